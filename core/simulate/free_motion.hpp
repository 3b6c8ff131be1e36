// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/math/saddle_solver.hpp"
#include "core/math/sparse_part.hpp"
#include "core/system/state.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// The solved coordinates that drives alone do not move, in a state in which constraints have their rank:
// those of nodes any of whose coordinates another motion changes.
std::vector<Index> free_coordinates(const System& system, const State& state);

// What moves beside that, or hangs from it, where its motion is known: by its own equations, with the
// constraints that it takes part in. Those that only hold what is led are none of them, and may lose rank.
class FreeMotion {
 public:
  // The system must outlive it.
  FreeMotion(const System& system, std::vector<Index> free);

  const std::vector<Index>& coordinates() const { return part_.columns(); }
  const std::vector<int>& rows() const { return part_.rows(); }  // the constraints that it takes part in

  // Coordinates and rates of what is led, and its accelerations, at a time.
  using Led = std::function<void(double t, State& state, VectorXd& acceleration)>;
  // From a state to the time `end`, through `edges` at which forces are not smooth: what is free of it.
  // Returns how far that may be off, in coordinates [m]; infinite where it is not found.
  double move(State& state, double end, const std::vector<double>& edges, const Led& led);
  // Its accelerations in a state, beside those of what is led, and the multipliers of its rows.
  bool solve(const State& state, VectorXd& acceleration, VectorXd& lambda);
  // How many of its rows are so weak, in a state.
  Index rows_below(const State& state, double bound);
  // The smallest pivot of them, looked for below `bound` (SaddleSolver).
  double weakest_pivot(const State& state, double bound);
  // What the rest feels of it then: by those rows, and by inertia that both share.
  VectorXd felt(const State& state, const VectorXd& acceleration, const VectorXd& lambda);

 private:
  bool factorise(const State& state);
  bool slope(double t, const VectorXd& y, VectorXd& out);
  bool extrapolate(double from, double to, const VectorXd& y, VectorXd& out, double& error);
  bool go(double from, double to, VectorXd& y, double& error, int halvings);
  void put(const VectorXd& y, State& state) const;

  const System& system_;
  SparseRows jacobian_;
  SparsePart part_;
  SparseRows rows_of_free_;
  std::unique_ptr<SaddleSolver> saddle_;
  std::vector<double> scratch_;
  const Led* led_ = nullptr;
  int left_ = 0;  // evaluations
  double size_ = 0;
  State state_;
  VectorXd acceleration_, lambda_, q_, v_, f_, force_, bias_;
};

}  // namespace unfurl
