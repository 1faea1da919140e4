// SPDX-License-Identifier: MIT
// Scenes and options that no user would want but that can be rendered: exit code 0, and a warning
// for what is lost, the same words each time.
#include <unistd.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "host/image/image_file.h"
#include "tests/scene/gltf_test_file.h"
#include "tests/support/command.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using scene::GltfTestFile;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct OddScene {
    const char* name;
    std::vector<float> positions;
    const char* node;      ///< JSON members of the node that has the mesh
    const char* rest;      ///< further JSON
    const char* light;     ///< --light
    const char* warnings;  ///< all of them, one a line
};

const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};
const char* const kAbove = "rect:at=0,0,4";

const OddScene kOddScenes[] = {
    {"PositionsNotANumber",
     {0, 0, 0, kNaN, 0, 0, 0, 1, 0},
     "",
     "",
     kAbove,
     "1 vertices are not finite or too far away: their triangles are dropped\n"
     ""},
    {"AllPositionsNotANumber", std::vector<float>(9, kNaN), "", "", kAbove,
     "no vertex of the scene is finite: it has no bounds\n"
     "3 vertices are not finite or too far away: their triangles are dropped\n"
     ""},
    {"PositionsAtInfinity",
     {0, 0, 0, kInfinity, 0, 0, 0, 1, 0},
     "",
     "",
     kAbove,
     "1 vertices are not finite or too far away: their triangles are dropped\n"
     ""},
    {"PositionsBeyondFloats",
     {0, 0, 0, 3e38F, 0, 0, 0, 3e38F, 0},
     "",
     "",
     kAbove,
     "all vertices of the scene lie at one point, 0,0,0: nothing of it can be seen\n"
     "2 vertices are not finite or too far away: their triangles are dropped\n"
     ""},
    {"PositionsFarApart", {0, 0, 0, 1e18F, 0, 0, 0, 1e18F, 0}, "", "", kAbove, ""},
    {"TrianglesWithoutArea",
     {0, 0, 0, 1, 0, 0, 2, 0, 0},
     "",
     "",
     kAbove,
     "mesh 0 primitive 0: none of its 1 triangles has an area\n"
     ""},
    {"AllAtOnePoint", std::vector<float>(9, 1), "", "", kAbove,
     "mesh 0 primitive 0: none of its 1 triangles has an area\n"
     "all vertices of the scene lie at one point, 1,1,1: nothing of it can be seen\n"
     ""},
    {"ScaleOfNothing", kTriangle, R"(,"scale":[0,0,0])", "", kAbove,
     "all vertices of the scene lie at one point, 0,0,0: nothing of it can be seen\n"
     ""},
    {"ScaleOfAPlane", kTriangle, R"(,"scale":[1,1,0])", "", kAbove, ""},
    {"SingularMatrix", kTriangle, R"(,"matrix":[1,0,0,0,1,0,0,0,0,0,1,0,0,0,0,1])", "", kAbove, ""},
    {"CameraScaledToNothing", kTriangle, R"(},{"camera":0,"scale":[0,0,0])",
     R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}])", kAbove,
     "camera 0 is not used: node 1 scales it to nothing\n"
     ""},
    {"SpotScaledToNothing", kTriangle,
     R"(},{"scale":[0,0,0],"extensions":{"KHR_lights_punctual":{"light":0}})",
     R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{}}]}})", "",
     "punctual light 0 on node 1 is not used: it has a node whose scale leaves it "
     "no direction\n"
     "the scene has no light that can be used: a square light is placed above it; "
     "choose your own with --light\n"
     ""},
    {"TrianglesBehindTheLight", kTriangle, "", "", "rect:at=0,0,-4;aim=0,0,-5", ""},
    {"LightInTheGeometry", kTriangle, "", "", "rect:at=0.25,0.25,0;aim=0.25,0.25,-1", ""},
    {"LightThroughTheGeometry", kTriangle, "", "", "disk:at=0.25,0.25,0;aim=1,0.25,0;radius=1", ""},
    {"LightBeyondTheScene", kTriangle, "", "", "rect:size=1e9x1e9", ""},
};

std::string warningsOf(const std::string& errors) {
    const std::string begin = "penumbra: warning: ";
    std::string warnings;
    std::istringstream lines(errors);
    for (std::string line; std::getline(lines, line);)
        if (line.rfind(begin, 0) == 0) warnings += line.substr(begin.size()) + "\n";
    return warnings;
}

const std::string kRender = "render --size 32x32 --light-samples 4 --set vwss.resolution=64 -v -o ";

class OddSceneTest : public testing::TestWithParam<OddScene> {};

TEST_P(OddSceneTest, IsRenderedWithItsWarnings) {
    const OddScene& odd = GetParam();
    const scene::TemporaryFolder folder;
    GltfTestFile file;
    file.accessor(odd.positions, "VEC3");
    const std::string scene = folder.write(
        "a.glb", file.glb(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
                          R"("nodes":[{"mesh":0)" +
                          std::string(odd.node) + "}]" + odd.rest));
    const std::string image = (folder.path() / "a.exr").string();
    const std::string light = *odd.light == '\0' ? "" : fmt::format(" --light '{}'", odd.light);
    const auto result = run(kRender + image + " " + scene + light);
    ASSERT_EQ(result.code, 0) << result.errors;
    EXPECT_EQ(warningsOf(result.errors), odd.warnings);
    const auto pixels = image::readImage(image);
    for (const char* channel : {"R", "G", "B", "A"})
        for (const float value : *pixels.find(channel))
            ASSERT_TRUE(std::isfinite(value)) << channel;
}

INSTANTIATE_TEST_SUITE_P(All, OddSceneTest, testing::ValuesIn(kOddScenes),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(OddSizeTest, OnePixelIsRendered) {
    const scene::TemporaryFolder folder;
    for (const char* technique : {"vwss", "raytrace", "raster4d", "none"}) {
        const std::string path = (folder.path() / technique).string() + ".exr";
        const auto result = run("render -q --size 1x1 --light-samples 4 --technique " +
                                std::string(technique) + " -o " + path);
        ASSERT_EQ(result.code, 0) << result.errors;
        EXPECT_EQ(image::readImage(path).width, 1);
    }
}

TEST(OddSkinTest, WeightsOfNothingFollowTheFirstJoint) {
    const scene::TemporaryFolder folder;
    GltfTestFile file;
    file.accessor(kTriangle, "VEC3");
    file.accessor(std::vector<std::uint8_t>(12, 0), "VEC4");
    file.accessor(std::vector<float>(12, 0), "VEC4");
    const auto path = folder.write(
        "a.glb", file.glb(R"("nodes":[{"mesh":0,"skin":0},{}],"skins":[{"joints":[1]}],"meshes":)"
                          R"([{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,)"
                          R"("WEIGHTS_0":2}}]}])"));
    const auto result =
        run(kRender + (folder.path() / "a.png").string() + " " + path + " --light rect:at=0,0,4");
    EXPECT_EQ(result.code, 0) << result.errors;
    EXPECT_EQ(
        warningsOf(result.errors),
        "mesh 0 primitive 0: 3 vertices have no weights; they follow the skin's first joint\n");
}

}  // namespace
}  // namespace penumbra::tests
