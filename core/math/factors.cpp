// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/factors.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace unfurl {
namespace {

using PivotedQr = Eigen::ColPivHouseholderQR<MatrixXd>;

Index pivots_above(const PivotedQr& qr, double least) {
  return (qr.matrixQR().diagonal().cwiseAbs().array() > least).count();
}

}  // namespace

// Eigen's decompositions take no matrix without rows or columns (a structure without constraints has one):
// what is to be said of those is said here.

SymmetricEigen symmetric_eigen(const MatrixXd& A) {
  if (A.size() == 0) return {VectorXd(0), MatrixXd(0, 0)};
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd symmetric_eigenvalues(const MatrixXd& A) {
  if (A.size() == 0) return VectorXd(0);
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

ComplexEigen complex_eigen(const MatrixXd& A) {
  if (A.size() == 0) return {Eigen::VectorXcd(0), Eigen::MatrixXcd(0, 0), Eigen::MatrixXcd(0, 0)};
  const Eigen::EigenSolver<MatrixXd> solver(A);
  ComplexEigen out{solver.eigenvalues(), solver.eigenvectors(), {}};
  out.inverse = out.vectors.inverse();
  return out;
}

MatrixXd inverse_of(const MatrixXd& A) {
  return A.inverse();
}

VectorXd least_squares(const MatrixXd& A, const VectorXd& b) {
  return fitted_columns(A, b);
}

MatrixXd fitted_columns(const MatrixXd& A, const MatrixXd& B) {
  if (A.size() == 0) return MatrixXd::Zero(A.cols(), B.cols());
  const Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors(A);
  MatrixXd x(A.cols(), B.cols());
  for (Index k = 0; k < B.cols(); ++k) x.col(k) = factors.solve(VectorXd(B.col(k)));
  return x;
}

Index rank_of(const MatrixXd& A, double threshold) {
  if (A.size() == 0) return 0;
  PivotedQr qr(A);
  if (threshold >= 0) qr.setThreshold(threshold);
  return qr.rank();
}

bool same_rank(const MatrixXd& A, double low, double high) {
  if (A.size() == 0) return true;
  PivotedQr qr(A);
  qr.setThreshold(low);
  const Index rank = qr.rank();
  qr.setThreshold(high);
  return qr.rank() == rank;
}

MatrixXd column_space(const MatrixXd& A, double least) {
  if (A.size() == 0) return {A.rows(), 0};
  const PivotedQr qr(A);
  return qr.householderQ() * MatrixXd::Identity(A.rows(), pivots_above(qr, least));
}

MatrixXd orthonormal_columns(const MatrixXd& A) {
  if (A.size() == 0) return MatrixXd::Identity(A.rows(), A.cols());
  const PivotedQr qr(A);
  return qr.householderQ() * MatrixXd::Identity(A.rows(), A.cols());
}

MatrixXd column_complement(const MatrixXd& A, double least) {
  if (A.size() == 0) return MatrixXd::Identity(A.rows(), A.rows());
  const PivotedQr qr(A);
  const Index left = A.rows() - pivots_above(qr, least);
  MatrixXd last = MatrixXd::Zero(A.rows(), left);
  last.bottomRows(left).setIdentity();
  return qr.householderQ() * last;
}

Cholesky::Cholesky(const MatrixXd& A) : factors_(A) {}
VectorXd Cholesky::solve(const VectorXd& b) const {
  return factors_.solve(b);
}
MatrixXd Cholesky::solve(const MatrixXd& b) const {
  return factors_.solve(b);
}
MatrixXd Cholesky::solve_lower(const MatrixXd& b) const {
  return factors_.matrixL().solve(b);
}

void DenseLu::compute(const MatrixXd& A) {
  factors_.compute(A);
}
VectorXd DenseLu::solve(const VectorXd& b) const {
  return factors_.solve(b);
}
MatrixXd DenseLu::solve(const MatrixXd& b) const {
  return factors_.solve(b);
}

SparseLu::SparseLu() = default;
SparseLu::SparseLu(const SparseColumns& A) : factors_(A) {}
SparseLu::~SparseLu() = default;
void SparseLu::analyse(const SparseColumns& A) {
  factors_.analyzePattern(A);
}
bool SparseLu::factorise(const SparseColumns& A) {
  factors_.factorize(A);
  return ok();
}
bool SparseLu::ok() const {
  return factors_.info() == Eigen::Success;
}
VectorXd SparseLu::solve(const VectorXd& b) const {
  return factors_.solve(b);
}

SparseCholesky::SparseCholesky(const SparseColumns& A) : factors_(A) {}
SparseCholesky::~SparseCholesky() = default;
bool SparseCholesky::ok() const {
  return factors_.info() == Eigen::Success;
}
VectorXd SparseCholesky::solve(const VectorXd& b) const {
  return factors_.solve(b);
}
MatrixXd SparseCholesky::solve(const MatrixXd& b) const {
  return factors_.solve(b);
}
VectorXd SparseCholesky::pivots() const {
  return factors_.vectorD();
}

}  // namespace unfurl
