// SPDX-License-Identifier: BSD-3-Clause
// Motions along a path against the full model's and against the ring's exact one; what the path refuses.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "core/diagnostics/diagnostics.hpp"
#include "core/path/path_forces.hpp"
#include "core/path/path_run.hpp"
#include "core/path/path_scope.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/reference.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/hoop_exact.hpp"
#include "tests/support/number.hpp"
#include "tests/support/runs_apart.hpp"

using namespace unfurl;
using unfurl::testing::number;

namespace path_run_test {

namespace {

struct Both {
  Simulation path, full;
};

Scene scene_with(const std::string& name, const std::vector<std::string>& changes) {
  return read_scene_file(find_scene(name), changes);
}

// The full model with seven stages, order 12: at the scenes' steps its error is below 1e-12 m, but for what
// rounding leaves of it next to singular poses.
Both both(const Scene& scene, double end = 0) {
  SolverOptions options = scene.solver;
  if (options.method == "dvm")
    options.nodes = "lobatto", options.constraints_at = "nodes", options.stages = 7;
  if (end > 0) options.end_time = std::min(end, options.end_time);
  const auto model = build_model(scene);
  return {simulate_on_path(model, options), simulate(model, options)};
}

void check_same(const Both& run, double tolerance) {
  CHECK(run.path.status == run.full.status);
  CHECK(run.path.trajectory.size() == run.full.trajectory.size());
  CHECK(testing::runs_apart(run.path, run.full) <= tolerance);
  CHECK(std::abs(run.path.trajectory.end_time() - run.full.trajectory.end_time()) <= 1e-10);
  REQUIRE(run.path.events.size() == run.full.events.size());
  for (std::size_t e = 0; e < run.path.events.size(); ++e) {
    CHECK(run.path.events[e].name == run.full.events[e].name);
    CHECK(run.path.events[e].kind == run.full.events[e].kind);
    CHECK(run.path.events[e].element == run.full.events[e].element);
    CHECK(std::abs(run.path.events[e].t - run.full.events[e].t) <= 1e-10);
    CHECK(run.path.events[e].energy_lost ==
          Approx(run.full.events[e].energy_lost).epsilon(1e-9).margin(1e-9));
  }
  // What holds, slips or pulls from the start does so in the first state: no step lies before that.
  const auto at_start = [](const Simulation& one) -> Eigen::RowVectorXd {
    return diagnose(one).axial_force.row(0);
  };
  const Eigen::RowVectorXd forces = at_start(run.full);
  CHECK((at_start(run.path) - forces).lpNorm<Eigen::Infinity>() <=
        1e-8 * (1 + forces.lpNorm<Eigen::Infinity>()));
}

std::string refusal(const Scene& scene) {
  try {
    simulate_on_path(build_model(scene), scene.solver);
  } catch (const PathRefused& refused) {
    return refused.what();
  }
  return "";
}

const std::vector<std::string> four_bar_cases{
    R"(forces[0]={kind="spring",nodes=["B","D"],stiffness=40,damping=3})",
    R"(forces[0]={kind="torsion_spring",rods=["crank","coupler"],stiffness=5,damping=0.3,axis=[0,1,0]})",
    R"(forces[0]={kind="spring",nodes=["B","D"],stiffness=400,tension_only=true,free_length=3.3})",
    R"(forces[0]={kind="spring",nodes=["B","D"],stiffness=400,damping=5,tension_only=true,free_length=3.3})",
    R"(constraints[0]={kind="length_stop",nodes=["B","D"],max=3.5,restitution=0.7})",
    R"(forces[0]={kind="load_over_time",nodes=["B"],force=[3,0,-5],times=[0,1,2.03,4],values=[0,1,-2,0.5]})",
    R"(forces[0]={kind="follower",rod="coupler",force=2})",
    R"(forces[0]={kind="joint_damping",nodes=["B","C"],damping=0.4})",
    R"(forces[0]={kind="drag",nodes=["B"],damping=0.2})",
    R"(forces[0]={kind="offload",nodes=["B"],length=7})",
    R"(forces[0]={kind="motor",rods=["crank","coupler"],stall_torque=0.9,no_load_speed=310,gear_ratio=-7,)"
    R"(axis=[0,1,0]})",
    "gravity.acceleration=[0.4,0,-3]"};

}  // namespace

TEST_CASE("on every scene of the library the path is the full model's motion, or refuses with the reason") {
  int along = 0;
  for (const LibraryScene& entry : library_scenes()) {
    INFO(entry.name);
    const Scene scene = read_scene_file(entry.path, {});
    if (scene.solver.constraints_at == "ends") continue;  // the same scene as another, by a method of order 2
    const std::string why = refusal(scene);
    if (!why.empty()) {
      INFO(why);
      const bool reason = why.find("degrees of freedom") != std::string::npos ||
                          why.find("not known to the path") != std::string::npos ||
                          why.find("cable") != std::string::npos ||
                          why.find("the path does not know") != std::string::npos;
      CHECK(reason);
      continue;
    }
    ++along;
    check_same(both(scene, 6.0), 1.1e-11);
  }
  CHECK(along >= 10);
}

TEST_CASE("forces, dampers, cables and stops act on the path as on the full model") {
  for (const std::string& change : four_bar_cases) {
    INFO(change);
    std::vector<std::string> changes{change};
    if (change.find("offload") != std::string::npos) changes.emplace_back("gravity.acceleration=[0,0,-2]");
    check_same(both(scene_with("four_bar", changes), 3.0), 1e-11);
  }
}

TEST_CASE("several cables go slack and taut on the path, each by itself") {
  const Both run = both(
      scene_with(
          "four_bar",
          {R"(forces[0]={kind="spring",nodes=["B","D"],stiffness=400,tension_only=true,free_length=3.3})",
           R"(forces[1]={kind="spring",nodes=["A","C"],stiffness=70,tension_only=true,free_length=2.9})",
           R"(forces[2]={kind="spring",nodes=["B","D"],stiffness=900,tension_only=true,free_length=3.45})"}),
      3.0);
  check_same(run, 1e-11);
  std::set<std::string> taken_up;
  for (const Event& event : run.full.events) taken_up.insert(event.element);
  CHECK(taken_up.size() >= 2);
}

TEST_CASE("a stop that is met at the turn of its length, between two looks, is met on the path too") {
  // The crank passes the line through both supports with B 4 m from D, and A is 3.9529645461488205 m from C
  // where they are furthest apart: within a small part of a step the stop is passed by so little. It throws
  // back even so: no force would hold what came to rest on it, and rounding decide when it leaves.
  for (const double little : {1e-3, 1e-5, 1e-7})
    for (const auto& [nodes, most] : {std::pair{R"(["B","D"])", 4.0}, {R"(["A","C"])", 3.9529645461488205}}) {
      INFO(nodes << " by " << little << " m");
      const Both run = both(
          scene_with("four_bar", {std::string(R"(constraints[0]={kind="length_stop",nodes=)") + nodes +
                                  ",max=" + number(most - little) + ",restitution=0.6,rest_speed=1e-5}"}),
          2.5);
      CHECK(run.full.events.size() == 1);
      // A crossing is located to some 1e-13 m of the gap; where that closes at a rate r an error e of it is
      // one of e / r in the time, and r^2 is 2 `little` times a curvature of 1/m and more, at metres a
      // second.
      check_same(run, 2e-11 + 2e-13 / std::sqrt(little));
    }
}

TEST_CASE("loads much shorter than a step move the linkage, and what holds it gives way to them") {
  const std::string pulse =
      R"(={kind="load_over_time",nodes=["B"],force=[-900,0,0],times=[1.3017,1.3027,1.3037],values=[0,1,0]})";
  const std::string friction =
      R"(forces[0]={kind="friction",rods=["crank","coupler"],axis=[0,1,0],kinetic=14,static=19})";
  const std::vector<std::vector<std::string>> cases{
      {"forces[0]" + pulse},
      // Three newton seconds at a stop that has held the linkage for a second, and friction that has.
      {"gravity.acceleration=[2,0,0]", R"(constraints[0]={kind="length_stop",nodes=["B","D"],min=2.5})",
       "forces[0]" + pulse},
      {friction, "forces[1]" + pulse}};
  for (const auto& changes : cases)
    for (const char* step : {"solver.step=0.01", "solver.step=0.0413"}) {
      INFO(changes.front() << " " << step);
      std::vector<std::string> all = changes;
      all.emplace_back(step);
      const Both run = both(scene_with("four_bar", all), 2.0);
      CHECK(run.path.events.size() == changes.size() - 1 + (changes.size() == 2 ? 2 : changes.size() == 3));
      check_same(run, std::string(step) == "solver.step=0.01" ? 1e-10 : 1e-6);
    }
}

TEST_CASE("a stop that throws back lets go of what meets it too slowly to be thrown and is pulled away") {
  // The linkage begins slowly, 22 um from the stop, towards it and away from it to fall back.
  for (const char* gravity : {"[3,0,0]", "[1,0,2]", "[0.4,0,-3]"})
    for (const double share : {0.05, -0.05}) {
      INFO(gravity << " " << share);
      const Both run =
          both(scene_with("four_bar", {std::string("gravity.acceleration=") + gravity,
                                       "structure.nodes[1].velocity=[" + number(3.4 * share) + ",0,0]",
                                       "structure.nodes[2].velocity=[" + number(3.12 * share) + ",0," +
                                           number(0.52 * share) + "]",
                                       R"(constraints[0]={kind="length_stop",nodes=["B","D"],max=3.1623,)"
                                       "rest_speed=0.4,restitution=0.6}"}),
               4.0);
      CHECK(!run.full.events.empty());
      check_same(run, 2e-11);
    }
}

TEST_CASE("a cable that is taut, or just so, at the start pulls on the path as in the full model") {
  // A and C are 3.5384 m apart there.
  for (const char* length : {"2.9", "3.5", "3.53", "3.54", "3.6"})
    for (const char* damping : {"0", "6"}) {
      INFO(length << " m, " << damping << " N s/m");
      check_same(both(scene_with("four_bar",
                                 {std::string(R"(forces[0]={kind="spring",nodes=["A","C"],stiffness=70,)") +
                                  "tension_only=true,free_length=" + length + ",damping=" + damping + "}"}),
                      3.0),
                 1e-11);
    }
}

TEST_CASE("friction slips, reverses, sticks and gives way on the path as in the full model") {
  const std::string
      weak = R"(forces[0]={kind="friction",rods=["crank","coupler"],axis=[0,1,0],kinetic=0.4,static=0.7})",
      strong = R"(forces[0]={kind="friction",rods=["crank","coupler"],axis=[0,1,0],kinetic=14,static=19})";
  const std::vector<std::vector<std::string>> cases{
      {weak},
      {weak, "gravity.acceleration=[0.4,0,-3]"},
      {strong},
      {strong, "gravity.acceleration=[0.4,0,-3]"},
      // It comes to rest and is pulled loose again.
      {strong,
       R"(forces[1]={kind="load_over_time",nodes=["B"],force=[60,0,150],times=[0,1.9,2.6,4],values=[0,0,1,0.2]})"},
      // Begins at rest, held.
      {strong, "structure.nodes[1].velocity=[0,0,0]", "structure.nodes[2].velocity=[0,0,0]",
       R"(forces[1]={kind="load_over_time",nodes=["B"],force=[90,0,10],times=[0,1,4],values=[0,1,0.3]})"},
      // A length that grows and shrinks while the linkage turns on.
      {R"(forces[0]={kind="friction",nodes=["B","D"],kinetic=0.8})"}};
  std::set<std::string> kinds;
  for (const auto& changes : cases) {
    INFO(changes.front() << " " << changes.back());
    const Both run = both(scene_with("four_bar", changes), 4.0);
    check_same(run, 1e-10);
    for (const Event& event : run.path.events) kinds.insert(event.kind);
  }
  CHECK(kinds == std::set<std::string>{"reversal", "slip", "stick"});
  CHECK(refusal(scene_with("four_bar", {weak, R"(forces[1]={kind="friction",nodes=["B","D"],kinetic=1})"}))
            .find("friction beside") != std::string::npos);
}

TEST_CASE("behind the deployed pose the path goes on as the full model does") {
  check_same(both(scene_with("hoop6", {"solver.at_deployed=pass"}), 6.0), 1e-11);
  check_same(both(scene_with("hoop6", {"solver.at_deployed=latch"}), 5.2), 1.1e-11);
  check_same(both(scene_with("scissor_mast", {"solver.at_deployed=latch", "solver.end_time=1.5"})), 1e-11);
  check_same(both(scene_with("scissor_mast", {"solver.at_deployed=latch", "solver.end_time=2.5",
                                              R"(forces[0]={kind="latch",stiffness=4000,damping=40})"})),
             1e-11);
}

// A multiplier off by 1e-9 of some 1e3 N moves what gives 1e-8 m/N at most by 1e-14 m. Next to the deployed
// pose rods that push each other over give 1/x, x the angle that is left: 1e-4 m there, of which the last
// digits of x tell four or so.
TEST_CASE("what rods give in a quasi-static model is shown on the path as on the full model") {
  const std::vector<std::string> gives{"structure.youngs_modulus=7e10", "structure.rod_model=quasi-static"};
  const auto shown = [&](const char* name, std::vector<std::string> changes, double end) {
    INFO(name);
    const Trajectory rigid = both(scene_with(name, changes), end).path.trajectory;
    changes.insert(changes.end(), gives.begin(), gives.end());
    const Both run = both(scene_with(name, changes), end);
    const Trajectory &path = run.path.trajectory, &full = run.full.trajectory;
    REQUIRE(path.size() == full.size());
    REQUIRE(path.size() == rigid.size());
    double given = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      double most = 1e-11;
      for (const Event& event : run.path.events)
        if (event.kind == "deployed" && std::abs(event.t - path.time(i)) < 0.02) most = 1e-5;
      CHECK(node_distance(path.positions(i), full.positions(i)) <= most);
      given = std::max(given, node_distance(path.positions(i), rigid.positions(i)));
    }
    CHECK(given > 1e-6);
  };
  shown("hoop6", {"structure.fold_angle=60"}, 1.0);
  shown("hoop6", {"structure.fold_angle=60", "solver.at_deployed=latch"}, 1.9);
  shown("scissor_mast", {}, 0.5);
  shown("hoop6",
        {"structure.fold_angle=60", "gravity.acceleration=[0,0,-2]",
         R"(constraints[0]={kind="angle_stop",fold_angle=true,min=50})"},
        2.0);
}

// A deployed pose that is not singular says itself what its forces and reactions are; those of a stroke that
// ends at speed are largest there. They agree as round-off of the pose, and of redundant rows, leaves them.
TEST_CASE("in a regular deployed pose forces and reactions are known on the path as in the full model") {
  const std::vector<std::pair<const char*, std::vector<std::string>>> scenes{
      {"scissor_mast",
       {"structure.cells=5", "structure.fold_angle=85.8", "structure.deployed_angle=9.4",
        "structure.tip_force=76", "gravity.acceleration=[0,0,9.81]", "solver.step=0.005"}},
      {"hoberman", {"structure.deployed_angle=5"}},
      {"reentrant_sheet", {"structure.deployed_angle=12"}}};
  for (const auto& [name, changes] : scenes) {
    INFO(name);
    const Both run = both(scene_with(name, changes));
    REQUIRE(run.path.status == RunStatus::deployed);
    REQUIRE(run.full.status == RunStatus::deployed);
    const Diagnostics path = diagnose(run.path), full = diagnose(run.full);
    REQUIRE(path.columns.size() == full.columns.size());
    double largest = 0;  // of all forces: reactions that vanish are round-off of these
    for (const Series& column : full.columns)
      for (const double x : column.values)
        if (column.unit == "N" && std::abs(x) > largest) largest = std::abs(x);
    for (std::size_t c = 0; c < full.columns.size(); ++c) {
      const Series &a = path.columns[c], &b = full.columns[c];
      if (a.unit != "N" && !a.name.ends_with("_unique")) continue;
      INFO(a.name);
      CHECK(std::abs(a.values.back() - b.values.back()) <= 1e-6 * largest);
    }
  }
}

// What pushes across the path makes noise of the tangent's there, where the constraints lose rank: steps that
// ask for more than is known would never end. So they would where a stiff latch leaves next to nothing.
TEST_CASE("forces across the path do not stop the motion where its pose is singular") {
  const std::vector<std::string> ring{"structure.units=6", "structure.fold_angle=70"};
  std::vector<std::string> passes = ring, latches = ring;
  passes.insert(passes.end(), {"gravity.acceleration=[1.38767,0.857493,0.719584]", "solver.step=0.005",
                               "solver.at_deployed=pass", "solver.end_time=0.82"});
  latches.insert(latches.end(),
                 {"gravity.acceleration=[-1.22748,1.75865,-0.8307]", "solver.at_deployed=latch",
                  "solver.end_time=1.39", R"(forces[0]={kind="joint_damping",nodes=["T2"],damping=0.154017})",
                  R"(forces[1]={kind="latch",stiffness=4160.1,damping=30.4389})"});
  check_same(both(scene_with("scissor_ring", passes)), 1e-10);
  check_same(both(scene_with("scissor_ring", latches)), 1e-10);
}

// The ring swings to and fro through the poses in which its constraints lose rank. Short steps have ends and
// nodes so close to them that no iteration finds those.
TEST_CASE("a ring swings through singular poses in steps of any size, when the path says") {
  for (const auto& [units, step] : {std::pair{6, "0.002"}, {7, "0.001"}, {8, "0.001"}}) {
    INFO(units << " units, " << step << " s");
    const Scene scene =
        scene_with("hoop6", {"structure.units=" + std::to_string(units), std::string("solver.step=") + step,
                             "solver.at_deployed=pass", "structure.fold_angle=57", "solver.end_time=6.5"});
    SolverOptions options = scene.solver;
    options.stages = 4, options.nodes = "lobatto", options.constraints_at = "nodes";
    const auto model = build_model(scene);
    const Simulation full = simulate(model, options), path = simulate_on_path(model, options);
    CHECK(full.status == RunStatus::completed);
    const Trajectory &a = full.trajectory, &b = path.trajectory;
    REQUIRE(a.end_time() == b.end_time());
    // Order 6: the energy balance is 1e-9 of what a swing turns over, and so is its period; over some ten
    // swings of a few m/s that is 1e-7 m at most.
    CHECK(node_distance(a.positions(a.size() - 1), b.positions(b.size() - 1)) <= 1e-7);
  }
}

TEST_CASE("a drive says where the path is, and bounces on a stop come to rest as in the full model") {
  // The motor's velocity jumps at the start; it reaches the deployed pose after 4.25 s.
  const Both driven = both(scene_with(
      "hoop6_motor", {R"(constraints[0]={kind="angle",name="m",fold_angle=true,motion="rate",rate=-20})"}));
  CHECK(driven.path.status == RunStatus::deployed);
  CHECK(std::abs(driven.path.trajectory.end_time() - 4.25) <= 1e-12);  // (85 - 0) / 20 degrees per second
  CHECK(driven.path.trajectory.size() == driven.full.trajectory.size());
  for (const char* restitution : {"0.3", "0.6"}) {
    const Both bounced = both(scene_with(
        "hoop6", {std::string(R"(constraints[0]={kind="angle_stop",fold_angle=true,min=30,restitution=)") +
                      restitution + "}",
                  "solver.end_time=9"}));
    // The series of impacts is a geometric one; its last, 1e-4 of a step apart, may be one more or less.
    REQUIRE(bounced.path.events.size() > 6);
    CHECK(std::abs(std::ssize(bounced.path.events) - std::ssize(bounced.full.events)) <= 1);
    for (std::size_t e = 0; e < 5; ++e)
      CHECK(std::abs(bounced.path.events[e].t - bounced.full.events[e].t) <= 1e-10);
    const Trajectory &path = bounced.path.trajectory, &full = bounced.full.trajectory;
    CHECK(node_distance(path.positions(path.size() - 1), full.positions(full.size() - 1)) <= 1e-11);
  }
}

TEST_CASE("the ring's deployment time is the exact one, and its deployed pose") {
  for (const double angle : {89.34053637766085, 61.7, 12.3}) {
    const Scene scene = scene_with("hoop6", {"structure.fold_angle=" + std::to_string(angle)});
    const exact::Hoop given{.fold_angle_deg = std::stod(std::to_string(angle))};
    const Simulation run = simulate_on_path(build_model(scene), scene.solver);
    INFO(angle);
    REQUIRE(run.status == RunStatus::deployed);
    // Near dead centre 1e-16 in the angle, of some 0.01 from it, is 1e-14 of the time.
    CHECK(run.trajectory.end_time() == Approx(given.time(0.0)).epsilon(1e-12));
    const VectorXd q = run.trajectory.positions(run.trajectory.size() - 1);
    // Node 2 is the first bottom hinge: at half a post below the middle when deployed. One hinge alone is
    // free there: rounding of 1e-16 over the angle of the poses that tell of it, some 1e-4.
    CHECK(std::abs(q[3 * 2 + 2] + 0.6) <= 1e-11);
  }
}

TEST_CASE("the equations hold what the path holds: forces and constraints follow from its states") {
  const Scene scene = scene_with("hoop6", {});
  const auto model = build_model(scene);
  const Simulation run = simulate_on_path(model, scene.solver);
  VectorXd phi(model->system.constraints());
  for (std::size_t i = 0; i < run.trajectory.size(); i += 40) {
    model->system.constraint(run.trajectory.time(i), run.trajectory.node_positions(i), phi);
    CHECK(phi.lpNorm<Eigen::Infinity>() <= 1e-13);
    // Energy: the loads' work is the kinetic energy, to the rounding of sums of some 1e4 J.
    const double gone = model->system.load_work(run.trajectory.node_positions(i)) -
                        model->system.load_work(run.trajectory.node_positions(0));
    CHECK(model->system.kinetic_energy(run.trajectory.state(i).w) ==
          Approx(gone).epsilon(1e-10).margin(1e-8));
  }
}

TEST_CASE("what the path does not know is refused, and auto says why it took the full model") {
  Scene scene = scene_with("double_pendulum", {"solver.end_time=0.1", "solver.model=auto"});
  const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
  CHECK(solved_as(run).name == "full");
  CHECK(solved_as(run).why.find("4 degrees of freedom") != std::string::npos);
  scene.solver.model = "path";
  CHECK_THROWS_WITH(simulate_as_asked(build_model(scene), scene.solver),
                    Catch::Contains("solver.model = \"path\"") && Catch::Contains("4 degrees of freedom"));
  Structure structure = build_model(scene_with("four_bar", {}))->structure;
  structure.forces.push_back({.kind = "magnet", .name = "m", .nodes = {1}});
  CHECK(unknown_to_path(structure).find("magnet") != std::string::npos);
  CHECK(unknown_to_path(build_model(scene_with("four_bar", {}))->structure).empty());
}

TEST_CASE("what holds a measure that the path does not know is named with it") {
  for (const auto& [kind, words] : {std::pair(MeasureKind::dihedral, "'sync' holds an angle between planes"),
                                    std::pair(MeasureKind::combination, "'sync' holds a sum of measures")}) {
    Structure structure = build_model(scene_with("four_bar", {}))->structure;
    structure.constraints.push_back({"measure", "sync", {}, {}, 0.0, {}, {}});
    structure.constraints.back().measure.kind = kind;
    CHECK_THAT(unknown_to_path(structure), Catch::StartsWith(words));
  }
}

// A triangle on a linkage: its corners are hinges that cannot turn. What friction they have does no work and
// no rod feels it.
TEST_CASE("friction in a hinge that cannot turn does not slip on the path") {
  const auto largest = [](const char* kinetic) {
    const Scene scene = read_scene_text(R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [3, 0, 0], fixed = true},
  {name = "A", position = [0, 1, 0], mass = 1}, {name = "B", position = [2, 2, 0], mass = 1},
  {name = "C", position = [1, 3, 0], mass = 1}]
rods = [{nodes = ["O", "A"], mass = 0.3}, {nodes = ["A", "B"], mass = 0.3}, {nodes = ["B", "P"], mass = 0.3},
  {nodes = ["A", "C"], mass = 0.3}, {nodes = ["B", "C"], mass = 0.3}]
[[constraints]]
kind = "plane"
nodes = ["A", "B", "C"]
normal = [0, 0, 1]
[[loads]]
nodes = ["A"]
force = [1, 0, 0]
[[forces]]
kind = "friction"
nodes = ["B", "A", "C"]
axis = [0, 0, 1]
kinetic = )" + std::string(kinetic) + R"(
[solver]
end_time = 1
)",
                                        "triangle.toml");
    return diagnose(simulate_on_path(build_model(scene), scene.solver, {})).axial_force.cwiseAbs().maxCoeff();
  };
  const double without = largest("1e-9");
  CHECK(largest("1") == Approx(without).epsilon(1e-8));
  CHECK(largest("5") == Approx(without).epsilon(1e-8));
}

}  // namespace path_run_test
