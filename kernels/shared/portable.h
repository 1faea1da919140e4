// SPDX-License-Identifier: MIT
// Types and checks for headers that are compiled as C++ (host) and as OpenCL C (device).
// Rules for a shared struct: fields of int, uint, float, float4 or another shared struct; no float3
// (16 bytes on the device, 12 on the host), bool, size_t or pointer; end it with SHARED_STRUCT.
#ifndef SHARED_PORTABLE_H
#define SHARED_PORTABLE_H

#ifdef __OPENCL_VERSION__
#pragma OPENCL FP_CONTRACT OFF  // the same bits on every device; fma() is written where it is meant
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_STRUCT(T, bytes) typedef char T##_has_##bytes##_bytes[sizeof(T) == (bytes) ? 1 : -1];
#else
#include <cstdint>
#define SHARED_BEGIN namespace penumbra::shared {
#define SHARED_END }
SHARED_BEGIN
using uint = std::uint32_t;
struct alignas(16) float4 {
    float x, y, z, w;
};
inline const char* deviceType(const float4*) {
    return "float4";
}
SHARED_END
/// Fixes the size of T in both languages and tells runtime::Kernel the name of T on the device.
#define SHARED_STRUCT(T, bytes)                                                     \
    static_assert(sizeof(T) == (bytes), #T " is not of the size that kernels see"); \
    inline const char* deviceType(const T*) {                                       \
        return #T;                                                                  \
    }
#endif

SHARED_BEGIN

/// Rows of an affine map: target = (dot(row[i].xyz, source) + row[i].w), i = 0..2.
typedef struct {
    float4 row[3];
} Affine;
SHARED_STRUCT(Affine, 48)

SHARED_END
#endif
