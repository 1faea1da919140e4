// SPDX-License-Identifier: MIT
// Atomic maximum that looks first: most fragments lose, and a read is far cheaper than an atomic.
// The plain read races benignly with the atomics; under a race checker it is left out.
#ifndef LIB_ATOMICS_H
#define LIB_ATOMICS_H

#ifdef RACE_CHECKED
#define ATOMIC_MAX_EARLY(pointer, value) atomic_max(pointer, value);
#else
#define ATOMIC_MAX_EARLY(pointer, value) \
    if (*(pointer) < (value)) atomic_max(pointer, value);
#endif

#endif
