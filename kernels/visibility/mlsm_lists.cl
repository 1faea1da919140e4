// SPDX-License-Identifier: MIT
// The base level: all fragments of casters that each texel of the light's central view holds, in order of depth.
//   triangles --mlsm_count--> lengths --scan--> first fragments --mlsm_fill--> packed lists --mlsm_sort--> lists
//   triangles --mlsm_link--> linked lists, lengths --scan, mlsm_collect--> packed lists --mlsm_sort--> lists
// Source: [MLSM] 4.1, 5.3 (alpha textures), 7 (arrays and linked lists).
// Differs: coloured fragments keep the share of the texel that they cover beside what they take of each channel, so
// that panes behind one another can be told from occluders beside one another.
// Fragments arrive in any order; sorted by depth and then by all their bits, lists are the same.
#include "lib/mlsm_accumulate.h"
#include "lib/mlsm_opacity.h"
#include "shared/map_raster.h"
#include "shared/multi_view.h"

#define MLSM_INSERTION 16  // fragments: longer lists are sorted as a heap

#define MLSM_FRAGMENT_OPACITY \
    mlsmOpacity(&draw, materials, indices, uvs, colours, texels, triangle, v, x, y)

#define RASTER_KERNEL mlsm_count
#define RASTER_KERNEL_LARGE mlsm_count_large
#define RASTER_PARAMETERS \
    CASTER_ALPHA_PARAMETERS, volatile global uint *counts, volatile global MultiViewCounters *counters
#define RASTER_BEGIN uint nearCount = 0;
#define RASTER_TRIANGLE
#define RASTER_FRAGMENT                                    \
    if (MLSM_FRAGMENT_OPACITY.w > 0.0f) {                  \
        atomic_inc(&counts[y * view.width + x]);           \
        nearCount += depth * MAP_NEAR_CLIP > 1.0f;         \
    }
#define RASTER_END \
    if (nearCount) atomic_add(&counters->nearPoints, nearCount);
#include "lib/raster.inl"

inline void mlsmStore(global float* fragments, uint slot, int channels, float depth, float4 opacity) {
    global float* f = fragments + (size_t)slot * MLSM_VALUES(channels);
    f[0] = min(depth * MAP_NEAR_CLIP, 1.0f);
    f[1] = opacity.w;
    if (channels == 1) return;
    f[2] = opacity.x;
    f[3] = opacity.y;
    f[4] = opacity.z;
}

/// starts [texel + 1]: scanned lengths; counts [texel]: lengths, counted down to 0.
#define RASTER_KERNEL mlsm_fill
#define RASTER_KERNEL_LARGE mlsm_fill_large
#define RASTER_PARAMETERS                                                                                \
    CASTER_ALPHA_PARAMETERS, const MlsmParams params, global const uint *restrict starts,                \
        volatile global uint *counts, global float *restrict fragments
#define RASTER_BEGIN
#define RASTER_TRIANGLE
#define RASTER_FRAGMENT                                                                   \
    const float4 opacity = MLSM_FRAGMENT_OPACITY;                                         \
    if (opacity.w > 0.0f) {                                                               \
        const int texel = y * view.width + x;                                             \
        const uint slot = starts[texel] + atomic_dec(&counts[texel]) - 1;                 \
        if (slot < params.capacity) mlsmStore(fragments, slot, params.channels, depth, opacity); \
    }
#define RASTER_END
#include "lib/raster.inl"

/// links [node]: the next node of a list + 1; heads [texel]: its first + 1; nodes float [node, MLSM_VALUES]
#define RASTER_KERNEL mlsm_link
#define RASTER_KERNEL_LARGE mlsm_link_large
#define RASTER_PARAMETERS                                                                                     \
    CASTER_ALPHA_PARAMETERS, const MlsmParams params, volatile global uint *counts, volatile global uint *heads, \
        volatile global uint *nodeCount, global uint *restrict links, global float *restrict nodes,           \
        volatile global MultiViewCounters *counters
#define RASTER_BEGIN uint nearCount = 0;
#define RASTER_TRIANGLE
#define RASTER_FRAGMENT                                                               \
    const float4 opacity = MLSM_FRAGMENT_OPACITY;                                     \
    if (opacity.w > 0.0f) {                                                           \
        const int texel = y * view.width + x;                                         \
        const uint node = atomic_inc(nodeCount);                                      \
        atomic_inc(&counts[texel]);                                                   \
        nearCount += depth * MAP_NEAR_CLIP > 1.0f;                                    \
        if (node < params.capacity) {                                                 \
            mlsmStore(nodes, node, params.channels, depth, opacity);                  \
            links[node] = atomic_xchg(&heads[texel], node + 1);                       \
        }                                                                             \
    }
#define RASTER_END \
    if (nearCount) atomic_add(&counters->nearPoints, nearCount);
#include "lib/raster.inl"

/// One work-item per texel: copies a linked list into its place of the packed array.
kernel void mlsm_collect(const MlsmParams params, global const uint* restrict starts, global const uint* restrict heads,
                         global const uint* restrict links, global const float* restrict nodes,
                         global float* restrict fragments) {
    const int texel = get_global_id(0), values = MLSM_VALUES(params.channels);
    if (texel >= params.resolution * params.resolution) return;
    uint slot = starts[texel];
    for (uint node = heads[texel]; node != 0 && slot < params.capacity; node = links[node - 1], ++slot)
        for (int i = 0; i < values; ++i)
            fragments[(size_t)slot * values + i] = nodes[(size_t)(node - 1) * values + i];
}

/// 1 if fragment a belongs before b: nearer to the light or, at the same depth, smaller bits.
inline int mlsmBefore(const float* a, global const float* b, int values) {
    if (a[0] != b[0]) return a[0] > b[0];
    for (int i = 1; i < values; ++i)
        if (as_uint(a[i]) != as_uint(b[i])) return as_uint(a[i]) < as_uint(b[i]);
    return 0;
}

inline void mlsmInsertionSort(global float* list, int count, int values) {
    float moved[5];
    for (int i = 1; i < count; ++i) {
        for (int k = 0; k < values; ++k) moved[k] = list[i * values + k];
        int at = i;
        for (; at > 0 && mlsmBefore(moved, list + (at - 1) * values, values); --at)
            for (int k = 0; k < values; ++k) list[at * values + k] = list[(at - 1) * values + k];
        for (int k = 0; k < values; ++k) list[at * values + k] = moved[k];
    }
}

/// Moves `moved` down from the root of a heap whose last fragments come first.
inline void mlsmSiftDown(global float* list, size_t root, size_t count, const float* moved, int values) {
    for (size_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
        float other[5];
        for (int k = 0; k < values; ++k) other[k] = list[child * values + k];
        if (child + 1 < count && mlsmBefore(other, list + (child + 1) * values, values)) ++child;
        if (!mlsmBefore(moved, list + child * values, values)) break;
        for (int k = 0; k < values; ++k) list[root * values + k] = list[child * values + k];
        root = child;
    }
    for (int k = 0; k < values; ++k) list[root * values + k] = moved[k];
}

inline void mlsmHeapSort(global float* list, size_t count, int values) {
    float moved[5];
    for (size_t root = count / 2; root-- > 0;) {
        for (int k = 0; k < values; ++k) moved[k] = list[root * values + k];
        mlsmSiftDown(list, root, count, moved, values);
    }
    for (size_t last = count - 1; last > 0; --last) {
        for (int k = 0; k < values; ++k) {
            moved[k] = list[last * values + k];
            list[last * values + k] = list[k];
        }
        mlsmSiftDown(list, 0, last, moved, values);
    }
}

/// Joins fragments within epsilon of the first of them, in place; returns what is left.
inline uint mlsmJoin(const MlsmParams* p, global float* list, uint count, int values) {
    uint kept = 0;
    for (uint i = 0; i < count;) {
        float joined[5];
        for (int k = 0; k < values; ++k) joined[k] = list[(size_t)i * values + k];
        const float nearest = joined[0], limit = nearest - p->epsilon * nearest;
        float farthest = nearest;
        uint members = 1;
        for (++i; i < count && list[(size_t)i * values] >= limit; ++i, ++members) {
            float value[4];
            for (int k = 1; k < values; ++k) value[k - 1] = list[(size_t)i * values + k];
            farthest = list[(size_t)i * values];
            joined[0] += farthest;
            mlsmAccumulate(p->accumulate, joined + 1, value, values);
        }
        joined[0] = clamp(joined[0] / (float)members, farthest, nearest);
        for (int k = 0; k < values; ++k) list[(size_t)kept * values + k] = joined[k];
        ++kept;
    }
    return kept;
}

/// One work-item per texel: sorts its list, joins and cuts it where asked to, and writes lists [texel, MLSM_LIST].
/// All lists are empty where the fragments did not fit: the frame is repeated.
kernel void mlsm_sort(const MlsmParams params, global const uint* restrict starts, global float* restrict fragments,
                      global uint* restrict lists) {
    const int texel = get_global_id(0), values = MLSM_VALUES(params.channels);
    const int texels = params.resolution * params.resolution;
    if (texel >= texels) return;
    const uint begin = starts[texel];
    uint count = starts[texels] > params.capacity ? 0 : starts[texel + 1] - begin;
    global float* list = fragments + (size_t)begin * values;
    if (count > MLSM_INSERTION)
        mlsmHeapSort(list, count, values);
    else if (count > 1)
        mlsmInsertionSort(list, (int)count, values);
    const float nearest = count ? list[0] : 0.0f;
    if (params.join) count = mlsmJoin(&params, list, count, values);
    if (params.layers > 0) count = min(count, (uint)params.layers);
    lists[texel * MLSM_LIST] = begin;
    lists[texel * MLSM_LIST + 1] = begin + count;
    lists[texel * MLSM_LIST + 2] = as_uint(nearest);
}
