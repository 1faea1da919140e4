// SPDX-License-Identifier: MIT
// Products of transmittances that do not depend on their order: sums of logarithms in fixed point.
#ifndef LIB_TRANSMITTANCE_H
#define LIB_TRANSMITTANCE_H

#define TRANSMITTANCE_ONE 65536        // fixed point of both logarithm and result
#define TRANSMITTANCE_OPAQUE (1 << 24) // a logarithm beyond which nothing passes: 2^-256

/// -log2(t) in fixed point; our own series, equal at every vector width. |error| < 2^-16.
inline int transmittanceLog(float t) {
    if (!(t > 1e-12f)) return TRANSMITTANCE_OPAQUE;
    if (t >= 1.0f) return 0;
    const uint bits = as_uint(t) + 0x004afb0du;  // splits at sqrt(1/2), so that the series is short
    const int exponent = (int)(bits >> 23) - 127;
    const float m = as_float((bits & 0x007fffffu) + 0x3f3504f3u);
    const float s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
    const float series = fma(s2, fma(s2, fma(s2, 1.0f / 7.0f, 1.0f / 5.0f), 1.0f / 3.0f), 1.0f);
    const float log2 = fma(2.88539008f * s, series, (float)exponent);
    return max((int)(-log2 * (float)TRANSMITTANCE_ONE + 0.5f), 0);
}

/// 2^-(logarithm), in fixed point.
inline int transmittanceOf(int logarithm) {
    if (logarithm >= 17 * TRANSMITTANCE_ONE) return 0;
    const int whole = logarithm / TRANSMITTANCE_ONE;
    const float f = (float)(logarithm - whole * TRANSMITTANCE_ONE) * (-0.69314718f / (float)TRANSMITTANCE_ONE);
    float e = fma(f, 1.0f / 720.0f, 1.0f / 120.0f);
    e = fma(f, e, 1.0f / 24.0f);
    e = fma(f, e, 1.0f / 6.0f);
    e = fma(f, e, 0.5f);
    e = fma(f, e, 1.0f);
    e = fma(f, e, 1.0f);
    return (int)(e * (float)TRANSMITTANCE_ONE + 0.5f) >> whole;
}

#endif
