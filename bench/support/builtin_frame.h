// SPDX-License-Identifier: MIT
// The G-buffer of the built-in scene at 1280 x 720, for the benchmarks of what comes after it.
#pragma once
#include "bench/support/bench.h"
#include "host/gbuffer/gbuffer.h"
#include "host/visibility/technique.h"

namespace penumbra::bench {

struct BuiltinFrame {
    BuiltinFrame();
    const gbuffer::GBuffer& gbuffer() const { return pass.result(); }
    std::int64_t pixels() const { return std::int64_t{1} * gbuffer().width * gbuffer().height; }
    /// Half visibility everywhere, of `visibility.channels`; all pixels tested.
    void fill(visibility::Visibility& visibility) const;

    scene::CameraFrame camera;
    gbuffer::GBufferPass pass;
};

}  // namespace penumbra::bench
