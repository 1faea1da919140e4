// SPDX-License-Identifier: MIT
// Leaves out receivers that no caster can shadow, seen from any sample of the light.
//   casters --central view--> occupied cells --sums--> receivers with an empty neighbourhood need no tests
// Source: our own. A caster at (a', b', w') hides sample k of a receiver at (a, b, w) where a' = a + kx (w' - w), so
// with the largest w' of all casters the box of half size K (w' - w) around the receiver holds all that can hide it.
// What is left out is lit by every test: the image is the same to the bit.
#include "lib/atomics.h"
#include "lib/lanes.h"
#include "lib/transform.h"
#include "shared/mesh.h"
#include "shared/multi_view.h"
#include "shared/occupancy.h"

#define OCCUPANCY_TEXELS 3.0f  // what filter taps and rounding reach beyond a box

/// Grid coordinate of a texel coordinate of the central view.
inline VF occupancyCell(const MultiViewParams* light, VF texel) {
    const float size = (float)light->resolution;
    return clamp((texel + 0.5f * size) * ((float)OCCUPANCY_SIDE / (2.0f * size)), 0.0f, (float)OCCUPANCY_SIDE - 0.5f);
}

inline int occupancyCell1(const MultiViewParams* light, float texel) {
    const float size = (float)light->resolution;
    return (int)clamp((texel + 0.5f * size) * ((float)OCCUPANCY_SIDE / (2.0f * size)), 0.0f, (float)OCCUPANCY_SIDE - 0.5f);
}

/// One work-item per triangle: marks the cells of its bounds; the host clears cells and range. Casters that reach
/// nearer than the near plane make the range larger than 1, which leaves out nothing.
kernel void occupancy_mark(const MultiViewParams light, const uint triangleCount, global const float* restrict positions,
                           global const uint* restrict indices, global const uint* restrict triangleDraw,
                           global const Draw* restrict draws, volatile global uint* cells,
                           volatile global OccupancyRange* range) {
    const uint triangle = get_global_id(0);
    if (triangle >= triangleCount || !(draws[triangleDraw[triangle]].flags & DRAW_CASTS)) return;
    float lowA = INFINITY, highA = -INFINITY, lowB = INFINITY, highB = -INFINITY, nearest = INFINITY, farthest = 0.0f;
    for (int i = 0; i < 3; ++i) {
        const float3 p = load3(positions, indices[3 * triangle + i]);
        const float z = dotPoint(light.lightFromWorld.row[2], p.x, p.y, p.z);
        const float a = dotPoint(light.lightFromWorld.row[0], p.x, p.y, p.z) / z;
        const float b = dotPoint(light.lightFromWorld.row[1], p.x, p.y, p.z) / z;
        if (!(fabs(z) < 1e30f)) return;  // not finite: no caster
        nearest = min(nearest, z);
        farthest = max(farthest, z);
        lowA = min(lowA, a), highA = max(highA, a);
        lowB = min(lowB, b), highB = max(highB, b);
    }
    if (farthest <= light.nearClip) return;  // drawn by none
    const uint w = as_uint(nearest < light.near ? 2.0f : light.near / nearest);
    ATOMIC_MAX_EARLY(&range->highestW, w)
    if (nearest < light.near) return;
    const int left = occupancyCell1(&light, fma(light.focal, lowA, light.centre));
    const int right = occupancyCell1(&light, fma(light.focal, highA, light.centre));
    const int top = occupancyCell1(&light, fma(light.focal, lowB, light.centre));
    const int bottom = occupancyCell1(&light, fma(light.focal, highB, light.centre));
    for (int row = top; row <= bottom; ++row)
        for (int column = left; column <= right; ++column) {
            volatile global uint* cell = &cells[(row + 1) * OCCUPANCY_ROW + column + 1];
            ATOMIC_MAX_EARLY(cell, 1u)
        }
}

/// One work-item: cells become sums.
kernel void occupancy_sum(global uint* cells) {
    if (get_global_id(0) != 0) return;
    for (int row = 1; row <= OCCUPANCY_SIDE; ++row) {
        uint sum = 0;
        for (int column = 1; column <= OCCUPANCY_SIDE; ++column) {
            sum += cells[row * OCCUPANCY_ROW + column];
            cells[row * OCCUPANCY_ROW + column] = sum + cells[(row - 1) * OCCUPANCY_ROW + column];
        }
    }
}

/// One work-item per LANES receivers: RECEIVER_W becomes 0 where no test can fail.
kernel void occupancy_skip(const MultiViewParams light, const int stride,
                           global const uint* restrict cells, global const OccupancyRange* restrict range,
                           global float* restrict receiver) {
    const int pixel = (int)get_global_id(0) * LANES;
    const float highest = as_float(range->highestW);
    if (pixel >= stride || highest > 1.0f) return;
    const VF w = V_LOAD(receiver, RECEIVER_W * stride + pixel);
    if (!V_ANY(V_MASK(w > 0.0f))) return;
    const VF a = V_LOAD(receiver, RECEIVER_A * stride + pixel), b = V_LOAD(receiver, RECEIVER_B * stride + pixel);
    const VF gradientX = fabs(V_LOAD(receiver, RECEIVER_GRADIENT_X * stride + pixel));
    const VF gradientY = fabs(V_LOAD(receiver, RECEIVER_GRADIENT_Y * stride + pixel));
    const float reachX = light.halfWidth * light.focal / light.near, reachY = light.halfHeight * light.focal / light.near;
    const VF spreadX = max(highest - w, (VF)0.0f) * reachX + OCCUPANCY_TEXELS;
    const VF spreadY = max(highest - w, (VF)0.0f) * reachY + OCCUPANCY_TEXELS;
    const VI left = V_TO_INT(occupancyCell(&light, a - spreadX)), right = V_TO_INT(occupancyCell(&light, a + spreadX)) + 1;
    const VI top = V_TO_INT(occupancyCell(&light, b - spreadY)), bottom = V_TO_INT(occupancyCell(&light, b + spreadY)) + 1;
    const VU casters = V_GATHER_(VU, cells, bottom * OCCUPANCY_ROW + right) - V_GATHER_(VU, cells, top * OCCUPANCY_ROW + right) -
                       V_GATHER_(VU, cells, bottom * OCCUPANCY_ROW + left) + V_GATHER_(VU, cells, top * OCCUPANCY_ROW + left);
    // Samples below the receiver's plane hide it without any caster
    const VF facing = V_LOAD(receiver, RECEIVER_FACING * stride + pixel);
    const VI above = V_MASK(facing - gradientX * reachX - gradientY * reachY > 0.0f);
    const VI empty = V_MASK(V_AS_INT(casters) == 0);
    V_STORE(V_SELECT(w, (VF)0.0f, empty & above), receiver, RECEIVER_W * stride + pixel);
}
