// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "core/system/state.hpp"
#include "core/system/system.hpp"
#include "core/text/archive.hpp"

namespace unfurl {

// States of a motion where none that ends there can be solved, next to a singular pose: on the polynomial
// through those at other times that can, on both sides of the pose.
class AcrossPose {
 public:
  using Step = std::function<bool(State& state, double length)>;

  // By steps of these lengths from one state, which ascend.
  AcrossPose(const State& from, const std::vector<double>& lengths, const Step& step);
  // By so many of them. False where fewer were solved, or none on both sides, unless `behind` all of them is
  // meant.
  bool at(const System& system, double t, State& out, bool behind = false, std::size_t points = 9) const;
  const std::vector<State>& solved() const { return solved_; }

 private:
  std::vector<State> solved_;  // in the order of time
};

// A run's state in such a pose, and what its own equations do not say of it: how the motion came there.
struct InPose {
  double t = 0, apart = 0;  // [s]; states that tell the motion there lie so far apart
  double before = 0;        // so long before
  VectorXd q = {}, v = {};  // were places and velocities of nodes these
  VectorXd v_there = {}, angles = {};

  void archive(Archive& archive) {
    for (double* x : {&t, &apart, &before}) archive(*x);
    for (VectorXd* x : {&q, &v, &v_there, &angles}) archive(*x);
  }
};

}  // namespace unfurl
