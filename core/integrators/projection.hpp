#pragma once

#include "core/math/saddle_solver.hpp"
#include "core/model/system.hpp"

namespace unfurl {

// Moves states that are nearly right onto the constraints, in the mass metric (least M-norm of the change):
//
//     positions:   [M G^T; G 0] [dz; y] = [0; -Phi(z)],  z += dz, G frozen where it was begun, until
//     round-off velocities:  [M G^T; G 0] [w; y]  = [M w; 0]       at the moved pose
class Projection {
 public:
  explicit Projection(const System& system);
  // False where the iteration does not reach the constraints. Leaves |Phi| at round-off of the coordinates.
  bool positions(VectorXd& z);
  bool velocities(const VectorXd& z, VectorXd& w);
  int iterations() const { return iterations_; }  // of the last call of positions

 private:
  double level();  // of phi_: 1 is what rounding the coordinates leaves
  const System& system_;
  SparseRows G_;
  std::vector<double> scratch_;
  SaddleSolver saddle_;
  VectorXd q_, phi_, force_, offset_, x_, y_;
  int iterations_ = 0;
};

}  // namespace unfurl
