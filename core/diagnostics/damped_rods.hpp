// SPDX-License-Identifier: BSD-3-Clause
// What the damping of rods that give takes where a step does not resolve their waves.
#pragma once

#include <vector>

#include "core/math/quadrature.hpp"
#include "core/system/system.hpp"

namespace unfurl {

class DampedRods {
 public:
  explicit DampedRods(const System& system);
  // At a time, node coordinates and velocities [W].
  double power(double t, const VectorXd& q, const VectorXd& v) const;
  // dF/dz' of theirs, in a pose.
  SparseRows derivative(const System& system, const VectorXd& q) const;
  // Through a step from a to b that tells the rods' axial forces N at its points, which are those of `rule`
  // [J]. No path through its ends tells it: the stretch e has the polynomial of the method, which starts
  // where a is and has e + damping_time e' = C N at these points, and the dampers take what they take at its
  // rates.
  double taken(const System& system, const State& a, const State& b, const Quadrature& rule) const;

 private:
  std::vector<Rod> rods_;             // that give, damped or not
  std::vector<double> coefficients_;  // [N s/m]
};

}  // namespace unfurl
