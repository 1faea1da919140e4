// SPDX-License-Identifier: MIT
#include "tests/reference/shadow_run.h"

#include <bit>
#include <cmath>

#include "host/gbuffer/gbuffer.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/multi_view.h"
#include "tests/support/opened_device.h"

namespace penumbra::tests {
namespace {

constexpr float kOriginOffset = 4e-6F;

void enqueue(const ShadowSetup& setup, const geometry::Mesh& mesh, const scene::CameraFrame& camera,
             gbuffer::GBufferPass& pass, visibility::Technique& technique,
             visibility::Visibility& visibility, ShadowRun& run) {
    const auto& gbuffer = pass.run(mesh, camera, run.bounds.centre());
    technique.prepare(mesh, run.bounds, run.bounds.centre());
    technique.run({mesh, gbuffer, run.light, run.bounds, run.bounds.centre(),
                   setup.keepMaps ? &run.maps : nullptr, setup.keepMasks ? &run.masks : nullptr},
                  visibility);
}

std::vector<glm::vec3> casterCorners(const geometry::Mesh& mesh) {
    const auto positions = mesh.positions.download();
    const auto indices = mesh.indices.download();
    const auto triangleDraw = mesh.triangleDraw.download();
    const auto draws = mesh.draws.download();
    std::vector<glm::vec3> corners;
    for (std::size_t t = 0; t < mesh.triangleCount; ++t) {
        if (!(draws[triangleDraw[t]].flags & DRAW_CASTS)) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t v = 3 * static_cast<std::size_t>(indices[3 * t + c]);
            corners.emplace_back(positions[v], positions[v + 1], positions[v + 2]);
        }
    }
    return corners;
}

}  // namespace

bool ShadowRun::tested(std::size_t pixel) const {
    return state[pixel] == STATE_TESTED;
}

bool ShadowRun::covered(std::size_t pixel) const {
    return std::bit_cast<std::uint32_t>(planes[GB_OBJECT * stride + pixel]) != 0;
}

glm::vec3 ShadowRun::vectorAt(int plane, std::size_t pixel) const {
    const auto at = static_cast<std::size_t>(plane) * stride + pixel;
    return {planes[at], planes[at + stride], planes[at + 2 * stride]};
}

glm::vec3 ShadowRun::shadowOrigin(std::size_t pixel) const {
    const glm::vec3 p = vectorAt(GB_POSITION, pixel);
    const glm::vec3 size = glm::abs(p);
    const float magnitude =
        std::max({size.x, size.y, size.z, static_cast<float>(bounds.empty ? 0 : bounds.radius())});
    return p + vectorAt(GB_GEOMETRIC, pixel) * (magnitude * kOriginOffset);
}

std::vector<glm::vec3> ShadowRun::samplePoints() const {
    std::vector<glm::vec3> points;
    for (const auto& s : light.samples)
        points.emplace_back(light.centre - bounds.centre() + s.x * light.axisX + s.y * light.axisY);
    return points;
}

ShadowRun runShadows(const scene::Scene& original, const ShadowSetup& setup) {
    scene::Scene scene = original;
    if (!setup.light.empty()) scene.lights = {scene::parseLight(setup.light)};
    const auto clips = scene::chooseAnimations(scene, "");
    ShadowRun run;
    run.width = setup.width;
    run.height = setup.height;
    run.bounds = scene::clipBounds(scene, clips);
    run.pose = scene::poseAt(scene, clips, setup.seconds);
    scene::SampleChoice samples;
    samples.pattern = setup.pattern;
    samples.seed = setup.seed;
    samples = scene::parseSampleCount(setup.samples, samples);
    run.light = scene::lightsAt(scene, run.pose, run.bounds, samples).at(0);
    scene::CameraChoice choice;
    if (setup.placedCamera) {
        choice.eye = setup.eye;
        choice.target = setup.target;
        choice.fovDegrees = setup.fovDegrees;
    }
    const auto camera = scene::cameraAt(scene, run.pose, choice, run.bounds,
                                        static_cast<double>(setup.width) / setup.height);
    geometry::Geometry geometry(program("frame"), scene, run.bounds.centre());
    gbuffer::GBufferPass pass(program("frame"), setup.width, setup.height);
    const auto& mesh = geometry.run(run.pose);
    // Blended surfaces are rows of the G-buffer: what follows is made for their number
    do pass.run(mesh, camera, run.bounds.centre());
    while (pass.grew());
    const auto& gbuffer = pass.result();
    const auto technique =
        visibility::findTechnique(setup.technique)
            .make({device(), setup.settings, setup.width, gbuffer.rows(), gbuffer.fragmentRows});
    const auto stride = static_cast<std::uint64_t>(gbuffer.planeStride);
    visibility::Visibility visibility;
    visibility.planes = runtime::Buffer<float>(device(), "visibility", 3 * stride);
    visibility.state = runtime::Buffer<std::uint32_t>(device(), "states", stride);
    for (;; ++run.retries) {
        if (run.retries > 6) throw std::runtime_error("lists still overflow");
        enqueue(setup, mesh, camera, pass, *technique, visibility, run);
        const bool tiles = pass.grew();
        if (!technique->grew() && !tiles) break;
        technique->takeCounts();
    }
    run.counts = technique->takeCounts();
    run.stride = stride;
    run.planes = pass.result().planes.download();
    run.visibility =
        visibility.planes.download(0, stride * static_cast<std::uint64_t>(visibility.channels));
    run.state = visibility.state.download();
    run.casters = casterCorners(mesh);
    return run;
}

double rmse(const ShadowRun& run, const std::vector<float>& truth) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        if (!run.tested(i)) continue;
        const double difference = static_cast<double>(run.visibility[i]) - truth[i];
        sum += difference * difference;
        ++count;
    }
    return count ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

}  // namespace penumbra::tests
