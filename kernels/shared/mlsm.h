// SPDX-License-Identifier: MIT
// Filtered multi-layer shadow maps [MLSM]: what is kept of casters, seen from the light's centre.
//   lists      uint [list, MLSM_LIST]  of all levels, level by level, rows from the top: first fragment, one past the
//              last, float bits of the nearest depth that went into the list (0: empty)
//   fragments  float [fragment, MLSM_VALUES]  those of a list follow one another from the light outwards:
//              depth near / z, coverage and, where anything is coloured, what it takes of red, green and blue;
//              coverage and colours may exceed 1 where surfaces were added up
#ifndef SHARED_MLSM_H
#define SHARED_MLSM_H
#include "shared/portable.h"
SHARED_BEGIN

#define MLSM_LIST 3
#define MLSM_MAX_LEVELS 14
#define MLSM_MAX_PARTS 8  // squares that a long light is cut into

// Floats of a fragment with 1 or 3 channels
#define MLSM_VALUES(channels) ((channels) == 1 ? 2 : 5)

// Accumulation
#define MLSM_ADD 0
#define MLSM_MULTIPLY 1
#define MLSM_MAX 2
#define MLSM_COVER 3  // adds until all is covered; what covers more lies behind and multiplies

#define MLSM_WEIGHT 65535  // of a receiver's visibility, as an integer

typedef struct {
    int resolution;    ///< texels, of the base level
    int channels;      ///< 1, or 3: anything is blended
    uint capacity;     ///< fragments of all levels that the buffer holds
    int layers;        ///< of each list of the base level: the first ones are kept; 0: all
    int levels;        ///< of lists
    int join;          ///< 1: fragments of a list within epsilon are joined at the base level
    float epsilon;     ///< base level: share of the depth below which fragments are joined; doubles each level
    int accumulate;    ///< MLSM_*: within a list, as lists are merged
    int firstList[MLSM_MAX_LEVELS];
    int size[MLSM_MAX_LEVELS];       ///< lists along each side
    float spacing[MLSM_MAX_LEVELS];  ///< base texels between lists
    float origin[MLSM_MAX_LEVELS];   ///< base texels: centre of the first list
    float width[MLSM_MAX_LEVELS];    ///< base texels: of the filter that the level stands for
    int unused[2];
} MlsmParams;
SHARED_STRUCT(MlsmParams, 320)

/// How a level is made of the one below: list (x, y) of lists (scale x + tap, scale y + tap), tap 0 and 1.
typedef struct {
    int level;
    int scale;
    int tap0, tap1;
    int subsample;  ///< 1: refers to one of the four lists instead of merging them
    int unused[3];
} MlsmFilterParams;
SHARED_STRUCT(MlsmFilterParams, 32)

typedef struct {
    float reach;        ///< filter size per unit of depth between occluder and receiver, base texels
    float stepX, stepY; ///< from a part of the light to the next, in units of the filter size
    int parts;          ///< squares that the light is cut into
    int accumulate;     ///< MLSM_ADD or MLSM_MULTIPLY
    int antialias;      ///< filters of the first so many receivers are at least as wide as their pixels
    int receiverWidth;  ///< receivers in a row
    float pixelStep;    ///< pixels between receivers
} MlsmLookupParams;
SHARED_STRUCT(MlsmLookupParams, 32)

SHARED_END
#endif
