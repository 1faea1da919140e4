// SPDX-License-Identifier: MIT
#include "tests/support/opened_device.h"

#include <cstdlib>
#include <map>
#include <memory>

namespace penumbra::tests {

runtime::Device& device() {
    // Never destroyed: drivers may be gone already when static objects are
    static auto* const opened = [] {
        const auto devices = runtime::listDevices();
        const bool asked = std::getenv("PENUMBRA_DEVICE") != nullptr;
        return new runtime::Device(
            devices.at(runtime::chooseDevice(devices, asked ? "" : "cpu").index));
    }();
    return *opened;
}

const runtime::Program& program(const std::string& name) {
    static auto& programs = *new std::map<std::string, std::unique_ptr<runtime::Program>>;
    auto& entry = programs[name];
    if (!entry) entry = std::make_unique<runtime::Program>(device(), name);
    return *entry;
}

}  // namespace penumbra::tests
