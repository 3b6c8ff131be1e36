// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/turned_frame.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/singular_values.hpp"
#include "core/simulate/run_words.hpp"
#include "core/structure/node_positions.hpp"

namespace unfurl {
namespace {

MatrixXd about_centre(const VectorXd& q) {
  MatrixXd x = Eigen::Map<const MatrixXd>(q.data(), 3, q.size() / 3);
  const Vec3 centre = x.rowwise().mean();
  x.colwise() -= centre;
  return x;
}

// Of a rigid body that is held like this at x, about the centre: rows that its three translations and three
// rotations must give zero.
void set_rows(const Constraint& c, const Vec3& x, MatrixXd& rows, Index at) {
  Mat3 held = Mat3::Identity();
  if (c.kind != "fixed") {
    const Vec3 n = c.vectors[0].normalized();
    held = c.kind == "plane" ? Mat3(n * n.transpose()) : Mat3(held - n * n.transpose());
  }
  for (int k = 0; k < 3; ++k) {
    rows.block<3, 1>(at, k) = held.col(k);
    rows.block<3, 1>(at, 3 + k) = held * Vec3::Unit(k).cross(x);
  }
}

// Whether supports of single nodes leave the whole a rotation; planes of symmetry do not hold a ring.
bool can_turn(const Structure& structure, const MatrixXd& about) {
  const double size = std::max(about.lpNorm<Eigen::Infinity>(), 1e-300);
  std::vector<const Constraint*> supports;
  for (const Constraint& c : structure.constraints)
    if ((c.kind == "fixed" || c.kind == "plane" || c.kind == "line") && c.nodes.size() == 1 &&
        c.nodes[0] < about.cols())
      supports.push_back(&c);
  if (supports.empty()) return true;
  MatrixXd rows(3 * static_cast<Index>(supports.size()), 6);
  for (std::size_t k = 0; k < supports.size(); ++k)
    set_rows(*supports[k], about.col(supports[k]->nodes[0]) / size, rows, 3 * static_cast<Index>(k));
  const auto rank = [](const MatrixXd& A) { return rank_above(A, 1e-9); };  // entries are of size 1
  return rank(rows) - rank(rows.leftCols(3)) < 3;
}

}  // namespace

TurnedFrame::TurnedFrame(const Structure& structure) {
  if (!structure.deployment.folds() || structure.sectors != 1.0) return;
  MatrixXd about = about_centre(node_positions(structure).head(space_coordinates(structure)));
  if (!can_turn(structure, about)) return;
  start_ = std::move(about);
  for (const ReportedSurface& surface : structure.surfaces) also_ += ", and " + surface.name;
}

std::string TurnedFrame::at(const System& system, const State& state) {
  constexpr double little = 0.0175, rounding = 1e-9;  // a degree
  if (said_ || start_.size() == 0) return "";
  VectorXd q(system.coordinates());
  system.expand(state.z, q);
  const Eigen::Matrix3d A = about_centre(q.head(start_.size())) * start_.transpose();
  for (Index i = 0; i < 3; ++i) {
    const Index j = (i + 1) % 3, k = (i + 2) % 3;
    said_ = said_ || std::abs(A(k, j) - A(j, k)) > little * std::abs(A(j, j) + A(k, k)) + rounding * A.norm();
  }
  if (!said_) return "";
  return "at t = " + seconds(state.t) +
         ": the structure turns in space, by a degree so far. Its fold angle is measured along the "
         "directions of t = 0: from here on it is off, and so are forces and drives that act on it and the "
         "time at which it counts as deployed" +
         also_;
}

}  // namespace unfurl
