// SPDX-License-Identifier: MIT
// The reference: one any-hit ray per pixel and light sample, to the same samples as every other
// technique.
#pragma once
#include "host/visibility/bvh.h"
#include "host/visibility/technique.h"
#include "kernels/shared/multi_view.h"
#include "kernels/shared/raytrace.h"

namespace penumbra::visibility {

/// Traces the pixels of an image through a tree; used by the technique and by others for what they
/// leave out.
class RayPass {
  public:
    RayPass(const runtime::Program& raytrace, int width, int height);
    /// Enqueues tracing to the light's samples. `onlyState`: which pixels; `classify`: write states
    /// first.
    void run(const Inputs& inputs, const Bvh& bvh, std::uint32_t onlyState, bool classify,
             Visibility& visibility);

  private:
    using U32 = std::uint32_t;
    runtime::Device* device_;
    shared::ReceiverParams image_{};
    runtime::Kernel<shared::RaytraceParams, shared::ReceiverParams, shared::BvhParams,
                    Buffer<float>, Buffer<float>, Buffer<float>, Buffer<U32>, Buffer<float>,
                    Buffer<U32>, Buffer<U32>, Buffer<shared::Draw>, Buffer<shared::Material>,
                    Buffer<float>, Buffer<U32>, Buffer<U32>, Buffer<U32>, Buffer<float>>
        raytrace_;
    Buffer<float> samples_;
};

struct RaytraceSettings {
    template <typename Row>
    void rows(Row&) {}
};

class Raytrace : public Technique {
  public:
    explicit Raytrace(const TechniqueContext& context);
    bool hasDepthMaps() const override { return false; }
    static std::uint64_t plannedBytes(const TechniqueContext&) { return 0; }
    void prepare(const Mesh& mesh, const scene::Bounds& casters,
                 const glm::dvec3& centre) override {
        bvh_.build(mesh, casters, centre);
    }
    std::uint64_t frameBytes(const Mesh& mesh) const override { return Bvh::bytesFor(mesh); }
    void run(const Inputs& inputs, Visibility& visibility) override;
    int channels(const Mesh& mesh) const override { return mesh.hasBlend ? 3 : 1; }

  private:
    runtime::Program frame_, program_;
    Bvh bvh_;
    RayPass pass_;
};

}  // namespace penumbra::visibility
