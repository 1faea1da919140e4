// SPDX-License-Identifier: MIT
#include "host/visibility/light_view.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernels/shared/map_raster.h"

namespace penumbra::visibility {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kMaxFov = 140 * kDegree, kSpare = 1.02;
constexpr int kMaxEnlarged = 8192;
/// Casters between this share of the near plane and the near plane keep depth 1; nearer ones are
/// cut.
constexpr double kNearClip = 1.0 / MAP_NEAR_CLIP;

struct Fit {
    double tanHalfFov = 1, near = 1;
    double farthest = 1;
    bool complete = true;
};

glm::dvec3 inLight(const scene::AreaLight& light, const glm::dvec3& world) {
    const glm::dvec3 offset = world - light.centre;
    return {glm::dot(offset, light.axisX), glm::dot(offset, light.axisY),
            glm::dot(offset, light.axisZ)};
}

Fit fitTo(const scene::AreaLight& light, const scene::Bounds& casters) {
    const double radius = casters.empty ? 1 : std::max(casters.radius(), 1e-9);
    std::vector<glm::dvec3> corners;
    double nearest = 1e300, farthest = 0;
    for (int i = 0; i < 8; ++i) {
        corners.push_back(inLight(
            light, {i & 1 ? casters.high.x : casters.low.x, i & 2 ? casters.high.y : casters.low.y,
                    i & 4 ? casters.high.z : casters.low.z}));
        nearest = std::min(nearest, corners.back().z);
        farthest = std::max(farthest, corners.back().z);
    }
    Fit fit;
    fit.farthest = farthest;
    const double least = std::max(0.25 * std::max(light.width, light.height), 1e-3 * radius);
    fit.near = light.nearMetres > 0 ? light.nearMetres : std::max(0.9 * nearest, least);
    const double maxTangent = std::tan(kMaxFov / 2);
    double tangent = 1e-3;
    for (const auto& c : corners) {
        const double z = std::max(c.z, fit.near);
        const double reach =
            std::max(std::abs(c.x) + light.width / 2, std::abs(c.y) + light.height / 2);
        tangent = std::max(tangent, c.z < fit.near && nearest < fit.near ? maxTangent : reach / z);
    }
    fit.tanHalfFov =
        light.fovRad > 0 ? std::tan(light.fovRad / 2) : std::min(tangent * kSpare, maxTangent);
    fit.complete = nearest >= fit.near && tangent <= fit.tanHalfFov;
    return fit;
}

shared::float4 row(const glm::dvec3& axis, double offset) {
    return {static_cast<float>(axis.x), static_cast<float>(axis.y), static_cast<float>(axis.z),
            static_cast<float>(offset)};
}

}  // namespace

int shuffleStride(int views) {
    int stride = std::max(static_cast<int>(views * 0.6180339887498949), 1);
    while (std::gcd(stride, views) != 1) ++stride;
    return stride;
}

LightView fitLightView(const scene::AreaLight& light, const scene::Bounds& casters,
                       const glm::dvec3& centre, int resolution, double density) {
    const Fit fit = fitTo(light, casters);
    const double t = fit.tanHalfFov, near = fit.near;
    const double setBack =
        std::max(light.width, light.height) / (2 * t);  // eq. 1; t serves both axes
    const double scale = (near + setBack) / near;       // eq. 3
    LightView view;
    auto& p = view.params;
    const glm::dvec3 origin = light.centre - centre;
    const glm::dvec3 axes[3] = {light.axisX, light.axisY, light.axisZ};
    for (int i = 0; i < 3; ++i) p.lightFromWorld.row[i] = row(axes[i], -glm::dot(axes[i], origin));
    const double wanted = std::ceil(resolution * scale * density - 1e-9);
    const int cap = std::max(kMaxEnlarged, resolution);
    p.enlarged = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(cap)));
    view.complete = fit.complete;
    view.farthestCaster = fit.farthest;
    view.disk = light.disk;
    view.density = density * std::min(1.0, p.enlarged / wanted);
    const double focal = resolution / (2 * t);
    p.tanHalfFov = static_cast<float>(t);
    p.near = static_cast<float>(near);
    p.focal = static_cast<float>(focal);
    p.centre = 0.5F * static_cast<float>(resolution);
    p.setBack = static_cast<float>(setBack);
    p.nearClip = static_cast<float>(near * kNearClip);
    p.halfWidth = static_cast<float>(light.width / 2);
    p.halfHeight = static_cast<float>(light.height / 2);
    p.resolution = resolution;
    p.views = static_cast<int>(light.samples.size());
    p.mapStride = (resolution * resolution + 16) / 16 * 16;
    p.sampleStride = shuffleStride(p.views);
    for (const auto& s : light.samples) {
        view.samples.push_back(static_cast<float>(s.x * focal / near));
        view.samples.push_back(static_cast<float>(s.y * focal / near));
    }

    auto& r = view.enlarged;
    r.width = r.height = p.enlarged;
    const double half = 0.5 * p.enlarged;
    const auto rowOf = [&](const glm::dvec3& axis) {
        const glm::dvec3 a = half * (light.axisZ + axis / t);
        return row(a, half * setBack - glm::dot(a, origin));
    };
    r.rowX = rowOf(light.axisX);
    r.rowY = rowOf(light.axisY);
    r.rowW = row(light.axisZ, setBack - glm::dot(light.axisZ, origin));
    r.rowD = row(glm::dvec3(0), near * kNearClip + setBack);
    // X right, Y down, Z forward is right-handed: nothing is mirrored, fronts turn
    // counter-clockwise
    r.frontIsClockwise = 0;

    auto& c = view.central;
    c = r;
    c.width = c.height = resolution;
    const auto centralRow = [&](const glm::dvec3& axis) {
        const glm::dvec3 a = focal * axis + 0.5 * resolution * light.axisZ;
        return row(a, -glm::dot(a, origin));
    };
    c.rowX = centralRow(light.axisX);
    c.rowY = centralRow(light.axisY);
    c.rowW = row(light.axisZ, -glm::dot(light.axisZ, origin));
    c.rowD = row(glm::dvec3(0), near * kNearClip);
    return view;
}

}  // namespace penumbra::visibility
