// SPDX-License-Identifier: BSD-3-Clause
// Structures that are joined with nothing do each what it does alone, however many there are.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/bennett_loops.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace copies_test {

// Up to 5 m from the origin coordinates are rounded to 9e-16 m, which redundant rows make some 50 times of:
// 1e-13 m (4e-14 here). 40 copies in one scene were 7e-11 m off.
TEST_CASE("each of forty loops with redundant rods moves as one alone") {
  constexpr int half = 20;
  constexpr double apart = 0.25;
  const Simulation one = run_scene(bennett_loops(0, 1, apart)),
                   many = run_scene(bennett_loops(-half, half, apart));
  REQUIRE(one.status == RunStatus::completed);
  REQUIRE(many.status == RunStatus::completed);
  const VectorXd alone = end_positions(one), all = end_positions(many);
  double off = 0;
  for (Index k = 0; k < 2 * half; ++k)
    for (Index i = 0; i < alone.size(); ++i) {
      const double along = i % 3 == 0 ? apart * static_cast<double>(k - half) : 0.0;
      off = std::max(off, std::abs(all[k * alone.size() + i] - alone[i] - along));
    }
  CHECK(off < 1e-12);
}

}  // namespace copies_test
