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

// Known limits of the published techniques: mean and largest difference of visibility with room
// for other devices' rounding, over what was measured (in parentheses).
const Exception kExceptions[] = {
    {"vwss", "halves", {0.003, 0.2, "the enlarged view is as large as the light (0.0015, 0.13)"}},
    {"vwss", "leak", {0.012, 0.3, "back faces make no points, steep ones few (0.0083, 0.20)"}},
    {"vwss", "acne", {0.002, 0.8, "taps at a wall's foot lie behind the floor (0.0014, 0.75)"}},
    {"vwss", "box", {0.02, 0.2, "points of slanting faces lie too far apart (0.0121, 0.125)"}},
    {"mvr", "acne", {0.0015, 0.5, "taps at a wall's foot lie behind the floor (0.0010, 0.39)"}},
    {"mvss", "mirror", {0.006, 0.2, "its Poisson samples have no mirror image (0.0040, 0.14)"}},
    {"mvss", "halves", {0.005, 0.14, "every light has the same 28 samples (0.0032, 0.09)"}},
    {"mvss", "leak", {0.0001, 0.02, "its bias is set, not fitted (0.00001, 0.007)"}},
    {"mvss",
     "acne",
     {0.01, 0.5,
      "its bias is set, its samples are not those of rays (0.0070, "
      "0.33)"}},
    {"pcss", "mirror", {0.003, 0.08, "each pixel turns its taps its own way (0.0016, 0.04)"}},
    {"pcss", "halves", {0.008, 0.3, "it looks from the light's centre alone (0.0054, 0.19)"}},
    {"pcss", "removal", {0.0001, 0.03, "blockers count by their mean depth (0.00001, 0.010)"}},
    {"pcss", "leak", {0.011, 0.3, "it looks from the light's centre alone (0.0073, 0.18)"}},
    {"pcss", "acne", {0.01, 0.7, "the filter reaches from a wall into its floor (0.0068, 0.47)"}},
    {"essm", "halves", {0.011, 0.8, "it looks from the light's centre alone (0.0075, 0.53)"}},
    {"essm", "removal", {0.0001, 0.04, "blockers count by their mean depth (0.00001, 0.015)"}},
    {"essm", "leak", {0.007, 0.2, "exponentials leak where blockers are near (0.0046, 0.13)"}},
    {"essm", "acne", {0.011, 0.7, "the filter reaches from a wall into its floor (0.0074, 0.47)"}},
    {"mlsm", "halves", {0.009, 0.66, "it looks from the light's centre alone (0.0058, 0.44)"}},
    {"mlsm",
     "leak",
     {0.0015, 0.05,
      "a face that ends at the foot covers part of a texel (0.0010, "
      "0.034)"}},
    {"mlsm",
     "acne",
     {0.0005, 0.05,
      "its filter is as wide as the light's centre sees it (0.0003, "
      "0.030)"}},
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
