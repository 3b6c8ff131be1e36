// SPDX-License-Identifier: BSD-3-Clause
// Motions that no step gets through are told by what blocks them, and what is advised helps.
#include "core/system/blocked_motion.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/structure/node_positions.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace blocked_motion_test {

namespace {

using testing::end_positions, testing::error_of, testing::model_of, testing::run_scene;

// A parallelogram with three cranks of 1.1 m, of which two would do, 1.1 rad from the x axis, with its
// positions given to so many decimals, so far along x.
std::string three_cranks(int decimals, double from = 0) {
  const double pivots[3][2] = {
      {0, 0}, {std::sqrt(2.0), std::sqrt(0.27)}, {3.14159265358979, 1.0392304845413}};
  std::string nodes, rods;
  for (int k = 0; k < 3; ++k) {
    char text[400];
    const double x = pivots[k][0], z = pivots[k][1];
    std::snprintf(text, sizeof text,
                  "{name = 'A%d', position = [%.*f, 0, %.*f], fixed = true}, "
                  "{name = 'B%d', position = [%.*f, 0, %.*f]}, ",
                  k, decimals, from + x, decimals, z, k, decimals, from + (x + 1.1 * std::cos(1.1)), decimals,
                  z + 1.1 * std::sin(1.1));
    nodes += text;
    std::snprintf(text, sizeof text, "{nodes = ['A%d', 'B%d'], mass = 0.5}, ", k, k);
    rods += text;
  }
  return "[structure]\nkind = 'custom'\nnodes = [" + nodes + "]\nrods = [" + rods +
         "{nodes = ['B0', 'B1'], mass = 0.3}, {nodes = ['B1', 'B2'], mass = 0.3}, "
         "{nodes = ['B0', 'B2'], mass = 0.3}]\n"
         "[[constraints]]\nkind = 'plane'\nnodes = ['B0', 'B1', 'B2']\nnormal = [0, 1, 0]\n"
         "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 0.1\nstep = 0.01\n";
}

// Of the first of the cranks.
const std::string motor =
    "[[constraints]]\nkind = 'coordinate'\nname = 'motor'\nnodes = ['B0']\ndirection = [1, 0, 0]\n"
    "motion = 'rate'\nrate = 0.1\nramp = 0.05\n";

// Rods between two held nodes, `slack` below the line, with a load across.
std::string in_line(const std::string& slack) {
  return "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
         "{name = 'B', position = [1, 0, -" +
         slack +
         "]}, {name = 'C', position = [2.5, 0, 0], fixed = true}]\n"
         "rods = [{nodes = ['A', 'B'], mass = 1.2}, {nodes = ['B', 'C'], mass = 1}]\n"
         "[[loads]]\nnodes = ['B']\nforce = [0, 0, -10]\n[solver]\nend_time = 0.1\nstep = 0.01\n";
}

// Two rods of 1 m as a jack: they reach 2 m.
std::string jack(const std::string& drive) {
  return "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
         "{name = 'B', position = [0.6, 0, 0.8]}, {name = 'C', position = [1.2, 0, 0]}]\n"
         "rods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['B', 'C'], mass = 1.3}]\n"
         "[[constraints]]\nkind = 'plane'\nnodes = ['B', 'C']\nnormal = [0, 1, 0]\n"
         "[[constraints]]\nkind = 'line'\nnodes = ['C']\ndirection = [1, 0, 0]\n"
         "[[constraints]]\nname = 'act'\nmotion = 'smooth'\nduration = 1\n" +
         drive + "\n[solver]\nend_time = 1\nstep = 0.01\n";
}

std::string held_in(const std::string& scene) {
  const auto model = model_of(scene);
  return held_at_second_order(model->system, node_positions(model->structure));
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a linkage that is rigid by the digits of its positions is refused and told which are missing") {
  for (const int decimals : {4, 6, 8}) {
    const std::string error = error_of(three_cranks(decimals));
    CAPTURE(decimals, error);
    CHECK(has(error, "nothing can move"));
    CHECK(has(error, "give its positions all 16 digits"));
  }
  CHECK(error_of(three_cranks(17)) == "");
  // Rigid by its make: the second crank ends at a pivot that stands still.
  std::string made = three_cranks(17);
  made.insert(made.find("{nodes = ['B1', 'B2']"), "{nodes = ['B0', 'A2'], mass = 1}, ");
  CHECK(has(error_of(made), "nothing can move"));
  CHECK_FALSE(has(error_of(made), "digits"));
}

// A drive of the first crank asks for no more than the free linkage can do: it is refused with as many digits
// as the free one is, and told the same. With nine, one of the two measures is next to what counts as zero:
// by 1e-9 of some 1 m, a hundredth of which the free one has left, and the driven one a little more.
TEST_CASE("a driven linkage is refused for missing digits where the free one is and told which") {
  for (const int decimals : {3, 4, 5, 6, 7, 8, 10, 11, 12, 13, 14, 15, 16, 17}) {
    const std::string free = three_cranks(decimals), error = error_of(free + motor);
    CAPTURE(decimals, error);
    CHECK(error.empty() == error_of(free).empty());
    if (!error.empty()) CHECK(has(error, "the drive motor moves what other constraints hold"));
    if (!error.empty()) CHECK(has(error, "give its positions all 16 digits"));
  }
  std::string made = three_cranks(17) + motor;
  made.insert(made.find("{nodes = ['B1', 'B2']"), "{nodes = ['B0', 'A2'], mass = 1}, ");
  CHECK(has(error_of(made), "the drive motor moves what other constraints hold"));
  CHECK_FALSE(has(error_of(made), "digits"));
}

// Between what counts as rigid and round-off such rows cannot be held together; B1 is then off by 1e-5 m with
// steps that get through.
TEST_CASE("positions with too few digits for a step are warned of and all digits need no warning") {
  for (const std::string& drive : {std::string(), motor}) {
    for (const int decimals : {9, 10}) {
      if (decimals == 9 && !drive.empty()) continue;
      const Simulation run = run_scene(three_cranks(decimals) + drive);
      CAPTURE(decimals, drive);
      REQUIRE_FALSE(run.warnings.empty());
      CHECK(has(run.warnings.front(), "follow from one another only to"));
      if (run.status == RunStatus::failed) CHECK(has(run.message, "give the positions all 16 digits"));
    }
    const Simulation right = run_scene(three_cranks(17) + drive);
    CHECK(right.warnings.empty());
    CHECK(right.status == RunStatus::completed);
  }
}

// Digits that end at 10^-d move a node by 0.7 10^-d at most, in its plane, and a unit row of rods of 1.1 m
// and more by 1.4 / 1.1 of that: all six by 3.2 10^-d, which bounds what is left of the one that depends. Far
// from the origin, where all digits that a number has are given, the spacing of numbers does the same.
TEST_CASE("how far rows follow from one another is told and what takes their digits") {
  const auto share_of = [](const std::string& warning) {
    const std::string mark = "follow from one another only to ";
    const std::size_t at = warning.find(mark);
    return at == std::string::npos ? 0.0 : std::strtod(warning.c_str() + at + mark.size(), nullptr);
  };
  const auto warning_of = [](const std::string& scene) {
    const auto model = model_of(scene);
    return misfit_warning(model->system, node_positions(model->structure));
  };
  for (const int decimals : {9, 10}) {
    const std::string warning = warning_of(three_cranks(decimals));
    CAPTURE(decimals, warning);
    CHECK(share_of(warning) < 3.2 * std::pow(10, -decimals));
    CHECK(share_of(warning) > 1e-3 * std::pow(10, -decimals));
    CHECK(has(warning, "give them all 16 digits"));
  }
  // Its rotor is a number, which lies nowhere.
  const std::string rotor =
      "[[forces]]\nkind = 'motor'\nnodes = ['A1', 'A0', 'B0']\naxis = [0, 1, 0]\nstall_torque = 1\n"
      "no_load_speed = 60\ninertia = 0.02\n";
  for (const auto& [from, more] : {std::pair(-1.9e5, std::string()), {4.4e6, ""}, {4.4e6, rotor}}) {
    const std::string warning = warning_of(three_cranks(17, from) + more);
    CAPTURE(from, more, warning);
    CHECK(share_of(warning) < 3.2 * 2e-16 * std::abs(from));
    CHECK(share_of(warning) > 0);
    CHECK(has(warning, "move the structure near the origin"));
    CHECK_FALSE(has(warning, "16 digits"));
  }
}

// Beside a pendulum, with one that hangs from them, and afloat: cranks of positions with 4 to 8 decimals hold
// each other; those of all digits move, and a crank braced against its pivots stands still as it is meant to.
TEST_CASE("a linkage that stands still for want of digits is named whatever moves beside it") {
  const auto put = [](std::string text, const std::string& behind, const std::string& more) {
    return text.insert(text.find(behind) + behind.size(), more);
  };
  const auto warning_of = [](const std::string& scene) {
    const auto model = model_of(scene);
    return misfit_warning(model->system, node_positions(model->structure));
  };
  const auto beside = [&](const std::string& scene) {
    return put(put(scene, "nodes = [",
                   "{name = 'P', position = [9, 0, 0], fixed = true}, {name = 'Q', position = [9, 0, -1]}, "),
               "rods = [", "{nodes = ['P', 'Q'], mass = 1}, ");
  };
  const auto hung = [&](const std::string& scene) {
    return put(put(scene, "nodes = [", "{name = 'Q', position = [4, 0, 0.5], mass = 1}, "), "rods = [",
               "{nodes = ['B2', 'Q'], mass = 1}, ");
  };
  const auto afloat = [&](std::string scene) {
    const std::string fixed = ", fixed = true";
    for (std::size_t at = 0; (at = scene.find(fixed, at)) != std::string::npos;)
      scene.erase(at, fixed.size());
    return put(put(scene, "rods = [",
                   "{nodes = ['A0', 'A1'], mass = 1}, {nodes = ['A1', 'A2'], mass = 1}, {nodes = ['A0', "
                   "'A2'], mass = 1}, "),
               "nodes = ['B0', 'B1', 'B2'", ", 'A0', 'A1', 'A2'");
  };
  for (const int decimals : {4, 5, 6, 8}) {
    CAPTURE(decimals);
    for (const auto& [scene, how] : {std::pair(beside(three_cranks(decimals)), "and stand still"),
                                     {hung(three_cranks(decimals)), "and stand still"},
                                     {afloat(three_cranks(decimals)), "as one rigid body"}}) {
      const std::string warning = warning_of(scene);
      CAPTURE(warning);
      CHECK(has(warning, std::string("hold each other ") + how + ", though they nearly leave one motion"));
      CHECK(has(warning, "give its positions all 16 digits"));
      CHECK_FALSE(has(warning, "-Q"));
    }
  }
  CHECK(warning_of(beside(three_cranks(17))).empty());
  CHECK(warning_of(hung(three_cranks(17))).empty());
  CHECK(warning_of(afloat(three_cranks(17))).empty());
  CHECK(warning_of(beside(put(three_cranks(17), "rods = [", "{nodes = ['A0', 'B1'], mass = 1}, "))).empty());
  const Simulation run = run_scene(beside(three_cranks(6)));
  REQUIRE(run.status == RunStatus::completed);
  CHECK(has(run.warnings.front(), "stand still"));
}

// A braced girder of 40 bays, 160 times as long as it is high, in its plane: statically determinate, its
// least singular values, of bending, are 1e-4 and less and as far apart as frequencies of a beam.
TEST_CASE("a slender girder and a pendulum on a short pin are no linkages without digits") {
  const std::string girder = R"([structure]
kind = "custom"
nodes = [{name = "A0", position = [0, 0, 0], fixed = true}, {name = "B0", position = [0, 0, 0.25], fixed = true},
  {repeat = {i = "1:41"}, name = "A{i}", position = ["=i", 0, 0]},
  {repeat = {i = "1:41"}, name = "B{i}", position = ["=i", 0, 0.25]}, {name = "Q", position = [0, 0, 9], mass = 1}]
rods = [{repeat = {i = "1:41"}, nodes = ["A{i-1}", "A{i}"], mass = 1},
  {repeat = {i = "1:41"}, nodes = ["B{i-1}", "B{i}"], mass = 1}, {repeat = {i = "1:41"}, nodes = ["A{i}", "B{i}"], mass = 1},
  {repeat = {i = "1:41"}, nodes = ["A{i-1}", "B{i}"], mass = 1}]
constraints = [{kind = "plane", nodes = ["A*", "B*"], normal = [0, 1, 0]}]
)";
  const std::string on_pin =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0, -0.005, 0], fixed = true}, "
      "{name = 'Q', position = [0, 0.005, 0], fixed = true}, {name = 'T', position = [8, 0, 6]}]\n"
      "rods = [{nodes = ['P', 'T'], mass = 1}, {nodes = ['Q', 'T'], mass = 1}]\n";
  std::string carries = girder;  // what it carries leaves it a girder
  carries.insert(carries.find("rods = [") + 8, R"({nodes = ["A0", "Q"], mass = 1}, )");
  for (const std::string& scene : {girder, carries, on_pin}) {
    const auto model = model_of(scene);
    CHECK(misfit_warning(model->system, node_positions(model->structure)) == "");
  }
}

TEST_CASE("rods in line under a load across are named and slack helps") {
  const Simulation run = run_scene(in_line("0"));
  CHECK(run.status == RunStatus::failed);
  CHECK(has(run.message, "A-B, rod B-C hold each other in this pose"));
  CHECK_FALSE(has(run.message, "smaller solver.step"));
  CHECK(run_scene(in_line("0.02")).status == RunStatus::completed);
}

TEST_CASE("a drive past the reach of the rods is named with what it asks for") {
  const std::string length = "kind = 'length'\nnodes = ['A', 'C']\nto = ";
  const Simulation run = run_scene(jack(length + "3"));
  CAPTURE(run.message);
  CHECK(run.status == RunStatus::failed);
  // 1.2 + 1.8 (10 u^3 - 15 u^4 + 6 u^5) = 2 at u = 0.4704.
  CHECK(has(run.message, "the drive act asks for 2.0"));
  CHECK(has(run.message, "at t = 0.47 s): let it move less far"));
  CHECK_FALSE(has(run.message, "smaller solver.step"));
  CHECK(run_scene(jack(length + "1.98")).status == RunStatus::completed);
  // As a coordinate the same.
  const Simulation slides =
      run_scene(jack("kind = 'coordinate'\nnodes = ['C']\ndirection = [1, 0, 0]\nto = 2.6"));
  CHECK(has(slides.message, "the drive act asks for 2.0"));
}

// A crank of 0.3 m and its rod of 0.7 m reach 1 m in line.
TEST_CASE("a drive that ends in a dead centre is told so and one that ends just before gets there") {
  const auto run_to = [](const std::string& end) {
    return run_scene(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, "
        "{name = 'B', position = [0.15, '=0.15*sqrt(3)', 0]}, {name = 'X', position = [0.8, 0, 0], mass = "
        "0.5}]\n"
        "rods = [{nodes = ['O', 'B'], mass = 1}, {nodes = ['B', 'X'], mass = 1}]\n"
        "constraints = [{kind = 'plane', nodes = ['*'], normal = [0, 0, 1]}, "
        "{kind = 'line', nodes = ['X'], direction = [1, 0, 0]}, {kind = 'coordinate', name = 'act', "
        "nodes = ['X'], direction = [1, 0, 0], motion = 'smooth', duration = 1, to = " +
        end + "}]\n[solver]\nstep = 0.01\nend_time = 1.5\n");
  };
  const Simulation run = run_to("1");
  CAPTURE(run.message);
  CHECK(run.status == RunStatus::failed);
  CHECK(has(run.message, "the drive act leads to 1 m, the utmost that the other constraints reach"));
  CHECK_FALSE(has(run.message, "digits"));
  CHECK_FALSE(has(run.message, "smaller solver.step"));
  CHECK(run_to("0.9999").status == RunStatus::completed);
}

// The same crank, 1e-5 degrees off the line in which it reaches 1 m, is drawn inwards: its rods turn by
// sqrt(x) of the way x, which short steps see.
TEST_CASE("a drive that sets out from a dead centre is told so, and shorter steps get through") {
  const std::string crank =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, "
      "{name = 'B', position = [0.29999999999999544, 5.235987755982963e-08, 0]}, "
      "{name = 'X', position = [0.9999999999999933, 0, 0], mass = 0.5}]\n"
      "rods = [{nodes = ['O', 'B'], mass = 1}, {nodes = ['B', 'X'], mass = 1}]\n"
      "constraints = [{kind = 'plane', nodes = ['*'], normal = [0, 0, 1]}, "
      "{kind = 'line', nodes = ['X'], direction = [1, 0, 0]}, {kind = 'coordinate', name = 'act', "
      "nodes = ['X'], direction = [1, 0, 0], motion = 'smooth', duration = 1, to = 0.8}]\n"
      "[solver]\nstages = 4\nstep = 0.01\nend_time = 1\n";
  const Simulation run = run_scene(crank);
  CAPTURE(run.message);
  CHECK(run.status == RunStatus::failed);
  CHECK(has(run.message, "the drive act sets out from 1 m, the utmost that the other constraints reach"));
  CHECK(has(run.message, "make solver.step smaller"));
  CHECK_FALSE(has(run.message, "let it"));
  CHECK(run_scene(crank, {"solver.step=1e-4"}).status == RunStatus::completed);
}

// A flat parallelogram has a self-stress and moves in two ways; a chain in line that is held at one end has
// no self-stress.
TEST_CASE("what moves to second order is not said to be held") {
  const std::string chain =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
      "{name = 'B', position = [1, 0, 0]}, {name = 'C', position = [2.5, 0, 0]}]\n"
      "rods = [{nodes = ['A', 'B'], mass = 1.2}, {nodes = ['B', 'C'], mass = 1}]\n";
  CHECK(held_in(chain) == "");
  CHECK(held_in(three_cranks(17)) == "");
  const std::string flat =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
      "{name = 'B', position = [0.7, 0, 0]}, {name = 'C', position = [2.2, 0, 0]}, "
      "{name = 'D', position = [1.5, 0, 0], fixed = true}]\n"
      "rods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['B', 'C'], mass = 1}, {nodes = ['C', 'D'], mass = "
      "1}]\n"
      "[[constraints]]\nkind = 'plane'\nnodes = ['B', 'C']\nnormal = [0, 1, 0]\n";
  CHECK(held_in(flat) == "");
  CHECK(held_in(in_line("0")) == "rod A-B, rod B-C");
  CHECK(held_in(in_line("0.02")) == "");
  const auto loose =
      model_of("[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [1, 2, 3], mass = 1}]\n");
  const Vec3 speed(0.3, 0, -0.2);
  CHECK(held_at_second_order(loose->system, node_positions(loose->structure)) == "");
  CHECK_FALSE(of_no_branch(loose->system, node_positions(loose->structure), speed));
  // In line with a rod along both of them, wherever they float: the middle cannot leave the line of the ends.
  CHECK(
      held_in("[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0.2, 0.1, -0.3]}, "
              "{name = 'B', position = [0.8, 0.9, -0.3]}, {name = 'C', position = [1.7, 2.1, -0.3]}]\n"
              "rods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['B', 'C'], mass = 2}, {nodes = ['A', 'C'], "
              "mass = 3}]\n") == "rod A-B, rod B-C, rod A-C");
}

// Cranks of 1 m and a coupler of 2 m in line: with velocities b and c of their ends across the line they bend
// by b^2, (c - b)^2 / 2 and c^2, pulled by tensions of one size: b^2 + (c - b)^2 / 2 - c^2 = 0 is c = b, the
// parallelogram, or c = -3 b, the crossed one.
TEST_CASE("velocities that are of no branch are said to be so") {
  const auto cranks = [](double b, double c) {
    char text[700];
    std::snprintf(
        text, sizeof text,
        "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true},\n"
        "{name = 'B', position = [1, 0, 0], velocity = [0, %g, 0]},\n"
        "{name = 'C', position = [3, 0, 0], velocity = [0, %g, 0]},\n"
        "{name = 'D', position = [2, 0, 0], fixed = true}]\n"
        "rods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['B', 'C'], mass = 1}, {nodes = ['C', 'D'], "
        "mass = 1}]\n[[constraints]]\nkind = 'plane'\nnodes = ['B', 'C']\nnormal = [0, 0, 1]\n"
        "[solver]\nstep = 0.01\nend_time = 0.1\n",
        b, c);
    return std::string(text);
  };
  for (const auto& [b, c] : {std::pair(1.0, -1.0), {1.0, 2.0}, {0.0, 1.0}}) {
    const Simulation run = run_scene(cranks(b, c));
    CAPTURE(b, c, run.message);
    CHECK(run.status == RunStatus::failed);
    CHECK(has(run.message, "the velocities lead into none of the motions that go on from this pose"));
    CHECK_FALSE(has(run.message, "smaller solver.step"));
  }
  for (const auto& [b, c] : {std::pair(1.0, 1.0), {1.0, -3.0}}) {
    const auto model = model_of(cranks(b, c));
    VectorXd v = VectorXd::Zero(model->system.coordinates());
    v[4] = b, v[7] = c;
    CHECK_FALSE(of_no_branch(model->system, node_positions(model->structure), v));
  }
}

// The middle of two rods in line cannot move at all. What holds the constraints fails there; steps of what
// lets them drift go through and move it.
TEST_CASE("methods that drift are warned of where rods hold each other to second order") {
  const auto told = [](const std::string& slack, const std::string& method) {
    const Simulation run = run_scene(in_line(slack), {"solver.method=" + method});
    INFO(method << ", slack " << slack << ": " << run.message);
    CHECK((run.status == RunStatus::failed) == (slack == "0" && !method.starts_with("rk4")));
    return std::ranges::count_if(run.warnings, [](const auto& w) {
      return w.starts_with("rod A-B, rod B-C hold each other in this pose");
    });
  };
  for (const char* method : {"rk4", "rk4_baumgarte"}) {
    CHECK(told("0", method) == 1);
    CHECK(told("0.1", method) == 0);
  }
  CHECK(told("0", "dvm") == 0);
  CHECK(told("0.1", "dvm") == 0);
}

}  // namespace blocked_motion_test
