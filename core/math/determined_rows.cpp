// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/determined_rows.hpp"

#include <cmath>
#include <limits>

#include "core/math/saddle_solver.hpp"

namespace unfurl {
namespace {

constexpr int trials = 3;
// Of entries of a size of one. Projections carry round-off of 1e-16 divided by the smallest singular value
// that counts; a member of a state of self-stress that spreads over a thousand rods has 1e-2.
constexpr double negligible = 1e-8;

// Neither symmetry nor sparsity makes a combination of its entries vanish.
double without_structure(Index i, int trial) {
  return std::sin(1.0 + static_cast<double>((i + 1) * (5 * trial + 3)) * 0.7548776662466927) + 0.1 * trial;
}

constexpr double of_poses = 1e-9;  // entries of unit rows: poses without rank are known to some 1e-11

}  // namespace

SparseRows without_round_off_transposed(const SparseRows& G, double round_off) {
  SparseRows clean = G;
  for (Index r = 0; r < clean.rows(); ++r) {
    const double norm = clean.row(r).norm();
    for (SparseRows::InnerIterator it(clean, r); it; ++it)
      if (!(std::abs(it.value()) > round_off * norm)) it.valueRef() = 0.0;
  }
  return clean.transpose();
}

namespace {

SparseRows unit_rows(const SparseRows& G) {
  SparseRows unit = G;
  if (unit.cols() == 0) return unit;
  for (Index r = 0; r < unit.rows(); ++r)
    if (const double norm = unit.row(r).norm(); norm > 0) unit.row(r) /= norm;
  return unit;
}

// Vectors of null(unit^T) without structure; what is not a number where they cannot be had [rows x trials].
MatrixXd null_vectors(const SparseRows& unit) {
  MatrixXd out = MatrixXd::Zero(unit.rows(), trials);
  if (unit.rows() == 0) return out;
  if (unit.cols() == 0) return out.setOnes();  // nothing asks for anything
  const SparseRows across = without_round_off_transposed(unit, of_poses);
  SparseRows identity(unit.rows(), unit.rows());
  identity.setIdentity();
  SaddleSolver solver(identity, across);
  if (!solver.factorise(across)) return out.setConstant(std::numeric_limits<double>::quiet_NaN());
  VectorXd r(unit.rows()), w(unit.rows()), x(unit.cols());
  for (int trial = 0; trial < trials; ++trial) {
    for (Index i = 0; i < unit.rows(); ++i) r[i] = without_structure(i, trial);
    solver.solve(r, VectorXd::Zero(unit.cols()), w, x);
    out.col(trial) = w;
  }
  return out;
}

// Those of them that are zero in the rows that have a compliance.
MatrixXd null_vectors(const SparseRows& unit, const VectorXd& compliance) {
  if (compliance.size() == 0) return null_vectors(unit);
  std::vector<Index> rigid;
  for (Index i = 0; i < unit.rows(); ++i)
    if (!(compliance[i] > 0)) rigid.push_back(i);
  SparseRows rest(std::ssize(rigid), unit.cols());
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t r = 0; r < rigid.size(); ++r)
    for (SparseRows::InnerIterator it(unit, rigid[r]); it; ++it)
      entries.emplace_back(static_cast<int>(r), static_cast<int>(it.col()), it.value());
  rest.setFromTriplets(entries.begin(), entries.end());
  const MatrixXd of_rest = null_vectors(rest);
  MatrixXd out = MatrixXd::Zero(unit.rows(), trials);
  for (std::size_t r = 0; r < rigid.size(); ++r) out.row(rigid[r]) = of_rest.row(static_cast<Index>(r));
  return out;
}

std::vector<char> vanishing_rows(const MatrixXd& samples) {
  std::vector<char> out;
  for (const auto& row : samples.rowwise()) out.push_back((row.array().abs() <= negligible).all());
  return out;
}

}  // namespace

std::vector<char> determined_rows(const SparseRows& G, const VectorXd& compliance) {
  return vanishing_rows(null_vectors(unit_rows(G), compliance));
}

std::vector<char> determined_sums(const SparseRows& G, const SparseRows& told, const VectorXd& compliance) {
  MatrixXd samples = null_vectors(unit_rows(G), compliance);
  for (Index r = 0; r < G.rows(); ++r)
    if (const double norm = G.row(r).norm(); norm > 0) samples.row(r) /= norm;
  return vanishing_rows(told.transpose() * samples);
}

}  // namespace unfurl
