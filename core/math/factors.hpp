// SPDX-License-Identifier: BSD-3-Clause
// Eigen's factorisations behind functions that are compiled once: each of them takes a compiler seconds, in
// every unit that names it.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <complex>

#include "core/math/types.hpp"

namespace unfurl {

using SparseColumns = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// Eigenvalues, ascending, and orthonormal eigenvectors of a symmetric matrix, of which the lower half is
/// read.
struct SymmetricEigen {
  VectorXd values;
  MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(const MatrixXd& A);
VectorXd symmetric_eigenvalues(const MatrixXd& A);

/// A = vectors diag(values) inverse, for a matrix that has as many eigenvectors as rows.
struct ComplexEigen {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors, inverse;
};
ComplexEigen complex_eigen(const MatrixXd& A);

MatrixXd inverse_of(const MatrixXd& A);

/// The x of least norm among those with the smallest |A x - b|; A of any shape and rank.
VectorXd least_squares(const MatrixXd& A, const VectorXd& b);
/// The same for each column of B.
MatrixXd fitted_columns(const MatrixXd& A, const MatrixXd& B);

/// Columns whose pivot, the column less what those before it hold of it, is larger than `threshold` times the
/// largest count; negative: than the round-off of the factorisation.
Index rank_of(const MatrixXd& A, double threshold = -1);
/// Whether the rank is the same by both of these thresholds.
bool same_rank(const MatrixXd& A, double low, double high);

/// Orthonormal columns that span what A's span, and those that span the rest: pivots larger than `least`
/// count.
MatrixXd column_space(const MatrixXd& A, double least);
MatrixXd column_complement(const MatrixXd& A, double least);
/// Of independent columns the same, as many as A has, the longest taken first.
MatrixXd orthonormal_columns(const MatrixXd& A);

/// A = L L^T of a symmetric positive matrix.
class Cholesky {
 public:
  explicit Cholesky(const MatrixXd& A);
  VectorXd solve(const VectorXd& b) const;
  MatrixXd solve(const MatrixXd& b) const;
  MatrixXd solve_lower(const MatrixXd& b) const;  // L x = b

 private:
  Eigen::LLT<MatrixXd> factors_;
};

class DenseLu {
 public:
  void compute(const MatrixXd& A);
  VectorXd solve(const VectorXd& b) const;
  MatrixXd solve(const MatrixXd& b) const;

 private:
  Eigen::PartialPivLU<MatrixXd> factors_;
};

class SparseLu {
 public:
  SparseLu();
  explicit SparseLu(const SparseColumns& A);
  ~SparseLu();
  void analyse(const SparseColumns& A);    // the pattern
  bool factorise(const SparseColumns& A);  // of that pattern
  bool ok() const;
  VectorXd solve(const VectorXd& b) const;

 private:
  Eigen::SparseLU<SparseColumns> factors_;
};

/// L D L^T of a sparse symmetric matrix, of which the lower half is read; without pivoting.
class SparseCholesky {
 public:
  explicit SparseCholesky(const SparseColumns& A);
  ~SparseCholesky();
  bool ok() const;
  VectorXd solve(const VectorXd& b) const;
  MatrixXd solve(const MatrixXd& b) const;
  VectorXd pivots() const;

 private:
  Eigen::SimplicialLDLT<SparseColumns> factors_;
};

}  // namespace unfurl
