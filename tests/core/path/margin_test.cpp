// SPDX-License-Identifier: BSD-3-Clause
// Margins against closed forms, held drives and runs that stall.
#include "core/path/margin.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>

#include "core/integrators/index1.hpp"
#include "core/path/path.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/table.hpp"
#include "tests/support/hoop_exact.hpp"

using namespace unfurl;

namespace margin_test {

namespace {

// The ring of six: chord rods of 3 m, f on each of its 12 hinges; the torque about its fold angle t is
// 12 f l cos t. A spring with free angle at the start resists with k (t_0 - t).
constexpr double f = 170, l = 3.0, start = 74.0 * radians_per_degree;

Scene ring(double stiffness, const std::vector<std::string>& more = {}) {
  std::vector<std::string> changes{"structure.fold_angle=74", "structure.hinge_force=170", "solver.stages=5",
                                   "solver.end_time=20"};
  if (stiffness > 0)
    changes.push_back(
        R"(forces[0]={kind="torsion_spring",name="hose",fold_angle=true,free_angle=74,stiffness=)" +
        exact_number(stiffness) + "}");
  changes.insert(changes.end(), more.begin(), more.end());
  return read_scene_file(find_scene("hoop6"), changes);
}

Margin margin_in(const Scene& scene, const std::map<std::string, double>& factors = {}) {
  return margin_of(build_model(scene), scene.solver, factors);
}

double driven(double angle) {
  return 12 * f * l * (std::sin(start) - std::sin(angle));
}

}  // namespace

// Gravity along the axis of a ring does no work: half of it goes up as the other half goes down. What is left
// of it next to the flat pose is rounding, and no resistance.
TEST_CASE("weight that moves nothing leaves margins without bound") {
  for (const char* hinge_force : {"26.6", "100", "200"})
    for (const int units : {4, 6, 8}) {
      CAPTURE(hinge_force, units);
      const Margin margin = margin_in(read_scene_file(
          find_scene("hoop6"),
          {"structure.units=" + std::to_string(units), std::string("structure.hinge_force=") + hinge_force,
           "structure.fold_angle=79.48", "gravity.acceleration=[0,0,-1.912]"}));
      CHECK(margin.worst.margin == std::numeric_limits<double>::infinity());
    }
}

TEST_CASE("static margins are the closed form's in every pose, by source") {
  const double k = 900;
  const Margin margin = margin_in(ring(k));
  REQUIRE(margin.sources.size() == 2);
  CHECK(margin.unit == "N m");
  for (std::size_t i = 1; i < margin.points.size(); i += 7) {
    const MarginPoint& p = margin.points[i];
    const double drive = 12 * f * l * std::cos(p.fold_angle), resistance = k * (start - p.fold_angle);
    // Tangents next to the deployed pose have errors of 1e-16 over the square of the angle to it, 1e-9 at
    // most at the poses taken here.
    CHECK(p.forces[0] == Approx(drive).epsilon(1e-9));
    CHECK(p.forces[1] == Approx(-resistance).epsilon(1e-9));
    CHECK(p.margin == Approx(drive / resistance - 1).epsilon(1e-9).margin(1e-9));
  }
  // Here what drives falls by less than what resists rises: the worst pose is the last one.
  CHECK(std::abs(margin.worst.fold_angle) <= 1e-6);
  CHECK(margin.worst.margin == Approx(12 * f * l / (k * start) - 1).epsilon(1e-8));
  // Half the drive, with a factor.
  const Margin half = margin_in(ring(k), {{"loads", 0.5}});
  CHECK(half.worst.margin + 1 == Approx(0.5 * (margin.worst.margin + 1)).epsilon(1e-9));
  CHECK_THROWS_WITH(margin_in(ring(k), {{"hoses", 0.5}}), Catch::Contains("did you mean"));
}

// s is the length in the metric of the masses, ds = sqrt(2 n l^2 G) dt; energies are those of springs and
// forces, times by quadrature (tests/support/hoop_exact.hpp).
TEST_CASE("the motion of a margin has the ring's places, times and energies, with the factors asked for") {
  const exact::Hoop hoop{.fold_angle_deg = 74, .f = f};
  const auto length = [&](double to) {
    double sum = 0;
    const auto slope = [&](double t) { return std::sqrt(12 * l * l * hoop.G(t)); };
    for (int i = 0; i < 8; ++i)
      sum += exact::gauss_panel(slope, to + (start - to) * i / 8, to + (start - to) * (i + 1) / 8);
    return sum;
  };
  const double k = 700, factor = 1.3;
  const Margin free = margin_in(ring(0)), sprung = margin_in(ring(k), {{"hose", factor}});
  REQUIRE(sprung.sources.size() == 2);
  CHECK(sprung.sources[1].name == "hose");
  CHECK((sprung.sources[0].factor == 1 && sprung.sources[1].factor == factor));
  for (const Margin* margin : {&free, &sprung}) {
    const double stiffness = margin == &free ? 0 : k * factor;
    CHECK(margin->arrives);
    REQUIRE(margin->motion.size() > 20);
    double least = 1e300, at = 0;
    for (std::size_t i = 1; i < margin->motion.size(); ++i) {
      const MarginReach& reach = margin->motion[i];
      const double angle = reach.fold_angle, way = start - angle, spring = 0.5 * stiffness * way * way;
      INFO(angle);
      // Near the deployed pose an angle is known to the root of round-off: relative to the whole way.
      CHECK(reach.s == Approx(length(angle)).epsilon(0).margin(1e-6));
      CHECK(reach.driven == Approx(driven(angle)).epsilon(1e-8));
      CHECK(reach.resisted == Approx(spring).epsilon(1e-7));
      CHECK(reach.kinetic == Approx(driven(angle) - spring).epsilon(1e-7));
      if (margin == &free) {
        CHECK(reach.t == Approx(hoop.time(angle)).epsilon(1e-7));
        CHECK(reach.margin() == std::numeric_limits<double>::infinity());
      } else if (reach.margin() < least) {
        least = reach.margin(), at = reach.s;
      }
    }
    if (margin == &sprung) {
      // The spring, free at the start, takes its largest share at the end.
      CHECK(margin->dynamic_min == Approx(driven(0) / (0.5 * stiffness * start * start) - 1).epsilon(1e-6));
      CHECK(margin->dynamic_at == at);
    }
  }
}

TEST_CASE("a motion that begins with a speed has a dynamic margin by what is left of it") {
  // A bob of 1.7 kg on a rod of 0.8 m and 0.6 kg, hanging, is pushed by 2.9 m/s and swings up in a plane.
  const std::string text = R"(
[structure]
kind = "custom"
[[structure.nodes]]
name = "O"
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
name = "B"
position = [0, 0, -0.8]
velocity = [2.9, 0, 0]
mass = 1.7
[[structure.rods]]
nodes = ["O", "B"]
mass = 0.6
[[structure.constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 6
step = 0.005
)";
  const double start_energy = 0.5 * (1.7 + 0.6 / 3) * 2.9 * 2.9;
  const auto margin_until = [&](const std::string& end) {
    return margin_in(read_scene_text(text + "end_time = " + end + "\n", "swing.toml"));
  };
  // Before it turns: K / (K_0 - K), K from the full model's speed.
  const Scene scene = read_scene_text(text + "end_time = 0.21\n", "swing.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const VectorXd v = run.trajectory.velocities(run.trajectory.size() - 1);
  const double left = 0.5 * (1.7 + 0.6 / 3) * v.tail<3>().squaredNorm();
  const Margin short_one = margin_until("0.21");
  CHECK(short_one.arrives);
  CHECK(short_one.dynamic_min == Approx(left / (start_energy - left)).epsilon(1e-9));
  // 0 where it turns. Nothing drives it at rest; hanging nothing resists either, so that pose is not the
  // worst.
  const Margin whole = margin_until("2");
  CHECK(!whole.arrives);
  CHECK(std::abs(whole.dynamic_min) <= 1e-9);
  CHECK(whole.worst.margin == -1);
  CHECK(whole.worst.s == Approx(whole.motion.back().s).epsilon(1e-9));
  CHECK(whole.points.front().margin == 0);
}

TEST_CASE("the force along the path is the reaction of a drive that is held") {
  const double k = 900;
  for (const double angle : {71.3, 43.9, 11.7}) {
    const std::vector<std::string> at{"structure.fold_angle=" + std::to_string(angle),
                                      "gravity.acceleration=[0,0,-0.7]"};
    const Margin free = margin_in(ring(k, at));
    std::vector<std::string> locked = at;
    locked.emplace_back(R"(constraints=[{kind="angle",name="motor",fold_angle=true}])");
    // A scene in which nothing can move is refused: these are its equations.
    const Structure structure = build_structure(ring(k, locked));
    const System system(structure, true);
    State state = initial_state(structure, system).state;
    Index1 index1(system, true);
    VectorXd acceleration(state.z.size());
    REQUIRE(index1.evaluate(0.0, state.z, state.w, acceleration, state.lambda));
    const int row = system.constraint_row(static_cast<int>(structure.constraints.size()) - 1);
    REQUIRE(row >= 0);
    // The row is its length times the angle: its force on the angle is -length lambda, and balances all
    // others.
    const double reaction = system.constraint_lengths()[row] * state.lambda[row];
    CHECK(std::abs(std::abs(reaction) - std::abs(free.points[0].forces.sum())) <=
          1e-12 * free.points[0].forces.cwiseAbs().sum());
  }
}

TEST_CASE("where the dynamic margin is exactly zero at a known angle, the run stalls there") {
  // All energy is in the spring at 31 degrees: 12 f l (sin t_0 - sin t) = k/2 (t_0 - t)^2.
  const double stall = 31 * radians_per_degree, k = 2 * driven(stall) / ((start - stall) * (start - stall));
  const Scene scene = ring(k);
  const Margin margin = margin_in(scene);
  CHECK_FALSE(margin.arrives);
  CHECK(std::abs(margin.motion.back().fold_angle - stall) <= 1e-9);
  CHECK(std::abs(margin.dynamic_min) <= 1e-12);
  const Simulation run = simulate(build_model(scene), scene.solver);
  CHECK(run.status == RunStatus::completed);
  double least = start;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i)
    least =
        std::min(least, run.trajectory.structure().deployment.fold_angle(run.trajectory.node_positions(i)));
  CHECK(least >= stall - 1e-9);
  // Between two states at rest a step of 0.01 s apart it is nearer by a t^2 / 2 with some 1 rad/s^2.
  CHECK(least <= stall + 1e-4);
  CHECK_FALSE(margin_in(ring(1.001 * k)).arrives);
  // A little less resistance than what would stall it at the deployed pose: it arrives.
  const double last = 2 * driven(0) / (start * start);
  CHECK(margin_in(ring(0.999 * last)).arrives);
  CHECK(margin_in(ring(0.999 * last)).dynamic_min == Approx(1 / 0.999 - 1).epsilon(1e-6));
}

TEST_CASE("a jammed hinge stalls the motion where its energy is used up") {
  const Scene scene = ring(0);
  const auto model = build_model(scene);
  const auto hinges = stuck_hinges(model, scene.solver, margin_of(model, scene.solver), 0);
  REQUIRE_FALSE(hinges.empty());
  // The hinge in the middle of a chord turns by 2 (t_0 - t).
  double torque = 1e300;
  for (int i = 1; i <= 20000; ++i) {
    const double angle = start * (1 - i / 20000.0);
    torque = std::min(torque, driven(angle) / (2 * (start - angle)));
  }
  const auto chord = std::find_if(hinges.begin(), hinges.end(),
                                  [](const StuckHinge& h) { return std::abs(h.turn - 2 * start) < 1e-6; });
  REQUIRE(chord != hinges.end());
  // Least at the start, where it is half of 12 f l cos(t_0); the first part of a step is 1e-6 of the way.
  CHECK(chord->stall_torque == Approx(torque).epsilon(1e-3));
  // At rest the torque 12 f l cos t on the fold angle, of which the hinge turns twice as much: least at the
  // start.
  CHECK(chord->static_torque == Approx(0.5 * 12 * f * l * std::cos(start)).epsilon(1e-3));
  // A stop at its angle instead: the run comes to rest on it there.
  const Scene jam = ring(0, {R"(constraints=[{kind="angle_stop",name="jam",fold_angle=true,min=52}])"});
  const Simulation run = simulate(build_model(jam), jam.solver);
  const double fold = run.trajectory.structure().deployment.fold_angle(
      run.trajectory.node_positions(run.trajectory.size() - 1));
  CHECK(fold == Approx(52 * radians_per_degree).epsilon(1e-10));
}

// Against a spring that takes nearly all of the energy by the end, so that the least is not at the start: of
// a hinge, or two together, that turn c times as far as the fold angle, K(t) / (c (t_0 - t)) and M(t) / c,
// with M = 12 f l cos t - k (t_0 - t) the torque at rest and K its integral.
TEST_CASE("hinges and pairs of them that jam stall where the spring has left least") {
  const double k = 0.96 * 2 * driven(0) / (start * start);
  const Scene scene = ring(k);
  const auto hinges = stuck_hinges(build_model(scene), scene.solver, margin_in(scene), 100);
  double stall = 1e300, stall_at = 0, weakest = 1e300;
  for (int i = 1; i <= 20000; ++i) {
    const double angle = start * (1 - i / 20000.0), way = start - angle;
    const double torque = (driven(angle) - 0.5 * k * way * way) / way;
    if (torque < stall) stall = torque, stall_at = angle;
    weakest = std::min(weakest, 12 * f * l * std::cos(angle) - k * way);
  }
  REQUIRE(weakest < 0);  // it passes by its momentum
  std::map<int, int> found;
  double single = 0, pairs = 0, singles = 0;
  for (const StuckHinge& h : hinges) {
    const double share = h.turn / start;
    const auto c = static_cast<int>(std::lround(share));
    const bool pair = h.name.find(" and ") != std::string::npos;
    (pair ? pairs : singles) += 1;
    if (!pair) single += h.turn;
    if (std::abs(share - c) > 1e-9) continue;
    ++found[pair ? 10 + c : c];
    INFO(h.name);
    // Of 20000 angles, next to the least a parabola: 1e-8 of it, and the place to one of them.
    CHECK(h.stall_torque == Approx(stall / c).epsilon(1e-7));
    CHECK(h.stall_fold == Approx(stall_at).epsilon(0).margin(1e-4));
    CHECK(h.static_torque == 0.0);
  }
  CHECK((found[1] > 0 && found[2] > 0 && found[12] > 0 && found[13] > 0 && found[14] > 0));
  // The two halves of each of 12 chords, and at each of 12 joints two chords and a post: every two of them
  // turn.
  CHECK(singles == 12 + 12 * 3);
  CHECK(pairs == singles * (singles - 1) / 2);
  double together = 0;  // each hinge is in one pair with every other one
  for (const StuckHinge& h : hinges)
    if (h.name.find(" and ") != std::string::npos) together += h.turn;
  CHECK(together == Approx((singles - 1) * single).epsilon(1e-12));
}

TEST_CASE("a jammed hinge holds the structure at rest where it turns most for what is left of the drive") {
  // Weakest at the end, where a tenth of the drive at 0 degrees is left, and twice the turn.
  const double k = 0.9 * 12 * f * l / start;
  const Scene scene = ring(k);
  const auto hinges = stuck_hinges(build_model(scene), scene.solver, margin_in(scene), 0);
  int halves = 0;
  for (const StuckHinge& h : hinges) {
    if (std::abs(h.turn - 2 * start) > 1e-6) continue;
    ++halves;
    // Of the last of some hundred parts of the way: a few hundredths above its value at the end.
    CHECK(h.static_torque == Approx(0.5 * 0.1 * 12 * f * l).epsilon(0.1));
  }
  CHECK(halves >= 12);
}

// Without a deployed pose the way is that in which it moves at the start: a pendulum thrown either way.
TEST_CASE("a margin without a deployed pose is that of the way on which the structure sets out") {
  for (const double speed : {1.3, -1.3}) {
    const Scene scene =
        read_scene_text(R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 0], fixed = true}, {name = "A", position = [0.8, 0, 0], mass = 1.5}]
rods = [{nodes = ["P", "A"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["A"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
end_time = 0.2
)",
                        "s.toml", {"structure.nodes[1].velocity=[0,0," + exact_number(speed) + "]"});
    const Margin margin = margin_in(scene);
    REQUIRE(margin.motion.size() > 3);
    // At level gravity is m g along the way down; s = sqrt(m) l times the angle turned.
    CHECK(margin.points.front().forces[0] ==
          Approx((speed < 0 ? 1 : -1) * std::sqrt(1.5) * 9.81).epsilon(1e-9));
    const MarginReach& last = margin.motion.back();
    const double turned = last.s / (std::sqrt(1.5) * 0.8);
    const double fall = (speed < 0 ? 1 : -1) * 0.8 * std::sin(turned);
    CHECK(last.kinetic == Approx(0.5 * 1.5 * 1.3 * 1.3 + 1.5 * 9.81 * fall).epsilon(0).margin(1e-8));
  }
}

// An angle without an axis turns back where its sides lie in line: the deployed pose may be as near to that
// as one likes.
TEST_CASE("the way ends at the deployed pose where what is measured turns back behind it") {
  for (const double deployed : {30.0, 5.0, 1.0, 0.3, 0.02, 0.0}) {
    const Scene scene = read_scene_text(R"toml(
[variables]
x = "=cos(80*deg)"
z = "=sin(80*deg)"
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "D", position = [2, 0, 0], fixed = true},
  {name = "B", position = ["=x", 0, "=z"]}, {name = "C", position = ["=2+x", 0, "=z"]},
  {name = "X", position = [0, 0, -1], fixed = true}]
rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 1}, {nodes = ["C", "D"], mass = 1},
  {nodes = ["A", "D"], mass = 0}]
[[constraints]]
kind = "plane"
nodes = ["B", "C"]
normal = [0, 1, 0]
[[forces]]
kind = "friction"
nodes = ["X", "A", "B"]
kinetic = 0.001
axis = [0, 1, 0]
[[loads]]
nodes = ["C"]
force = [8, 0, 0]
[deployment]
measure = "angle D A B"
)toml",
                                        "s.toml", {"deployment.deployed=" + exact_number(deployed)});
    const Margin margin = margin_in(scene);
    CHECK(margin.arrives);
    // The load drives with 8 N x 1 m x sin(angle), least in the end. Poses near the line, where there are two
    // ways on, are right to 1e-16 over the angle to it.
    CHECK(margin.worst.margin ==
          Approx(8 * std::sin(deployed * radians_per_degree) / 0.001 - 1).epsilon(1e-9));
  }
}

TEST_CASE("dry friction resists in every pose, with what it holds at rest and what it takes on the way") {
  const double most = 1100, kinetic = 700;
  const Margin margin = margin_in(
      ring(0, {R"(forces[0]={kind="friction",name="dry",fold_angle=true,kinetic=700,static=1100})"}));
  REQUIRE(margin.sources.size() == 2);
  CHECK(margin.sources[1].kind == "friction");
  for (std::size_t i = 1; i < margin.points.size(); i += 7) {
    const MarginPoint& p = margin.points[i];
    CHECK(p.forces[1] == Approx(-most).epsilon(1e-9));  // as above
    CHECK(p.margin == Approx(12 * f * l * std::cos(p.fold_angle) / most - 1).epsilon(1e-9));
  }
  // The drive is weakest folded.
  CHECK(margin.worst.margin == Approx(12 * f * l * std::cos(start) / most - 1).epsilon(1e-9));
  CHECK(margin.arrives);
  CHECK(margin.motion.back().resisted == Approx(kinetic * start).epsilon(1e-8));
  // Work is what it takes on the way: 12 f l (sin start - sin angle) over 700 (start - angle), least at the
  // start.
  CHECK(margin.dynamic_min == Approx(12 * f * l * std::cos(start) / kinetic - 1).epsilon(1e-9));
  CHECK(margin.dynamic_at == 0);
  // What holds more than the drive gives holds for good.
  const Scene held = ring(0, {R"(forces[0]={kind="friction",fold_angle=true,kinetic=1700,static=1720})"});
  CHECK(12 * f * l * std::cos(start) < 1720);
  CHECK(margin_in(held).worst.margin < 0);
  CHECK_FALSE(margin_in(held).arrives);
}

TEST_CASE("no margin where there is no path, or a drive does what it is told") {
  const auto refusal = [](const char* name) {
    const Scene scene = read_scene_file(find_scene(name), {});
    try {
      margin_in(scene);
    } catch (const PathRefused& refused) {
      return std::string(refused.what());
    }
    return std::string();
  };
  CHECK(refusal("hoop6_motor").find("a drive prescribes the motion") != std::string::npos);
  CHECK(refusal("chain").find("degrees of freedom") != std::string::npos);
}

// A rod on a fixed hinge, which its load takes past the line with another one: there the angle between both
// turns back, and with an axis it goes on.
TEST_CASE("no margin names what acts on an angle that turns back and its cure gives one") {
  const auto text = [](const std::string& entry, const std::string& axis) {
    return R"([structure]
kind = "custom"
nodes = [{name = "A", position = [-1, 0, 0], fixed = true}, {name = "B", position = [0, 0, 0], fixed = true},
  {name = "C", position = [0.6, 0, 0.8]}, {name = "D", position = [0, 0, -1], fixed = true}]
rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 1}]
constraints = [{kind = "plane", nodes = ["C"], normal = [0, 1, 0]}]
[[loads]]
nodes = ["C"]
force = [0, 0, -9]
[[forces]]
nodes = ["A", "B", "C"]
)" + entry +
           axis +
           R"(
[deployment]
measure = "length D C"
deployed = 1
)";
  };
  for (const std::string entry :
       {"kind = \"friction\"\nname = \"own\"\nkinetic = 0.1\n",
        "kind = \"torsion_spring\"\nname = \"own\"\nstiffness = 0.1\n",
        "kind = \"motor\"\nname = \"own\"\nstall_torque = 0.1\nno_load_speed = 100\n"}) {
    CHECK_THROWS_WITH(
        margin_in(read_scene_text(text(entry, ""), "own.toml")),
        Catch::Contains("the angle that 'own' acts on turns back") && Catch::Contains("give it an axis"));
    CHECK(margin_in(read_scene_text(text(entry, "axis = [0, 1, 0]"), "own.toml")).points.back().s > 0);
  }
}

// A lies straight above P, which its guide and the plane hold: to first order A can move sideways, and no
// further than that.
TEST_CASE("no margin where no path leads on from the start") {
  const Scene scene = read_scene_text(R"([structure]
kind = "custom"
nodes = [{name = "O", position = [6, 0, 0], fixed = true}, {name = "A", position = [2, 0, 0.2]},
  {name = "P", position = [2, 0, 0]}]
rods = [{nodes = ["O", "A"], mass = 1}, {nodes = ["A", "P"], mass = 2}]
[[constraints]]
kind = "plane"
nodes = ["*"]
normal = [0, 0, 1]
[[constraints]]
kind = "line"
nodes = ["P"]
direction = [2, 1, 1]
)",
                                      "stuck.toml");
  CHECK_THROWS_WITH(margin_in(scene), Catch::Contains("no path leads on from the pose at the start"));
}

}  // namespace margin_test
