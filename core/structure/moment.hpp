// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace unfurl {

// When forces and constraints are asked for, with what is known of that time beside pose and velocities; near
// which values angles that count their turns are taken: those of a state, carried on with its rates, so that
// a step may turn by any angle that its acceleration does not change by half a turn.
struct Moment {
  Moment(double time) : t(time) {}  // NOLINT: a time alone is a moment of a structure that follows no angle
  double t;                         // [s]
  double since = 0.0;               // the time of the state [s]
  // Of each followed angle (measure.hpp) [rad], [rad/s]; nullptr: as at t = 0.
  const double* angles = nullptr;
  const double* rates = nullptr;
  // What rods that give pull with, in their order; nullptr: their lengths tell [N].
  const double* tension = nullptr;

  double near(int followed, double otherwise) const {
    if (followed < 0 || !angles) return otherwise;
    return angles[followed] + (t - since) * rates[followed];
  }
};

}  // namespace unfurl
