// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/integrators/index1.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// What the index-1 equations say at a state, in solved coordinates.
struct SolvedPoint {
  VectorXd acceleration, lambda;
  bool known = false;  // false: nothing
};

// What the index-1 equations say at the states of a run, which are best asked for in their order: those that
// follow are solved along.
class StateForces {
 public:
  // `ahead`: what another one found at the first states already; null: nothing.
  explicit StateForces(const Trajectory& trajectory, const std::vector<SolvedPoint>* ahead = nullptr)
      : trajectory_(trajectory), ahead_(ahead) {}

  // Multipliers of state i, least-norm where rows are redundant; NaN where the equations have no solution. At
  // an event in a singular pose they are the extrapolated ones that the state holds. Accelerations are those
  // of the nodes, NaN where they are not known [m/s^2].
  VectorXd multipliers(std::size_t i, VectorXd& node_acceleration);
  // The same as the equations give it: not known at an event in a singular pose.
  SolvedPoint at(std::size_t i);

 private:
  void solve_from(std::size_t i);

  const Trajectory& trajectory_;
  const std::vector<SolvedPoint>* ahead_;
  const Model* model_ = nullptr;
  std::optional<Index1Lanes> lanes_;         // of that model
  std::size_t first_ = 0, behind_last_ = 0;  // states that are solved
};

}  // namespace unfurl
