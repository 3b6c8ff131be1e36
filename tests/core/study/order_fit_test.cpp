// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/study/order_fit.hpp"

using namespace unfurl;

namespace order_fit_test {

namespace {

// How likely Student's t with so many degrees of freedom lies within +-x: its density, proportional to
// (1 + t^2 / n)^(-(n+1)/2), with t = sqrt(n) tan(a) proportional to cos(a)^(n-1): Simpson's rule in a.
double within(double x, std::size_t freedom) {
  const auto n = static_cast<double>(freedom);
  const auto integral = [&](double end) {
    constexpr int pieces = 2000;
    double sum = 0;
    for (int i = 0; i <= pieces; ++i)
      sum += std::pow(std::cos(end * i / pieces), n - 1) * (i == 0 || i == pieces ? 1 : i % 2 ? 4 : 2);
    return sum * end / pieces / 3;
  };
  return integral(std::atan(x / std::sqrt(n))) / integral(std::acos(0.0));
}

}  // namespace

TEST_CASE("the interval of an order holds it 95 times of 100, for every number of points") {
  std::mt19937 dice(5);
  std::uniform_real_distribution<double> noise(-0.3, 0.3);
  for (std::size_t n = 3; n <= 12; ++n) {
    std::vector<double> step, error;
    for (std::size_t i = 0; i < n; ++i) {
      step.push_back(0.7 * std::exp(-0.6 * static_cast<double>(i) + noise(dice)));
      error.push_back(3.1 * std::pow(step.back(), 2.4) * std::exp(noise(dice)));
    }
    const ObservedOrder fit = fit_order(step, error);
    CHECK(fit.points == static_cast<int>(n));
    // The slope from all pairs: sum of dx dy by sum of dx^2, which is the least squares' one (Lagrange).
    double xx = 0, xy = 0, yy = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const double dx = std::log(step[i] / step[j]), dy = std::log(error[i] / error[j]);
        xx += dx * dx, xy += dx * dy, yy += dy * dy;
      }
    const double slope = xy / xx, count = static_cast<double>(n);
    const double deviation = std::sqrt((yy - slope * xy) / (count - 2) / xx);
    CHECK(fit.order == Approx(slope).epsilon(1e-12));
    CHECK(fit.order - fit.low == Approx(fit.high - fit.order).epsilon(1e-12));
    // Tables print the quantile to 4 or 5 digits: the density there is below 0.06.
    CHECK(within((fit.high - fit.order) / deviation, n - 2) == Approx(0.95).epsilon(0).margin(6e-5));
  }
  // Beyond a dozen points that of the normal distribution: 0.5 % less than it should be at 20.
  std::vector<double> step, error;
  for (int i = 0; i < 20; ++i) {
    step.push_back(std::exp(-0.3 * i));
    error.push_back(std::pow(step.back(), 1.7) * std::exp(i % 2 ? 0.1 : -0.1));
  }
  const ObservedOrder many = fit_order(step, error);
  CHECK(many.high > many.order);
}

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

}  // namespace order_fit_test
