// SPDX-License-Identifier: BSD-3-Clause
// A number that a scene prescribes over time: the value of a drive, the size of a load.
#pragma once

#include <string>
#include <vector>

namespace unfurl {

// f(t) with two derivatives.
//   constant  f = offset
//   rate      f' rises from 0 to `rate` within `ramp` s (a cubic, f'' continuous inside), then stays
//   smooth    from offset to offset + rise between start and start + duration: 10 u^3 - 15 u^4 + 6 u^5, twice
//             continuously differentiable
//   spline    clamped cubic spline through the points (times, values): at rest at its ends, held beyond
//             them, twice continuously differentiable between them
//   sine      waves of `duration` s from `start` on, rate / w sin(w s) + rise sin^2(w s / 2) with s the time
//             since then and w = 2 pi / duration: `rate` is that at the start, `rise` that after half a wave.
//             They grow to that size within `ramp` s, as 10 u^3 - 15 u^4 + 6 u^5: twice continuously
//             differentiable
//   linear    straight lines through the points, held beyond its ends; a time that stands twice is a jump, f
//             there is that behind it. For loads; not for drives, whose velocity must not jump
//   piece     sum of values[k] (t - start)^k, at all times: one of the others from edge to edge
//   wave      that sum times the waves of a sine, at all times: a sine from edge to edge
struct TimeFunction {
  enum class Kind { constant, rate, smooth, spline, linear, piece, sine, wave };

  Kind kind = Kind::constant;
  double offset = 0.0;
  double rate = 0.0;  // [1/s]
  double ramp = 0.0;  // [s]
  double rise = 0.0;
  double start = 0.0;     // [s]: rate, smooth, sine
  double duration = 1.0;  // [s]
  std::vector<double> times, values;
  std::vector<double> bends;  // f'' at the times; spline only, filled by make_spline

  double operator()(double t) const { return derivative(0, t); }
  double derivative(int order, double t) const;  // order 0, 1, 2
  // What it is at t and until something of it ends, as if that had been and were to be so at all times.
  TimeFunction piece_at(double t) const;
  bool moves() const { return kind != Kind::constant; }
  bool operator==(const TimeFunction&) const = default;
};

// Two points of a linear function nearer than this to each other become a jump between them, where the
// integral over both and their neighbours stays what it was; a ramp of a rate or a sine as short is none, and
// what begins within a hundredth of that begins at t = 0. False where that is nowhere and a neighbour is as
// near as makes it matter, or where three points are that near.
bool make_jumps(TimeFunction& f, double near);

// When a sine that has grown to its size turns round, from one time to another.
std::vector<double> turning_times(const TimeFunction& sine, double from, double to);

// times ascending, at least two; as many values.
TimeFunction make_spline(std::vector<double> times, std::vector<double> values);

}  // namespace unfurl
