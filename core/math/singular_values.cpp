// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/singular_values.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

namespace unfurl {
namespace {

// A bidiagonal matrix with a on its diagonal and b beside it, a multiple `bound` of one whose singular values
// are at most 1, by the squares of the latter's entries. L D L^T of B^T B - x^2 has as many negative pivots d
// as singular values are below x; with t = d - a^2 these are, to high relative accuracy (Fernando & Parlett
// 1994, dstqds),
//   t_1 = -x^2,  d_k = a_k^2 + t_k,  t_{k+1} = t_k b_k^2 / d_k - x^2.
// Four x at once: each step waits for a division, which four share.
class BidiagonalCount {
 public:
  explicit BidiagonalCount(const VectorXd& entries) : size_((entries.size() + 1) / 2) {
    for (Index i = 0; i <= entries.size(); ++i)  // Gershgorin, of the matrix of Golub and Kahan
      bound_ = std::max(bound_, (i > 0 ? std::abs(entries[i - 1]) : 0.0) +
                                    (i < entries.size() ? std::abs(entries[i]) : 0.0));
    if (bound_ > 0) square_ = (entries / bound_).cwiseAbs2();
  }
  Index size() const { return size_; }
  double bound() const { return bound_; }

  Eigen::Array4d below(const Eigen::Array4d& x) const {  // x > 0, in multiples of bound()
    constexpr double tiny = 1e-300, huge = 1e305;        // no pivot is zero; the sign of what is not
    const Eigen::Array4d shift = x.square();
    Eigen::Array4d count = Eigen::Array4d::Zero(), t = -shift;
    for (Index k = 0;; ++k) {
      const Eigen::Array4d d = square_[2 * k] + t + tiny;
      count -= (huge * d).max(-1.0).min(0.0);
      if (k + 1 == size_) return count;
      t = t * (square_[2 * k + 1] / d) - shift;
    }
  }

 private:
  Index size_;
  double bound_ = 0;
  VectorXd square_;
};

}  // namespace

VectorXd singular_values_at(const VectorXd& entries, std::span<const Index> which) {
  const BidiagonalCount spectrum(entries);
  VectorXd values = VectorXd::Zero(static_cast<Index>(which.size()));
  if (spectrum.bound() == 0) return values;
  constexpr double resolution = std::numeric_limits<double>::epsilon();
  for (Index at = 0; at < values.size(); at += 4) {
    const Index lanes = std::min<Index>(4, values.size() - at);
    Eigen::Array4d behind, lo = Eigen::Array4d::Zero(), hi = Eigen::Array4d::Constant(1 + resolution);
    for (Index k = 0; k < 4; ++k)  // so many are below the value
      behind[k] = static_cast<double>(spectrum.size() - 1 -
                                      which[static_cast<std::size_t>(at + std::min(k, lanes - 1))]);
    while ((hi - lo).maxCoeff() > resolution) {
      const Eigen::Array4d middle = 0.5 * (lo + hi);
      if ((middle <= lo || middle >= hi).any()) break;
      const Eigen::Array4d count = spectrum.below(middle);
      for (Index k = 0; k < 4; ++k) (count[k] > behind[k] ? hi[k] : lo[k]) = middle[k];
    }
    for (Index k = 0; k < lanes; ++k)
      values[at + k] = lo[k] > 0 ? 0.5 * (lo[k] + hi[k]) * spectrum.bound() : 0.0;
  }
  return values;
}

Index singular_values_above(const VectorXd& entries, double x) {
  const BidiagonalCount spectrum(entries);
  if (spectrum.bound() == 0) return 0;
  return spectrum.size() -
         static_cast<Index>(spectrum.below(Eigen::Array4d::Constant(x / spectrum.bound()))[0]);
}

Index rank_above(const MatrixXd& matrix, double x) {
  return matrix.size() > 0 && matrix.allFinite() ? singular_values_above(bidiagonal_of(matrix), x) : 0;
}

Index rank_within(const MatrixXd& matrix, double share) {
  if (matrix.size() == 0 || !matrix.allFinite()) return 0;
  const VectorXd entries = bidiagonal_of(matrix);
  const Index first[] = {0};
  const double largest = singular_values_at(entries, first)[0];
  return largest > 0 ? singular_values_above(entries, share * largest) : 0;
}

// Not Eigen's own decompositions: for the values alone they compile for half a minute. Its iteration for
// tridiagonal matrices, which is quicker than bisection, now and then does not converge.
VectorXd singular_values(const MatrixXd& matrix) {
  if (matrix.size() == 0) return {};
  if (!matrix.allFinite())
    return VectorXd::Constant(std::min(matrix.rows(), matrix.cols()),
                              std::numeric_limits<double>::quiet_NaN());
  return singular_values_of_bidiagonal(bidiagonal_of(matrix));
}

VectorXd bidiagonal_of(const MatrixXd& matrix) {
  MatrixXd A = matrix;
  if (A.rows() < A.cols()) A.transposeInPlace();
  const Index m = A.rows(), n = A.cols();
  VectorXd off = VectorXd::Zero(2 * n - 1), workspace(m);  // diagonal and superdiagonal, in turn
  for (Index k = 0; k < n; ++k) {
    double tau = 0.0;
    A.col(k).tail(m - k).makeHouseholderInPlace(tau, off[2 * k]);
    const Index right = n - k - 1;
    if (right == 0) break;
    A.bottomRightCorner(m - k, right)
        .applyHouseholderOnTheLeft(A.col(k).tail(m - k - 1), tau, workspace.data());
    A.row(k).tail(right).makeHouseholderInPlace(tau, off[2 * k + 1]);
    A.bottomRightCorner(m - k - 1, right)
        .applyHouseholderOnTheRight(A.row(k).tail(right - 1).transpose(), tau, workspace.data());
  }
  return off;
}

VectorXd singular_values_of_bidiagonal(const VectorXd& entries, bool by_bisection) {
  const Index n = (entries.size() + 1) / 2;
  if (!by_bisection) {
    Eigen::SelfAdjointEigenSolver<MatrixXd> solver;
    solver.computeFromTridiagonal(VectorXd::Zero(2 * n), entries, Eigen::EigenvaluesOnly);
    if (solver.info() == Eigen::Success) return solver.eigenvalues().tail(n).reverse().cwiseMax(0.0);
  }
  std::vector<Index> all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), Index{0});
  return singular_values_at(entries, all);
}

}  // namespace unfurl
