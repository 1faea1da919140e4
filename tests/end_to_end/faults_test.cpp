// SPDX-License-Identifier: MIT
// What the machine may do to a frame: memory that is refused, lists that are too short, a device
// that is gone. Either an error that says so, or the same bytes; never a wrong image.
#include <functional>
#include <nlohmann/json.hpp>

#include "host/pipeline.h"
#include "host/visibility/technique.h"
#include "runtime/error.h"
#include "tests/support/fixtures.h"
#include "tests/support/tiny_scene.h"

namespace penumbra::tests {
namespace {

/// A technique, with settings where a variant has lists of its own.
struct Variant {
    std::string technique;
    std::map<std::string, std::string> settings;
};

RenderOptions optionsOf(const Variant& variant) {
    RenderOptions options;
    options.width = 20;
    options.height = 12;
    options.lightSamples = "3";
    options.eye = {{2.5, 2.5, 3.5}};
    options.target = {{0, 0.5, 0}};
    options.technique = variant.technique;
    options.settings = variant.settings;
    for (const auto& row : visibility::findTechnique(options.technique).describe())
        if (row.name == "resolution") options.settings[options.technique + ".resolution"] = "64";
    options.aovs = {"visibility"};
    return options;
}

std::unique_ptr<runtime::Device> ownDevice(const runtime::DeviceOptions& options = {}) {
    return std::make_unique<runtime::Device>(device().info(), options);
}

void expectSame(const Frame& frame, const Frame& expected, const std::string& what) {
    EXPECT_EQ(frame.rgba, expected.rgba) << what;
    ASSERT_EQ(frame.channels.size(), expected.channels.size()) << what;
    for (std::size_t i = 0; i < frame.channels.size(); ++i)
        EXPECT_EQ(frame.channels[i].values, expected.channels[i].values) << what;
}

/// The call succeeds, or throws an error of that code with that part in its message.
bool succeeds(ExitCode code, const std::string& part, const std::function<void()>& call) {
    try {
        call();
        return true;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        return false;
    }
}

class FaultsTest : public testing::TestWithParam<Variant> {
  protected:
    RenderOptions options_ = optionsOf(GetParam());
    Pipeline whole_{options_, tinyScene(), ownDevice()};
    Frame expected_ = whole_.render(0);
};

TEST_P(FaultsTest, AnyAllocationMayFailAndTheNextFrameIsRight) {
    Pipeline pipeline(options_, tinyScene(), ownDevice());
    auto& fault = pipeline.device().faults().allocation;
    std::uint64_t n = 0;
    const auto render = [&] { expectSame(pipeline.render(0), expected_, fmt::format("{}", n)); };
    // A failure drops what was made for frames: from the second on, all of it is allocated anew
    for (fault.after(n); !succeeds(ExitCode::outOfMemory, "MB", render); fault.after(++n)) {
    }
    EXPECT_GT(n, 20U);
    fault.never();
    render();
}

TEST_P(FaultsTest, ListsThatBeginWithNothingGrowToTheSameBytes) {
    auto own = ownDevice();
    own->faults().firstCapacity = 1;
    Pipeline pipeline(options_, tinyScene(), std::move(own));
    const Frame frame = pipeline.render(0);
    expectSame(frame, expected_, "short lists");
    EXPECT_GT(nlohmann::json::parse(frame.statsJson)["retries"], 0);
}

TEST_P(FaultsTest, AnyLimitOfMemoryGivesTheSameBytesOrTheFigures) {
    const auto peak = whole_.device().memory().peak;
    bool fitted = false, refused = false;
    for (const std::uint64_t percent : {130U, 100U, 90U, 70U, 50U, 30U}) {
        runtime::DeviceOptions limits;
        limits.memoryLimitBytes = peak * percent / 100;
        const bool fits = succeeds(ExitCode::outOfMemory, "MB", [&] {
            Pipeline pipeline(options_, tinyScene(), ownDevice(limits));
            expectSame(pipeline.render(0), expected_, fmt::format("{} %", percent));
        });
        (fits ? fitted : refused) = true;
    }
    EXPECT_TRUE(fitted);
    EXPECT_TRUE(refused);
}

TEST_P(FaultsTest, ADeviceLostInTheMiddleIsNamed) {
    auto& loss = whole_.device().faults().loss;
    for (const std::uint64_t launches : {0U, 3U, 7U}) {
        loss.after(launches);
        EXPECT_FALSE(succeeds(ExitCode::noDevice, device().info().name + " was lost",
                              [&] { whole_.render(1); }));
    }
    loss.never();
    expectSame(whole_.render(0), expected_, "after the device came back");
}

std::vector<Variant> variants() {
    std::vector<Variant> all;
    for (const auto& entry : visibility::techniques()) all.push_back({entry.name, {}});
    all.push_back({"mlsm", {{"mlsm.build", "list"}}});
    all.push_back({"raster4d", {{"raster4d.method", "grid"}, {"raster4d.grid", "8"}}});
    return all;
}

INSTANTIATE_TEST_SUITE_P(Techniques, FaultsTest, testing::ValuesIn(variants()),
                         [](const auto& test) {
                             return test.param.technique +
                                    (test.param.settings.empty() ? "" : "Variant");
                         });

/// A pipeline whose program is built with a define that breaks it.
Frame renderBroken(const std::string& program, const std::string& define,
                   std::vector<std::string>* warnings = nullptr) {
    auto own = ownDevice();
    own->faults().defines[program] = {define};
    Pipeline pipeline(optionsOf({"vwss", {}}), tinyScene(), std::move(own));
    auto frame = pipeline.render(0);
    if (warnings) *warnings = pipeline.takeWarnings();
    return frame;
}

constexpr const char* kDoesNotBuild = "get_global_id=absent_name";

TEST(ProgramFaultsTest, AProgramThatDoesNotBuildIsNamed) {
    for (const char* program : {"frame", "multi_view"})
        EXPECT_FALSE(succeeds(ExitCode::noDevice, fmt::format("'{}' does not build", program),
                              [&] { renderBroken(program, kDoesNotBuild); }));
}

TEST(ProgramFaultsTest, ADeviceThatFailsItsSelfTestRendersNothing) {
    EXPECT_FALSE(succeeds(ExitCode::noDevice, "fails its self-test",
                          [&] { renderBroken("frame", "SELF_TEST_BROKEN"); }));
}

TEST(ProgramFaultsTest, WithoutAtomicsOf64BitsThatBuildTheImageIsTheSame) {
    if (!device().info().atomics64) GTEST_SKIP() << "the device has none";
    std::vector<std::string> warnings;
    const auto frame = renderBroken("atomic64", kDoesNotBuild, &warnings);
    expectSame(frame, Pipeline(optionsOf({"vwss", {}}), tinyScene()).render(0), "two passes");
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("'atomic64' does not build"), std::string::npos) << warnings[0];
}

}  // namespace
}  // namespace penumbra::tests
