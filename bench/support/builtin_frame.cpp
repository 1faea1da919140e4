// SPDX-License-Identifier: MIT
#include "bench/support/builtin_frame.h"

#include "kernels/shared/multi_view.h"

namespace penumbra::bench {

BuiltinFrame::BuiltinFrame() : pass(program("frame"), 1280, 720) {
    auto& posed = builtinScene();
    const auto pose = scene::poseAt(posed.scene, scene::chooseAnimations(posed.scene, ""), 0.25);
    camera = scene::cameraAt(posed.scene, pose, {}, posed.bounds, 16.0 / 9);
    do pass.run(posed.mesh(), camera, posed.bounds.centre());
    while (pass.grew());
}

void BuiltinFrame::fill(visibility::Visibility& visibility) const {
    const auto stride = static_cast<std::uint64_t>(gbuffer().planeStride);
    const auto channels = static_cast<std::uint64_t>(visibility.channels);
    visibility.planes = runtime::Buffer<float>(device(), "visibility", channels * stride);
    visibility.state = runtime::Buffer<std::uint32_t>(device(), "states", stride);
    visibility.planes.fill(0.5F);
    visibility.state.fill(STATE_TESTED);
}

}  // namespace penumbra::bench
