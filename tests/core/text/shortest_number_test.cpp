// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/shortest_number.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <random>
#include <string>

using namespace unfurl;

namespace shortest_number_test {
namespace {

std::string ours(double x) {
  char text[31];
  return {text, write_shortest(text, x)};
}

std::string standard(double x) {
  char text[31];
  return {text, std::to_chars(text, text + sizeof text, x).ptr};
}

}  // namespace

TEST_CASE("numbers have the bytes of std::to_chars") {
  std::mt19937_64 random(20261122);
  std::string wrong;
  const auto check = [&](double x) {
    if (x > 0 && std::isfinite(x) && ours(x) != standard(x)) wrong += standard(x) + " ";
  };
  const double step = std::nextafter(1.0, 2.0) - 1.0;
  for (int i = 0; i < 200000; ++i) {
    check(std::bit_cast<double>(random()));  // of any size
    check(std::ldexp(static_cast<double>(random() >> 11U), static_cast<int>(random() % 190) - 188));
    check(static_cast<double>(random() >> (random() % 64)));  // whole numbers
    check(static_cast<double>(random() % 100000) / 1000);     // few digits
    check(static_cast<double>(random() % 100000) / 64);
    check(static_cast<double>(random() % 1000) * std::pow(10.0, static_cast<int>(random() % 60) - 40));
  }
  for (int e = -1074; e < 1024; ++e)  // where the neighbours are not equally far
    for (const double factor : {1.0, 1.0 + step, 1.0 - 0.5 * step, 1.5}) check(std::ldexp(factor, e));
  CHECK(wrong.empty());
}

TEST_CASE("what is written reads as the same number again, and nothing shorter does") {
  CHECK(ours(0.3) == "0.3");
  CHECK(ours(1e-5) == "1e-05");
  CHECK(ours(0.00012) == "0.00012");  // as long as 1.2e-04
  CHECK(ours(1e-4) == "1e-04");
  CHECK(ours(123456) == "123456");
  CHECK(ours(5e22) == "5e+22");
  CHECK(ours(2.5e-7) == "2.5e-07");
}

}  // namespace shortest_number_test
