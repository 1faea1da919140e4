// SPDX-License-Identifier: MIT
// Where a light sees casters: a grid over its central view, twice as wide as a depth map.
//   cells  uint [OCCUPANCY_SIDE + 1, OCCUPANCY_SIDE + 1]  first 1 where a caster may lie at (row + 1, column + 1),
//          then sums over all cells above and to the left (a summed-area table, row and column 0 empty)
#ifndef SHARED_OCCUPANCY_H
#define SHARED_OCCUPANCY_H
#include "shared/portable.h"
SHARED_BEGIN

#define OCCUPANCY_SIDE 256
#define OCCUPANCY_ROW (OCCUPANCY_SIDE + 1)

typedef struct {
    uint highestW;  ///< float bits: the largest near / z of all casters
    uint unused[3];
} OccupancyRange;
SHARED_STRUCT(OccupancyRange, 16)

SHARED_END
#endif
