// SPDX-License-Identifier: BSD-3-Clause
// Barycentric Lagrange interpolation (Berrut & Trefethen 2004, SIAM Review 46): the paper's "center of
// gravity" interpolation. Weights are computed from the nodes, whatever they are.
#pragma once

#include <string_view>

#include "core/math/types.hpp"

namespace unfurl {

class Barycentric {
 public:
  explicit Barycentric(VectorXd nodes);  // distinct

  const VectorXd& nodes() const { return nodes_; }
  VectorXd values(double t) const;       // l_k(t), k = 1..s
  VectorXd derivatives(double t) const;  // l_k'(t)
  MatrixXd derivative_matrix() const;    // D_ik = l_k'(c_i)

 private:
  VectorXd nodes_, weights_;
};

// The s control times on [0, 1], both ends among them: "lobatto", "equidistant" or "chebyshev" (extrema).
VectorXd interpolation_nodes(std::string_view family, int s);

}  // namespace unfurl
