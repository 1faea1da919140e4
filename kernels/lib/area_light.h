// SPDX-License-Identifier: MIT
// Irradiance of a polygonal light in closed form: Lambert's formula, clipped to the receiver's horizon.
// Disks are polygons of the same area (16 corners). Everything is in the light's frame.
#ifndef LIB_AREA_LIGHT_H
#define LIB_AREA_LIGHT_H
#include "lib/lanes.h"
#include "shared/shade.h"

typedef struct {
    VF x, y, z;
} V3;

inline VF v3Dot(V3 a, V3 b) {
    return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}

inline V3 v3Scale(V3 a, VF s) {
    V3 r;
    r.x = a.x * s, r.y = a.y * s, r.z = a.z * s;
    return r;
}

inline V3 v3Add(V3 a, V3 b) {
    V3 r;
    r.x = a.x + b.x, r.y = a.y + b.y, r.z = a.z + b.z;
    return r;
}

inline V3 v3Unit(V3 a) {
    return v3Scale(a, 1.0f / sqrt(max(v3Dot(a, a), (VF)1e-30f)));
}

inline V3 v3Select(V3 no, V3 yes, VI mask) {
    V3 r;
    r.x = V_SELECT(no.x, yes.x, mask), r.y = V_SELECT(no.y, yes.y, mask);
    r.z = V_SELECT(no.z, yes.z, mask);
    return r;
}

/// acos(x) / sin(acos(x)) for x in (-1, 1]; |error| <= 2e-7 on [0, 1] (our own Chebyshev fit).
inline VF arcRatio(VF x) {
    const VF y = fabs(x);
    VF p = fma((VF)0.01765390671789646f, y, (VF)-0.09797003120183945f);
    p = fma(p, y, (VF)0.25324133038520813f);
    p = fma(p, y, (VF)-0.42456933856010437f);
    p = fma(p, y, (VF)0.5570240020751953f);
    p = fma(p, y, (VF)-0.6610901355743408f);
    p = fma(p, y, (VF)0.7848963737487793f);
    p = fma(p, y, (VF)-0.9999822974205017f);
    p = fma(p, y, (VF)1.570796251296997f);
    const VF sine = sqrt(max(fma(-y, y, (VF)1.0f), (VF)1e-7f));
    return V_SELECT(p, 3.14159265f / sine - p, V_MASK(x < 0.0f));
}

/// n . (a x b) angle(a, b) / |a x b| for directions a, b of any length.
inline VF edgeIntegral(V3 a, V3 b, V3 n) {
    const V3 u = v3Unit(a), v = v3Unit(b);
    V3 c;
    c.x = u.y * v.z - u.z * v.y;
    c.y = u.z * v.x - u.x * v.z;
    c.z = u.x * v.y - u.y * v.x;
    return arcRatio(clamp(v3Dot(u, v), (VF)-1.0f, (VF)1.0f)) * v3Dot(c, n);
}

inline V3 lightCorner(const ShadeLight* light, int i, V3 p) {
    const float4 pair = light->corner[i >> 1];
    V3 r;
    r.x = (i & 1 ? pair.z : pair.x) - p.x;
    r.y = (i & 1 ? pair.w : pair.y) - p.y;
    r.z = -p.z;
    return r;
}

/// Irradiance at p with unit normal n for radiance 1; 0 behind the light.
inline VF polygonIrradiance(const ShadeLight* light, V3 p, V3 n) {
    V3 exit_ = v3Scale(n, (VF)0.0f), entry = exit_;
    VI crossed = (VI)0;
    VF sum = (VF)0.0f;
    V3 a = lightCorner(light, light->corners - 1, p);
    VF da = v3Dot(a, n);
    for (int i = 0; i < light->corners; ++i) {
        const V3 b = lightCorner(light, i, p);
        const VF db = v3Dot(b, n);
        const VI aAbove = V_MASK(da >= 0.0f), bAbove = V_MASK(db >= 0.0f);
        const VF gap = da - db;
        const VF t = da / V_SELECT(gap, (VF)1.0f, V_MASK(gap == 0.0f));
        const V3 cut = v3Add(v3Scale(a, 1.0f - t), v3Scale(b, t));
        const VF part = edgeIntegral(v3Select(cut, a, aAbove), v3Select(cut, b, bAbove), n);
        sum += V_SELECT((VF)0.0f, part, aAbove | bAbove);
        exit_ = v3Select(exit_, cut, aAbove & ~bAbove);
        entry = v3Select(entry, cut, bAbove & ~aAbove);
        crossed |= aAbove ^ bAbove;
        a = b;
        da = db;
    }
    // The clipped polygon closes along the horizon
    sum += V_SELECT((VF)0.0f, edgeIntegral(exit_, entry, n), crossed);
    const VF polygon = 0.5f * fabs(sum);
    // Small and far: the formula cancels, and a point is as good
    const VF squared = v3Dot(p, p);
    const VF cosines = max(-v3Dot(p, n), (VF)0.0f) * p.z;
    const VF small = light->area * cosines / max(squared * squared, (VF)1e-30f);
    const VF irradiance = V_SELECT(polygon, small, V_MASK(light->area < 1e-4f * squared));
    return V_SELECT((VF)0.0f, irradiance, V_MASK(p.z > 0.0f));
}

#endif
