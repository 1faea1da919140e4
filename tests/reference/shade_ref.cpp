// SPDX-License-Identifier: MIT
#include "tests/reference/shade_ref.h"

#include <algorithm>
#include <cmath>

#include "kernels/shared/shade.h"
#include "tests/reference/irradiance_ref.h"

namespace penumbra::tests {
namespace {

/// Roughness below which the 16 points would show as 16 highlights.
constexpr double kLeastRoughness = 0.2;

/// Walter et al. 2007, eq. 33: distribution of microfacets over the tangent of their angle.
double distribution(double alpha, double cosine) {
    if (cosine <= 0) return 0;
    const double tangent2 = (1 - cosine * cosine) / (cosine * cosine);
    const double sum = alpha * alpha + tangent2;
    return alpha * alpha / (M_PI * std::pow(cosine, 4) * sum * sum);
}

/// Smith's Lambda for GGX; the share of facets that see both directions is 1 / (1 + L(v) + L(l)).
double lambda(double alpha, double cosine) {
    const double tangent2 = (1 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1 + alpha * alpha * tangent2) - 1);
}

/// BRDF times the cosine at the surface, for unit directions.
glm::dvec3 reflectance(const ShadePixel& pixel, const glm::dvec3& view, const glm::dvec3& towards) {
    const double alpha = std::pow(std::max(pixel.roughness, kLeastRoughness), 2);
    const double nl = glm::dot(pixel.normal, towards);
    // Normals that lean away from the eye still reflect, at grazing angles
    const double nv = std::max(glm::dot(pixel.normal, view), 1e-4);
    if (nl <= 0) return glm::dvec3(0);
    const glm::dvec3 half = glm::normalize(view + towards);
    const double shadowing = 1 / (1 + lambda(alpha, nv) + lambda(alpha, nl));
    const double lobe =
        distribution(alpha, glm::dot(pixel.normal, half)) * shadowing / (4 * nl * nv);
    const glm::dvec3 f0 = glm::mix(glm::dvec3(0.04), pixel.albedo, pixel.metallic);
    const glm::dvec3 fresnel = f0 + (1.0 - f0) * std::pow(1 - glm::dot(view, half), 5);
    return lobe * nl * fresnel;
}

/// Reflected radiance of a patch of the light's area around the offset (x, y) of its centre.
glm::dvec3 patch(const scene::AreaLight& light, const ShadePixel& pixel, const glm::dvec3& view,
                 const glm::dvec2& at, double area) {
    const glm::dvec3 offset =
        light.centre + at.x * light.axisX + at.y * light.axisY - pixel.position;
    const double squared = glm::dot(offset, offset);
    const glm::dvec3 towards = offset / std::sqrt(squared);
    const double emitter = std::max(-glm::dot(light.axisZ, towards), 0.0);
    const double solidAngle = light.isPoint() ? 1 / squared : emitter * area / squared;
    return solidAngle * reflectance(pixel, view, towards);
}

double areaOf(const scene::AreaLight& light) {
    return light.width * light.height * (light.disk ? M_PI / 4 : 1);
}

/// KHR_lights_punctual: the square of a ramp between the cosines of the two angles.
double cone(const scene::AreaLight& light, const glm::dvec3& point) {
    if (light.outerConeRad <= 0) return 1;
    const double cosine = glm::dot(glm::normalize(point - light.centre), light.axisZ);
    const double inner = std::cos(light.innerConeRad), outer = std::cos(light.outerConeRad);
    const double ramp = std::clamp((cosine - outer) / std::max(inner - outer, 1e-4), 0.0, 1.0);
    return ramp * ramp;
}

double irradiance(const scene::AreaLight& light, const ShadePixel& pixel) {
    if (!light.isPoint()) return irradianceReference(light, pixel.position, pixel.normal, 200);
    const glm::dvec3 offset = light.centre - pixel.position;
    return std::max(glm::dot(offset, pixel.normal), 0.0) / std::pow(glm::length(offset), 3);
}

/// True if some corner of the light's bounding rectangle is above the pixel's plane.
bool faces(const scene::AreaLight& light, const ShadePixel& pixel) {
    bool above = false;
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.5, 0.5}) {
            const glm::dvec3 corner =
                light.centre + x * light.width * light.axisX + y * light.height * light.axisY;
            above |= glm::dot(corner - pixel.position, pixel.geometric) > 0;
        }
    return above;
}

}  // namespace

glm::dvec3 reflectionReference(const scene::AreaLight& light, const ShadePixel& pixel,
                               const glm::dvec3& towardsEye) {
    scene::SampleChoice choice;
    choice.count = SHADE_POINTS;
    choice.pattern = light.disk ? scene::Pattern::hammersley : scene::Pattern::grid;
    const auto points = scene::samplePattern(choice, light.disk);
    glm::dvec3 sum(0);
    for (const auto& p : points)
        sum += patch(light, pixel, glm::normalize(towardsEye),
                     p * glm::dvec2(light.width, light.height) / 2.0, areaOf(light));
    return light.radiance * sum / static_cast<double>(points.size());
}

glm::dvec3 reflectionIntegral(const scene::AreaLight& light, const ShadePixel& pixel,
                              const glm::dvec3& towardsEye, int steps) {
    const glm::dvec3 view = glm::normalize(towardsEye);
    const double cells = static_cast<double>(steps) * steps;
    glm::dvec3 sum(0);
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double a = (i + 0.5) / steps, b = (j + 0.5) / steps;
            glm::dvec2 at(2 * a - 1, 2 * b - 1);
            if (light.disk)  // rings of equal area
                at = std::sqrt(a) * glm::dvec2(std::cos(2 * M_PI * b), std::sin(2 * M_PI * b));
            sum += patch(light, pixel, view, at * glm::dvec2(light.width, light.height) / 2.0,
                         areaOf(light) / cells);
        }
    return light.radiance * sum;
}

glm::dvec3 shadeReference(const scene::AreaLight& light, const ShadePixel& pixel,
                          const glm::dvec3& towardsEye, const glm::dvec3& visibility) {
    if (pixel.unlit || !faces(light, pixel)) return glm::dvec3(0);
    const glm::dvec3 diffuse =
        light.radiance * pixel.albedo * (1 - pixel.metallic) / M_PI * irradiance(light, pixel);
    return visibility * cone(light, pixel.position) *
           (diffuse + reflectionReference(light, pixel, towardsEye));
}

}  // namespace penumbra::tests
