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
      window_(window),
      temporal_(frame, "temporal"),
      begin_(frame, "temporal_begin"),
      keep_(frame, "temporal_keep"),
      noLists_(*device_, "no fragments", 1),
      lastEnds_(*device_, "no fragments", 1) {
    const auto pixels = static_cast<std::uint64_t>(shared::gbufferStride(width * height));
    lastDepth_.grow(*device_, "last depth", pixels);
    lastObject_.grow(*device_, "last objects", pixels);
}

void Temporal::reset() {
    valid_ = 0;
}

void Temporal::run(const gbuffer::GBuffer& gbuffer, std::size_t light,
                   visibility::Visibility& visibility) {
    if (window_ < 2) return;
    device_->profiler().beginStage("temporal");
    while (histories_.size() <= light) histories_.push_back(std::make_unique<History>());
    History& history = *histories_[light];
    const auto stride = static_cast<std::uint64_t>(gbuffer.planeStride);
    const auto size = static_cast<std::uint64_t>(window_ - 1) *
                      static_cast<std::uint64_t>(visibility.channels) * stride;
    // What `now` holds is needed: it was as long as the last frame's entries
    history.last.grow(*device_, "visibility history", size);
    if (!history.now.allocated()) history.now.grow(*device_, "visibility history", size);
    std::swap(history.now, history.last);
    lightsRun_ = light + 1;
    auto params = lastCamera_;
    params.width = width_;
    params.height = height_;
    params.planeStride = gbuffer.planeStride;
    params.ages = window_ - 1;
    params.channels = visibility.channels;
    params.valid = valid_;
    const auto* lists = gbuffer.blended;
    begin_.launch({stride}, {64}, params, visibility.state, visibility.planes, history.now);
    temporal_.launch({stride}, {64}, params, gbuffer.planes, lists ? lists->ends : noLists_,
                     lists ? lists->owners : noLists_, lastEnds_, lastDepth_, lastObject_,
                     visibility.state, history.last, history.now, visibility.planes);
}

void Temporal::undo() {
    for (std::size_t i = 0; i < lightsRun_; ++i) std::swap(histories_[i]->now, histories_[i]->last);
    lightsRun_ = 0;
}

void Temporal::endFrame(const gbuffer::GBuffer& gbuffer, const scene::CameraFrame& camera,
                        const glm::dvec3& centre) {
    if (window_ < 2) return;
    device_->profiler().beginStage("temporal");
    const auto stride = static_cast<std::uint64_t>(gbuffer.planeStride);
    lastDepth_.grow(*device_, "last depth", stride);
    lastObject_.grow(*device_, "last objects", stride);
    keep_.launch({stride}, {64}, gbuffer.planeStride, gbuffer.planes, lastDepth_, lastObject_);
    if (gbuffer.blended) {
        lastEnds_.grow(*device_, "last ends of lists", gbuffer.blended->ends.count());
        lastEnds_.copyFrom(gbuffer.blended->ends, gbuffer.blended->ends.count());
    }
    lastCamera_.lastStride = gbuffer.planeStride;
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
