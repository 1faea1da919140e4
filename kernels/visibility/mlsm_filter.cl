// SPDX-License-Identifier: MIT
// A coarser level of lists: four neighbouring lists are merged, and what lies within epsilon becomes one fragment.
//   lists of a level --merge by depth, mean of four--> lists of the next
// Source: [MLSM] 4.2, figures 3 (merge), 4, 7 (Y-map); 6 (epsilon); 8, figure 18 (sub-sampling).
// Differs: depths are averaged as near / z. In it both the filter size of [MLSM] 5.1 and a plane are linear, so that a
// plane's fragments keep their plane, and with it their filter size, at every level.
// A list is merged into private memory, or where it is long merged once to count and once to write; its place is
// appended to those of all levels. Places depend on the order of work-items, lists do not.
#include "lib/mlsm_accumulate.h"

#define MLSM_KEPT 12  // fragments of a merged list in private memory

/// Four lists on their way through a merge. Depth -1: used up.
typedef struct {
    uint next[4], end[4];
    float depth[4];
} MlsmMerge;

inline float mlsmDepth(global const float* restrict fragments, uint next, uint end, int values) {
    return next < end ? fragments[(size_t)next * values] : -1.0f;
}

/// The list whose next fragment is nearest to the light; of equal ones the first.
inline int mlsmNearest(const MlsmMerge* m) {
    int nearest = 0;
    for (int i = 1; i < 4; ++i)
        if (m->depth[i] > m->depth[nearest]) nearest = i;
    return nearest;
}

/// Takes the nearest fragment and all within epsilon of it: depths are averaged, opacities accumulated in each list
/// and averaged over the four. Returns 0 when all lists are used up.
inline int mlsmMergeNext(MlsmMerge* m, global const float* restrict fragments, float epsilon, int accumulate,
                         const int values, float* merged) {
    int i = mlsmNearest(m);
    const float nearest = m->depth[i];
    if (nearest < 0.0f) return 0;
    const float limit = nearest - epsilon * nearest;
    float opacity[4][4], sum = 0.0f, farthest;
    for (int k = 0; k < 4; ++k)
        for (int c = 0; c < 4; ++c) opacity[k][c] = 0.0f;
    int members = 0;
    do {
        global const float* fragment = fragments + (size_t)m->next[i] * values;
        farthest = m->depth[i];
        sum += farthest;
        ++members;
        float value[4];
        for (int c = 0; c + 1 < values; ++c) value[c] = fragment[c + 1];
        mlsmAccumulate(accumulate, opacity[i], value, values);
        m->next[i] += 1;
        m->depth[i] = mlsmDepth(fragments, m->next[i], m->end[i], values);
        i = mlsmNearest(m);
    } while (m->depth[i] >= limit && m->depth[i] >= 0.0f);
    // Rounding must not move a fragment past its neighbours
    merged[0] = clamp(sum / (float)members, farthest, nearest);
    for (int c = 0; c + 1 < values; ++c)
        merged[c + 1] = 0.25f * ((opacity[0][c] + opacity[1][c]) + (opacity[2][c] + opacity[3][c]));
    return 1;
}

inline MlsmMerge mlsmMergeOf(const uint* begin, const uint* end, global const float* restrict fragments, int values) {
    MlsmMerge m;
    for (int i = 0; i < 4; ++i) {
        m.next[i] = begin[i];
        m.end[i] = end[i];
        m.depth[i] = mlsmDepth(fragments, begin[i], end[i], values);
    }
    return m;
}

/// Merges four lists behind the last fragment of all; returns the length and where it begins.
inline uint mlsmMergeLists(const MlsmParams* p, float epsilon, const uint* begin, const uint* end,
                           global float* fragments, volatile global uint* total, const int values, uint* first) {
    float kept[MLSM_KEPT * 5], merged[5];
    MlsmMerge m = mlsmMergeOf(begin, end, fragments, values);
    uint count = 0;
    while (mlsmMergeNext(&m, fragments, epsilon, p->accumulate, values, merged)) {
        if (count < MLSM_KEPT)
            for (int k = 0; k < values; ++k) kept[count * values + k] = merged[k];
        ++count;
    }
    *first = atomic_add(total, count);
    if (*first > p->capacity || count > p->capacity - *first) return 0;
    global float* out = fragments + (size_t)*first * values;
    if (count <= MLSM_KEPT) {
        for (uint k = 0; k < count * values; ++k) out[k] = kept[k];
        return count;
    }
    m = mlsmMergeOf(begin, end, fragments, values);
    for (; mlsmMergeNext(&m, fragments, epsilon, p->accumulate, values, merged); out += values)
        for (int k = 0; k < values; ++k) out[k] = merged[k];
    return count;
}

/// One work-item per list of the level. total [1]: fragments of all levels so far, also of those without room.
inline void mlsmFilter(const MlsmParams* p, const MlsmFilterParams* f, global uint* lists, global float* fragments,
                       volatile global uint* total, const int values) {
    const int list = get_global_id(0), size = p->size[f->level], below = p->size[f->level - 1];
    if (list >= size * size) return;
    const int x = list % size * f->scale, y = list / size * f->scale;
    const int columns[2] = {clamp(x + f->tap0, 0, below - 1), clamp(x + f->tap1, 0, below - 1)};
    const int rows[2] = {clamp(y + f->tap0, 0, below - 1), clamp(y + f->tap1, 0, below - 1)};
    uint begin[4], end[4], nearest = 0, members = 0;
    for (int i = 0; i < 4; ++i) {
        global const uint* from =
            lists + (size_t)(p->firstList[f->level - 1] + rows[i >> 1] * below + columns[i & 1]) * MLSM_LIST;
        begin[i] = from[0];
        end[i] = from[1];
        nearest = max(nearest, from[2]);
        members += end[i] - begin[i];
    }
    global uint* to = lists + (size_t)(p->firstList[f->level] + list) * MLSM_LIST;
    uint first = 0, count = 0;
    if (f->subsample) {
        // In turn the upper right and the lower left one, so that nothing moves on the whole
        const int one = (list % size + list / size) & 1 ? 2 : 1;
        first = begin[one];
        count = end[one] - begin[one];
    } else if (members) {
        const float epsilon = p->epsilon * (float)(1 << f->level);
        count = mlsmMergeLists(p, epsilon, begin, end, fragments, total, values, &first);
    }
    to[0] = first;
    to[1] = first + count;
    to[2] = nearest;
}

kernel void mlsm_filter(const MlsmParams params, const MlsmFilterParams filter, global uint* lists,
                        global float* fragments, volatile global uint* total) {
    mlsmFilter(&params, &filter, lists, fragments, total, MLSM_VALUES(1));
}

kernel void mlsm_filter_colour(const MlsmParams params, const MlsmFilterParams filter, global uint* lists,
                               global float* fragments, volatile global uint* total) {
    mlsmFilter(&params, &filter, lists, fragments, total, MLSM_VALUES(3));
}
