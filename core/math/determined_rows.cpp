// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/determined_rows.hpp"

#include <cmath>

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

constexpr double round_off = 1e-11;  // of entries of unit rows

}  // namespace

SparseRows without_round_off_transposed(const SparseRows& G) {
  SparseRows clean = G;
  for (Index r = 0; r < clean.rows(); ++r) {
    const double norm = clean.row(r).norm();
    for (SparseRows::InnerIterator it(clean, r); it; ++it)
      if (!(std::abs(it.value()) > round_off * norm)) it.valueRef() = 0.0;
  }
  return clean.transpose();
}

std::vector<char> determined_rows(const SparseRows& G) {
  const Index rows = G.rows();
  std::vector<char> determined(static_cast<std::size_t>(rows), 1);
  if (rows == 0) return determined;
  SparseRows unit = G;
  for (Index r = 0; r < rows; ++r)
    if (const double norm = unit.row(r).norm(); norm > 0) unit.row(r) /= norm;
  const SparseRows across = without_round_off_transposed(unit);
  SparseRows identity(rows, rows);
  identity.setIdentity();
  SaddleSolver solver(identity, across);
  if (!solver.factorise(across)) return std::vector<char>(determined.size(), 0);
  VectorXd r(rows), w(rows), x(G.cols());
  for (int trial = 0; trial < trials; ++trial) {
    for (Index i = 0; i < rows; ++i) r[i] = without_structure(i, trial);
    solver.solve(r, VectorXd::Zero(G.cols()), w, x);
    for (Index i = 0; i < rows; ++i)
      if (!(std::abs(w[i]) <= negligible)) determined[static_cast<std::size_t>(i)] = 0;
  }
  return determined;
}

std::vector<char> determined_rows(const SparseRows& G, const VectorXd& compliance) {
  std::vector<int> rigid;
  for (Index i = 0; i < G.rows(); ++i)
    if (!(compliance[i] > 0)) rigid.push_back(static_cast<int>(i));
  SparseRows rest(static_cast<Index>(rigid.size()), G.cols());
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t r = 0; r < rigid.size(); ++r)
    for (SparseRows::InnerIterator it(G, rigid[r]); it; ++it)
      entries.emplace_back(static_cast<int>(r), static_cast<int>(it.col()), it.value());
  rest.setFromTriplets(entries.begin(), entries.end());
  const std::vector<char> of_rest = determined_rows(rest);
  std::vector<char> determined(static_cast<std::size_t>(G.rows()), 1);
  for (std::size_t r = 0; r < rigid.size(); ++r) determined[static_cast<std::size_t>(rigid[r])] = of_rest[r];
  return determined;
}

}  // namespace unfurl
