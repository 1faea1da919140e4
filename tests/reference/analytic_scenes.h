// SPDX-License-Identifier: MIT
// Scenes whose soft shadows are known on paper: an occluder over a floor under a light at a height
// of 4 m. Tests hold techniques to them, and `penumbra_papers analytic` prints how far off each is.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace penumbra::tests {

struct AnalyticScene {
    std::string name;
    scene::Scene scene;
    std::string light;  ///< as --light; its name is "key"
    bool disk = false;  ///< samples of a grid suit every technique
    glm::dvec3 eye{0.2, 1.2, 2.6}, target{0};
    /// Share of the light that a point of the floor sees.
    std::function<double(const glm::dvec3&)> truth;
};

/// Edge of a half-plane 1.5 m up, turned by 0 .. 23 times 15 degrees, under a square light of 1 m.
std::vector<AnalyticScene> halfPlanes();
/// A finely cut sphere under a disk.
AnalyticScene sphereUnderDisk();
/// A box under a rectangle.
AnalyticScene boxUnderRectangle();
/// Two half-planes, one over the other, whose edges cross: light passes where it passes both.
AnalyticScene halfPlanesInSeries();
/// Six translucent sheets, each as wide as the light: the product passes.
AnalyticScene sheetsInSeries();

/// How far a picture of a scene is from the truth, over pixels of its floor.
struct AnalyticError {
    double mean = 0;  ///< over the penumbra: truth between 0 and 1
    double bias = 0;  ///< the same with its sign: above 0 is too bright
    double largest = 0;
    std::size_t penumbra = 0;  ///< pixels
    void add(double truth, double measured);
    /// Turns sums into means; call it once, at the end.
    void finish();
};

/// Renders the scenes, 64 x 48 pixels each, and takes their floors together.
AnalyticError measureAnalytic(const std::vector<AnalyticScene>& scenes,
                              const std::string& technique, const std::string& samples);

}  // namespace penumbra::tests
