// SPDX-License-Identifier: MIT
// What the toys of [4DR] stand on and are animated by.
#pragma once
#include <string_view>
#include <vector>

#include "make_scene_exhibit.h"
#include "make_scene_fight.h"
#include "make_scene_gltf.h"

namespace tools {

constexpr float kSeconds = 2 * kFightSeconds;  // of the loop
constexpr float kGymHeight = 11;               // the frame is the highest of all toys

// The floor that toys are put on, and the one animation of all.
class Toybox {
  public:
    Toybox(GltfWriter& writer, Exhibit& exhibit, int animation)
        : writer_(writer), exhibit_(exhibit), animation_(animation) {}

    int addPlace(std::string_view name, const glm::vec3& at, int parent = -1) {
        return addUnder(writer_, parent, placedNode(name, at, yaw(0)));
    }

    // A part that does not move against its parent.
    void add(std::string_view name, const Mesh& mesh, const glm::vec3& colour, int parent,
             float creaseDeg = 40) {
        const int material = writer_.addMaterial(name, colour, 0.5F);
        addProp(writer_, {{"name", name}}, withNormals(mesh, creaseDeg), material, parent);
        exhibit_.count(mesh.triangleCount(), kGymHeight);
    }

    // `at` gives the rotation for a share of the loop.
    template <typename Rotation>
    void rotate(int node, const Rotation& at) {
        std::vector<glm::quat> keys;
        for (const float time : times()) keys.push_back(at(time / kSeconds));
        writer_.animateNodes(animation_, times(), {keys}, node);
    }

    template <typename Translation>
    void move(int node, const Translation& at) {
        std::vector<glm::vec3> keys;
        for (const float time : times()) keys.push_back(at(time / kSeconds));
        writer_.animateTranslation(animation_, times(), keys, node);
    }

  private:
    static std::vector<float> times() {
        constexpr int kKeys = 96;
        std::vector<float> times;
        for (int key = 0; key <= kKeys; ++key)
            times.push_back(kSeconds * static_cast<float>(key) / kKeys);
        return times;
    }

    GltfWriter& writer_;
    Exhibit& exhibit_;
    int animation_;
};

}  // namespace tools
