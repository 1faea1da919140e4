// SPDX-License-Identifier: MIT
// Compositing: blended fragments over the opaque surface behind them.
#pragma once
#include "host/gbuffer/gbuffer.h"

namespace penumbra::shading {

using runtime::Buffer;

class Composite {
  public:
    Composite(const runtime::Program& frame, int width, int height);

    /// Enqueues putting each pixel's shaded fragments over it. A fragment adds its colour times its
    /// alpha a; of what is behind, 1 - a passes, and a t c more where a share t of the colour c is
    /// transmitted. `colour` [3, planeStride] of pixels and fragments; those of the image become
    /// the composite. Kernel: kernels/shading/composite.cl
    void run(const gbuffer::GBuffer& gbuffer, const Buffer<float>& colour);
    /// Share of each pixel of the image that is covered.
    const Buffer<float>& alpha() const { return alpha_; }
    /// Which entry of the G-buffer the channels beside colour show: the first surface of an alpha
    /// above 0.5, else the opaque one.
    const Buffer<std::uint32_t>& front() const { return front_; }

  private:
    runtime::Device* device_;
    runtime::Kernel<shared::ABufferParams, Buffer<std::uint32_t>, Buffer<float>, Buffer<float>,
                    Buffer<float>, Buffer<float>, Buffer<std::uint32_t>>
        composite_;
    Buffer<float> alpha_;
    Buffer<std::uint32_t> front_;
};

}  // namespace penumbra::shading
