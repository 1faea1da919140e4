// SPDX-License-Identifier: MIT
// The shadow rays of a whole frame by Embree, beside a technique on the same frame.
#pragma once
#include "host/penumbra.h"

namespace penumbra::papers {

struct EmbreeFrame {
    double ms = 0;  ///< of the rays alone, best of three; the tree is built before
    std::uint64_t rays = 0;
    int threads = 0;
};

/// Opaque shadow rays from every pixel of frame 0 that sees some of the light to each of its
/// samples, columns x rows.
EmbreeFrame traceFrame(RenderOptions options, int columns, int rows);

}  // namespace penumbra::papers
