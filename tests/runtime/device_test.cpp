// SPDX-License-Identifier: MIT
#include "runtime/device.h"

#include <gtest/gtest.h>

#include "runtime/error.h"

namespace penumbra::runtime {
namespace {

DeviceInfo make(const char* platform, const char* name, bool gpu, int units) {
    DeviceInfo info;
    info.platform = platform;
    info.name = name;
    info.isGpu = gpu;
    info.isCpu = !gpu;
    info.computeUnits = units;
    info.clockMhz = 1000;
    return info;
}

/// A machine with one of each kind; platform and device indices as a loader would number them.
std::vector<DeviceInfo> machine() {
    auto devices = std::vector<DeviceInfo>{
        make("PoCL", "pthread-cpu", false, 8), make("Oclgrind", "Simulator", false, 64),
        make("Fast", "small gpu", true, 2), make("Fast", "big gpu", true, 40)};
    devices[1].chosenUnasked = false;
    for (int i = 0; i < 3; ++i) devices[static_cast<std::size_t>(i)].platformIndex = i;
    devices[3].platformIndex = 2;
    devices[3].deviceIndex = 1;
    return devices;
}

std::string chosen(const std::string& request) {
    const auto devices = machine();
    return devices[chooseDevice(devices, request).index].name;
}

class DeviceChoiceTest : public testing::Test {
  protected:
    void SetUp() override {
        if (const char* value = std::getenv("PENUMBRA_DEVICE")) saved_ = value;
        unsetenv("PENUMBRA_DEVICE");
    }
    void TearDown() override {
        if (!saved_.empty()) setenv("PENUMBRA_DEVICE", saved_.c_str(), 1);
    }
    std::string saved_;
};

TEST_F(DeviceChoiceTest, TheFastestGpuIsTheDefault) {
    EXPECT_EQ(chosen(""), "big gpu");
}

TEST_F(DeviceChoiceTest, WithoutAGpuTheCpuIsTaken) {
    auto devices = machine();
    devices.resize(2);
    EXPECT_EQ(devices[chooseDevice(devices, "").index].name, "pthread-cpu");
}

TEST_F(DeviceChoiceTest, EmulatorsAreNeverChosenUnaskedHoweverManyUnitsTheyClaim) {
    EXPECT_EQ(chosen("cpu"), "pthread-cpu");
    EXPECT_EQ(chosen("oclgrind"), "Simulator");
}

TEST_F(DeviceChoiceTest, IndexPlatformPairAndPartOfANameSelect) {
    EXPECT_EQ(chosen("2"), "small gpu");
    EXPECT_EQ(chosen("2:1"), "big gpu");
    EXPECT_EQ(chosen("fast:small"), "small gpu");
    EXPECT_EQ(chosen("BIG"), "big gpu");
}

TEST_F(DeviceChoiceTest, TheEnvironmentAsksWhereTheUserDoesNot) {
    setenv("PENUMBRA_DEVICE", "pthread", 1);
    EXPECT_EQ(chosen(""), "pthread-cpu");
    EXPECT_EQ(chosen("gpu"), "big gpu");
    unsetenv("PENUMBRA_DEVICE");
}

void expectNoDevice(const std::vector<DeviceInfo>& devices, const std::string& request,
                    const std::string& part) {
    try {
        chooseDevice(devices, request);
        FAIL() << "a device was chosen";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::noDevice);
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST_F(DeviceChoiceTest, AnUnknownNameListsWhatWasFound) {
    expectNoDevice(machine(), "radeon", "big gpu");
    expectNoDevice(machine(), "17", "allowed: cpu, gpu");
}

TEST_F(DeviceChoiceTest, NoDeviceSaysWhereDriversAreLookedFor) {
    expectNoDevice({}, "", "pocl-opencl-icd");
}

TEST_F(DeviceChoiceTest, AnUnusableDeviceIsRefusedWithItsReason) {
    auto devices = machine();
    devices[0].usable = false;
    devices[0].whyNot = "has no compiler";
    expectNoDevice(devices, "pthread", "has no compiler");
}

}  // namespace
}  // namespace penumbra::runtime
