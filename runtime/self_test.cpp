// SPDX-License-Identifier: MIT
#include "runtime/self_test.h"

#include <bit>

#include "runtime/error.h"
#include "runtime/kernel.h"

namespace penumbra::runtime {

void selfTest(const Program& frame) {
    constexpr int kItems = 1000;
    Device& device = frame.device();
    Buffer<std::uint32_t> results(device, "self-test", 4);
    results.fill(0);
    Kernel<int, Buffer<std::uint32_t>> kernel(frame, "self_test");
    kernel.launch({kItems}, {64}, kItems, results);
    const auto r = results.download();
    const auto refuse = [&](const char* what) {
        throw Error(
            fmt::format("device {} fails its self-test: {}; choose another with --device or update "
                        "its driver",
                        device.info().name, what),
            ExitCode::noDevice);
    };
    if (r[0] != std::bit_cast<std::uint32_t>(kItems - 0.5F)) refuse("32-bit atomic maximum");
    if (r[1] != kItems) refuse("32-bit atomic increment");
    if (r[2] != 1) refuse("fused multiply-add rounds twice");
    if (r[3] != 1) refuse("vectors or rounding conversions");
}

}  // namespace penumbra::runtime
