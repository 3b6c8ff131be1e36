// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/anderson.hpp"

#include <array>
#include <catch2/catch.hpp>

using namespace unfurl;

namespace anderson_test {

TEST_CASE("an iteration with three slow modes ends in five corrections") {
  // c = B (end - x) with the eigenvalues 1, 0.5, 0.1 and 0.02 of B: a combination of five corrections is zero
  // (Cayley-Hamilton), where the iteration alone leaves 0.98^5 of the slowest mode. y follows x.
  constexpr Index n = 40;
  constexpr std::array<double, 4> rate{1.0, 0.5, 0.1, 0.02};
  VectorXd end(n), x = VectorXd::Zero(n), y = VectorXd::Zero(2);
  for (Index i = 0; i < n; ++i) end[i] = 1.0 + 0.1 * static_cast<double>(i % 7);
  Anderson anderson;
  for (int round = 0; round < 2; ++round) {  // restarted it owes nothing to what it knew
    anderson.restart();
    x.setZero();
    for (int k = 0; k < 6; ++k) {
      VectorXd c(n);
      for (Index i = 0; i < n; ++i) c[i] = rate[static_cast<std::size_t>(i) % 4] * (end[i] - x[i]);
      x += c;
      y = 3 * x.head(2);
      anderson.extrapolate(c, x, y);
    }
    CHECK((x - end).lpNorm<Eigen::Infinity>() <= 1e-11);  // round-off over the least rate
    CHECK((y - 3 * x.head(2)).lpNorm<Eigen::Infinity>() <=
          1e-12);  // of some moves up to a hundred times as long
    end *= -0.5;
  }
}

}  // namespace anderson_test
