// SPDX-License-Identifier: MIT
// The area lights of a frame and their light samples.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/scene/animation.h"
#include "host/scene/bounds.h"
#include "host/scene/scene.h"

namespace penumbra::scene {

enum class Pattern { hammersley, poisson, grid, jittered, random };

/// Which samples a light gets. columns x rows > 0: cells of a grid (on a disk those whose centre
/// lies inside); else `count` samples of `pattern`.
struct SampleChoice {
    int count = 64;
    int columns = 0, rows = 0;
    Pattern pattern = Pattern::hammersley;
    std::uint32_t seed = 0;
};

/// "64" or "8x8". Throws Error (usage). At most 4096 samples.
SampleChoice parseSampleCount(const std::string& text, SampleChoice base,
                              const std::string& option = "--light-samples");
Pattern parsePattern(const std::string& text);
/// A number below 2^32, or "frame" for the frame's own. Throws Error (usage).
std::uint32_t parseSeed(const std::string& text, int frame);

/// Offsets in [-1, 1]^2 (disk: in the unit disk), to be scaled by half the light's size.
/// hammersley lies concentrically on disks, poisson is Bridson's in the shape itself; one sample
/// lies at the centre.
std::vector<glm::dvec2> samplePattern(const SampleChoice& choice, bool disk);
struct AreaLight;
/// Gives a light the samples of a choice; a point has one.
void placeSamples(SampleChoice choice, AreaLight& light);

/// A light at one time, in the world. Emits along the frame's third axis from a rectangle or disk
/// in the plane of the first two; a sphere is a disk of its radius that faces C.
struct AreaLight {
    std::string name;  ///< [A-Za-z0-9_-], unique
    bool disk = false;
    glm::dvec3 centre{0};
    glm::dvec3 axisX{1, 0, 0}, axisY{0, 1, 0},
        axisZ{0, 0, 1};                         ///< orthonormal; axisZ: where light goes
    double width = 1, height = 1;               ///< metres; both 0: a point
    glm::dvec3 radiance{1};                     ///< a point: intensity
    double innerConeRad = 0, outerConeRad = 0;  ///< outer 0: no cone
    double fovRad = 0, nearMetres = 0;          ///< 0: fitted
    std::vector<glm::dvec2> samples;            ///< metres along axisX, axisY
    /// Where set, rays go to random points of their own in each pixel, as many as there are
    /// samples.
    std::optional<std::uint32_t> randomSeed;
    bool isPoint() const { return width <= 0 && height <= 0; }
};

/// All lights at a time. A scene without lights gets a rectangle of 0.75 R at C + 3 R
/// normalize(-0.5, 1, 0.6), aimed at C, of radiance 50.
std::vector<AreaLight> lightsAt(const Scene& scene, const Pose& pose, const Bounds& bounds,
                                const SampleChoice& samples);

/// Irradiance that an unoccluded surface at `point`, facing the light's centre, receives: RGB.
glm::dvec3 facingIrradiance(const AreaLight& light, const glm::dvec3& point);

/// Parses "rect:at=0,4,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=20", "disk:" and "sphere:" with
/// radius=. Throws Error (usage) that names the field.
Light parseLight(const std::string& text);

}  // namespace penumbra::scene
