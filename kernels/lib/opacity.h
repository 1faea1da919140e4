// SPDX-License-Identifier: MIT
// Partial opacity for techniques that can only block or pass: of N light samples, a surface of opacity a
// blocks those whose rank in a fixed shuffle, keyed on (primitive, view), is below a N.
#ifndef LIB_OPACITY_H
#define LIB_OPACITY_H

/// Opacity in 1/4096 (upper 13 bits) and the primitive's hash (lower 19 bits).
inline uint opacityKey(float alpha, uint primitive) {
    uint h = primitive * 0x9e3779b1u;
    h = (h ^ (h >> 15)) * 0x85ebca77u;
    return (uint)(clamp(alpha, 0.0f, 1.0f) * 4096.0f + 0.5f) << 19 | (h & 0x7ffffu);
}

/// 1 if the surface blocks the view: a > (rank + 0.5) / N.
inline int opacityBlocks(uint key, int view, int views, int stride) {
    const uint rank = ((uint)view * (uint)stride + (key & 0x7ffffu)) % (uint)views;
    return (key >> 19) * 2u * (uint)views > (2u * rank + 1u) * 4096u;
}

#endif
