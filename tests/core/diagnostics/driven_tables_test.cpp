// SPDX-License-Identifier: BSD-3-Clause
// Which tables that prescribe motions have points within a step that its ends and three points do not tell
// of.
#include "core/diagnostics/driven_tables.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace driven_tables_test {

namespace {

// A smooth way of that size, at rest at both ends of 1 s, sampled in steps of 0.2 ms; rounded to a share of
// it.
std::string table(double begin, double size, double rounded_to) {
  std::string times, values;
  char text[64];
  for (int k = 0; k <= 5000; ++k) {
    const double u = k / 5000.0;
    double share = u * u * u * (10 - 15 * u + 6 * u * u);
    if (rounded_to > 0) share = std::round(share / rounded_to) * rounded_to;
    std::snprintf(text, sizeof text, "%.17g", begin + u);
    times += (k > 0 ? ", " : "") + std::string(text);
    std::snprintf(text, sizeof text, "%.17g", size * share);
    values += (k > 0 ? ", " : "") + std::string(text);
  }
  return "[[constraints]]\nkind = 'coordinate'\nname = 'led'\nnodes = ['A']\ndirection = [1, 0, 0]\n"
         "motion = 'table'\ntimes = [" +
         times + "]\nvalues = [" + values + "]\n";
}

DrivenTables tables(double begin, double size, double rounded_to) {
  return DrivenTables(testing::model_of("[structure]\nkind = 'custom'\n"
                                        "nodes = [{name = 'A', position = [0, 0, 0], mass = 1}]\n" +
                                        table(begin, size, rounded_to))
                          ->structure);
}

}  // namespace

// Of u^3 (10 - 15 u + 6 u^2) the work against inertia is of degree 7, two beyond three Gauss points, whose
// error is 1e-9 here; the spline's second derivative is 1e-6 off.
TEST_CASE("steps follow a table of a smooth motion whichever way and whenever it goes") {
  for (const double begin : {0.0, 3.25})
    for (const double size : {1.0, -1.0, 0.004, -900.0}) {
      const DrivenTables smooth = tables(begin, size, 0), rounded = tables(begin, size, 1e-4);
      INFO(begin << " s, " << size << " m");
      for (const double from : {0.1205, 0.3705, 0.4805, 0.7305, 0.9005}) {
        const double to = from + 0.04;
        INFO("from " << from);
        CHECK(smooth.points_within(begin + from, begin + to).empty());
        const std::vector<double> points = rounded.points_within(begin + from, begin + to);
        REQUIRE(points.size() == 200);
        for (std::size_t k = 0; k < 200; ++k)
          CHECK(points[k] ==
                Approx(begin + from + 0.0001 + 0.0002 * static_cast<double>(k)).epsilon(0).margin(1e-9));
      }
      CHECK(rounded.points_within(begin + 0.48001, begin + 0.48019).empty());  // between two points
      CHECK(smooth.words(0.00015).empty());
      CHECK(smooth.words(0.01) ==
            "the table of led has 50 points within a step: solver.step = 0.0002 follows them");
    }
}

}  // namespace driven_tables_test
