// SPDX-License-Identifier: MIT
#include "tests/reference/points_run.h"

#include <bit>
#include <cmath>

#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

/// IEEE 754 binary16.
double halfOf(std::uint16_t bits) {
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    const double magnitude = exponent ? std::ldexp(1024 + fraction, exponent - 25)
                                      : std::ldexp(static_cast<double>(fraction), -24);
    return bits & 0x8000 ? -magnitude : magnitude;
}

scene::Scene withLight(scene::Scene scene, const std::string& light) {
    scene.lights = {scene::parseLight(light)};
    return scene;
}

}  // namespace

PointsRun::PointsRun(const scene::Scene& original, const PointsSetup& setup)
    : scene(withLight(original, setup.light)),
      bounds(scene::clipBounds(scene, {})),
      pose(scene::poseAt(scene, {}, 0)),
      light(scene::lightsAt(scene, pose, bounds, scene::parseSampleCount(setup.samples, {})).at(0)),
      view(visibility::fitLightView(light, bounds, bounds.centre(), setup.resolution,
                                    setup.density)),
      geometry_(program("frame"), scene, bounds.centre()),
      pass_(program("multi_view"), setup.cull, setup.precision) {
    view.params.depthBits = 32;
    const auto& mesh = geometry_.run(pose);
    runtime::Buffer<shared::MultiViewCounters> buffer(device(), "counters", 1);
    pass_.grow(1);
    do {
        pass_.adapt(mesh, view);
        buffer.fill({});
        pass_.run(mesh, view, buffer);
        counters = buffer.download()[0];
    } while (pass_.grewTiles() || pass_.grow(counters.points));
}

std::vector<DevicePoint> PointsRun::points() const {
    const auto& p = view.params;
    const auto& buffers = pass_.buffers();
    std::vector<float> planes32;
    std::vector<std::uint16_t> planes16;
    std::vector<std::uint32_t> keys(counters.points, 0);
    if (p.precision == POINTS_FLOAT)
        planes32 = buffers.points32.download();
    else
        planes16 = buffers.points16.download();
    if (p.alphaKeys) keys = buffers.keys.download(0, counters.points);
    const double low = 0.5 * p.resolution * (1 - (1 + static_cast<double>(p.setBack) / p.near));
    const double step = p.resolution * (1 + static_cast<double>(p.setBack) / p.near) / 65535;
    std::vector<DevicePoint> points(counters.points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        double* const out[] = {&points[i].a, &points[i].b, &points[i].w};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t at = k * p.pointCapacity + i;
            const double middle = k < 2 ? 0.5 * p.resolution : 0;
            if (p.precision == POINTS_FLOAT)
                *out[k] = planes32[at];
            else if (p.precision == POINTS_HALF)
                *out[k] = halfOf(planes16[at]) + middle;
            else
                *out[k] = k < 2 ? planes16[at] * step + low : planes16[at] / 65535.0;
        }
        points[i].key = keys[i];
    }
    return points;
}

std::vector<std::vector<float>> PointsRun::warpedMaps(visibility::Parallelism form, int bits) {
    const auto views = static_cast<std::size_t>(view.params.views);
    const auto stride = static_cast<std::size_t>(view.params.mapStride);
    runtime::Buffer<std::uint32_t> maps32(device(), "maps", views * stride);
    runtime::Buffer<std::uint16_t> maps16(device(), "maps", views * stride);
    runtime::Buffer<float> samples(device(), "samples", view.samples);
    runtime::Buffer<shared::MultiViewCounters> count(
        device(), "counters", std::vector<shared::MultiViewCounters>{counters});
    view.params.depthBits = bits;
    visibility::DepthWarp warp(program("multi_view"), form, 3);
    warp.run(pass_.buffers(), view, samples,
             {0, view.params.views, &maps32, bits == 16 ? &maps16 : nullptr}, count);
    const auto words = maps32.download();
    const auto shorts = maps16.download();
    const auto texels = static_cast<std::size_t>(view.params.resolution) *
                        static_cast<std::size_t>(view.params.resolution);
    std::vector<std::vector<float>> result(views);
    for (std::size_t v = 0; v < views; ++v)
        for (std::size_t i = v * stride; i < v * stride + texels; ++i)
            // Where only 32-bit texels can be filled, they hold 16-bit depths to be packed
            result[v].push_back(
                bits == 32 ? std::bit_cast<float>(words[i])
                           : static_cast<float>(warp.needsWideMaps() ? words[i] : shorts[i]) / 65535.0F);
    return result;
}

std::vector<std::vector<float>> PointsRun::directMaps() {
    const auto views = static_cast<std::size_t>(view.params.views);
    const auto stride = static_cast<std::size_t>(view.params.mapStride);
    const auto texels = static_cast<std::size_t>(view.params.resolution) *
                        static_cast<std::size_t>(view.params.resolution);
    runtime::Buffer<std::uint32_t> maps(device(), "maps", views * stride);
    runtime::Buffer<float> samples(device(), "samples", view.samples);
    runtime::Buffer<shared::MultiViewCounters> buffer(device(), "counters", 1);
    shared::LookupParams all{};
    all.viewCount = view.params.views;
    do {
        maps.fill(0);
        buffer.fill({});
        pass_.runDirect(geometry_.mesh(), view, all, samples, maps, buffer);
    } while (pass_.grewTiles());
    counters = buffer.download()[0];
    const auto bits = maps.download();
    std::vector<std::vector<float>> result(views);
    for (std::size_t v = 0; v < views; ++v)
        for (std::size_t i = 0; i < texels; ++i)
            result[v].push_back(std::bit_cast<float>(bits[v * stride + i]));
    return result;
}

}  // namespace penumbra::tests
