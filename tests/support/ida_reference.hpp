// SPDX-License-Identifier: BSD-3-Clause
// An independent solver of the same equations: SUNDIALS IDA (variable-step BDF) on the stabilised index-2
// form of Gear, Leimkuhler & Gupta (1985),
//
//     M z' = M w - G^T mu,   M w' = F - G^T lambda,   Phi(z) = 0,   G w = 0
//
// with independent rows of G only, picked at the start. For tests and benches, where libsundials-dev is
// present.
#pragma once

#include <string>
#include <vector>

#include "core/system/state.hpp"
#include "core/system/system.hpp"

namespace unfurl::testing {

struct IdaOptions {
  double relative_tolerance = 1e-8;
  double absolute_tolerance = 1e-10;  // [m], [m/s]
  long max_steps = 1000000;           // between two output times
};

struct IdaRun {
  bool ok = false;
  std::string message;        // why it stopped early
  std::vector<State> states;  // at the times asked for, as far as it came; multipliers of dropped rows are 0
  long steps = 0, residuals = 0, jacobians = 0;
  double cpu_s = 0;  // of the stepping, set-up excluded
};

// `times` ascending, after start.t.
IdaRun solve_with_ida(const System& system, const State& start, const std::vector<double>& times,
                      const IdaOptions& options = {});

}  // namespace unfurl::testing
