#include "core/math/singular_values.hpp"

#include <Eigen/Eigenvalues>
#include <stdexcept>

namespace unfurl {

// Not Eigen's own decompositions: for the values alone they compile for half a minute.
VectorXd singular_values(const MatrixXd& matrix) {
  if (matrix.size() == 0) return {};
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
  Eigen::SelfAdjointEigenSolver<MatrixXd> solver;
  solver.computeFromTridiagonal(VectorXd::Zero(2 * n), off, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) throw std::runtime_error("singular values did not converge");
  return solver.eigenvalues().tail(n).reverse().cwiseMax(0.0);
}

}  // namespace unfurl
