// SPDX-License-Identifier: BSD-3-Clause
// The stability atlas: method x step x extreme, every cell decided by a stated criterion.
#pragma once

#include "core/study/extremes.hpp"
#include "core/study/journal.hpp"
#include "core/study/study.hpp"

namespace unfurl {

// The first that applies, in this order.
enum class Verdict {
  solver_failed,
  too_slow,
  constraint_lost,
  energy_growth,
  wrong_branch,
  inaccurate,
  right
};
std::string_view to_string(Verdict verdict);
std::span<const Verdict> verdicts();
std::string criterion(Verdict verdict);  // in words

struct StressLimits {
  double seconds = 3.0;      // a run that takes more CPU time is too slow
  double constraint = 1e-3;  // of a rod's length
  double energy = 0.05;      // of the energy turned over
  double branch = 0.1;       // position error, of the structure's size
  double right = 0.01;       // position error, of the structure's size
};

struct StressCell {
  std::string extreme;  // its name
  double value = 0;
  std::string setting;
  long steps = 0;  // over the motion
  Verdict verdict = Verdict::right;
  MeasuredRun run;
};

// Energy and constraints over very many steps.
struct LongRun {
  std::string setting;
  double step = 0;
  long steps = 0;   // done; fewer than asked for where the time was up or the solver failed
  std::string end;  // "done", "time is up", "solver failed", "constraints lost"
  std::vector<double> step_count, energy_error,
      constraint;  // samples: largest so far; relative to the energy turned over, to length
};

struct StressPlan {
  std::vector<Extreme> extremes;
  std::vector<Setting> settings;
  std::vector<long> steps;  // over the motion; about the scene's own, to a 32nd and to 4 times as many
  StressLimits limits;
  long long_steps = 0;  // 0: no long run
  SceneSource source;
};

// All extremes that the scene can be driven to, or those named. A long run of 10^6 steps where the scene does
// not deploy. Throws StudyError.
StressPlan plan_stress(const SceneSource& source, const std::vector<std::string>& names);

struct Stress {
  std::vector<StressCell> cells;
  std::vector<LongRun> long_runs;
  std::vector<std::string> notes;  // extremes that have no reference
  bool complete = true;
};

Stress run_stress(const StressPlan& plan, Journal& journal, const StudyHooks& hooks);

std::vector<std::string> stress_columns();
inline constexpr std::size_t stress_key_columns = 4;
std::vector<std::size_t> stress_number_columns();          // whose cells are numbers
bool is_stress_cell(const std::vector<std::string>& row);  // such as run_stress() leaves

Table cells_table(const Stress& stress);
Table summary_table(const StressPlan& plan, const Stress& stress);  // verdicts per setting

std::vector<LongRun> long_runs(const StressPlan& plan, const StudyHooks& hooks);

}  // namespace unfurl
