// SPDX-License-Identifier: BSD-3-Clause
// Which points of a table that is finer than steps are edges of a motion.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/structure/time_edges.hpp"

using namespace unfurl;

namespace table_edges_test {

namespace {

template <class Motion>
std::vector<double> inner_edges(const std::vector<double>& times, const Motion& motion) {
  std::vector<double> values;
  for (const double t : times) values.push_back(motion(t));
  Structure structure;
  structure.constraints.push_back({"measure", "drive", {}, {}, 0.0, {}, make_spline(times, values)});
  std::vector<double> found;
  for (const TimeEdge& edge : time_edges(structure, 0.5))
    if (edge.t > times.front() && edge.t < times.back()) found.push_back(edge.t);
  return found;
}

std::vector<double> even(double from, double to, int parts) {
  std::vector<double> times;
  for (int i = 0; i <= parts; ++i) times.push_back(from + (to - from) * i / parts);
  return times;
}

// At rest at 0.2 and 1.9; what of it is sampled finely has no corner.
double smooth(double t) {
  const double u = (t - 0.2) / 1.7;
  return 0.3 + 1.4 * u * u * u * (10 + u * (-15 + 6 * u));
}

}  // namespace

// Its third derivative jumps by 90 where it changes by 0.5 from one point to the next, and is up to 17
// itself.
TEST_CASE("a bend in a fine table is an edge and a longer stretch between its points is none") {
  std::vector<double> times = even(0.2, 1.9, 340);
  CHECK(inner_edges(times, smooth).empty());
  const double at = times[140];
  const auto bent = [&](double t) {
    const double on = std::max(0.0, t - at), whole = 1.9 - at, u = on / whole;
    return smooth(t) + 15 * on * on * on * (1 - u) * (1 - u) * (1 + 2 * u);
  };
  CHECK(inner_edges(times, bent) == std::vector{at});
  // Without four points in a row, where the third derivative moves by five times as much.
  times.erase(times.begin() + 200, times.begin() + 204);
  CHECK(inner_edges(times, smooth).empty());
  CHECK(inner_edges(times, bent) == std::vector{at});
}

}  // namespace table_edges_test
