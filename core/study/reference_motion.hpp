// SPDX-License-Identifier: BSD-3-Clause
// A reference for a run as it stands: its steps need not meet any comparison times.
#pragma once

#include "core/simulate/simulation.hpp"
#include "core/study/reference.hpp"

namespace unfurl {

// How far a run can be judged by a reference, which is one smooth motion: to its end or, where it comes to a
// singular deployed pose, an end stop or another change of what acts on one side only before, to 99.5 % of
// that time.
struct JudgedSpan {
  double end = 0;  // [s]
  // "the deployed pose", "the first end stop", "the first time that rope pulls"; empty: it is all of the
  // motion
  std::string before = {};
};
JudgedSpan judged_span(const Simulation& run);

// What is held, taut, sticks or slips from the start: the equations without modes, those of solve_reference,
// have none of it. Empty: nothing.
std::string one_sided_at_start(const Simulation& run);
// Throws ReferenceError where solve_reference would solve another motion from the start.
void require_plain_start(const Simulation& run);

// States of a motion, close enough to tell it at any time: by Hermite interpolation of degree 15 through
// positions and velocities of the eight states around that.
class ReferenceMotion {
 public:
  // Of a run without impacts; throws ReferenceError where it has fewer than 16 states.
  explicit ReferenceMotion(const Trajectory& trajectory);

  double end() const { return t_.back(); }
  VectorXd positions(double t) const;  // node coordinates [3 n], t in [0, end]
  std::size_t bytes() const;
  // How well the motion is known, interpolation included: the largest distance of a node from those of a
  // solution with larger steps, at this one's states and half-way between that one's [m].
  double uncertainty() const { return uncertainty_; }
  double compare(const ReferenceMotion& coarser);  // sets that and returns it
  void widen(double uncertainty);                  // to that at least; the first there is, at first

 private:
  std::vector<double> t_;        // [s]
  std::vector<VectorXd> q_, v_;  // of nodes [3 n]
  double uncertainty_ = std::numeric_limits<double>::infinity();
};

// The reference of the motion of a model that `run` is of, whatever settings that had: dvm with 8 and with 7
// nodes in turn, with steps that follow the motion, halved until two solutions agree to round-off or come no
// closer. That shares the principle of dvm's own rows, but neither order nor steps; it costs a hundredth of
// solve_reference, with which it agrees (a test). `cpu_s`: not much more CPU time than that is spent. Throws
// ReferenceError, Cancelled.
ReferenceMotion solve_reference_motion(const std::shared_ptr<const Model>& model, const Simulation& run,
                                       double cpu_s, const StudyHooks& hooks);

// Largest distance of a node from the reference at the run's own times [m]. NaN where the run failed or was
// stopped before the reference's end.
double position_error(const Simulation& run, const ReferenceMotion& reference);

}  // namespace unfurl
