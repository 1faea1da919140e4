// SPDX-License-Identifier: MIT
// Exact occlusion masks: receivers and triangles in the light's grid, sorted, bounded, paired, rasterised.
//   G-buffer --receivers, sort, gather--> receivers --groups--+--> masks --count--> visibility
//   mesh --vertices, keys, sort, triangles--> bounds ---------+
// Source: [4DR] 3: generalised projection, full coverage (3.2, appendix), rows of the mask at once (3.3).
// Differs: no grid on a plane. Both sides are sorted along a curve through (slope x, slope y, z) and bounded in
// nodes of 16; a node of receivers meets a node of triangles by five comparisons. Pairs are never stored: they
// are found and rasterised as the work-item goes, in lists that it empties when they are full.
#include "lib/receiver.h"
#include "visibility/raster4d_pair.h"
#include "shared/raster4d.h"

/// Row of the sum of two affine maps, to more digits than a float has (products and sums with their errors).
inline float affineRow(float4 high, float4 low, float3 p) {
    const float products[3] = {high.x * p.x, high.y * p.y, high.z * p.z};
    float rest = fma(high.x, p.x, -products[0]) + fma(high.y, p.y, -products[1]) + fma(high.z, p.z, -products[2]);
    rest += fma(low.x, p.x, fma(low.y, p.y, fma(low.z, p.z, low.w)));
    float sum = high.w;
    for (int k = 0; k < 3; ++k) {
        const float next = sum + products[k], other = next - sum;
        rest += (sum - (next - other)) + (products[k] - other);
        sum = next;
    }
    return sum + rest;
}

inline float3 toGrid(const Raster4dParams* p, float3 world) {
    return (float3)(affineRow(p->gridHigh.row[0], p->gridLow.row[0], world),
                    affineRow(p->gridHigh.row[1], p->gridLow.row[1], world),
                    affineRow(p->gridHigh.row[2], p->gridLow.row[2], world));
}

/// [0, 1): most of it for [-1, 1], the rest for what lies beyond.
inline float keyAxis(float v) {
    const float a = fabs(v);
    const float spread = a <= 1.0f ? 0.45f * a : 0.5f - 0.05f / a;
    return clamp(0.5f + copysign(spread, v), 0.0f, 0.999999f);
}

inline uint spreadKey(uint v) {
    v = (v | v << 8) & 0x0000f00fu;
    v = (v | v << 4) & 0x000c30c3u;
    return (v | v << 2) & 0x00249249u;
}

/// Place along the curve that sorting follows.
inline uint gridKey(const Raster4dParams* p, float3 q) {
    const float cells = (float)(1 << R4_KEY_BITS), z = max(q.z, 1e-6f);
    const uint x = (uint)(keyAxis((q.x / z - p->keyCentre.x) * p->keyScale.x) * cells);
    const uint y = (uint)(keyAxis((q.y / z - p->keyCentre.y) * p->keyScale.y) * cells);
    // Farthest from the light first: what is close to receivers hides most, and full masks end a receiver's work
    const uint d = (uint)(keyAxis((p->keyCentre.z - q.z) * p->keyScale.z) * cells);
    return spreadKey(x) | spreadKey(y) << 1 | spreadKey(d) << 2;
}

/// z times the largest and the negated least slope of a point in x, then in y, over all light samples.
inline void slopeNumerators(const Raster4dParams* p, float3 v, float* numerators) {
    numerators[0] = v.x + p->slack;
    numerators[1] = -(v.x - ((float)(p->columns - 1) + p->slack));
    numerators[2] = v.y + p->slack;
    numerators[3] = -(v.y - ((float)(p->rows - 1) + p->slack));
}

/// One work-item per pixel: its state, and a key for those that are tested.
kernel void raster4d_receivers(const Raster4dParams params, const ReceiverParams image,
                               global const float* restrict planes, global uint* restrict state,
                               global float* restrict visibility, global uint* restrict keys,
                               global uint* restrict pixels) {
    const int pixel = get_global_id(0);
    if (pixel >= image.planeStride) return;
    const Receiver r =
        receiverAt(&image, &params.lightFromWorld, params.halfWidth, params.halfHeight, planes, pixel);
    state[pixel] = r.state;
    visibility[pixel] = 1.0f;
    pixels[pixel] = (uint)pixel;
    keys[pixel] = r.state == STATE_TESTED ? gridKey(&params, toGrid(&params, r.origin)) : R4_KEY_NONE;
}

/// One work-item per sorted pixel: receivers, and how many there are.
kernel void raster4d_gather(const Raster4dParams params, const ReceiverParams image,
                            global const float* restrict planes, global const uint* restrict keys,
                            global const uint* restrict pixels, global float* restrict receivers,
                            global uint* restrict count) {
    const int i = get_global_id(0), stride = params.receiverStride;
    if (i >= image.planeStride) return;
    const int tested = keys[i] != R4_KEY_NONE;
    if (i == 0 && !tested) *count = 0;
    if (!tested) return;
    if (i + 1 == image.planeStride || keys[i + 1] == R4_KEY_NONE) *count = (uint)i + 1u;
    const int pixel = (int)pixels[i];
    const Receiver r =
        receiverAt(&image, &params.lightFromWorld, params.halfWidth, params.halfHeight, planes, pixel);
    const float3 q = toGrid(&params, r.origin);
    receivers[(R4_Q + 0) * stride + i] = q.x;
    receivers[(R4_Q + 1) * stride + i] = q.y;
    receivers[(R4_Q + 2) * stride + i] = q.z;
    float numerators[4];
    slopeNumerators(&params, q, numerators);
    for (int k = 0; k < 4; ++k) receivers[(R4_BOUND + k) * stride + i] = numerators[k] / q.z;
    receivers[(R4_BOUND + 4) * stride + i] = -q.z;
    receivers[R4_PIXEL * stride + i] = as_float((uint)pixel);
    receivers[(R4_ORIGIN + 0) * stride + i] = r.origin.x;
    receivers[(R4_ORIGIN + 1) * stride + i] = r.origin.y;
    receivers[(R4_ORIGIN + 2) * stride + i] = r.origin.z;
}

/// One work-item per vertex: [vertex, 4] in the light's grid.
kernel void raster4d_vertices(const Raster4dParams params, const uint vertices,
                              global const float* restrict positions, global float4* restrict grid) {
    const uint i = get_global_id(0);
    if (i >= vertices) return;
    grid[i] = (float4)(toGrid(&params, load3(positions, i)), 0.0f);
}

/// One work-item per triangle: what casts nothing and what is not finite comes last.
kernel void raster4d_keys(const Raster4dParams params, global const float4* restrict grid,
                          global const uint* restrict indices, global const uint* restrict triangleDraw,
                          global const Draw* restrict draws, global uint* restrict keys,
                          global uint* restrict triangles) {
    const uint i = get_global_id(0);
    if (i >= (uint)params.triangleCount) return;
    triangles[i] = i;
    keys[i] = R4_KEY_NONE;
    if (!(draws[triangleDraw[i]].flags & DRAW_CASTS)) return;
    const float3 centre =
        (grid[indices[3 * i]].xyz + grid[indices[3 * i + 1]].xyz + grid[indices[3 * i + 2]].xyz) * (1.0f / 3.0f);
    const float reach = fabs(centre.x) + fabs(centre.y) + fabs(centre.z);
    keys[i] = reach < 1e18f ? gridKey(&params, centre) : R4_KEY_NONE - 1u;
}

/// Widens a triangle's bounds by a corner; a corner in the light's plane reaches to infinity.
inline void boundCorner(const Raster4dParams* p, float3 v, float* bounds) {
    float numerators[4];
    slopeNumerators(p, v, numerators);
    for (int k = 0; k < 4; ++k) {
        const float slope = v.z > 0.0f ? numerators[k] / v.z : numerators[k] > 0.0f ? INFINITY : -INFINITY;
        bounds[k] = max(bounds[k], fabs(slope) < INFINITY ? slope + 5e-7f * fabs(slope) : slope);
    }
    bounds[4] = max(bounds[4], -max(v.z, 0.0f));
}

/// Bounds of the part of a triangle in front of the light.
inline void boundTriangle(const Raster4dParams* p, const float3* v, float* bounds) {
    for (int k = 0; k < R4_BOUNDS; ++k) bounds[k] = -INFINITY;
    for (int i = 0; i < 3; ++i) {
        const float3 a = v[i], b = v[i == 2 ? 0 : i + 1];
        if (a.z > 0.0f) boundCorner(p, a, bounds);
        if ((a.z > 0.0f) == (b.z > 0.0f)) continue;
        const float3 cut = a + (b - a) * (a.z / (a.z - b.z));
        boundCorner(p, (float3)(cut.xy, 0.0f), bounds);
    }
}

/// a b - c d without cancellation.
inline float productDifference(float a, float b, float c, float d) {
    const float product = c * d;
    return fma(a, b, -product) + fma(-c, d, product);
}

inline float component(float3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// One work-item per slot of the lowest nodes: its triangle and its bounds; -infinity where there is none.
kernel void raster4d_triangles(const Raster4dParams params, global const float* restrict positions,
                               global const float4* restrict grid,
                               global const uint* restrict indices, global const uint* restrict triangleDraw,
                               global const Draw* restrict draws, global const uint* restrict keys,
                               global const uint* restrict sorted, global float* restrict bounds,
                               global float* restrict corners, global float* restrict world,
                               global uint* restrict order) {
    const int slot = get_global_id(0);
    if (slot >= params.nodeCount[0] * R4_WIDTH) return;
    float box[R4_BOUNDS];
    for (int k = 0; k < R4_BOUNDS; ++k) box[k] = -INFINITY;
    const uint triangle = slot < params.casterCount ? sorted[slot] : 0u;
    if (slot < params.casterCount && keys[slot] < R4_KEY_NONE - 1u) {
        float3 v[3];
        global float* out = corners + slot / R4_WIDTH * (R4_CORNERS * R4_WIDTH) + slot % R4_WIDTH;
        global float* worldOut = world + (size_t)slot * R4_WORLD;
        float3 w[3];
        for (int i = 0; i < 3; ++i) {
            v[i] = grid[indices[3 * triangle + i]].xyz;
            w[i] = load3(positions, indices[3 * triangle + i]);
            for (int axis = 0; axis < 3; ++axis) {
                out[(3 * i + axis) * R4_WIDTH] = component(v[i], axis);
                worldOut[3 * i + axis] = component(w[i], axis);
            }
        }
        const float3 a = w[1] - w[0], b = w[2] - w[0];
        worldOut[9] = productDifference(a.y, b.z, a.z, b.y);
        worldOut[10] = productDifference(a.z, b.x, a.x, b.z);
        worldOut[11] = productDifference(a.x, b.y, a.y, b.x);
        boundTriangle(&params, v, box);
        const uint flags = draws[triangleDraw[triangle]].flags;
        order[slot] = triangle | (flags & (DRAW_MASK | DRAW_BLEND) ? R4_SURFACE : 0u);
    }
    for (int k = 0; k < R4_BOUNDS; ++k)
        bounds[(slot / R4_WIDTH * R4_BOUNDS + k) * R4_WIDTH + slot % R4_WIDTH] = box[k];
}

/// One work-item per slot of a level above: bounds of the node below.
kernel void raster4d_nodes(const Raster4dParams params, const int level, global const float* restrict below,
                           global float* restrict bounds) {
    const int slot = get_global_id(0);
    if (slot >= params.nodeCount[level] * R4_WIDTH) return;
    for (int k = 0; k < R4_BOUNDS; ++k) {
        float most = -INFINITY;
        for (int i = 0; i < R4_WIDTH && slot < params.nodeCount[level - 1]; ++i)
            most = max(most, below[(slot * R4_BOUNDS + k) * R4_WIDTH + i]);
        bounds[(slot / R4_WIDTH * R4_BOUNDS + k) * R4_WIDTH + slot % R4_WIDTH] = most;
    }
}

#include "visibility/raster4d_bins.inl"
#include "visibility/raster4d_grid.inl"
