// SPDX-License-Identifier: MIT
// Collects nodes, meshes and buffers and writes them as one binary glTF 2.0 file. Bytes depend on
// the input alone.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "make_scene_figure.h"
#include "make_scene_walk.h"

namespace tools {

class GltfWriter {
  public:
    GltfWriter();

    // Each returns the index of what it added.
    int addMaterial(std::string_view name, const glm::vec3& baseColor, float roughness);
    int addMesh(std::string_view name, const Mesh& mesh, int material);
    int addFigureMesh(std::string_view name, const Figure& figure);
    int addNode(nlohmann::json node);
    int addSkin(std::string_view name, int firstJointNode);

    // Translation of the hips and rotation of every joint; joint nodes are consecutive.
    void addWalk(std::string_view name, const WalkClip& clip, int firstJointNode);

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

    nlohmann::json document_;
    std::vector<uint8_t> binary_;
};

nlohmann::json toJson(const glm::vec3& v);
nlohmann::json toJson(const glm::quat& q);

}  // namespace tools
