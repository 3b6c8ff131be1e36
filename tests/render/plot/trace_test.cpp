// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/trace.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "render/plot/limits.hpp"
#include "render/plot/placement.hpp"

namespace unfurl::plot {

namespace trace_test {

namespace {
const double nan = std::nan("");
Scale linear(double lo, double hi, double length) {
  return {lo, hi, 0, length, false};
}
}  // namespace

TEST_CASE("scales map values to the page", "[trace]") {
  const Scale x{0, 10, 100, 300, false};
  CHECK(x(0) == 100);
  CHECK(x(10) == 300);
  CHECK(x(2.5) == 150);
  const Scale y{1e-16, 1e-12, 200, 0, true};
  CHECK(y(1e-14) == Approx(100).epsilon(1e-12));
  CHECK(std::isfinite(Scale{-1e300, 1e300, 0, 100, false}(1e300)));
  CHECK(Scale{1e-300, 1e300, 0, 600, true}(1.0) == Approx(300).epsilon(1e-12));
}

TEST_CASE("NaN, infinities and missing partners break a line", "[trace]") {
  const auto pieces =
      trace({0, 1, 2, 3, 4, 5}, {1, 2, nan, 4, INFINITY}, {linear(0, 5, 50), linear(0, 5, 50)});
  REQUIRE(pieces.size() == 2);
  CHECK(pieces[0].size() == 2);
  CHECK(pieces[1].size() == 1);
}

TEST_CASE("log axes leave out what is not positive, and floor exact zeros where asked", "[trace]") {
  TraceRules rules{linear(0, 4, 40), {1e-3, 1, 90, 0, true}};
  CHECK(trace({0, 1, 2}, {0.1, 0, 0.1}, rules).size() == 2);
  CHECK(trace({0, 1, 2}, {0.1, -1, 0.1}, rules).size() == 2);
  rules.zeros_at_floor = true;
  const auto floored = trace({0, 1, 2}, {0.1, 0, 0.1}, rules);
  REQUIRE(floored.size() == 1);
  CHECK(floored[0][1].y == 90);
  CHECK(trace({0, 1, 2}, {0.1, -1, 0.1}, rules).size() == 2);
}

TEST_CASE("thinning keeps every spike and the shape of every column", "[trace]") {
  Polyline line;
  for (int i = 0; i < 100000; ++i) line.push_back({i * 1e-3, 5 + std::sin(i * 0.37)});
  line[54321].y = 99;
  const Polyline thin = thinned(line, 0.25);
  CHECK(thin.size() <= 4 * 401);  // 100 points of page in columns of a quarter
  CHECK(thin.size() >= 2 * 400);  // first and last, where these are the extremes
  CHECK(std::any_of(thin.begin(), thin.end(),
                    [](const Point& p) { return p.y == 99 && p.x == Approx(54.321); }));
  CHECK(std::is_sorted(thin.begin(), thin.end(), [](const Point& a, const Point& b) { return a.x < b.x; }));
  CHECK(thin.front().x == line.front().x);
  CHECK(thin.back().x == line.back().x);
  const Polyline few{{0, 1}, {0.1, 2}, {0.2, 3}};
  CHECK(thinned(few, 0.25).size() == 3);
}

TEST_CASE("a band keeps its widest extent", "[trace]") {
  std::vector<double> x, low, high;
  for (int i = 0; i < 20000; ++i)
    x.push_back(i * 5e-5), low.push_back(i == 7777 ? -4 : -1), high.push_back(i == 8888 ? 4 : 1);
  const BandTrace band = trace_band(x, low, high, {linear(0, 1, 100), {-5, 5, 100, 0, false}});
  REQUIRE(band.lower.size() == 1);
  CHECK(band.lower[0].size() == band.upper[0].size());
  CHECK(band.lower[0].size() < 1000);
  CHECK(std::max_element(band.lower[0].begin(), band.lower[0].end(), [](Point a, Point b) {
          return a.y < b.y;
        })->y == Approx(90));
  CHECK(std::min_element(band.upper[0].begin(), band.upper[0].end(), [](Point a, Point b) {
          return a.y < b.y;
        })->y == Approx(10));
  CHECK(trace_band({0, 1, 2}, {0, nan, 0}, {1, 1, 1}, {linear(0, 2, 9), linear(0, 1, 9)}).lower.size() == 2);
}

TEST_CASE("axis limits are usable whatever the data", "[limits]") {
  const auto limits = [](std::vector<double> y, bool log, bool floor = false) {
    Panel p;
    p.y.log = log;
    p.y.zeros_at_floor = floor;
    Curve c;
    c.x.assign(y.size(), 1.0);
    c.y = std::move(y);
    p.curves.push_back(c);
    return axis_limits(p, AxisOf::y);
  };
  for (const bool log : {false, true}) {
    for (const auto& y : std::vector<std::vector<double>>{{},
                                                          {0},
                                                          {0, 0},
                                                          {nan},
                                                          {INFINITY, -INFINITY},
                                                          {1e308, -1e308},
                                                          {5e-324},
                                                          {3, 3, 3},
                                                          {1, 1 + 1e-15},
                                                          {-2, -1},
                                                          {1e-300, 1e300}}) {
      const Limits l = limits(y, log);
      CHECK(std::isfinite(l.hi - l.lo));
      CHECK(l.lo < l.hi);
      if (log) CHECK(l.lo > 0);
    }
  }
  CHECK(limits({3e-16, 5e-13}, true).lo == Approx(1e-16).epsilon(1e-12));  // whole decades
  CHECK(limits({3e-16, 5e-13}, true).hi == Approx(1e-12).epsilon(1e-12));
  CHECK(limits({1e-16, 1e-13, 0}, true, true).lo ==
        Approx(1e-17).epsilon(1e-12));  // room for the floor below the data
  // Where there is nothing but zeros, at zero, as a quantity that cannot be negative has it: no tick below
  // it.
  CHECK(limits({0, 0}, false).lo == Approx(-0.05).epsilon(0).margin(1e-12));
  CHECK(limits({0, 0}, false).hi == Approx(1.05).epsilon(0).margin(1e-12));
  const Limits padded = limits({0, 10}, false);
  CHECK(padded.lo < 0);
  CHECK(padded.hi > 10);
}

TEST_CASE("the length of a line inside a box", "[placement]") {
  const Rect box{0, 0, 10, 10};
  CHECK(length_inside({-5, 5}, {15, 5}, box) == Approx(10));
  CHECK(length_inside({0, 0}, {10, 10}, box) == Approx(std::sqrt(200.0)));
  CHECK(length_inside({2, 2}, {5, 6}, box) == Approx(5));
  CHECK(length_inside({-5, 11}, {15, 11}, box) == 0);
  CHECK(length_inside({-1, 5}, {-1, 6}, box) == 0);
  CHECK(length_inside({3, 3}, {3, 3}, box) == 0);
}

TEST_CASE("a legend goes where nothing is hidden", "[placement]") {
  Obstacles obstacles;
  obstacles.add_line({{0, 0}, {100, 0}, {100, 100}});  // the upper and right edges
  const Spot spot = free_spot(obstacles, {0, 0, 100, 100}, 30, 20);
  CHECK(spot.hidden == 0);
  CHECK(spot.box.y1 == Approx(100));  // a lower corner
  obstacles.add_box({0, 0, 100, 100});
  CHECK(free_spot(obstacles, {0, 0, 100, 100}, 30, 20).hidden >= touches_text);
}

}  // namespace trace_test

}  // namespace unfurl::plot
