// SPDX-License-Identifier: MIT
// What the tests share: one open device, programs built once, scenes made in code.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "host/penumbra.h"
#include "host/scene/scene.h"
#include "runtime/device.h"
#include "runtime/program.h"

namespace penumbra::tests {

/// The device under test: PENUMBRA_DEVICE, else the CPU. Opened once with profiling off.
runtime::Device& device();
/// A program of CMakeLists.txt, built once.
const runtime::Program& program(const std::string& name);

/// Folder of the real models: $PENUMBRA_ASSETS, else ../shared/assets beside the checkout; empty if
/// absent.
std::string assetFolder();
/// Path of a model such as "Fox/Fox.glb"; skips the test with a message where it is absent.
#define ASSET_OR_SKIP(variable, name)                                       \
    const std::string variable = penumbra::tests::assetFolder() + "/" name; \
    if (penumbra::tests::assetFolder().empty())                             \
    GTEST_SKIP() << "the models are absent; set PENUMBRA_ASSETS to their folder"

/// A folder for files of this test, emptied before.
std::string temporaryFolder(const std::string& name);

/// Scenes in code: a mesh becomes a node with the given transform.
class SceneBuilder {
  public:
    SceneBuilder();
    /// Adds triangles in the world; `positions` per vertex, three indices per triangle. Returns the
    /// node.
    int addMesh(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& indices,
                const glm::dmat4& world = glm::dmat4(1), bool casts = true, bool receives = true);
    /// Rectangle spanned by two edges from a corner; front along cross(a, b).
    int addQuad(glm::vec3 corner, glm::vec3 a, glm::vec3 b, bool casts = true,
                bool receives = true);
    /// Closed sphere of quads, normals outwards.
    int addSphere(glm::vec3 centre, float radius, int rings = 32, int segments = 64);
    /// Closed box.
    int addBox(glm::vec3 low, glm::vec3 high);
    scene::Material& material() { return scene_.materials[0]; }
    scene::Scene& scene() { return scene_; }

  private:
    scene::Scene scene_;
};

}  // namespace penumbra::tests
