// SPDX-License-Identifier: MIT
// Pictures somebody has looked at (data/golden), each with its tolerance. A failure leaves the
// actual picture and the difference in the build folder. tools/update_golden writes them anew.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/image/image_file.h"
#include "host/pipeline.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using nlohmann::json;

const std::string kFolder = std::string(PENUMBRA_SOURCE_DIR) + "/data/golden/";

json readRows() {
    std::ifstream file(kFolder + "golden.json");
    return json::parse(file);
}

Frame renderRow(const json& row) {
    RenderOptions options;
    options.width = 240;
    options.height = 135;
    options.device = std::getenv("PENUMBRA_DEVICE") ? "" : "cpu";
    options.lightSamples = row["samples"];
    options.technique = row.value("technique", "vwss");
    options.settings = row["settings"].get<std::map<std::string, std::string>>();
    if (row.contains("light")) options.lights = {row["light"]};
    return Pipeline(options).render(row["frame"]);
}

class GoldenTest : public testing::TestWithParam<std::string> {};

TEST_P(GoldenTest, LooksAsBefore) {
    const auto rows = readRows();
    const auto& row = rows[GetParam()];
    const Frame frame = renderRow(row["options"]);
    const auto golden = kFolder + GetParam() + ".png";
    const auto actual = temporaryFolder("golden-" + GetParam()) + "/actual.png";
    writePng(actual, frame);
    if (std::getenv("PENUMBRA_UPDATE_GOLDEN")) {
        std::filesystem::copy_file(actual, golden,
                                   std::filesystem::copy_options::overwrite_existing);
        GTEST_SKIP() << golden << " is written: look at it";
    }
    const auto a = image::readImage(golden), b = image::readImage(actual);
    ASSERT_EQ(a.width, b.width);
    std::size_t beyond = 0;
    double sum = 0;
    const auto pixels = a.channels[0].values.size();
    for (std::size_t i = 0; i < pixels; ++i) {
        double worst = 0;
        for (std::size_t c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(static_cast<double>(a.channels[c].values[i]) -
                                             b.channels[c].values[i]));
        beyond += worst > row["tolerance"]["step"].get<double>() ? 1 : 0;
        sum += worst;
    }
    EXPECT_LE(static_cast<double>(beyond) / static_cast<double>(pixels),
              row["tolerance"]["share"].get<double>())
        << actual;
    EXPECT_LE(sum / static_cast<double>(pixels), row["tolerance"]["mean"].get<double>()) << actual;
}

std::vector<std::string> rowNames() {
    std::vector<std::string> names;
    const auto rows = readRows();
    for (const auto& [name, row] : rows.items()) names.push_back(name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(Pictures, GoldenTest, testing::ValuesIn(rowNames()), [](const auto& test) {
    std::string name = test.param;
    for (char& c : name) c = c == '-' ? '_' : c;
    return name;
});

}  // namespace
}  // namespace penumbra::tests
