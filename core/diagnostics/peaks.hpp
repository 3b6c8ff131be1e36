// SPDX-License-Identifier: BSD-3-Clause
// The largest value of something over a motion, which is seldom at the end of a step.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// One value per state of a run: a function of the state alone, not of what went before.
using StateValues = std::function<std::vector<double>(const Simulation&)>;

// The largest value over the motion. `at_states`: the values at the run's own states, NaN where there is
// none. Around the largest of them and others that may top it `values` is asked at a few times within the
// steps, closer and closer: of the quintic through positions, velocities and accelerations, or of the run's
// dense output where that is not good enough. Steps from a singular pose, or in which the motion changes too
// fast for these, have only their ends. `also`: states around which is looked, whatever their values are. NaN
// where all values are.
PeakInMotion top_of_motion(const Simulation& run, const std::vector<double>& at_states,
                           const StateValues& values, const std::vector<std::size_t>& also = {});
double largest_in_motion(const Simulation& run, const std::vector<double>& at_states,
                         const StateValues& values);

// Of what was looked for and what a digest has found before: the larger, or smaller.
PeakInMotion beyond(const Diagnostics& diagnostics, std::string_view column, bool largest, PeakInMotion seen);

// Largest and smallest value of a column of series.csv over the motion. Columns that are sums over the run's
// steps (energies that went in or out, errors, counts) are taken at the states, but for NAME.energy_J of
// drives (energy_tops.hpp).
double largest_of_column(const Simulation& run, const Diagnostics& diagnostics, std::string_view column);
double smallest_of_column(const Simulation& run, const Diagnostics& diagnostics, std::string_view column);
PeakInMotion extreme_of_column(const Simulation& run, const Diagnostics& diagnostics, std::string_view column,
                               bool largest);
// The larger magnitude of both.
double peak_of_column(const Simulation& run, const Diagnostics& diagnostics, std::string_view column);

// Axial forces of the rods of the solved structure at a time within a step [N], as peaks see the motion
// there; none where no step is around it.
VectorXd rod_forces_within_step(const Simulation& run, double t);

class MotionSamples;

// While one of these lives, looking into the motion of a run for this thread's largest and smallest values
// ends with LookedEnough as soon as `enough` says so.
struct LookedEnough {};
class LooksUntil {
 public:
  explicit LooksUntil(bool (*enough)());
  ~LooksUntil();
  LooksUntil(const LooksUntil&) = delete;
  LooksUntil& operator=(const LooksUntil&) = delete;
};

// While one of these lives, largest and smallest values that this thread has found are not looked for again:
// several measures of a run, which stays as it is meanwhile, begin with the same ones. One within another
// shares what that has found.
class RememberedExtremes {
 public:
  RememberedExtremes();
  ~RememberedExtremes();
  RememberedExtremes(const RememberedExtremes&) = delete;
  RememberedExtremes& operator=(const RememberedExtremes&) = delete;

 private:
  bool outermost_;
  std::map<std::tuple<const Diagnostics*, std::string, bool>, PeakInMotion> found_;
  std::unique_ptr<MotionSamples> samples_;  // of the outermost
  friend MotionSamples* remembered_samples();
  friend PeakInMotion extreme_of_column(const Simulation& run, const Diagnostics& diagnostics,
                                        std::string_view column, bool largest);
};

}  // namespace unfurl
