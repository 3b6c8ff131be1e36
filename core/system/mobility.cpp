// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/mobility.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "core/math/determined_rows.hpp"
#include "core/math/row_dependence.hpp"
#include "core/math/saddle_solver.hpp"
#include "core/math/singular_values.hpp"

namespace unfurl {

double rounding_of_rows(const System& system, const ConstVec& q) {
  const Index in_space = q.size() / 3 - std::ssize(system.ghosts());  // these come last, and are nowhere
  if (in_space == 0) return 0;
  const Eigen::Map<const Eigen::Matrix3Xd> x(q.data(), 3, in_space);
  const double extent = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
  constexpr double some = 8 * std::numeric_limits<double>::epsilon();
  return extent > 0 ? some * x.lpNorm<Eigen::Infinity>() / extent : 0.0;
}

SparseRows unit_rows(const System& system, const ConstVec& q) {
  SparseRows G = system.all_jacobian(q);
  for (Index row = 0; row < G.rows(); ++row) {
    const double norm = G.row(row).norm();
    if (norm > 0.0) G.row(row) /= norm;
  }
  return G;
}

std::vector<int> counted_rows(const System& system, const ConstVec& q) {
  std::vector<char> counts(static_cast<std::size_t>(system.all_constraints()), 1);
  for (const int row : system.implied_rows(q)) counts[static_cast<std::size_t>(row)] = 0;
  std::vector<int> rows;
  for (std::size_t r = 0; r < counts.size(); ++r)
    if (counts[r]) rows.push_back(static_cast<int>(r));
  return rows;
}

SparseRows picked_rows(const SparseRows& A, const std::vector<int>& rows) {
  if (static_cast<Index>(rows.size()) == A.rows()) return A;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (SparseRows::InnerIterator it(A, rows[r]); it; ++it)
      entries.emplace_back(static_cast<int>(r), static_cast<int>(it.col()), it.value());
  SparseRows out(static_cast<Index>(rows.size()), A.cols());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

namespace {

// Elimination in order fills the rows of a chain, of which none depends. Where it leaves so little of a row
// that the row may depend, which ones do is what factors in twice the digits say.
std::vector<int> dependent_rows(const SparseRows& G) {
  constexpr double weak = 1e-12;  // the square of a singular value of unit rows that elimination may doubt
  constexpr double doubtful = 1e-5;
  SparseRows identity(G.cols(), G.cols());
  identity.setIdentity();
  const SparseRows clean = without_round_off_transposed(G).transpose();
  SaddleSolver solver(identity, clean);
  const bool held = solver.factorise(clean);
  if (held && solver.all_independent(weak)) return {};
  RowDependence left = dependence_of_rows(G, dependent_row);
  if (left.least > doubtful || !held) return left.rows;
  return solver.dependent_rows(dependent_row, left.rows);
}

}  // namespace

Index rigid_motions(const SparseRows& G, const ConstVec& q, const std::vector<int>& ghosts) {
  const Index n = q.size() / 3, numbers = 3 * std::ssize(ghosts);
  MatrixXd R = MatrixXd::Zero(q.size(), 6), E = MatrixXd::Zero(q.size(), numbers);
  std::vector<char> in_space(static_cast<std::size_t>(n), 1);
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    in_space[static_cast<std::size_t>(ghosts[g])] = 0;
    E.block<3, 3>(3 * ghosts[g], static_cast<Index>(3 * g)).setIdentity();
  }
  double size = std::numeric_limits<double>::min();
  for (Index i = 0; i < n; ++i)
    if (in_space[static_cast<std::size_t>(i)])
      size = std::max(size, q.segment<3>(3 * i).lpNorm<Eigen::Infinity>());
  for (Index i = 0; i < n; ++i) {
    if (!in_space[static_cast<std::size_t>(i)]) continue;
    const Vec3 x = q.segment<3>(3 * i) / size;
    for (int k = 0; k < 3; ++k) {
      R.block<3, 1>(3 * i, k) = Vec3::Unit(k);
      R.block<3, 1>(3 * i, 3 + k) = Vec3::Unit(k).cross(x);
    }
  }
  // Rows of G have the length 1 and entries of R are below 1: round-off is 1e-15, a motion that a row forbids
  // 1e-3 and more.
  const auto rank = [](const MatrixXd& A) { return rank_above(A, 1e-9); };
  if (G.rows() == 0) return rank(R);
  MatrixXd all(q.size(), 6 + numbers);
  all << R, E;
  return rank(R) - (rank(G * all) - rank(G * E));
}

Mobility analyse_mobility(const System& system, const ConstVec& q) {
  Mobility mobility;
  const std::vector<int> counted = counted_rows(system, q);
  const SparseRows G = picked_rows(unit_rows(system, q), counted);
  mobility.coordinates = G.cols();
  mobility.constraints = G.rows();
  const std::vector<int> dependent = dependent_rows(G);

  mobility.rank = G.rows() - static_cast<Index>(dependent.size());
  mobility.degrees_of_freedom = mobility.coordinates - mobility.rank - system.integrals();
  mobility.count = mobility.coordinates - mobility.constraints - system.integrals();
  mobility.rigid_motions = rigid_motions(G, q, system.ghosts());
  const auto names = system.all_names();
  for (const int row : dependent) {
    mobility.redundant_rows.push_back(counted[static_cast<std::size_t>(row)]);
    mobility.redundant.push_back(names[static_cast<std::size_t>(mobility.redundant_rows.back())]);
  }
  return mobility;
}

double smallest_singular_value(const System& system, const ConstVec& q, Index rank) {
  constexpr Index max_dense_coordinates = 900;  // beyond, it takes seconds: its cost is cubic
  if (q.size() > max_dense_coordinates || rank == 0) return std::numeric_limits<double>::quiet_NaN();
  const SparseRows G = picked_rows(unit_rows(system, q), counted_rows(system, q));
  return singular_values(MatrixXd(G))[rank - 1];
}

}  // namespace unfurl
