// SPDX-License-Identifier: BSD-3-Clause
// Rings whose sectors are alike, solved as one sector: the full model's answer; and what is unlike, by name.
#include "core/path/sector.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/reference.hpp"
#include "core/study/tolerance.hpp"

using namespace unfurl;

namespace sector_test {

namespace {

struct Ring {
  std::string scene;
  std::vector<std::string> changes;
};

Simulation solved(const Ring& ring, const std::string& model, double end) {
  std::vector<std::string> changes = ring.changes;
  changes.push_back("solver.model=" + model);
  changes.push_back("solver.end_time=" + std::to_string(end));
  const Scene scene = read_scene_file(find_scene(ring.scene), changes);
  return simulate_as_asked(build_model(scene), scene.solver);
}

// One entry of a list for each unit of a ring; k and n stand for the unit and the next.
std::vector<std::string> for_units(int units, const std::string& list, const std::string& entry) {
  std::vector<std::string> out;
  for (int k = 0; k < units; ++k) {
    std::string text = entry;
    for (const auto& [letter, unit] : {std::pair{'#', k}, std::pair{'@', (k + 1) % units}})
      for (std::size_t at; (at = text.find(letter)) != std::string::npos;)
        text.replace(at, 1, std::to_string(unit));
    out.push_back(list + "[" + std::to_string(k) + "]=" + text);
  }
  return out;
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const std::vector<std::string> joints{"structure.model=joints", "structure.fold_angle=63",
                                      "structure.units=5"};
const std::vector<std::string> hinge_springs = for_units(
    5, "forces",
    R"({name="hinge #",kind="torsion_spring",nodes=["B#","Mb#","B@"],stiffness=37,damping=5,free_angle=137})");

// The method's equations of a symmetric state are those of its sector: what differs is rounding, some 1e-15
// of the ring's 7 m, and what the motion makes of it, exp(4.3 t) in a ring of joints: tenfold in half a
// second.
constexpr double same_place = 1e-12;

}  // namespace

TEST_CASE("a ring whose sectors are alike is solved as one of them, and is where the full model is") {
  const std::vector<std::tuple<Ring, std::string, double>> cases{
      {{"hoop6", {"structure.fold_angle=70"}}, "one of 6", 1.0},
      {{"hoop6", {"structure.units=11", "structure.mass=lumped", "gravity.acceleration=[0,0,-1.3]"}},
       "one of 11",
       1.0},
      {{"hoop6", joined(joints, hinge_springs)}, "one of 5", 0.5},
      // Of what has no direction one may be named the other way round.
      {{"hoop6",
        joined(joints, joined(for_units(5, "forces",
                                        R"({name="bar #",kind="spring",nodes=["B#","Mt#"],stiffness=37,)"
                                        R"(damping=5,free_length=2.5})"),
                              {"forces[2].nodes=[\"Mt2\",\"B2\"]"}))},
       "one of 5",
       0.5},
      {{"hoop6", joined(joints, {"loads[0]={nodes=[\"T*\"],force=[0,0,2.5]}",
                                 "forces[0]={kind=\"joint_damping\",nodes=[\"Mb*\",\"Mt*\"],damping=21}",
                                 "forces[1]={kind=\"drag\",nodes=[\"B*\"],damping=3.1}"})},
       "one of 5",
       0.5},
      {{"hoop6", joined(joints, {"constraints[0]={kind=\"angle\",fold_angle=true,motion=\"smooth\",to=41,"
                                 "duration=0.9}"})},
       "one of 5",
       0.5},
      {{"hoop6",
        joined(joints, {"forces[0]={kind=\"torsion_spring\",fold_angle=true,stiffness=800,free_angle=0,"
                        "damping=11}"})},
       "one of 5",
       0.5},
      // The first controller rests where the models compare themselves, at first and in the middle.
      {{"hoop6",
        joined(joints, {"structure.hinge_force=0",
                        "forces[0]={kind=\"motor\",fold_angle=true,stall_torque=1e5,no_load_speed=36000,"
                        "control=\"position\",proportional=2000,derivative=500,motion=\"smooth\",to=50,"
                        "start=0.3,duration=0.2}"})},
       "one of 5",
       0.5},
      {{"hoop6",
        joined(joints, {"structure.hinge_force=0",
                        "forces[0]={kind=\"motor\",fold_angle=true,stall_torque=1e3,no_load_speed=360,"
                        "control=\"rate\",proportional=500,integral=1000,motion=\"smooth\",to=50,"
                        "start=0.05,duration=0.3,current_limit=2,torque_constant=100}"})},
       "one of 5",
       0.5},
      {{"hoop6",
        joined(joints, for_units(5, "constraints",
                                 R"({name="actuator #",kind="length",nodes=["Mb#","Mt#"],motion="smooth",)"
                                 R"(to=3.9,duration=0.7})"))},
       "one of 5",
       0.5},
      {{"hoberman", {"structure.units=15"}}, "one of 15", 0.4}};
  for (const auto& [ring, order, end] : cases) {
    INFO(ring.scene << " " << (ring.changes.empty() ? "" : ring.changes.back()));
    const Simulation full = solved(ring, "full", end), one = solved(ring, "sector", end);
    CHECK(solved_as(one).name == "sector");
    INFO(solved_as(one).why);
    CHECK(solved_as(one).why.starts_with(order));
    REQUIRE(one.status == full.status);
    REQUIRE(one.trajectory.size() == full.trajectory.size());
    double off = 0;
    for (std::size_t i = 0; i < full.trajectory.size(); ++i)
      off = std::max(off, node_distance(one.trajectory.positions(i), full.trajectory.positions(i)));
    CHECK(off <= same_place);
    REQUIRE(one.events.size() == full.events.size());
    for (std::size_t e = 0; e < one.events.size(); ++e)
      CHECK(std::abs(one.events[e].t - full.events[e].t) <= 1e-12);
    // Forces and energies come from the whole's equations at these places; multipliers that are not unique
    // are known to some 1e-7 of their size where rods are nearly in line.
    const Diagnostics a = diagnose(one), b = diagnose(full);
    REQUIRE(a.columns.size() == b.columns.size());
    for (const std::string name : {"axial_force_max_N", "kinetic_energy_J"}) {
      INFO(name);
      const auto &x = a.at(name).values, &y = b.at(name).values;
      double size = 0, apart = 0;
      for (std::size_t i = 0; i < x.size(); ++i)
        size = std::max(size, std::abs(y[i])), apart = std::max(apart, std::abs(x[i] - y[i]));
      CHECK(apart <= 1e-6 * size);
    }
  }
}

// A cable between neighbours pulls and slackens, and a motor in every hinge comes to its current limit: each
// of the ring's, as in the full model.
TEST_CASE("what is told of one sector's cables and motors is told of all of the ring's") {
  const auto with = [](const std::string& more) {
    auto all = for_units(6, "forces",
                         R"({name="cab #",kind="spring",nodes=["B#","B@"],stiffness=4000,damping=20,)"
                         R"(free_length=2.5,tension_only=true})");
    const auto motors =
        for_units(6, "forces",
                  R"({name="mot #",kind="motor",nodes=["B#","Mb#","B@"],stall_torque=60,no_load_speed=300,)"
                  R"(current_limit=10,torque_constant=4)" +
                      more + "}");
    for (std::size_t k = 0; k < motors.size(); ++k)
      all.push_back("forces[" + std::to_string(6 + k) + "]" + motors[k].substr(motors[k].find('=')));
    all.insert(all.end(),
               {R"(forces[12]={kind="torsion_spring",fold_angle=true,stiffness=50,damping=30,free_angle=20})",
                R"(loads[0]={nodes=["Mb*"],force=[0,0,-200]})", R"(loads[1]={nodes=["Mt*"],force=[0,0,200]})",
                "structure.model=joints", "structure.units=6", "structure.fold_angle=80",
                "structure.hinge_force=0", "structure.chord_rod_length=3.0", "structure.post_length=1.2",
                "solver.stages=4", "solver.step=0.01"});
    return Ring{"hoop6", all};
  };
  for (const char* more :
       {"", R"(,control="rate",motion="rate",rate=25,ramp=0.5,proportional=50)",
        R"(,control="position",motion="rate",rate=25,ramp=0.5,proportional=90,derivative=20)"}) {
    INFO(more);
    const Ring ring = with(more);
    const Simulation full = solved(ring, "full", 1.6), one = solved(ring, "sector", 1.6);
    CHECK(full.events.size() >= 6);
    CHECK(full.events.size() % 6 == 0);
    REQUIRE(one.events.size() == full.events.size());
    for (std::size_t e = 0; e < one.events.size(); ++e) {
      CHECK(one.events[e].name == full.events[e].name);
      CHECK(one.events[e].element == full.events[e].element);
      CHECK(one.events[e].kind == full.events[e].kind);
      // Two searches of one time, of a margin that is rounding of 1e-15 of 7 m where they end.
      CHECK(std::abs(one.events[e].t - full.events[e].t) <= 1e-10);
    }
  }
}

// Waves of 0.9 ms shake every rod: with steps of 10 ms nobody knows forces at single states.
TEST_CASE("forces of waves that steps do not follow are no better known where a sector is solved") {
  const Ring ring{"hoop6",
                  {"structure.rod_model=elastic", "structure.youngs_modulus=7e10", "solver.stages=4"}};
  const Diagnostics full = diagnose(solved(ring, "full", 0.3)), one = diagnose(solved(ring, "sector", 0.3));
  CHECK_FALSE(full.force_unique.bottomRows(1).any());
  CHECK((one.force_unique == full.force_unique).all());
}

TEST_CASE("a ring is followed as a sector to its deployed pose, and has its forces there") {
  const Ring ring{"hoop6", {}};
  const Simulation full = solved(ring, "full", 6), one = solved(ring, "sector", 6);
  REQUIRE(one.status == RunStatus::deployed);
  CHECK(std::abs(one.events.back().t - full.events.back().t) <= 1e-12);
  const std::size_t last = full.trajectory.size() - 1;
  REQUIRE(one.trajectory.size() == last + 1);
  // The event is extrapolated from states next to a singular pose in both (deployed_event.hpp).
  CHECK(node_distance(one.trajectory.positions(last), full.trajectory.positions(last)) <= 2e-11);
  CHECK(node_distance(one.trajectory.positions(last - 1), full.trajectory.positions(last - 1)) <= 1e-12);
  const double a = diagnose(one).at("axial_force_max_N").values.back(),
               b = diagnose(full).at("axial_force_max_N").values.back();
  CHECK(std::abs(a - b) <= 1e-4 * std::abs(b));
}

// Where the pose is singular the sector's multipliers are lifted: each constraint's own, that of a drive of
// the whole ring n times the sector's. Extrapolated there from states next to it in both
// (deployed_event.hpp).
TEST_CASE("in a singular deployed pose a ring has the forces of its sector and a drive's for all of them") {
  const std::vector<std::string> small{"structure.units=4", "structure.fold_angle=20", "solver.step=0.02",
                                       "structure.model=joints"};
  const std::vector<Ring> rings{
      {"hoop6", joined(small, {"structure.model=full"})},
      {"hoop6", small},
      {"hoop6", joined(small, {"structure.hinge_force=0",
                               "constraints[0]={kind=\"angle\",fold_angle=true,motion=\"rate\",rate=-50}"})}};
  for (const Ring& ring : rings) {
    INFO(ring.scene << " " << ring.changes.back());
    const Simulation full = solved(ring, "full", 9), one = solved(ring, "sector", 9);
    REQUIRE(full.status == RunStatus::deployed);
    REQUIRE(one.solved_as.name == "sector");
    REQUIRE(one.trajectory.size() == full.trajectory.size());
    const std::size_t last = full.trajectory.size() - 1;
    const VectorXd a = one.trajectory.state(last).lambda, b = full.trajectory.state(last).lambda;
    REQUIRE((full.trajectory.report(last).singular_event && one.trajectory.report(last).singular_event));
    REQUIRE(a.size() == b.size());
    CHECK((a - b).norm() <= 1e-6 * b.norm());
  }
}

TEST_CASE("what is unlike in a ring keeps the full model, and is named") {
  const std::string base_spring =
      R"(forces[3]={name="hinge 3",kind="torsion_spring",nodes=["B3","Mb3","B4"],stiffness=37,damping=)";
  const std::vector<std::tuple<std::vector<std::string>, std::string>> cases{
      {{"loads[0]={nodes=[\"Mb2\"],force=[0,0,-0.3]}"}, "the load on Mb2"},
      {joined(hinge_springs, {base_spring + "5.01,free_angle=137}"}), "hinge 3"},
      {{"forces[0]={kind=\"drag\",nodes=[\"T3\"],damping=0.01}"}, "T3"},
      {{"gravity.acceleration=[0.01,0,-3]"}, "gravity"},
      {{"structure.length_error=1e-4", "structure.rod_model=elastic", "structure.youngs_modulus=7e10"},
       "turn"},
      {{"constraints[0]={name=\"held\",kind=\"length\",nodes=[\"Mb1\",\"Mt1\"]}"}, "held"},
      {{"constraints[0]={name=\"wall\",kind=\"plane\",nodes=[\"Mb4\"],normal=[0.3,0.1,0.9]}"}, "Mb4"},
      {{"structure.perturbed_unit=3", "structure.perturbed_force=201"}, "the load on Mb3"}};
  for (const auto& [changes, name] : cases) {
    INFO(changes.back());
    const Ring ring{"hoop6", joined(joints, changes)};
    const Simulation run = solved(ring, "auto", 0.05);
    CHECK(solved_as(run).name == "full");
    INFO(solved_as(run).why);
    CHECK(solved_as(run).why.find("no path: ") != std::string::npos);
    const std::size_t reason = solved_as(run).why.find("no sector: ");
    REQUIRE(reason != std::string::npos);
    CHECK(solved_as(run).why.find(name, reason) != std::string::npos);
    CHECK_THROWS_AS(solved(ring, "sector", 0.05), SectorRefused);
  }
}

TEST_CASE("auto takes the path where there is one, a sector where sectors are alike") {
  CHECK(solved_as(solved({"hoop6", {}}, "auto", 0.1)).name == "path");
  const Simulation run = solved({"hoop6", joints}, "auto", 0.1);
  CHECK(solved_as(run).name == "sector");
  CHECK(solved_as(run).why.find("one of 5 equal sectors; no path: ") == 0);
  CHECK(solved_as(solved({"hoop6", {}}, "full", 0.1)).name == "full");
  CHECK(solved_as(solved({"hoop6_sector", {}}, "sector", 0.1)).why == "structure.model = \"sector\"");
}

TEST_CASE("one value that is another in one unit makes a ring unlike") {
  const struct {
    const char *kind, *alike, *unlike;
  } cases[] = {
      {"torsion_spring", "stiffness=37,damping=5,free_angle=137", "stiffness=37.1,damping=5,free_angle=137"},
      {"torsion_spring", "stiffness=37,damping=5,free_angle=137", "stiffness=37,damping=5.1,free_angle=137"},
      {"torsion_spring", "stiffness=37,damping=5,free_angle=137", "stiffness=37,damping=5,free_angle=137.1"},
      {"motor", "stall_torque=3,no_load_speed=90", "stall_torque=3.1,no_load_speed=90"},
      {"motor", "stall_torque=3,no_load_speed=90", "stall_torque=3,no_load_speed=91"}};
  for (const auto& [kind, alike, unlike] : cases) {
    CAPTURE(kind, alike, unlike);
    const auto entry = [&, kind = kind](const char* values) {
      return std::string("{name=\"hinge #\",kind=\"") + kind + R"(",nodes=["B#","Mb#","B@"],)" + values + "}";
    };
    const auto all = for_units(5, "forces", entry(alike));
    CHECK(solved_as(solved({"hoop6", joined(joints, all)}, "auto", 0.01)).name == "sector");
    auto one = all;
    one[3] = for_units(5, "forces", entry(unlike))[3];
    const Simulation run = solved({"hoop6", joined(joints, one)}, "auto", 0.01);
    CHECK(solved_as(run).name == "full");
    CHECK(solved_as(run).why.find("hinge ") != std::string::npos);
  }
}

// Six masses of 0.45 kg on springs of E A / l = 100 N/m: a ring of 1 m breathes with omega^2 = k / m, by
// sin(omega t) v / omega.
TEST_CASE("a ring that nothing holds is solved as one of its sectors") {
  const std::string ring = R"toml(
[structure]
kind = "custom"
rod_model = "elastic"
youngs_modulus = 1e6
[[structure.nodes]]
repeat = {i = "0:6"}
name = "P{i}"
position = ["=cos(2*pi*i/6)", "=sin(2*pi*i/6)", 0]
velocity = ["=1e-6*cos(2*pi*i/6)", "=1e-6*sin(2*pi*i/6)", 0]
mass = 0.45
[[structure.rods]]
repeat = {i = "0:6"}
nodes = ["P{i}", "P{(i+1) % 6}"]
mass = 0
area = 1e-4
[solver]
stages = 4
step = 0.01
end_time = 0.3
)toml";
  for (const char* model : {"sector", "full"}) {
    INFO(model);
    const Scene scene = read_scene_text(ring, "s.toml", {std::string("solver.model=") + model});
    const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
    REQUIRE(run.status == RunStatus::completed);
    // A hexagon's rods are as long as its radius: its strain is the radius', and two pull with sin 30 deg.
    const double omega = std::sqrt(100 / 0.45);
    const std::size_t last = run.trajectory.size() - 1;
    const double radius = run.trajectory.node_positions(last).head<3>().norm();
    // (1e-6)^2 of what is not linear, and order 8 of steps of 0.15 rad.
    CHECK(radius - 1 == Approx(1e-6 / omega * std::sin(omega * 0.3)).epsilon(0).margin(1e-12));
  }
}

// Five masses whose radial coordinates are held, one of them drawn out, or relate to those of others: what a
// coordinate is elsewhere is no other ring.
TEST_CASE("a ring about any axis is solved as a sector, what its coordinates are held at, too") {
  const auto ring = [](const std::string& centre, const std::string& held, const std::string& more) {
    return read_scene_text("[variables]\nn = 5\ncx = " + centre + R"toml(
[structure]
kind = "custom"
[[structure.nodes]]
repeat = {i = "0:n"}
name = "P{i}"
position = ["=cx+cos(2*pi*i/n)", "=sin(2*pi*i/n)", 0]
velocity = ["=-0.3*sin(2*pi*i/n)", "=0.3*cos(2*pi*i/n)", 0.1]
mass = 1
[[structure.nodes]]
repeat = {i = "0:n"}
name = "Q{i}"
position = ["=cx+1.3*cos(2*pi*(i+0.2)/n)", "=1.3*sin(2*pi*(i+0.2)/n)", 0.3]
mass = 1
[[structure.rods]]
repeat = {i = "0:n"}
nodes = ["P{i}", "Q{i}"]
mass = 0.25
[[constraints]]
repeat = {i = "0:n"}
kind = "coordinate"
direction = ["=cos(2*pi*i/n+0.3)", "=sin(2*pi*i/n+0.3)", 0]
)toml" + held + "\n" + more + "[solver]\nstep = 0.01\nend_time = 0.3\n",
                           "ring.toml", {});
  };
  const auto run = [](Scene scene, const char* model) {
    scene.solver.model = model;
    return simulate_as_asked(build_model(scene), scene.solver);
  };
  const std::string drawn = "nodes = [\"P{i}\"]\nmotion = \"rate\"\nrate = 0.2\nramp = 0.1\n",
                    smooth =
                        "nodes = [\"P{i}\"]\nmotion = \"smooth\"\nduration = 0.2\n"
                        "to = \"=cx*cos(2*pi*i/n+0.3)+cos(0.3)+0.1\"\n";
  for (const std::string& held : {std::string("nodes = [\"P{i}\"]\n"), drawn, smooth})
    for (const char* centre : {"0", "1.5", "-40"}) {
      CAPTURE(held, centre);
      const Simulation one = run(ring(centre, held, ""), "sector"),
                       full = run(ring(centre, held, ""), "full");
      REQUIRE(one.status == full.status);
      const std::size_t last = full.trajectory.size() - 1;
      CHECK(node_distance(one.trajectory.positions(last), full.trajectory.positions(last)) <= 1e-11);
    }
  const std::string third =
      "[[constraints]]\nkind = \"coordinate\"\nnodes = [\"Q2\"]\ndirection = [0, 0, 1]\n";
  CHECK_THROWS_AS(run(ring("1.5", "nodes = [\"P{i}\"]\n", third), "sector"), SectorRefused);
}

}  // namespace sector_test
