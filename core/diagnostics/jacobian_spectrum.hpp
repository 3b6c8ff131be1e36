// SPDX-License-Identifier: BSD-3-Clause
// How far the poses of a run are from singular ones, in which a structure gains ways to move.
#pragma once

#include <vector>

#include "core/simulate/simulation.hpp"

namespace unfurl {

// The smallest singular values of the Jacobian of all constraints, its rows scaled to length 1, at some of
// the states of a run. `rank` is the largest one on the way; redundant constraints leave the singular values
// behind it at zero everywhere and are not listed.
struct JacobianSpectrum {
  std::vector<double> t;  // [s]
  Index constraints = 0, coordinates = 0, rank = 0;
  std::vector<double> largest;                // the largest singular value at each time
  std::vector<std::vector<double>> smallest;  // [k][i]: number rank - k at time i; 0 where it is round-off
};

// Dense decompositions cost a cube of the size: for Jacobians of at most so many rows and columns.
inline constexpr Index max_spectrum_size = 400;
bool spectrum_applies(const Simulation& run);

// `count`: how many of the smallest ones, as far as the rank goes. At every state of short runs of small
// structures, else at evenly counted ones, the last always among them, so that it takes about a second.
JacobianSpectrum jacobian_spectrum(const Simulation& run, int count = 3);

}  // namespace unfurl
