// SPDX-License-Identifier: MIT
#include "host/shading/shade.h"

#include <cmath>

#include "runtime/profiler.h"

namespace penumbra::shading {
namespace {

constexpr double kPi = 3.14159265358979323846;

shared::float4 narrow(const glm::dvec3& v, double w) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(w)};
}

/// Writes (x, y) as the i-th pair of an array of float4.
void setPair(shared::float4* pairs, int i, double x, double y) {
    auto& pair = pairs[i / 2];
    (i % 2 ? pair.z : pair.x) = static_cast<float>(x);
    (i % 2 ? pair.w : pair.y) = static_cast<float>(y);
}

void setCorners(const scene::AreaLight& light, shared::ShadeLight& out) {
    if (light.isPoint()) return;
    const double w = light.width / 2, h = light.height / 2;
    if (!light.disk) {
        out.corners = 4;
        out.area = static_cast<float>(light.width * light.height);
        const double x[] = {-w, w, w, -w}, y[] = {-h, -h, h, h};
        for (int i = 0; i < 4; ++i) setPair(out.corner, i, x[i], y[i]);
        return;
    }
    out.corners = SHADE_MAX_CORNERS;
    out.area = static_cast<float>(kPi * w * h);
    const double n = SHADE_MAX_CORNERS, step = 2 * kPi / n;
    const double grow = std::sqrt(kPi / (0.5 * n * std::sin(step)));  // same area as the ellipse
    for (int i = 0; i < SHADE_MAX_CORNERS; ++i)
        setPair(out.corner, i, grow * w * std::cos(i * step), grow * h * std::sin(i * step));
}

}  // namespace

shared::ShadeLight shadeLight(const scene::AreaLight& light, const glm::dvec3& centre) {
    shared::ShadeLight out{};
    const glm::dvec3 origin = light.centre - centre;
    const glm::dvec3 axes[] = {light.axisX, light.axisY, light.axisZ};
    for (int i = 0; i < 3; ++i)
        out.lightFromWorld.row[i] = narrow(axes[i], -glm::dot(axes[i], origin));
    out.radiance = narrow(light.radiance, 0);
    out.halfWidth = static_cast<float>(light.width / 2);
    out.halfHeight = static_cast<float>(light.height / 2);
    out.cosInner = static_cast<float>(std::cos(light.innerConeRad));
    out.cosOuter =
        light.outerConeRad > 0 ? static_cast<float>(std::cos(light.outerConeRad)) : -2.0F;
    setCorners(light, out);
    scene::SampleChoice grid;
    grid.count = SHADE_POINTS;
    grid.pattern = light.disk ? scene::Pattern::hammersley : scene::Pattern::grid;
    const auto points = scene::samplePattern(grid, light.disk);
    for (int i = 0; i < SHADE_POINTS; ++i) {
        const auto& p = points[static_cast<std::size_t>(i)];
        setPair(out.point, i, p.x * light.width / 2, p.y * light.height / 2);
    }
    return out;
}

Shade::Shade(const runtime::Program& frame, int width, int height)
    : device_(&frame.device()), begin_(frame, "shade_begin"), light_(frame, "shade_light") {
    const auto pixels = static_cast<std::uint64_t>(shared::gbufferStride(width * height));
    colour_ = Buffer<float>(*device_, "colour", runtime::Shape{1, 3, pixels});
}

void Shade::begin(const gbuffer::GBuffer& gbuffer, const glm::dvec3& ambient) {
    device_->profiler().beginStage("shading");
    shared::ShadeParams params{};
    params.planeStride = gbuffer.planeStride;
    params.ambient = narrow(ambient, 0);
    const auto items = static_cast<std::uint64_t>(gbuffer.planeStride / device_->info().lanes);
    begin_.launch({items}, {64}, params, gbuffer.planes, colour_);
}

void Shade::add(const gbuffer::GBuffer& gbuffer, const scene::AreaLight& light,
                const visibility::Visibility& visibility, const scene::CameraFrame& camera,
                const glm::dvec3& centre) {
    device_->profiler().beginStage("shading");
    shared::ShadeParams params{};
    params.planeStride = gbuffer.planeStride;
    params.channels = visibility.channels;
    const glm::dvec3 eye = glm::dvec3(camera.worldFromCamera[3]) - centre;
    params.eye =
        camera.orthographic ? narrow(glm::dvec3(camera.worldFromCamera[2]), 0) : narrow(eye, 1);
    const auto items = static_cast<std::uint64_t>(gbuffer.planeStride / device_->info().lanes);
    light_.launch({items}, {64}, params, shadeLight(light, centre), gbuffer.planes,
                  visibility.planes, colour_);
}

}  // namespace penumbra::shading
