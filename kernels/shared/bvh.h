// SPDX-License-Identifier: MIT
// A tree of boxes over the casters' triangles in Morton order. It is complete: node i of a level holds the
// children 8 i .. 8 i + 7 of the level below, level 0 holds leaves, so there are no pointers to build.
//   nodes   float [node, 6, 8]   low x, y, z and high x, y, z of the eight children; empty: low > high
//   leaves  float [leaf, 9, 4]   corner coordinates (v0.x, v0.y, v0.z, v1.x ..) of four triangles
//   leafTriangles uint [leaf, 4] their indices; BVH_NO_TRIANGLE: none
#ifndef SHARED_BVH_H
#define SHARED_BVH_H
#include "shared/portable.h"
SHARED_BEGIN

#define BVH_WIDTH 8
#define BVH_LEAF 4
#define BVH_MAX_LEVELS 12
#define BVH_NO_TRIANGLE 0xffffffffu

typedef struct {
    float4 low;        ///< of the casters over the clip, re-based; w: cells per metre along the longest side
    int triangleCount; ///< of the mesh
    int casterCount;   ///< triangles in the tree
    int leafCount;
    int levels;        ///< of nodes; the last has one
    int firstNode[BVH_MAX_LEVELS];  ///< of each level
    int nodeCount[BVH_MAX_LEVELS];
    float margin;      ///< metres that boxes are widened by, for the rounding of slab tests
    int unused[3];
} BvhParams;
SHARED_STRUCT(BvhParams, 144)

SHARED_END
#endif
