// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>
#include <cmath>

#include "core/study/order_fit.hpp"

using namespace unfurl;

TEST_CASE("a pure power law gives its exponent and an interval of no width") {
  std::vector<double> step, error;
  for (int i = 0; i < 5; ++i)
    step.push_back(std::ldexp(1.0, -i)), error.push_back(3 * std::pow(step.back(), 4));
  const ObservedOrder fit = fit_order(step, error);
  CHECK(fit.order == Approx(4).epsilon(1e-12));
  CHECK(fit.high - fit.low < 1e-6);  // round-off of logarithms, magnified by t = 3.2
}

TEST_CASE("the interval of a noisy order is that of Student's t") {
  // log2 of errors 0, 2.1, 3.9, 6 at log2 of steps 0, 1, 2, 3: slope 1.98, residual sum of squares 0.018 (by
  // hand), so half the interval is 4.303 sqrt(0.018 / 2 / 5) in units of log2.
  const ObservedOrder fit = fit_order({1, 2, 4, 8}, {1, std::exp2(2.1), std::exp2(3.9), std::exp2(6.0)});
  CHECK(fit.order == Approx(1.98).epsilon(1e-12));
  CHECK(fit.high - fit.order == Approx(4.303 * std::sqrt(0.018 / 2 / 5)).epsilon(1e-9));
}

TEST_CASE("two points tell no order") {
  CHECK(std::isnan(fit_order({1, 2}, {1, 4}).order));
}
