// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/simulate/trajectory.hpp"
#include "core/system/state.hpp"
#include "core/system/system.hpp"
#include "core/text/archive.hpp"

namespace unfurl {

// States of a motion where none that ends there can be solved, next to a singular pose: on the polynomial
// through those at other times that can, on both sides of the pose.
class AcrossPose {
 public:
  using Step = std::function<bool(State& state, double length)>;
  using Beside = std::function<bool(State& state)>;

  // By steps of these lengths from one state, which ascend.
  AcrossPose(const State& from, const std::vector<double>& lengths, const Step& step);
  // By so many of them; `beside` says what is free of it, if anything does. False where fewer were solved, or
  // none on both sides, unless `behind` all of them is meant.
  bool at(const System& system, double t, State& out, const Beside& beside = {}, bool behind = false,
          std::size_t points = most_points) const;
  const std::vector<State>& solved() const { return solved_; }
  // What is free of what these lead goes its own way from a state. False where that is not found.
  bool move_free(const System& system, const std::vector<Index>& free, const State& from, State& out) const;
  // As the polynomials have it, with the accelerations.
  void between(double t, State& state, VectorXd& acceleration) const;

 private:
  static constexpr std::size_t most_points = 9;
  std::size_t first_around(std::size_t before, std::size_t points) const;

  std::vector<State> solved_;  // in the order of time
};

// Such a motion, what is free of it, and its state in the pose.
struct AroundPose {
  std::shared_ptr<const Model> smooth;
  AcrossPose across;
  std::vector<Index> free;
  double apart;  // [s]
  State there;
  bool led;
  double off = 0;  // by how much its last degrees change it [m]
};
struct BehindPose {
  AcrossPose across;
  std::vector<Index> free;
};

// A run's state in such a pose, and what its own equations do not say of it: how the motion came there.
struct InPose {
  double t = 0, apart = 0;  // [s]; states that tell the motion there lie so far apart
  double before = 0;        // so long before
  VectorXd q = {}, v = {};  // were places and velocities of nodes these
  VectorXd v_there = {}, angles = {};
  bool led = false;  // drives alone lead what loses its rank there

  void archive(Archive& archive) {
    for (double* x : {&t, &apart, &before}) archive(*x);
    for (VectorXd* x : {&q, &v, &v_there, &angles}) archive(*x);
    archive(led);
  }
};

}  // namespace unfurl
