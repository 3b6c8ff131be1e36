// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/elimination_choice.hpp"

#include <algorithm>

#include "core/math/saddle_solver.hpp"

namespace unfurl {
namespace {

// Elimination never pays to keep below this many users of a coordinate (the ring of six units has three), and
// factors are compared before rows are kept.
constexpr Index users_allowed = 24;

// Constraints and masses in the coordinates of an elimination. Values serve as pattern: made positive, so
// that no two cancel.
struct Reduced {
  SparseRows M, G;

  Reduced(const LinearElimination& e, const SparseRows& A, const SparseRows& mass, const SparseRows& rest) {
    const SparseRows B = e.B.cwiseAbs();
    M = SparseRows(B.transpose() * SparseRows(mass.cwiseAbs())) * B;
    std::vector<Eigen::Triplet<double>> entries;
    for (int r = 0; r < rest.outerSize(); ++r)
      for (SparseRows::InnerIterator it(rest, r); it; ++it) entries.emplace_back(r, it.col(), 1.0);
    int row = static_cast<int>(rest.rows());
    for (const int r : e.kept) {
      for (SparseRows::InnerIterator it(A, r); it; ++it) entries.emplace_back(row, it.col(), 1.0);
      ++row;
    }
    SparseRows all(row, A.cols());
    all.setFromTriplets(entries.begin(), entries.end());
    G = all * B;
  }

  // Constraints are eliminated behind their coordinates (SaddleSolver): those of one coordinate fill a
  // square.
  double least_fill() const {
    std::vector<Index> users(static_cast<std::size_t>(G.cols()), 0);
    for (int r = 0; r < G.outerSize(); ++r)
      for (SparseRows::InnerIterator it(G, r); it; ++it) ++users[static_cast<std::size_t>(it.col())];
    const auto most = static_cast<double>(users.empty() ? 0 : *std::max_element(users.begin(), users.end()));
    return 0.5 * most * most;
  }
  double fill() const { return static_cast<double>(SaddleSolver(M, G).factor_nonzeros()); }
};

}  // namespace

LinearElimination choose_elimination(const SparseRows& A, const ConstVec& b, const SparseRows& M,
                                     const SparseRows& G) {
  std::vector<char> massless(static_cast<std::size_t>(A.cols()));
  for (Index i = 0; i < A.cols(); ++i) massless[static_cast<std::size_t>(i)] = !(M.coeff(i, i) > 0);
  LinearElimination some = eliminate_sparsely(A, b, massless, users_allowed);
  if (some.kept.empty()) return eliminate(A, b);
  const double fill = Reduced(some, A, M, G).fill();
  LinearElimination all = eliminate(A, b);
  const Reduced reduced(all, A, M, G);
  return reduced.least_fill() > fill || reduced.fill() > fill ? some : all;
}

}  // namespace unfurl
