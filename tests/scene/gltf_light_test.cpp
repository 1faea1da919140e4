// SPDX-License-Identifier: MIT
// The glTF loader's lights and cameras. Radiances follow from I = L pi r^2 and E = L pi sin^2(angle
// / 2).
#include <cmath>
#include <numbers>

#include "tests/scene/gltf_test_file.h"

namespace penumbra::scene {
namespace {

constexpr double kPi = std::numbers::pi;

Scene loadLit(const std::string& extension, const std::string& light,
              const std::string& node = "") {
    return GltfTestFile().load(
        fmt::format(R"("extensions":{{"{0}":{{"lights":[{{{1}}}]}}}},)"
                    R"("nodes":[{{"name":"lamp","extensions":{{"{0}":{{"light":0}}}}{2}}}])",
                    extension, light, node));
}

Light loadArea(const std::string& light, const std::string& node = "") {
    return loadLit("EXT_lights_area", light, node).lights.at(0);
}

Light loadPunctual(const std::string& light, const std::string& node = "") {
    return loadLit("KHR_lights_punctual", light, node).lights.at(0);
}

void expectNear(const glm::dvec3& found, const glm::dvec3& expected) {
    EXPECT_LT(glm::length(found - expected), 1e-9 * (1 + glm::length(expected)))
        << found.x << " " << found.y << " " << found.z;
}

TEST(GltfLightTest, RectanglesHaveAnAspectAndNits) {
    const Scene scene = loadLit("EXT_lights_area",
                                R"("type":"rect","name":"panel","color":[1,0.5,0],"intensity":200,)"
                                R"("size":2,"rect":{"aspect":1.5})");
    const Light& light = scene.lights.at(0);
    EXPECT_EQ(light.name, "panel");
    EXPECT_EQ(light.shape, LightShape::rectangle);
    EXPECT_EQ(light.width, 3);
    EXPECT_EQ(light.height, 2);
    EXPECT_EQ(light.radiance, glm::dvec3(200, 100, 0));
    EXPECT_EQ(light.node, 0);
    EXPECT_EQ(scene.nodes[0].light, 0);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfLightTest, DisksHaveTheirDiameterAndTheDefaultsOfTheDraft) {
    const Light light = loadArea(R"("type":"disk")");
    EXPECT_EQ(light.name, "lamp") << "the node's, where the light has none";
    EXPECT_EQ(light.shape, LightShape::disk);
    EXPECT_EQ(light.width, 1);
    EXPECT_EQ(light.height, 1);
    EXPECT_EQ(light.radiance, glm::dvec3(1000));
}

TEST(GltfLightTest, AreaLightsGrowWithTheLargestWorldScale) {
    const Scene scene = GltfTestFile().load(
        R"("extensions":{"EXT_lights_area":{"lights":[{"type":"rect","size":0.5,"rect":{"aspect":2}}]}},)"
        R"("nodes":[{"scale":[2,2,2],"rotation":[0,0.6,0,0.8],"children":[1]},{"scale":[1,-3,0.5],)"
        R"("extensions":{"EXT_lights_area":{"light":0}}}])");
    EXPECT_NEAR(scene.lights.at(0).width, 6, 1e-12);
    EXPECT_NEAR(scene.lights.at(0).height, 3, 1e-12);
}

TEST(GltfLightTest, PointsWithARadiusAreSpheres) {
    for (const bool onNode : {true, false}) {
        const std::string extras = R"("extras":{"radius":0.5})";
        const Light light = loadPunctual(
            R"("type":"point","intensity":10,"color":[1,0,0.5])" + (onNode ? "" : "," + extras),
            onNode ? "," + extras : "");
        EXPECT_EQ(light.shape, LightShape::sphere);
        EXPECT_EQ(light.width, 1);
        EXPECT_EQ(light.height, 1);
        expectNear(light.radiance, glm::dvec3(10, 0, 5) / (kPi * 0.25));
        EXPECT_EQ(light.outerConeRad, 0);
    }
    EXPECT_EQ(
        loadPunctual(R"("type":"point","extras":{"radius":1})", R"(,"extras":{"radius":2})").width,
        4)
        << "the node's extras win";
}

TEST(GltfLightTest, PointsWithoutARadiusGiveHardShadows) {
    const Light light = loadPunctual(R"("type":"point","intensity":10)");
    EXPECT_EQ(light.shape, LightShape::sphere);
    EXPECT_EQ(light.width, 0);
    EXPECT_EQ(light.intensity, glm::dvec3(10));
}

TEST(GltfLightTest, SpotsAreDisksWithACone) {
    const std::string spot =
        R"("type":"spot","intensity":8,"spot":{"innerConeAngle":0.25,"outerConeAngle":0.5})";
    const Light light = loadPunctual(spot, R"(,"extras":{"radius":2})");
    EXPECT_EQ(light.shape, LightShape::disk);
    EXPECT_EQ(light.width, 4);
    expectNear(light.radiance, glm::dvec3(8 / (kPi * 4)));
    EXPECT_EQ(light.innerConeRad, 0.25);
    EXPECT_EQ(light.outerConeRad, 0.5);
    const Light hard = loadPunctual(R"("type":"spot","intensity":8,"spot":{})");
    EXPECT_EQ(hard.shape, LightShape::disk);
    EXPECT_EQ(hard.width, 0);
    EXPECT_EQ(hard.intensity, glm::dvec3(8));
    EXPECT_NEAR(hard.outerConeRad, kPi / 4, 1e-9);
}

TEST(GltfLightTest, DirectionalLightsHaveAnAngleAndLux) {
    const Light sun = loadPunctual(R"("type":"directional","intensity":1000,"color":[1,1,0.5])");
    EXPECT_TRUE(sun.directional);
    EXPECT_NEAR(sun.angleRad, 0.53 * kPi / 180, 1e-12);
    EXPECT_EQ(sun.illuminance, glm::dvec3(1000, 1000, 500));
    const Light wide = loadPunctual(R"("type":"directional")", R"(,"extras":{"angle":60})");
    EXPECT_NEAR(wide.angleRad, kPi / 3, 1e-12);
    expectNear(wide.radiance, glm::dvec3(4 / kPi));  // sin^2(30 degrees) = 1/4
}

TEST(GltfLightTest, ExtrasFixTheViews) {
    const std::string extras = R"("extras":{"fov":60,"near":2})";
    for (const Light& light :
         {loadArea(R"("size":0.5)", "," + extras), loadArea(R"("size":0.5,)" + extras),
          loadPunctual(R"("type":"point","extras":{"radius":1})", "," + extras)}) {
        EXPECT_NEAR(light.fovRad, kPi / 3, 1e-12);
        EXPECT_EQ(light.nearMetres, 2);
    }
    const Light fitted = loadArea(R"("size":0.5)");
    EXPECT_EQ(fitted.fovRad, 0);
    EXPECT_EQ(fitted.nearMetres, 0);
}

TEST(GltfLightTest, LightsThatCannotBeUsedAreNamed) {
    const auto check = [](const char* extension, const std::string& light, const char* problem) {
        const Scene scene = loadLit(extension, R"("name":"odd",)" + light);
        EXPECT_TRUE(scene.lights.empty()) << light;
        EXPECT_EQ(scene.nodes[0].light, -1);
        EXPECT_TRUE(warnsOnce(scene, problem));
        EXPECT_TRUE(warnsOnce(scene, "\"odd\" on node 0 is not used"));
    };
    check("EXT_lights_area", R"("type":"tube")", "supported are rect and disk");
    check("EXT_lights_area", R"("type":"rect","size":0)", "size 0");
    check("EXT_lights_area", R"("type":"disk","intensity":-1)", "negative");
    check("EXT_lights_area", R"("extras":{"fov":141})", "fov of 141 degrees");
    check("EXT_lights_area", R"("extras":{"near":0})", "near of 0 m");
    check("KHR_lights_punctual", R"("type":"ambient")", "supported are point, spot, directional");
    check("KHR_lights_punctual", R"("type":"point","extras":{"radius":-1})", "radius of -1 m");
    check("KHR_lights_punctual", R"("type":"point","color":[1,1])", "a color of 2 numbers");
    check("KHR_lights_punctual", R"("type":"directional","extras":{"angle":180})", "180 degrees");
    check("KHR_lights_punctual", R"("type":"spot","spot":{"innerConeAngle":1,"outerConeAngle":1})",
          "cones of 1 and 1");
}

TEST(GltfLightTest, LightsThatAreNotThereAreRefused) {
    const std::string node = R"("nodes":[{"extensions":{"EXT_lights_area":{"light":2}}}])";
    EXPECT_TRUE(contains(messageOf([&] { GltfTestFile().load(node); }), "area light 2"));
}

TEST(GltfLightTest, LightsOutsideOfTheSceneAreNotLoaded) {
    const std::string rest =
        R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}},"scenes":[{"nodes":[1]}],)"
        R"("nodes":[{"extensions":{"KHR_lights_punctual":{"light":0}}},{}])";
    EXPECT_TRUE(GltfTestFile().load(rest).lights.empty());
}

TEST(GltfCameraTest, PerspectiveAndOrthographicCamerasAreRead) {
    const Scene scene = GltfTestFile().load(
        R"("cameras":[{"name":"eye","type":"perspective","perspective":{"yfov":0.5,"znear":0.25,)"
        R"("aspectRatio":1.5,"zfar":9}},{"type":"orthographic","orthographic":{"xmag":3,"ymag":-2,)"
        R"("znear":0,"zfar":7}},{"type":"perspective","perspective":{"yfov":1,"znear":1}}],)"
        R"("nodes":[{"camera":1,"name":"plan"},{"camera":0},{"camera":0},{}])");
    ASSERT_EQ(scene.cameras.size(), 3U);
    const Camera& plan = scene.cameras[0];
    EXPECT_TRUE(plan.orthographic);
    EXPECT_EQ(plan.name, "plan");
    EXPECT_EQ(plan.xmag, 3);
    EXPECT_EQ(plan.ymag, 2);
    EXPECT_EQ(plan.zfar, 7);
    const Camera& eye = scene.cameras[2];
    EXPECT_EQ(eye.name, "eye");
    EXPECT_EQ(eye.node, 2);
    EXPECT_EQ(scene.nodes[2].camera, 2);
    EXPECT_EQ(scene.nodes[3].camera, -1);
    EXPECT_EQ(eye.yfov, 0.5);
    EXPECT_EQ(eye.aspect, 1.5);
    EXPECT_EQ(eye.znear, 0.25);
    EXPECT_EQ(eye.zfar, 9);
}

TEST(GltfCameraTest, CamerasOutOfRangeAreRefused) {
    const auto message = [](const std::string& camera) {
        return messageOf(
            [&] { GltfTestFile().load(R"("nodes":[{"camera":0}],"cameras":[{)" + camera + "}]"); });
    };
    EXPECT_TRUE(contains(message(R"("type":"perspective","perspective":{"yfov":4,"znear":1})"),
                         "0 < yfov < pi"));
    EXPECT_TRUE(contains(message(R"("type":"perspective","perspective":{"yfov":1,"znear":0})"),
                         "0 < znear"));
    EXPECT_TRUE(contains(
        message(R"("type":"orthographic","orthographic":{"xmag":0,"ymag":1,"znear":0,"zfar":1})"),
        "other than 0"));
}

}  // namespace
}  // namespace penumbra::scene
