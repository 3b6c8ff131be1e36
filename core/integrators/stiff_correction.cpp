// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/stiff_correction.hpp"

#include <algorithm>

#include "core/math/factors.hpp"

namespace unfurl {
namespace {

// What is left of a correction when its gradients end, as a share of it; and how many there are at most. The
// iteration around them gains about that much by each.
constexpr double left_of_correction = 0.03;
constexpr int most_gradients = 60;

}  // namespace

StiffCorrection::StiffCorrection(const GalerkinCoefficients& c, Index coordinates, Index constraints)
    : stages_(c.s - 1) {
  const MatrixXd value = c.value.topRows(stages_) * c.weight.asDiagonal(),
                 slope = c.slope.bottomRows(stages_), B = value * slope.transpose();
  const ComplexEigen eigen = complex_eigen(-(c.C_inverse * B));
  for (Index k = 0; k < stages_; ++k) {
    const Complex zeta = eigen.values[k];
    if (zeta.imag() < 0) continue;
    const double copies = zeta.imag() > 0 ? 2.0 : 1.0;
    modes_.push_back({zeta, eigen.inverse.row(k), copies * eigen.vectors.col(k), {}});
  }
  for (Eigen::VectorXcd* v : {&x_, &r_, &z_, &p_, &Ap_}) v->setZero(coordinates);
  y_.setZero(constraints);
  sum_x_.setZero(coordinates, stages_);
  sum_y_.setZero(constraints, stages_);
}

void StiffCorrection::take(double h, const SparseRows& M, const SparseRows& K, const SparseRows& D) {
  mass_ = M.diagonal();
  for (Mode& mode : modes_) {
    const Complex z = h * mode.zeta;
    mode.A = M.cast<Complex>() - (z * z) * K.cast<Complex>();
    mode.A -= z * D.cast<Complex>();
  }
}

void StiffCorrection::solve(const SaddleSolver& saddle, double* f, double* g) {
  Eigen::Map<Interleaved> F(f, sum_x_.rows(), stages_), G(g, sum_y_.rows(), stages_);
  sum_x_.setZero();
  sum_y_.setZero();
  for (const Mode& mode : modes_) {
    r_.noalias() = F * mode.from.transpose();
    y_.noalias() = G * mode.from.transpose();
    solve(saddle, mode);
    for (Index j = 0; j < stages_; ++j) {
      sum_x_.col(j) += (mode.to[j] * x_).real();
      sum_y_.col(j) += (mode.to[j] * y_).real();
    }
  }
  F = sum_x_;
  G = sum_y_;
}

// [A G^T; G 0] [x; y] = [r; y] for the r and y that are given. Residuals r keep the part G^T y, so that the
// preconditioner's multipliers of the last one are those of the solution.
void StiffCorrection::solve(const SaddleSolver& saddle, const Mode& mode) {
  const auto precondition = [&] {
    saddle.apply(reinterpret_cast<double*>(z_.data()), reinterpret_cast<double*>(y_.data()), 2);
  };
  z_ = r_;
  precondition();
  x_ = z_;
  const auto size = [&](const Eigen::VectorXcd& v) {  // v^* M v, M by its diagonal
    double sum = 0;
    for (Index i = 0; i < v.size(); ++i) sum += mass_[i] * std::norm(v[i]);
    return sum;
  };
  const double wanted = left_of_correction * left_of_correction * size(x_);
  r_.noalias() -= mode.A * x_;
  Complex before = 0;
  for (int i = 0; i <= most_gradients; ++i) {
    z_ = r_;
    y_.setZero();
    precondition();
    const Complex now = r_.cwiseProduct(z_).sum();
    if (i == most_gradients || !(size(z_) > wanted) || now == 0.0) return;
    if (i == 0)
      p_ = z_;
    else
      p_ = z_ + (now / before) * p_;
    before = now;
    Ap_.noalias() = mode.A * p_;
    const Complex share = now / p_.cwiseProduct(Ap_).sum();
    x_ += share * p_;
    r_ -= share * Ap_;
  }
}

}  // namespace unfurl
