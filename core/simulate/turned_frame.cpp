// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/turned_frame.hpp"

#include <algorithm>
#include <cmath>

#include "core/simulate/run_words.hpp"
#include "core/structure/node_positions.hpp"

namespace unfurl {
namespace {

// Held in space, at least somewhere; planes of symmetry do not hold a ring.
bool held(const Constraint& c) {
  const bool linear = c.kind == "fixed" || c.kind == "plane" || c.kind == "line";
  return linear && c.nodes.size() == 1;
}

MatrixXd about_centre(const VectorXd& q) {
  MatrixXd x = Eigen::Map<const MatrixXd>(q.data(), 3, q.size() / 3);
  const Vec3 centre = x.rowwise().mean();
  x.colwise() -= centre;
  return x;
}

}  // namespace

TurnedFrame::TurnedFrame(const Structure& structure) {
  if (structure.deployment.folds() && structure.sectors == 1.0 &&
      std::ranges::none_of(structure.constraints, held))
    start_ = about_centre(node_positions(structure));
}

std::string TurnedFrame::at(const System& system, const State& state) {
  constexpr double little = 0.0175, rounding = 1e-9;  // a degree
  if (said_ || start_.size() == 0) return "";
  VectorXd q(system.coordinates());
  system.expand(state.z, q);
  const Eigen::Matrix3d A = about_centre(q) * start_.transpose();
  for (Index i = 0; i < 3; ++i) {
    const Index j = (i + 1) % 3, k = (i + 2) % 3;
    said_ = said_ || std::abs(A(k, j) - A(j, k)) > little * std::abs(A(j, j) + A(k, k)) + rounding * A.norm();
  }
  if (!said_) return "";
  return "at t = " + seconds(state.t) +
         ": the structure turns in space, by a degree so far. Its fold angle is measured along the "
         "directions "
         "of t = 0: from here on it is off, and so are forces and drives that act on it and the time at "
         "which "
         "it counts as deployed";
}

}  // namespace unfurl
