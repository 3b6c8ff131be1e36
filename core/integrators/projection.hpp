// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/integrators/constraint_increment.hpp"
#include "core/integrators/row_noise.hpp"
#include "core/math/saddle_solver.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// Moves states that are nearly right onto the constraints, in the mass metric (least M-norm of the change):
//
//     positions:   [M G^T; G 0] [dz; y] = [0; -Phi(z)],  z += dz, G frozen where it was begun, until
//     round-off velocities:  [M G^T; G 0] [w; y]  = [M w; 0]       at the moved pose
class Projection {
 public:
  explicit Projection(const System& system, double regularisation = SaddleSolver::standard_regularisation);
  // False where the iteration does not reach the constraints. Leaves |Phi| at round-off of the coordinates;
  // where that would move a weak mode by more than 1e-8 of the motion z - z0, what the motion from z0 at t0
  // changes of Phi at round-off of the motion instead.
  [[nodiscard]] bool positions(double t0, const VectorXd& z0, double t, VectorXd& z);
  // The same for an increment of z_0 of which no digit is to be lost: always in what it changes of Phi.
  [[nodiscard]] bool increment(double t0, const VectorXd& z0, double t, VectorXd& move);
  // Onto the constraints along the rows at one pose, which is given first: a smooth map of poses beside them,
  // as what is evaluated within a step needs. False where the iteration does not settle.
  [[nodiscard]] bool hold_rows_at(const VectorXd& z);
  [[nodiscard]] bool along_held_rows(double t, VectorXd& z);
  // Onto the rates that these rows ask for at that pose. What they hold by rounding alone stays free.
  [[nodiscard]] bool rates_by_held_rows(double t, VectorXd& w);
  [[nodiscard]] bool velocities(double t, const VectorXd& z, VectorXd& w);
  int iterations() const { return iterations_; }  // of the last call of positions

 private:
  bool needs_care(const VectorXd& z0, const VectorXd& z);
  bool reach(double t0, double t, VectorXd& move);
  double level();  // of phi_: 1 is what rounding the coordinates leaves
  const System& system_;
  SparseRows G_;
  std::vector<double> scratch_;
  SaddleSolver saddle_;
  RowNoise rows_;
  std::unique_ptr<ConstraintIncrement> increment_;  // made when first needed
  VectorXd q_, phi_, force_, offset_, x_, y_, move_;
  int iterations_ = 0;
};

}  // namespace unfurl
