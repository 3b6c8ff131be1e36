// SPDX-License-Identifier: BSD-3-Clause
// The example of Kong, Ma, Xue and Ding, "Dynamic simulation of deployable structures based on discrete
// variational method" (2023), section 4, run again, and what its tables leave out.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/study/measured_run.hpp"
#include "core/study/order_fit.hpp"
#include "core/study/report.hpp"

namespace unfurl {

// What the paper prints in Tables 1 and 2, for one step.
struct PrintedResults {
  double step;                                  // [s]
  double variational_cpu, runge_kutta_cpu;      // [s]
  double variational_error, runge_kutta_error;  // largest constraint error
};
inline constexpr std::array printed_results{
    PrintedResults{0.01, 52.3906, 22.5313, 2.2737e-13, 2.6980e-7},
    PrintedResults{0.005, 108.25, 43.5781, 4.7368e-11, 1.6918e-8},
};
inline constexpr double printed_deployment_time = 4.92;  // [s]

struct ReproducedRun {
  MeasuredRun measured;
  std::vector<double> t, constraint_error,
      position_error;  // over time [s, m, m]; the latter at comparison times
  std::vector<double> comparison_t;
};

// A scheme at each of the reproduced steps.
struct ReproducedScheme {
  std::string name, what;
  SolverOptions options;
  std::vector<ReproducedRun> runs;  // as reproduced_steps
  ObservedOrder order;              // of the position error
  double deployment_time = 0;       // at h = 0.01 s; NaN: it did not deploy [s]
};
inline constexpr std::array reproduced_steps{0.02, 0.01, 0.005, 0.0025};
inline constexpr std::size_t paper_step = 1;    // index of the paper's 0.01 s, which 0.005 s follows
inline constexpr double comparison_step = 0.1;  // every step divides it [s]

struct Check {
  std::string claim, found;
  bool holds = false;
};

struct Reproduction {
  std::vector<ReproducedScheme> schemes;     // as printed, rk4, constraints at nodes with s = 3 and s = 4
  std::shared_ptr<const Simulation> motion;  // to the deployed pose, for the poses
  double end = 4.9;                          // errors are taken up to here [s]
  std::string reference;
  double reference_uncertainty = 0;  // [m]
  std::vector<Check> checks;
  bool verified() const;
};

// Throws Cancelled, ReferenceError, UnreadableScene.
Reproduction reproduce_paper(const StudyHooks& hooks);

Table reproduced_table(const Reproduction& r,
                       std::size_t step);       // of printed_results: paper and ours side by side
Table trajectory_table(const Reproduction& r);  // position errors and orders
Table runs_table(const Reproduction& r);        // every run, exact numbers

}  // namespace unfurl
