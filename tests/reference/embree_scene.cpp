// SPDX-License-Identifier: MIT
#include "tests/reference/embree_scene.h"

#include <limits>

#include "kernels/shared/gbuffer.h"

namespace penumbra::tests {

EmbreeScene::EmbreeScene(const scene::Scene& scene, const scene::Pose& pose,
                         const glm::dvec3& centre, bool castersOnly) {
    for (const auto& triangle : posedTriangles(scene, pose))
        if (!castersOnly || scene.nodes[static_cast<std::size_t>(triangle.node)].castShadow)
            triangles_.push_back(triangle);
    std::vector<glm::vec3> corners;
    for (const auto& triangle : triangles_)
        for (const auto& corner : triangle.corners) corners.emplace_back(corner - centre);
    commit(corners);
}

EmbreeScene::EmbreeScene(const std::vector<glm::vec3>& corners) {
    commit(corners);
}

void EmbreeScene::commit(const std::vector<glm::vec3>& corners) {
    device_ = rtcNewDevice("threads=1");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    if (!corners.empty()) {
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), corners.size()));
        auto* indices = static_cast<unsigned*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(unsigned), corners.size() / 3));
        for (std::size_t i = 0; i < corners.size(); ++i) {
            for (int axis = 0; axis < 3; ++axis)
                vertices[3 * i + static_cast<std::size_t>(axis)] = corners[i][axis];
            indices[i] = static_cast<unsigned>(i);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_);
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

EmbreeScene::Hit EmbreeScene::trace(const glm::vec3& origin, const glm::vec3& direction,
                                    float nearest) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray.org_x = origin.x, ray.ray.org_y = origin.y, ray.ray.org_z = origin.z;
    ray.ray.dir_x = direction.x, ray.ray.dir_y = direction.y, ray.ray.dir_z = direction.z;
    ray.ray.tnear = nearest;
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0U;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {static_cast<int>(ray.hit.primID), ray.ray.tfar, ray.hit.u, ray.hit.v};
}

bool EmbreeScene::occluded(const glm::vec3& from, const glm::vec3& to) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const glm::vec3 direction = to - from;
    RTCRay ray{};
    ray.org_x = from.x, ray.org_y = from.y, ray.org_z = from.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tfar = 1;
    ray.mask = ~0U;
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0;
}

std::vector<float> tracedVisibility(const scene::Scene& scene, const ShadowRun& run,
                                    std::vector<glm::vec3> samples) {
    const EmbreeScene embree(scene, run.pose, run.bounds.centre(), true);
    if (samples.empty()) samples = run.samplePoints();
    std::vector<float> truth(run.pixels(), 1.0F);
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        if (!run.tested(i)) continue;
        const glm::vec3 origin = run.shadowOrigin(i), normal = run.vectorAt(GB_GEOMETRIC, i);
        int seen = 0;
        for (const auto& sample : samples)
            seen += glm::dot(sample - origin, normal) > 0 && !embree.occluded(origin, sample);
        truth[i] = static_cast<float>(seen) / static_cast<float>(samples.size());
    }
    return truth;
}

}  // namespace penumbra::tests
