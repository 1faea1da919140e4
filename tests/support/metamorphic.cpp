// SPDX-License-Identifier: MIT
#include "tests/support/metamorphic.h"

#include <algorithm>
#include <cmath>

#include "host/visibility/technique.h"
#include "tests/support/scene_builder.h"

namespace penumbra::tests {
namespace {

struct Exception {
    const char *technique, *property;
    Allowed allowed;
};

const Exception kExceptions[] = {
    {"vwss", "x", {0, 0, ""}},
};

}  // namespace

std::vector<std::string> shadowTechniques() {
    std::vector<std::string> names;
    for (const auto& entry : visibility::techniques())
        if (std::string(entry.name) != "none") names.emplace_back(entry.name);
    return names;
}

Allowed allowedFor(const std::string& technique, const std::string& property) {
    for (const auto& e : kExceptions)
        if (technique == e.technique && property == e.property) return e.allowed;
    return {};
}

void Difference::add(double difference) {
    sum += std::abs(difference);
    largest = std::max(largest, std::abs(difference));
    ++pixels;
}

Difference differenceOf(const ShadowRun& a, const ShadowRun& b) {
    Difference result;
    for (std::size_t i = 0; i < a.pixels(); ++i)
        if (a.tested(i) && b.tested(i)) result.add(a.visibility[i] - b.visibility[i]);
    return result;
}

Difference differenceWhere(const ShadowRun& run, const ShadowRun& rays, float visibility) {
    Difference result;
    const auto width = static_cast<std::size_t>(rays.width);
    for (std::size_t y = 1; y + 1 < static_cast<std::size_t>(rays.height); ++y)
        for (std::size_t x = 1; x + 1 < width; ++x) {
            bool all = true;
            for (std::size_t k = 0; k < 9 && all; ++k) {
                const std::size_t other = (y + k / 3 - 1) * width + x + k % 3 - 1;
                all = rays.tested(other) && rays.visibility[other] == visibility;
            }
            const std::size_t i = y * width + x;
            if (all && run.tested(i)) result.add(run.visibility[i] - visibility);
        }
    return result;
}

scene::Scene metamorphicSolids() {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    builder.addSphere({-0.75F, 0.875F, 0.25F}, 0.5F, 16, 24);
    builder.addBox({0.375F, 0, -0.625F}, {1.0F, 0.875F, 0.125F});
    builder.addQuad({-0.5F, 1.25F, -0.5F}, {0.75F, 0.25F, 0}, {0, 0.5F, -0.75F});
    return builder.scene();
}

scene::Scene contactScene() {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    builder.addBox({-0.5F, 0, -0.5F}, {0.5F, 1, 0.5F});
    return builder.scene();
}

}  // namespace penumbra::tests
