// SPDX-License-Identifier: MIT
// Nodes, the chosen scene's order, skins. No recursion: a file may nest nodes as deep as it likes.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "host/scene/gltf_accessor.h"
#include "host/scene/gltf_context.h"

namespace penumbra::scene {

namespace {

/// The rows of a matrix must end in 0 0 0 1, up to the rounding of exporters; it is made exact.
glm::dmat4 checkAffine(const double* values, const std::string& user) {
    const glm::dmat4 matrix = glm::make_mat4(values);
    for (int i = 0; i < 16; ++i)
        require(std::isfinite(values[i]) && std::abs(values[i]) <= FLT_MAX,
                "{} has a matrix with the entry {}; finite floats are needed", user, values[i]);
    const glm::dvec4 bottom(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    require(glm::length(bottom - glm::dvec4(0, 0, 0, 1)) < 1e-4,
            "{} has a matrix that ends in the row {} {} {} {}; 0 0 0 1 is needed", user, bottom.x,
            bottom.y, bottom.z, bottom.w);
    glm::dmat4 affine = matrix;
    for (int column = 0; column < 4; ++column) affine[column][3] = column == 3 ? 1 : 0;
    return affine;
}

/// `values` is empty (absent) or has `count` finite numbers.
bool checkNumbers(const std::vector<double>& values, std::size_t count, const char* property,
                  const std::string& user) {
    if (values.empty()) return false;
    require(values.size() == count, "{} has a {} of {} numbers; {} are needed", user, property,
            values.size(), count);
    for (const double value : values)
        require(std::isfinite(value) && std::abs(value) <= FLT_MAX,
                "{} has {} in its {}; finite floats are needed", user, value, property);
    return true;
}

void loadTransform(LoadContext& context, const tinygltf::Node& source, Node& node,
                   const std::string& user) {
    if (checkNumbers(source.matrix, 16, "matrix", user)) {
        node.usesMatrix = true;
        node.matrix = checkAffine(source.matrix.data(), user);
    }
    if (checkNumbers(source.translation, 3, "translation", user))
        node.translation = glm::make_vec3(source.translation.data());
    if (checkNumbers(source.scale, 3, "scale", user))
        node.scale = glm::make_vec3(source.scale.data());
    if (checkNumbers(source.rotation, 4, "rotation", user)) {
        const std::vector<double>& xyzw = source.rotation;
        const glm::dquat rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
        const double length = glm::length(rotation);
        if (length > 1e-12)
            node.rotation = rotation / length;
        else
            context.warn(fmt::format("{} has a rotation of length 0; identity is used", user));
    }
}

bool readFlag(const tinygltf::Value& extras, const char* key, bool otherwise) {
    if (!extras.IsObject() || !extras.Has(key) || !extras.Get(key).IsBool()) return otherwise;
    return extras.Get(key).Get<bool>();
}

Node loadNode(LoadContext& context, const tinygltf::Node& source, const std::string& user) {
    const tinygltf::Model& model = context.model;
    Node node;
    node.name = source.name;
    loadTransform(context, source, node, user);
    if (source.mesh >= 0) checkIndex(source.mesh, model.meshes.size(), user, "mesh");
    if (source.skin >= 0) checkIndex(source.skin, model.skins.size(), user, "skin");
    if (source.camera >= 0) checkIndex(source.camera, model.cameras.size(), user, "camera");
    node.mesh = std::max(source.mesh, -1);
    node.skin = node.mesh < 0 ? -1 : std::max(source.skin, -1);
    if (!source.weights.empty()) {
        const std::size_t targets =
            node.mesh < 0 ? 0 : context.targetsPerMesh[static_cast<std::size_t>(node.mesh)];
        checkNumbers(source.weights, targets, "list of morph weights", user);
        node.weights.assign(source.weights.begin(), source.weights.end());
    }
    node.castShadow = readFlag(source.extras, "castShadow", true);
    node.receiveShadow = readFlag(source.extras, "receiveShadow", true);
    return node;
}

/// Nodes below `roots`, parents first. Each node has one parent at most, so none comes twice.
std::vector<int> collectBelow(const tinygltf::Model& model, std::vector<int> roots) {
    std::vector<int> order = std::move(roots);
    for (std::size_t next = 0; next < order.size(); ++next) {
        const auto& children = model.nodes[static_cast<std::size_t>(order[next])].children;
        order.insert(order.end(), children.begin(), children.end());
    }
    return order;
}

void linkParents(LoadContext& context) {
    const tinygltf::Model& model = context.model;
    std::vector<Node>& nodes = context.scene.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (const int child : model.nodes[i].children) {
            checkIndex(child, nodes.size(), describe("node", i, nodes[i].name), "node");
            int& parent = nodes[static_cast<std::size_t>(child)].parent;
            require(parent < 0, "node {} is a child of both node {} and node {}", child, parent, i);
            parent = static_cast<int>(i);
        }
    std::vector<int> roots;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].parent < 0) roots.push_back(static_cast<int>(i));
    std::vector<bool> reached(nodes.size(), false);
    for (const int node : collectBelow(model, std::move(roots)))
        reached[static_cast<std::size_t>(node)] = true;
    const auto lost = std::find(reached.begin(), reached.end(), false);
    require(lost == reached.end(), "node {} is its own ancestor", lost - reached.begin());
}

/// The default scene's roots, else scene 0's, else all roots.
std::vector<int> chooseRoots(const LoadContext& context) {
    const tinygltf::Model& model = context.model;
    const std::vector<Node>& nodes = context.scene.nodes;
    std::vector<int> roots;
    if (model.defaultScene >= 0 || !model.scenes.empty()) {
        const int chosen = std::max(model.defaultScene, 0);
        checkIndex(chosen, model.scenes.size(), "the property 'scene'", "scene");
        roots = model.scenes[static_cast<std::size_t>(chosen)].nodes;
        std::vector<bool> listed(nodes.size(), false);
        for (const int root : roots) {
            const std::string user = fmt::format("scene {}", chosen);
            checkIndex(root, nodes.size(), user, "node");
            const auto at = static_cast<std::size_t>(root);
            require(nodes[at].parent < 0 && !listed[at],
                    "{} lists node {} twice or as a child of another; it must list roots", user,
                    root);
            listed[at] = true;
        }
        return roots;
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].parent < 0) roots.push_back(static_cast<int>(i));
    return roots;
}

Skin loadSkin(LoadContext& context, const tinygltf::Skin& source, const std::string& user) {
    require(!source.joints.empty(), "{} has no joints", user);
    Skin skin;
    for (const int joint : source.joints) {
        checkIndex(joint, context.scene.nodes.size(), user, "joint node");
        skin.joints.push_back(joint);
    }
    skin.jointFromMesh.assign(skin.joints.size(), glm::dmat4(1));
    if (source.inverseBindMatrices < 0) return skin;
    const std::string what = user + " inverseBindMatrices";
    const std::vector<float> flat = readFloats(context, source.inverseBindMatrices, 16, what);
    require(flat.size() / 16 >= skin.joints.size(), "{} has {} matrices for {} joints", what,
            flat.size() / 16, skin.joints.size());
    for (std::size_t joint = 0; joint < skin.joints.size(); ++joint) {
        std::array<double, 16> values{};
        std::copy_n(flat.begin() + static_cast<std::ptrdiff_t>(16 * joint), 16, values.begin());
        skin.jointFromMesh[joint] = checkAffine(values.data(), fmt::format("{} {}", what, joint));
    }
    return skin;
}

}  // namespace

void loadNodes(LoadContext& context) {
    for (std::size_t i = 0; i < context.model.nodes.size(); ++i) {
        const tinygltf::Node& source = context.model.nodes[i];
        context.scene.nodes.push_back(loadNode(context, source, describe("node", i, source.name)));
    }
    linkParents(context);
    context.scene.order = collectBelow(context.model, chooseRoots(context));
}

void loadSkins(LoadContext& context) {
    Scene& scene = context.scene;
    for (std::size_t i = 0; i < context.model.skins.size(); ++i) {
        const tinygltf::Skin& source = context.model.skins[i];
        scene.skins.push_back(loadSkin(context, source, describe("skin", i, source.name)));
    }
    std::vector<bool> posed(scene.nodes.size(), false);
    for (const int node : scene.order) posed[static_cast<std::size_t>(node)] = true;
    std::vector<bool> checked(scene.skins.size(), false);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.skin < 0) continue;
        const auto skin = static_cast<std::size_t>(node.skin);
        const std::size_t jointCount = scene.skins[skin].joints.size();
        const int largest = context.largestJoint[static_cast<std::size_t>(node.mesh)];
        require(largest < static_cast<int>(jointCount),
                "{} has a mesh that follows joint {}, but its skin {} has {} joints",
                describe("node", i, node.name), largest, skin, jointCount);
        if (!posed[i] || checked[skin]) continue;
        checked[skin] = true;
        for (const int joint : scene.skins[skin].joints)
            if (!posed[static_cast<std::size_t>(joint)])
                context.warn(fmt::format("skin {} has joints outside of the scene", skin));
    }
}

}  // namespace penumbra::scene
