// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/integrators/stage_equations.hpp"
#include "core/system/state.hpp"

namespace unfurl {

// The Newton iteration with the exact matrix of the stage equations: Jacobians at every node and the
// curvature of the constraints. In the unknowns dX_j and Y_j = -h^2 sum_k (C^-1)_jk b_k dlambda_k it reads
//
//     sum_j C_kj (M dX_j + G(Q_k)^T Y_j) - h^2 b_k H_k dX_k = -h r_k,   H_k = sum_i lambda_ki Hess Phi_i(Q_k)
//     G(Q_j) dX_j - e Y_j = -Phi_j
//
// with the derivatives of the forces that vary added to the first row, and a small e for redundant rows. One
// matrix serves as long as every iteration gains a digit. It is slow (a sparse LU of all stages at once, with
// allocation) and meant for the few steps near singular poses at which the simplified iteration does not
// contract.
StepStatus full_newton(StageEquations& equations, double wanted, double accepted, StepReport& report);

}  // namespace unfurl
