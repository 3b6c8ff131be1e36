// SPDX-License-Identifier: BSD-3-Clause
// What of a structure drives lead to its deployed pose, in coordinates of a run's last model.
#pragma once

#include <vector>

#include "core/simulate/trajectory.hpp"

namespace unfurl {

// A state of the run in these coordinates. What else is held since then was not, and is put where it is: what
// drives lead is the same whatever holds beside it.
State in_last_model(const Trajectory& trajectory, std::size_t i);

// Of what is left to the deployed pose, by motions of some solved coordinates.
class LeftRate {
 public:
  explicit LeftRate(const Trajectory& trajectory);
  // Does any motion of those that are 1 change it?
  bool takes(const VectorXd& those);

 private:
  double of(const VectorXd& w);

  const Model& model_;
  VectorXd q_, v_, any_;
  double all_;
};

// What is interpolated: what drives alone move, where that says all of what is left; as in linkages that
// float it does not, all that constraints join to what is left. The rest is free.
struct DrivenParts {
  std::vector<Index> free;
  bool led;  // what is interpolated is known whatever acts
};
DrivenParts driven_parts(const Trajectory& trajectory);

}  // namespace unfurl
