// SPDX-License-Identifier: MIT
#include "host/shading/temporal.h"

#include <algorithm>

#include "kernels/shared/gbuffer.h"
#include "runtime/profiler.h"

namespace penumbra::shading {

Temporal::Temporal(const runtime::Program& frame, int width, int height, int window)
    : device_(&frame.device()),
      width_(width),
      height_(height),
      stride_(shared::gbufferStride(width * height)),
      window_(window),
      temporal_(frame, "temporal"),
      begin_(frame, "temporal_begin"),
      keep_(frame, "temporal_keep"),
      lastDepth_(*device_, "last depth", static_cast<std::uint64_t>(stride_)),
      lastObject_(*device_, "last objects", static_cast<std::uint64_t>(stride_)) {}

void Temporal::reset() {
    valid_ = 0;
}

void Temporal::run(const gbuffer::GBuffer& gbuffer, std::size_t light,
                   visibility::Visibility& visibility) {
    if (window_ < 2) return;
    device_->profiler().beginStage("temporal");
    while (histories_.size() <= light) histories_.push_back(std::make_unique<History>());
    History& history = *histories_[light];
    const auto size = static_cast<std::uint64_t>(window_ - 1) *
                      static_cast<std::uint64_t>(visibility.channels) *
                      static_cast<std::uint64_t>(stride_);
    history.now.grow(*device_, "visibility history", size);
    history.last.grow(*device_, "visibility history", size);
    std::swap(history.now, history.last);
    lightsRun_ = light + 1;
    auto params = lastCamera_;
    params.width = width_;
    params.height = height_;
    params.planeStride = stride_;
    params.ages = window_ - 1;
    params.channels = visibility.channels;
    params.valid = valid_;
    begin_.launch({static_cast<std::uint64_t>(stride_)}, {64}, params, visibility.state,
                  visibility.planes, history.now);
    temporal_.launch({static_cast<std::uint64_t>(stride_)}, {64}, params, gbuffer.planes,
                     lastDepth_, lastObject_, visibility.state, history.last, history.now,
                     visibility.planes);
}

void Temporal::undo() {
    for (std::size_t i = 0; i < lightsRun_; ++i) std::swap(histories_[i]->now, histories_[i]->last);
    lightsRun_ = 0;
}

void Temporal::endFrame(const gbuffer::GBuffer& gbuffer, const scene::CameraFrame& camera,
                        const glm::dvec3& centre) {
    if (window_ < 2) return;
    device_->profiler().beginStage("temporal");
    keep_.launch({static_cast<std::uint64_t>(stride_)}, {64}, stride_, gbuffer.planes, lastDepth_,
                 lastObject_);
    const auto view = scene::rasterView(camera, centre, width_, height_);
    const auto row = scene::depthRow(camera, centre);
    lastCamera_.rowX = view.rowX;
    lastCamera_.rowY = view.rowY;
    lastCamera_.rowW = view.rowW;
    lastCamera_.rowDepth = {static_cast<float>(row.x), static_cast<float>(row.y),
                            static_cast<float>(row.z), static_cast<float>(row.w)};
    lightsRun_ = 0;
    valid_ = std::min(valid_ + 1, window_ - 1);
}

}  // namespace penumbra::shading
