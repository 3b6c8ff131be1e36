// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/forces/force.hpp"
#include "core/math/types.hpp"

namespace unfurl {

// B^T A B for an A that is a sum of entries, asked for again and again: which of them add up to which entry
// of the result is found anew only where they are at other places than the last time (a cable has gone
// slack).
class ReducedSum {
 public:
  // Clears what was there and takes the entries of A, in any order; those at one place add up. B: node
  // coordinates by those that are solved for, always the same, and there until the sum is asked for.
  ForceDerivative& begin(const SparseRows& B);
  const SparseRows& sum();

 private:
  bool same_places() const;
  void find_places();

  const SparseRows* B_ = nullptr;
  ForceDerivative entries_;
  bool summed_ = false;
  std::vector<int> row_, column_, to_;  // of each entry, and where in A it goes
  SparseRows A_, result_;
  // An entry a of A gives weight * a to each target [start_a, start_{a+1}) in the result.
  std::vector<int> start_, target_;
  std::vector<double> weight_;
  bool by_product_ = false;  // rows of B are so long that the product of matrices is less
};

// dF/dz [N/m] and dF/dz' [N s/m] of a System's forces.
struct ForceDerivatives {
  ReducedSum by_z, by_w;
};

}  // namespace unfurl
