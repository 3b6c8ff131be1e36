// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/twofold.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

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

TEST_CASE("two twofold numbers at once have the bits of one after the other") {
  typedef double Pair __attribute__((vector_size(16)));
  using Two = TwofoldOf<Pair>;
  std::mt19937 random(20261122);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto number = [&] {
    return Twofold(std::ldexp(uniform(random), static_cast<int>(random() % 60) - 30)) +
           Twofold(std::ldexp(uniform(random), -70));
  };
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const Twofold a[2] = {number(), number()}, b[2] = {number(), number()}, c[2] = {number(), number()};
    const auto both = [](const Twofold* x) {
      return Two::of(Pair{x[0].hi, x[1].hi}, Pair{x[0].lo, x[1].lo});
    };
    const Two left = both(a) - both(b) * both(c);
    for (int k = 0; k < 2; ++k) {
      const Twofold alone = a[k] - b[k] * c[k];
      wrong += left.hi[k] == alone.hi && left.lo[k] == alone.lo ? 0 : 1;
    }
  }
  CHECK(wrong == 0);
}

namespace twofold_test {

struct Products {
  Twofold one;
  TwofoldPair two;
};

template <bool fused>
#if defined(__x86_64__)
[[gnu::target("fma"), gnu::flatten, gnu::noinline]]
#endif
void multiply(const Twofold* a, const Twofold* b, Products& out) {
  out.one = Twofold::times<fused>(a[0], b[0]);
  out.two = TwofoldPair::times<fused>(both(a[0], a[1]), both(b[0], b[1]));
}

TEST_CASE("fused products of twofold numbers have the bits of those that are split") {
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("fma")) {
    SUCCEED("no such instruction here, none is used");
    return;
  }
#endif
  std::mt19937 random(20261124);
  std::uniform_real_distribution<double> uniform(-1, 1);
  // Where a part of the split product falls below 1e-308 the two may differ: 2^-200 is far from that.
  const auto number = [&] {
    const double high = std::ldexp(uniform(random), static_cast<int>(random() % 400) - 200);
    return Twofold(high) + Twofold(std::ldexp(high, -55) * uniform(random));
  };
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const Twofold a[2] = {number(), number()}, b[2] = {number(), number()};
    Products split, fused;
    multiply<false>(a, b, split);
    multiply<true>(a, b, fused);
    wrong += split.one.hi == fused.one.hi && split.one.lo == fused.one.lo ? 0 : 1;
    for (int k = 0; k < 2; ++k)
      wrong += split.two.hi[k] == fused.two.hi[k] && split.two.lo[k] == fused.two.lo[k] ? 0 : 1;
  }
  CHECK(wrong == 0);
}

}  // namespace twofold_test
