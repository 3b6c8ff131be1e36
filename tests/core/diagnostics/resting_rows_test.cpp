// SPDX-License-Identifier: BSD-3-Clause
// One freedom that several things hold at rest: how they share is nobody's to say.
#include "core/diagnostics/resting_rows.hpp"

#include <catch2/catch.hpp>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace resting_rows_test {

using testing::run_scene;

namespace {

// A slider-crank under its weight, and beside it a bracket of two rods, which nothing else holds.
const std::string slider_crank = R"(
[structure]
kind = "custom"
nodes = [{ name = "A", fixed = true, position = [0, 0, 0] }, { name = "G", fixed = true, position = [1, 0, 0] },
  { name = "B", position = [0.3, 0, -0.2] }, { name = "C", mass = 0.5, position = [1.2, 0, 0] },
  { name = "L", fixed = true, position = [0, 0, 1] }, { name = "R", fixed = true, position = [0, 0, 2] },
  { name = "T", mass = 1, position = [1, 0, 1] }]
rods = [{ name = "crank", nodes = ["A", "B"], mass = 1 }, { name = "con", nodes = ["B", "C"], mass = 2 },
  { name = "strut", nodes = ["L", "T"], mass = 0 }, { name = "tie", nodes = ["R", "T"], mass = 0 }]
constraints = [{ kind = "plane", nodes = ["B", "T"], normal = [0, 1, 0] },
  { kind = "line", nodes = ["C"], direction = [1, 0, 0] }]
[gravity]
acceleration = [0, 0, -10]
[solver]
step = 0.05
end_time = 0.5
)";
const std::string hinge =
    "[[forces]]\nkind = 'friction'\nname = 'hinge'\nnodes = ['G', 'A', 'B']\naxis = [0, 1, 0]\nkinetic = "
    "50\n";
const std::string slide =
    "[[forces]]\nkind = 'friction'\nname = 'slide'\nnodes = ['C']\ndirection = [1, 0, 0]\nkinetic = 200\n";
const std::string floor_under_crank =
    "[[constraints]]\nkind = 'coordinate_stop'\nname = 'floor'\nnodes = ['B']\ndirection = [0, 0, 1]\n"
    "min = -0.2\n";
const std::string wall =
    "[[constraints]]\nkind = 'coordinate_stop'\nname = 'wall'\nnodes = ['C']\ndirection = [1, 0, 0]\nmin = "
    "1.2\nmax = 1.2\n";
std::string drive(double by) {  // of the slider, from its place at the start in 0.3 s
  return "[[constraints]]\nkind = 'coordinate'\nname = 'motor'\nnodes = ['C']\ndirection = [1, 0, 0]\nmotion "
         "= 'smooth'\nto = " +
         testing::number(1.2 + by) + "\nduration = 0.3\n";
}

// Of every state from `first` on, whether the forces of the crank's rods and reactions are called unique;
// those of the bracket always are.
struct Said {
  bool any = false, all = true;
  void add(double flag) { flag == 1.0 ? any = true : all = false; }
};
Said of_crank(const std::string& holds, double first = 0.0, double last = 1.0) {
  const Simulation run = run_scene(slider_crank + holds);
  const Diagnostics d = diagnose(run);
  Said said;
  for (std::size_t i = 0; i < d.t.size(); ++i) {
    const auto row = static_cast<Index>(i);
    CHECK(d.force_unique(row, 2));
    CHECK(d.force_unique(row, 3));
    CHECK(d.at("L.reaction_unique").values[i] == 1.0);
    if (d.t[i] < first || d.t[i] > last) continue;
    said.add(d.force_unique(row, 0) ? 1.0 : 0.0);
    said.add(d.force_unique(row, 1) ? 1.0 : 0.0);
    for (const char* node : {"A", "C"}) said.add(d.at(std::string(node) + ".reaction_unique").values[i]);
  }
  return said;
}

}  // namespace

TEST_CASE("forces of what two frictions or stops hold at rest are not unique, whatever comes first") {
  CHECK_FALSE(of_crank(hinge + slide).any);
  CHECK_FALSE(of_crank(slide + hinge).any);
  CHECK_FALSE(of_crank(floor_under_crank + slide).any);
  CHECK_FALSE(of_crank(slide + floor_under_crank).any);
  CHECK_FALSE(of_crank(floor_under_crank + wall).any);
}

TEST_CASE("what one friction or stop holds alone has unique forces") {
  CHECK(of_crank(hinge).all);
  CHECK(of_crank(slide).all);
  CHECK(of_crank(floor_under_crank).all);
  CHECK(of_crank(wall).all);  // two sides of one stop: their sum is
}

TEST_CASE("a drive at rest shares with the friction it has moved, and with a stop that it has met") {
  const std::string resisted = drive(0.05) + hinge;
  CHECK(of_crank(resisted, 0.05, 0.25).all);  // slips
  CHECK_FALSE(of_crank(resisted, 0.35).any);
  CHECK(of_crank(drive(0.05) + wall.substr(0, wall.find("max")), 0.05).all);  // it is left behind
  const std::string ceiling =
      "[[constraints]]\nkind = 'coordinate_stop'\nname = 'end'\nnodes = ['B']\ndirection = [1, 0, 0]\nmax = ";
  CHECK(of_crank(drive(0.05) + ceiling + "0.6\n").all);  // out of reach
  const Simulation run = run_scene(slider_crank + drive(0.05));
  const double end = testing::end_positions(run)[3 * 2];
  CHECK_FALSE(of_crank(drive(0.05) + ceiling + testing::number(end) + "\n", 0.35).any);
}

TEST_CASE(
    "the effort of a drive at rest beside friction on the same slider is not unique, the rods' forces are") {
  const Simulation run = run_scene(slider_crank + drive(0.05) + slide);
  const Diagnostics d = diagnose(run);
  for (std::size_t i = 0; i < d.t.size(); ++i) {
    INFO("t = " << d.t[i]);
    if (d.t[i] > 0.04 && d.t[i] < 0.26) CHECK(d.at("motor.force_unique").values[i] == 1.0);
    if (d.t[i] > 0.34) CHECK(d.at("motor.force_unique").values[i] == 0.0);
    if (d.t[i] > 0.34) CHECK(d.force_unique(static_cast<Index>(i), 1));
  }
}

}  // namespace resting_rows_test
