// SPDX-License-Identifier: MIT
// glTF structure: one buffer, one bufferView per accessor, each aligned to four bytes.
#include "make_scene_gltf.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace tools {

using nlohmann::json;

namespace {

// Constants of glTF 2.0.
constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kNoTarget = 0;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr uint32_t kBinaryChunk = 0x004E4942;

int lastOf(const json& array) {
    return static_cast<int>(array.size()) - 1;
}

}  // namespace

json toJson(const glm::vec3& v) {
    return json::array({v.x, v.y, v.z});
}
json toJson(const glm::quat& q) {
    return json::array({q.x, q.y, q.z, q.w});
}

GltfWriter::GltfWriter() {
    document_["asset"] = {{"version", "2.0"}, {"generator", "penumbra make_scene"}};
    for (const char* list : {"accessors", "bufferViews", "materials", "meshes", "nodes"}) {
        document_[list] = json::array();
    }
}

int GltfWriter::addMaterial(std::string_view name, const glm::vec3& baseColor, float roughness) {
    document_["materials"].push_back(
        {{"name", name},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {baseColor.x, baseColor.y, baseColor.z, 1}},
           {"metallicFactor", 0},
           {"roughnessFactor", roughness}}}});
    return lastOf(document_["materials"]);
}

template <typename Element>
int GltfWriter::addAccessor(const std::vector<Element>& elements, int componentType,
                            std::string_view type, int target) {
    while (binary_.size() % 4 != 0) binary_.push_back(0);
    const size_t offset = binary_.size();
    const size_t sizeBytes = elements.size() * sizeof(Element);
    const auto* bytes = reinterpret_cast<const uint8_t*>(elements.data());
    binary_.insert(binary_.end(), bytes, bytes + sizeBytes);
    json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", sizeBytes}};
    if (target != kNoTarget) view["target"] = target;
    document_["bufferViews"].push_back(view);
    document_["accessors"].push_back({{"bufferView", lastOf(document_["bufferViews"])},
                                      {"componentType", componentType},
                                      {"count", elements.size()},
                                      {"type", type}});
    return lastOf(document_["accessors"]);
}

int GltfWriter::addTexture(const Picture& picture, bool repeats) {
    while (binary_.size() % 4 != 0) binary_.push_back(0);
    const std::vector<uint8_t> png = toPng(picture);
    document_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", png.size()}});
    binary_.insert(binary_.end(), png.begin(), png.end());
    document_["images"].push_back(
        {{"bufferView", lastOf(document_["bufferViews"])}, {"mimeType", "image/png"}});
    const int wrap = repeats ? 10497 : 33071;
    document_["samplers"].push_back({{"wrapS", wrap}, {"wrapT", wrap}});
    document_["textures"].push_back(
        {{"source", lastOf(document_["images"])}, {"sampler", lastOf(document_["samplers"])}});
    return lastOf(document_["textures"]);
}

int GltfWriter::addIndices(const std::vector<uint32_t>& indices, size_t vertexCount) {
    if (vertexCount > 65535)
        return addAccessor(indices, kUnsignedInt, "SCALAR", kElementArrayBuffer);
    const std::vector<uint16_t> narrow(indices.begin(), indices.end());
    return addAccessor(narrow, kUnsignedShort, "SCALAR", kElementArrayBuffer);
}

json GltfWriter::addAttributes(const Mesh& mesh) {
    glm::vec3 low = mesh.positions.front();
    glm::vec3 high = low;
    for (const glm::vec3& position : mesh.positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    const int positions = addAccessor(mesh.positions, kFloat, "VEC3", kArrayBuffer);
    document_["accessors"][positions]["min"] = toJson(low);
    document_["accessors"][positions]["max"] = toJson(high);
    json attributes = {{"POSITION", positions},
                       {"NORMAL", addAccessor(mesh.normals, kFloat, "VEC3", kArrayBuffer)}};
    if (!mesh.uvs.empty())
        attributes["TEXCOORD_0"] = addAccessor(mesh.uvs, kFloat, "VEC2", kArrayBuffer);
    return attributes;
}

int GltfWriter::addMesh(std::string_view name, const Mesh& mesh, int material) {
    const json attributes = addAttributes(mesh);
    const int indices = addIndices(mesh.indices, mesh.positions.size());
    const json primitive = {
        {"attributes", attributes}, {"indices", indices}, {"material", material}};
    document_["meshes"].push_back({{"name", name}, {"primitives", json::array({primitive})}});
    return lastOf(document_["meshes"]);
}

json GltfWriter::addSkinnedAttributes(const Mesh& mesh,
                                      const std::vector<std::array<uint8_t, 4>>& joints,
                                      const std::vector<std::array<uint16_t, 4>>& weights) {
    json attributes = addAttributes(mesh);
    attributes["JOINTS_0"] = addAccessor(joints, kUnsignedByte, "VEC4", kArrayBuffer);
    const int shares = addAccessor(weights, kUnsignedShort, "VEC4", kArrayBuffer);
    document_["accessors"][shares]["normalized"] = true;
    attributes["WEIGHTS_0"] = shares;
    return attributes;
}

FigureBuffers GltfWriter::addFigureBuffers(const Figure& figure) {
    FigureBuffers buffers;
    for (const auto& indices : figure.indicesOf) {
        Figure part;
        std::vector<uint32_t> numberOf(figure.skin.positions.size(), UINT32_MAX);
        for (const uint32_t vertex : indices) {
            uint32_t& number = numberOf[vertex];
            if (number == UINT32_MAX) {
                number = static_cast<uint32_t>(part.skin.positions.size());
                part.skin.positions.push_back(figure.skin.positions[vertex]);
                part.skin.normals.push_back(figure.skin.normals[vertex]);
                part.joints.push_back(figure.joints[vertex]);
                part.weights.push_back(figure.weights[vertex]);
            }
            part.skin.indices.push_back(number);
        }
        buffers.attributes.push_back(addSkinnedAttributes(part.skin, part.joints, part.weights));
        buffers.indices.push_back(addIndices(part.skin.indices, part.skin.positions.size()));
    }
    return buffers;
}

int GltfWriter::addFigureMesh(std::string_view name, const Figure& figure) {
    const json attributes = addSkinnedAttributes(figure.skin, figure.joints, figure.weights);
    FigureBuffers buffers;
    for (const auto& indices : figure.indicesOf) {
        buffers.attributes.push_back(attributes);
        buffers.indices.push_back(addIndices(indices, figure.skin.positions.size()));
    }
    return addFigureMesh(name, buffers, figure.materials);
}

int GltfWriter::addFigureMesh(std::string_view name, const FigureBuffers& buffers,
                              const std::vector<FigureMaterial>& materials) {
    json primitives = json::array();
    for (size_t i = 0; i < materials.size(); ++i) {
        const FigureMaterial& look = materials[i];
        const int material = addMaterial(look.name, look.baseColor, look.roughness);
        primitives.push_back({{"attributes", buffers.attributes[i]},
                              {"indices", buffers.indices[i]},
                              {"material", material}});
    }
    document_["meshes"].push_back({{"name", name}, {"primitives", primitives}});
    return lastOf(document_["meshes"]);
}

int GltfWriter::addClothMesh(std::string_view name, const Cloth& cloth, int material) {
    const json attributes = addSkinnedAttributes(cloth.mesh, cloth.joints, cloth.weights);
    const int indices = addIndices(cloth.mesh.indices, cloth.mesh.positions.size());
    const json primitive = {
        {"attributes", attributes}, {"indices", indices}, {"material", material}};
    document_["meshes"].push_back({{"name", name}, {"primitives", json::array({primitive})}});
    return lastOf(document_["meshes"]);
}

int GltfWriter::addNode(json node) {
    document_["nodes"].push_back(std::move(node));
    return lastOf(document_["nodes"]);
}

void GltfWriter::addChild(int parent, int child) {
    document_["nodes"][parent]["children"].push_back(child);
}

int GltfWriter::addSkin(std::string_view name, int firstJointNode) {
    std::vector<glm::vec3> places;
    for (const JointInfo& joint : skeleton()) places.push_back(joint.restPosition);
    return addSkin(name, firstJointNode, places);
}

int GltfWriter::addSkin(std::string_view name, int firstJointNode,
                        const std::vector<glm::vec3>& places) {
    std::vector<glm::mat4> jointFromMesh;
    json joints = json::array();
    for (const glm::vec3& place : places) {
        glm::mat4 inverse(1);
        inverse[3] = glm::vec4(-place, 1);
        jointFromMesh.push_back(inverse);
        joints.push_back(firstJointNode + static_cast<int>(joints.size()));
    }
    const int matrices = addAccessor(jointFromMesh, kFloat, "MAT4", kNoTarget);
    document_["skins"].push_back({{"name", name},
                                  {"inverseBindMatrices", matrices},
                                  {"joints", joints},
                                  {"skeleton", firstJointNode}});
    return lastOf(document_["skins"]);
}

int GltfWriter::addAnimation(std::string_view name) {
    document_["animations"].push_back(
        {{"name", name}, {"samplers", json::array()}, {"channels", json::array()}});
    return lastOf(document_["animations"]);
}

int GltfWriter::addTimes(const std::vector<float>& timesSeconds) {
    const int times = addAccessor(timesSeconds, kFloat, "SCALAR", kNoTarget);
    document_["accessors"][times]["min"] = {timesSeconds.front()};
    document_["accessors"][times]["max"] = {timesSeconds.back()};
    return times;
}

void GltfWriter::addChannel(int animation, int times, int output, int node, std::string_view path) {
    json& target = document_["animations"][animation];
    target["samplers"].push_back(
        {{"input", times}, {"interpolation", "LINEAR"}, {"output", output}});
    target["channels"].push_back(
        {{"sampler", lastOf(target["samplers"])}, {"target", {{"node", node}, {"path", path}}}});
}

int GltfWriter::addRotations(const std::vector<glm::quat>& rotations) {
    std::vector<glm::vec4> keys;  // x, y, z, w whatever glm's own order
    for (const glm::quat& q : rotations) keys.emplace_back(q.x, q.y, q.z, q.w);
    return addAccessor(keys, kFloat, "VEC4", kNoTarget);
}

void GltfWriter::animateFigure(int animation, const Clip& clip, int firstJointNode) {
    const int times = addTimes(clip.timesSeconds);
    addChannel(animation, times, addAccessor(clip.hipsTranslations, kFloat, "VEC3", kNoTarget),
               firstJointNode, "translation");
    for (int joint = 0; joint < kJointCount; ++joint)
        addChannel(animation, times, addRotations(clip.rotations[joint]), firstJointNode + joint,
                   "rotation");
}

void GltfWriter::animateNodes(int animation, const std::vector<float>& timesSeconds,
                              const std::vector<std::vector<glm::quat>>& rotations, int firstNode) {
    const int times = addTimes(timesSeconds);
    for (size_t i = 0; i < rotations.size(); ++i)
        addChannel(animation, times, addRotations(rotations[i]), firstNode + static_cast<int>(i),
                   "rotation");
}

void GltfWriter::animateTranslation(int animation, const std::vector<float>& timesSeconds,
                                    const std::vector<glm::vec3>& translations, int node) {
    const int times = addTimes(timesSeconds);
    addChannel(animation, times, addAccessor(translations, kFloat, "VEC3", kNoTarget), node,
               "translation");
}

size_t GltfWriter::write(const std::string& path) {
    while (binary_.size() % 4 != 0) binary_.push_back(0);
    document_["buffers"] = json::array({{{"byteLength", binary_.size()}}});
    std::string text = document_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto jsonBytes = static_cast<uint32_t>(text.size());
    const auto binaryBytes = static_cast<uint32_t>(binary_.size());
    const uint32_t totalBytes = 12 + 8 + jsonBytes + 8 + binaryBytes;
    std::ofstream file(path, std::ios::binary);
    // Words byte by byte; the buffer itself is copied, so this tool wants a little-endian machine.
    const auto writeWord = [&](uint32_t word) {
        for (unsigned shift = 0; shift < 32; shift += 8)
            file.put(static_cast<char>((word >> shift) & 0xFFU));
    };
    for (const uint32_t word : {kMagic, 2U, totalBytes, jsonBytes, kJsonChunk}) writeWord(word);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    writeWord(binaryBytes);
    writeWord(kBinaryChunk);
    file.write(reinterpret_cast<const char*>(binary_.data()),
               static_cast<std::streamsize>(binary_.size()));
    file.close();
    if (!file) throw std::runtime_error("cannot write '" + path + "'");
    return totalBytes;
}

}  // namespace tools
