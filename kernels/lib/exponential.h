// SPDX-License-Identifier: MIT
// e^x by our own polynomial: drivers' versions differ between scalar and vector forms.
#ifndef LIB_EXPONENTIAL_H
#define LIB_EXPONENTIAL_H
#include "lib/lanes.h"

/// e^x for |x| <= 87; relative error < 3e-7, beyond that the error of the argument's own rounding.
inline VF exponential(VF x) {
    x = clamp(x, (VF)-87.0f, (VF)87.0f);
    const VF whole = floor(fma(x, (VF)1.44269504f, (VF)0.5f));
    // x - whole ln 2, ln 2 in two parts
    const VF f = fma(whole, (VF)-1.42860677e-6f, fma(whole, (VF)-0.693145752f, x));
    VF e = fma(f, (VF)(1.0f / 5040.0f), (VF)(1.0f / 720.0f));
    e = fma(f, e, (VF)(1.0f / 120.0f));
    e = fma(f, e, (VF)(1.0f / 24.0f));
    e = fma(f, e, (VF)(1.0f / 6.0f));
    e = fma(f, e, (VF)0.5f);
    e = fma(f, e, (VF)1.0f);
    e = fma(f, e, (VF)1.0f);
    return e * V_AS_FLOAT((V_TO_INT(whole) + 127) << 23);
}

#endif
