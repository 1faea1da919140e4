// SPDX-License-Identifier: MIT
#include "host/shading/composite.h"

#include "runtime/profiler.h"

namespace penumbra::shading {

Composite::Composite(const runtime::Program& frame, int width, int height)
    : device_(&frame.device()), composite_(frame, "composite") {
    const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    alpha_ = Buffer<float>(*device_, "alpha of pixels", pixels);
    front_ = Buffer<std::uint32_t>(*device_, "front surfaces", pixels);
}

void Composite::run(const gbuffer::GBuffer& gbuffer, const Buffer<float>& colour) {
    device_->profiler().beginStage("composite");
    const auto& lists = *gbuffer.blended;
    shared::ABufferParams params{};
    params.pixels = lists.pixels;
    params.planeStride = gbuffer.planeStride;
    params.capacity = lists.capacity;
    composite_.launch({static_cast<std::uint64_t>(lists.pixels)}, {64}, params, lists.ends,
                      lists.coverage, gbuffer.planes, colour, alpha_, front_);
}

}  // namespace penumbra::shading
