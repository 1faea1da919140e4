// SPDX-License-Identifier: MIT
#include "tests/reference/shade_run.h"

#include <bit>
#include <cmath>

#include "host/gbuffer/gbuffer.h"
#include "host/shading/shade.h"
#include "kernels/shared/gbuffer.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

void setPlane3(std::vector<float>& planes, std::size_t stride, int plane, std::size_t pixel,
               const glm::dvec3& value) {
    for (int axis = 0; axis < 3; ++axis)
        planes[static_cast<std::size_t>(plane + axis) * stride + pixel] =
            static_cast<float>(value[axis]);
}

/// A G-buffer of hand-made pixels; one row.
gbuffer::GBuffer gbufferOf(const std::vector<ShadePixel>& pixels) {
    const std::size_t stride = (pixels.size() + GB_PAD - 1) / GB_PAD * GB_PAD;
    std::vector<float> planes(GB_PLANES * stride, 0.0F);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const ShadePixel& p = pixels[i];
        setPlane3(planes, stride, GB_POSITION, i, p.position);
        setPlane3(planes, stride, GB_GEOMETRIC, i, p.geometric);
        setPlane3(planes, stride, GB_NORMAL, i, p.normal);
        setPlane3(planes, stride, GB_ALBEDO, i, p.albedo);
        setPlane3(planes, stride, GB_EMISSIVE, i, p.emissive);
        planes[GB_METALLIC * stride + i] = static_cast<float>(p.metallic);
        planes[GB_ROUGHNESS * stride + i] = static_cast<float>(p.roughness);
        planes[GB_OBJECT * stride + i] = std::bit_cast<float>(1U);
        planes[GB_FLAGS * stride + i] = std::bit_cast<float>(p.unlit ? DRAW_UNLIT : 0U);
    }
    gbuffer::GBuffer result;
    result.width = static_cast<int>(pixels.size());
    result.height = 1;
    result.planeStride = static_cast<int>(stride);
    result.planes = runtime::Buffer<float>(device(), "G-buffer", planes);
    return result;
}

}  // namespace

std::vector<glm::dvec3> shadePixels(const std::vector<ShadePixel>& pixels,
                                    const scene::AreaLight& light, const glm::dvec3& eye,
                                    const glm::dvec3& ambient, int channels,
                                    const std::vector<glm::dvec3>& visibility) {
    const auto gbuffer = gbufferOf(pixels);
    const auto stride = static_cast<std::size_t>(gbuffer.planeStride);
    shading::Shade shade(program("frame"), gbuffer.width, gbuffer.height);
    std::vector<float> planes(static_cast<std::size_t>(channels) * stride, 1.0F);
    for (std::size_t i = 0; i < visibility.size(); ++i)
        for (int c = 0; c < channels; ++c)
            planes[static_cast<std::size_t>(c) * stride + i] = static_cast<float>(visibility[i][c]);
    visibility::Visibility seen;
    seen.channels = channels;
    seen.planes = runtime::Buffer<float>(device(), "visibility", planes);
    scene::CameraFrame camera;
    camera.worldFromCamera[3] = glm::dvec4(eye, 1);
    shade.begin(gbuffer, ambient);
    shade.add(gbuffer, light, seen, camera, glm::dvec3(0));
    const auto colour = shade.colour().download();
    std::vector<glm::dvec3> result;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        result.emplace_back(colour[i], colour[stride + i], colour[2 * stride + i]);
    return result;
}

namespace {

std::vector<float> shadeOnce(const std::vector<Receiver>& receivers, const scene::AreaLight& light,
                             float albedo) {
    std::vector<ShadePixel> pixels;
    for (const auto& r : receivers)
        pixels.push_back({r.point, r.normal, r.normal, glm::dvec3(albedo)});
    std::vector<float> red;
    for (const auto& colour : shadePixels(pixels, light, {0, 0, 0}, {0, 0, 0}, 1, {}))
        red.push_back(static_cast<float>(colour.x));
    return red;
}

}  // namespace

std::vector<double> irradiance(const std::vector<Receiver>& receivers,
                               const scene::AreaLight& light) {
    const auto bright = shadeOnce(receivers, light, 1), dim = shadeOnce(receivers, light, 0.5F);
    std::vector<double> result;
    for (std::size_t i = 0; i < receivers.size(); ++i)
        result.push_back((static_cast<double>(bright[i]) - dim[i]) * 2 * M_PI);
    return result;
}

scene::AreaLight makeLight(bool disk, double width, double height) {
    scene::AreaLight light;
    light.disk = disk;
    light.centre = {0.3, 2, -0.4};
    light.axisZ = glm::normalize(glm::dvec3(0.2, -1, 0.3));
    light.axisX = glm::normalize(glm::cross(light.axisZ, glm::dvec3(0.1, 0.2, 1)));
    light.axisY = glm::cross(light.axisZ, light.axisX);
    light.width = width;
    light.height = height;
    return light;
}

}  // namespace penumbra::tests
