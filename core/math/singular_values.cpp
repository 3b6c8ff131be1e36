// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/singular_values.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

namespace unfurl {
namespace {

// The matrix [0 B^T; B 0] of a bidiagonal B, reordered, is tridiagonal with a zero diagonal and these entries
// beside it (Golub & Kahan 1965); its eigenvalues are plus and minus the singular values. Here by bisection
// with Sturm counts (Golub & Van Loan, Matrix Computations, 8.4.1), which cannot fail to converge.
class Bisection {
 public:
  Bisection(const VectorXd& beside, Index n) : square_(beside.cwiseAbs2()), values_(n) {
    const Index size = 2 * n;
    double bound = 0;  // Gershgorin
    for (Index i = 0; i < size; ++i)
      bound = std::max(bound,
                       (i > 0 ? std::abs(beside[i - 1]) : 0.0) + (i + 1 < size ? std::abs(beside[i]) : 0.0));
    resolution_ = std::numeric_limits<double>::epsilon() * bound;
    split(0.0, bound + resolution_, 0, n);
  }
  VectorXd descending() const { return values_.reverse(); }

 private:
  // How many singular values are below x > 0.
  Index below(double x) const {
    Index count = 0;
    double pivot = -x;
    for (Index i = 0; i <= square_.size(); ++i) {
      if (i > 0) pivot = -x - square_[i - 1] / pivot;
      if (pivot == 0.0) pivot = -std::numeric_limits<double>::min();
      if (pivot < 0) ++count;
    }
    return count - values_.size();  // all the negative eigenvalues are below x
  }

  // Values first..last-1, ascending, lie between lo and hi.
  void split(double lo, double hi, Index first, Index last) {
    if (first >= last) return;
    const double middle = 0.5 * (lo + hi);
    if (hi - lo <= resolution_ || middle <= lo || middle >= hi) {
      values_.segment(first, last - first).setConstant(lo > 0 ? middle : 0.0);
      return;
    }
    const Index left = std::clamp(below(middle), first, last);
    split(lo, middle, first, left);
    split(middle, hi, left, last);
  }

  VectorXd square_, values_;
  double resolution_ = 0;
};

}  // namespace

// Not Eigen's own decompositions: for the values alone they compile for half a minute. Its iteration for
// tridiagonal matrices, which is quicker than bisection, now and then does not converge.
VectorXd singular_values(const MatrixXd& matrix) {
  if (matrix.size() == 0) return {};
  MatrixXd A = matrix;
  if (A.rows() < A.cols()) A.transposeInPlace();
  const Index m = A.rows(), n = A.cols();
  if (!A.allFinite()) return VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN());
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
  return singular_values_of_bidiagonal(off);
}

VectorXd singular_values_of_bidiagonal(const VectorXd& entries, bool by_bisection) {
  const Index n = (entries.size() + 1) / 2;
  if (!by_bisection) {
    Eigen::SelfAdjointEigenSolver<MatrixXd> solver;
    solver.computeFromTridiagonal(VectorXd::Zero(2 * n), entries, Eigen::EigenvaluesOnly);
    if (solver.info() == Eigen::Success) return solver.eigenvalues().tail(n).reverse().cwiseMax(0.0);
  }
  return Bisection(entries, n).descending();
}

}  // namespace unfurl
