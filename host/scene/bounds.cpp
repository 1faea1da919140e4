// SPDX-License-Identifier: MIT
#include "host/scene/bounds.h"

#include <algorithm>
#include <cmath>

namespace penumbra::scene {
namespace {

constexpr double kFramesPerSecond = 24;
constexpr double kMaxFrames = 240;
constexpr double kMaxPosedVertices = 3e7;  // a few seconds of host time

std::vector<bool> movedNodes(const Scene& scene, const std::vector<int>& clips) {
    std::vector<bool> moved(scene.nodes.size(), false);
    for (const int clip : clips)
        for (const auto& channel : scene.animations[static_cast<std::size_t>(clip)].channels)
            moved[static_cast<std::size_t>(channel.node)] = true;
    for (const int node : scene.order) {
        const int parent = scene.nodes[static_cast<std::size_t>(node)].parent;
        if (parent >= 0 && moved[static_cast<std::size_t>(parent)])
            moved[static_cast<std::size_t>(node)] = true;
    }
    return moved;
}

bool isMoved(const Scene& scene, const std::vector<bool>& moved, int node) {
    const auto& n = scene.nodes[static_cast<std::size_t>(node)];
    if (moved[static_cast<std::size_t>(node)]) return true;
    if (n.skin < 0) return false;
    const auto& joints = scene.skins[static_cast<std::size_t>(n.skin)].joints;
    return std::any_of(joints.begin(), joints.end(),
                       [&](int joint) { return moved[static_cast<std::size_t>(joint)]; });
}

std::size_t vertexCount(const Scene& scene, int node) {
    std::size_t count = 0;
    const int mesh = scene.nodes[static_cast<std::size_t>(node)].mesh;
    if (mesh < 0) return 0;
    for (const auto& p : scene.meshes[static_cast<std::size_t>(mesh)].primitives)
        count += p.positions.size();
    return count;
}

void addNode(const Scene& scene, const Pose& pose, int node, Bounds& bounds) {
    const int mesh = scene.nodes[static_cast<std::size_t>(node)].mesh;
    if (mesh < 0) return;
    for (const auto& primitive : scene.meshes[static_cast<std::size_t>(mesh)].primitives)
        for (const auto& p : posedPositions(scene, pose, node, primitive)) bounds.add(p);
}

std::vector<glm::dvec3> morphed(const Primitive& primitive, const std::vector<float>& weights) {
    std::vector<glm::dvec3> positions(primitive.positions.begin(), primitive.positions.end());
    const auto targets = std::min(weights.size(), primitive.targets.size());
    for (std::size_t t = 0; t < targets; ++t) {
        const auto& moves = primitive.targets[t].positions;
        if (weights[t] == 0) continue;
        for (std::size_t i = 0; i < moves.size(); ++i)
            positions[i] += static_cast<double>(weights[t]) * glm::dvec3(moves[i]);
    }
    return positions;
}

Bounds boundsOf(const Scene& scene, const std::vector<int>& clips, bool castersOnly) {
    const auto moved = movedNodes(scene, clips);
    Bounds bounds;
    std::vector<int> moving;
    double movingVertices = 0;
    const Pose first = poseAt(scene, clips, 0);
    for (const int node : scene.order) {
        if (castersOnly && !scene.nodes[static_cast<std::size_t>(node)].castShadow) continue;
        addNode(scene, first, node, bounds);
        if (!isMoved(scene, moved, node)) continue;
        moving.push_back(node);
        movingVertices += static_cast<double>(vertexCount(scene, node));
    }
    const double duration = clipDurationSeconds(scene, clips);
    if (moving.empty() || duration <= 0) return bounds;
    const double affordable = kMaxPosedVertices / std::max(movingVertices, 1.0);
    const double most = std::clamp(std::floor(affordable), 2.0, kMaxFrames);
    const auto frames =
        static_cast<int>(std::clamp(std::ceil(duration * kFramesPerSecond), 1.0, most));
    for (int i = 1; i <= frames; ++i) {
        const Pose pose = poseAt(scene, clips, duration * i / frames);
        for (const int node : moving) addNode(scene, pose, node, bounds);
    }
    return bounds;
}

}  // namespace

void Bounds::add(const glm::dvec3& point) {
    if (!(std::abs(point.x) < 1e30 && std::abs(point.y) < 1e30 && std::abs(point.z) < 1e30)) return;
    low = empty ? point : glm::min(low, point);
    high = empty ? point : glm::max(high, point);
    empty = false;
}

std::vector<glm::dvec3> posedPositions(const Scene& scene, const Pose& pose, int node,
                                       const Primitive& primitive) {
    auto positions = morphed(primitive, pose.weights[static_cast<std::size_t>(node)]);
    const int skinIndex = scene.nodes[static_cast<std::size_t>(node)].skin;
    if (skinIndex < 0 || primitive.joints.empty()) {
        const auto& world = pose.worldFromNode[static_cast<std::size_t>(node)];
        for (auto& p : positions) p = glm::dvec3(world * glm::dvec4(p, 1));
        return positions;
    }
    const auto& skin = scene.skins[static_cast<std::size_t>(skinIndex)];
    std::vector<glm::dmat4> joints(skin.joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j)
        joints[j] =
            pose.worldFromNode[static_cast<std::size_t>(skin.joints[j])] * skin.jointFromMesh[j];
    for (std::size_t i = 0; i < positions.size(); ++i) {
        glm::dvec4 sum(0);
        for (std::size_t k = 0; k < 8; ++k)
            if (primitive.weights[i][k] != 0)
                sum += static_cast<double>(primitive.weights[i][k]) *
                       (joints[primitive.joints[i][k]] * glm::dvec4(positions[i], 1));
        positions[i] = glm::dvec3(sum);
    }
    return positions;
}

Bounds clipBounds(const Scene& scene, const std::vector<int>& clips) {
    const Bounds casters = boundsOf(scene, clips, true);
    return casters.empty ? boundsOf(scene, clips, false) : casters;
}

void addGround(Scene& scene, const Bounds& bounds) {
    const double radius = bounds.empty ? 1.0 : std::max(bounds.radius(), 1e-6);
    const auto half = static_cast<float>(10 * radius);
    Material material;
    material.name = "ground";
    material.baseColor = {0.5F, 0.5F, 0.5F, 1};
    material.metallic = 0;
    Primitive square;
    square.positions = {{-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half}};
    square.normals.assign(4, {0, 1, 0});
    square.indices = {0, 1, 2, 0, 2, 3};
    square.material = static_cast<int>(scene.materials.size());
    Node node;
    node.name = "ground";
    node.mesh = static_cast<int>(scene.meshes.size());
    node.castShadow = false;
    node.translation = {bounds.centre().x, bounds.low.y - 1e-4 * radius, bounds.centre().z};
    scene.materials.push_back(material);
    scene.meshes.push_back({"ground", {square}, {}});
    scene.order.push_back(static_cast<int>(scene.nodes.size()));
    scene.nodes.push_back(node);
}

}  // namespace penumbra::scene
