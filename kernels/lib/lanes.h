// SPDX-License-Identifier: MIT
// LANES pixels, points or rays at once: 16 or 8 in a CPU's vector registers, 1 on a GPU, where each
// work-item is a lane. The same source gives the same bits at every width.
// Masks (VM) are integers: all bits of a lane set, or none.
#ifndef LIB_LANES_H
#define LIB_LANES_H

#ifndef LANES
#define LANES 1
#endif
#define LANES_JOIN_(a, b) a##b
#define LANES_JOIN(a, b) LANES_JOIN_(a, b)

#if LANES == 1
typedef float VF;
typedef int VI;
typedef uint VU;
#define V_LOAD(p, i) ((p)[i])
#define V_STORE(v, p, i) ((p)[i] = (v))
#define V_MASK(c) (-(int)(c))  // scalar comparisons give 0 or 1, vector ones 0 or -1
#define V_SELECT(no, yes, mask) ((mask) ? (yes) : (no))
#define V_ANY(mask) ((mask) != 0)
#define V_ALL(mask) ((mask) != 0)
#define V_INDEX (0)
#define V_LANE(v, i) (v)
#define V_GATHER_(T, p, i) ((T)((p)[i]))
#define V_GATHER_NEAR(T, p, i, offset) ((T)((p)[(i) + (offset)]))
#define V_AS_UINT as_uint
#define V_AS_INT as_int
#define V_AS_FLOAT as_float
#define V_TO_INT convert_int
#define V_TO_FLOAT convert_float
#define V_LOAD_HALF(p, i) vload_half(i, p)
#else
typedef LANES_JOIN(float, LANES) VF;
typedef LANES_JOIN(int, LANES) VI;
typedef LANES_JOIN(uint, LANES) VU;
#define V_LOAD(p, i) LANES_JOIN(vload, LANES)(0, (p) + (i))
#define V_STORE(v, p, i) LANES_JOIN(vstore, LANES)(v, 0, (p) + (i))
#define V_MASK(c) (c)
#define V_SELECT(no, yes, mask) select((no), (yes), (mask))
// any() and all() branch from lane to lane in some compilers
#define V_ANY(mask) (lanesOr(mask) != 0)
#define V_ALL(mask) (lanesOr(~(mask)) == 0)
#define V_AS_UINT LANES_JOIN(as_uint, LANES)
#define V_AS_INT LANES_JOIN(as_int, LANES)
#define V_AS_FLOAT LANES_JOIN(as_float, LANES)
#define V_TO_INT LANES_JOIN(convert_int, LANES)
#define V_TO_FLOAT LANES_JOIN(convert_float, LANES)
#define V_LOAD_HALF(p, i) LANES_JOIN(vload_half, LANES)(0, (p) + (i))
#if LANES == 8
inline ulong lanesOr(VI mask) {
    const ulong4 w = as_ulong4(mask);
    const ulong2 half_ = w.lo | w.hi;
    return half_.x | half_.y;
}
// Gathers at i + offset: several offsets from the same i share the work of taking its lanes apart
#define V_GATHER_NEAR(T, p, i, offset)                                                                         \
    (T)((p)[(i).s0 + (offset)], (p)[(i).s1 + (offset)], (p)[(i).s2 + (offset)], (p)[(i).s3 + (offset)],        \
        (p)[(i).s4 + (offset)], (p)[(i).s5 + (offset)], (p)[(i).s6 + (offset)], (p)[(i).s7 + (offset)])
#define V_INDEX ((VI)(0, 1, 2, 3, 4, 5, 6, 7))
#define V_GATHER_(T, p, i) \
    (T)((p)[(i).s0], (p)[(i).s1], (p)[(i).s2], (p)[(i).s3], (p)[(i).s4], (p)[(i).s5], (p)[(i).s6], (p)[(i).s7])
#else
inline ulong lanesOr(VI mask) {
    const ulong8 w = as_ulong8(mask);
    const ulong4 half_ = w.lo | w.hi;
    const ulong2 quarter = half_.lo | half_.hi;
    return quarter.x | quarter.y;
}
#define V_GATHER_NEAR(T, p, i, offset)                                                                         \
    (T)((p)[(i).s0 + (offset)], (p)[(i).s1 + (offset)], (p)[(i).s2 + (offset)], (p)[(i).s3 + (offset)],        \
        (p)[(i).s4 + (offset)], (p)[(i).s5 + (offset)], (p)[(i).s6 + (offset)], (p)[(i).s7 + (offset)],        \
        (p)[(i).s8 + (offset)], (p)[(i).s9 + (offset)], (p)[(i).sa + (offset)], (p)[(i).sb + (offset)],        \
        (p)[(i).sc + (offset)], (p)[(i).sd + (offset)], (p)[(i).se + (offset)], (p)[(i).sf + (offset)])
#define V_INDEX ((VI)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#define V_GATHER_(T, p, i)                                                                          \
    (T)((p)[(i).s0], (p)[(i).s1], (p)[(i).s2], (p)[(i).s3], (p)[(i).s4], (p)[(i).s5], (p)[(i).s6],  \
        (p)[(i).s7], (p)[(i).s8], (p)[(i).s9], (p)[(i).sa], (p)[(i).sb], (p)[(i).sc], (p)[(i).sd],  \
        (p)[(i).se], (p)[(i).sf])
#endif
#endif

#endif
