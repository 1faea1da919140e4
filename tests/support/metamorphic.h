// SPDX-License-Identifier: MIT
// What the properties of tests/visibility/metamorphic_test.cpp are stated with: scenes, differences
// of images, and which technique cannot keep which property.
#pragma once
#include <string>
#include <vector>

#include "host/scene/scene.h"
#include "tests/reference/shadow_run.h"

namespace penumbra::tests {

/// All of host/visibility/techniques.cpp but `none`.
std::vector<std::string> shadowTechniques();

/// How far a technique may be from a property, and why it may. By default: a step of 1/65536 in few
/// pixels, which is how lookups count light.
struct Allowed {
    double mean = 1e-6, largest = 2e-5;
    const char* why = "every technique keeps this; see kExceptions";
};
Allowed allowedFor(const std::string& technique, const std::string& property);

/// Absolute differences of visibility.
struct Difference {
    double sum = 0, largest = 0;
    std::size_t pixels = 0;
    void add(double difference);
    double mean() const { return pixels ? sum / static_cast<double>(pixels) : 0; }
};
/// Over pixels that both tested.
Difference differenceOf(const ShadowRun& a, const ShadowRun& b);
/// Over pixels where rays, and their neighbours' rays, see all (1) or nothing (0) of the light.
Difference differenceWhere(const ShadowRun& run, const ShadowRun& rays, float visibility);

/// A floor, a sphere above it, a box on it and a leaning sheet that holds the bounds.
scene::Scene metamorphicSolids();
constexpr std::size_t kSolidsSphere = 1;  ///< node
/// A box on a floor; both cast.
scene::Scene contactScene();

}  // namespace penumbra::tests
