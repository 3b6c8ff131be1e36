// SPDX-License-Identifier: BSD-3-Clause
// Locking at the end of travel: momentum, the energy lost, and the structure that goes on.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/latch.hpp"
#include "core/study/table.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

TEST_CASE("a ring that latches loses its kinetic energy and then stands still under its loads") {
  for (const char* kind : {"full", "sector"}) {
    SolverOptions options = dvm_options(3, 0.01, 5.2);
    options.at_deployed = "latch";
    const Simulation run = simulate(make_model(hoop_structure({{"model", std::string(kind)}})), options);
    INFO(kind << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    REQUIRE(run.events.size() == 2);
    CHECK(run.events[0].name == "deployed");
    CHECK(run.events[1].name == "latched");
    CHECK(run.events[1].t == run.events[0].t);
    const Diagnostics d = diagnose(run);
    const auto& kinetic = d.at("kinetic_energy_J").values;
    std::size_t i = 0;
    while (d.t[i + 1] != d.t[i]) ++i;
    // All of it: a deployed ring cannot move as a whole between its symmetry planes.
    CHECK(run.events[1].energy_lost == Approx(kinetic[i]).epsilon(1e-12));
    CHECK(kinetic[i] > 1.0);
    CHECK(d.at("impact_loss_J").values.back() == Approx(run.events[1].energy_lost).epsilon(1e-12));
    CHECK(kinetic.back() <= 1e-12 * kinetic[i]);
    const VectorXd at_latch = run.trajectory.positions(i),
                   at_end = run.trajectory.positions(run.trajectory.size() - 1);
    // The pose at the event is extrapolated; the first locked step brings its constraints to round-off.
    CHECK((at_end - at_latch).lpNorm<Eigen::Infinity>() <= 1e-9);
    // The balance before it is that of the run itself; the impulse and what follows add nothing.
    const auto& balance = d.at("energy_balance_J").values;
    CHECK(std::abs(balance.back() - balance[i]) <= 1e-9 * kinetic[i]);
    CHECK(run.trajectory.end_time() == Approx(5.2));
  }
}

TEST_CASE("a folding rod that latches while it flies keeps its momentum and its spin") {
  // Two rods, hinged, free in the plane: the second turns about the hinge until it is in line with the first.
  CustomSpec spec;
  spec.nodes = {{"A", {-1, 0, 0}, {0, 0, 0}, 0, false},
                {"H", {0, 0, 0}, {0, 0, 0}, 0, false},
                {"B", {0, 1, 0}, {2, 0, 0}, 0, false}};
  spec.rods = {{"AH", {"A", "H"}, 1.0}, {"HB", {"H", "B"}, 1.0}};
  Structure structure = build_custom(spec);
  for (const int node : {0, 1, 2})
    structure.constraints.push_back({"plane", "plane", {node}, {Vec3::UnitZ()}, 0.0, {}, {}});
  // In the frame of the first rod there is no linear measure of the angle: latch the collinear pose as the
  // relation x_A - 2 x_H + x_B = 0 of the ends with the middle, reached by y alone.
  structure.deployment.fold_sine = {{0, 1, 2}, {Vec3(0, 1, 0), Vec3(0, -2, 0), Vec3(0, 1, 0)}, 0.0};
  structure.deployment.fold_cosine = {{1, 2}, {Vec3(-1, 0, 0), Vec3(1, 0, 0)}, 0.0};
  structure.deployment.initial_fold_angle = pi / 2;
  SolverOptions options = dvm_options(4, 0.01, 3.0);
  options.at_deployed = "latch";
  const Simulation run = simulate(make_model(structure), options);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.events.size() == 2);
  const Model& model = run.trajectory.model();
  std::size_t i = 0;
  while (run.trajectory.time(i + 1) != run.trajectory.time(i)) ++i;
  const auto momentum = [&](std::size_t k) {
    const VectorXd p = model.system.node_mass() * run.trajectory.node_velocities(k);
    return Vec3(p.segment<3>(0) + p.segment<3>(3) + p.segment<3>(6));
  };
  const double before = model.system.kinetic_energy(run.trajectory.state(i).w);
  CHECK((momentum(i + 1) - momentum(i)).norm() <= 1e-12);  // the latch is an internal constraint
  CHECK(run.events[1].energy_lost > 0.0);
  CHECK(run.events[1].energy_lost < before);
}

TEST_CASE(
    "every scene that can deploy latches in its deployed pose, and the impact takes what its loads put in") {
  int latched = 0;
  for (const LibraryScene& entry : library_scenes()) {
    const Scene scene = read_scene_file(entry.path, {});
    const auto model = build_model(scene);
    const Structure& s = model->structure;
    // Of constant loads alone: what winches and springs have done is not force times way.
    if (s.deployment.empty() || !model->system.drives().empty() || !s.forces.empty()) continue;
    SolverOptions options = scene.solver;
    options.at_deployed = "latch";
    const Simulation run = simulate(model, options);
    INFO(entry.name << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    const auto event = std::find_if(run.events.begin(), run.events.end(),
                                    [](const Event& e) { return e.name == "latched"; });
    if (event == run.events.end()) continue;  // its end time comes before the deployed pose
    ++latched;
    const Diagnostics d = diagnose(run);
    CHECK(d.at("deployed_fraction").values.back() == Approx(1.0).epsilon(1e-9));
    // The pose of the impact is extrapolated to 1e-9 and projected twice, all others are solved.
    for (const double x : d.at("constraint_relative_max").values) CHECK(x <= 1e-12);
    // One freedom, released at rest, in a pose that the latch holds: all that constant loads have done is
    // lost, and that is force times way. The tolerance is what the scenes' own steps leave of the energy, as
    // every_scene_test has it.
    const double tolerance = scene.solver.constraints_at == "ends" ? 1e-2
                             : scene.solver.stages <= 3            ? 2e-4
                                                                   : 1e-6;
    const VectorXd way = run.trajectory.positions(run.trajectory.size() - 1) - run.trajectory.positions(0);
    double work = 0;
    for (const LoadCopy& load : s.load_copies) work += load.force.dot(way.segment<3>(3 * load.node));
    CHECK(event->energy_lost == Approx(work).epsilon(tolerance));
    CHECK(d.at("kinetic_energy_J").values.back() <= 1e-12 * work);
  }
  CHECK(latched >= 8);
}

namespace {

constexpr double arm = 0.8, rod_mass = 0.9, tip = 0.35, rate = 0.9;
constexpr double inertia = (rod_mass / 3 + tip) * arm * arm;

// A rod on a pivot that turns into line with the x axis, free of loads, and is latched there by a spring. EA:
// the rod gives, and starts stretched as its turning keeps it, without a wave; 0: it is rigid.
// shares: of k and c, each an entry.
Simulation turned_in(double k, double c, double end_time, double EA = 0,
                     const std::vector<double>& shares = {1}) {
  CustomSpec spec;
  const double fold = 0.4;
  const Vec3 at = arm * Vec3(std::cos(fold), 0, std::sin(fold)),
             v = -rate * arm * Vec3(-std::sin(fold), 0, std::cos(fold));
  spec.nodes = {{"O", {0, 0, 0}, {0, 0, 0}, 0, true}, {"A", at, v, tip, false}};
  spec.rods = {{"arm", {"O", "A"}, rod_mass}};
  Structure structure = build_custom(spec);
  if (EA > 0) {
    Rod& rod = structure.rods.front();
    rod.gives = true;
    rod.area = 2e-4;
    rod.youngs_modulus = EA / rod.area;
    rod.free_length = arm / (1 + inertia / arm * rate * rate / EA);  // N = (m / 3 + M) l w^2
  }
  structure.constraints.push_back({"plane", "plane", {1}, {Vec3::UnitY()}, 0.0, {}, {}});
  structure.deployment.fold_sine = {{1}, {Vec3(0, 0, 1 / arm)}, 0.0};
  structure.deployment.fold_cosine = {{1}, {Vec3(1 / arm, 0, 0)}, 0.0};
  structure.deployment.initial_fold_angle = fold;
  for (const double share : shares) {
    Force latch;
    latch.kind = "latch";
    latch.stiffness = share * k;
    latch.damping = share * c;
    structure.forces.push_back(latch);
  }
  SolverOptions options = dvm_options(4, 0.01, end_time);
  options.at_deployed = "latch";
  return simulate(make_model(structure), options);
}

// What a closed latch holds, a motion that is prescribed cannot move: the two are named, not the matrix.
TEST_CASE("a drive that moves on behind a closed latch is named") {
  const Scene scene = read_scene_file(
      find_scene("hoop6_motor"),
      {"solver.at_deployed=latch",
       R"(constraints[0]={kind="angle",name="crank",fold_angle=true,motion="rate",rate=-20})"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  CHECK(run.status == RunStatus::failed);
  CHECK(run.message.find("the latch holds what crank drives on") != std::string::npos);
}

// Its winch stands still behind the latch: no power, no more of it drawn in, and its columns go on.
TEST_CASE("a damped cable that a motion draws in stays a column of the run behind a latch") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [-1, 0, 0], fixed = true}, {name = "P", position = [0, 0, 0], fixed = true},
  {name = "B", position = [0, -2, 0], mass = 3}]
rods = []
constraints = [{kind = "line", nodes = ["B"], direction = [0, 1, 0]}]
[gravity]
acceleration = [0, -9.81, 0]
[[forces]]
kind = "cable"
name = "c"
nodes = ["A", "P", "B"]
axial_stiffness = 3000
damping = 30
motion = "rate"
rate = -0.8
ramp = 0.2
[deployment]
measure = "length P B"
deployed = 1.2
[solver]
step = 0.01
stages = 4
end_time = 3
at_deployed = "latch"
)");
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  const auto &value = d.at("c.value_m").values, &force = d.at("c.force_N").values,
             &power = d.at("c.power_W").values;
  REQUIRE(power.size() == run.trajectory.size());
  const double latched = run.events.back().t, rest = 3 - (0.8 * (latched - 0.1));
  for (std::size_t i = 0; i < power.size(); ++i) {
    if (run.trajectory.time(i) <= latched) continue;
    CHECK(power[i] == 0);
    CHECK(value[i] == Approx(rest).epsilon(1e-12));
    // Nothing moves: E A (S / L - 1) is all.
    CHECK(std::abs(force[i]) == Approx(3000 * (2.2 / rest - 1)).epsilon(1e-9));
  }
  CHECK(smallest_of_column(run, d, "c.power_W") <= 0);
  CHECK(largest_of_column(run, d, "c.power_W") >= *std::ranges::max_element(power));
}

}  // namespace

TEST_CASE(
    "a latch that gives meets an inertia with w sqrt(I k), and takes its energy as the rigid one does") {
  for (const double k : {3.0, 40.0, 900.0}) {
    const Simulation run = turned_in(k, 0.0, 2.0);
    INFO(k << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    REQUIRE(run.events.size() == 2);
    CHECK(run.events[0].t == Approx(0.4 / rate).epsilon(1e-9));
    CHECK(run.events[1].energy_lost == 0.0);
    const Diagnostics d = diagnose(run);
    // The spring acts on the sine of the angle, of which k/2 sine^2 is its energy: exact at any amplitude.
    // The peak between steps is that of a quintic, whose error falls with (omega h)^6.
    CHECK(largest_of_column(run, d, "latch_torque_max_N_m") ==
          Approx(rate * std::sqrt(inertia * k)).epsilon(k > 100 ? 1e-5 : 1e-8));
    const double energy = 0.5 * inertia * rate * rate;
    for (const double x : d.at("energy_balance_J").values) CHECK(std::abs(x) < 1e-7 * energy);
  }
  // Damping ratio 0.35 of 900 N m/rad: e^-48 is left after 3 s, but for the error of steps of omega h = 0.46.
  const double c = 2 * 0.35 * std::sqrt(900 * inertia);
  const Simulation run = turned_in(900.0, c, 4.0);
  const Diagnostics d = diagnose(run);
  CHECK(d.at("dissipated_J").values.back() == Approx(0.5 * inertia * rate * rate).epsilon(1e-6));
  CHECK(d.at("latch_torque_max_N_m").values.back() < 1e-6);
}

// Side by side they move as one of their sum does, and the joint bears their sum. Shares add up to the last
// bit.
TEST_CASE("several latches that give bear together what one of their sum bears") {
  const Simulation one = turned_in(40.0, 0.8, 2.0), three = turned_in(40.0, 0.8, 2.0, 0, {0.25, 0.25, 0.5});
  REQUIRE(one.status == RunStatus::completed);
  CHECK(largest_of_column(three, diagnose(three), "latch_torque_max_N_m") ==
        Approx(largest_of_column(one, diagnose(one), "latch_torque_max_N_m")).epsilon(1e-12));
  const std::string measured = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true},
         {name = "B", position = [1, 0, 0], velocity = [1.3, 0, 0], mass = 2}]
rods = []
constraints = [{kind = "line", nodes = ["B"], direction = [1, 0, 0]}]
[deployment]
measure = "length A B"
deployed = 1.2
[solver]
at_deployed = "latch"
step = 0.01
stages = 4
end_time = 2
[[forces]]
kind = "latch"
stiffness = 30
[[forces]]
kind = "latch"
stiffness = 20
)";
  const Simulation run = run_scene(measured);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(largest_of_column(run, diagnose(run), "latch_force_max_N") ==  // v sqrt(m k)
        Approx(1.3 * std::sqrt(2 * 50.0)).epsilon(1e-8));
}

// The rod gives by N / EA, N up to 2 N as it turns and 0 as it stands still: so do l, the torque and the
// energy. Steps do not follow its waves from 1e6 N on, and hold them from 1e8 N on.
TEST_CASE("a latch that gives beside a rod that gives meets it with w sqrt(I k), the stiffer the nearer") {
  for (const double EA : {1e4, 1e6, 1e8, 1e10, 1e12})
    for (const double k : {3.0, 40.0}) {
      const Simulation run = turned_in(k, 0.0, 2.0, EA);
      INFO(k << ", EA = " << EA << ": " << run.message);
      REQUIRE(run.status == RunStatus::completed);
      const double gives = 10 / EA;
      const Diagnostics d = diagnose(run);
      CHECK(largest_of_column(run, d, "latch_torque_max_N_m") ==
            Approx(rate * std::sqrt(inertia * k)).epsilon(1e-7 + gives));
      const double energy = 0.5 * inertia * rate * rate;
      for (const double x : d.at("energy_balance_J").values) CHECK(std::abs(x) < (1e-7 + gives) * energy);
    }
}

TEST_CASE("a mast on springs swings about its deployed pose and keeps its energy") {
  const Scene scene = read_scene_file(
      find_scene("scissor_mast"), {"forces[0]={kind=\"latch\", stiffness=4000}", "solver.at_deployed=latch",
                                   "structure.tip_force=30", "solver.end_time=4", "solver.stages=4"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.events.size() >= 2);
  const Diagnostics d = diagnose(run);
  double turned_over = 0;
  for (const double x : d.at("work_J").values) turned_over = std::max(turned_over, std::abs(x));
  for (const double x : d.at("energy_balance_J").values) CHECK(std::abs(x) < 1e-5 * turned_over);
  const auto& fraction = d.at("deployed_fraction").values;
  CHECK(*std::max_element(fraction.begin(), fraction.end()) > 1.0);  // past it, and back
  CHECK(fraction.back() > 0.9);
  CHECK(d.find("impact_loss_J") == nullptr);
}

TEST_CASE("a latch without a deployed pose is refused, and one that is never used is told") {
  const auto with = [](const char* scene, std::vector<std::string> changes) {
    changes.emplace_back("forces[0]={kind=\"latch\", stiffness=4000}");
    return build_model(read_scene_file(find_scene(scene), changes));
  };
  CHECK_THROWS_WITH(with("pendulum", {}), Catch::Contains("no deployed pose to latch in"));
  const auto unused = with("scissor_mast", {"solver.at_deployed=stop"});
  REQUIRE(unused->structure.notes.size() == 1);
  CHECK_THAT(unused->structure.notes.front(), Catch::Contains("does nothing without solver.at_deployed"));
}

// A ring's latches hold its hinges, each of which bears a load.
TEST_CASE("the latches of a ring are named by the hinges that they hold") {
  const Scene scene = read_scene_file(find_scene("hoop6"));
  const auto latched = latched_model(*build_model(scene), true);
  const Structure& structure = latched->structure;
  std::vector<std::string> expected, names;
  for (const Load& load : structure.loads)
    expected.push_back("latch of " + structure.nodes[static_cast<std::size_t>(load.node)].name);
  for (const Constraint& c : structure.constraints)
    if (c.name.starts_with("latch of ")) names.push_back(c.name);
  std::ranges::sort(expected), std::ranges::sort(names);
  CHECK(expected.size() == 12);
  CHECK(names == expected);
}

TEST_CASE("a latch that gives is refused where the deployed pose is singular") {
  const Scene scene = read_scene_file(
      find_scene("hoop6"), {"forces[0]={kind=\"latch\", stiffness=40000}", "solver.at_deployed=latch",
                            "solver.step=0.05", "solver.end_time=6"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  CHECK(run.status == RunStatus::failed);
  CHECK_THAT(run.message, Catch::Contains("cannot hold this deployed pose"));
  CHECK(run.trajectory.end_time() == Approx(4.92).epsilon(1e-4));  // the good part is kept
}

// What a latch takes is the energy of the velocities that it takes (Carnot): of what stops, cables and drives
// do at the same instant nothing is its own, and the events of impacts are all of the impact loss.
TEST_CASE("a latch takes what it takes itself, whatever else happens at that instant") {
  const std::string guided = R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], velocity = [1, 0, 0], mass = 2},
  {name = "B", position = [0, 1, 0], velocity = [1, 0, 0], mass = 3}]
[[constraints]]
kind = "line"
nodes = ["A", "B"]
direction = [1, 0, 0]
[[constraints]]
kind = "coordinate_stop"
nodes = ["B"]
direction = [1, 0, 0]
max = 1
[deployment]
measure = "coordinate A along 1 0 0"
deployed = 1
[solver]
at_deployed = "latch"
end_time = 2
)";
  // A free end T of a mass m = 1 kg at (0, -1) from E, which is driven about P: the latch of the joint at E
  // takes from T the velocity that E does not have.
  const std::string driven = R"toml([structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 0], fixed = true}, {name = "X", position = [1, 0, 0], fixed = true},
  {name = "E", position = [1, 0, 0], mass = 1}, {name = "T", position = [2, 0, 0], velocity = [0, 3, 0], mass = 1}]
rods = [{nodes = ["P", "E"], mass = 0}, {nodes = ["E", "T"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["E", "T"]
normal = [0, 0, 1]
[[constraints]]
kind = "angle"
nodes = ["X", "P", "E"]
axis = [0, 0, 1]
motion = "rate"
rate = 57.29577951308232
[deployment]
measure = "angle P E T about 0 0 1"
deployed = 200
[solver]
at_deployed = "latch"
step = 0.001
stages = 5
end_time = 1
)toml";
  const auto lost = [](const Simulation& run, const std::string& name) {
    double sum = 0;
    for (const Event& event : run.events)
      if (event.name.starts_with(name)) sum += event.energy_lost;
    return sum;
  };
  for (const double restitution : {0.0, 0.5, 1.0}) {
    const Simulation run = run_scene(guided, {"constraints[1].restitution=" + exact_number(restitution)});
    CHECK(lost(run, "latched") == Approx(0.5 * 2).epsilon(1e-12));
    CHECK(lost(run, "") == Approx(1 + 1.5 * (1 - restitution * restitution)).epsilon(1e-12));
    CHECK(diagnose(run).at("impact_loss_J").values.back() == Approx(lost(run, "")).epsilon(1e-12));
  }
  const Simulation run = run_scene(driven);
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(lost(run, "latched") > 0.4);
  const Diagnostics d = diagnose(run);
  CHECK(d.at("impact_loss_J").values.back() == Approx(lost(run, "latched")).epsilon(1e-9));
  std::size_t i = 0;
  while (i + 1 < d.t.size() && d.t[i + 1] != d.t[i]) ++i;
  REQUIRE(i + 1 < d.t.size());
  const Eigen::VectorXd turned = run.trajectory.velocities(i + 1) - run.trajectory.velocities(i);
  CHECK(turned.head(9).norm() < 1e-9);  // the drive holds E
  CHECK(lost(run, "latched") == Approx(0.5 * turned.squaredNorm()).epsilon(1e-9));
}

TEST_CASE("what remains to a deployed fold angle is the sine of the difference with all offsets") {
  Deployment d;
  d.fold_sine = {{0, 2}, {Vec3(0.3, -0.7, 1.1), Vec3(0.9, 0.2, -0.4)}, 0.31};
  d.fold_cosine = {{1, 2}, {Vec3(-0.6, 0.8, 0.5), Vec3(1.2, -0.1, 0.7)}, -0.47};
  d.deployed_fold_angle = 0.7;
  const VectorXd q = VectorXd::LinSpaced(9, -1.3, 2.1).array().sin();
  CHECK(remaining_form(d)(q) ==
        Approx(std::cos(0.7) * d.fold_sine(q) - std::sin(0.7) * d.fold_cosine(q)).epsilon(1e-13));
}

// A point mass on a rod turns evenly, from 0.4 rad at 2 rad/s; latched at 340 degrees.
TEST_CASE("a sum of angles that latches beyond half a turn counts on") {
  const Simulation run = run_scene(R"toml(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "R", position = [1, 0, 0], fixed = true},
         {name = "P", position = ["=1.3*cos(0.4)", "=1.3*sin(0.4)", 0], velocity = ["=-2.6*sin(0.4)", "=2.6*cos(0.4)", 0], mass = 0.7}]
rods = [{nodes = ["O", "P"], mass = 0}]
[[constraints]]
kind = "plane"
nodes = ["P"]
normal = [0, 0, 1]
[deployment]
measure = ["2 angle R O P about 0 0 1", "-0.5 angle R O P about 0 0 -1"]
deployed = 850
[solver]
stages = 4
step = 0.02
at_deployed = "latch"
end_time = 6
)toml");
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.events.back().kind == "latch");
  CHECK(run.events.back().t == Approx((340 * radians_per_degree - 0.4) / 2).epsilon(1e-9));
  CHECK(run.events.back().energy_lost == Approx(0.5 * 0.7 * 2.6 * 2.6).epsilon(1e-8));
  const double there = 340 * radians_per_degree;
  CHECK((end_positions(run).tail<3>() - 1.3 * Vec3(std::cos(there), std::sin(there), 0)).norm() <= 1e-9);
  for (std::size_t i = 0; i < run.trajectory.size(); ++i)
    CHECK(run.trajectory.state(i).angles.size() == run.trajectory.model(i).system.followed_angles());
  CHECK(diagnose(run).at("deployed_fraction").values.back() == Approx(1).epsilon(1e-9));
}
