// SPDX-License-Identifier: MIT
// A comparison's figures, files and page.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/metrics/image_error.h"
#include "host/report/comparison.h"
#include "host/report/page_parts.h"
#include "runtime/error.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using nlohmann::json;

void noProgress(const std::string&) {}

report::CompareOptions smallOptions(const std::string& folder) {
    report::CompareOptions options;
    options.base.width = 64;
    options.base.height = 40;
    options.base.lightSamples = "4";
    options.base.device = "cpu";
    options.techniques = {"vwss:resolution=512", "mvr:resolution=512"};
    options.referenceSamples = "32";
    options.repeats = 1;
    options.folder = temporaryFolder(folder);
    options.command = "penumbra compare 'a <b> & \"c\"'";
    return options;
}

std::string textOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
}

TEST(CompareTest, TheReferenceComparedWithItselfHasNoError) {
    auto options = smallOptions("compare_self");
    options.techniques = {"raytrace:samples=32"};
    const auto comparison = report::compare(options, noProgress);
    EXPECT_EQ(comparison.results[0].error.rmse, 0);
    EXPECT_EQ(comparison.results[0].error.frameFlip, 0);
    EXPECT_EQ(comparison.results[0].error.frameSsim, 1);
    EXPECT_EQ(comparison.results[0].sameSamples.value(), 0);
}

TEST(CompareTest, RaysToTheSameSamplesLeaveOutTheErrorOfSampling) {
    auto options = smallOptions("compare_same");
    options.techniques = {"raytrace", "mvss:maps=3", "vwss"};
    const auto comparison = report::compare(options, noProgress);
    EXPECT_EQ(comparison.results[0].sameSamples.value(), 0);
    EXPECT_GT(comparison.results[0].error.rmse, 0.01);  // of four samples
    // The samples of mvss are its own
    EXPECT_GT(comparison.results[1].sameSamples.value(), 0);
    EXPECT_LT(comparison.results[1].sameSamples.value(), 0.2);
    EXPECT_GT(comparison.results[2].sameSamples.value(), 0);
}

TEST(CompareTest, ResultsNameTimesErrorsAndFiles) {
    const auto options = smallOptions("compare_results");
    const auto comparison = report::compare(options, noProgress);
    report::writeReport(comparison);
    const auto results = json::parse(textOf(options.folder + "/results.json"));
    EXPECT_EQ(results["schema"], 1);
    EXPECT_EQ(results["reference"]["samples"], "32");
    ASSERT_EQ(results["results"].size(), 2U);
    for (const auto& r : results["results"]) {
        EXPECT_GT(r["ms"]["shadows"].get<double>(), 0);
        EXPECT_GE(r["ms"]["total"].get<double>(), r["ms"]["shadows"].get<double>());
        EXPECT_GT(r["error"]["reference"]["rmse"].get<double>(), 0);
        EXPECT_LT(r["error"]["reference"]["rmse"].get<double>(), 0.3);
        EXPECT_LT(r["error"]["sameSamples"].get<double>(), 0.3);
        for (const auto& file : r["files"])
            EXPECT_TRUE(std::filesystem::exists(options.folder + "/" + file.get<std::string>()));
        EXPECT_EQ(r["files"].size(), 1U);
    }
    EXPECT_EQ(results["results"][1]["fasterThanMvr"], 1.0);
}

TEST(CompareTest, ThePageStandsAloneAndEscapesWhatItShows) {
    const auto options = smallOptions("compare_page");
    const auto comparison = report::compare(options, noProgress);
    const auto page = report::reportPage(comparison);
    EXPECT_EQ(page.find("http"), std::string::npos);
    EXPECT_EQ(page.find("a <b>"), std::string::npos);
    EXPECT_NE(page.find("a &lt;b&gt; &amp; &quot;c&quot;"), std::string::npos);
    EXPECT_EQ(count(page, "class=\"slider\""), 2U);
    // Frames, two maps each, the marked reference, and insets of all
    EXPECT_GE(count(page, "data:image/png;base64,"), 2U * 4 + 1 + 3);
    EXPECT_EQ(count(page, "<svg"), count(page, "</svg>"));
    EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST(CompareTest, SequencesShowErrorAndFlickerOverTime) {
    auto options = smallOptions("compare_sequence");
    options.frames = {0, 1, 2};
    options.techniques = {"vwss:resolution=128", "vwss:resolution=128:temporal=3"};
    const auto comparison = report::compare(options, noProgress);
    const auto& plain = comparison.results[0];
    ASSERT_EQ(plain.frames.size(), 3U);
    EXPECT_FALSE(plain.frames[0].flicker);
    EXPECT_GT(plain.frames[1].flicker.value(), 0);
    EXPECT_LT(comparison.results[1].flicker.value(), plain.flicker.value());  // averaging steadies
    EXPECT_GT(comparison.reference.flicker.value(), 0);
    const auto page = report::reportPage(comparison);
    EXPECT_NE(page.find("Error over time"), std::string::npos);
    EXPECT_NE(page.find("Flicker on resting receivers"), std::string::npos);
}

TEST(CompareTest, SweepsRunEachTechniqueThatHasTheSetting) {
    auto options = smallOptions("compare_sweep");
    options.techniques = {"vwss:resolution=128", "pcss"};
    options.sweep = "light-samples=2,32";
    auto comparison = report::compare(options, noProgress);
    ASSERT_EQ(comparison.sweep.size(), 2U);  // pcss has no samples
    EXPECT_LT(comparison.sweep[1].error.rmse, comparison.sweep[0].error.rmse);
    options.sweep = "resolution=64,256";
    comparison = report::compare(options, noProgress);
    ASSERT_EQ(comparison.sweep.size(), 4U);
    EXPECT_NE(report::reportPage(comparison).find("Sweep of resolution"), std::string::npos);
}

TEST(CompareTest, AFileOfAnotherRendererCanBeTheReference) {
    auto options = smallOptions("compare_file");
    options.techniques = {"raytrace:samples=32"};
    report::compare(options, noProgress);
    options.reference = options.folder + "/reference.####.exr";
    options.techniques = {"raytrace:samples=32", "vwss"};
    const auto comparison = report::compare(options, noProgress);
    EXPECT_EQ(comparison.results[0].error.rmse, 0);
    EXPECT_GT(comparison.results[1].error.rmse, 0);
    options.base.width = 32;
    EXPECT_THROW(report::compare(options, noProgress), Error);
}

TEST(CompareTest, NoShadowsAreMeasuredOverTheSamePixelsAsAllOthers) {
    auto options = smallOptions("compare_none");
    options.techniques = {"none", "raytrace:samples=32"};
    const auto comparison = report::compare(options, noProgress);
    EXPECT_GT(comparison.results[0].error.rmse, 0.1);
    EXPECT_EQ(comparison.results[0].error.maximum, 1);
    EXPECT_EQ(comparison.results[0].shown.mask, comparison.results[1].shown.mask);
}

TEST(CompareTest, WhatWasNotMeasuredIsNullAndSaid) {
    auto options = smallOptions("compare_null");
    options.frames = {0, 1};
    report::compare(options, noProgress);
    options.reference = options.folder + "/reference.####.exr";
    options.sameSamples = false;
    const auto comparison = report::compare(options, noProgress);
    const auto results = json::parse(report::resultsJson(comparison));
    EXPECT_TRUE(results["reference"]["flicker"].is_null());
    for (const auto& r : results["results"]) {
        EXPECT_TRUE(r["flicker"].is_null());
        EXPECT_TRUE(r["error"]["sameSamples"].is_null());
        EXPECT_EQ(r["error"]["of"], "visibility");
    }
    EXPECT_EQ(report::reportPage(comparison).find("Flicker on resting"), std::string::npos);
}

TEST(CompareTest, InsetsLieWhereTechniquesDiffer) {
    auto options = smallOptions("compare_insets");
    auto comparison = report::compare(options, noProgress);
    auto& shown = comparison.results[0].shown;
    for (auto& result : comparison.results)
        result.shown.visibility = comparison.reference.shown.visibility;
    for (int y = 10; y < 16; ++y)
        for (int x = 40; x < 46; ++x) {
            const auto at = static_cast<std::size_t>(y * 64 + x);
            shown.visibility[at] = 1 - shown.visibility[at];
            shown.mask[at] = true;
        }
    const auto insets = report::findInsets(comparison, 4);
    ASSERT_FALSE(insets.empty());
    EXPECT_LE(insets[0].x, 40);
    EXPECT_GE(insets[0].x + insets[0].size, 46);
    EXPECT_LE(insets[0].y, 10);
    EXPECT_GE(insets[0].y + insets[0].size, 16);
}

TEST(CompareSlowTest, TheBuiltinSceneFromPointsIsWithinTwoLevelsOfRasterisedMaps) {
    auto options = smallOptions("compare_builtin");
    options.base.width = 320;
    options.base.height = 180;
    options.base.lightSamples = "64";
    options.base.lights.clear();
    options.techniques = {"vwss", "mvr", "pcss", "essm"};
    options.reference = "mvr:samples=64";
    const auto toMvr = report::compare(options, noProgress);
    const auto& vwss = toMvr.results[0].error;
    std::printf("[ RMSE     ] vwss against mvr: %.2f of 255 in the frame, %.4f of visibility\n",
                vwss.frameRmse255, vwss.rmse);
    EXPECT_LT(vwss.frameRmse255, 2);
    // Inside of the shadow alone
    const auto& rasterised = toMvr.reference.shown;
    std::vector<bool> shadow(rasterised.mask);
    for (std::size_t i = 0; i < shadow.size(); ++i)
        shadow[i] = shadow[i] && rasterised.visibility[i] < 1;
    const auto inside =
        metrics::imageError({&rasterised.visibility}, {&toMvr.results[0].shown.visibility}, shadow);
    std::printf("[ RMSE     ] vwss against mvr inside of the shadow: %.4f of %zu pixels\n",
                inside.rmse, inside.pixels);
    EXPECT_GT(inside.pixels, 5000U);
    EXPECT_LT(inside.rmse, 0.04);
    options.reference = "raytrace:samples=256";
    const auto toRays = report::compare(options, noProgress);
    std::vector<double> errors;
    for (const auto& r : toRays.results) {
        std::printf("[ RMSE     ] %s against rays: %.2f of 255 in the frame, %.4f of visibility\n",
                    r.contender.label.c_str(), r.error.frameRmse255, r.error.rmse);
        errors.push_back(r.error.rmse);
    }
    for (const std::size_t multi : {0U, 1U})
        for (const std::size_t single : {2U, 3U}) EXPECT_LT(errors[multi], 0.8 * errors[single]);
}

TEST(CompareTest, WrongOptionsAreNamed) {
    const auto messageOf = [](auto change) {
        auto options = smallOptions("compare_wrong");
        change(options);
        try {
            report::compare(options, noProgress);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::usage);
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(messageOf([](auto& o) {
                  o.techniques = {"vwss", "vwss"};
              }).find("listed twice"),
              std::string::npos);
    EXPECT_NE(messageOf([](auto& o) { o.techniques = {"vsm"}; }).find("vsm"), std::string::npos);
    EXPECT_NE(messageOf([](auto& o) { o.techniques = {"vwss:pcf"}; }).find("setting=value"),
              std::string::npos);
    EXPECT_NE(messageOf([](auto& o) { o.sweep = "resolution=a"; }).find("not a number"),
              std::string::npos);
    EXPECT_NE(messageOf([](auto& o) { o.techniques = {"vwss:colour=1"}; }).find("colour"),
              std::string::npos);
    EXPECT_NE(messageOf([](auto& o) { o.techniques = {"vwss:pattern=random"}; }).find("raytrace"),
              std::string::npos);
    EXPECT_NE(messageOf([](auto& o) { o.sweep = "foo=1,2"; }).find("no technique"),
              std::string::npos);
    EXPECT_NE(messageOf([](auto& o) {
                  o.frames = {0, 1};
                  o.reference = "one.exr";
              }).find("####"),
              std::string::npos);
}

}  // namespace
}  // namespace penumbra::tests
