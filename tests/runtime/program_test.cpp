// SPDX-License-Identifier: MIT
// Programs, kernels and their cache.
#include "runtime/program.h"

#include <filesystem>
#include <fstream>

#include "kernels/shared/mesh.h"
#include "runtime/error.h"
#include "runtime/kernel.h"
#include "runtime/self_test.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using runtime::Kernel;
using U32 = std::uint32_t;

TEST(ProgramTest, AnUnknownProgramIsNamed) {
    EXPECT_THROW(runtime::Program(device(), "absent"), Error);
}

TEST(ProgramTest, ABuildFailureNamesDeviceOptionsFileAndLine) {
    try {
        runtime::Program(device(), "frame", {"DRAW_ANY=1", "get_global_id=absent_name"});
        FAIL() << "it builds";
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find(device().info().name), std::string::npos);
        EXPECT_NE(text.find("-Dget_global_id=absent_name"), std::string::npos);
        EXPECT_NE(text.find("kernels/"), std::string::npos) << text;
    }
}

TEST(KernelTest, AParameterOfAnotherTypeIsRefusedWithBothTypes) {
    try {
        Kernel<int, Buffer<float>> kernel(program("frame"), "self_test");
        FAIL() << "float* is taken for uint*";
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("uint*"), std::string::npos) << text;
        EXPECT_NE(text.find("float*"), std::string::npos) << text;
    }
}

TEST(KernelTest, AWrongNumberOfParametersIsRefused) {
    EXPECT_THROW((Kernel<int>(program("frame"), "self_test")), Error);
}

TEST(KernelTest, AnUnknownKernelIsNamed) {
    EXPECT_THROW((Kernel<int>(program("frame"), "absent")), Error);
}

/// A device that does not leave caching to its driver, with a cache folder of its own.
class ProgramCacheTest : public testing::Test {
  protected:
    void SetUp() override {
        device();  // drivers look for their own cache folder when they start: not in ours
        folder_ = temporaryFolder("program-cache");
        if (const char* value = std::getenv("XDG_CACHE_HOME")) saved_ = value;
        setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    }
    void TearDown() override {
        if (saved_.empty())
            unsetenv("XDG_CACHE_HOME");
        else
            setenv("XDG_CACHE_HOME", saved_.c_str(), 1);
    }
    /// Makes the program anew and runs its self-test; returns what was built and loaded.
    runtime::ProgramStats use(bool cache = true) {
        auto info = device().info();
        info.cachesBuilds = false;
        runtime::DeviceOptions options;
        options.cache = cache;
        runtime::Device own(info, options);
        const runtime::Program frame(own, "frame");
        runtime::selfTest(frame);
        EXPECT_FALSE(frame.signatures().empty());
        return own.programs();
    }
    std::filesystem::path entry() const {
        for (const auto& file : std::filesystem::directory_iterator(folder_ + "/penumbra"))
            return file.path();
        return {};
    }
    std::string folder_, saved_;
};

TEST_F(ProgramCacheTest, TheSecondStartLoadsWhatTheFirstBuilt) {
    EXPECT_EQ(use().built, 1);
    const auto second = use();
    EXPECT_EQ(second.built, 0);
    EXPECT_EQ(second.loaded, 1);
}

TEST_F(ProgramCacheTest, ADamagedEntryIsBuiltAnew) {
    use();
    std::fstream file(entry(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(-10, std::ios::end);
    file.put('!');
    file.close();
    EXPECT_EQ(use().built, 1);
    EXPECT_EQ(use().loaded, 1);  // and was replaced
}

TEST_F(ProgramCacheTest, ATruncatedEntryIsBuiltAnew) {
    use();
    std::filesystem::resize_file(entry(), std::filesystem::file_size(entry()) / 2);
    EXPECT_EQ(use().built, 1);
}

TEST_F(ProgramCacheTest, NoCacheNeitherReadsNorWrites) {
    use(false);
    EXPECT_FALSE(std::filesystem::exists(folder_ + "/penumbra"));
}

}  // namespace
}  // namespace penumbra::tests
