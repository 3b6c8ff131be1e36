// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/galerkin.hpp"

#include "core/math/factors.hpp"

namespace unfurl {
GalerkinCoefficients::GalerkinCoefficients(std::string_view family, int stages)
    : s(stages), basis(interpolation_nodes(family, stages)) {
  // s points integrate l_k' l_i' (degree 2 s - 4) and l_k (degree s - 1) exactly.
  take(gauss_legendre(s));
  b = value * weight;
  const MatrixXd weighed = slope * weight.asDiagonal();
  K = weighed * slope.transpose();
  take(gauss_legendre(s - 1));
  tau_to_end = Barycentric(tau).values(1.0);
  C = K.topRightCorner(s - 1, s - 1);
  C_inverse = inverse_of(C);
  extrapolate(1.0, extrapolation);
}

void GalerkinCoefficients::take(const Quadrature& rule) {
  tau = rule.nodes;
  weight = rule.weights;
  value.resize(s, tau.size());
  slope.resize(s, tau.size());
  for (Index j = 0; j < tau.size(); ++j) {
    value.col(j) = basis.values(tau[j]);
    slope.col(j) = basis.derivatives(tau[j]);
  }
}

void GalerkinCoefficients::extrapolate(double ratio, MatrixXd& out) const {
  out.resize(s - 1, s - 1);
  for (int i = 0; i + 1 < s; ++i) {
    const VectorXd l = basis.values(1.0 + basis.nodes()[i + 1] * ratio);
    out.row(i) = l.tail(s - 1).transpose();
    out(i, s - 2) -= 1.0;
  }
}

}  // namespace unfurl
