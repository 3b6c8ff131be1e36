// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/twofold.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace unfurl;

TEST_CASE("twofold numbers keep what doubles round away") {
  const double small = std::ldexp(1.0, -70);
  const Twofold x = Twofold(1.7) + Twofold(small);
  CHECK(static_cast<double>(x - Twofold(1.7)) == small);
  // (a + e)^2 - a^2 = 2 a e + e^2, of which the square is below 2^-104 of the product.
  const Twofold square = x * x;
  CHECK(static_cast<double>(square - Twofold(1.7) * Twofold(1.7)) == Approx(2 * 1.7 * small).epsilon(1e-9));
  for (const double a : {3.0, -0.7, 1.3e-20, 4.1e15}) {
    const Twofold number = Twofold(a) * x;
    // A Newton step squares the error of the double, 1e-16; products add some 2^-104 = 5e-32.
    CHECK(std::abs(static_cast<double>(number * inverse(number) - Twofold(1.0))) <= 1e-30);
  }
}
