// SPDX-License-Identifier: MIT
#include "host/visibility/bvh.h"

#include <algorithm>

#include "runtime/profiler.h"

namespace penumbra::visibility {

Bvh::Bvh(const runtime::Program& frame, const runtime::Program& raytrace)
    : device_(&frame.device()),
      sort_(frame),
      keys_(raytrace, "bvh_keys"),
      leavesKernel_(raytrace, "bvh_leaves"),
      level_(raytrace, "bvh_level") {}

void Bvh::plan(const geometry::Mesh& mesh) {
    auto& p = params_;
    p = {};
    p.triangleCount = static_cast<int>(mesh.triangleCount);
    p.casterCount = static_cast<int>(mesh.casterTriangleCount);
    p.leafCount = (p.casterCount + BVH_LEAF - 1) / BVH_LEAF;
    int below = p.leafCount, nodes = 0;
    while (below > 0) {
        const int count = (below + BVH_WIDTH - 1) / BVH_WIDTH;
        p.firstNode[p.levels] = nodes;
        p.nodeCount[p.levels++] = count;
        nodes += count;
        below = count > 1 ? count : 0;
    }
    const auto triangles = std::max<std::uint64_t>(mesh.triangleCount, 1);
    keyBuffer_.grow(*device_, "tree keys", triangles);
    triangles_.grow(*device_, "tree triangles", triangles);
    leafTriangles_.grow(*device_, "leaf triangles",
                        static_cast<std::uint64_t>(p.leafCount) * BVH_LEAF + 1);
    leaves_.grow(*device_, "leaves", static_cast<std::uint64_t>(p.leafCount) * 9 * BVH_LEAF + 1);
    nodes_.grow(*device_, "tree nodes", static_cast<std::uint64_t>(nodes) * 6 * BVH_WIDTH + 1);
}

std::uint64_t Bvh::bytesFor(const geometry::Mesh& mesh) {
    const std::uint64_t leaves =
        (std::uint64_t{mesh.casterTriangleCount} + BVH_LEAF - 1) / BVH_LEAF;
    // A node is 8 boxes of 6 floats; the levels above the lowest hold a seventh of its nodes
    const std::uint64_t nodes = leaves / (BVH_WIDTH - 1) + BVH_MAX_LEVELS;
    return 4 * std::uint64_t{mesh.triangleCount} * sizeof(std::uint32_t) +  // keys, sorted twice
           leaves * BVH_LEAF * 10 * sizeof(float) + nodes * 6 * BVH_WIDTH * sizeof(float);
}

void Bvh::build(const geometry::Mesh& mesh, const scene::Bounds& casters,
                const glm::dvec3& centre) {
    if (builtVersion_ == mesh.version) return;
    device_->profiler().beginStage("tree");
    plan(mesh);
    auto& p = params_;
    const glm::dvec3 low = casters.low - centre, size = casters.high - casters.low;
    const double longest = std::max({size.x, size.y, size.z, 1e-30});
    p.low = {static_cast<float>(low.x), static_cast<float>(low.y), static_cast<float>(low.z),
             static_cast<float>(1023.99 / longest)};
    p.margin = static_cast<float>(1e-6 * casters.radius());
    keys_.launch({mesh.triangleCount}, {64}, p, mesh.positions, mesh.indices, mesh.triangleDraw,
                 mesh.draws, keyBuffer_, triangles_);
    sort_.run(keyBuffer_, triangles_, mesh.triangleCount);
    if (p.levels > 0) {
        const auto slots = [&](int level) {
            return runtime::Range{static_cast<std::uint64_t>(p.nodeCount[level]) * BVH_WIDTH};
        };
        leavesKernel_.launch(slots(0), {64}, p, mesh.positions, mesh.indices, triangles_, leaves_,
                             leafTriangles_, nodes_);
        for (int level = 1; level < p.levels; ++level)
            level_.launch(slots(level), {64}, p, level, nodes_);
    }
    builtVersion_ = mesh.version;
}

}  // namespace penumbra::visibility
