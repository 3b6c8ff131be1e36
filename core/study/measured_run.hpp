// SPDX-License-Identifier: BSD-3-Clause
// One run of a study: its errors against a reference, what it cost.
#pragma once

#include <limits>
#include <optional>

#include "core/simulate/simulation.hpp"
#include "core/study/reference.hpp"

namespace unfurl {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct MeasuredRun {
  // "ok", or in a word or two why there is no answer: "solver failed", "too slow", "not trusted"
  std::string outcome;
  std::string message = {};
  long steps = 0;
  double step = 0;            // [s]
  double position_error = 0;  // largest distance of a node from the reference at the comparison times [m]
  double constraint_max = 0;  // over all states and constraints [m]
  double constraint_relative_max = 0;  // relative to rod length
  double constraint_velocity_max = 0;  // [m/s]
  double energy_error = 0;        // largest magnitude of the energy balance, of all that goes in and out [J]
  double kinetic_energy_max = 0;  // [J]
  double energy_turned_over = 0;  // (accuracy.hpp) [J]
  double energy_round_off = 0;    // what the balance may be off by rounding alone [J]
  long newton_iterations = 0, factorisations = 0, linear_solves = 0;
  double cpu_median = 0, cpu_min = 0, cpu_max = 0;  // of the stepping loop [s]
  int repeats = 0;

  bool ok() const { return outcome == "ok"; }
};

struct TimingOptions {
  int repeats = 5;  // timed runs at most ...
  double patience =
      1.0;  // ... and no further one after so much CPU time in sum [s]; three at least below 3 times it
  double limit = 30.0;  // a run that takes longer is given up [s]
};

// Runs alone and one after another; the answers of repeated runs are equal, only their times differ. `end`
// and `steps` replace the options' own.
MeasuredRun measure_run(const std::shared_ptr<const Model>& model, SolverOptions options, long steps,
                        const Reference& reference, const TimingOptions& timing, const StudyHooks& hooks);

double deployment_time(const Simulation& run);  // of the event "deployed" [s]; NaN: there was none

// Whether measure_run() can have given it: an outcome that there is, no negative number and, of a run that is
// ok, none that is not finite.
bool is_possible(const MeasuredRun& run);

// Errors that a run shows about itself, written into `out`; where they are beyond what judge() trusts, a good
// outcome becomes "not trusted".
void measure_invariants(const Simulation& run, MeasuredRun& out);

// Largest distance of a node from the reference [m]; NaN where the run lacks a state at a comparison time.
double position_error(const Trajectory& trajectory, const Reference& reference);

}  // namespace unfurl
