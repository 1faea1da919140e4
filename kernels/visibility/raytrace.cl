// SPDX-License-Identifier: MIT
// Visibility by one any-hit ray per pixel and light sample through the tree of shared/bvh.h.
//   G-buffer --receivers--> packets of LANES samples of one pixel --tree--> transmittance --mean--> visibility
// Source: our own. Edges are tested by the sign of d.(a x b) with corners relative to the ray's origin: two
// triangles compute a shared edge with opposite signs exactly, so that closed meshes have no cracks.
// Opacity is multiplied along the ray as a sum of fixed-point logarithms: the tree's order does not matter.
#include "lib/lanes.h"
#include "lib/random_samples.h"
#include "lib/receiver.h"
#include "lib/texture.h"
#include "lib/transmittance.h"
#include "shared/bvh.h"
#include "shared/raytrace.h"

#define RAY_STACK 96  // each level leaves at most BVH_WIDTH - 1 behind

/// A packet of rays from one origin, of unit length in t: t = 1 is the light sample.
typedef struct {
    VF x, y, z;     ///< directions, not normalised
    VF ix, iy, iz;  ///< their inverses
    VI alive;       ///< mask: may still pass
    VI logs[3];     ///< of transmittance so far, fixed point
} RayPacket;

inline VF inverseOf(VF d) {
    const VF tiny = V_SELECT((VF)1e-18f, (VF)-1e-18f, V_MASK(d < 0.0f));
    return 1.0f / V_SELECT(d, tiny, V_MASK(fabs(d) < 1e-18f));
}

inline RayPacket packetTo(const RaytraceParams* p, float3 origin, float3 normal, global const float* restrict samples,
                          int pixel, int first) {
    RayPacket r;
    const int count = p->samples;
    const VI index = V_INDEX + first;
    const VI inside = V_MASK(index < count);
    const VI clamped = V_SELECT((VI)0, index, inside);
    if (p->shape == RAY_SAMPLES_FIXED) {
        r.x = V_GATHER_(VF, samples, clamped);
        r.y = V_GATHER_(VF, samples, clamped + count);
        r.z = V_GATHER_(VF, samples, clamped + 2 * count);
    } else {
        randomSamples(p, pixel, index, &r.x, &r.y, &r.z);
    }
    r.x -= origin.x;
    r.y -= origin.y;
    r.z -= origin.z;
    r.ix = inverseOf(r.x);
    r.iy = inverseOf(r.y);
    r.iz = inverseOf(r.z);
    // Samples below the receiver's plane are hidden by the receiver itself
    const VF facing = fma(r.x, (VF)normal.x, fma(r.y, (VF)normal.y, r.z * normal.z));
    r.alive = inside & V_MASK(facing > 0.0f);
    for (int c = 0; c < 3; ++c) r.logs[c] = (VI)0;
    return r;
}

/// Lanes whose segment meets a box; boxes are widened by what rounding may take.
inline VI packetMeetsBox(const RayPacket* r, float3 origin, global const float* restrict node, int child) {
    const float lowX = node[child], highX = node[3 * BVH_WIDTH + child];
    if (!(lowX <= highX)) return (VI)0;
    const VF x0 = (lowX - origin.x) * r->ix, x1 = (highX - origin.x) * r->ix;
    const VF y0 = (node[BVH_WIDTH + child] - origin.y) * r->iy;
    const VF y1 = (node[4 * BVH_WIDTH + child] - origin.y) * r->iy;
    const VF z0 = (node[2 * BVH_WIDTH + child] - origin.z) * r->iz;
    const VF z1 = (node[5 * BVH_WIDTH + child] - origin.z) * r->iz;
    const VF enter = max(max(min(x0, x1), min(y0, y1)), max(min(z0, z1), (VF)0.0f));
    const VF leave = min(min(max(x0, x1), max(y0, y1)), min(max(z0, z1), (VF)1.0f));
    return V_MASK(enter <= leave * 1.000001f) & r->alive;
}

typedef struct {
    global const uint* indices;
    global const uint* triangleDraw;
    global const Draw* draws;
    global const Material* materials;
    global const float* uvs;
    global const uint* colours;
    global const uint* texels;
} RaySurfaces;

/// What a surface lets through at barycentric coordinates b; returns 0 if the alpha test fails: no hit.
inline int surfaceLogs(const RaySurfaces* s, uint triangle, float3 b, int logs[3]) {
    const Draw draw = s->draws[s->triangleDraw[triangle]];
    global const Material* m = &s->materials[draw.material];
    const float alpha = surfaceAlpha(&draw, m, s->indices, s->uvs, s->colours, s->texels, triangle, b);
    if (draw.flags & DRAW_MASK) {
        logs[0] = logs[1] = logs[2] = TRANSMITTANCE_OPAQUE;
        return alpha >= m->alphaCutoff;
    }
    float4 colour = m->baseColor;
    const Texture t = m->baseColorTexture;
    const int v0 = (int)s->indices[3 * triangle] + draw.sourceOffset;
    const int v1 = (int)s->indices[3 * triangle + 1] + draw.sourceOffset;
    const int v2 = (int)s->indices[3 * triangle + 2] + draw.sourceOffset;
    if (t.offset >= 0) colour *= textureRead(s->texels, &t, readUvs(s->uvs, v0, v1, v2, b), 0);
    if (draw.flags & DRAW_COLOURS)
        colour *= unpackColour(s->colours[v0]) * b.x + unpackColour(s->colours[v1]) * b.y +
                  unpackColour(s->colours[v2]) * b.z;
    const float colours[3] = {colour.x, colour.y, colour.z};
    for (int c = 0; c < 3; ++c) {
        const float blended = (1.0f - alpha) * (1.0f - alpha + alpha * colours[c]);
        const float transmitted = 1.0f - alpha + alpha * m->transmission * colours[c];
        logs[c] = transmittanceLog(m->transmission > 0.0f ? transmitted : blended);
    }
    return 1;
}

/// Adds what a triangle takes from the rays that hit it; weights are those of its corners, times `sum`.
inline void attenuate(RayPacket* r, const RaySurfaces* s, uint triangle, VI hit, VF w0, VF w1, VF w2) {
    float weights[3][LANES];
    int hits[LANES], logs[3][LANES];
    V_STORE(w0, weights[0], 0);
    V_STORE(w1, weights[1], 0);
    V_STORE(w2, weights[2], 0);
    V_STORE(hit, hits, 0);
    for (int lane = 0; lane < LANES; ++lane) {
        int one[3] = {0, 0, 0};
        if (hits[lane]) {
            const float3 w = (float3)(weights[0][lane], weights[1][lane], weights[2][lane]);
            if (!surfaceLogs(s, triangle, w / (w.x + w.y + w.z), one)) one[0] = one[1] = one[2] = 0;
        }
        for (int c = 0; c < 3; ++c) logs[c][lane] = one[c];
    }
    for (int c = 0; c < 3; ++c)
        r->logs[c] = min(r->logs[c] + V_LOAD(logs[c], 0), (VI)TRANSMITTANCE_OPAQUE);
    r->alive &= V_MASK(min(r->logs[0], min(r->logs[1], r->logs[2])) < TRANSMITTANCE_OPAQUE);
}

inline void packetLeaf(RayPacket* r, float3 origin, global const float* restrict leaf,
                       global const uint* restrict triangles, const RaySurfaces* s) {
    for (int i = 0; i < BVH_LEAF; ++i) {
        const uint triangle = triangles[i];
        if (triangle == BVH_NO_TRIANGLE) return;
        float3 v[3];
        for (int k = 0; k < 3; ++k)
            v[k] = (float3)(leaf[3 * k * BVH_LEAF + i], leaf[(3 * k + 1) * BVH_LEAF + i],
                            leaf[(3 * k + 2) * BVH_LEAF + i]) - origin;
        const float3 e0 = cross3(v[1], v[2]), e1 = cross3(v[2], v[0]), e2 = cross3(v[0], v[1]);
        const VF w0 = fma(r->x, (VF)e0.x, fma(r->y, (VF)e0.y, r->z * e0.z));
        const VF w1 = fma(r->x, (VF)e1.x, fma(r->y, (VF)e1.y, r->z * e1.z));
        const VF w2 = fma(r->x, (VF)e2.x, fma(r->y, (VF)e2.y, r->z * e2.z));
        const VF lowest = min(w0, min(w1, w2)), highest = max(w0, max(w1, w2));
        VI hit = (V_MASK(lowest >= 0.0f) | V_MASK(highest <= 0.0f)) & V_MASK(highest > lowest) & r->alive;
        if (!V_ANY(hit)) continue;
        // Distance along the ray: t = n.a / n.d, between 0 and 1
        const float3 n = cross3(v[1] - v[0], v[2] - v[0]);
        const float na = n.x * v[0].x + n.y * v[0].y + n.z * v[0].z;
        const VF nd = fma(r->x, (VF)n.x, fma(r->y, (VF)n.y, r->z * n.z));
        hit &= V_MASK(nd * na > 0.0f) & V_MASK(fabs(nd) > fabs(na));
        if (!V_ANY(hit)) continue;
        const uint flags = s->draws[s->triangleDraw[triangle]].flags;
        if (flags & (DRAW_MASK | DRAW_BLEND)) {
            attenuate(r, s, triangle, hit, w0, w1, w2);
        } else {
            r->alive &= ~hit;
            for (int c = 0; c < 3; ++c) r->logs[c] = V_SELECT(r->logs[c], (VI)TRANSMITTANCE_OPAQUE, hit);
        }
        if (!V_ANY(r->alive)) return;
    }
}

inline void tracePacket(RayPacket* r, float3 origin, const BvhParams* bvh, global const float* restrict nodes,
                        global const float* restrict leaves, global const uint* restrict leafTriangles,
                        const RaySurfaces* s) {
    if (bvh->levels == 0) return;
    uint stack[RAY_STACK];
    int depth = 0;
    stack[depth++] = (uint)(bvh->levels - 1) << 28;  // level, index in it
    while (depth > 0 && V_ANY(r->alive)) {
        const uint top = stack[--depth];
        const int level = (int)(top >> 28), index = (int)(top & 0x0fffffffu);
        global const float* node = nodes + (size_t)(bvh->firstNode[level] + index) * (6 * BVH_WIDTH);
        for (int child = 0; child < BVH_WIDTH; ++child) {
            if (!V_ANY(packetMeetsBox(r, origin, node, child))) continue;
            const int below = index * BVH_WIDTH + child;
            if (level > 0)
                stack[depth++] = (uint)(level - 1) << 28 | (uint)below;
            else
                packetLeaf(r, origin, leaves + (size_t)below * (9 * BVH_LEAF), leafTriangles + below * BVH_LEAF, s);
        }
    }
}

/// Sum over lanes of what passed, fixed point.
inline uint packetPassed(const RayPacket* r, int channel) {
    int logs[LANES], alive[LANES];
    V_STORE(r->logs[channel], logs, 0);
    V_STORE(r->alive, alive, 0);
    uint sum = 0;
    for (int lane = 0; lane < LANES; ++lane) sum += alive[lane] ? (uint)transmittanceOf(logs[lane]) : 0u;
    return sum;
}

/// One work-item per pixel of the padded image.
/// samples [3, sample] world, re-based; visibility [channels, planeStride]
kernel void raytrace(const RaytraceParams params, const ReceiverParams image, const BvhParams bvh,
                     global const float* restrict planes, global const float* restrict nodes,
                     global const float* restrict leaves, global const uint* restrict leafTriangles,
                     global const float* restrict samples, global const uint* restrict indices,
                     global const uint* restrict triangleDraw, global const Draw* restrict draws,
                     global const Material* restrict materials, global const float* restrict uvs,
                     global const uint* restrict colours, global const uint* restrict texels,
                     global uint* restrict state, global float* restrict visibility) {
    const int pixel = get_global_id(0), stride = image.planeStride;
    if (pixel >= stride) return;
    const Receiver receiver =
        receiverAt(&image, &params.lightFromWorld, params.halfWidth, params.halfHeight, planes, pixel);
    if (params.classify) {
        state[pixel] = receiver.state;
        for (int c = 0; c < params.channels; ++c) visibility[c * stride + pixel] = 1.0f;
    }
    if (state[pixel] != params.onlyState || receiver.state != STATE_TESTED) return;
    const RaySurfaces surfaces = {indices, triangleDraw, draws, materials, uvs, colours, texels};
    uint passed[3] = {0, 0, 0};
    for (int first = 0; first < params.samples; first += LANES) {
        RayPacket packet = packetTo(&params, receiver.origin, receiver.normal, samples, pixel, first);
        tracePacket(&packet, receiver.origin, &bvh, nodes, leaves, leafTriangles, &surfaces);
        for (int c = 0; c < (params.mean ? 3 : params.channels); ++c) passed[c] += packetPassed(&packet, c);
    }
    if (params.mean) passed[0] = passed[0] / 3 + passed[1] / 3 + passed[2] / 3;
    state[pixel] = STATE_TESTED;
    const float total = (float)params.samples * (float)TRANSMITTANCE_ONE;
    for (int c = 0; c < params.channels; ++c) visibility[c * stride + pixel] = (float)passed[c] / total;
}
