// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// A sheet of re-entrant units in the plane of x and z: `columns` units side by side, `rows` of them one above
// the other, each row half a unit aside of the one below. Chords of rods of length l run in zigzags along x,
// one more than there are rows; posts of length h join them. In zigzag j the nodes i = 0..2 columns stand at
//
//     x = (i - columns) l cos(theta),   z = j (h - l sin(theta)) + (i - j odd: l sin(theta)) - const
//
// with the fold angle theta; where i - j is even a post goes up to the next zigzag, into which it reaches.
// Units are re-entrant: pulled along x the sheet grows along z too, and with the pitches a = 2 l cos(theta),
// b = h - l sin(theta) Poisson's ratio is -(b'/b) / (a'/a) = -l cos^2(theta) / (sin(theta) (h - l
// sin(theta))) < 0.
//
// Posts stay parallel to z, and the nodes at one height of a zigzag stay at one height.
const std::vector<ParamSpec>& reentrant_sheet_params();
Structure build_reentrant_sheet(const ParamSet& params);

}  // namespace unfurl
