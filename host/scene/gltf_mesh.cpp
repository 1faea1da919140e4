// SPDX-License-Identifier: MIT
// Meshes: attributes, indices and morph targets of every primitive, decoded to float and 32-bit
// indices. A Primitive owns its arrays, so accessors that several primitives share are decoded for
// each.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/scene/gltf_accessor.h"
#include "host/scene/gltf_context.h"
#include "host/scene/gltf_primitive.h"

namespace penumbra::scene {

namespace {

using Attributes = std::map<std::string, int>;

/// One attribute as vectors of the length of the positions; empty if absent.
template <typename Vector>
std::vector<Vector> readAttribute(LoadContext& context, const Attributes& attributes,
                                  const std::string& name, std::size_t vertexCount,
                                  const std::string& user) {
    const auto found = attributes.find(name);
    if (found == attributes.end()) return {};
    const std::string what = user + " " + name;
    std::vector<Vector> vectors = readVectors<Vector>(context, found->second, what);
    require(vectors.size() == vertexCount, "{} has {} elements, but POSITION has {}", what,
            vectors.size(), vertexCount);
    return vectors;
}

std::vector<glm::vec4> readColors(LoadContext& context, const Attributes& attributes,
                                  std::size_t vertexCount, const std::string& user) {
    const auto found = attributes.find("COLOR_0");
    if (found == attributes.end()) return {};
    if (componentCount(context, found->second, user + " COLOR_0") == 4)
        return readAttribute<glm::vec4>(context, attributes, "COLOR_0", vertexCount, user);
    const auto opaque = readAttribute<glm::vec3>(context, attributes, "COLOR_0", vertexCount, user);
    std::vector<glm::vec4> colors(opaque.size());
    std::transform(opaque.begin(), opaque.end(), colors.begin(),
                   [](const glm::vec3& color) { return glm::vec4(color, 1); });
    return colors;
}

/// JOINTS_n and WEIGHTS_n into half n of the eight influences.
void readInfluences(LoadContext& context, const Attributes& attributes, Primitive& primitive,
                    const std::string& user) {
    const std::size_t vertexCount = primitive.positions.size();
    for (std::size_t set = 0; set < 2; ++set) {
        const std::string suffix = std::to_string(set);
        const auto joints = attributes.find("JOINTS_" + suffix);
        require((joints == attributes.end()) == (attributes.count("WEIGHTS_" + suffix) == 0),
                "{} has only one of JOINTS_{} and WEIGHTS_{}; both or neither are needed", user,
                set, set);
        if (joints == attributes.end()) continue;
        const auto values =
            readIntegers(context, joints->second, 4, fmt::format("{} JOINTS_{}", user, set));
        const auto weights =
            readAttribute<glm::vec4>(context, attributes, "WEIGHTS_" + suffix, vertexCount, user);
        require(values.size() == 4 * vertexCount,
                "{} JOINTS_{} has {} elements, but POSITION has {}", user, set, values.size() / 4,
                vertexCount);
        context.charge(vertexCount, 48, user + " JOINTS");
        primitive.joints.resize(vertexCount);
        primitive.weights.resize(vertexCount);
        for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
            for (std::size_t i = 0; i < 4; ++i) {
                const std::uint32_t joint = values[4 * vertex + i];
                require(joint <= 0xFFFF, "{} JOINTS_{} has the joint {}; 16 bits are allowed", user,
                        set, joint);
                primitive.joints[vertex][4 * set + i] = static_cast<std::uint16_t>(joint);
                primitive.weights[vertex][4 * set + i] = weights[vertex][static_cast<int>(i)];
            }
    }
    const std::size_t bound = normalizeWeights(primitive);
    if (bound > 0)
        context.warn(fmt::format(
            "{}: {} vertices have no weights; they follow the skin's first joint", user, bound));
}

/// Integer normals and tangents are seldom of length 1 after decoding.
template <typename Vector>
void normalizeDirections(std::vector<Vector>& vectors) {
    for (Vector& vector : vectors) {
        const float length = glm::length(glm::vec3(vector));
        if (length > 0)
            for (int c = 0; c < 3; ++c) vector[c] /= length;
    }
}

void readAttributes(LoadContext& context, const Attributes& attributes, Primitive& primitive,
                    const std::string& user) {
    primitive.positions =
        readVectors<glm::vec3>(context, attributes.at("POSITION"), user + " POSITION");
    const std::size_t count = primitive.positions.size();
    primitive.normals = readAttribute<glm::vec3>(context, attributes, "NORMAL", count, user);
    primitive.tangents = readAttribute<glm::vec4>(context, attributes, "TANGENT", count, user);
    if (!primitive.normals.empty() && !holdsFloats(context, attributes.at("NORMAL")))
        normalizeDirections(primitive.normals);
    if (!primitive.tangents.empty() && !holdsFloats(context, attributes.at("TANGENT")))
        normalizeDirections(primitive.tangents);
    for (std::size_t set = 0; set < 2; ++set)
        primitive.uvs[set] = readAttribute<glm::vec2>(
            context, attributes, "TEXCOORD_" + std::to_string(set), count, user);
    primitive.colors = readColors(context, attributes, count, user);
    readInfluences(context, attributes, primitive, user);
    static const std::set<std::string> kRead = {"POSITION",   "NORMAL",   "TANGENT",  "TEXCOORD_0",
                                                "TEXCOORD_1", "COLOR_0",  "JOINTS_0", "JOINTS_1",
                                                "WEIGHTS_0",  "WEIGHTS_1"};
    for (const auto& [name, accessor] : attributes)
        if (kRead.count(name) == 0) context.warn(fmt::format("attribute {} is ignored", name));
}

void readTargets(LoadContext& context, const tinygltf::Primitive& source, Primitive& primitive,
                 const std::string& user) {
    const std::size_t count = primitive.positions.size();
    for (std::size_t i = 0; i < source.targets.size(); ++i) {
        const Attributes& attributes = source.targets[i];
        const std::string what = fmt::format("{} target {}", user, i);
        MorphTarget target;
        target.positions = readAttribute<glm::vec3>(context, attributes, "POSITION", count, what);
        target.normals = readAttribute<glm::vec3>(context, attributes, "NORMAL", count, what);
        target.tangents = readAttribute<glm::vec3>(context, attributes, "TANGENT", count, what);
        if (primitive.tangents.empty()) target.tangents.clear();
        for (const auto& [name, accessor] : attributes)
            if (name != "POSITION" && name != "NORMAL" && name != "TANGENT")
                context.warn(fmt::format("morph targets of {} are ignored", name));
        primitive.targets.push_back(std::move(target));
    }
}

void readIndices(LoadContext& context, const tinygltf::Primitive& source, Primitive& primitive,
                 Topology topology, const std::string& user) {
    const std::size_t vertexCount = primitive.positions.size();
    std::vector<std::uint32_t> corners;
    if (source.indices >= 0) {
        corners = readIntegers(context, source.indices, 1, user + " indices");
        const std::uint32_t largest = *std::max_element(corners.begin(), corners.end());
        require(largest < vertexCount, "{} has the index {}, but {} vertices", user, largest,
                vertexCount);
    } else {
        require(vertexCount <= 0xFFFFFFFFU, "{} has {} vertices; 32-bit indices are used", user,
                vertexCount);
        context.charge(vertexCount, sizeof(std::uint32_t), user + " without indices");
        corners.resize(vertexCount);
        std::iota(corners.begin(), corners.end(), 0U);
    }
    if (topology == Topology::triangles && corners.size() % 3 != 0)
        context.warn(fmt::format("{}: the last {} of {} corners make no triangle", user,
                                 corners.size() % 3, corners.size()));
    if (topology != Topology::triangles)
        context.charge(corners.size(), 3 * sizeof(std::uint32_t), user + " indices");
    primitive.indices = triangulate(std::move(corners), topology);
}

int chooseMaterial(LoadContext& context, int material, const std::string& user) {
    if (material >= 0) {
        checkIndex(material, context.model.materials.size(), user, "material");
        return material;
    }
    if (context.defaultMaterial < 0) {
        context.defaultMaterial = static_cast<int>(context.scene.materials.size());
        context.scene.materials.emplace_back().name = "default";
    }
    return context.defaultMaterial;
}

/// False, with a warning, where there is nothing to draw.
bool isDrawn(LoadContext& context, const tinygltf::Primitive& source, const std::string& user) {
    require(source.mode >= TINYGLTF_MODE_POINTS && source.mode <= TINYGLTF_MODE_TRIANGLE_FAN,
            "{} has mode {}; allowed are 0 to 6", user, source.mode);
    if (source.mode == TINYGLTF_MODE_POINTS) context.warn("primitives of points are ignored");
    if (source.mode > TINYGLTF_MODE_POINTS && source.mode < TINYGLTF_MODE_TRIANGLES)
        context.warn("primitives of lines are ignored");
    if (source.mode < TINYGLTF_MODE_TRIANGLES) return false;
    if (source.attributes.count("POSITION") == 0) {
        context.warn(fmt::format("{} has no POSITION and is ignored", user));
        return false;
    }
    return true;
}

Primitive loadPrimitive(LoadContext& context, const tinygltf::Primitive& source,
                        const std::string& user) {
    Primitive primitive;
    primitive.material = chooseMaterial(context, source.material, user);
    readAttributes(context, source.attributes, primitive, user);
    readTargets(context, source, primitive, user);
    const Topology topology = source.mode == TINYGLTF_MODE_TRIANGLES        ? Topology::triangles
                              : source.mode == TINYGLTF_MODE_TRIANGLE_STRIP ? Topology::strip
                                                                            : Topology::fan;
    readIndices(context, source, primitive, topology, user);
    if (primitive.normals.empty()) {
        context.charge(primitive.indices.size(), vertexBytes(primitive), user + " flat normals");
        makeFlatNormals(primitive);
    }
    return primitive;
}

void loadDefaultWeights(LoadContext& context, const tinygltf::Mesh& source, Mesh& mesh,
                        const std::string& user) {
    const std::size_t targets = source.primitives.empty() ? 0 : source.primitives[0].targets.size();
    for (const tinygltf::Primitive& primitive : source.primitives)
        require(primitive.targets.size() == targets,
                "{} has primitives with {} and {} morph targets; they must agree", user, targets,
                primitive.targets.size());
    require(source.weights.empty() || source.weights.size() == targets,
            "{} has {} weights for {} morph targets", user, source.weights.size(), targets);
    mesh.weights.assign(source.weights.begin(), source.weights.end());
    for (const float weight : mesh.weights)
        require(std::isfinite(weight), "{} has a morph weight that is not finite", user);
    mesh.weights.resize(targets, 0.0F);
    context.targetsPerMesh.push_back(targets);
}

}  // namespace

void loadMeshes(LoadContext& context) {
    for (std::size_t i = 0; i < context.model.meshes.size(); ++i) {
        const tinygltf::Mesh& source = context.model.meshes[i];
        const std::string user = describe("mesh", i, source.name);
        Mesh& mesh = context.scene.meshes.emplace_back();
        mesh.name = source.name;
        loadDefaultWeights(context, source, mesh, user);
        int largestJoint = -1;
        for (std::size_t p = 0; p < source.primitives.size(); ++p) {
            const std::string primitiveUser = fmt::format("{} primitive {}", user, p);
            if (!isDrawn(context, source.primitives[p], primitiveUser)) continue;
            Primitive primitive = loadPrimitive(context, source.primitives[p], primitiveUser);
            if (primitive.indices.empty()) {
                context.warn(fmt::format("{} has no triangles and is ignored", primitiveUser));
                continue;
            }
            if (!hasArea(primitive))
                context.warn(fmt::format("{}: none of its {} triangles has an area", primitiveUser,
                                         primitive.indices.size() / 3));
            mesh.primitives.push_back(std::move(primitive));
            for (const auto& joints : mesh.primitives.back().joints)
                largestJoint =
                    std::max<int>(largestJoint, *std::max_element(joints.begin(), joints.end()));
        }
        context.largestJoint.push_back(largestJoint);
    }
}

}  // namespace penumbra::scene
