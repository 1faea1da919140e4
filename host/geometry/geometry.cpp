// SPDX-License-Identifier: MIT
#include "host/geometry/geometry.h"

#include <cstring>

#include "host/geometry/materials.h"
#include "host/geometry/mesh_arrays.h"
#include "runtime/profiler.h"

namespace penumbra::geometry {
namespace {

shared::Affine affineOf(const glm::dmat4& m) {
    shared::Affine a{};
    for (int row = 0; row < 3; ++row)
        a.row[row] = {static_cast<float>(m[0][row]), static_cast<float>(m[1][row]),
                      static_cast<float>(m[2][row]), static_cast<float>(m[3][row])};
    return a;
}

/// A buffer of these values, or of one zero where there are none: kernels are never handed null.
template <typename T>
Buffer<T> bufferOf(runtime::Device& device, const char* label, const std::vector<T>& values) {
    return Buffer<T>(device, label, values.empty() ? std::vector<T>(1) : values);
}

template <typename T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace

Geometry::Geometry(const runtime::Program& frame, const scene::Scene& scene,
                   const glm::dvec3& centre)
    : scene_(&scene), centre_(centre), device_(&frame.device()), pose_(frame, "pose") {
    int matrixCount = static_cast<int>(scene.nodes.size());
    for (const auto& skin : scene.skins) {
        skinFirstMatrix_.push_back(matrixCount);
        matrixCount += static_cast<int>(skin.joints.size());
    }
    for (const auto& node : scene.nodes) {
        nodeFirstWeight_.push_back(weightCount_);
        if (node.mesh < 0) continue;
        const auto& primitives = scene.meshes[static_cast<std::size_t>(node.mesh)].primitives;
        if (!primitives.empty()) weightCount_ += static_cast<int>(primitives[0].targets.size());
    }
    const MeshArrays arrays = flatten(scene, skinFirstMatrix_, nodeFirstWeight_);
    const MaterialArrays materials = packMaterials(scene);
    draws_ = arrays.draws;
    drawNode_ = arrays.drawNode;
    items_ = arrays.items;

    auto& device = *device_;
    mesh_.vertexCount = static_cast<std::uint32_t>(arrays.vertexItem.size());
    mesh_.triangleCount = static_cast<std::uint32_t>(arrays.triangleDraw.size());
    for (const auto draw : arrays.triangleDraw)
        mesh_.casterTriangleCount += arrays.draws[draw].flags & DRAW_CASTS ? 1 : 0;
    mesh_.hasMask = arrays.hasMask;
    mesh_.hasBlend = arrays.hasBlend;
    mesh_.positions = Buffer<float>(device, "positions", 3ULL * mesh_.vertexCount + 1);
    mesh_.previousPositions = Buffer<float>(device, "last positions", 3ULL * mesh_.vertexCount + 1);
    mesh_.normals = Buffer<float>(device, "normals", 3ULL * mesh_.vertexCount + 1);
    mesh_.tangents = Buffer<float>(device, "tangents", 4ULL * mesh_.vertexCount + 4);
    mesh_.indices = bufferOf(device, "indices", arrays.indices);
    mesh_.triangleDraw = bufferOf(device, "triangle draws", arrays.triangleDraw);
    mesh_.draws = bufferOf(device, "draws", arrays.draws);
    mesh_.materials = bufferOf(device, "materials", materials.materials);
    mesh_.uvs = bufferOf(device, "uvs", arrays.uvs);
    mesh_.colours = bufferOf(device, "colours", arrays.colours);
    mesh_.texels = bufferOf(device, "texels", materials.texels);
    vertexItem_ = bufferOf(device, "vertex items", arrays.vertexItem);
    itemBuffer_ = bufferOf(device, "pose items", arrays.items);
    sourcePositions_ = bufferOf(device, "source positions", arrays.positions);
    sourceNormals_ = bufferOf(device, "source normals", arrays.normals);
    sourceTangents_ = bufferOf(device, "source tangents", arrays.tangents);
    joints_ = bufferOf(device, "joints", arrays.joints);
    jointWeights_ = bufferOf(device, "joint weights", arrays.weights);
    morphs_ = bufferOf(device, "morph targets", arrays.morphs);
    morphWeights_ =
        Buffer<float>(device, "morph weights", static_cast<std::uint64_t>(weightCount_) + 1);
    matrices_ =
        Buffer<shared::Affine>(device, "matrices", static_cast<std::uint64_t>(matrixCount) + 1);
    counters_ = Buffer<shared::GeometryCounters>(device, "geometry counters", 1);
    counters_.fill({});
}

Geometry::~Geometry() = default;

std::vector<shared::Affine> Geometry::matricesOf(const scene::Pose& pose) const {
    glm::dmat4 rebase(1);
    rebase[3] = glm::dvec4(-centre_, 1);
    std::vector<shared::Affine> matrices;
    for (const auto& world : pose.worldFromNode) matrices.push_back(affineOf(rebase * world));
    for (const auto& skin : scene_->skins)
        for (std::size_t j = 0; j < skin.joints.size(); ++j)
            matrices.push_back(
                affineOf(rebase * pose.worldFromNode[static_cast<std::size_t>(skin.joints[j])] *
                         skin.jointFromMesh[j]));
    return matrices;
}

std::vector<float> Geometry::weightsOf(const scene::Pose& pose) const {
    std::vector<float> weights(static_cast<std::size_t>(weightCount_) + 1, 0.0F);
    for (std::size_t node = 0; node < pose.weights.size(); ++node) {
        const auto first = static_cast<std::size_t>(nodeFirstWeight_[node]);
        for (std::size_t i = 0; i < pose.weights[node].size() && first + i < weights.size(); ++i)
            weights[first + i] = pose.weights[node][i];
    }
    return weights;
}

std::vector<shared::Draw> Geometry::drawsOf(const scene::Pose& pose) const {
    auto draws = draws_;
    for (std::size_t i = 0; i < draws.size(); ++i) {
        if (items_[i].skinVertex >= 0) continue;  // joints of a skin mirror rarely and not as one
        const auto& world = pose.worldFromNode[static_cast<std::size_t>(drawNode_[i])];
        if (glm::determinant(glm::dmat3(world)) < 0) draws[i].flags |= DRAW_MIRRORED;
    }
    return draws;
}

const Mesh& Geometry::run(const scene::Pose& pose) {
    device_->profiler().beginStage("geometry");
    auto matrices = matricesOf(pose);
    auto weights = weightsOf(pose);
    if (posed_ && sameBytes(matrices, lastMatrices_) && sameBytes(weights, lastWeights_)) {
        mesh_.moved = false;
        return mesh_;
    }
    mesh_.moved = posed_;
    std::swap(mesh_.positions, mesh_.previousPositions);
    lastMatrices_ = matrices;
    lastWeights_ = weights;
    auto draws = drawsOf(pose);
    if (!draws.empty()) mesh_.draws.uploadLater(std::move(draws));
    matrices_.uploadLater(std::move(matrices));
    morphWeights_.uploadLater(std::move(weights));
    counters_.fill({});
    pose_.launch({mesh_.vertexCount}, {64}, static_cast<int>(mesh_.vertexCount), vertexItem_,
                 itemBuffer_, sourcePositions_, sourceNormals_, sourceTangents_, joints_,
                 jointWeights_, morphs_, morphWeights_, matrices_, mesh_.positions, mesh_.normals,
                 mesh_.tangents, counters_);
    posed_ = true;
    ++mesh_.version;
    return mesh_;
}

GeometryCounts Geometry::counts() const {
    return {counters_.download()[0].nonFiniteVertices};
}

}  // namespace penumbra::geometry
