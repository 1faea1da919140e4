// SPDX-License-Identifier: MIT
// Averages each light's visibility over the last K frames, following surfaces through their motion.
#pragma once
#include <memory>

#include "host/scene/camera.h"
#include "host/visibility/technique.h"
#include "kernels/shared/temporal.h"

namespace penumbra::shading {

using runtime::Buffer;

class Temporal {
  public:
    /// `window`: frames averaged, this one included. Width and height of the image; blended
    /// fragments are followed as its pixels are.
    Temporal(const runtime::Program& frame, int width, int height, int window);

    /// Forgets all history: the next frame is the first of its window.
    void reset();
    /// Enqueues averaging `visibility` of the frame's `light`-th light in place.
    void run(const gbuffer::GBuffer& gbuffer, std::size_t light,
             visibility::Visibility& visibility);
    /// Takes back the frame's run() calls: the frame is repeated.
    void undo();
    /// Enqueues keeping what the next frame compares with; once a frame, after the lights.
    void endFrame(const gbuffer::GBuffer& gbuffer, const scene::CameraFrame& camera,
                  const glm::dvec3& centre);
    int window() const { return window_; }

  private:
    struct History {
        Buffer<float> now, last;  ///< [age, channel, stride]
    };
    runtime::Device* device_;
    int width_, height_, window_;
    int valid_ = 0;
    shared::TemporalParams lastCamera_{};
    using U32 = std::uint32_t;
    runtime::Kernel<shared::TemporalParams, Buffer<float>, Buffer<U32>, Buffer<U32>, Buffer<U32>,
                    Buffer<float>, Buffer<U32>, Buffer<U32>, Buffer<float>, Buffer<float>,
                    Buffer<float>>
        temporal_;
    runtime::Kernel<shared::TemporalParams, Buffer<U32>, Buffer<float>, Buffer<float>> begin_;
    runtime::Kernel<int, Buffer<float>, Buffer<float>, Buffer<U32>> keep_;
    Buffer<U32> noLists_, lastEnds_;
    Buffer<float> lastDepth_;
    Buffer<U32> lastObject_;
    std::vector<std::unique_ptr<History>> histories_;
    std::size_t lightsRun_ = 0;  ///< in this frame
};

}  // namespace penumbra::shading
