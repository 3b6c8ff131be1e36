// SPDX-License-Identifier: BSD-3-Clause
// Sines among what a structure prescribes over time.
#pragma once

#include <limits>
#include <string_view>

#include "core/structure/structure.hpp"

namespace unfurl {

struct PrescribedWave {
  std::string_view name;                                    // of the structure's constraint, stop or force
  double period = std::numeric_limits<double>::infinity();  // [s]
};

// The fastest that has begun at t; the period of none is infinite.
PrescribedWave fastest_wave(const Structure& structure, double t);

}  // namespace unfurl
