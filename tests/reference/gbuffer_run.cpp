// SPDX-License-Identifier: MIT
#include "tests/reference/gbuffer_run.h"

#include <bit>
#include <cmath>

#include "host/gbuffer/gbuffer.h"
#include "kernels/shared/gbuffer.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {

std::uint32_t GBufferRun::object(int x, int y) const {
    return std::bit_cast<std::uint32_t>(value(GB_OBJECT, x, y));
}

GBufferRun runGBuffer(const scene::Scene& scene, const scene::CameraFrame& camera, int width,
                      int height, const glm::dvec3& centre, bool atomics64) {
    geometry::Geometry geometry(program("frame"), scene, centre);
    gbuffer::GBufferPass pass(program("frame"), width, height, atomics64);
    const auto& mesh = geometry.run(scene::poseAt(scene, {}, 0));
    do pass.run(mesh, camera, centre);
    while (pass.grew());
    GBufferRun run;
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
