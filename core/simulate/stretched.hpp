// SPDX-License-Identifier: BSD-3-Clause
// The quasi-static rung between rigid and elastic rods: no waves.
#pragma once

#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Adds to the shown positions of a run of rigid rods what its forces stretch them by. With the multipliers
// lambda of least complementary energy and the compliances C of the rods' rows,
//
//     G u = C lambda,     u of least kinetic metric u^T M u
//
// which is no motion of the mechanism. Of first order in C; forces and motion stay those of the rigid run.
// Poses at which the rank falls take the displacement of the state before, u being infinite there.
// Next to such a pose the weakest direction makes of the states' round-off as much as it makes of C lambda:
// what is not smooth there is the polynomial through the states on either side that are not in doubt, or the
// nearest where they are on one side only, as far as round-off explains that u differs from it. Where u is no
// small displacement, as next to such poses, nothing is added (accuracy_warnings() says so).
void add_stretch(Trajectory& trajectory);

}  // namespace unfurl
