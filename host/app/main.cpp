// SPDX-License-Identifier: MIT
#include <cstdio>
#include <exception>
#include <new>

#include "host/app/cli.h"
#include "host/penumbra.h"
#include "runtime/crash_notice.h"

int main(int argc, char** argv) try {
    penumbra::runtime::announceCrashes();
    return penumbra::app::runCommandLine(argc, argv);
} catch (const std::bad_alloc& error) {
    std::fputs(
        "penumbra: out of memory: the host has none left; use a smaller --size, fewer --aov or a "
        "smaller scene\n",
        stderr);
    return penumbra::exitCodeOf(error);
} catch (const std::exception& error) {
    std::fprintf(stderr, "penumbra: %s\n", error.what());
    return penumbra::exitCodeOf(error);
}
