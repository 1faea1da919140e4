// SPDX-License-Identifier: MIT
// Shadow tests against maps of one texel type; paste with LOOKUP_KERNEL, LOOKUP_TEXEL, LOOKUP_DEPTH.

/// Lanes whose texel holds something nearer than `reference`; texels outside of the map hold nothing.
inline VI LANES_JOIN(LOOKUP_KERNEL, _hides)(global const LOOKUP_TEXEL* restrict map, int size, VI column,
                                            VI row, VF reference) {
    const VI inside = V_MASK(column >= 0) & V_MASK(column < size) & V_MASK(row >= 0) & V_MASK(row < size);
    const VI texel = V_SELECT((VI)(size * size), row * size + column, inside);
    const VF depth = LOOKUP_DEPTH(V_GATHER_(VU, map, texel));
    // Where the receiver's plane ends at its horizon, `reference` is negative: empty texels hide nothing
    return V_MASK(depth > max(reference, (VF)0.0f)) & inside;
}

/// The same where the taps of all lanes lie inside: that of this one is `offset` texels from `texel`.
inline VI LANES_JOIN(LOOKUP_KERNEL, _hidesInside)(global const LOOKUP_TEXEL* restrict map, VI texel, int offset,
                                                  VF reference) {
    return V_MASK(LOOKUP_DEPTH(V_GATHER_NEAR(VU, map, texel, offset)) > max(reference, (VF)0.0f));
}

/// One work-item per LANES pixels: adds the hidden tests of the launch's views to hidden [stride].
kernel void LOOKUP_KERNEL(const MultiViewParams params, const LookupParams lookup, const int stride,
                          global const float* restrict receiver, global const float* restrict samples,
                          global const LOOKUP_TEXEL* restrict maps, global uint* restrict hidden) {
    const int pixel = (int)get_global_id(0) * LANES;
    if (pixel >= stride) return;
    const VF w = V_LOAD(receiver, RECEIVER_W * stride + pixel);
    const VI tested = V_MASK(w > 0.0f);
    if (!V_ANY(tested)) return;
    // Lanes that are not tested look into the middle of the map
    const VF middle = (VF)params.centre;
    const VF a = V_SELECT(middle, V_LOAD(receiver, RECEIVER_A * stride + pixel), tested);
    const VF b = V_SELECT(middle, V_LOAD(receiver, RECEIVER_B * stride + pixel), tested);
    const VF gradientX = V_LOAD(receiver, RECEIVER_GRADIENT_X * stride + pixel);
    const VF gradientY = V_LOAD(receiver, RECEIVER_GRADIENT_Y * stride + pixel);
    const VF facing = V_LOAD(receiver, RECEIVER_FACING * stride + pixel);
    const VF margin = w * (lookup.constantTexels / params.focal + w * (lookup.constantMetres / params.near)) +
                        lookup.quantum;
    const int size = params.resolution, bilinear = lookup.pcf == 4;
    const int weight = bilinear ? 256 : lookup.pcf;
    const float shift = bilinear ? 0.5f : 0.0f;
    VI count = (VI)0;
    for (int i = 0; i < lookup.viewCount; ++i) {
        const int view = lookup.firstView + i;
        global const LOOKUP_TEXEL* map = maps + (size_t)(view - lookup.mapView) * params.mapStride;
        const float kx = samples[2 * view], ky = samples[2 * view + 1];
        const VF u = fma((VF)-kx, w, a) - shift, v = fma((VF)-ky, w, b) - shift;
        const VF e = facing + gradientX * kx + gradientY * ky;
        const VI above = V_MASK(e > 0.0f);
        // Depth of the receiver's plane at the first tap's centre, and its step per texel
        const VF inverse = lookup.flat ? (VF)0.0f : -1.0f / V_SELECT((VF)1.0f, e, above);
        const VF stepX = gradientX * inverse, stepY = gradientY * inverse;
        const VF column0 = floor(clamp(u, (VF)-4.0f, (VF)(float)(size + 4)));
        const VF row0 = floor(clamp(v, (VF)-4.0f, (VF)(float)(size + 4)));
        const VF slope = (fabs(stepX) + fabs(stepY)) * (0.5f * lookup.slopeBias);
        const VF reference = w + stepX * (column0 + (0.5f - shift) - u) +
                             stepY * (row0 + (0.5f - shift) - v) + slope + margin;
        const VI column = V_TO_INT(column0), row = V_TO_INT(row0), texel = row * size + column;
        const VI inside = V_MASK(column > 0) & V_MASK(column < size - 1) & V_MASK(row > 0) & V_MASK(row < size - 1);
        VI tests;
#define REFERENCE(dx, dy) (reference + stepX * (float)(dx) + stepY * (float)(dy))
        if (V_ALL(inside)) {
#define HIDES(dx, dy) LANES_JOIN(LOOKUP_KERNEL, _hidesInside)(map, texel, (dy)*size + (dx), REFERENCE(dx, dy))
            LOOKUP_TAPS
#undef HIDES
        } else {
#define HIDES(dx, dy) LANES_JOIN(LOOKUP_KERNEL, _hides)(map, size, column + (dx), row + (dy), REFERENCE(dx, dy))
            LOOKUP_TAPS
#undef HIDES
        }
#undef REFERENCE
        // Samples below the receiver's plane are hidden by the receiver itself
        count += V_SELECT((VI)weight, tests, above);
    }
    const VI sum = V_AS_INT(V_LOAD(hidden, pixel)) + (count & tested);
    V_STORE(V_AS_UINT(sum), hidden, pixel);
}
#undef LOOKUP_KERNEL
#undef LOOKUP_TEXEL
#undef LOOKUP_DEPTH
