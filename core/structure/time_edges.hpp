// SPDX-License-Identifier: BSD-3-Clause
// Times at which what a structure prescribes over time is not smooth.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/structure/structure.hpp"

namespace unfurl {

struct TimeEdge {
  double t = 0.0;  // [s]
  // A prescribed velocity jumps, an impact of the drive, or its acceleration does, or a force, as a motor's
  // whose command is a rate: steps that end there must not see what is behind. Otherwise something bends.
  bool jump = false;
  bool impact = false;  // of these, a prescribed velocity or acceleration jumps
  bool smooth = false;  // nothing does: what is led to the deployed pose turns round in it
};

// The time of a state before a jump at t: so little earlier that the sum of a step and its start does not
// round to t. States nearer to each other than that are before and after an impulse.
inline constexpr double jump_width = 4 * std::numeric_limits<double>::epsilon();
inline double before_jump(double t) {
  return t - jump_width * std::abs(t);
}
inline bool same_instant(double before, double after) {
  return after - before <= 2 * jump_width * std::abs(after);
}

// The times that no step may straddle, ascending, each once: a step of any method takes what it integrates
// for a polynomial, and over a bend of a force or of an acceleration it is of order 2, whatever it claims.
//
//   load, linear     every point where the line bends: the force is continuous, its slope is not; where a
//                    time stands twice it jumps
//   drive, rate      start: the velocity jumps (no ramp); otherwise start and start + ramp, where f''' jumps
//                    and with it the slope of the forces that inertia takes
//   drive, sine      as for a rate; without a ramp the velocity jumps at the start, or the acceleration where
//                    it begins at rest (a phase of a quarter turn). Besides, where it turns round in the
//                    deployed pose
//   drive, smooth    start and start + duration, for the same reason; shorter than two steps, three times
//                    between them too
//   drive, spline    the ends, where the acceleration jumps; of the points between, where f''' jumps, those
//                    with both neighbours at least a `step` away. Points that lie closer sample a motion
//                    finer than steps do: f''' jumps by f'''' times their distance there, which is the
//                    spline's own error in the motion that it was sampled from, and a table of thousands of
//                    points would shatter the grid for it. Of these only those at which it jumps much more
//                    than at most others (a spike, a corner), lest a step pass over them.
std::vector<TimeEdge> time_edges(const Structure& structure, double step);
// Of these, those of what constraints prescribe: where no force begins or ends.
std::vector<TimeEdge> prescribed_edges(const Structure& structure, double step);

// A structure for which what it prescribes at t, and until the next edge, is so at all times.
Structure pieces_at(Structure structure, double t);

// The first of them behind a time.
inline std::vector<TimeEdge>::const_iterator edge_after(const std::vector<TimeEdge>& edges, double t) {
  return std::upper_bound(edges.begin(), edges.end(), t,
                          [](double time, const TimeEdge& edge) { return time < edge.t; });
}

}  // namespace unfurl
