// SPDX-License-Identifier: MIT
// Where shadow tests start: the receiver moved off its surface along the geometric normal, in
// proportion to the magnitude of its coordinates, which is what float rounding grows with.
#ifndef LIB_SHADOW_ORIGIN_H
#define LIB_SHADOW_ORIGIN_H

inline float3 shadowOrigin(float3 position, float3 normal, float offset, float leastMagnitude) {
    const float magnitude =
        max(max(fabs(position.x), fabs(position.y)), max(fabs(position.z), leastMagnitude));
    return position + normal * (magnitude * offset);
}

#endif
