// SPDX-License-Identifier: MIT
// Scenes that must be refused, each with its whole message: what was found, and what is allowed.
#include <cstddef>

#include "tests/scene/gltf_test_file.h"

namespace penumbra::scene {
namespace {

/// A scene over the accessors below. The message is what follows the file's name.
struct BadScene {
    const char* name;
    const char* accessor;  ///< text of accessor 6, where the row has one
    const char* rest;      ///< JSON beside the data
    const char* message;
};

/// 0 a triangle, 1 its indices, 2 indices of which one is past the end, 3 joints 0 and 1, 4 weights
/// of 0.5, 5 one matrix. View 0 has 36 bytes.
GltfTestFile fileWith(const BadScene& bad) {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");
    file.accessor<std::uint8_t>({0, 1, 2}, "SCALAR");
    file.accessor<std::uint8_t>({0, 1, 3}, "SCALAR");
    file.accessor<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4");
    file.accessor(std::vector<float>(12, 0.5F), "VEC4");
    file.accessor<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4");
    if (*bad.accessor != '\0') file.accessorText(bad.accessor);
    return file;
}

#define MESH(members) R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{)" members "}]}]"
#define POSITIONS(accessor) MESH(R"("attributes":{"POSITION":)" accessor "}")
#define VEC3 R"("componentType":5126,"type":"VEC3",)"

const BadScene kBadScenes[] = {
    // Accessors
    {"CountPastTheEnd", "{" VEC3 R"("bufferView":0,"count":4})", POSITIONS("6"),
     "accessor 6 (mesh 0 primitive 0 POSITION) has 4 elements of 12 bytes, 12 apart "
     "from offset 0, which is more than the 36 bytes of its bufferView"},
    {"OffsetPastTheEnd", "{" VEC3 R"("bufferView":0,"byteOffset":4,"count":3})", POSITIONS("6"),
     "accessor 6 (mesh 0 primitive 0 POSITION) has 3 elements of 12 bytes, 12 apart "
     "from offset 4, which is more than the 36 bytes of its bufferView"},
    {"OffsetNearTwoToThe31", "{" VEC3 R"("bufferView":0,"byteOffset":2147483647,"count":1})",
     POSITIONS("6"),
     "accessor 6 (mesh 0 primitive 0 POSITION) has 1 elements of 12 bytes, 12 apart "
     "from offset 2147483647, which is more than the 36 bytes of its bufferView"},
    {"CountTimesStrideBeyondTwoToThe32", "{" VEC3 R"("bufferView":0,"count":2147483647})",
     POSITIONS("6"),
     "accessor 6 (mesh 0 primitive 0 POSITION) has 2147483647 elements of 12 bytes, 12 "
     "apart from offset 0, which is more than the 36 bytes of its bufferView"},
    {"NoElements", "{" VEC3 R"("bufferView":0,"count":0})", POSITIONS("6"),
     "accessor 6 (mesh 0 primitive 0 POSITION) has no elements"},
    {"NoSuchBufferView", "{" VEC3 R"("bufferView":9,"count":3})", POSITIONS("6"),
     "accessor 6 (mesh 0 primitive 0 POSITION) refers to bufferView 9, but the file "
     "has 6 of them, counted from 0"},
    {"NoSuchAccessor", "", POSITIONS("77"),
     "mesh 0 primitive 0 POSITION refers to accessor 77, but the file has 6 of them, "
     "counted from 0"},
    {"ABillionZeros", "{" VEC3 R"("count":1000000000})", POSITIONS("6"),
     "accessor 6 (mesh 0 primitive 0 POSITION) has 1000000000 elements of 12 bytes, "
     "and no bufferView that holds them; all such zeros together may take 256 MiB of "
     "memory"},
    {"AsManyZerosAsFitInAnInt", "{" VEC3 R"("count":2147483647})", POSITIONS("6"),
     "accessor 6 (mesh 0 primitive 0 POSITION) has 2147483647 elements of 12 bytes, "
     "and no bufferView that holds them; all such zeros together may take 256 MiB of "
     "memory"},
    {"PositionsOfTwoComponents", R"({"componentType":5126,"type":"VEC2","bufferView":0,"count":3})",
     POSITIONS("6"),
     "accessor 6 (mesh 0 primitive 0 POSITION) has 2 components per element; 3 are needed"},
    {"PositionsOfWideIntegers", R"({"componentType":5125,"type":"VEC3","bufferView":0,"count":3})",
     POSITIONS("6"),
     "accessor 6 (mesh 0 primitive 0 POSITION) has componentType 5125 (32-bit "
     "integers); only indices may have that"},
    {"PositionsOfMatrices", R"({"componentType":5126,"type":"MAT3","bufferView":0,"count":1})",
     POSITIONS("6"),
     "accessor 6 (mesh 0 primitive 0 POSITION) holds 2x2 or 3x3 matrices; nothing in a "
     "scene uses these"},
    {"UnknownComponentType", R"({"componentType":9999,"type":"VEC3","bufferView":0,"count":1})",
     POSITIONS("6"), "is not valid: Invalid `componentType` in accessor. Got 9999"},
    // Primitives
    {"IndexPastTheEnd", "", MESH(R"("attributes":{"POSITION":0},"indices":2)"),
     "mesh 0 primitive 0 has the index 3, but 3 vertices"},
    {"IndicesThatAreFloats", "", MESH(R"("attributes":{"POSITION":0},"indices":0)"),
     "accessor 0 (mesh 0 primitive 0 indices) has 3 components per element; 1 are needed"},
    {"JointsWithoutWeights", "", MESH(R"("attributes":{"POSITION":0,"JOINTS_0":3})"),
     "mesh 0 primitive 0 has only one of JOINTS_0 and WEIGHTS_0; both or neither are needed"},
    {"NoSuchMaterial", "", MESH(R"("attributes":{"POSITION":0},"material":0)"),
     "mesh 0 primitive 0 refers to material 0, but the file has 0 of them, counted from 0"},
    {"UnknownMode", "", MESH(R"("attributes":{"POSITION":0},"mode":7)"),
     "mesh 0 primitive 0 has mode 7; allowed are 0 to 6"},
    // Nodes and scenes
    {"NodeBelowItself", "", R"("nodes":[{"children":[0]}])", "node 0 is its own ancestor"},
    {"NodesInACycle", "", R"("nodes":[{},{"children":[2]},{"children":[1]}])",
     "node 1 is its own ancestor"},
    {"NodeOfTwoParents", "", R"("nodes":[{"children":[2]},{"children":[2]},{}])",
     "node 2 is a child of both node 0 and node 1"},
    {"NodeTwiceBelowOne", "", R"("nodes":[{"children":[1,1]},{}])",
     "node 1 is a child of both node 0 and node 0"},
    {"NoSuchChild", "", R"("nodes":[{"children":[4]}])",
     "node 0 refers to node 4, but the file has 1 of them, counted from 0"},
    {"NoSuchMesh", "", R"("nodes":[{"mesh":5}])",
     "node 0 refers to mesh 5, but the file has 0 of them, counted from 0"},
    {"NoSuchSkin", "", R"("nodes":[{"skin":5}])",
     "node 0 refers to skin 5, but the file has 0 of them, counted from 0"},
    {"NoSuchCamera", "", R"("nodes":[{"camera":5}])",
     "node 0 refers to camera 5, but the file has 0 of them, counted from 0"},
    {"NoSuchScene", "", R"("scenes":[{}],"scene":4)",
     "the property 'scene' refers to scene 4, but the file has 1 of them, counted from 0"},
    {"SceneOfAChild", "", R"("nodes":[{"children":[1]},{}],"scenes":[{"nodes":[1]}])",
     "scene 0 lists node 1 twice or as a child of another; it must list roots"},
    {"SceneOfNoSuchNode", "", R"("nodes":[{}],"scenes":[{"nodes":[3]}])",
     "scene 0 refers to node 3, but the file has 1 of them, counted from 0"},
    {"MatrixWithPerspective", "", R"("nodes":[{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0.5,0,0,0,1]}])",
     "node 0 has a matrix that ends in the row 0 0 0.5 1; 0 0 0 1 is needed"},
    {"MatrixBeyondFloats", "", R"("nodes":[{"matrix":[1e60,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}])",
     "node 0 has 1e+60 in its matrix; finite floats are needed"},
    {"MatrixOfFourNumbers", "", R"("nodes":[{"matrix":[1,0,0,0]}])",
     "node 0 has a matrix of 4 numbers; 16 are needed"},
    {"ScaleBeyondFloats", "", R"("nodes":[{"scale":[1,1e300,1]}])",
     "node 0 has 1e+300 in its scale; finite floats are needed"},
    // Skins
    {"SkinWithoutJoints", "", R"("nodes":[{}],"skins":[{"joints":[]}])", "skin 0 has no joints"},
    {"NoSuchJoint", "", R"("nodes":[{}],"skins":[{"joints":[6]}])",
     "skin 0 refers to joint node 6, but the file has 1 of them, counted from 0"},
    {"FewerMatricesThanJoints", "",
     R"("nodes":[{},{}],"skins":[{"inverseBindMatrices":5,"joints":[0,1]}])",
     "skin 0 inverseBindMatrices has 1 matrices for 2 joints"},
    {"VerticesOfAJointThatTheSkinLacks", "",
     R"("nodes":[{"mesh":0,"skin":0}],"skins":[{"joints":[0]}],)"
     R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":3,"WEIGHTS_0":4}}]}])",
     "node 0 has a mesh that follows joint 1, but its skin 0 has 1 joints"},
    // Types of values
    {"NodesThatAreANumber", "", R"("nodes":5)",
     R"(the JSON has a number as "nodes"; an array is needed)"},
    {"NodesThatAreAnObject", "", R"("nodes":{})",
     R"(the JSON has an object as "nodes"; an array is needed)"},
    {"NodesOfStrings", "", R"("nodes":["a"])",
     R"(the JSON has a string in "nodes"; an object or a whole number is needed)"},
    {"MeshThatIsAString", "", R"("nodes":[{"mesh":"0"}])",
     R"(the JSON has a string as "mesh"; a whole number is needed)"},
    {"MeshThatIsNegative", "", R"("nodes":[{"mesh":-1}])",
     R"(the JSON has "mesh": -1; it must be a whole number from 0 to 2147483647)"},
    {"MeshThatIsNull", "", R"("nodes":[{"mesh":null}])",
     R"(the JSON has null as "mesh"; a whole number is needed)"},
    {"ChildrenThatAreFractions", "", R"("nodes":[{"children":[1.5]},{}])",
     R"(the JSON has "children": 1.5; it must be a whole number from 0 to 2147483647)"},
    {"TranslationThatIsAString", "", R"("nodes":[{"translation":"up"}])",
     R"(the JSON has a string as "translation"; an array is needed)"},
    {"TranslationOfStrings", "", R"("nodes":[{"translation":["1","2","3"]}])",
     R"(the JSON has a string in "translation"; a number is needed)"},
    {"NameThatIsANumber", "", R"("nodes":[{"name":5}])",
     R"(the JSON has a number as "name"; a string is needed)"},
    {"PrimitivesThatAreANumber", "", R"("meshes":[{"primitives":5}])",
     R"(the JSON has a number as "primitives"; an array is needed)"},
    {"AttributeThatIsAnObject", "", MESH(R"("attributes":{"POSITION":{}})"),
     R"(the JSON has an object as "POSITION"; a whole number is needed)"},
    {"DoubleSidedThatIsANumber", "", R"("materials":[{"doubleSided":1}])",
     R"(the JSON has a number as "doubleSided"; a boolean is needed)"},
    {"NestedArraysOfMeshes", "", R"("meshes":[[]])",
     R"(the JSON has an array in "meshes"; an object is needed)"},
    // Values
    {"BaseColourAboveOne", "",
     R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[2,0,0,1]}}])",
     "material 0 has baseColorFactor = 2; allowed are 0 to 1"},
    {"UnknownAlphaMode", "", R"("materials":[{"alphaMode":"GLASS"}])",
     R"(material 0 has alphaMode "GLASS"; allowed are OPAQUE, MASK, BLEND)"},
    {"CameraOfNoWidth", "",
     R"("nodes":[{"camera":0}],"cameras":[{"type":"perspective","perspective":{"yfov":0,"znear":1}}])",
     "camera 0 has yfov 0, aspectRatio 0, znear 1, zfar 0; needed are 0 < yfov < pi, "
     "aspectRatio >= 0 and 0 < znear < zfar"},
    {"LightThatIsNotThere", "", R"("nodes":[{"extensions":{"KHR_lights_punctual":{"light":2}}}])",
     "node 0 refers to punctual light 2, but the file has 0 of them, counted from 0"},
    {"RequiredExtension", "", R"("extensionsRequired":["VENDOR_unheard_of"])",
     "requires the extension VENDOR_unheard_of, which is not supported; supported are "
     "EXT_lights_area, KHR_lights_punctual, KHR_materials_emissive_strength, "
     "KHR_materials_transmission, KHR_materials_unlit, KHR_mesh_quantization, "
     "KHR_texture_transform"},
};

class BadSceneTest : public testing::TestWithParam<BadScene> {};

TEST_P(BadSceneTest, IsRefusedWithItsMessage) {
    const BadScene& bad = GetParam();
    const std::string message = messageOf([&] { fileWith(bad).load(bad.rest); });
    EXPECT_EQ(message, std::string("test.glb: ") + bad.message);
}

INSTANTIATE_TEST_SUITE_P(All, BadSceneTest, testing::ValuesIn(kBadScenes),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace penumbra::scene
