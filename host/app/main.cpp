// SPDX-License-Identifier: MIT
#include <cstdio>
#include "host/penumbra.h"
int main(int argc, char** argv) try {
    penumbra::RenderOptions o;
    o.profile = true;
    if (argc > 2) o.scene = argv[2];
    o.lightSamples = "24";
    penumbra::Renderer r(o);
    auto f = r.render(0);
    f = r.render(5);
    penumbra::writePng(argv[1], f);
    std::puts(f.statsJson.c_str());
    std::puts(r.statsJson().c_str());
    for (auto& w : r.takeWarnings()) std::puts(w.c_str());
} catch (const std::exception& e) { std::fprintf(stderr, "%s\n", e.what()); return penumbra::exitCodeOf(e); }
