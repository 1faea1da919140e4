// SPDX-License-Identifier: MIT
// Per-pixel lists of blended fragments in front of the opaque surface, in depth order.
//   triangles --count--> fragments per pixel --scan--> starts --fill--> lists --sort--> nearest first
// Source: Carpenter 1984, The A-buffer; counted and packed instead of linked, so that a list has no greatest length.
// The array's counter goes past its capacity without writing: the host grows it and repeats.
// The order of work-items does not change the result: lists are sorted by depth, and fragments of one depth by
// what does not depend on the triangles' order.
#include "gbuffer/gbuffer_alpha.h"
#include "lib/raster.h"
#include "shared/abuffer.h"

// At the depth of the opaque surface a blended one is a coat on it
#define ABUFFER_SEEN                                                                                    \
    (as_uint(depth) >= opaque[(y * view.width + x + 1) * lists.depthStride - 1] && GBUFFER_ALPHA_BLENDS)

#define RASTER_KERNEL abuffer_count
#define RASTER_KERNEL_LARGE abuffer_count_large
#define RASTER_PARAMETERS                                                                              \
    GBUFFER_ALPHA_PARAMETERS, const ABufferParams lists, global const uint* restrict opaque,            \
        volatile global uint* counts
#define RASTER_BEGIN
#define RASTER_TRIANGLE
#define RASTER_FRAGMENT if (ABUFFER_SEEN) atomic_inc(&counts[y * view.width + x]);
#define RASTER_END
#include "lib/raster.inl"

// ends [pixel]: where the lists start, scanned from the counts; where they end, after this
#define RASTER_KERNEL abuffer_fill
#define RASTER_KERNEL_LARGE abuffer_fill_large
#define RASTER_PARAMETERS                                                                              \
    GBUFFER_ALPHA_PARAMETERS, const ABufferParams lists, global const uint* restrict opaque,            \
        volatile global uint* ends, global uint* restrict fragments, global uint* restrict owners
#define RASTER_BEGIN
#define RASTER_TRIANGLE
#define RASTER_FRAGMENT                                                         \
    if (ABUFFER_SEEN) {                                                         \
        const uint slot = atomic_inc(&ends[y * view.width + x]);                \
        if (slot < lists.capacity) {                                            \
            vstore2((uint2)(as_uint(depth), triangle), slot, fragments);        \
            owners[slot] = (uint)(y * view.width + x);                          \
        }                                                                       \
    }
#define RASTER_END
#include "lib/raster.inl"

typedef struct {
    global const float* positions;
    global const uint* indices;
    global const uint* triangleDraw;
    global const Draw* draws;
} ABufferMesh;

/// A number that depends on where a triangle's corners are, not on its index or theirs.
inline uint cornersHash(const ABufferMesh* mesh, uint triangle) {
    uint sum = 0;
    for (int k = 0; k < 3; ++k) {
        const uint vertex = mesh->indices[3 * triangle + k];
        uint h = 0;
        for (int axis = 0; axis < 3; ++axis) {
            h = (h ^ as_uint(mesh->positions[3 * vertex + axis])) * 0x9e3779b1u;
            h ^= h >> 15;
        }
        sum += h * 0x85ebca77u;
    }
    return sum;
}

/// 1 if fragment a comes before b: nearer, or of the same depth and, by convention, first.
inline int comesBefore(const ABufferMesh* mesh, uint2 a, uint2 b) {
    if (a.x != b.x) return a.x > b.x;
    if (a.y == b.y) return 0;
    const uint hashA = cornersHash(mesh, a.y), hashB = cornersHash(mesh, b.y);
    if (hashA != hashB) return hashA < hashB;
    const uint materialA = mesh->draws[mesh->triangleDraw[a.y]].material;
    const uint materialB = mesh->draws[mesh->triangleDraw[b.y]].material;
    return materialA != materialB ? materialA < materialB : a.y < b.y;
}

/// Moves the fragment at `root` of a heap [count], whose last is on top, down to its place.
inline void siftDown(const ABufferMesh* mesh, global uint* list, uint root, uint count) {
    const uint2 moved = vload2(root, list);
    for (uint child = 2 * root + 1; child < count; child = 2 * root + 1) {
        if (child + 1 < count && comesBefore(mesh, vload2(child, list), vload2(child + 1, list))) ++child;
        const uint2 below = vload2(child, list);
        if (!comesBefore(mesh, moved, below)) break;
        vstore2(below, root, list);
        root = child;
    }
    vstore2(moved, root, list);
}

inline void heapSort(const ABufferMesh* mesh, global uint* list, uint count) {
    for (uint root = count / 2; root-- > 0;) siftDown(mesh, list, root, count);
    for (uint last = count; last-- > 1;) {
        const uint2 top = vload2(0, list);
        vstore2(vload2(last, list), 0, list);
        vstore2(top, last, list);
        siftDown(mesh, list, 0, last);
    }
}

inline void insertionSort(const ABufferMesh* mesh, global uint* list, uint count) {
    for (uint i = 1; i < count; ++i) {
        const uint2 moved = vload2(i, list);
        uint at = i;
        for (; at > 0; --at) {
            const uint2 before = vload2(at - 1, list);
            if (!comesBefore(mesh, moved, before)) break;
            vstore2(before, at, list);
        }
        vstore2(moved, at, list);
    }
}

#define ABUFFER_SHORT 24  // fragments: longer lists are sorted by a heap

/// One work-item per pixel. layers: the longest list.
kernel void abuffer_sort(const ABufferParams params, global const float* restrict positions,
                         global const uint* restrict indices, global const uint* restrict triangleDraw,
                         global const Draw* restrict draws, global const uint* restrict ends,
                         global uint* restrict fragments, volatile global uint* layers) {
    const int pixel = get_global_id(0);
    if (pixel >= params.pixels) return;
    const uint begin = pixel ? ends[pixel - 1] : 0, end = min(ends[pixel], params.capacity);
    if (begin >= end) return;
    const uint count = end - begin;
    ATOMIC_MAX_EARLY(layers, count)
    const ABufferMesh mesh = {positions, indices, triangleDraw, draws};
    global uint* list = fragments + 2 * (size_t)begin;
    if (count <= ABUFFER_SHORT)
        insertionSort(&mesh, list, count);
    else
        heapSort(&mesh, list, count);
}
