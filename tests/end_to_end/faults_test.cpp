// SPDX-License-Identifier: MIT
// What the machine may do to a frame: memory that is refused, lists that are too short, a device
// that is gone. Either an error that says so, or the same bytes; never a wrong image.
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>

#include "host/pipeline.h"
#include "host/visibility/technique.h"
#include "runtime/error.h"
#include "tests/support/fixtures.h"
#include "tests/support/tiny_scene.h"

namespace penumbra::tests {
namespace {

/// A technique and what follows after _; settings where it has lists of its own; whether these are
/// too short at first.
struct Variant {
    std::string name;
    bool ownLists = false;
    std::map<std::string, std::string> settings = {};
};

RenderOptions optionsOf(const Variant& variant) {
    RenderOptions options = tinyOptions();
    options.technique = variant.name.substr(0, variant.name.find('_'));
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

/// What an undisturbed device makes of a variant, and the most memory that this may take.
struct Undisturbed {
    Frame frame;
    std::uint64_t bytes = 0;
};

const Undisturbed& undisturbed(const Variant& variant) {
    static std::map<std::string, Undisturbed> known;
    auto& entry = known[variant.name];
    if (!entry.bytes) {
        Pipeline pipeline(optionsOf(variant), tinyScene(), ownDevice());
        entry.frame = pipeline.render(0);
        const auto memory = nlohmann::json::parse(pipeline.statsJson())["memory"];
        const std::uint64_t peak = memory["peak"], planned = memory["planned"];
        entry.bytes = std::max(peak, planned);
    }
    return entry;
}

class FaultsTest : public testing::TestWithParam<Variant> {
  protected:
    Pipeline make(std::unique_ptr<runtime::Device> own) const {
        return {options_, tinyScene(), std::move(own)};
    }
    void expectRight(Pipeline& pipeline, const std::string& what) const {
        expectSame(pipeline.render(0), expected_.frame, what);
    }
    /// Refuses allocation n of a frame and its passes for n = first, first + step, ...
    void failAllocations(std::uint64_t first, std::uint64_t step) const;
    const RenderOptions options_ = optionsOf(GetParam());
    const Undisturbed& expected_ = undisturbed(GetParam());
};

void FaultsTest::failAllocations(std::uint64_t first, std::uint64_t step) const {
    auto pipeline = make(ownDevice());
    auto& faults = pipeline.device().faults();
    // A failure drops what was made for frames, so that all of it is allocated anew
    faults.loss.after(0);
    EXPECT_THROW(pipeline.render(0), Error);
    faults.loss.never();
    auto n = first;
    const auto render = [&] { expectRight(pipeline, fmt::format("allocation {}", n)); };
    for (;; n += step) {
        faults.allocation.after(n);
        if (succeeds(ExitCode::outOfMemory, "MB", render)) break;
    }
    EXPECT_GT(n, 20U);
    faults.allocation.never();
    render();
}

/// One of 25, other ones with each variant; all of them, which takes a minute, in
/// tools/check_allocations.
TEST_P(FaultsTest, AllocationsMayFailAndTheNextFrameIsRight) {
    if (std::getenv("PENUMBRA_EVERY_ALLOCATION") != nullptr)
        failAllocations(0, 1);
    else
        failAllocations(5 * (GetParam().name.size() % 5), 25);
}

TEST_P(FaultsTest, ListsThatBeginWithNothingGrowToTheSameBytes) {
    auto own = ownDevice();
    own->faults().firstCapacity = 1;
    auto pipeline = make(std::move(own));
    const Frame frame = pipeline.render(0);
    expectSame(frame, expected_.frame, "short lists");
    // Those of the camera grow before the first frame
    EXPECT_EQ(nlohmann::json::parse(frame.statsJson)["retries"] > 0, GetParam().ownLists);
}

TEST_P(FaultsTest, AnyLimitOfMemoryGivesTheSameBytesOrTheFigures) {
    std::vector<bool> fits;
    for (const std::uint64_t percent : {101U, 80U, 40U}) {
        runtime::DeviceOptions limits;
        limits.memoryLimitBytes = expected_.bytes * percent / 100;
        fits.push_back(succeeds(ExitCode::outOfMemory, "MB", [&] {
            auto pipeline = make(ownDevice(limits));
            expectRight(pipeline, fmt::format("{} %", percent));
        }));
    }
    EXPECT_TRUE(fits.front());
    EXPECT_FALSE(fits.back());
}

TEST_P(FaultsTest, ADeviceLostInTheMiddleIsNamed) {
    auto pipeline = make(ownDevice());
    auto& loss = pipeline.device().faults().loss;
    for (const std::uint64_t launches : {7U, 0U}) {
        loss.after(launches);
        EXPECT_FALSE(succeeds(ExitCode::noDevice, device().info().name + " was lost",
                              [&] { pipeline.render(1); }));
    }
    loss.never();
    expectRight(pipeline, "after the device came back");
}

const std::vector<Variant>& variants() {
    static const std::vector<Variant> all = {
        {"vwss", true},
        {"mvr", false},
        {"mvr_textbook", true, {{"mvr.form", "textbook"}}},
        {"mvss", false},
        {"pcss", true},
        {"essm", true},
        {"mlsm", true},
        {"mlsm_list", true, {{"mlsm.build", "list"}}},
        {"raster4d", false},
        {"raster4d_grid", true, {{"raster4d.method", "grid"}, {"raster4d.grid", "8"}}},
        {"raytrace", false},
        {"none", false}};
    return all;
}

INSTANTIATE_TEST_SUITE_P(Techniques, FaultsTest, testing::ValuesIn(variants()),
                         [](const auto& test) { return test.param.name; });

TEST(FaultVariantsTest, NoTechniqueIsForgotten) {
    for (const auto& entry : visibility::techniques())
        EXPECT_TRUE(std::any_of(variants().begin(), variants().end(), [&](const auto& v) {
            return v.name == entry.name;
        })) << entry.name;
}

/// A pipeline whose program is built with a define that breaks it.
Frame renderBroken(const std::string& program, const std::string& define,
                   std::vector<std::string>* warnings = nullptr) {
    auto own = ownDevice();
    own->faults().defines[program] = {define};
    Pipeline pipeline(optionsOf({"vwss"}), tinyScene(), std::move(own));
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
    expectSame(frame, Pipeline(optionsOf({"vwss"}), tinyScene()).render(0), "two passes");
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("'atomic64' does not build"), std::string::npos) << warnings[0];
}

}  // namespace
}  // namespace penumbra::tests
