// SPDX-License-Identifier: BSD-3-Clause
// What a user is told of forces whose measure turns back inside a step.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/simulate/initial_state.hpp"
#include "core/simulate/turning_back.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace turning_back_test {

namespace {

using testing::run_scene;

// A crank that begins across the base and swings through its line at 2 rad/s, which takes pi / 4 s.
const std::string crank = R"(
[structure]
kind = "custom"
nodes = [
  {name = "E", position = [-1, 0, 0], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
  {name = "T", position = [0, 1, 0], velocity = [2, 0, 0], mass = 1}]
rods = [{nodes = ["O", "T"], mass = 0}]
constraints = [{kind = "plane", nodes = ["T"], normal = [0, 0, 1]}]
[[forces]]
kind = "torsion_spring"
name = "hinge"
nodes = ["E", "O", "T"]
stiffness = 1e-3
[solver]
step = 0.01
end_time = 1.2
)";

// A mass on a guide through the other end of its spring.
const std::string guide = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [0.4, 0.3, 0], velocity = [-0.8, -0.6, 0], mass = 1}]
constraints = [{kind = "line", nodes = ["A"], direction = [0.8, 0.6, 0]}]
[[forces]]
kind = "spring"
name = "bar"
nodes = ["O", "A"]
stiffness = 1e-3
[solver]
step = 0.013
end_time = 0.9
)";

std::size_t said(const Simulation& run, const char* what) {
  std::size_t n = 0;
  for (const std::string& warning : run.warnings) n += warning.find(what) != std::string::npos ? 1 : 0;
  return n;
}

}  // namespace

TEST_CASE("an angle without an axis that passes rods in line is told once") {
  for (const char* method : {"dvm", "rk4"}) {
    const Simulation run = run_scene(crank, {std::string("solver.method=") + method});
    REQUIRE(run.status == RunStatus::completed);
    CHECK(run.warnings.size() == 1);
    CHECK(said(run, "the rods of hinge pass through one line") == 1);
    CHECK(said(run, "at t = 0.79 s") == 1);  // pi / 4 and its step's end; the spring is too weak to count
  }
  // To the other side, where the angle falls to 0; and there and back, twice in all.
  CHECK(said(run_scene(crank, {"structure.nodes[2].velocity=[-2, 0, 0]"}),
             "the rods of hinge pass through") == 1);
  CHECK(said(run_scene(crank, {"solver.end_time=2.9", "structure.nodes[2].velocity=[4, 0, 0]"}), "hinge") ==
        1);
}

TEST_CASE("no spring is told to turn back that has an axis, no force there, or turns before") {
  for (const std::vector<std::string>& changes : {std::vector<std::string>{"forces[0].axis=[0, 0, 1]"},
                                                  {"forces[0].free_angle=180"},
                                                  {"forces[0].stiffness=0", "forces[0].damping=1e-3"},
                                                  {"solver.end_time=0.7"}})
    CHECK(run_scene(crank, changes).warnings.empty());
  // Past the line at a distance, as a crank in a plane beside it does.
  CHECK(
      run_scene(crank, {"structure.nodes[2].position=[0, 0.8, 0.6]",
                        "structure.constraints[0].normal=[0, 0, 1]", "structure.nodes[2].velocity=[2, 0, 0]"})
          .warnings.empty());
}

TEST_CASE("ends of a spring that pass each other are told") {
  const Simulation run = run_scene(guide);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(said(run, "the ends of bar pass each other") == 1);
  CHECK(run_scene(guide, {"forces[0].free_length=0"}).warnings.empty());
  CHECK(run_scene(guide, {"forces[0].tension_only=true"}).warnings.empty());
  CHECK(run_scene(guide, {"solver.end_time=0.4"}).warnings.empty());
}

TEST_CASE("ends of a spring that pass close by are told where the step does not resolve it") {
  // At 1 m/s past the other end, 5 mm beside it: in a step of 13 mm, from 6 before to 7 behind, the force
  // turns by 105 degrees; in steps of 5 mm by 45 at most.
  const std::vector<std::string> beside{"structure.nodes[1].position=[0.4, 0.3, 0.005]"};
  const Simulation run = run_scene(guide, beside);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(said(run, "the ends of bar pass each other at 0.005 m") == 1);
  CHECK(said(run, "make solver.step 0.0025 s") == 1);  // 13 ms * 0.5 * 5 / 13: some 30 degrees
  auto changed = [&](const std::string& change) {
    std::vector<std::string> all = beside;
    all.push_back(change);
    return run_scene(guide, all);
  };
  CHECK(changed("solver.step=0.005").warnings.empty());
  CHECK(changed("forces[0].free_length=0").warnings.empty());
  // A crank whose tip passes the base's line 5 mm beside it, in the same way an angle.
  const std::string hinge = "the rods of hinge pass one line at";
  CHECK(said(run_scene(crank, {"structure.nodes[2].position=[0, 1, 0.005]",
                               "structure.nodes[2].velocity=[2, 0, 0]"}),
             hinge.c_str()) == 1);
}

namespace {

// Springs, a cable, a hinge and a motor between free masses, whose poses are set by hand.
const std::string loose = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0], mass = 1}, {name = "B", position = [1, 0, 0], mass = 1},
  {name = "C", position = [0, 2, 0], mass = 1}, {name = "D", position = [1, 2, 0.5], mass = 1}]
[[forces]]
kind = "spring"
name = "bar"
nodes = ["A", "B"]
stiffness = 3
free_length = 0.7
[[forces]]
kind = "spring"
name = "cable"
nodes = ["C", "D"]
stiffness = 3
free_length = 0.7
tension_only = true
[solver]
step = 0.1
)";

struct Told {
  std::shared_ptr<const Model> model;
  TurningBack turning;

  explicit Told(Structure structure)
      : model(std::make_shared<const Model>(Model{structure, System(structure, true)})), turning(structure) {}

  // From one difference of B and A to another, or of two lines, between t = 0.3 and 0.8.
  std::vector<std::string> said(const Vec3& before, const Vec3& after, const Vec3& lines = Vec3(1, 0, 0)) {
    const System& system = model->system;
    const auto state = [&](double t, const Vec3& b) {
      VectorXd q(12);
      q << 0.2, 0.1, -0.4, Vec3(0.2, 0.1, -0.4) + b, 5, 6, 7, Vec3(5, 6, 7) + lines;
      State s;
      s.t = t;
      s.z = system.reduce(q);
      s.w = VectorXd::Zero(s.z.size());
      return s;
    };
    return turning.between(system, state(0.3, before), state(0.8, after));
  }
};

using Texts = std::vector<std::string>;

Structure loose_structure() {
  return testing::model_of(loose)->structure;
}

std::string rounded(const char* form, double x) {
  char text[40];
  std::snprintf(text, sizeof text, form, x);
  return text;
}

}  // namespace

TEST_CASE("ends that pass each other are told apart from ends that pass close by and from others") {
  const Texts through = {
      "at t = 0.8 s: the ends of bar pass each other, where its force turns round; what "
      "follows is right to the first order of solver.step"};
  const auto said = [](const Vec3& a, const Vec3& b) { return Told(loose_structure()).said(a, b); };
  CHECK(said({0.3, 0, 0}, {-0.2, 0, 0}) == through);
  CHECK(said({-0.1, 0.2, 0.3}, {0.2, -0.4, -0.6}) == through);
  CHECK(said({0.3, 0, 0}, {0.2, 0, 0}).empty());
  CHECK(said({0.3, 0, 0}, {0.001, 5, 0}).empty());   // by less than a right angle
  CHECK(said({0.3, 0, 0}, {-1e-10, 0, 0}).empty());  // there, on neither side
  // The way from (0.3, 0, 0) to (-0.2, y, 0) passes at 0.3 y / hypot(0.5, y), a tenth of 0.2 at y = 0.0339.
  CHECK(said({0.3, 0, 0}, {-0.2, 0.033, 0}) == through);
  for (const double y : {0.036, -0.4, 3.0}) {
    const double way = std::hypot(0.5, y), distance = 0.3 * std::abs(y) / way;
    CHECK(said({0.3, 0, 0}, {-0.2, 0, y}) ==
          Texts{"at t = 0.8 s: the ends of bar pass each other at " + rounded("%.2g m", distance) +
                ", and what it pulls with turns round within a step, which does not resolve that; make "
                "solver.step " +
                rounded("%.2g s", 0.5 * distance / way * 0.5)});
  }
  // The cable does not push, whatever its ends do; and what was said once is not said again.
  CHECK(Told(loose_structure()).said({1, 0, 0}, {1, 0, 0}, {0, 0, 1}).empty());
  Told once(loose_structure());
  CHECK(once.said({0.3, 0, 0}, {-0.2, 0, 0}).size() == 1);
  CHECK(once.said({-0.3, 0, 0}, {0.2, 0, 0}).empty());
  Structure free = loose_structure();
  free.forces[0].rest = 0;  // no force to turn round
  CHECK(Told(free).said({0.3, 0, 0}, {-0.2, 0, 0}).empty());
  free = loose_structure();
  free.forces[0].stiffness = 0;
  CHECK(Told(free).said({0.3, 0, 0}, {-0.2, 0, 0}).empty());
  free.forces[0].kind = "motor";  // which has one by other laws, also towards no length
  free.forces[0].rest = 0;
  CHECK(Told(free).said({0.3, 0, 0}, {-0.2, 0, 0}) == through);
}

TEST_CASE("lines that an angle without an axis passes are told with the angle that is left") {
  Structure structure = loose_structure();
  Force& hinge = structure.forces[0];
  hinge.kind = "torsion_spring", hinge.name = "hinge", hinge.rest = 0.4;
  hinge.measure = {MeasureKind::angle, {0, 1, 2, 3}, Vec3::Zero(), 0.0, {}};
  const Texts through = {
      "at t = 0.8 s: the rods of hinge pass through one line, where an angle without an axis "
      "turns back and the torque on it jumps; give an axis, if the hinge turns through"};
  const Vec3 along(1.3, 0, 0);
  const auto said = [&](const Vec3& a, const Vec3& b, double rest = 0.4) {
    Structure s = structure;
    s.forces[0].rest = rest;
    return Told(s).said(a, b, along);
  };
  for (const double side : {1.0, -1.0}) {  // in line, or folded onto it
    CHECK(said({side, 0.2, 0}, {side, -0.1, 0}) == through);
    CHECK(said({side, 0.2, 0}, {side, 0.1, 0}).empty());
    // A torque that is nothing in line does not jump.
    CHECK(said({side, 0.2, 0}, {side, -0.1, 0}, side > 0 ? 0.0 : std::acos(-1.0)).empty());
    CHECK(said({side, 0.2, 0}, {side, -0.1, 0}, side > 0 ? std::acos(-1.0) : 0.0) == through);
    // Normals (0, -z, y) of the lines, times 1.3: from (0, 0, 0.2) to (0, 0.15, -0.1) of 1 m.
    const double way = std::hypot(0.3, 0.15), sine = 0.2 * 0.15 / way;
    // The product of the lengths is that before the step.
    const double size = std::hypot(1, 0.2);
    const double left = std::asin(1.3 * sine / (1.3 * std::hypot(1.0, std::hypot(0.1, 0.15))));
    const Texts close = said({side, 0.2, 0}, {side, -0.1, 0.15});
    REQUIRE(close.size() == 1);
    CHECK(close[0].starts_with("at t = 0.8 s: the rods of hinge pass one line at "));
    double degrees = 0, step = 0;
    CHECK(std::sscanf(close[0].c_str(), "at t = 0.8 s: the rods of hinge pass one line at %lf degrees, and",
                      &degrees) == 1);
    CHECK(std::sscanf(close[0].c_str() + close[0].find("make "), "make solver.step %lf s", &step) == 1);
    // Two digits are printed; lengths are those of either state.
    const double most = std::asin(sine) * 180 / std::acos(-1.0), least = left * 180 / std::acos(-1.0);
    CHECK(degrees <= most * 1.05);
    CHECK(degrees >= std::min(least, std::asin(sine / size) * 180 / std::acos(-1.0)) * 0.95);
    CHECK(step == Approx(0.5 * 0.2 * 0.15 / (way * way) * 0.5).epsilon(0.05));
  }
  structure.forces[0].measure.axis = Vec3(0, 0, 1);  // which counts on
  CHECK(said({1, 0.2, 0}, {1, -0.1, 0}).empty());
}

// What a rack holds turns round with its pinion's angle; two stages of a tube that share its extension have
// no motion on where one of them is nothing.
TEST_CASE("constraints whose measure turns back are named") {
  const std::string rack = R"(
[structure]
kind = "custom"
nodes = [
  {name = "E", position = [-1, 0, 0], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
  {name = "T", position = [0, 1, 0], velocity = [2, 0, 0], mass = 1},
  {name = "D", position = [0, 0, 1], velocity = [0.6, 0, 0], mass = 1}]
rods = [{nodes = ["O", "T"], mass = 0}]
constraints = [{kind = "plane", nodes = ["T"], normal = [0, 0, 1]},
               {kind = "line", nodes = ["D"], direction = [1, 0, 0]}]
[[constraints]]
kind = "rack"
name = "pinion"
nodes = ["E", "O", "T", "D"]
radius = 0.3
direction = [1, 0, 0]
[solver]
step = 0.01
end_time = 1.2
)";
  const char* told = "the rods of pinion pass through one line";
  CHECK(said(run_scene(rack), told) == 1);
  CHECK(said(run_scene(rack, {"constraints[0].axis=[0, 0, 1]"}), told) == 0);
  const std::string tube = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [0.8, 0.6, 0], velocity = [-0.4, -0.3, 0], mass = 0.5},
         {name = "C", position = [1.2, 0.9, 0], velocity = [-0.8, -0.6, 0], mass = 0.7}]
constraints = [{kind = "line", nodes = ["C"], direction = [0.8, 0.6, 0]}]
[[constraints]]
kind = "telescope"
name = "tube"
nodes = ["A", "B", "C"]
[solver]
step = 0.013
end_time = 2
)";
  const Simulation run = run_scene(tube);
  CHECK(run.message.find("a length of tube (stages 1, 2) falls to 0 and turns back") != std::string::npos);
  CHECK(run.message.find("smaller solver.step") == std::string::npos);
  CHECK(run_scene(tube, {"solver.end_time=0.4"}).status == RunStatus::completed);
}

// A motor winds up 0.5 m of cable, which pulls its load along: nothing else can end such a run.
TEST_CASE("an elastic cable that a winch winds up to its end is named") {
  for (const char* stiffness : {"5000", "0"}) {
    const Simulation run = testing::run_scene(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'X', position = [0, 0, 0], fixed = true}, {name = "
        "'M', "
        "position = [0.5, 0, 0], mass = 2}]\n[[constraints]]\nkind = 'line'\nnodes = ['M']\ndirection = [1, "
        "0, "
        "0]\n[[forces]]\nkind = 'winch'\nname = 'w'\nnodes = ['X', 'M']\nstall_torque = 0.1\nno_load_speed = "
        "6000\ndrum_radius = 0.1\ngear_ratio = 20\ninertia = 1e-4\n[solver]\nstep = 0.01\nstages = "
        "4\nend_time = "
        "5\n",
        {std::string("forces[0].axial_stiffness=") + stiffness,
         std::string("forces[0].damping=") + (stiffness[0] == '0' ? "0" : "20")});
    INFO(run.message);
    CHECK(run.status == RunStatus::failed);
    CHECK(run.message.find("a length of w cable falls to 0") != std::string::npos);
  }
}

TEST_CASE("a stop beyond whose limit an angle turns back within a step is told of") {
  const Vec3 along(1.3, 0, 0);
  const auto said = [&](double min, double max, double side, MeasureKind kind = MeasureKind::angle) {
    Structure s = loose_structure();
    s.forces.clear();
    s.stops.push_back({.name = "end", .measure = {kind, {0, 1, 2, 3}, Vec3::Zero(), 0.0, {}}});
    s.stops[0].min = min, s.stops[0].max = max;
    return Told(s).said({side, 0.2, 0}, {side, -0.1, 0}, along).size();
  };
  const double none = std::numeric_limits<double>::infinity();
  CHECK(said(-none, 3.1, -1) == 1);  // 180 degrees are beyond
  CHECK(said(-none, 3.1, 1) == 0);
  CHECK(said(0.1, none, 1) == 1);
  CHECK(said(0.1, none, -1) == 0);
  for (const double side : {1.0, -1.0}) CHECK(said(0.1, 3.1, side) == 1);
}

// N flies straight at the axis of what holds its angle, and reaches it after 1 s, whatever the step.
TEST_CASE("a side that comes onto the axis of its angle ends the run and is named") {
  const std::string text = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0.4, -0.7, 0.2], fixed = true},
         {name = "T", position = [0.4, -0.7, 1.2], fixed = true},
         {name = "Q", position = [2.4, -0.7, 0.7], fixed = true},
         {name = "N", position = [1.4, -0.7, 0.5], mass = 1, velocity = [-1, 0, 0]},
         {name = "G", position = [1.4, 0.3, 0.5], mass = 1}]
[solver]
step = 0.03
end_time = 2
)";
  const std::string axis = " comes to lie along the axis of k, about which it has no angle there to be held";
  const std::vector<std::pair<std::string, std::string>> cases{
      {R"(kind="angle",nodes=["N","O","Q"],axis=[0,0,1])", "O-N" + axis},
      {R"(kind="rack",nodes=["Q","O","N","G"],radius=0.2,axis=[0,0,1],direction=[0,1,0])", "O-N" + axis},
      {R"(kind="gear",nodes=["N","O","Q","G","O","Q"],axis=[0,0,1],radii=[0.1,0.2])", "O-N" + axis},
      {R"(kind="combination",terms=["1 dihedral N O T Q","0.2 coordinate G along 0 1 0"])",
       "N comes onto the edge of k, about which it has no angle"},
  };
  for (const auto& [constraint, words] : cases)
    for (const std::string step : {"solver.step=0.03", "solver.step=0.0007", "solver.adaptive=true"}) {
      const std::string there = "structure.constraints[0]={name=\"k\"," + constraint + "}";
      const Simulation run = run_scene(text, {there, step});
      INFO(constraint << ", " << step << ": " << run.message);
      CHECK(run.status == RunStatus::failed);
      CHECK(run.message.find(words) != std::string::npos);
      CHECK(run.message.find("smaller solver.step") == std::string::npos);
      CHECK(run_scene(text, {there, step, "solver.end_time=0.9"}).status == RunStatus::completed);
    }
}

// Where a step has failed: what its next two steps at these rates would lead to. N is 1 m from the axis of
// one angle, B 0.8 m from A, the rods of another angle enclose 150 degrees.
TEST_CASE("what ends within two steps is named as what ends the run") {
  const std::string text = R"toml(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0.4, -0.7, 0.2], fixed = true},
         {name = "Q", position = [2.4, -0.7, 0.7], fixed = true},
         {name = "N", position = [1.4, -0.7, 0.5], mass = 1},
         {name = "A", position = [0, 0, 0], mass = 1},
         {name = "B", position = [0, 0.8, 0], mass = 1},
         {name = "C", position = [0, "=2*cos(5*pi/6)", "=2*sin(5*pi/6)"], mass = 1}]
)toml";
  const std::string
      axis = R"(constraints[0]={kind="angle",name="k",nodes=["N","O","Q"],axis=[0,0,1]})",
      length = R"(constraints[0]={kind="length",name="k",nodes=["A","B"]})",
      angle = R"(constraints[0]={kind="angle",name="k",nodes=["B","A","C"]})",
      sum =
          R"(constraints[0]={kind="combination",name="k",terms=["1 length A B","0.3 coordinate C along 0 0 1"]})",
      spring = R"(forces[0]={kind="torsion_spring",name="k",nodes=["B","A","C"],stiffness=3})";
  const Vec3 turns(0, -std::sin(5 * pi / 6), std::cos(5 * pi / 6));  // of C about A, at 2 m
  struct Case {
    const std::string& entry;
    std::size_t node;
    Vec3 rate;
    double within;  // [s]: two steps of half of it; 0: never
    std::string words;
  };
  const std::string falls = "a length of k falls to 0", onto = "O-N comes to lie along the axis of k",
                    through = "the rods of k pass through one line",
                    in_line = "the rods of k come to lie in line";
  for (const Case& c : {Case{axis, 2, {-1, 0, 0}, 0.9, onto},  // to a tenth of its distance
                        Case{axis, 2, {-2, 0.15, 7}, (4 - std::sqrt(16 - 4 * 4.0225 * 0.99)) / 8.045, onto},
                        Case{axis, 2, {-1, 0.3, 0}, 0, onto}, Case{axis, 2, {1, 0, 0}, 0, onto},
                        Case{length, 4, {0, -0.4, 3}, 2, falls}, Case{length, 4, {0, 0.4, 0}, 0, falls},
                        Case{length, 3, {0, 0.4, 0}, 2, falls}, Case{sum, 4, {0, -0.4, 0}, 2, falls},
                        Case{angle, 5, 0.4 * turns, pi / 6 / 0.2, through},
                        Case{angle, 5, -0.4 * turns, 5 * pi / 6 / 0.2, through},
                        Case{spring, 5, 0.4 * turns, pi / 6 / 0.2, in_line},
                        Case{spring, 5, -0.4 * turns, 5 * pi / 6 / 0.2, in_line}}) {
    const auto model = testing::model_of(text, {c.entry});
    State state = initial_state(model->structure, model->system).state;
    VectorXd v = VectorXd::Zero(model->system.coordinates());
    v.segment<3>(3 * static_cast<Index>(c.node)) = c.rate;
    state.w = model->system.reduce_rate(v);
    const auto told = [&](double h) { return at_its_end(model->structure, model->system, state, h); };
    INFO(c.entry << " " << c.rate.transpose());
    if (c.within == 0) {
      for (const double h : {0.1, 0.4, 1.0, 9.0}) CHECK(told(h).empty());
      continue;
    }
    CHECK(told(0.49 * c.within).empty());
    for (const double share : {0.51, 0.8, 1.1, 3.0}) CHECK(told(share * c.within).starts_with(c.words));
  }
}

// What presses a hinge without an axis onto a stop in its straight pose holds it there, whatever the step.
TEST_CASE("a hinge without an axis rests on a stop in its straight pose") {
  const std::string text = R"toml(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1, 0, 0], fixed = true},
         {name = "B", position = ["=1+cos(0.5)", "=sin(0.5)", 0], velocity = ["=sin(0.5)", "=-cos(0.5)", 0], mass = 1}]
rods = [{nodes = ["O", "A"], mass = 0}, {nodes = ["A", "B"], mass = 0}]
constraints = [{kind = "plane", nodes = ["B"], normal = [0, 0, 1]},
               {kind = "coordinate_stop", name = "st", nodes = ["B"], direction = [0, 1, 0], min = 0}]
[solver]
stages = 4
end_time = 5
)toml";
  const std::string motor =
      R"(forces[0]={kind="motor",nodes=["O","A","B"],stall_torque=0.5,no_load_speed=300,inertia=0,control="voltage",voltage=1})";
  const std::string spring =
      R"(forces[0]={kind="torsion_spring",nodes=["O","A","B"],stiffness=2,free_angle=200})";
  for (const std::string& force : {motor, spring})
    for (const char* restitution : {"0", "0.3", "0.5"})
      for (const char* step : {"0.013", "0.01", "0.007", "0.005", "0.003"}) {
        const Simulation run =
            run_scene(text, {force, std::string("structure.constraints[1].restitution=") + restitution,
                             std::string("solver.step=") + step});
        INFO(force << ", " << restitution << ", " << step << ": " << run.message);
        CHECK(run.status == RunStatus::completed);
        const std::size_t last = run.trajectory.size() - 1;
        // What rests on a stop after bounces does within a flight at the rest speed, 1e-3 m/s, of a step.
        CHECK(std::abs(run.trajectory.node_positions(last)[7]) <= 1e-5);
        CHECK(std::abs(run.trajectory.velocities(last)[7]) <= 2e-3);
      }
}

}  // namespace turning_back_test
