// SPDX-License-Identifier: BSD-3-Clause
// The numbers of an L D L^T in twice the digits, on the pattern of a SparseLdlt that has been analysed: some
// twenty times slower, for the few matrices whose weak directions the square of a singular value takes below
// the round-off of doubles.
#pragma once

#include <vector>

#include "core/math/sparse_ldlt.hpp"
#include "core/math/twofold.hpp"

namespace unfurl {

class TwofoldLdlt {
 public:
  explicit TwofoldLdlt(const SparseLdlt& pattern);  // kept by reference

  // As SparseLdlt; entries of the diagonal at which `diagonal_shift` is not zero get it added.
  [[nodiscard]] bool factorise(const double* values, const double* diagonal_shift);
  void solve_ordered(Twofold* b) const;
  void solve_ordered(TwofoldPair* b) const;  // two right-hand sides
  // r -= A x for the matrix with these values, without the shift.
  void subtract_product(const double* values, const Twofold* x, Twofold* r) const;
  void subtract_product(const double* values, const TwofoldPair* x, TwofoldPair* r) const;
  double pivot(Index k) const { return pivot_[static_cast<std::size_t>(k)].hi; }  // k-th eliminated
  // As SparseLdlt, in doubles.
  double pivot_rate(std::size_t k) const {
    return pattern_.pivot_rate(
        k, [this](std::size_t p) { return l_[p].hi; }, [this](std::size_t r) { return pivot_[r].hi < 0; });
  }

 private:
  template <bool fused>
  [[nodiscard]] bool eliminate(const double* values, const double* diagonal_shift);
  template <class Number>
  void solve_in_place(Number* b) const;

  const SparseLdlt& pattern_;
  std::vector<Twofold> l_, pivot_, inverse_pivot_, work_;
  std::vector<int> fill_;
};

}  // namespace unfurl
