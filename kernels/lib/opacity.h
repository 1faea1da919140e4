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

/// 1 if the surface blocks the view: a > (rank + 0.5) / N. Each surface has a step of its own: with one for all, what
/// a stack of surfaces blocks would be arcs of one circle, and what it lets through not the product, however many
/// the samples.
inline int opacityBlocks(uint key, int view, int views, int stride) {
    const uint offset = key & 0x7ffffu, step = offset * 0x9e3779b1u >> 8 | 1u, shift = offset * 0x85ebca77u >> 13;
    uint rank = ((uint)view * (uint)stride + offset) % (uint)views;
    // A permutation of the power of two that holds all ranks, walked until it comes back among them: one of the ranks
    const uint mask = 0xffffffffu >> clz(((uint)views - 1u) | 1u);
    do rank = (rank + shift) * step & mask;
    while (rank >= (uint)views);
    return (key >> 19) * 2u * (uint)views > (2u * rank + 1u) * 4096u;
}

#endif
