// SPDX-License-Identifier: MIT
// A tree of boxes over the posed casters, built on the device each frame.
#pragma once
#include "host/geometry/geometry.h"
#include "host/scene/bounds.h"
#include "kernels/shared/bvh.h"
#include "runtime/sort.h"

namespace penumbra::visibility {

using runtime::Buffer;

class Bvh {
  public:
    Bvh(const runtime::Program& frame, const runtime::Program& raytrace);

    /// Enqueues building the tree of the mesh's casters; allocates when the mesh is another.
    /// Nothing is done where the mesh did not move since the last call. Kernels:
    /// kernels/visibility/bvh.cl
    void build(const geometry::Mesh& mesh, const scene::Bounds& casters, const glm::dvec3& centre);

    /// Bytes of the tree of a mesh and of its sort.
    static std::uint64_t bytesFor(const geometry::Mesh& mesh);

    const shared::BvhParams& params() const { return params_; }
    const Buffer<float>& nodes() const { return nodes_; }
    const Buffer<float>& leaves() const { return leaves_; }
    const Buffer<std::uint32_t>& leafTriangles() const { return leafTriangles_; }

  private:
    void plan(const geometry::Mesh& mesh);
    runtime::Device* device_;
    runtime::Sort sort_;
    using U32 = std::uint32_t;
    runtime::Kernel<shared::BvhParams, Buffer<float>, Buffer<U32>, Buffer<U32>,
                    Buffer<shared::Draw>, Buffer<U32>, Buffer<U32>>
        keys_;
    runtime::Kernel<shared::BvhParams, Buffer<float>, Buffer<U32>, Buffer<U32>, Buffer<float>,
                    Buffer<U32>, Buffer<float>>
        leavesKernel_;
    runtime::Kernel<shared::BvhParams, int, Buffer<float>> level_;
    shared::BvhParams params_{};
    Buffer<U32> keyBuffer_, triangles_, leafTriangles_;
    Buffer<float> nodes_, leaves_;
    std::uint64_t builtVersion_ = 0;
};

}  // namespace penumbra::visibility
