// SPDX-License-Identifier: BSD-3-Clause
// Why a motion does not go on where no step, however small, gets through. Structures of more than 300
// coordinates are left out.
#pragma once

#include <string>

#include "core/system/system.hpp"

namespace unfurl {

// Unit rows of G that depend on each other but for this share, the largest that is neither round-off nor a
// distance that was meant: positions were given to so many digits. 0: there is none. Of positions that a
// scene gives: those of a family have all digits, and are next to singular poses only where they are asked to
// be.
double misfit_of_rows(const System& system, const ConstVec& q);

// What a run with such rows is told of at its start; empty where they are well within round-off.
std::string misfit_warning(const System& system, const ConstVec& q);

// "the drive act asks for 2.03 m at t = 0.48 s, ...": where the constraints have no pose soon after the time
// t unless a drive is left out, or where the step leads to the last pose that they have. h: the step that
// failed [s].
std::string beyond_reach(const System& system, double t, double h, const ConstVec& q);

// Names of constraints that hold each other in the pose q so that what looks free to first order is not to
// second: rods in line between two held nodes. Empty: there are none.
std::string held_at_second_order(const System& system, const ConstVec& q);

// No motion goes on from q with the velocities v, though they fit the constraints to first order: two
// branches meet there, and v is of neither.
bool of_no_branch(const System& system, const ConstVec& q, const ConstVec& v);

}  // namespace unfurl
