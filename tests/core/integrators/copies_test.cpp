// SPDX-License-Identifier: BSD-3-Clause
// Structures that are joined with nothing do each what it does alone, however many there are.
#include <array>
#include <catch2/catch.hpp>
#include <sstream>
#include <utility>

#include "core/integrators/integrator.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace copies_test {

namespace {

// Bennett's loop, of rods that form its four links: it moves, though 14 lengths hold 12 coordinates.
std::string bennett_loops(int first, int end, double apart) {
  const std::array<std::pair<const char*, Vec3>, 8> nodes{{
      {"A1", {0, 0, -0.1}},
      {"A2", {0, 0, 0.1}},
      {"B1", {0.2816178659701636, 0.9616772518252036, -0.0766044443118978}},
      {"B2", {0.4024224206811742, 0.917707989746613, 0.0766044443118978}},
      {"C1", {-0.5898430596292608, -0.1809584357947804, 0.3793692317667702}},
      {"C2", {-0.65026692613533, -0.0623388399279029, 0.5286285625733748}},
      {"D1", {-1.5027138229377353, -0.0965925826289071, -0.0258819045102526}},
      {"D2", {-1.5027138229377353, 0.0965925826289066, 0.0258819045102516}},
  }};
  std::ostringstream text, rods;
  text.precision(17);
  text << "[structure]\nkind = 'custom'\nnodes = [\n";
  for (int k = first; k < end; ++k) {
    for (const auto& [name, x] : nodes)
      text << "{name = '" << name << "_" << k << "', position = [" << x[0] + apart * k << ", " << x[1] << ", "
           << x[2] << "], fixed = " << (name[0] < 'C' ? "true" : "false") << "},\n";
    for (const char* rod : {"C1-C2", "D1-D2", "B1-C1", "B1-C2", "B2-C1", "B2-C2", "C1-D1", "C1-D2", "C2-D1",
                            "C2-D2", "D1-A1", "D1-A2", "D2-A1", "D2-A2"})
      rods << "{nodes = ['" << std::string(rod, 2) << "_" << k << "', '" << rod + 3 << "_" << k
           << "'], mass = 0.3},\n";
  }
  text << "]\nrods = [\n"
       << rods.str() << "]\n[gravity]\nacceleration = [0, 0, -9.81]\n"
       << "[solver]\nstages = 6\nstep = 0.01\nend_time = 0.7\n";
  return text.str();
}

}  // namespace

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
