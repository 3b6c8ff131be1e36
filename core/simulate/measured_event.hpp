// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/integrators/integrator.hpp"
#include "core/simulate/crossing.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// The state in which `left`, > 0 at `from` and <= 0 after a step of size h, is zero: a step of the length
// that ends there, by regula falsi (Illinois). `solve` takes a step of a length from a state; nothing where
// it fails, as it does in singular poses, or where the step does not reach the zero.
std::optional<State> step_to_zero(const State& from, double h,
                                  const std::function<double(const State&)>& left,
                                  const std::function<bool(double length, State& state)>& solve);

// Is the deployed pose one like any other, which steps may end in? Not where a fold angle tells it and rods
// are rigid: their constraints lose rank there.
bool deploys_regularly(const Structure& structure);

// The same for what is left to such a deployed pose, less a margin; by a fresh integrator. Nothing where the
// pose is not regular.
std::optional<State> step_to_deployed(const Model& model, Integrator& integrator, const State& from, double h,
                                      double margin);

// Where a step of size h leads from one side of the deployed pose to the same side, `to`, but may have been
// beyond it in between: the length of a step that ends there, or in the pose itself where it is touched, at a
// dead centre of the measure; not `solved` where steps that end so near fail or say too little, and it may
// not get there. Nothing where it was not, or the pose is not regular. `fresh`: makes the integrator, which
// few steps need. `rounded`: what of the way is nothing. `behind`: a solved part of the step to look behind;
// null: all of it.
struct Dip {
  double length;
  bool touches = false, solved = true;
};
std::optional<Dip> step_to_dip(const Model& model, const std::function<std::unique_ptr<Integrator>()>& fresh,
                               const State& from, const State& to, double h, double rounded,
                               const Probe* behind = nullptr);

// The rate of Deployment::remaining at a state [1/s].
double remaining_rate(const Model& model, const State& state);

}  // namespace unfurl
