// SPDX-License-Identifier: MIT
// Masks of a tile of receivers: triangles' nodes are culled against the tile, then against its groups of 16,
// then triangles against a group and at last against each receiver. Part of raster4d.cl.

#define TILE_LIST 1024  // clusters that a tile remembers; its groups look for the rest themselves
#define GROUP_LIST 256  // triangles of a group before they are rasterised

/// Nodes that passed, with their bounds; padded by a vector.
typedef struct {
    float bound[R4_BOUNDS][TILE_LIST + 16];
    uint index[TILE_LIST + 16];
    int count;
} NodeList;

/// Triangles that passed, with bounds and corners.
typedef struct {
    float bound[R4_BOUNDS][GROUP_LIST + 16];
    float corner[R4_CORNERS][GROUP_LIST + 16];
    uint index[GROUP_LIST + 16];
    int count;
} TriangleList;

/// Lanes of `bounds` (k apart by `stride`) that none of the key's parts exceeds.
#define PASSING(bounds, stride, key)                                                                    \
    (V_MASK(V_LOAD(bounds, 0) >= (key)[0]) & V_MASK(V_LOAD(bounds, (stride)) >= (key)[1]) &             \
     V_MASK(V_LOAD(bounds, 2 * (stride)) >= (key)[2]) & V_MASK(V_LOAD(bounds, 3 * (stride)) >= (key)[3]) & \
     V_MASK(V_LOAD(bounds, 4 * (stride)) >= (key)[4]))

/// Appends the children of a node that pass to a list with room for 16.
#define APPEND_PASSING(node, bounds, key, list)                                              \
    for (int half_ = 0; half_ < R4_WIDTH; half_ += LANES) {                                  \
        global const float* at_ = (bounds) + (size_t)(node) * (R4_BOUNDS * R4_WIDTH) + half_; \
        const VI pass_ = PASSING(at_, R4_WIDTH, key);                                        \
        if (!V_ANY(pass_)) continue;                                                         \
        int hits_[LANES];                                                                    \
        V_STORE(pass_, hits_, 0);                                                            \
        for (int lane_ = 0; lane_ < LANES; ++lane_) {                                        \
            if (!hits_[lane_]) continue;                                                     \
            const int n_ = (list)->count++;                                                  \
            (list)->index[n_] = (uint)((node) * R4_WIDTH + half_ + lane_);                   \
            for (int k_ = 0; k_ < R4_BOUNDS; ++k_)                                           \
                (list)->bound[k_][n_] = at_[k_ * R4_WIDTH + lane_];                          \
        }                                                                                    \
    }

/// The same for the triangles of a lowest node, with their corners.
inline void appendTriangles(int node, global const float* restrict bounds, global const float* restrict corners,
                            const float* key, TriangleList* list) {
    for (int half_ = 0; half_ < R4_WIDTH; half_ += LANES) {
        global const float* at = bounds + (size_t)node * (R4_BOUNDS * R4_WIDTH) + half_;
        global const float* corner = corners + (size_t)node * (R4_CORNERS * R4_WIDTH) + half_;
        const VI pass = PASSING(at, R4_WIDTH, key);
        if (!V_ANY(pass)) continue;
        int hits[LANES];
        V_STORE(pass, hits, 0);
        for (int lane = 0; lane < LANES; ++lane) {
            if (!hits[lane]) continue;
            const int n = list->count++;
            list->index[n] = (uint)(node * R4_WIDTH + half_ + lane);
            for (int k = 0; k < R4_BOUNDS; ++k) list->bound[k][n] = at[k * R4_WIDTH + lane];
            for (int k = 0; k < R4_CORNERS; ++k) list->corner[k][n] = corner[k * R4_WIDTH + lane];
        }
    }
}

/// Whatever is loaded beyond the end of a list passes nothing.
#define CLOSE_LIST(list)                                     \
    for (int i_ = 0; i_ < LANES; ++i_)                       \
        (list)->bound[0][(list)->count + i_] = -INFINITY;

inline void leastKey(global const float* restrict receivers, int stride, int first, int count, float* key) {
    for (int k = 0; k < R4_BOUNDS; ++k) {
        global const float* values = receivers + (R4_BOUND + k) * stride + first;
        float least = values[0];
        for (int i = 1; i < count; ++i) least = min(least, values[i]);
        key[k] = least;
    }
}

/// Cells without a sample, and samples below the receiver's own horizon, count as hidden from the start.
inline void startMask(const Raster4dParams* p, float3 origin, float3 normal, global const uint* restrict empty,
                      const MaskCells* cells, uint* mask) {
    for (int word = 0; word < p->words; ++word)
        for (int row = 0; row < p->rows; ++row) mask[word * MASK_STRIDE + row] = empty[word * p->rows + row];
    const float3 toCorner = (p->corner.xyz - origin) + p->cornerLow.xyz;
    const float at = fma(toCorner.x, normal.x, fma(toCorner.y, normal.y, toCorner.z * normal.z));
    const float x = fma(p->stepX.x, normal.x, fma(p->stepX.y, normal.y, p->stepX.z * normal.z));
    const float y = fma(p->stepY.x, normal.x, fma(p->stepY.y, normal.y, p->stepY.z * normal.z));
    const float least = at + min(x, 0.0f) * ((float)p->columns - 0.5f) + min(y, 0.0f) * ((float)p->rows - 0.5f) -
                        0.5f * (max(x, 0.0f) + max(y, 0.0f));
    if (least > 0.0f) return;
    for (int cell = 0; cell < p->rows * p->columns; ++cell)
        if (!(fma(x, cells->x[cell], fma(y, cells->y[cell], at)) > 0.0f))
            mask[(cell % p->columns >> 5) * MASK_STRIDE + cell / p->columns] |= 1u << (cell % p->columns & 31);
}

inline int maskFull(const Raster4dParams* p, const uint* mask) {
    VU common = (VU)0xffffffffu;
    for (int word = 0; word < p->words; ++word)
        for (int row = 0; row < p->rows; row += LANES) common &= V_LOAD(mask + word * MASK_STRIDE + row, 0);
    return V_ALL(V_MASK(V_AS_INT(common) == -1));
}

typedef struct {
    global const float* receivers;
    global const float* world;
    global const uint* order;
    MaskCells cells;
    MaskSurfaces surfaces;
} Raster4dInputs;

/// A receiver, and by how many cells its projections of corners may be off.
typedef struct {
    float3 q;
    MaskOrigin world;
    float key[R4_BOUNDS];
    float margin, marginReach;  ///< the latter times how much farther than the corner the light is
} MaskReceiver;

inline MaskReceiver maskReceiver(const Raster4dParams* p, global const float* restrict receivers, int i) {
    const int stride = p->receiverStride;
    MaskReceiver r;
    r.q = (float3)(receivers[R4_Q * stride + i], receivers[(R4_Q + 1) * stride + i],
                   receivers[(R4_Q + 2) * stride + i]);
    r.world.origin = (float3)(receivers[R4_ORIGIN * stride + i], receivers[(R4_ORIGIN + 1) * stride + i],
                              receivers[(R4_ORIGIN + 2) * stride + i]);
    r.world.toCorner = (p->corner.xyz - r.world.origin) + p->cornerLow.xyz;
    for (int k = 0; k < R4_BOUNDS; ++k) r.key[k] = receivers[(R4_BOUND + k) * stride + i];
    // Rounding of edges' lines and of grid coordinates, generously; samples off their cells' centres
    const float beside = fabs(r.q.x) + fabs(r.q.y);
    r.margin = 0.015625f + p->slack + 1e-6f * beside * (1.0f + beside / r.q.z);
    r.marginReach = 3e-7f * (beside + r.q.z);
    return r;
}

/// Pairs that are to be rasterised.
typedef struct {
    uint code[GROUP_LIST + 16];  ///< place in the list of triangles, rows and planes: see PAIR_*
    int count;
} PairList;

#define PAIR_AT(code) ((int)((code) & 511u))
#define PAIR_FIRST(code) ((int)((code) >> 9 & 63u))
#define PAIR_LAST(code) ((int)((code) >> 15 & 63u))
#define PAIR_PLANES(code) (3 + (int)((code) >> 21 & 1u))

/// Triangles of the list from `at` on whose projections may hold a sample, and their pairs' codes. A triangle with a
/// corner that is not between light and receiver may reach all rows, and its own plane matters.
inline VI projectTriangles(const Raster4dParams* p, const MaskReceiver* r, const TriangleList* list, int at, VU* code) {
    VF lowX = (VF)INFINITY, lowY = (VF)INFINITY, highX = -(VF)INFINITY, highY = -(VF)INFINITY;
    VF nearest = (VF)INFINITY, farthest = -(VF)INFINITY, most = (VF)0.0f;
#pragma unroll
    for (int k = 0; k < 3; ++k) {
        const VF z = V_LOAD(list->corner[3 * k + 2] + at, 0);
        const VF reach = r->q.z / (r->q.z - z);
        const VF x = fma(V_LOAD(list->corner[3 * k] + at, 0) - r->q.x, reach, (VF)r->q.x);
        const VF y = fma(V_LOAD(list->corner[3 * k + 1] + at, 0) - r->q.y, reach, (VF)r->q.y);
        lowX = min(lowX, x);
        lowY = min(lowY, y);
        highX = max(highX, x);
        highY = max(highY, y);
        nearest = min(nearest, z);
        farthest = max(farthest, z);
        most = max(most, reach);
    }
    const VI before = V_MASK(farthest < r->q.z);
    const VF columns = (VF)(float)(p->columns - 1), rows = (VF)(float)(p->rows - 1), none = (VF)0.0f;
    const VF margin = fma(most, (VF)r->marginReach, (VF)r->margin), beyond = (VF)(float)R4_ROWS;
    const VF left = clamp(lowX - margin, none, beyond), right = min(highX + margin, columns);
    const VF top = clamp(lowY - margin, none, beyond), bottom = min(highY + margin, rows);
    const VI meets = V_MASK(left <= right) & V_MASK(top <= bottom) & before;
    const VI first = maskCeil(V_SELECT(none, top, meets)), last = V_TO_INT(V_SELECT(rows, bottom, meets));
    const VI planes = (VI)1 & ~(before & V_MASK(nearest > 0.0f));
    *code = V_AS_UINT((V_INDEX + at) | first << 9 | last << 15 | planes << 21);
    return ~before | (V_MASK(maskCeil(V_SELECT(none, left, meets)) <= V_TO_INT(V_SELECT(none, right, meets))) &
                      V_MASK(first <= last) & meets);
}

inline void listPairs(const Raster4dParams* p, const MaskReceiver* r, const TriangleList* list, PairList* pairs) {
    int count = 0;
    for (int at = 0; at < list->count; at += LANES) {
        VI pass = PASSING(list->bound[0] + at, GROUP_LIST + 16, r->key);
        if (!V_ANY(pass)) continue;
        VU code;
        pass &= projectTriangles(p, r, list, at, &code);
        if (!V_ANY(pass)) continue;
        int hits[LANES];
        uint codes[LANES];
        V_STORE(pass, hits, 0);
        V_STORE(code, codes, 0);
#pragma unroll
        for (int lane = 0; lane < LANES; ++lane) {
            pairs->code[count] = codes[lane];
            count += hits[lane] != 0;
        }
    }
    pairs->count = count;
    for (int lane = 0; lane < LANES; ++lane) pairs->code[count + lane] = 0u;  // something to load
}

/// Adds what each of LANES pairs hides.
inline void rasterLanes(const Raster4dParams* p, const Raster4dInputs* in, const MaskReceiver* r,
                        const TriangleList* list, const uint* codes, int count, uint* mask) {
    int offset[LANES];
    for (int lane = 0; lane < LANES; ++lane)
        offset[lane] = (int)list->index[PAIR_AT(codes[lane < count ? lane : 0])] * R4_WORLD;
    const VI offsets = V_LOAD(offset, 0);
    MaskTriangles triangles;
#pragma unroll
    for (int k = 0; k < R4_WORLD; ++k) triangles.at[k] = V_GATHER_(VF, in->world + k, offsets);
    const MaskLines lines = maskLines(p, &r->world, &triangles);
    MaskEnds ends;
    maskEnds(&lines, &ends);
    uint bits[2][LANES];
    maskOneRow(p, &ends, V_TO_FLOAT(V_AS_INT(V_LOAD(codes, 0) >> 9 & 63u)), bits);
    int valid[LANES];
    V_STORE(lines.valid, valid, 0);
    for (int lane = 0; lane < LANES && lane < count; ++lane) {
        if (!valid[lane]) continue;
        const int first = PAIR_FIRST(codes[lane]), last = PAIR_LAST(codes[lane]), planes = PAIR_PLANES(codes[lane]);
        const uint triangle = in->order[list->index[PAIR_AT(codes[lane])]];
        if (!p->centred || (triangle & R4_SURFACE)) {
            pairSamples(p, &ends, lane, planes, first, last, triangle, &in->cells, &in->surfaces, mask);
        } else if (!p->rowAtOnce) {
            maskBitwise(p, &ends, lane, planes, first, last, mask);
        } else if (first == last && planes == 3) {
            mask[first] |= bits[0][lane];
            if (p->words > 1) mask[MASK_STRIDE + first] |= bits[1][lane];
        } else {
            maskRows(p, &ends, lane, planes, first, last, mask);
        }
    }
}

/// Rasterises a list of triangles into the mask of receiver i.
inline void rasterList(const Raster4dParams* p, const Raster4dInputs* in, const TriangleList* list, int i, uint* mask) {
    const MaskReceiver r = maskReceiver(p, in->receivers, i);
    PairList pairs;
    listPairs(p, &r, list, &pairs);
    for (int from = 0; from < pairs.count; from += LANES) {
        if (maskFull(p, mask)) return;
        rasterLanes(p, in, &r, list, pairs.code + from, pairs.count - from, mask);
    }
}

inline void storeMask(const Raster4dParams* p, const ReceiverParams* image, int pixel, const uint* mask,
                      global const uint* restrict empty, global float* restrict visibility,
                      global uint* restrict masks) {
    int hidden = 0;
    for (int word = 0; word < p->words; ++word)
        for (int row = 0; row < p->rows; ++row) {
            const uint bits = mask[word * MASK_STRIDE + row] & ~empty[word * p->rows + row];
            hidden += (int)popcount(bits);
            if (p->keepMasks) masks[(size_t)(row * p->words + word) * image->planeStride + pixel] = bits;
        }
    visibility[pixel] = (float)(p->samples - hidden) / (float)p->samples;
}

/// One work-item per tile of tileGroups x 16 receivers.
/// empty [words, rows]: cells without a sample; cells [rows * columns]
kernel void raster4d_bins(const Raster4dParams params, const ReceiverParams image,
                          global const float* restrict planes, global const float* restrict receivers,
                          global const uint* restrict receiverCount, global const float* restrict bounds0,
                          global const float* restrict bounds1, global const float* restrict bounds2,
                          global const float* restrict corners, global const float* restrict world,
                          global const uint* restrict order, global const float* restrict cellX, global const float* restrict cellY,
                          global const int* restrict cellSample, global const uint* restrict empty,
                          RASTER4D_SURFACES, global float* restrict visibility, global uint* restrict masks) {
    const int stride = params.receiverStride, first = (int)get_global_id(0) * params.tileGroups * R4_WIDTH;
    const int count = min((int)*receiverCount - first, params.tileGroups * R4_WIDTH);
    if (count <= 0) return;
    const Raster4dInputs in = {receivers,
                               world,
                               order,
                               {cellX, cellY, cellSample},
                               {indices, triangleDraw, draws, materials, uvs, colours, texels}};
    float key[R4_BOUNDS];
    leastKey(receivers, stride, first, count, key);
    NodeList tile;
    tile.count = 0;
    // Nodes of level 2 below `node` are in the list, as far as they have anything for the tile
    int node = 0;
    for (; node < params.nodeCount[2] && tile.count <= TILE_LIST - R4_WIDTH * R4_WIDTH; ++node) {
        NodeList inner;
        inner.count = 0;
        APPEND_PASSING(node, bounds2, key, &inner)
        for (int i = 0; i < inner.count; ++i) APPEND_PASSING((int)inner.index[i], bounds1, key, &tile)
    }
    CLOSE_LIST(&tile)
    uint mask[R4_WIDTH][MASK_WORDS];
    for (int group = first; group < first + count; group += R4_WIDTH) {
        const int size = min(first + count - group, R4_WIDTH);
        leastKey(receivers, stride, group, size, key);
        for (int i = 0; i < size; ++i) {
            const Receiver r = receiverAt(&image, &params.lightFromWorld, params.halfWidth, params.halfHeight, planes,
                                          (int)as_uint(receivers[R4_PIXEL * stride + group + i]));
            for (int w = 0; w < MASK_WORDS; ++w) mask[i][w] = 0xffffffffu;
            startMask(&params, r.origin, r.normal, empty, &in.cells, mask[i]);
        }
        TriangleList list;
        list.count = 0;
#define RASTER_GROUP                                                                            \
    {                                                                                           \
        CLOSE_LIST(&list)                                                                       \
        for (int i_ = 0; i_ < size; ++i_) rasterList(&params, &in, &list, group + i_, mask[i_]); \
        list.count = 0;                                                                         \
    }
#define RASTER_CLUSTER(cluster)                                      \
    {                                                                \
        if (list.count > GROUP_LIST - R4_WIDTH) RASTER_GROUP         \
        appendTriangles((int)(cluster), bounds0, corners, key, &list); \
    }
        for (int at = 0; at < tile.count; at += LANES) {
            const VI pass = PASSING(tile.bound[0] + at, TILE_LIST + 16, key);
            if (!V_ANY(pass)) continue;
            int hits[LANES];
            V_STORE(pass, hits, 0);
            for (int lane = 0; lane < LANES; ++lane)
                if (hits[lane]) RASTER_CLUSTER(tile.index[at + lane])
        }
        for (int rest = node; rest < params.nodeCount[2]; ++rest) {
            NodeList inner, clusters;
            inner.count = clusters.count = 0;
            APPEND_PASSING(rest, bounds2, key, &inner)
            for (int i = 0; i < inner.count; ++i) APPEND_PASSING((int)inner.index[i], bounds1, key, &clusters)
            for (int i = 0; i < clusters.count; ++i) RASTER_CLUSTER(clusters.index[i])
        }
        RASTER_GROUP
        for (int i = 0; i < size; ++i)
            storeMask(&params, &image, (int)as_uint(receivers[R4_PIXEL * stride + group + i]), mask[i], empty,
                      visibility, masks);
    }
}
