// SPDX-License-Identifier: BSD-3-Clause
// Published digits: what `unfurl reproduce --validation` prints.
#include "core/study/validation.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/math/types.hpp"

using namespace unfurl;

TEST_CASE("published benchmarks are met to the digits that they print") {
  StudyHooks hooks;
  std::vector<double> told{0};
  hooks.progress = [&](double share) {
    CHECK(share >= told.back());
    CHECK(share - told.back() <= 0.45);  // no one waits for long without hearing
    told.push_back(share);
  };
  const auto rows = validate(hooks);
  CHECK(told.back() == 1);
  CHECK(rows.size() >= 14);
  const Table table = validation_table(rows);
  REQUIRE(table.rows.size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {  // two digits of these
    CHECK(number_of(table.rows[i].at(3)) == rows[i].ours);
    CHECK(number_of(table.rows[i].at(4)) == Approx(rows[i].difference()).epsilon(0.06));
    CHECK(number_of(table.rows[i].at(5)) == Approx(rows[i].allowed).epsilon(0.06));
  }
  for (const ValidationRow& row : rows) {
    INFO(row.problem << ", " << row.quantity << ": " << row.ours << ", published " << row.published);
    CHECK(row.holds());
  }
}

namespace validation_test {

namespace {

// Half of an elastic catenary of weight w = 30 N/m and E A = 5e7 N, 105 m long over 100 m: its half width is
// x = H s / E A + (H / w) asinh(w s / H), and its sag w s^2 / (2 E A) + (sqrt(H^2 + w^2 s^2) - H) / w.
double catenary_sag() {
  const double w = 30, EA = 5e7, s = 52.5;
  double low = 10, high = 1e5;
  for (int i = 0; i < 200; ++i) {
    const double h = 0.5 * (low + high);
    (h * s / EA + h / w * std::asinh(w * s / h) > 50 ? high : low) = h;
  }
  return w * s * s / (2 * EA) + w * s * s / (std::hypot(low, w * s) + low);
}

}  // namespace

// What the rows print as published, by closed forms, to half of the last digit.
TEST_CASE("elements of every kind are among the benchmarks, with the digits of their closed forms") {
  // P(h) = 2 E A h (1 / l - 1 / l_0), largest where l^3 = l_0 (half span 1). A unit in the last place of l,
  // which is what a cube root may miss, is l / h = 7 of them in h.
  const double l0 = std::sqrt(1.0625), l = std::cbrt(l0), height = std::sqrt(l * l - 1),
               omega = std::sqrt(9.81 / 2.3);
  struct Truth {
    const char* quantity;
    double value, off;
  };
  const Truth truths[] = {{"limit load (N)", 2 * height * (1 / l - 1 / l0), 1e-16},
                          {"height there (m)", height, 2.5e-15},
                          {"tension left behind 12 of them", std::exp(-0.6 * pi), 5e-10},
                          {"tension left behind 30 of them", std::exp(-1.5 * pi), 5e-10},
                          {"x where it first turns (m)", 2 - (0.495 - 0.02), 1e-15},
                          {"x where it comes to rest (m)", 2 + 0.005, 1e-15},
                          {"time of rest, 2.5 pi (s)", 2.5 * pi, 1e-15},
                          {"x at 4 s (m)", 0.4 + 0.3 * std::sin(4 * omega) / omega, 1e-15},
                          {"height at mid-span (m)", -catenary_sag(), 1e-13}};
  const auto rows = validate({});
  for (const Truth& truth : truths) {
    INFO(truth.quantity);
    const auto row = std::ranges::find(rows, truth.quantity, &ValidationRow::quantity);
    REQUIRE(row != rows.end());
    CHECK(std::abs(number_of(row->published) - truth.value) <= truth.off);
  }
  for (const char* problem : {"cantilever, P L^2 / E I = 1", "cantilever, P L^2 / E I = 2",
                              "cantilever, P L^2 / E I = 5", "free top, I = (1, 2, 3) kg m^2",
                              "arms on trolleys that follow", "ring of six units coupled by gears"})
    CHECK(std::ranges::count(rows, problem, &ValidationRow::problem) >= 1);
}

}  // namespace validation_test

TEST_CASE("a benchmark that was not reached does not hold") {
  ValidationRow row{"", "", "", "1.25", std::nan(""), 1e9};
  CHECK_FALSE(row.holds());
  row.ours = 1.5;
  CHECK(row.difference() == 0.25);
  CHECK(row.holds());
  row.allowed = 0.2;
  CHECK_FALSE(row.holds());
}
