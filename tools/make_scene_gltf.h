// SPDX-License-Identifier: MIT
// Collects nodes, meshes and buffers and writes them as one binary glTF 2.0 file. Bytes depend on
// the input alone.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "make_scene_cloth.h"
#include "make_scene_png.h"
#include "make_scene_pose.h"

namespace tools {

// What the meshes of one figure share: per material, accessors of vertices and indices.
struct FigureBuffers {
    std::vector<nlohmann::json> attributes;
    std::vector<int> indices;
};

class GltfWriter {
  public:
    GltfWriter();

    // Each returns the index of what it added.
    int addMaterial(std::string_view name, const glm::vec3& baseColor, float roughness);
    // An embedded picture, clamped at its edges or repeated.
    int addTexture(const Picture& picture, bool repeats);
    int addMesh(std::string_view name, const Mesh& mesh, int material);
    // All materials index the same vertices, as many exporters have it.
    int addFigureMesh(std::string_view name, const Figure& figure);
    // Each material has its own vertices, so that none is posed in vain.
    FigureBuffers addFigureBuffers(const Figure& figure);
    int addFigureMesh(std::string_view name, const FigureBuffers& buffers,
                      const std::vector<FigureMaterial>& materials);
    int addClothMesh(std::string_view name, const Cloth& cloth, int material);
    int addNode(nlohmann::json node);
    // The figure's skin, or one of joints at rest at the given places; joint nodes are consecutive.
    int addSkin(std::string_view name, int firstJointNode);
    int addSkin(std::string_view name, int firstJointNode, const std::vector<glm::vec3>& places);

    int addAnimation(std::string_view name);
    // Translation of the hips and rotation of every joint; joint nodes are consecutive.
    void animateFigure(int animation, const Clip& clip, int firstJointNode);
    // Rotations of consecutive nodes.
    void animateNodes(int animation, const std::vector<float>& timesSeconds,
                      const std::vector<std::vector<glm::quat>>& rotations, int firstNode);

    void animateTranslation(int animation, const std::vector<float>& timesSeconds,
                            const std::vector<glm::vec3>& translations, int node);

    void addChild(int parent, int child);

    // Top-level members that need no bookkeeping: cameras, extensions.
    nlohmann::json& document() { return document_; }

    // Returns the size in bytes; throws std::runtime_error if the file cannot be written.
    size_t write(const std::string& path);

  private:
    template <typename Element>
    int addAccessor(const std::vector<Element>& elements, int componentType, std::string_view type,
                    int target);
    int addIndices(const std::vector<uint32_t>& indices, size_t vertexCount);
    nlohmann::json addAttributes(const Mesh& mesh);
    nlohmann::json addSkinnedAttributes(const Mesh& mesh,
                                        const std::vector<std::array<uint8_t, 4>>& joints,
                                        const std::vector<std::array<uint16_t, 4>>& weights);
    int addTimes(const std::vector<float>& timesSeconds);
    void addChannel(int animation, int times, int output, int node, std::string_view path);
    int addRotations(const std::vector<glm::quat>& rotations);

    nlohmann::json document_;
    std::vector<uint8_t> binary_;
};

nlohmann::json toJson(const glm::vec3& v);
nlohmann::json toJson(const glm::quat& q);

}  // namespace tools
