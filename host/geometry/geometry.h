// SPDX-License-Identifier: MIT
// The geometry pass: a scene's meshes on the device, posed each frame.
#pragma once
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "host/scene/animation.h"
#include "host/scene/scene.h"
#include "kernels/shared/mesh.h"
#include "runtime/kernel.h"

namespace penumbra::geometry {

using runtime::Buffer;

/// The posed mesh on the device; layouts in kernels/shared/mesh.h.
struct Mesh {
    std::uint32_t vertexCount = 0, triangleCount = 0;
    std::uint32_t casterTriangleCount = 0;  ///< of draws that cast shadows
    Buffer<float> positions, previousPositions, normals, tangents;
    std::uint64_t version = 0;  ///< counts posings: equal versions are equal positions
    bool moved = false;         ///< positions differ from previousPositions
    Buffer<std::uint32_t> indices, triangleDraw;
    Buffer<shared::Draw> draws;
    Buffer<shared::Material> materials;
    Buffer<float> uvs;
    Buffer<std::uint32_t> colours, texels;
    bool hasMask = false, hasBlend = false;
};

struct GeometryCounts {
    std::uint32_t nonFiniteVertices = 0;
};

class Geometry {
  public:
    /// Uploads the scene. `centre`: the world is re-based to it in double before anything reaches
    /// the device. `frame`: the program of that name.
    Geometry(const runtime::Program& frame, const scene::Scene& scene, const glm::dvec3& centre);
    ~Geometry();

    /// Enqueues posing; skips it where nothing moved since the last call.
    const Mesh& run(const scene::Pose& pose);
    /// Waits for the device. Counts of the last posing that ran.
    GeometryCounts counts() const;
    const Mesh& mesh() const { return mesh_; }

  private:
    struct Matrices;
    std::vector<shared::Affine> matricesOf(const scene::Pose& pose) const;
    std::vector<float> weightsOf(const scene::Pose& pose) const;
    std::vector<shared::Draw> drawsOf(const scene::Pose& pose) const;

    const scene::Scene* scene_;
    glm::dvec3 centre_;
    runtime::Device* device_;
    Mesh mesh_;
    std::vector<shared::Draw> draws_;  ///< flags without DRAW_MIRRORED
    std::vector<int> drawNode_;
    std::vector<shared::PoseItem> items_;
    std::vector<int> skinFirstMatrix_;  ///< [skin] after the nodes' matrices
    std::vector<int> nodeFirstWeight_;  ///< [node]
    int weightCount_ = 0;
    bool posed_ = false;
    std::vector<shared::Affine> lastMatrices_;
    std::vector<float> lastWeights_;

    Buffer<std::uint32_t> vertexItem_;
    Buffer<shared::PoseItem> itemBuffer_;
    Buffer<float> sourcePositions_, sourceNormals_, sourceTangents_, jointWeights_, morphs_,
        morphWeights_;
    Buffer<std::uint16_t> joints_;
    Buffer<shared::Affine> matrices_;
    Buffer<shared::GeometryCounters> counters_;
    runtime::Kernel<int, Buffer<std::uint32_t>, Buffer<shared::PoseItem>, Buffer<float>,
                    Buffer<float>, Buffer<float>, Buffer<std::uint16_t>, Buffer<float>,
                    Buffer<float>, Buffer<float>, Buffer<shared::Affine>, Buffer<float>,
                    Buffer<float>, Buffer<float>, Buffer<shared::GeometryCounters>>
        pose_;
};

}  // namespace penumbra::geometry
