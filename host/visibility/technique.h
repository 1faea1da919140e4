// SPDX-License-Identifier: MIT
// What every shadow technique offers. A technique composes passes; it never calls another
// technique.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "host/gbuffer/gbuffer.h"
#include "host/geometry/geometry.h"
#include "host/scene/bounds.h"
#include "host/scene/light.h"
#include "host/settings.h"
#include "runtime/memory_plan.h"

namespace penumbra::visibility {

using gbuffer::GBuffer;
using geometry::Mesh;
using runtime::Buffer;

/// Share of the light that each pixel sees, 0 to 1: float [channels, planeStride].
struct Visibility {
    int channels = 1;
    Buffer<float> planes;
    Buffer<std::uint32_t> state;  ///< [planeStride] STATE_*: what metrics leave out
};

/// Depth maps on the host, when the user asks to see them: [view, row, column], reversed depth.
struct DepthMaps {
    int views = 0, size = 0;
    std::vector<float> depths;
};

/// Occlusion masks on the host, when the user asks to see them.
struct OcclusionMasks {
    int columns = 0, rows = 0;  ///< cells of the light
    std::size_t stride = 0;     ///< pixels between planes
    /// [row, word, stride]: bit j of word w: the sample in column 32 w + j is hidden. Words of 32
    /// columns.
    std::vector<std::uint32_t> bits;
    std::vector<int> samples;  ///< [rows, columns] index of the light sample, -1: none
    int words() const { return (columns + 31) / 32; }
};

struct Inputs {
    const Mesh& mesh;
    const GBuffer& gbuffer;
    const scene::AreaLight& light;
    const scene::Bounds& casters;
    glm::dvec3 centre;                ///< what the world was re-based to
    DepthMaps* depthMaps = nullptr;   ///< filled if not null (waits for the device)
    OcclusionMasks* masks = nullptr;  ///< the same
};

/// What a frame of a technique did; summed over lights.
struct Counts {
    std::uint64_t points = 0, outsideFov = 0, nearPoints = 0;
    std::uint64_t mapTriangles = 0;  ///< drawn into each depth map
    std::uint64_t mapBytes = 0;  ///< of all depth maps, whether they are held at once or in turn
};

class Technique {
  public:
    virtual ~Technique() = default;
    /// Channels of the visibility that run() makes: 3 where it carries colour, else 1.
    virtual int channels(const Mesh&) const { return 1; }
    /// Once a frame, before the lights: trees and sorts that all lights share.
    virtual void prepare(const Mesh&, const scene::Bounds& /*casters*/,
                         const glm::dvec3& /*centre*/) {}
    /// False if there are no depth maps to keep for --aov depth-maps.
    virtual bool hasDepthMaps() const { return true; }
    /// Bytes of a light's occlusion masks, for --aov mask; 0: it makes none.
    virtual std::uint64_t maskBytes(const scene::AreaLight&) const { return 0; }
    /// Throws Error (usage) if it cannot use the light's samples, naming what it can.
    virtual void check(const scene::AreaLight&) const {}
    /// Bytes that the first frame will allocate at the least; the rest is held by now, or grows
    /// with lists whose length only the device knows.
    virtual std::uint64_t frameBytes(const Mesh&) const { return 0; }
    /// Enqueues one light's visibility. Allocates only when sizes change.
    virtual void run(const Inputs& inputs, Visibility& visibility) = 0;
    /// Waits for the device; true if a list was too short and has grown: repeat the frame.
    virtual bool grew() { return false; }
    /// Counts of the frame; call after grew(). Starts anew.
    virtual Counts takeCounts() { return {}; }
    /// Settings in force.
    virtual std::vector<SettingRow> settings() const { return {}; }
    /// Names what the last frame had to give up, once each ("density 0.7 of 1 ...").
    virtual std::vector<std::string> warnings() const { return {}; }
};

/// What a technique is made with.
struct TechniqueContext {
    runtime::Device& device;
    const SettingValues& values;
    int width, height;  ///< of the G-buffer
    /// Of the height: the last rows hold blended fragments, whose neighbours there are no
    /// neighbours on the screen. They are receivers as any pixel.
    int fragmentRows = 0;
};

/// A row of the list of techniques.
struct TechniqueEntry {
    const char* name;
    const char* summary;
    const char* source;    ///< key of the paper and section
    const char* failures;  ///< known failures, for `penumbra techniques`
    std::vector<SettingRow> (*describe)();
    /// Throws Error (usage) naming what is wrong with the values.
    void (*check)(const std::string& technique, const SettingValues& values);
    /// What it will hold at the least: batches of maps shrink to what is left, lists grow.
    std::uint64_t (*plannedBytes)(const TechniqueContext&);
    std::unique_ptr<Technique> (*make)(const TechniqueContext&);
};

/// The only list; see techniques.cpp.
const std::vector<TechniqueEntry>& techniques();
/// Throws Error (usage) naming the techniques.
const TechniqueEntry& findTechnique(const std::string& name);

}  // namespace penumbra::visibility
