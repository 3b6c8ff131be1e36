// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/barycentric.hpp"

#include <cmath>
#include <stdexcept>

#include "core/math/quadrature.hpp"

namespace unfurl {

Barycentric::Barycentric(VectorXd nodes) : nodes_(std::move(nodes)), weights_(VectorXd::Ones(nodes_.size())) {
  for (Index i = 0; i < nodes_.size(); ++i)
    for (Index j = 0; j < nodes_.size(); ++j)
      if (i != j) weights_[i] /= nodes_[i] - nodes_[j];
}

VectorXd Barycentric::values(double t) const {
  const Index s = nodes_.size();
  VectorXd l(s);
  for (Index k = 0; k < s; ++k)
    if (t == nodes_[k]) return VectorXd::Unit(s, k);
  for (Index k = 0; k < s; ++k) l[k] = weights_[k] / (t - nodes_[k]);
  return l / l.sum();
}

MatrixXd Barycentric::derivative_matrix() const {
  const Index s = nodes_.size();
  MatrixXd D = MatrixXd::Zero(s, s);
  for (Index i = 0; i < s; ++i) {
    for (Index k = 0; k < s; ++k)
      if (k != i) D(i, k) = weights_[k] / weights_[i] / (nodes_[i] - nodes_[k]);
    D(i, i) = -D.row(i).sum();
  }
  return D;
}

// l_k' is the interpolant of its own values at the nodes.
VectorXd Barycentric::derivatives(double t) const {
  return derivative_matrix().transpose() * values(t);
}

VectorXd interpolation_nodes(std::string_view family, int s) {
  if (s < 2) throw std::invalid_argument("interpolation_nodes: at least two");
  if (family == "lobatto") return gauss_lobatto(s).nodes;
  if (family == "equidistant") return VectorXd::LinSpaced(s, 0.0, 1.0);
  if (family == "chebyshev") {
    VectorXd c(s);
    for (int i = 0; i < s; ++i) {
      const double angle = pi * i / (2.0 * (s - 1));
      c[i] = std::sin(angle) * std::sin(angle);
    }
    c[s - 1] = 1.0;
    return c;
  }
  throw std::invalid_argument("interpolation_nodes: unknown family " + std::string(family));
}

}  // namespace unfurl
