// SPDX-License-Identifier: BSD-3-Clause
// What acts on one side only: end stops, which push or are out of touch, and cables, which pull or are slack.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/integrators/index1.hpp"
#include "core/integrators/solver_options.hpp"
#include "core/simulate/crossing.hpp"
#include "core/simulate/stops.hpp"

namespace unfurl {

// Each of them is at any time in one of two modes, and in either the motion is smooth:
//
//     stop    out of touch (gap > 0)           margin: the gap
//             held: a constraint at its limit  margin: the force with which it pushes
//     cable   slack: no force                  margin: -min(s - rest, n / (k + c / h))
//             pulls: a spring on both sides    margin: min(s - rest, n / (k + c / h)),  n = k (s - rest) + c
//             s'
//
// A margin that falls below zero ends the mode. Margins come in units of what counts as zero: 1e-11 of the
// structure's length, or a part of the largest multiplier. A cable with damping c pulls with n where it is
// both stretched and n > 0, so that it never pushes.
class OneSided {
 public:
  OneSided(const Structure& structure, const SolverOptions& options);

  bool empty() const { return active_.empty(); }
  std::size_t size() const { return active_.size(); }  // stops first, then cables
  bool is_stop(std::size_t i) const { return i < stops_.size(); }
  bool active(std::size_t i) const { return active_[i]; }  // a held stop, a cable that pulls
  bool any_active() const;
  bool any_held() const;
  const Stops& stops() const { return stops_; }
  // "leaves stop NAME", "NAME pulls", ...: that the mode has begun.
  std::string text(std::size_t i) const;

  void set_active(std::size_t i, bool active) { active_[i] = active; }
  // A stop that is passed by less than rounding or by what a start left of it counts as touched there.
  void touch(const System& system, const State& state);
  // Cables that are stretched and pull.
  void find_modes(const System& system, const State& state);
  // All cables by the law that knows both of their modes; whether any was not.
  bool relax_cables();

  // Margins and their rates (NaN: not known) of a state of `model`, which must be that of the present modes.
  // Without `forces`, those of held stops are left NaN, which saves a factorisation.
  void measure(const Model& model, const State& state, bool forces, Probe& probe);
  void forget_model() { index1_.reset(); }

  // `base` in the present modes.
  std::shared_ptr<const Model> model(const Model& base) const;
  // `base` with the held stops as constraints for good, which leaves them free here. Reels stop at their
  // length at t instead.
  std::shared_ptr<const Model> lock_held(const Model& base, double t);

 private:
  struct Cable {
    std::size_t force;  // of the structure
    std::string name;
    MeasureFunction length;
    Force law;
  };
  std::set<std::size_t> held() const;
  void measure_pushes(const Model& model, const State& state, Probe& probe);
  double stretch(const Cable& cable, double t, const VectorXd& q, const VectorXd& v, double& rate);

  Stops stops_;
  std::vector<Cable> cables_;
  std::vector<bool> active_;
  VectorXd shift_;  // of the stops' gaps [m] or [rad]
  double step_;
  bool eliminate_linear_;
  VectorXd gradient_, acceleration_, lambda_;
  std::optional<System> followed_;  // the present model's, near a state's angles
  std::unique_ptr<Index1> index1_;  // of that
};

}  // namespace unfurl
