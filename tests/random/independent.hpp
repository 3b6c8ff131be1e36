// SPDX-License-Identifier: BSD-3-Clause
// The motion of a mechanism by formulas and a method that share nothing with core: Newton's equations with
// the constraints differentiated twice, dense, multipliers by an orthogonal decomposition, integrated by
// extrapolation of the modified midpoint rule (Gragg 1965; Hairer, Norsett & Wanner, Solving ODEs I, II.9) to
// round-off, states projected after each step. Slack, contact and rest are located in time, each side with
// its own smooth law.
#pragma once

#include <string>
#include <vector>

#include "tests/random/mechanism.hpp"

namespace unfurl::random {

struct Motion3 {
  double t = 0;
  Vector q, v;  // of all points [3 n]
};

struct IndependentRun {
  bool ok = false;
  std::string why;              // not ok: what keeps this solver from an answer
  std::vector<Motion3> states;  // at the times asked for
  int switches = 0;             // events located
};

struct IndependentOptions {
  double tolerance = 1e-12;  // of a step, relative to sizes of 1 m and 1 m/s
  double perturbation = 0;   // of the velocities at the start, for how errors grow [m/s]
};

IndependentRun solve_independently(const Mechanism& mechanism, const std::vector<double>& times,
                                   const IndependentOptions& options = {});

}  // namespace unfurl::random
