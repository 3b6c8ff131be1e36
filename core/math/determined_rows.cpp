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

// Of entries of unit rows; the solver scales coordinates to one size and would take them for slopes.
constexpr double round_off = 1e-11;

SparseRows transposed_unit_rows(const SparseRows& G) {
  SparseRows unit = G;
  for (Index r = 0; r < unit.rows(); ++r) {
    const double norm = unit.row(r).norm();
    for (SparseRows::InnerIterator it(unit, r); it; ++it)
      it.valueRef() = std::abs(it.value()) > round_off * norm ? it.value() / norm : 0.0;
  }
  return unit.transpose();
}

}  // namespace

std::vector<char> determined_rows(const SparseRows& G) {
  const Index rows = G.rows();
  std::vector<char> determined(static_cast<std::size_t>(rows), 1);
  if (rows == 0) return determined;
  const SparseRows across = transposed_unit_rows(G);
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

}  // namespace unfurl
