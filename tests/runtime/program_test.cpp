// SPDX-License-Identifier: MIT
// Programs, kernels and their cache.
#include "runtime/program.h"

#include <filesystem>
#include <fstream>
#include <thread>

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
    /// Makes the program anew and runs its self-test; returns what was built and loaded, and keeps
    /// what the device warned of.
    runtime::ProgramStats use(bool cache = true) {
        std::vector<std::string> warnings;
        const auto stats = use(cache, warnings);
        warnings_ = warnings;
        return stats;
    }
    static runtime::ProgramStats use(bool cache, std::vector<std::string>& warnings) {
        auto info = device().info();
        info.cachesBuilds = false;
        runtime::DeviceOptions options;
        options.cache = cache;
        runtime::Device own(info, options);
        const runtime::Program frame(own, "frame");
        runtime::selfTest(frame);
        EXPECT_FALSE(frame.signatures().empty());
        warnings = own.takeWarnings();
        return own.programs();
    }
    std::filesystem::path entry() const {
        for (const auto& file : std::filesystem::directory_iterator(folder_ + "/penumbra"))
            return file.path();
        return {};
    }
    /// The last use warned once, of this.
    void expectWarning(const std::string& part) const {
        ASSERT_EQ(warnings_.size(), 1U);
        EXPECT_NE(warnings_[0].find(part), std::string::npos) << warnings_[0];
    }
    std::string folder_, saved_;
    std::vector<std::string> warnings_;
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
    expectWarning(entry().string() + ": the cached program is compiled anew: it is damaged");
    EXPECT_EQ(use().loaded, 1);  // and was replaced
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(ProgramCacheTest, AnEntryOfAnotherVersionIsBuiltAnew) {
    use();
    std::fstream file(entry(), std::ios::in | std::ios::out | std::ios::binary);
    file << "penumbra-program-0";
    file.close();
    EXPECT_EQ(use().built, 1);
    expectWarning("it is of another version");
    EXPECT_EQ(use().loaded, 1);
}

TEST_F(ProgramCacheTest, AFolderThatCannotBeWrittenIsSaid) {
    std::ofstream(folder_ + "/penumbra") << "a file where the folder should be";
    EXPECT_EQ(use().built, 1);
    expectWarning("the cache " + folder_ + "/penumbra cannot be written");
}

TEST_F(ProgramCacheTest, SeveralMayShareAnEmptyFolder) {
    std::vector<std::vector<std::string>> warnings(4);
    std::vector<std::thread> threads;
    for (auto& of : warnings) threads.emplace_back([&of] { use(true, of); });
    for (auto& thread : threads) thread.join();
    for (const auto& of : warnings) EXPECT_EQ(of, std::vector<std::string>{});
    EXPECT_EQ(use().loaded, 1);
    const std::filesystem::directory_iterator files(folder_ + "/penumbra");
    EXPECT_EQ(std::distance(begin(files), end(files)), 1);
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
