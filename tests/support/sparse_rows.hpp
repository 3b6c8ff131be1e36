// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/math/types.hpp"

namespace unfurl::testing {

// The entries of A that are not zero.
inline SparseRows sparse_rows(const MatrixXd& A) {
  SparseRows S = A.sparseView(1.0, 0.0);
  S.makeCompressed();
  return S;
}

}  // namespace unfurl::testing
