// SPDX-License-Identifier: MIT
// tools/make_scene: the papers' scenes have the papers' numbers of triangles and points, are
// skinned and animated, and are the same bytes on every run.
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/geometry/mesh_arrays.h"
#include "host/pipeline.h"
#include "host/scene/bounds.h"
#include "host/scene/gltf_loader.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

struct PaperScene {
    const char* name;
    double triangles;
    double points;  ///< [VWSS] tables 1 and 2; 0: not told
    std::size_t figures;
};

const PaperScene kPaperScenes[] = {
    {"challenger", 90007, 40541, 1},  {"volund", 240186, 57188, 1}, {"warriors", 510523, 101002, 3},
    {"cliffside", 672927, 347060, 3}, {"mvss2", 12086, 0, 2},       {"mvss6", 36258, 0, 6}};

int runTool(const std::string& arguments, const std::string& errors = "/dev/null") {
    const std::string line =
        std::string(PENUMBRA_MAKE_SCENE) + " " + arguments + " >/dev/null 2>" + errors;
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string readBytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

double casterTriangles(const scene::Scene& scene) {
    std::size_t indices = 0;
    for (const int index : scene.order) {
        const scene::Node& node = scene.nodes[static_cast<std::size_t>(index)];
        if (node.mesh < 0 || !node.castShadow) continue;
        for (const auto& p : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives)
            indices += p.indices.size();
    }
    return static_cast<double>(indices) / 3;
}

/// As the papers' tables count them: enlarged central view for maps of 1024^2, frame 0.
double pointsOf(const scene::Scene& scene) {
    RenderOptions options;
    options.width = 64;
    options.height = 36;
    options.lightSamples = "24";
    options.device = std::getenv("PENUMBRA_DEVICE") ? "" : "cpu";
    Pipeline pipeline(options, scene);
    return nlohmann::json::parse(pipeline.render(0).statsJson)["points"].get<double>();
}

class PaperSceneSlowTest : public testing::TestWithParam<PaperScene> {};

TEST_P(PaperSceneSlowTest, IsThePapersSizeAndTheSameBytesTwice) {
    const PaperScene& expected = GetParam();
    const std::string path = temporaryFolder(expected.name) + "/scene.glb", again = path + ".again";
    ASSERT_EQ(runTool(path + " " + expected.name), 0);
    ASSERT_EQ(runTool(again + " " + expected.name), 0);
    EXPECT_TRUE(readBytes(path) == readBytes(again)) << "two runs gave different bytes";

    const scene::Scene scene = scene::loadGltf(path);
    EXPECT_EQ(scene.warnings, std::vector<std::string>());
    EXPECT_EQ(scene.lights.size(), 1U);
    EXPECT_EQ(scene.cameras.size(), 1U);
    EXPECT_NEAR(casterTriangles(scene), expected.triangles, 0.01 * expected.triangles);
    std::size_t figures = 0;
    for (const scene::Mesh& mesh : scene.meshes) {
        figures += mesh.name == "skin" ? 1 : 0;
        // Sheets are seen from both sides; all else hides its back faces
        const bool isSheet = mesh.name == "flag" || mesh.name == "cape" || mesh.name == "floor";
        EXPECT_EQ(geometry::isEdgeClosed(mesh), !isSheet) << mesh.name;
    }
    EXPECT_EQ(figures, expected.figures);
    EXPECT_GE(scene.skins.size(), figures);
    EXPECT_GE(scene::clipDurationSeconds(scene, {0}), 1);

    const auto bounds = scene::clipBounds(scene, {0});
    EXPECT_TRUE(std::isfinite(bounds.radius()));
    EXPECT_GT(bounds.high.y, 1.7);
    const bool onCliff = std::string(expected.name) == "cliffside";  // whose foot is in the ground
    if (!onCliff) {
        EXPECT_NEAR(bounds.low.y, 0, 0.03) << "feet stand on the ground";
    }
    if (expected.points > 0) {
        EXPECT_NEAR(pointsOf(scene), expected.points, 0.01 * expected.points);
    }
}

INSTANTIATE_TEST_SUITE_P(Papers, PaperSceneSlowTest, testing::ValuesIn(kPaperScenes),
                         [](const auto& test) { return test.param.name; });

TEST(MakeSceneTest, UnknownNamesAreRefusedWithTheNamesThatExist) {
    const std::string folder = temporaryFolder("make-scene"), errors = folder + "/errors";
    EXPECT_EQ(runTool(folder + "/a.glb castle", errors), 2);
    const std::string message = readBytes(errors);
    EXPECT_NE(message.find("'castle'"), std::string::npos) << message;
    for (const PaperScene& scene : kPaperScenes)
        EXPECT_NE(message.find(scene.name), std::string::npos) << message;
    EXPECT_EQ(runTool(""), 2);
}

}  // namespace
}  // namespace penumbra::tests
