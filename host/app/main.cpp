// SPDX-License-Identifier: MIT
#include <cstdio>
#include <exception>

#include "host/app/cli.h"
#include "host/penumbra.h"

int main(int argc, char** argv) try {
    return penumbra::app::runCommandLine(argc, argv);
} catch (const std::exception& error) {
    std::fprintf(stderr, "penumbra: %s\n", error.what());
    return penumbra::exitCodeOf(error);
}
