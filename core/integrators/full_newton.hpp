// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/integrators/stage_equations.hpp"
#include "core/math/factors.hpp"
#include "core/system/state.hpp"

namespace unfurl {

// The Newton iteration with the exact matrix of the stage equations: Jacobians at every node and the
// curvature of the constraints. In the unknowns dX_j and Y_j = -h^2 sum_k (C^-1)_jk b_k dlambda_k it reads
//
//     sum_j C_kj (M dX_j + G(Q_k)^T Y_j) - h^2 b_k H_k dX_k = -h r_k,   H_k = sum_i lambda_ki Hess Phi_i(Q_k)
//     G(Q_j) dX_j - e Y_j = -Phi_j
//
// (with constraints at the ends only, one Y = -h^2/2 dlambda beside G(Q_1)^T in the first row, and only the
// last of the second), with the derivatives of the forces that vary added to the first row, and a small e for
// redundant rows. Axial forces of rods that give, where they are unknowns (elastic_stages.hpp), have columns
// and rows behind these, with their compliances on the diagonal. One matrix serves as long as every iteration
// gains a digit. It is slow (a sparse LU of all stages at once, with allocation) and meant for the few steps
// near singular poses at which the simplified iteration does not contract, and for forces that are stiff at
// the step, of which that iteration knows nothing.
class FullNewton {
 public:
  // keep: begin with the matrix of the last step, where that is known.
  StepStatus solve(StageEquations& equations, double wanted, double accepted, bool keep, StepReport& report);
  void forget() { known_ = false; }

 private:
  // Small systems are factorised as dense ones, which is several times faster than what a sparse code needs
  // to set itself up; the pattern of larger ones is analysed when it is new.
  class Factors {
   public:
    bool compute(StageEquations& equations, const VectorXd& scale);  // of their Newton matrix
    VectorXd solve(const VectorXd& b) const;

   private:
    static constexpr Index largest_dense = 80;
    MatrixXd matrix_;
    DenseLu dense_;
    struct Slot {  // an entry's place in the matrix, and among its values
      int row, column;
      std::ptrdiff_t at;
    };
    void assemble(Index size);  // the entries into the columns

    std::vector<Eigen::Triplet<double>> entries_;
    std::vector<Slot> slots_;
    SparseColumns columns_;
    SparseLu sparse_;
  };
  void set_scale(const StageEquations& equations);

  Factors factors_;
  VectorXd scale_;
  double h_ = 0;  // the step that the factors are for
  bool known_ = false;
};

}  // namespace unfurl
