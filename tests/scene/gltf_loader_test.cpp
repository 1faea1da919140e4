// SPDX-License-Identifier: MIT
// The glTF loader's geometry: accessors, primitives, nodes, skins, morph targets, scenes.
// Materials and images, lights and cameras, and malformed files have test files of their own.
#include <cmath>
#include <limits>

#include "host/scene/animation.h"
#include "tests/scene/gltf_test_file.h"

namespace penumbra::scene {
namespace {

using Indices = std::vector<std::uint32_t>;
using glm::vec2;
using glm::vec3;
using glm::vec4;

TEST(GltfLoaderTest, TrianglesComeWithPositionsNormalsAndUvs) {
    GltfTestFile file;
    const int position = file.accessor(rightTriangle(), "VEC3");
    const int normal = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int uv0 = file.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    const int uv1 =
        file.accessor<std::uint8_t>({0, 0, 255, 0, 0, 51}, "VEC2", R"("normalized":true)");
    const Primitive primitive = file.loadPrimitive(
        fmt::format(R"("attributes":{{"POSITION":{},"NORMAL":{},"TEXCOORD_0":{},"TEXCOORD_1":{}}})",
                    position, normal, uv0, uv1));
    EXPECT_EQ(primitive.positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(primitive.normals, std::vector<vec3>(3, {0, 0, 1}));
    EXPECT_EQ(primitive.uvs[0], (std::vector<vec2>{{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_EQ(primitive.uvs[1][2], vec2(0, 0.2F));
    EXPECT_EQ(primitive.indices, (Indices{0, 1, 2}));
    EXPECT_TRUE(primitive.tangents.empty() && primitive.colors.empty() && primitive.joints.empty());
}

template <typename Index>
Indices loadIndices(int mode, const std::vector<Index>& indices) {
    GltfTestFile file;
    std::vector<float> positions, normals;
    for (int i = 0; i < 5; ++i) positions.insert(positions.end(), {float(i), float(i % 2), 0});
    for (int i = 0; i < 5; ++i) normals.insert(normals.end(), {0, 0, 1});
    const int position = file.accessor(positions, "VEC3");
    const int normal = file.accessor(normals, "VEC3");
    const std::string indexText =
        indices.empty() ? "" : fmt::format(R"(,"indices":{})", file.accessor(indices, "SCALAR"));
    return file
        .loadPrimitive(fmt::format(R"("mode":{},"attributes":{{"POSITION":{},"NORMAL":{}}}{})",
                                   mode, position, normal, indexText))
        .indices;
}

TEST(GltfLoaderTest, IndicesOfAllWidthsAreRead) {
    EXPECT_EQ(loadIndices<std::uint8_t>(4, {2, 1, 0, 4, 3, 2}), (Indices{2, 1, 0, 4, 3, 2}));
    EXPECT_EQ(loadIndices<std::uint16_t>(4, {2, 1, 0, 4, 3, 2}), (Indices{2, 1, 0, 4, 3, 2}));
    EXPECT_EQ(loadIndices<std::uint32_t>(4, {2, 1, 0, 4, 3, 2}), (Indices{2, 1, 0, 4, 3, 2}));
}

TEST(GltfLoaderTest, StripsAndFansKeepTheirWinding) {
    EXPECT_EQ(loadIndices<std::uint8_t>(5, {}), (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    EXPECT_EQ(loadIndices<std::uint8_t>(5, {4, 3, 2, 1}), (Indices{4, 3, 2, 3, 1, 2}));
    EXPECT_EQ(loadIndices<std::uint8_t>(6, {}), (Indices{1, 2, 0, 2, 3, 0, 3, 4, 0}));
    EXPECT_EQ(loadIndices<std::uint8_t>(6, {4, 3, 2, 1}), (Indices{3, 2, 4, 2, 1, 4}));
}

TEST(GltfLoaderTest, CornersLeftOverAreDropped) {
    EXPECT_EQ(loadIndices<std::uint8_t>(4, {0, 1, 2, 3}), (Indices{0, 1, 2}));
}

TEST(GltfLoaderTest, PrimitivesWithoutTrianglesAreNamedAndIgnored) {
    GltfTestFile file;
    file.accessor<float>({0, 0, 0, 1, 0, 0}, "VEC3");
    const Scene scene = file.load(GltfTestFile::meshOf(R"("attributes":{"POSITION":0})"));
    EXPECT_TRUE(scene.meshes.at(0).primitives.empty());
    EXPECT_TRUE(warnsOnce(scene, "mesh 0 primitive 0 has no triangles"));
}

TEST(GltfLoaderTest, PointsAndLinesAreNamedOnceAndIgnored) {
    GltfTestFile file;
    const int position = file.accessor(rightTriangle(), "VEC3");
    std::string primitives;
    for (const int mode : {0, 0, 1, 2, 3, 4})
        primitives += fmt::format(R"({}{{"mode":{},"attributes":{{"POSITION":{}}}}})",
                                  primitives.empty() ? "" : ",", mode, position);
    const Scene scene = file.load(R"("meshes":[{"primitives":[)" + primitives + "]}]");
    EXPECT_EQ(scene.meshes.at(0).primitives.size(), 1U);
    EXPECT_TRUE(warnsOnce(scene, "points"));
    EXPECT_TRUE(warnsOnce(scene, "lines"));
}

TEST(GltfLoaderTest, InterleavedAttributesAreTakenApart) {
    GltfTestFile file;
    const int view = file.view<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0}, 24);
    for (const int offset : {0, 12})
        file.accessorText(fmt::format(
            R"({{"bufferView":{},"byteOffset":{},"componentType":5126,"count":3,"type":"VEC3"}})",
            view, offset));
    const Primitive primitive = file.loadPrimitive(R"("attributes":{"POSITION":0,"NORMAL":1})");
    EXPECT_EQ(primitive.positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(primitive.normals, (std::vector<vec3>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
}

std::string sparseText(GltfTestFile& file, const std::string& base, int count) {
    const int indices = file.view<std::uint16_t>({1, 2});
    const int values = file.view<float>({7, 8, 9, -1, -2, -3});
    return fmt::format(R"({{{}"componentType":5126,"count":{},"type":"VEC3","sparse":{{"count":2,)"
                       R"("indices":{{"bufferView":{},"componentType":5123}},)"
                       R"("values":{{"bufferView":{}}}}}}})",
                       base, count, indices, values);
}

TEST(GltfLoaderTest, SparseAccessorsReplaceTheirBase) {
    GltfTestFile file;
    const int view = file.view(rightTriangle());
    file.accessorText(sparseText(file, fmt::format(R"("bufferView":{},)", view), 3));
    const int index = file.accessor<std::uint8_t>({0, 1, 2}, "SCALAR");
    const int normal = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const Primitive primitive = file.loadPrimitive(
        fmt::format(R"("attributes":{{"POSITION":0,"NORMAL":{}}},"indices":{})", normal, index));
    EXPECT_EQ(primitive.positions, (std::vector<vec3>{{0, 0, 0}, {7, 8, 9}, {-1, -2, -3}}));
}

TEST(GltfLoaderTest, SparseAccessorsWithoutBaseReplaceZeros) {
    GltfTestFile file;
    file.accessorText(sparseText(file, "", 4));
    const int normal = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const Primitive primitive =
        file.loadPrimitive(fmt::format(R"("attributes":{{"POSITION":0,"NORMAL":{}}})", normal));
    EXPECT_EQ(primitive.positions,
              (std::vector<vec3>{{0, 0, 0}, {7, 8, 9}, {-1, -2, -3}, {0, 0, 0}}));
}

TEST(GltfLoaderTest, QuantizedPositionsAreIntegersOrShares) {
    GltfTestFile file;
    // Rows are padded to 4 and 8 bytes, as KHR_mesh_quantization asks
    const int bytes = file.view<std::int8_t>({-128, 127, 5, 0, 1, 2, 3, 0, -127, 0, 64, 0}, 4);
    const int shorts = file.view<std::uint16_t>({0, 65535, 13107, 0, 1, 2, 3, 0, 9, 9, 9, 0}, 8);
    const auto add = [&](int view, int type, bool normalized) {
        return file.accessorText(fmt::format(
            R"({{"bufferView":{},"componentType":{},"normalized":{},"count":3,"type":"VEC3"}})",
            view, type, normalized));
    };
    for (const auto& [view, type] : {std::pair{bytes, 5120}, std::pair{shorts, 5123}})
        for (const bool normalized : {false, true}) add(view, type, normalized);
    const auto positions = [&](int accessor) {
        return file.loadPrimitive(fmt::format(R"("attributes":{{"POSITION":{}}})", accessor))
            .positions;
    };
    EXPECT_EQ(positions(0)[0], vec3(-128, 127, 5));
    EXPECT_EQ(positions(1)[0], vec3(-1, 1, 5 / 127.0F));  // -128 and -127 are both -1
    EXPECT_EQ(positions(1)[2], vec3(-1, 0, 64 / 127.0F));
    EXPECT_EQ(positions(2)[0], vec3(0, 65535, 13107));
    EXPECT_EQ(positions(3)[0], vec3(0, 1, 0.2F));
}

TEST(GltfLoaderTest, QuantizedNormalsHaveLengthOne) {
    GltfTestFile file;
    const int position = file.accessor(rightTriangle(), "VEC3");
    const int view = file.view<std::int8_t>({90, 0, 90, 0, 0, 127, 0, 0, 0, 0, -127, 0}, 4);
    const int normal = file.accessorText(fmt::format(
        R"({{"bufferView":{},"componentType":5120,"normalized":true,"count":3,"type":"VEC3"}})",
        view));
    const Primitive primitive = file.loadPrimitive(
        fmt::format(R"("attributes":{{"POSITION":{},"NORMAL":{}}})", position, normal));
    EXPECT_NEAR(primitive.normals[0].x, std::sqrt(0.5F), 1e-6);
    EXPECT_NEAR(primitive.normals[0].z, std::sqrt(0.5F), 1e-6);
    EXPECT_EQ(primitive.normals[2], vec3(0, 0, -1));
}

TEST(GltfLoaderTest, ColorsOfThreeComponentsAreOpaque) {
    GltfTestFile file;
    const int position = file.accessor(rightTriangle(), "VEC3");
    const int rgb = file.accessor<float>({0, 0.25F, 1, 1, 1, 1, 0, 0, 0}, "VEC3");
    const int rgba = file.accessor<std::uint16_t>({65535, 0, 0, 13107, 0, 0, 0, 0, 0, 0, 0, 0},
                                                  "VEC4", R"("normalized":true)");
    const auto colors = [&](int accessor) {
        return file
            .loadPrimitive(
                fmt::format(R"("attributes":{{"POSITION":{},"COLOR_0":{}}})", position, accessor))
            .colors;
    };
    EXPECT_EQ(colors(rgb)[0], vec4(0, 0.25F, 1, 1));
    EXPECT_EQ(colors(rgba)[0], vec4(1, 0, 0, 0.2F));
}

TEST(GltfLoaderTest, MissingNormalsAreFlatAndUnshareTheVertices) {
    // Two triangles that share an edge and meet at a right angle; everything must follow the
    // corners
    GltfTestFile file;
    file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
    file.accessor<float>({0, 0, 1, 0, 2, 0, 3, 0}, "VEC2");
    file.accessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
    file.accessor<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0}, "VEC4");
    file.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    file.accessor<float>({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC3");
    file.accessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    const Primitive primitive = file.loadPrimitive(
        R"("attributes":{"POSITION":0,"TEXCOORD_0":1,"TANGENT":2,"JOINTS_0":3,"WEIGHTS_0":4},)"
        R"("targets":[{"POSITION":5}],"indices":6)");
    EXPECT_EQ(primitive.indices, (Indices{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(
        primitive.positions,
        (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(
        primitive.normals,
        (std::vector<vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}}));
    EXPECT_EQ(primitive.uvs[0][5], vec2(3, 0));
    EXPECT_EQ(primitive.joints[4][0], 2);
    EXPECT_EQ(primitive.weights.size(), 6U);
    EXPECT_TRUE(primitive.tangents.empty()) << "tangents mean nothing without normals";
    ASSERT_EQ(primitive.targets.size(), 1U);
    EXPECT_EQ(primitive.targets[0].positions[1], vec3(0, 0, 1));
    // The first triangle becomes (0,0,0), (1,0,1), (0,1,0), whose normal is (-1, 0, 1) / sqrt 2
    const vec3 moved = primitive.normals[0] + primitive.targets[0].normals[0];
    EXPECT_NEAR(glm::length(moved - vec3(-1, 0, 1) / std::sqrt(2.0F)), 0, 1e-6);
}

TEST(GltfLoaderTest, PositionsThatAreNotFiniteAreKept) {
    GltfTestFile file;
    std::vector<float> positions = rightTriangle();
    positions[3] = std::numeric_limits<float>::quiet_NaN();
    positions[7] = std::numeric_limits<float>::infinity();
    file.accessor(positions, "VEC3");
    const Primitive primitive = file.loadPrimitive(R"("attributes":{"POSITION":0})");
    EXPECT_TRUE(std::isnan(primitive.positions[1].x));
    EXPECT_TRUE(std::isinf(primitive.positions[2].y));
    EXPECT_EQ(primitive.normals[0], vec3(0, 1, 0));
}

TEST(GltfLoaderTest, MorphTargetsHaveTheirOwnAttributesAndDefaultWeights) {
    GltfTestFile file;
    const std::vector<float> ones(9, 1);
    file.accessor(rightTriangle(), "VEC3");
    file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    file.accessor(std::vector<float>(12, 1), "VEC4");
    file.accessor(ones, "VEC3");
    const std::string mesh =
        R"("meshes":[{"weights":[0.25,0.75],"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,)"
        R"("TANGENT":2},"targets":[{"POSITION":3},{"NORMAL":3,"TANGENT":3}]}]}],)";
    const Scene scene = file.load(mesh + R"("nodes":[{"mesh":0,"weights":[1,0]},{"mesh":0}])");
    const Primitive& primitive = scene.meshes[0].primitives[0];
    ASSERT_EQ(primitive.targets.size(), 2U);
    EXPECT_EQ(primitive.targets[0].positions, std::vector<vec3>(3, vec3(1)));
    EXPECT_TRUE(primitive.targets[0].normals.empty() && primitive.targets[1].positions.empty());
    EXPECT_EQ(primitive.targets[1].normals.size(), 3U);
    EXPECT_EQ(primitive.targets[1].tangents.size(), 3U);
    EXPECT_EQ(scene.meshes[0].weights, (std::vector<float>{0.25F, 0.75F}));
    EXPECT_EQ(scene.nodes[0].weights, (std::vector<float>{1, 0}));
    EXPECT_TRUE(scene.nodes[1].weights.empty());
}

/// A skinned triangle whose first vertex has these influences; 12 joints.
template <typename Joint, typename Weight>
Scene loadSkinned(std::vector<Joint> joints, std::vector<Weight> weights, bool second = false) {
    GltfTestFile file;
    joints.resize(12);
    weights.resize(12);
    weights[4] = weights[8] = 1;
    file.accessor(rightTriangle(), "VEC3");
    file.accessor(joints, "VEC4");
    file.accessor(weights, "VEC4", std::is_same_v<Weight, float> ? "" : R"("normalized":true)");
    std::string nodes = R"("nodes":[{"mesh":0,"skin":0})", list;
    for (int i = 1; i <= 12; ++i) nodes += ",{}", list += fmt::format("{}{}", i == 1 ? "" : ",", i);
    return file.load(nodes + R"(],"skins":[{"joints":[)" + list +
                     R"(]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,)" +
                     R"("WEIGHTS_0":2)" + (second ? R"(,"JOINTS_1":1,"WEIGHTS_1":2)" : "") +
                     "}}]}]");
}

TEST(GltfLoaderTest, WeightsOfAllTypesSumToOne) {
    const auto first = [](const Scene& scene) { return scene.meshes[0].primitives[0].weights[0]; };
    EXPECT_EQ(first(loadSkinned<std::uint8_t, float>({1, 2}, {1, 3})),
              (std::array<float, 8>{0.25F, 0.75F}));
    EXPECT_EQ(first(loadSkinned<std::uint16_t, std::uint8_t>({1, 2}, {64, 192})),
              (std::array<float, 8>{0.25F, 0.75F}));
    EXPECT_EQ(first(loadSkinned<std::uint8_t, std::uint16_t>({1, 2}, {100, 300})),
              (std::array<float, 8>{0.25F, 0.75F}));
    const Scene eight = loadSkinned<std::uint16_t, float>({3, 4}, {1, 3}, true);
    EXPECT_EQ(first(eight), (std::array<float, 8>{0.125F, 0.375F, 0, 0, 0.125F, 0.375F, 0, 0}));
    EXPECT_EQ(eight.meshes[0].primitives[0].joints[0],
              (std::array<std::uint16_t, 8>{3, 4, 0, 0, 3, 4, 0, 0}));
}

TEST(GltfLoaderTest, VerticesWithoutWeightsFollowTheFirstJoint) {
    const Scene scene = loadSkinned<std::uint8_t, float>({7, 8}, {0, -1});
    EXPECT_EQ(scene.meshes[0].primitives[0].weights[0], (std::array<float, 8>{1}));
    EXPECT_EQ(scene.meshes[0].primitives[0].joints[0], (std::array<std::uint16_t, 8>{0}));
    EXPECT_TRUE(warnsOnce(scene, "1 vertices have no weights"));
}

TEST(GltfLoaderTest, JointsMustBeInTheSkinUnlessTheyHaveNoWeight) {
    EXPECT_EQ(
        (loadSkinned<std::uint8_t, float>({1, 200}, {1, 0}).meshes[0].primitives[0].joints[0][1]),
        0);
    EXPECT_TRUE(contains(messageOf([] {
                             loadSkinned<std::uint8_t, float>({1, 12}, {1, 1});
                         }),
                         "follows joint 12, but its skin 0 has 12 joints"));
}

TEST(GltfLoaderTest, SkinsHaveInverseBindMatricesOrIdentity) {
    GltfTestFile file;
    file.accessor<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1}, "MAT4");
    file.accessor(rightTriangle(), "VEC3");
    const Scene scene =
        file.load(R"("skins":[{"joints":[2],"inverseBindMatrices":0},{"joints":[2,1]}],)"
                  R"("meshes":[{"primitives":[{"attributes":{"POSITION":1}}]}],)"
                  R"("nodes":[{"mesh":0,"skin":0},{"mesh":0,"skin":0},{"mesh":0,"skin":1}])");
    ASSERT_EQ(scene.skins.size(), 2U);
    EXPECT_EQ(scene.skins[0].jointFromMesh[0][3], glm::dvec4(4, 5, 6, 1));
    EXPECT_EQ(scene.skins[1].joints, (std::vector<int>{2, 1}));
    EXPECT_EQ(scene.skins[1].jointFromMesh, std::vector<glm::dmat4>(2, glm::dmat4(1)));
    EXPECT_EQ(scene.nodes[1].skin, 0) << "nodes may share a skin";
    EXPECT_TRUE(scene.meshes[0].primitives[0].joints.empty()) << "without JOINTS it is rigid";
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfLoaderTest, NodesKeepTheirHierarchyAndTransforms) {
    const Scene scene = GltfTestFile().load(
        R"("nodes":[{"name":"a","children":[2],"translation":[1,2,3],"rotation":[0,0,2,0],)"
        R"("scale":[-1,2,3],"extras":{"castShadow":false}},)"
        R"({"matrix":[2,0,0,0,0,2,0,0,0,0,2,0,7,8,9,1],"extras":{"receiveShadow":false}},{}])");
    ASSERT_EQ(scene.nodes.size(), 3U);
    EXPECT_EQ(scene.nodes[0].name, "a");
    EXPECT_EQ(scene.nodes[2].parent, 0);
    EXPECT_EQ(scene.nodes[0].scale, glm::dvec3(-1, 2, 3));
    EXPECT_EQ(scene.nodes[0].rotation, glm::dquat(0, 0, 0, 1)) << "made unit";
    EXPECT_TRUE(scene.nodes[1].usesMatrix);
    EXPECT_EQ(scene.nodes[1].matrix[3], glm::dvec4(7, 8, 9, 1));
    EXPECT_FALSE(scene.nodes[0].castShadow);
    EXPECT_TRUE(scene.nodes[0].receiveShadow);
    EXPECT_FALSE(scene.nodes[1].receiveShadow);
    EXPECT_EQ(scene.order, (std::vector<int>{0, 1, 2}));
}

TEST(GltfLoaderTest, TheDefaultSceneIsChosenElseTheFirstElseAllRoots) {
    const std::string nodes = R"("nodes":[{},{"children":[3]},{},{}])";
    const std::string scenes = R"(,"scenes":[{"nodes":[0]},{"nodes":[2,1]}])";
    EXPECT_EQ(GltfTestFile().load(nodes + scenes + R"(,"scene":1)").order,
              (std::vector<int>{2, 1, 3}));
    EXPECT_EQ(GltfTestFile().load(nodes + scenes).order, std::vector<int>{0});
    EXPECT_EQ(GltfTestFile().load(nodes).order, (std::vector<int>{0, 1, 2, 3}));
    EXPECT_TRUE(GltfTestFile().load("").order.empty());
}

TEST(GltfLoaderTest, HierarchiesMayBeVeryDeep) {
    constexpr int kDepth = 100000;
    std::string nodes = R"("nodes":[{"translation":[1,0,0],"children":[1]})";
    for (int i = 2; i <= kDepth; ++i)
        nodes += fmt::format(R"(,{{"translation":[1,0,0],"children":[{}]}})", i);
    const Scene scene = GltfTestFile().load(nodes + ",{}]");
    EXPECT_EQ(poseAt(scene, {}, 0).worldFromNode[kDepth][3][0], kDepth);
}

}  // namespace
}  // namespace penumbra::scene
