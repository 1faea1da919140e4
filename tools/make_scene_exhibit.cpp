// SPDX-License-Identifier: MIT
#include "make_scene_exhibit.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace tools {

using glm::vec3;

namespace {

// The light's diagonal is 3 ([4DR] table 5).
const double kLightSide = 3 / std::sqrt(2.0);

void addGround(GltfWriter& writer, float halfSide, const vec3& colour) {
    Mesh mesh;
    for (const vec3& corner : {vec3(-1, 0, -1), vec3(-1, 0, 1), vec3(1, 0, 1), vec3(1, 0, -1)}) {
        mesh.positions.push_back(corner * halfSide);
        mesh.normals.emplace_back(0, 1, 0);
    }
    mesh.indices = {0, 1, 2, 0, 2, 3};
    addProp(writer, {{"name", "ground"}, {"extras", {{"castShadow", false}}}}, mesh,
            writer.addMaterial("ground", colour, 0.95F));
}

}  // namespace

void Exhibit::add(std::string_view name, const Mesh& mesh, const vec3& colour, float roughness,
                  bool isSheet) {
    const int material = writer_.addMaterial(name, colour, roughness);
    if (isSheet) writer_.document()["materials"][material]["doubleSided"] = true;
    addProp(writer_, {{"name", name}}, mesh, material);
    triangleCount_ += mesh.triangleCount();
    for (const vec3& position : mesh.positions) {
        low_ = glm::min(low_, position);
        high_ = glm::max(high_, position);
    }
}

void Exhibit::count(size_t triangles, float height) {
    triangleCount_ += triangles;
    high_.y = std::max(high_.y, height);
}

void Exhibit::finish(const ExhibitView& view) {
    const float height = high_.y - low_.y;
    const float halfSide =
        std::sqrt((view.diagonal * view.diagonal - height * height) / 8);  // NaN if too high
    const vec3 reach = glm::max(glm::abs(low_), glm::abs(high_));
    if (!(halfSide > std::max(reach.x, reach.z)))
        throw std::runtime_error("the scene is larger than its diagonal");
    addGround(writer_, halfSide, view.groundColour);
    const vec3 centre(0, 0.5F * (low_.y + high_.y), 0);
    const vec3 light = centre + view.lightDistance * glm::normalize(view.towardsLight);
    // The same irradiance at the centre of each
    const double nits = 0.6 * view.lightDistance * view.lightDistance;
    addLight(writer_, {light, centre, kLightSide, nits});
    addCamera(writer_, view.eye, view.target, glm::radians(view.yfovDeg), 1, 500);
    std::printf("%-12s %6zu triangles, ground of %.2f m\n", "all", triangleCount_ + 2,
                2 * halfSide);
}

}  // namespace tools
