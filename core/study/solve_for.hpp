// SPDX-License-Identifier: BSD-3-Clause
// One parameter of a scene, so that a run gives what is wanted.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/study/reference.hpp"

namespace unfurl {

// f(x); NaN where x is no valid parameter or the run failed; may be infinite ("not within the run").
using Objective = std::function<double(double x)>;

struct SolveOptions {
  double start = 0;            // where the search begins
  double low = 0, high = 0;    // --between; equal: not given, the search looks around `start`
  double x_tolerance = 1e-12;  // relative
  int most = 200;              // evaluations
  // Looking around, a side is given up where its evaluations took so long and the last one so many times the
  // first: towards a step of zero runs grow without end.
  double patience_s = 10, patience_of_first = 30;         // [s], times
  std::function<double()> clock = nullptr;                // [s]; by default the CPU time of this thread
  std::function<std::string(double)> why_none = nullptr;  // why there is no value at x; empty: unknown
};

struct Evaluation {
  double x = 0, value = 0;  // f(x) - target is what has a root
};

struct Solved {
  double x = 0, value = 0;
  double low = 0, high = 0;  // the last bracket
  std::vector<Evaluation> evaluations;
};

// The parameter could not be found; what() says what was tried.
struct NotFound : Error {
  using Error::Error;
};

// A root of f - target by bracketing: from `start` outwards, steps doubled, halved again where x becomes
// invalid, until the sign changes, with a closer look where values come nearer and go again; then regula
// falsi with bisection as safeguard (ITP-like: never slower than bisection by more than a factor of two), on
// the side of the root where x is invalid between the ends.
// An extremum on the target, to rounding, is met, too. Throws NotFound, Cancelled.
Solved solve_for(const Objective& f, double target, const SolveOptions& options, const StudyHooks& hooks);

}  // namespace unfurl
