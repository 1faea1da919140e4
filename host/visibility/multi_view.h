// SPDX-License-Identifier: MIT
// Averages shadow tests over the parallel views of a light, a batch of depth maps at a time. A
// source fills the maps, a reader tests receivers against them; which pixels are tested, batches,
// accumulation and what lies outside of the views are the same for all.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "host/visibility/light_view.h"
#include "host/visibility/multi_view_settings.h"
#include "host/visibility/occupancy.h"
#include "host/visibility/raytrace.h"
#include "host/visibility/technique.h"

namespace penumbra::visibility {

/// Depth maps [view - firstView, row, column] with a stride of params.mapStride texels.
struct MapBatch {
    int firstView = 0, viewCount = 0;
    Buffer<std::uint32_t>* maps32 = nullptr;  ///< float bits
    Buffer<std::uint16_t>* maps16 = nullptr;  ///< depth x 65535; null with 32 bits
};

/// Fills depth maps of the views of one light.
class MapSource {
  public:
    virtual ~MapSource() = default;
    /// Called once per light, before its batches. May adapt `view.params`.
    virtual void begin(const Inputs& inputs, LightView& view, Buffer<float>& samples,
                       Buffer<shared::MultiViewCounters>& counters) = 0;
    /// Pixels of the enlarged view per texel of a map, where the source looks through that view.
    virtual double density() const { return 1; }
    /// False if it makes something else than depth maps: none are allocated, and fill is called
    /// once.
    virtual bool makesMaps() const { return true; }
    /// Enqueues filling all maps of the batch: maps32 where needsWideMaps(), else the narrower one.
    virtual void fill(const MapBatch& batch) = 0;
    /// True if only 32-bit maps can be filled: 16-bit ones are packed from them.
    virtual bool needsWideMaps() const = 0;
    virtual bool grew() = 0;
};

/// The pixels that are tested, in the central view of the light; layouts in
/// kernels/shared/multi_view.h.
struct ReceiverImage {
    int width = 0;                           ///< receivers in a row
    int stride = 0;                          ///< floats between planes
    int onScreen = 0;                        ///< the first ones, neighbours as on the screen
    Buffer<float> planes;                    ///< [RECEIVER_PLANES, stride]
    Buffer<std::uint32_t> hidden;            ///< [channels, stride] tests that failed
    const Buffer<float>* samples = nullptr;  ///< [view, 2] kx, ky
};

/// Tests receivers against maps.
class MapReader {
  public:
    virtual ~MapReader() = default;
    /// True if it looks for nothing but what hides a sample: receivers that no caster can shadow
    /// may be left out.
    virtual bool testsSamples() const { return false; }
    /// Of visibility; more than 1 where what hides a receiver has colour.
    virtual int channels() const { return 1; }
    /// Tests of a receiver in each map: visibility is 1 - hidden / (maps x weight).
    virtual int weight() const = 0;
    /// Enqueues adding the failed tests of the batch's maps to receivers.hidden.
    virtual void read(const LightView& view, const MapBatch& batch, ReceiverImage& receivers) = 0;
};

class MultiView {
  public:
    /// The last `fragmentRows` of the height hold pixels without neighbours on the screen: each is
    /// tested itself, also with halfResolution.
    MultiView(const runtime::Program& multiView, const MapSettings& settings, int width, int height,
              int fragmentRows = 0);

    /// Receivers and one depth map: the least that it works with.
    static std::uint64_t plannedBytes(const MapSettings& settings, int width, int height);
    /// Bytes of one map and of a light's samples, which the first frame allocates.
    std::uint64_t frameBytes(bool wideMaps) const;
    /// Enqueues one light's visibility. `views` is the inputs' light with the samples that are the
    /// views; what lies outside of them is traced to the inputs' own samples.
    void run(const Inputs& inputs, const scene::AreaLight& views, MapSource& source,
             MapReader& reader, Visibility& visibility);
    /// Reads the counters of the frame's lights (waits) and starts anew.
    Counts takeCounts();
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    /// What traces the receivers outside of the views; made when a light first needs it.
    struct Tracer {
        Tracer(runtime::Device& device, int width, int height)
            : frame(device, "frame"),
              program(device, "raytrace"),
              bvh(frame, program),
              pass(program, width, height) {}
        runtime::Program frame, program;
        Bvh bvh;
        RayPass pass;
    };
    struct PerLight {
        Buffer<float> samples;
        Buffer<shared::MultiViewCounters> counters;
        bool used = false;
    };
    int batchSize(const LightView& view, bool wide) const;
    void allocateMaps(const LightView& view, int batch, bool wide);
    void pack(const LightView& view, const MapBatch& batch);
    void readMaps(const Inputs& inputs, const LightView& view, MapSource& source,
                  MapReader& reader);
    void traceOutside(const Inputs& inputs, Visibility& visibility);
    void average(int tests, int channels, const GBuffer& gbuffer, Visibility& visibility);
    void keepMaps(const LightView& view, const MapBatch& batch, DepthMaps& out);

    runtime::Device* device_;
    MapSettings settings_;
    int stride_;
    shared::ReceiverParams image_{};
    runtime::Kernel<shared::ReceiverParams, shared::MultiViewParams, Buffer<float>, Buffer<float>,
                    Buffer<std::uint32_t>, Buffer<std::uint32_t>, Buffer<shared::MultiViewCounters>>
        receivers_;
    Occupancy occupancy_;
    runtime::Kernel<std::uint32_t, Buffer<std::uint32_t>, Buffer<std::uint16_t>> pack_;
    runtime::Kernel<int, int, int, Buffer<std::uint32_t>, Buffer<std::uint32_t>, Buffer<float>>
        average_;
    runtime::Kernel<shared::ReceiverParams, int, int, Buffer<float>, Buffer<std::uint32_t>,
                    Buffer<std::uint32_t>, Buffer<float>>
        upsample_;
    ReceiverImage receiverImage_;
    Buffer<std::uint32_t> maps32_;
    Buffer<std::uint16_t> maps16_;
    std::vector<std::unique_ptr<PerLight>> lights_;
    std::size_t nextLight_ = 0;
    std::uint64_t mapBytes_ = 0;  ///< of the frame's lights
    std::unique_ptr<Tracer> tracer_;
    std::vector<std::string> warnings_;
};

}  // namespace penumbra::visibility
