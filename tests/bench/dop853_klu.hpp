// SPDX-License-Identifier: BSD-3-Clause
// The rival to name: DOP853, adaptive, on the index-1 equations in whatever coordinates a system is solved
// in, with independent constraint rows and KLU for the linear systems.
#pragma once

#include <memory>

#include "core/integrators/integrator.hpp"

namespace unfurl::bench {

// step(state, h) goes on by h in steps of its own, chosen for this tolerance, relative and absolute [m],
// [m/s]; it fails where they become too small. Rows are picked at the pose q (node coordinates). pivoting:
// numerical pivots anew in every factorisation, for poses in which those of another are none.
std::unique_ptr<Integrator> make_dop853_klu(const System& system, const ConstVec& q, double tolerance,
                                            bool pivoting);

}  // namespace unfurl::bench
