// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/chebyshev.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace unfurl;

namespace chebyshev_test {

namespace {

VectorXd series_of(double (*f)(double), int n) {
  const VectorXd x = chebyshev_points(n);
  VectorXd values(n + 1);
  for (int k = 0; k <= n; ++k) values[k] = f(x[k]);
  return (values.transpose() * chebyshev_transform(n)).transpose();
}

double wave(double x) {
  return std::exp(0.7 * x) * std::sin(2.3 * x + 0.4);
}
double wave_slope(double x) {
  return std::exp(0.7 * x) * (0.7 * std::sin(2.3 * x + 0.4) + 2.3 * std::cos(2.3 * x + 0.4));
}

}  // namespace

TEST_CASE("a Chebyshev series is its function, with slope, divided difference and integral") {
  const VectorXd c = series_of(wave, 24);
  const VectorXd P = chebyshev_integral(series_of(wave_slope, 24));
  // 25 terms of some 1 each: round-off of a few 1e-16, times up to n^2 / 10 in slopes.
  for (const double x : {-1.0, -0.83, -0.1, 0.0, 0.37, 0.999, 1.0}) {
    const ValueAndSlope f = chebyshev_value_and_slope(c.data(), c.size(), x);
    CHECK(std::abs(f.value - wave(x)) <= 1e-14);
    CHECK(std::abs(f.slope - wave_slope(x)) <= 1e-12);
    CHECK(chebyshev_value(c.data(), c.size(), x) == f.value);
    CHECK(std::abs(chebyshev_value(P.data(), P.size(), x) - (wave(x) - wave(-1.0))) <= 1e-14);
    CHECK(std::abs(chebyshev_divided_difference(c.data(), c.size(), x, x) - wave_slope(x)) <= 1e-12);
    CHECK(std::abs(chebyshev_divided_difference(c.data(), c.size(), x, 0.21) -
                   (wave(x) - wave(0.21)) / (x - 0.21)) <= 1e-13);
  }
  // Where a plain difference has no digit left.
  CHECK(std::abs(chebyshev_divided_difference(c.data(), c.size(), 0.5, 0.5 + 1e-15) - wave_slope(0.5)) <=
        1e-12);
}

// Of some polynomial of each degree, whose last coefficient is as large as the others.
TEST_CASE("the integral of a short Chebyshev series has it for its slope and begins at zero") {
  for (Index n = 1; n < 8; ++n) {
    INFO(n << " terms");
    VectorXd c(n);
    for (Index k = 0; k < n; ++k) c[k] = std::cos(0.7 + 1.3 * static_cast<double>(k)) + 1.9;
    const VectorXd P = chebyshev_integral(c);
    REQUIRE(P.size() == n + 1);
    CHECK(std::abs(chebyshev_value(P.data(), P.size(), -1.0)) < 1e-14);
    MatrixXd two(2, n);
    two << c.transpose(), -2.1 * c.transpose();
    for (const double x : {-0.83, 0.0, 0.41, 1.0}) {
      const double value = chebyshev_value(c.data(), n, x);
      double sum = 0;  // T_k = cos(k arccos x)
      for (Index k = 0; k < n; ++k) sum += c[k] * std::cos(static_cast<double>(k) * std::acos(x));
      CHECK(value == Approx(sum).epsilon(0).margin(1e-13));
      CHECK(chebyshev_value_and_slope(P.data(), P.size(), x).slope == Approx(value).epsilon(0).margin(1e-13));
      VectorXd out(2);
      chebyshev_value(two, x, out);
      CHECK(out[0] == Approx(value).epsilon(0).margin(1e-13));
      CHECK(out[1] == Approx(-2.1 * value).epsilon(0).margin(1e-13));
    }
  }
}

}  // namespace chebyshev_test
