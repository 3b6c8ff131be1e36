// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/shortest_text.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <random>
#include <string>

using namespace unfurl;

namespace {

std::string ours(double x) {
  char text[longest_number];
  return {text, shortest_text(x, text)};
}

// The standard library's own, by another algorithm.
std::string theirs(double x) {
  char text[longest_number];
  return {text, std::to_chars(text, text + longest_number, x).ptr};
}

}  // namespace

TEST_CASE("numbers have the shortest text that reads back, as the standard library writes it") {
  std::mt19937_64 random(20261122);
  int wrong = 0;
  const auto check = [&](double x) { wrong += ours(x) == theirs(x) ? 0 : 1; };
  for (int i = 0; i < 100'000; ++i) {
    check(std::bit_cast<double>(random()));  // of any size, NaN
    check(std::ldexp(static_cast<double>(random() >> 11U), -static_cast<int>(random() % 190)));
    check(static_cast<double>(random() % 1'000'000) * std::pow(10, -static_cast<int>(random() % 25)));
    check(-std::nextafter(std::ldexp(1.0, static_cast<int>(random() % 300) - 200), 0));  // uneven gaps
    check(std::ldexp(static_cast<double>(random() % 4096), static_cast<int>(random() % 120) - 60));
  }
  for (int power = -60; power < 25; ++power)
    for (int digit = 1; digit < 10; ++digit) {
      const double x = digit * std::pow(10, power);
      for (const double y : {x, std::nextafter(x, HUGE_VAL), std::nextafter(x, 0)}) check(y);
    }
  for (const double x : {0.0, -0.0, HUGE_VAL, -HUGE_VAL, 5e-324, 9007199254740991.0, 9007199254740993.0})
    check(x);
  CHECK(wrong == 0);
}
