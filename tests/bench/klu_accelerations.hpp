// SPDX-License-Identifier: BSD-3-Clause
// Accelerations from the index-1 equations as a user of SuiteSparse has them: independent constraint rows,
// picked once by a dense rank-revealing QR (for small systems), and KLU.
#pragma once

#include <klu.h>

#include <vector>

#include "core/system/system.hpp"

namespace unfurl::bench {

class KluAccelerations {
 public:
  // Rows are picked at the pose q (node coordinates). pivoting: pivots are chosen anew in every
  // factorisation.
  KluAccelerations(const System& system, const ConstVec& q, bool pivoting = false);
  ~KluAccelerations();
  KluAccelerations(const KluAccelerations&) = delete;
  KluAccelerations& operator=(const KluAccelerations&) = delete;

  void accelerate(double t, const VectorXd& z, const VectorXd& w, VectorXd& acceleration);

 private:
  struct Place {
    Index from, below, above;
  };
  void pick_rows(const ConstVec& q);
  void fill();
  void factorise();

  const System& system_;
  bool pivoting_;
  SparseRows G_;
  std::vector<double> scratch_;
  std::vector<int> rows_;
  std::vector<Place> places_;
  Eigen::SparseMatrix<double, Eigen::ColMajor, int> matrix_;
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
  VectorXd q_, v_, f_, b_, bias_, force_;
};

}  // namespace unfurl::bench
