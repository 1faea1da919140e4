// SPDX-License-Identifier: MIT
#include "make_scene_bear.h"

#include "make_scene_field.h"
#include "make_scene_random.h"
#include "make_scene_simplify.h"
#include "make_scene_surface.h"

namespace tools {

using glm::vec3;

namespace {

float bearDistance(const vec3& p) {
    constexpr float kFur = 0.025F;
    const vec3 q(std::abs(p.x), p.y, p.z);  // both sides at once
    float d = ellipsoid(p, {0, 1.6F, 0}, {1.25F, 1.6F, 1.1F});
    d = smoothMin(d, ellipsoid(p, {0, 3.85F, 0.15F}, {1.15F, 1.05F, 1.05F}), 0.25F);
    const float ear = smoothMax(ellipsoid(q, {0.88F, 4.7F, 0.05F}, {0.45F, 0.45F, 0.24F}),
                                -ellipsoid(q, {0.88F, 4.7F, 0.33F}, {0.28F, 0.28F, 0.2F}), 0.08F);
    d = smoothMin(d, ear, 0.1F);
    d = smoothMin(d, ellipsoid(p, {0, 3.6F, 1.1F}, {0.52F, 0.42F, 0.42F}), 0.12F);
    d = smoothMin(d, capsule(q, {0.68F, 0.58F, 0.4F}, {1.1F, 0.55F, 2.1F}, 0.56F, 0.5F), 0.15F);
    d = smoothMin(d, ellipsoid(q, {1.14F, 0.68F, 2.45F}, {0.5F, 0.66F, 0.3F}), 0.12F);
    d = smoothMin(d, capsule(q, {1.05F, 2.6F, 0.15F}, {1.75F, 1.5F, 1.0F}, 0.42F, 0.38F), 0.15F);
    return std::abs(d) < 0.2F ? d + kFur * noiseAt(5.5F * p) : d;
}

std::vector<float> makeSteps(float low, float high, float step) {
    std::vector<float> planes;
    for (float at = low; at < high; at += step) planes.push_back(at);
    return planes;
}

}  // namespace

Mesh makeBear(size_t triangleCount) {
    constexpr float kStep = 0.042F;
    Mesh mesh =
        polygonise(bearDistance, {makeSteps(-2.35F, 2.4F, kStep), makeSteps(-0.15F, 5.35F, kStep),
                                  makeSteps(-1.35F, 3.0F, kStep)});
    std::vector<uint8_t> none;
    simplify(mesh, none, triangleCount);
    return withNormals(mesh, 60);
}

Mesh makeBearButtons() {
    Mesh mesh;
    const glm::quat none(1, 0, 0, 0);
    append(mesh, makeSphere(0.17F, 32, 20), none, {0, 3.8F, 1.5F});
    for (const float side : {-1.0F, 1.0F})
        append(mesh, makeSphere(0.12F, 28, 18), none, {0.38F * side, 4.15F, 1.05F});
    for (const float y : {1.3F, 2.0F}) append(mesh, makeSphere(0.1F, 28, 18), none, {0, y, 1.09F});
    return withNormals(mesh, 60);
}

}  // namespace tools
