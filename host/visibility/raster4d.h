// SPDX-License-Identifier: MIT
// Exact visibility by 4D rasterisation [4DR]: for each pixel a bit per light sample, identical to
// ray tracing to the same samples.
#pragma once
#include "host/visibility/light_grid.h"
#include "host/visibility/technique.h"
#include "kernels/shared/multi_view.h"
#include "runtime/sort.h"

namespace penumbra::visibility {

enum class PairMethod { bins, grid };

struct Raster4dSettings {
    PairMethod method = PairMethod::bins;
    int grid = 128;
    bool onePixel = true, reject = true, rowAtOnce = true;

    template <typename Row>
    void rows(Row& row) {
        row.choice("method", method, {"bins", "grid"},
                   "how receivers and triangles meet: bounds of sorted nodes, or the paper's grid; "
                   "the bits are the same");
        row.number("grid", grid, 8, 1024, "pixels", "side of the paper's grid");
        row.flag("onePixel", onePixel,
                 "grid: a receiver has one pixel, not all of its generalised projection");
        row.flag("reject", reject, "grid: pairs without full coverage cost no rows");
        row.flag("rowAtOnce", rowAtOnce, "a row of the mask at once, not a bit at a time");
    }
};

/// The cells of one light on the device; kept while its samples stay the same.
struct LightCells {
    scene::AreaLight light;
    LightGrid grid;
    Buffer<float> x, y;
    Buffer<int> sample;
    Buffer<std::uint32_t> empty;
    void place(runtime::Device& device, const scene::AreaLight& newLight);
};

/// Posed casters in the grid of one light, sorted and bounded; kernels/shared/raster4d.h.
class LightTriangles {
  public:
    LightTriangles(const runtime::Program& frame, const runtime::Program& raster4d);
    /// Enqueues making all of it for the mesh; sets the counts in `params`.
    void run(const Mesh& mesh, shared::Raster4dParams& params);
    static std::uint64_t bytesFor(const Mesh& mesh);

    const Buffer<float>& bounds(int level) const { return bounds_[level]; }
    const Buffer<float>& corners() const { return corners_; }
    const Buffer<float>& world() const { return world_; }
    const Buffer<std::uint32_t>& order() const { return order_; }

  private:
    using U32 = std::uint32_t;
    void plan(const Mesh& mesh, shared::Raster4dParams& params);
    runtime::Device* device_;
    runtime::Sort sort_;
    runtime::Kernel<shared::Raster4dParams, U32, Buffer<float>, Buffer<shared::float4>> vertices_;
    runtime::Kernel<shared::Raster4dParams, Buffer<shared::float4>, Buffer<U32>, Buffer<U32>,
                    Buffer<shared::Draw>, Buffer<U32>, Buffer<U32>>
        keys_;
    runtime::Kernel<shared::Raster4dParams, Buffer<float>, Buffer<shared::float4>, Buffer<U32>,
                    Buffer<U32>, Buffer<shared::Draw>, Buffer<U32>, Buffer<U32>, Buffer<float>,
                    Buffer<float>, Buffer<float>, Buffer<U32>>
        trianglesKernel_;
    runtime::Kernel<shared::Raster4dParams, int, Buffer<float>, Buffer<float>> nodes_;
    Buffer<shared::float4> grid_;
    Buffer<U32> keyBuffer_, sorted_, order_;
    Buffer<float> bounds_[R4_LEVELS], corners_, world_;
};

/// Pixels that are tested, in the grid of one light, sorted.
class LightReceivers {
  public:
    LightReceivers(const runtime::Program& frame, const runtime::Program& raster4d, int width,
                   int height);
    void run(const Inputs& inputs, shared::Raster4dParams& params, Visibility& visibility);
    static std::uint64_t bytesFor(int width, int height);

    const shared::ReceiverParams& image() const { return image_; }
    /// What sorting takes beside the receivers, from the first frame on.
    std::uint64_t sortBytes() const {
        return 2 * static_cast<std::uint64_t>(image_.planeStride) * sizeof(U32) + (1 << 19);
    }
    const Buffer<float>& planes() const { return planes_; }
    const Buffer<std::uint32_t>& count() const { return count_; }

  private:
    using U32 = std::uint32_t;
    runtime::Device* device_;
    shared::ReceiverParams image_{};
    runtime::Sort sort_;
    runtime::Kernel<shared::Raster4dParams, shared::ReceiverParams, Buffer<float>, Buffer<U32>,
                    Buffer<float>, Buffer<U32>, Buffer<U32>>
        receivers_;
    runtime::Kernel<shared::Raster4dParams, shared::ReceiverParams, Buffer<float>, Buffer<U32>,
                    Buffer<U32>, Buffer<float>, Buffer<U32>>
        gather_;
    Buffer<U32> keys_, pixels_, count_;
    Buffer<float> planes_;
};

class Raster4dGrid;

class Raster4d : public Technique {
  public:
    explicit Raster4d(const TechniqueContext& context);
    ~Raster4d() override;
    static std::uint64_t plannedBytes(const TechniqueContext& context);
    bool hasDepthMaps() const override { return false; }
    std::uint64_t frameBytes(const Mesh& mesh) const override {
        return LightTriangles::bytesFor(mesh) + receivers_.sortBytes();
    }
    std::uint64_t maskBytes(const scene::AreaLight& light) const override;
    void check(const scene::AreaLight& light) const override { fitLightGrid(light); }
    void run(const Inputs& inputs, Visibility& visibility) override;
    bool grew() override;
    std::vector<SettingRow> settings() const override { return settingsInForce(settings_); }

  private:
    void runBins(const Inputs& inputs, const shared::Raster4dParams& params,
                 Visibility& visibility);
    void keepMasks(OcclusionMasks& masks) const;

    Raster4dSettings settings_;
    runtime::Program frame_, program_;
    LightReceivers receivers_;
    LightTriangles triangles_;
    using U32 = std::uint32_t;
    runtime::Kernel<shared::Raster4dParams, shared::ReceiverParams, Buffer<float>, Buffer<float>,
                    Buffer<U32>, Buffer<float>, Buffer<float>, Buffer<float>, Buffer<float>,
                    Buffer<float>, Buffer<U32>, Buffer<float>, Buffer<float>, Buffer<int>,
                    Buffer<U32>, Buffer<U32>, Buffer<U32>, Buffer<shared::Draw>,
                    Buffer<shared::Material>, Buffer<float>, Buffer<U32>, Buffer<U32>,
                    Buffer<float>, Buffer<U32>>
        bins_;
    LightCells cells_;
    Buffer<U32> masks_;
    std::unique_ptr<Raster4dGrid> grid_;  ///< of the method
};

}  // namespace penumbra::visibility
