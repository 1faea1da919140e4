// SPDX-License-Identifier: MIT
// The paper's own way to its pairs: receivers and triangles are assigned to the pixels of a grid ([4DR] 3.1,
// steps 2 to 5). Part of raster4d.cl; the arithmetic of a pair is that of the bins, so the bits are the same.
// Differs: the grid lies on the plane at infinity, in slopes; it is processed in bands of rows, so that the
// lists of a band fit into memory whatever their length.

inline uint orderedBits(float v) {
    const uint bits = as_uint(v);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

inline float fromOrderedBits(uint bits) {
    return as_float(bits & 0x80000000u ? bits & 0x7fffffffu : ~bits);
}

/// One work-item per 64 receivers: extent [4] of all their generalised projections, the largest of each part of
/// their keys' boxes, as ordered bits that start at 0 (step 2).
kernel void raster4d_grid_extent(const Raster4dParams params, global const float* restrict receivers,
                                 global const uint* restrict count, global uint* restrict extent) {
    const int first = (int)get_global_id(0) * 64, stop = min(first + 64, (int)*count);
    if (first >= stop) return;
    for (int k = 0; k < 4; ++k) {
        float most = -INFINITY;
        for (int i = first; i < stop; ++i) most = max(most, receivers[(R4_BOUND + k) * params.receiverStride + i]);
        atomic_max(extent + k, orderedBits(most));
    }
}

/// Pixels of the grid, inclusive.
typedef struct {
    int left, right, top, bottom;
} GridBox;

inline int gridPixel(float slope, float low, float high, int size) {
    const float at = (slope - low) / max(high - low, 1e-30f) * (float)size;
    return (int)clamp(at, 0.0f, (float)(size - 1));
}

/// Box of a key or of bounds: the slopes -[1] to [0] and -[3] to [2], cut to a band of rows.
inline GridBox gridBox(const Raster4dGridParams* g, global const uint* restrict extent, const float* bounds) {
    float e[4];
    for (int k = 0; k < 4; ++k) e[k] = fromOrderedBits(extent[k]);
    GridBox box = {0, -1, 0, -1};
    if (!(bounds[0] >= -e[1] && -bounds[1] <= e[0] && bounds[2] >= -e[3] && -bounds[3] <= e[2])) return box;
    box.left = gridPixel(-bounds[1], -e[1], e[0], g->size);
    box.right = gridPixel(bounds[0], -e[1], e[0], g->size);
    box.top = max(gridPixel(-bounds[3], -e[3], e[2], g->size), g->firstRow);
    box.bottom = min(gridPixel(bounds[2], -e[3], e[2], g->size), g->firstRow + g->rowCount - 1);
    return box;
}

/// Adds an entry to every pixel of a box: counts where `fill` is 0, else writes it where counting put it.
inline void gridAssign(const Raster4dGridParams* g, GridBox box, uint entry, global uint* restrict cursors,
                       global uint* restrict list) {
    for (int row = box.top; row <= box.bottom; ++row)
        for (int column = box.left; column <= box.right; ++column) {
            const uint at = atomic_inc(cursors + (row - g->firstRow) * g->size + column);
            if (g->fill && at < g->capacity) list[at] = entry;
        }
}

/// One work-item per receiver (step 3). With `onePixel` a receiver has the pixel of its projection from one
/// corner of the light only ([4DR] 3.2, algorithm 2).
kernel void raster4d_grid_receivers(const Raster4dParams params, const Raster4dGridParams grid,
                                    global const float* restrict receivers, global const uint* restrict count,
                                    global const uint* restrict extent, global uint* restrict cursors,
                                    global uint* restrict list) {
    const uint i = get_global_id(0);
    if (i >= *count) return;
    float key[R4_BOUNDS];
    for (int k = 0; k < R4_BOUNDS; ++k) key[k] = receivers[(R4_BOUND + k) * params.receiverStride + (int)i];
    if (grid.onePixel) {
        key[1] = -key[0];
        key[3] = -key[2];
    }
    gridAssign(&grid, gridBox(&grid, extent, key), i, cursors, list);
}

/// One work-item per slot of a triangle (step 4).
kernel void raster4d_grid_triangles(const Raster4dParams params, const Raster4dGridParams grid,
                                    global const float* restrict bounds, global const uint* restrict extent,
                                    global uint* restrict cursors, global uint* restrict list) {
    const int slot = get_global_id(0);
    if (slot >= params.nodeCount[0] * R4_WIDTH) return;
    float box[R4_BOUNDS];
    for (int k = 0; k < R4_BOUNDS; ++k)
        box[k] = bounds[(slot / R4_WIDTH * R4_BOUNDS + k) * R4_WIDTH + slot % R4_WIDTH];
    gridAssign(&grid, gridBox(&grid, extent, box), (uint)slot, cursors, list);
}

/// Loads triangles of a list of slots, with bounds and corners.
inline void loadTriangles(global const float* restrict bounds, global const float* restrict corners,
                          global const uint* restrict slots, int count, TriangleList* list) {
    for (int i = 0; i < count; ++i) {
        const int node = (int)slots[i] / R4_WIDTH, child = (int)slots[i] % R4_WIDTH;
        list->index[i] = slots[i];
        for (int k = 0; k < R4_BOUNDS; ++k)
            list->bound[k][i] = bounds[(node * R4_BOUNDS + k) * R4_WIDTH + child];
        for (int k = 0; k < R4_CORNERS; ++k)
            list->corner[k][i] = corners[(node * R4_CORNERS + k) * R4_WIDTH + child];
    }
    list->count = count;
    CLOSE_LIST(list)
}

/// Without rejection: the rows of every pair are worked out, and dropped where it does not count.
inline void rasterAll(const Raster4dParams* p, const Raster4dInputs* in, const TriangleList* list, int i, uint* mask) {
    const MaskReceiver r = maskReceiver(p, in->receivers, i);
    for (int from = 0; from < list->count; from += LANES) {
        VU code;
        const VI pass = projectTriangles(p, &r, list, from, &code) &
                        PASSING(list->bound[0] + from, GROUP_LIST + 16, r.key);
        int hits[LANES];
        uint codes[LANES], kept[LANES], dropped[LANES];
        V_STORE(pass, hits, 0);
        V_STORE(code, codes, 0);
        int keptCount = 0, droppedCount = 0;
        for (int lane = 0; lane < LANES; ++lane) kept[lane] = dropped[lane] = codes[0];
        for (int lane = 0; lane < LANES && from + lane < list->count; ++lane) {
            if (hits[lane])
                kept[keptCount++] = codes[lane];
            else
                dropped[droppedCount++] = (codes[lane] & 511u) | (uint)(p->rows - 1) << 15;
        }
        if (keptCount) rasterLanes(p, in, &r, list, kept, keptCount, mask);
        if (!droppedCount) continue;
        uint unused[MASK_WORDS];
        for (int w = 0; w < MASK_WORDS; ++w) unused[w] = 0u;
        rasterLanes(p, in, &r, list, dropped, droppedCount, unused);
        // Its bits must be worked out, but none may reach the mask: words beyond the last row are never read
        mask[MASK_WORDS - 1] ^= unused[0];
    }
}

/// One work-item per pixel of the band: all its triangles with all its receivers (step 5).
/// ends [pixel]: where the pixel's part of each list ends, and the last one's ends where it begins;
/// receiverMasks [receiver, word, row]
kernel void raster4d_grid_masks(const Raster4dParams params, const Raster4dGridParams grid,
                                global const float* restrict receivers, global const float* restrict bounds,
                                global const float* restrict corners, global const float* restrict world,
                                global const uint* restrict order,
                                global const uint* restrict receiverEnds, global const uint* restrict receiverList,
                                global const uint* restrict triangleEnds, global const uint* restrict triangleList,
                                global const float* restrict cellX, global const float* restrict cellY,
                                global const int* restrict cellSample, RASTER4D_SURFACES,
                                global uint* restrict receiverMasks) {
    const int pixel = get_global_id(0);
    if (pixel >= grid.rowCount * grid.size) return;
    const uint receiverBegin = pixel ? receiverEnds[pixel - 1] : 0u, receiverEnd = receiverEnds[pixel];
    const uint triangleBegin = pixel ? triangleEnds[pixel - 1] : 0u, triangleEnd = triangleEnds[pixel];
    // A list that did not fit: the frame is repeated
    if (receiverEnd > grid.capacity || triangleEnd > grid.capacity) return;
    const Raster4dInputs in = {receivers,
                               world,
                               order,
                               {cellX, cellY, cellSample},
                               {indices, triangleDraw, draws, materials, uvs, colours, texels}};
    TriangleList list;
    for (uint from = triangleBegin; from < triangleEnd; from += GROUP_LIST) {
        loadTriangles(bounds, corners, triangleList + from, (int)min(triangleEnd - from, (uint)GROUP_LIST), &list);
        for (uint i = receiverBegin; i < receiverEnd; ++i) {
            const int receiver = (int)receiverList[i];
            uint mask[MASK_WORDS];
            for (int w = 0; w < MASK_WORDS; ++w) mask[w] = 0u;
            if (grid.reject)
                rasterList(&params, &in, &list, receiver, mask);
            else
                rasterAll(&params, &in, &list, receiver, mask);
            for (int word = 0; word < params.words; ++word)
                for (int row = 0; row < params.rows; ++row) {
                    const uint bits = mask[word * MASK_STRIDE + row];
                    global uint* out =
                        receiverMasks + ((size_t)receiver * params.words + word) * params.rows + row;
                    if (bits) atomic_or(out, bits);
                }
        }
    }
}

/// One work-item per receiver: its whole mask becomes visibility.
kernel void raster4d_grid_finish(const Raster4dParams params, const ReceiverParams image,
                                 global const float* restrict planes, global const float* restrict receivers,
                                 global const uint* restrict count, global const float* restrict cellX,
                                 global const float* restrict cellY, global const int* restrict cellSample,
                                 global const uint* restrict empty, global const uint* restrict receiverMasks,
                                 global float* restrict visibility, global uint* restrict masks) {
    const uint i = get_global_id(0);
    if (i >= *count) return;
    const int pixel = (int)as_uint(receivers[R4_PIXEL * params.receiverStride + (int)i]);
    const Receiver r = receiverAt(&image, &params.lightFromWorld, params.halfWidth, params.halfHeight, planes, pixel);
    const MaskCells cells = {cellX, cellY, cellSample};
    uint mask[MASK_WORDS];
    for (int w = 0; w < MASK_WORDS; ++w) mask[w] = 0xffffffffu;
    startMask(&params, r.origin, r.normal, empty, &cells, mask);
    for (int word = 0; word < params.words; ++word)
        for (int row = 0; row < params.rows; ++row)
            mask[word * MASK_STRIDE + row] |= receiverMasks[((size_t)i * params.words + word) * params.rows + row];
    storeMask(&params, &image, pixel, mask, empty, visibility, masks);
}

/// One work-item: keeps the larger of the entries that a list needed.
kernel void raster4d_grid_longest(global const uint* restrict total, global uint* restrict longest) {
    if (get_global_id(0) == 0) *longest = max(*longest, *total);
}
