// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/SparseCore>
#include <complex>
#include <vector>

#include "core/integrators/galerkin.hpp"
#include "core/math/interleaved.hpp"
#include "core/math/saddle_solver.hpp"

namespace unfurl {

// The correction of the frozen iteration (dvm.cpp) with the derivatives K = dF/dz, D = dF/dz' of the forces
// at one pose in it, for forces that move too fast for an iteration that knows nothing of them, in structures
// too large for the factors of a full Newton matrix (cable nets). Of the stage equations' derivative
//
//     (1/h) C_kj M + B_kj D + h A_kj K,     A_kj = sum_i w_i l_k l_j (tau_i),  B_kj = sum_i w_i l_k l_j'
//     (tau_i)
//
// multiplication by h C^-1 leaves, because the s - 1 Gauss points make C^-1 A = -Z^2 with Z = -C^-1 B,
//
//     M x_j - sum_i (h Z_ji D + h^2 (Z^2)_ji K) x_i + G^T y_j = f_j,     G x_j = g_j.
//
// With Z = T diag(zeta) T^-1 these are s - 1 systems of the size of one pose, of which conjugate ones need
// one solution. Their matrices are complex and symmetric where K and D are. Each is solved by conjugate
// gradients with the unconjugated product (van der Vorst, Melissen 1990, IEEE Trans. Magn. 26, 706), with the
// factors of [M G^T; G 0] as preconditioner, which keeps every iterate on G x = g. The number of products
// goes with h omega, whatever the size of the structure: a cost per member that does not grow.
class StiffCorrection {
 public:
  StiffCorrection(const GalerkinCoefficients& coefficients, Index coordinates, Index constraints);

  // K and D from now on, for steps of this length.
  void take(double h, const SparseRows& M, const SparseRows& K, const SparseRows& D);
  // f [n x s-1], g [m x s-1], interleaved: right-hand sides, on return x and y.
  void solve(const SaddleSolver& saddle, double* f, double* g);

 private:
  using Complex = std::complex<double>;
  using Rows = Eigen::SparseMatrix<Complex, Eigen::RowMajor, int>;
  struct Mode {
    Complex zeta;
    Eigen::RowVectorXcd from;  // its row of T^-1
    Eigen::VectorXcd to;       // its column of T, twice where it stands for its conjugate as well
    Rows A;                    // M - h zeta D - h^2 zeta^2 K
  };
  void solve(const SaddleSolver& saddle, const Mode& mode);

  int stages_;
  std::vector<Mode> modes_;
  Eigen::VectorXcd x_, y_, r_, z_, p_, Ap_;  // y: multipliers that go with z
  VectorXd mass_;                            // diagonal of M
  Interleaved sum_x_, sum_y_;
};

}  // namespace unfurl
