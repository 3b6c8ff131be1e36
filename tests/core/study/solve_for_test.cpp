// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/study/solve_for.hpp"

using namespace unfurl;

namespace solve_for_test {

namespace {
constexpr double none = std::numeric_limits<double>::quiet_NaN();
}

TEST_CASE("a root is bracketed from where the search starts") {
  const Solved s = solve_for([](double x) { return x * x * x; }, 27, {.start = 1}, {});
  CHECK(s.x == Approx(3).epsilon(1e-11));
  CHECK(s.evaluations.size() < 40);
}

TEST_CASE("a root between two ends is found on either side of where the scene stands") {
  const auto f = [](double x) { return x * x - 7.3; };
  for (const double start : {1.1, 5.9}) {
    const Solved s = solve_for(f, 0, {.start = start, .low = 1.3, .high = 4.7}, {});
    CHECK(s.x == Approx(std::sqrt(7.3)).epsilon(1e-11));
    for (const Evaluation& e : s.evaluations) CHECK((e.x >= 1.3 && e.x <= 4.7));
  }
  const Solved exact =
      solve_for([](double x) { return 3 * x; }, 7.5, {.start = 2.5, .f_tolerance = 1e-12}, {});
  CHECK(exact.x == 2.5);
  CHECK(exact.low == 2.5);
  CHECK(exact.high == 2.5);
}

TEST_CASE("the search approaches a wall behind which parameters are invalid") {
  // Like the deployment time near dead centre: it grows without end towards 90.
  const auto f = [](double x) { return x < 90 ? -std::log(90 - x) : none; };
  const Solved s = solve_for(f, std::log(1e6), {.start = 60}, {});
  CHECK(90 - s.x == Approx(1e-6).epsilon(1e-5));  // x is good to 1e-12 of 90
}

TEST_CASE("a target out of reach is told with what was reached") {
  CHECK_THROWS_WITH(solve_for([](double x) { return 1 / (1 + x * x); }, 2, {.start = 1}, {}),
                    Catch::Contains("the target is not reached on either side of 1"));
  CHECK_THROWS_WITH(solve_for([](double x) { return x; }, 9, {.low = 0, .high = 1}, {}),
                    Catch::Contains("does not lie between the ends of --between"));
  CHECK_THROWS_AS(solve_for([](double) { return none; }, 9, {.start = 1}, {}), NotFound);
  CHECK_THROWS_WITH(solve_for([](double x) { return 5 - x * x; }, 100, {.low = 1.3, .high = 4.7}, {}),
                    Catch::Contains("for parameters from 1.3 to 4.7 the measure runs from -17.09 to 3.31"));
  CHECK_THROWS_WITH(
      solve_for([](double x) { return x; }, 9, {.start = 1, .most = 3}, {}),
      Catch::Contains("no answer after 3 runs; for parameters from 0.98 to 1.02 the measure runs "
                      "from 0.98 to 1.02"));
}

TEST_CASE("a jump over the target is no root") {
  CHECK_THROWS_WITH(solve_for([](double x) { return x < 2 ? 0.0 : 10.0; }, 5, {.start = 1}, {}),
                    Catch::Contains("jumps over the target at 2"));
}

}  // namespace solve_for_test
