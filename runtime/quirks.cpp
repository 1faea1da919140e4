// SPDX-License-Identifier: MIT
#include "runtime/quirks.h"

namespace penumbra::runtime {
namespace {

struct Quirk {
    const char *platform, *device;  ///< parts of names; "" matches all
    const char* what;               ///< observed behaviour
    void (*apply)(DeviceInfo&);
};

const Quirk kQuirks[] = {
    {"Portable Computing Language", "",
     "caches kernels by preprocessed source, better than binaries",
     [](DeviceInfo& info) { info.cachesBuilds = true; }},
    {"NVIDIA CUDA", "", "caches compiled programs on disk",
     [](DeviceInfo& info) { info.cachesBuilds = true; }},
    {"Oclgrind", "", "an interpreter for finding errors, thousands of times slower",
     [](DeviceInfo& info) {
         info.chosenUnasked = false;
         info.lanes = 1;
         info.whyNot = "an interpreter, used only when asked for";
     }},
    {"rusticl", "llvmpipe", "64-bit atomics are listed and do not build; slow",
     [](DeviceInfo& info) {
         info.chosenUnasked = false;
         info.atomics64 = false;
         info.lanes = 1;
         info.whyNot = "software rasteriser, used only when asked for";
     }},
    {"", "llvmpipe", "a software rasteriser",
     [](DeviceInfo& info) {
         info.chosenUnasked = false;
         info.atomics64 = false;
         info.whyNot = "software rasteriser, used only when asked for";
     }},
};

}  // namespace

void applyQuirks(DeviceInfo& info) {
    for (const Quirk& quirk : kQuirks)
        if (info.platform.find(quirk.platform) != std::string::npos &&
            info.name.find(quirk.device) != std::string::npos)
            quirk.apply(info);
}

}  // namespace penumbra::runtime
