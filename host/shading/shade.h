// SPDX-License-Identifier: MIT
// Shading: reflectance x visibility.
#pragma once
#include "host/gbuffer/gbuffer.h"
#include "host/scene/light.h"
#include "host/visibility/technique.h"
#include "kernels/shared/shade.h"

namespace penumbra::shading {

using runtime::Buffer;

class Shade {
  public:
    Shade(const runtime::Program& frame, int width, int height);

    /// Enqueues emission and ambient light into the colour image. `ambient`: radiance of a white
    /// surface.
    void begin(const gbuffer::GBuffer& gbuffer, const glm::dvec3& ambient);
    /// Enqueues adding one light: closed-form Lambert irradiance (rectangles; disks as 16-gons of
    /// the same area), GGX over 16 fixed points of the light; roughness at least 0.2.
    void add(const gbuffer::GBuffer& gbuffer, const scene::AreaLight& light,
             const visibility::Visibility& visibility, const scene::CameraFrame& camera,
             const glm::dvec3& centre);
    /// Linear RGB: float [3, planeStride].
    const Buffer<float>& colour() const { return colour_; }

  private:
    runtime::Device* device_;
    runtime::Kernel<shared::ShadeParams, Buffer<float>, Buffer<float>> begin_;
    runtime::Kernel<shared::ShadeParams, shared::ShadeLight, Buffer<float>, Buffer<float>,
                    Buffer<float>>
        light_;
    Buffer<float> colour_;
};

/// What the kernel needs of a light; `centre` is what the world was re-based to.
shared::ShadeLight shadeLight(const scene::AreaLight& light, const glm::dvec3& centre);

}  // namespace penumbra::shading
