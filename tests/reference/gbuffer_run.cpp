// SPDX-License-Identifier: MIT
#include "tests/reference/gbuffer_run.h"

#include <bit>
#include <cmath>
#include <stdexcept>

#include "host/gbuffer/gbuffer.h"
#include "kernels/shared/gbuffer.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {

std::uint32_t GBufferRun::object(int x, int y) const {
    return std::bit_cast<std::uint32_t>(value(GB_OBJECT, x, y));
}

namespace {

std::vector<std::vector<ListedFragment>> downloadLists(const gbuffer::FragmentLists& lists) {
    std::vector<std::vector<ListedFragment>> result(static_cast<std::size_t>(lists.pixels));
    const auto ends = lists.ends.download(), fragments = lists.fragments.download(),
               owners = lists.owners.download();
    const auto coverage = lists.coverage.download();
    const std::size_t capacity = lists.capacity;
    std::size_t f = 0;
    for (std::size_t pixel = 0; pixel < result.size(); ++pixel)
        for (; f < ends[pixel]; ++f) {
            if (owners[f] != pixel) throw std::runtime_error("a fragment of another pixel");
            ListedFragment fragment;
            fragment.triangle = static_cast<int>(fragments[2 * f + 1]);
            fragment.depth = std::bit_cast<float>(fragments[2 * f]);
            fragment.entry = result.size() + f;
            fragment.alpha = coverage[COVERAGE_ALPHA * capacity + f];
            for (std::size_t c = 0; c < 3; ++c)
                fragment.through[static_cast<int>(c)] =
                    coverage[(COVERAGE_THROUGH + c) * capacity + f];
            result[pixel].push_back(fragment);
        }
    return result;
}

}  // namespace

GBufferRun runGBuffer(const scene::Scene& scene, const scene::CameraFrame& camera, int width,
                      int height, const glm::dvec3& centre, bool atomics64) {
    geometry::Geometry geometry(program("frame"), scene, centre);
    gbuffer::GBufferPass pass(program("frame"), width, height, atomics64);
    const auto& mesh = geometry.run(scene::poseAt(scene, {}, 0));
    GBufferRun run;
    for (pass.run(mesh, camera, centre); pass.grew(); ++run.repetitions)
        pass.run(mesh, camera, centre);
    if (pass.result().blended) run.lists = downloadLists(*pass.result().blended);
    run.layers = pass.fragmentCounts().layers;
    run.width = width;
    run.height = height;
    run.stride = static_cast<std::size_t>(pass.result().planeStride);
    run.planes = pass.result().planes.download();
    run.nonFinite = geometry.counts().nonFiniteVertices;
    return run;
}

scene::CameraFrame pixelCamera(int width, int height) {
    scene::CameraFrame camera;
    camera.orthographic = true;
    camera.xmag = width / 2.0;
    camera.ymag = height / 2.0;
    camera.nearMetres = 1;
    camera.farMetres = 20;
    camera.worldFromCamera[3] = glm::dvec4(width / 2.0, -height / 2.0, 10, 1);
    return camera;
}

scene::CameraFrame perspectiveCamera(const glm::dvec3& eye, const glm::dvec3& target,
                                     double yfovDegrees) {
    scene::CameraFrame camera;
    camera.worldFromCamera = scene::lookAt(eye, target, {0, 1, 0});
    camera.yfovRad = yfovDegrees * M_PI / 180;
    return camera;
}

glm::dvec3 pixelRay(const scene::CameraFrame& camera, int width, int height, int x, int y) {
    const double t = std::tan(camera.yfovRad / 2);
    const double right = (2 * (x + 0.5) / width - 1) * t * width / height;
    const double up = (1 - 2 * (y + 0.5) / height) * t;
    return glm::dmat3(camera.worldFromCamera) * glm::dvec3(right, up, -1);
}

}  // namespace penumbra::tests
