// SPDX-License-Identifier: MIT
// Animation: which clips play, and poses at times whose values are known on paper.
#include "host/scene/animation.h"

#include <cmath>
#include <numbers>

#include "tests/scene/gltf_test_file.h"

namespace penumbra::scene {
namespace {

constexpr double kHalf = std::numbers::sqrt2 / 2;

/// One clip that moves node 0 by one channel.
Scene sceneWith(Path path, Interpolation interpolation, std::vector<float> times,
                std::vector<float> values) {
    Scene scene;
    scene.nodes.resize(1);
    scene.order = {0};
    scene.animations.push_back(
        {"clip", {{0, path, interpolation, std::move(times), std::move(values)}}});
    return scene;
}

glm::dvec3 originAt(const Scene& scene, double seconds) {
    return glm::dvec3(poseAt(scene, {0}, seconds).worldFromNode[0][3]);
}

/// Where the node's +X axis points.
glm::dvec3 axisAt(const Scene& scene, double seconds) {
    return glm::dvec3(poseAt(scene, {0}, seconds).worldFromNode[0][0]);
}

void expectNear(const glm::dvec3& found, const glm::dvec3& expected) {
    EXPECT_LT(glm::length(found - expected), 1e-6)
        << found.x << " " << found.y << " " << found.z << " instead of " << expected.x << " "
        << expected.y << " " << expected.z;
}

TEST(AnimationTest, StepHoldsEachValueUntilTheNextKey) {
    const Scene scene =
        sceneWith(Path::translation, Interpolation::step, {1, 2, 4}, {1, 0, 0, 2, 0, 0, 4, 0, 0});
    expectNear(originAt(scene, 1.999), {1, 0, 0});
    expectNear(originAt(scene, 2), {2, 0, 0});
    expectNear(originAt(scene, 3.999), {2, 0, 0});
    expectNear(originAt(scene, 4), {4, 0, 0});
}

TEST(AnimationTest, LinearGoesStraightBetweenKeys) {
    const Scene scene = sceneWith(Path::translation, Interpolation::linear, {1, 2, 4},
                                  {1, 0, 0, 2, 8, 0, 4, 0, -4});
    expectNear(originAt(scene, 1.25), {1.25, 2, 0});
    expectNear(originAt(scene, 3), {3, 4, -2});
}

TEST(AnimationTest, TimesOutsideOfTheKeysAreClamped) {
    for (const Interpolation kind : {Interpolation::step, Interpolation::linear}) {
        const Scene scene = sceneWith(Path::translation, kind, {1, 2}, {1, 0, 0, 2, 0, 0});
        expectNear(originAt(scene, -5), {1, 0, 0});
        expectNear(originAt(scene, 0.999), {1, 0, 0});
        expectNear(originAt(scene, 99), {2, 0, 0});
    }
}

TEST(AnimationTest, RotationsTurnAtConstantSpeed) {
    // A quarter turn about +Z in 1 s: a third of it after 1/3 s, where mixing would be off by 0.3
    // degrees
    const Scene scene =
        sceneWith(Path::rotation, Interpolation::linear, {0, 1},
                  {0, 0, 0, 1, 0, 0, static_cast<float>(kHalf), static_cast<float>(kHalf)});
    const double angle = std::numbers::pi / 6;
    expectNear(axisAt(scene, 1 / 3.0), {std::cos(angle), std::sin(angle), 0});
}

TEST(AnimationTest, RotationsGoTheShorterWay) {
    // The second key is a quarter turn with its sign flipped, three quarters the other way by its
    // numbers
    const Scene scene =
        sceneWith(Path::rotation, Interpolation::linear, {0, 1},
                  {0, 0, 0, 1, 0, 0, -static_cast<float>(kHalf), -static_cast<float>(kHalf)});
    expectNear(axisAt(scene, 0.5), {kHalf, kHalf, 0});
}

TEST(AnimationTest, CubicSplinesFollowTheirTangents) {
    // Key 0: value 0, out-tangent 3 per second; key 1, after 2 s: value 1, in-tangent -1 per
    // second. Hermite at the middle: 0.5 * 0 + 0.5 * 1 + 2 * 0.125 * 3 - 2 * 0.125 * (-1) = 1.5
    const Scene scene = sceneWith(Path::translation, Interpolation::cubicSpline, {1, 3},
                                  {9, 9, 9, 0, 0, 0, 3, 0, 0, -1, 0, 0, 1, 0, 0, 9, 9, 9});
    expectNear(originAt(scene, 1), {0, 0, 0});
    expectNear(originAt(scene, 2), {1.5, 0, 0});
    expectNear(originAt(scene, 3), {1, 0, 0});
    expectNear(originAt(scene, 0), {0, 0, 0});
    expectNear(originAt(scene, 7), {1, 0, 0});
}

TEST(AnimationTest, CubicSplinesOfRotationsAreNormalised) {
    const Scene scene =
        sceneWith(Path::rotation, Interpolation::cubicSpline, {0, 1},
                  {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
    // By symmetry the middle is 90 degrees about +Z, half of the 180 between the keys
    expectNear(axisAt(scene, 0.5), {0, 1, 0});
}

TEST(AnimationTest, ScaleMayBeNegativeAndUneven) {
    const Scene scene = sceneWith(Path::scale, Interpolation::linear, {0, 1}, {1, 1, 1, -3, 1, 5});
    const glm::dmat4 world = poseAt(scene, {0}, 1).worldFromNode[0];
    expectNear(glm::dvec3(world[0]), {-3, 0, 0});
    expectNear(glm::dvec3(world[2]), {0, 0, 5});
}

TEST(AnimationTest, MorphWeightsComeFromClipElseNodeElseMesh) {
    Scene scene = sceneWith(Path::weights, Interpolation::linear, {0, 1}, {0, 1, 1, 0});
    scene.meshes.resize(1);
    scene.meshes[0].weights = {0.5F, 0.25F};
    scene.nodes.resize(4);
    scene.order = {0, 1, 2, 3};
    for (int i = 0; i < 3; ++i) scene.nodes[static_cast<std::size_t>(i)].mesh = 0;
    scene.nodes[1].weights = {2, 3};
    const Pose pose = poseAt(scene, {0}, 0.25);
    EXPECT_EQ(pose.weights[0], (std::vector<float>{0.25F, 0.75F}));
    EXPECT_EQ(pose.weights[1], (std::vector<float>{2, 3}));
    EXPECT_EQ(pose.weights[2], (std::vector<float>{0.5F, 0.25F}));
    EXPECT_TRUE(pose.weights[3].empty());
}

TEST(AnimationTest, ChildrenFollowTheirParents) {
    Scene scene = sceneWith(Path::rotation, Interpolation::step, {0},
                            {0, 0, static_cast<float>(kHalf), static_cast<float>(kHalf)});
    scene.nodes.resize(3);
    scene.nodes[0].translation = {10, 0, 0};
    scene.nodes[0].scale = {2, 2, 2};
    scene.nodes[1].parent = 0;
    scene.nodes[1].usesMatrix = true;
    scene.nodes[1].matrix[3] = {1, 0, 0, 1};
    scene.nodes[2].translation = {5, 5, 5};
    scene.order = {0, 1};
    const Pose pose = poseAt(scene, {0}, 0);
    // (1, 0, 0), scaled by 2, turned by 90 degrees about +Z, moved by 10 along +X
    expectNear(glm::dvec3(pose.worldFromNode[1][3]), {10, 2, 0});
    EXPECT_EQ(pose.worldFromNode[2], glm::dmat4(1)) << "outside of the chosen scene";
}

TEST(AnimationTest, MatricesAreInDoublePrecision) {
    Scene scene = sceneWith(Path::translation, Interpolation::step, {0}, {0.25F, 0, 0});
    scene.nodes.resize(2);
    scene.nodes[0].parent = 1;
    scene.nodes[1].translation = {123456789, 0, 0};
    scene.order = {1, 0};
    EXPECT_EQ(originAt(scene, 0).x, 123456789.25);
}

/// Clips named "walk" (node 0, 2 s), "run" (node 0, 5 s), "wave" (node 1, 3 s) and "nod" (node 1, 1
/// s).
Scene fourClips() {
    Scene scene;
    scene.nodes.resize(2);
    scene.order = {0, 1};
    const auto add = [&](const char* name, int node, float seconds) {
        scene.animations.push_back(
            {name,
             {{node, Path::translation, Interpolation::linear, {0, seconds}, {0, 0, 0, 1, 0, 0}}}});
    };
    add("walk", 0, 2);
    add("run", 0, 5);
    add("wave", 1, 3);
    add("nod", 1, 1);
    return scene;
}

TEST(AnimationTest, AllPlaysTheFirstClipAndThoseThatMoveOtherNodes) {
    EXPECT_EQ(chooseAnimations(fourClips(), "all"), (std::vector<int>{0, 2}));
    EXPECT_EQ(chooseAnimations(fourClips(), ""), (std::vector<int>{0, 2}));
    EXPECT_TRUE(chooseAnimations(Scene(), "all").empty());
}

TEST(AnimationTest, ClipsAreChosenByNameOrIndex) {
    EXPECT_EQ(chooseAnimations(fourClips(), "run"), std::vector<int>{1});
    EXPECT_EQ(chooseAnimations(fourClips(), "3"), std::vector<int>{3});
    EXPECT_TRUE(chooseAnimations(fourClips(), "none").empty());
}

TEST(AnimationTest, UnknownClipsAreRefusedWithTheNamesOfAll) {
    for (const char* const choice : {"jump", "4", "-1", "1x"}) {
        try {
            chooseAnimations(fourClips(), choice);
            ADD_FAILURE() << choice;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::usage);
            EXPECT_TRUE(contains(error.what(), choice));
            EXPECT_TRUE(contains(error.what(), R"(0 "walk", 1 "run", 2 "wave", 3 "nod")"));
        }
    }
}

TEST(AnimationTest, TheDurationIsThatOfTheLongestChosenClip) {
    EXPECT_EQ(clipDurationSeconds(fourClips(), {0, 2}), 3);
    EXPECT_EQ(clipDurationSeconds(fourClips(), {1}), 5);
    EXPECT_EQ(clipDurationSeconds(fourClips(), {}), 0);
}

/// Loads a clip of one channel over a node with a mesh of one morph target.
Scene loadClip(const GltfTestFile& file, const std::string& sampler, const std::string& target,
               const std::string& node = "") {
    return file.load(fmt::format(
        R"("nodes":[{{"mesh":0{}}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},)"
        R"("targets":[{{"POSITION":0}}]}}]}}],"animations":[{{"name":"clip","samplers":[{{{}}}],)"
        R"("channels":[{{"sampler":0,"target":{{{}}}}}]}}])",
        node, sampler, target));
}

TEST(AnimationTest, ChannelsAreLoadedWithTheirKeys) {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");
    const int times = file.accessor<float>({0.5F, 1.5F}, "SCALAR");
    const int bytes =
        file.accessor<std::int8_t>({0, 0, 0, 127, 0, 0, -127, 0}, "VEC4", R"("normalized":true)");
    const int floats = file.accessor<float>({0, 0.25F, 0, 0, 1, 0}, "SCALAR");
    const Scene turned = loadClip(file, fmt::format(R"("input":{},"output":{})", times, bytes),
                                  R"("node":0,"path":"rotation")");
    ASSERT_EQ(turned.animations.at(0).channels.size(), 1U);
    const Channel& channel = turned.animations[0].channels[0];
    EXPECT_EQ(channel.values, (std::vector<float>{0, 0, 0, 1, 0, 0, -1, 0}));
    EXPECT_EQ(channel.interpolation, Interpolation::linear);
    EXPECT_EQ(turned.animations[0].durationSeconds(), 1.5);
    const Scene morphed = loadClip(
        file, fmt::format(R"("input":{},"output":{},"interpolation":"CUBICSPLINE")", times, floats),
        R"("node":0,"path":"weights")");
    EXPECT_EQ(poseAt(morphed, {0}, 0.5).weights[0], std::vector<float>{0.25F});
    EXPECT_EQ(poseAt(morphed, {0}, 2).weights[0], std::vector<float>{1});
}

TEST(AnimationTest, ChannelsThatCannotBePlayedAreNamedAndIgnored) {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");
    file.accessor<float>({0, 1}, "SCALAR");
    file.accessor<float>({0, 0, 0, 1, 1, 1}, "VEC3");
    const std::string sampler = R"("input":1,"output":2)";
    const Scene pointer = loadClip(file, sampler, R"("node":0,"path":"pointer")");
    EXPECT_TRUE(pointer.animations[0].channels.empty());
    EXPECT_TRUE(warnsOnce(pointer, "\"pointer\""));
    EXPECT_TRUE(warnsOnce(loadClip(file, sampler, R"("path":"translation")"), "without a node"));
    EXPECT_TRUE(warnsOnce(loadClip(file, sampler, R"("node":0,"path":"translation")",
                                   R"(,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1])"),
                          "has a matrix"));
}

TEST(AnimationTest, RotationKeysOfLengthZeroBecomeIdentity) {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");
    file.accessor<float>({0, 1}, "SCALAR");
    file.accessor(std::vector<float>(8, 0), "VEC4");
    const Scene scene = loadClip(file, R"("input":1,"output":2)", R"("node":0,"path":"rotation")");
    EXPECT_TRUE(warnsOnce(scene, "length 0"));
    EXPECT_EQ(poseAt(scene, {0}, 0.5).worldFromNode[0], glm::dmat4(1));
}

TEST(AnimationTest, BrokenChannelsAreRefused) {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");                                                 // 0
    file.accessor<float>({0, 1}, "SCALAR");                                                 // 1
    file.accessor<float>({1, 1}, "SCALAR");                                                 // 2
    file.accessor<float>({0, std::nanf("")}, "SCALAR");                                     // 3
    file.accessor<float>({0, 0, 0, 1, 1, 1}, "VEC3");                                       // 4
    file.accessor<float>({0, 0, 0, 1, 1, std::numeric_limits<float>::infinity()}, "VEC3");  // 5
    const auto message = [&](const std::string& sampler, const std::string& path) {
        return messageOf([&] { loadClip(file, sampler, R"("node":0,"path":")" + path + "\""); });
    };
    EXPECT_TRUE(contains(message(R"("input":2,"output":4)", "translation"), "times must ascend"));
    EXPECT_TRUE(contains(message(R"("input":3,"output":4)", "scale"), "not finite at key 1"));
    EXPECT_TRUE(contains(message(R"("input":1,"output":5)", "scale"), "value that is not finite"));
    EXPECT_TRUE(contains(message(R"("input":1,"output":0)", "scale"), "9 numbers for 2 keys of 3"));
    EXPECT_TRUE(contains(message(R"("input":1,"output":4)", "rotation"), "4 are needed"));
    EXPECT_TRUE(contains(message(R"("input":1,"output":4,"interpolation":"CUBICSPLINE")", "scale"),
                         "6 numbers for 2 keys of 9"));
    EXPECT_TRUE(contains(message(R"("input":1,"output":4,"interpolation":"BEZIER")", "scale"),
                         "allowed are STEP, LINEAR, CUBICSPLINE"));
    EXPECT_TRUE(contains(message(R"("input":1,"output":77)", "scale"), "accessor 77"));
}

}  // namespace
}  // namespace penumbra::scene
