// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/quadrature.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/math/barycentric.hpp"

using namespace unfurl;

// integral of x^k over [0, 1] is 1 / (k + 1). A dozen additions of numbers below one: a few ulp, 4e-16 each.
TEST_CASE("Gauss rules integrate the polynomials they promise and no more") {
  for (int n = 2; n <= 9; ++n) {
    const Quadrature legendre = gauss_legendre(n), lobatto = gauss_lobatto(n);
    for (int k = 0; k <= 2 * n - 1; ++k) {
      CHECK(legendre.weights.dot(legendre.nodes.array().pow(k).matrix()) ==
            Approx(1.0 / (k + 1)).epsilon(4e-15));
      if (k <= 2 * n - 3)
        CHECK(lobatto.weights.dot(lobatto.nodes.array().pow(k).matrix()) ==
              Approx(1.0 / (k + 1)).epsilon(4e-15));
    }
    // The first power beyond: the error constant of the rule is (n!)^4 / ((2n+1) (2n)!^2) > 1e-12 for n <= 9.
    const double beyond = legendre.weights.dot(legendre.nodes.array().pow(2 * n).matrix());
    CHECK(std::abs(beyond - 1.0 / (2 * n + 1)) > 1e-12);
    CHECK(lobatto.nodes[0] == 0.0);
    CHECK(lobatto.nodes[n - 1] == 1.0);
  }
}

TEST_CASE("barycentric interpolation reproduces polynomials and their derivatives") {
  for (const char* family : {"lobatto", "equidistant", "chebyshev"})
    for (int s = 2; s <= 8; ++s) {
      const Barycentric basis(interpolation_nodes(family, s));
      const VectorXd data = basis.nodes().array().pow(s - 1);  // x^(s-1) is in the space
      for (double t : {0.0, 0.13, 0.5, 0.91, 1.0, 1.4}) {
        INFO(family << " s = " << s << " t = " << t);
        // Lebesgue constants on [0, 1.4] with 8 nodes stay below 1e4: 1e4 ulp of values of some 10; ten times
        // that of derivatives.
        CHECK(basis.values(t).dot(data) == Approx(std::pow(t, s - 1)).epsilon(0).margin(2e-11));
        CHECK(basis.derivatives(t).dot(data) ==
              Approx(s == 2 ? 1.0 : (s - 1) * std::pow(t, s - 2)).epsilon(0).margin(2e-10));
        CHECK(basis.values(t).sum() == Approx(1.0).epsilon(2e-12));
      }
    }
}
