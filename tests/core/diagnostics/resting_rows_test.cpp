// SPDX-License-Identifier: BSD-3-Clause
// One freedom that several things hold at rest: how they share is nobody's to say.
#include "core/diagnostics/resting_rows.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "core/path/path_run.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/singular_poses.hpp"
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

// 1.1 kg hang from a point; their weight is what all that pulls gives together.
TEST_CASE("taut cables side by side, or beside a rod, share as they like, one alone does not") {
  const std::string hung = R"(
[structure]
kind = "custom"
nodes = [{ name = "A", fixed = true, position = [0, 0, 0] }, { name = "B", mass = 1.1, position = [0, 0, -1] }]
[[constraints]]
kind = "cable"
name = "one"
nodes = ["A", "B"]
[gravity]
acceleration = [0, 0, -10]
[solver]
end_time = 0.2
)";
  const std::string two = "[[constraints]]\nkind = 'cable'\nname = 'two'\nnodes = ['A', 'B']\n";
  const auto flags = [&](const std::string& text, const char* column) {
    const Diagnostics d = diagnose(run_scene(text));
    double least = 1, most = 0;
    for (const double flag : d.at(column).values) least = std::min(least, flag), most = std::max(most, flag);
    CHECK(least == most);
    for (const double pull : d.at("one.force_N").values) CHECK(pull + 11 >= -1e-9);
    CHECK(d.at("A.reaction_z_N").values.back() == Approx(11));
    CHECK(d.at("A.reaction_unique").values.back() == 1.0);
    return most;
  };
  CHECK(flags(hung, "one.force_unique") == 1.0);
  CHECK(flags(hung + two, "one.force_unique") == 0.0);
  CHECK(flags(hung + two, "two.force_unique") == 0.0);
  CHECK(flags(hung + two + "length = 1.5\n", "one.force_unique") == 1.0);  // slack
  CHECK(flags(hung + two + "length = 1.5\n", "two.force_unique") == 1.0);
  const std::string rod = "[[structure.rods]]\nnodes = ['A', 'B']\nmass = 0\n";
  CHECK(flags(hung + rod, "one.force_unique") == 0.0);
  const Diagnostics d = diagnose(run_scene(hung + rod));
  CHECK_FALSE(d.force_unique(2, 0));
}

// Load and stop act on the same node: nothing passes through the rod, at no time.
TEST_CASE("what rests on a stop from the start has no row of the forces that it would have without") {
  const std::string pushed = R"(
[structure]
kind = "custom"
nodes = [{ name = "P1", position = [0, 0, 0], mass = 1 }, { name = "P2", position = [1, 0, 0], mass = 1 }]
rods = [{ name = "rod", nodes = ["P1", "P2"], mass = 0 }]
[[constraints]]
kind = "line"
nodes = ["P*"]
direction = [1, 0, 0]
[[constraints]]
kind = "coordinate_stop"
name = "stop"
nodes = ["P2"]
direction = [1, 0, 0]
max = 1
[[loads]]
nodes = ["P2"]
force = [100, 0, 0]
[solver]
end_time = 0.05
)";
  for (const char* model : {"full", "path"}) {
    const Scene scene = read_scene_text(pushed, "s.toml", {});
    const auto built = build_model(scene);
    const Simulation run =
        std::string(model) == "path" ? simulate_on_path(built, scene.solver) : simulate(built, scene.solver);
    INFO(model);
    const Diagnostics d = diagnose(run);
    CHECK(run.trajectory.time(1) > 0);
    CHECK(d.axial_force.cwiseAbs().maxCoeff() <= 1e-9);
    REQUIRE(run.events.size() == 1);
    CHECK(run.events[0].name == "rests on stop stop");
    CHECK(d.at("P2.reaction_x_N").values.front() == Approx(-100));
  }
}

TEST_CASE("a rod with a modulus between held nodes is a run without motion") {
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [{ name = "A", fixed = true, position = [0, 0, 0] }, { name = "B", fixed = true, position = [1, 0, 0] }]
rods = [{ nodes = ["A", "B"], mass = 1, area = 1e-4, youngs_modulus = 1e10 }]
)");
  CHECK(run.trajectory.size() > 2);
  CHECK(find_singular_poses(run.trajectory).empty());
  CHECK(diagnose(run).axial_force.rows() > 0);
}

// A spline through 0, 0.1 and 0.3 m at 0, 0.2 and 0.5 s sets out with 6.5 m/s^2: 5 N of friction and half of
// 2 kg are on the rod from the first state on, 18 N on the drive, and nothing holds.
TEST_CASE("a drive that sets out against friction has unique forces from the start") {
  const Simulation run = run_scene(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0]}, {name = "B", position = [1, 0, 0]}]
rods = [{nodes = ["A", "B"], mass = 2}]
constraints = [{kind = "line", nodes = ["A", "B"], direction = [1, 0, 0]},
  {kind = "coordinate", name = "push", nodes = ["A"], direction = [1, 0, 0], motion = "table", times = [0, 0.2, 0.5], values = [0, 0.1, 0.3]}]
[[forces]]
kind = "friction"
nodes = ["B"]
direction = [1, 0, 0]
kinetic = 5
[solver]
end_time = 0.1
)");
  const Diagnostics d = diagnose(run);
  CHECK(d.axial_force(0, 0) == Approx(-11.5).epsilon(1e-9));
  CHECK(d.at("push.force_N").values.front() == Approx(18).epsilon(1e-9));
  for (const char* name : {"push.force_unique", "axial_force_min_unique", "A.reaction_unique"}) {
    INFO(name);
    for (const double unique : d.at(name).values) CHECK(unique == 1.0);
  }
}

// Frictions come first, of a hinge by its pin alone too, then both sides of a stop and the cable that is
// drawn.
TEST_CASE("rows of what rests are told apart by what it is") {
  const auto model = testing::model_of(R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "E", position = [-1, 0, 0], fixed = true},
         {name = "A", position = [1, 0, 0], mass = 1}, {name = "B", position = [0, 1, 0], mass = 1}]
rods = [{nodes = ["O", "A"], mass = 1}]
[[forces]]
kind = "friction"
nodes = ["A", "O", "E"]
axis = [0, 0, 1]
kinetic = 0
pin_friction = 0.2
pin_radius = 0.01
[[forces]]
kind = "friction"
nodes = ["B"]
direction = [0, 1, 0]
kinetic = 2
[[constraints]]
kind = "coordinate_stop"
nodes = ["B"]
direction = [0, 1, 0]
min = 0.2
max = 1.7
[[constraints]]
kind = "cable"
nodes = ["A", "B"]
motion = "rate"
rate = -0.1
)");
  const RestingRows rows(*model);
  const State start = initial_state(model->structure, model->system).state;
  CHECK(rows.at(start, nullptr, 0.01).size() == 5);
  CHECK(rows.cables({1, 1, 1, 1, 1}) == std::vector{-1, -1, -1, -1, 2});
  CHECK(rows.cables({1, 0, 0, 1, 1}) == std::vector{-1, -1, 2});
  CHECK(rows.cables({0, 0, 0, 0, 0}).empty());
  const std::vector<Measure> measures = rows.measures({1, 0, 0, 1, 1});
  REQUIRE(measures.size() == 3);
  CHECK(measures[0].kind == MeasureKind::angle);
  CHECK(measures[1].kind == MeasureKind::coordinate);
  CHECK(measures[2].kind == MeasureKind::combination);
}

}  // namespace resting_rows_test
