// SPDX-License-Identifier: MIT
#include "bench/papers/opengl_rival.h"

#include <algorithm>
#include <chrono>

#include "bench/papers/mask_scene.h"
#include "bench/support/egl_maps.h"

namespace penumbra::papers {

double openGlMs(const Request& request, const std::string& scene, int maps) {
    MaskView few;
    few.size = 64;
    few.samples = std::to_string(maps);
    const MaskScene posed(openDevice(request), sceneFile(scene), few);
    const auto view =
        visibility::fitLightView(posed.light(), posed.bounds(), posed.bounds().centre(), 1024, 1);
    const bench::EglContext context(0);
    bench::EglMaps rival(context, posed.mesh(), view, std::min(8, maps), bench::EglForm::perView);
    double best = 1e30;
    for (int i = 0; i < 4; ++i) {
        const auto start = std::chrono::steady_clock::now();
        rival.run();
        const std::chrono::duration<double, std::milli> ms =
            std::chrono::steady_clock::now() - start;
        if (i > 0) best = std::min(best, ms.count());
    }
    return best;
}

}  // namespace penumbra::papers
