// SPDX-License-Identifier: MIT
// depth_warp with each map owned by one work-item; paste with OWNED_TEXEL and OWNED_KERNEL defined.
// The map's last texel, at resolution^2, takes what falls outside, so that nothing branches.

/// One work-item per view of the launch: clears its map, then warps all points into it.
kernel void OWNED_KERNEL(const MultiViewParams params, const LookupParams views,
                         global const float* restrict points32, global const ushort* restrict points16,
                         global const uint* restrict keys, global const float* restrict samples,
                         global OWNED_TEXEL* restrict maps,
                         global const MultiViewCounters* restrict counters) {
    const int item = get_global_id(0);
    if (item >= views.viewCount) return;
    const int view = views.firstView + item, size = params.resolution;
    global OWNED_TEXEL* map = maps + (size_t)(view - views.mapView) * params.mapStride;
    for (int i = 0; i < params.mapStride; ++i) map[i] = 0;

    const uint count = min(counters->points, params.pointCapacity);
    const float kx = samples[2 * view], ky = samples[2 * view + 1];
    const VF limit = (VF)(float)size;
    for (uint first = 0; first < count; first += LANES) {
        const PointLanes p = loadPoints(&params, first, points32, points16);
        const VF u = fma((VF)-kx, p.w, p.a), v = fma((VF)-ky, p.w, p.b);
        VI inside = V_MASK(u >= 0.0f) & V_MASK(u < limit) & V_MASK(v >= 0.0f) & V_MASK(v < limit) &
                    V_MASK(V_INDEX < (VI)(int)(count - first));
        const VI column = V_TO_INT(V_SELECT((VF)0.0f, u, inside));
        const VI row = V_TO_INT(V_SELECT((VF)0.0f, v, inside));
        const VI texel = V_SELECT((VI)(size * size), row * size + column, inside);
        const VF depth = min(p.w, (VF)1.0f);
        const VU bits = params.depthBits == 32 ? V_AS_UINT(depth)
                                               : V_AS_UINT(V_TO_INT(fma(depth, (VF)65535.0f, (VF)0.5f)));
        int texels[LANES];
        uint values[LANES];
        V_STORE(texel, texels, 0);
        V_STORE(bits, values, 0);
        for (int lane = 0; lane < LANES; ++lane) {
            if (params.alphaKeys && texels[lane] != size * size &&
                !opacityBlocks(keys[first + (uint)lane], view, params.views, params.sampleStride))
                continue;
            global OWNED_TEXEL* target = &map[texels[lane]];
            if (*target < values[lane]) *target = (OWNED_TEXEL)values[lane];
        }
    }
}
#undef OWNED_TEXEL
#undef OWNED_KERNEL
