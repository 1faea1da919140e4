// SPDX-License-Identifier: MIT
// Builds the tree of shared/bvh.h each frame: Morton keys, (sort), leaves, then level by level upwards.
// Source: Morton order as in Lauterbach et al. 2009 (LBVH).
// Differs: a complete tree of width 8 over the sorted order instead of splits at the keys' bits: nothing to
// search for, every level one launch, no atomics; boxes are a little larger.
#include "lib/transform.h"
#include "shared/bvh.h"
#include "shared/mesh.h"

inline uint spreadBits(uint v) {
    v &= 1023u;
    v = (v | v << 16) & 0x030000ffu;
    v = (v | v << 8) & 0x0300f00fu;
    v = (v | v << 4) & 0x030c30c3u;
    return (v | v << 2) & 0x09249249u;
}

/// One work-item per triangle: keys [triangle] for sorting. What casts nothing comes last; triangles that
/// are not finite come just before that.
kernel void bvh_keys(const BvhParams bvh, global const float* restrict positions,
                     global const uint* restrict indices, global const uint* restrict triangleDraw,
                     global const Draw* restrict draws, global uint* restrict keys,
                     global uint* restrict triangles) {
    const uint triangle = get_global_id(0);
    if (triangle >= (uint)bvh.triangleCount) return;
    triangles[triangle] = triangle;
    keys[triangle] = 0xffffffffu;
    if (!(draws[triangleDraw[triangle]].flags & DRAW_CASTS)) return;
    const float3 sum = load3(positions, indices[3 * triangle]) + load3(positions, indices[3 * triangle + 1]) +
                       load3(positions, indices[3 * triangle + 2]);
    const float3 cell = (sum * (1.0f / 3.0f) - bvh.low.xyz) * bvh.low.w;
    keys[triangle] = 0xfffffffeu;
    if (!(fabs(cell.x) < 1e9f && fabs(cell.y) < 1e9f && fabs(cell.z) < 1e9f)) return;
    const uint3 c = convert_uint3(clamp(cell, 0.0f, 1023.0f));
    keys[triangle] = spreadBits(c.x) | spreadBits(c.y) << 1 | spreadBits(c.z) << 2;
}

inline void storeBox(const BvhParams* bvh, global float* nodes, int slot, float3 low, float3 high) {
    global float* box = nodes + (size_t)(slot / BVH_WIDTH) * (6 * BVH_WIDTH) + slot % BVH_WIDTH;
    const float m = low.x <= high.x ? bvh->margin : 0.0f;
    box[0 * BVH_WIDTH] = low.x - m;
    box[1 * BVH_WIDTH] = low.y - m;
    box[2 * BVH_WIDTH] = low.z - m;
    box[3 * BVH_WIDTH] = high.x + m;
    box[4 * BVH_WIDTH] = high.y + m;
    box[5 * BVH_WIDTH] = high.z + m;
}

/// One work-item per slot of the lowest level: fills its leaf and box.
kernel void bvh_leaves(const BvhParams bvh, global const float* restrict positions,
                       global const uint* restrict indices, global const uint* restrict triangles,
                       global float* restrict leaves, global uint* restrict leafTriangles,
                       global float* restrict nodes) {
    const int slot = get_global_id(0);
    if (slot >= bvh.nodeCount[0] * BVH_WIDTH) return;
    float3 low = (float3)(INFINITY), high = (float3)(-INFINITY);
    for (int i = 0; i < BVH_LEAF && slot < bvh.leafCount; ++i) {
        const int rank = slot * BVH_LEAF + i;
        const uint triangle = rank < bvh.casterCount ? triangles[rank] : BVH_NO_TRIANGLE;
        leafTriangles[slot * BVH_LEAF + i] = triangle;
        for (int corner = 0; corner < 3; ++corner) {
            const float3 p = triangle == BVH_NO_TRIANGLE ? (float3)(0.0f)
                                                         : load3(positions, indices[3 * triangle + corner]);
            global float* out = leaves + (size_t)slot * (9 * BVH_LEAF) + 3 * corner * BVH_LEAF + i;
            out[0] = p.x;
            out[BVH_LEAF] = p.y;
            out[2 * BVH_LEAF] = p.z;
            if (triangle == BVH_NO_TRIANGLE) continue;
            low = fmin(low, p);  // fmin leaves NaN out
            high = fmax(high, p);
        }
    }
    storeBox(&bvh, nodes, slot, low, high);
}

/// One work-item per slot of a level above the lowest: the union of the boxes of the node below.
kernel void bvh_level(const BvhParams bvh, const int level, global float* nodes) {
    const int slot = get_global_id(0);
    if (slot >= bvh.nodeCount[level] * BVH_WIDTH) return;
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    if (slot < bvh.nodeCount[level - 1]) {
        global const float* child = nodes + (size_t)(bvh.firstNode[level - 1] + slot) * (6 * BVH_WIDTH);
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < BVH_WIDTH; ++i) {
                low[axis] = fmin(low[axis], child[axis * BVH_WIDTH + i]);
                high[axis] = fmax(high[axis], child[(3 + axis) * BVH_WIDTH + i]);
            }
    }
    global float* box =
        nodes + (size_t)(bvh.firstNode[level] + slot / BVH_WIDTH) * (6 * BVH_WIDTH) + slot % BVH_WIDTH;
    for (int axis = 0; axis < 3; ++axis) {
        box[axis * BVH_WIDTH] = low[axis];
        box[(3 + axis) * BVH_WIDTH] = high[axis];
    }
}
