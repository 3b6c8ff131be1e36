// SPDX-License-Identifier: BSD-3-Clause
// What a sweep may ask of a run, against two pendulums whose tensions follow from their energy.
#include "core/diagnostics/measures.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/export/summary.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/system/mobility.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace measures_test {

namespace {

// The first falls from upright at 1.1 rad/s, the second is let go level at 3 rad/s.
const std::string pendulums = R"(
[structure]
kind = "custom"
section = "round"
nodes = [
  {name = "P", position = [0, 0, 0], fixed = true},
  {name = "A", position = [0, 0, 0.8], velocity = [0.88, 0, 0], mass = 1.3},
  {name = "Q", position = [5, 0, 0], fixed = true},
  {name = "B", position = [6.1, 0, 0], velocity = [0, 0, -3.3], mass = 0.9}]
rods = [{name = "one", nodes = ["P", "A"], mass = 0, area = 2e-5, youngs_modulus = 7e10, strength = 3e7},
        {name = "two", nodes = ["Q", "B"], mass = 0, area = 1e-5, youngs_modulus = 2e11, strength = 5e7}]
[[structure.constraints]]
kind = "plane"
nodes = ["A", "B"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 5
step = 0.013
end_time = 2.6
)";

constexpr double g = 9.81;

// l w^2 / 2 = l w_0^2 / 2 + g (cos f - cos f_0) with f from straight down: T = m (l w_0^2 + 3 g cos f - 2 g
// cos f_0).
double tension(double m, double l, double w0, double cos_f0, double cos_f) {
  return m * (l * w0 * w0 + 3 * g * cos_f - 2 * g * cos_f0);
}

double euler(double modulus, double area, double l) {
  return pi * pi * modulus * (area * area / (4 * pi)) / (l * l);
}

}  // namespace

TEST_CASE("measures of a run are those of the motion, between its steps, too") {
  const Simulation run = testing::run_scene(pendulums);
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  const auto measure = [&](const std::string& name) { return find_measure(name).value(run, d); };
  const double one = tension(1.3, 0.8, 1.1, -1, 1), two = tension(0.9, 1.1, 3, 0, 1),
               push_one = -tension(1.3, 0.8, 1.1, -1, -1),
               push_two = -tension(0.9, 1.1, 3, 0, -1.1 * 9 / (2 * g));  // where it turns round
  REQUIRE((one > two && push_one > push_two && push_two > 0));
  // Within a step a peak is found on a parabola through 9 points: third derivatives of some 1e3 m w^3 ... of
  // the tension, some 10^4 of it, times (0.013 / 32)^4.
  const double near = 1e-6;
  CHECK(measure("peak_tension") == Approx(one).epsilon(near));
  CHECK(measure("peak_compression") == Approx(push_one).epsilon(near));
  CHECK(measure("peak_rod_force") == Approx(one).epsilon(near));
  CHECK(measure("max:axial_force_max_N") == Approx(one).epsilon(near));
  CHECK(measure("min:axial_force_min_N") == Approx(-push_one).epsilon(near));
  CHECK(measure("final:axial_force_max_N") == d.axial_force.row(d.axial_force.rows() - 1).maxCoeff());
  CHECK(measure("peak_stress") == Approx(std::max(one / 2e-5, two / 1e-5)).epsilon(near));
  CHECK(measure("stress_margin") ==
        Approx(std::min(3e7 / (one / 2e-5), 5e7 / (two / 1e-5)) - 1).epsilon(near));
  CHECK(measure("buckling_margin") ==
        Approx(std::min(euler(7e10, 2e-5, 0.8) / push_one, euler(2e11, 1e-5, 1.1) / push_two) - 1)
            .epsilon(near));
  CHECK(measure("peak_speed") == Approx(std::sqrt(3.3 * 3.3 + 2 * g * 1.1)).epsilon(near));  // of the second
  for (const char* name : {"peak_rod_force_unique", "peak_tension_unique", "peak_compression_unique",
                           "peak_stress_unique", "stress_margin_unique", "buckling_margin_unique"})
    CHECK(measure(name) == 1.0);
  CHECK(measure("end_time") == 2.6);
  CHECK(std::isnan(measure("deploy_time")));
  double newton = 0;
  for (const double x : d.at("newton_iterations").values) newton += std::isnan(x) ? 0 : x;
  CHECK(measure("newton_iterations") == newton);
}

TEST_CASE("what has no value is not said to be unique") {
  const Simulation run = testing::run_scene(R"(
structure.kind = 'pendulum'
solver.end_time = 0.1
solver.step = 0.01
)");
  const Diagnostics d = diagnose(run);
  for (const char* name : {"peak_stress_unique", "stress_margin_unique", "buckling_margin_unique"})
    CHECK(std::isnan(find_measure(name).value(run, d)));
  CHECK(find_measure("peak_rod_force_unique").value(run, d) == 1.0);
}

TEST_CASE("a summary names the rod that bears most and when, of force, stress and buckling") {
  const Simulation run = testing::run_scene(pendulums);
  const Diagnostics d = diagnose(run);
  struct Worst {
    double size = 0, t = 0;
    std::string rod;
    void take(double x, double at, const char* name) {
      if (x > size) *this = {x, at, name};
    }
  };
  Worst force, stress, share, buckling, at_p, at_q;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const VectorXd x = run.trajectory.positions(i);
    const double t = run.trajectory.time(i);
    const double one = tension(1.3, 0.8, 1.1, -1, -x[5] / 0.8), two = tension(0.9, 1.1, 3, 0, -x[11] / 1.1);
    const auto row = static_cast<Index>(i);
    // Rates of order 8 in steps of 0.013 s at some 7 rad/s.
    CHECK(d.axial_force(row, 0) == Approx(one).epsilon(0).margin(1e-9));
    CHECK(d.axial_force(row, 1) == Approx(two).epsilon(0).margin(1e-9));
    force.take(std::abs(one), t, "one"), force.take(std::abs(two), t, "two");
    at_p.take(std::abs(one), t, ""), at_q.take(std::abs(two), t, "");
    stress.take(std::abs(one) / 2e-5, t, "one"), stress.take(std::abs(two) / 1e-5, t, "two");
    share.take(std::abs(one) / 600, t, "one"), share.take(std::abs(two) / 500, t, "two");
    buckling.take(-one / euler(7e10, 2e-5, 0.8), t, "one"),
        buckling.take(-two / euler(2e11, 1e-5, 1.1), t, "two");
  }
  // How much is that of the motion, as above.
  const double push_one = -tension(1.3, 0.8, 1.1, -1, -1),
               push_two = -tension(0.9, 1.1, 3, 0, -1.1 * 9 / (2 * g));
  force.size = tension(1.3, 0.8, 1.1, -1, 1);
  stress.size = tension(0.9, 1.1, 3, 0, 1) / 1e-5;
  share.size = force.size / 600;
  buckling.size = std::max(push_one / euler(7e10, 2e-5, 0.8), push_two / euler(2e11, 1e-5, 1.1));
  const Model& model = run.trajectory.model();
  const auto json = nlohmann::json::parse(
      summary_json("two", run, d, analyse_mobility(model.system, run.trajectory.node_positions(0))));
  const auto check = [](const nlohmann::json& entry, const char* value, const Worst& wanted, const char* rod,
                        const char* time) {
    CHECK(entry[value].get<double>() == Approx(wanted.size).epsilon(1e-6));  // between states, as above
    if (rod) CHECK(entry[rod] == wanted.rod);
    if (!rod) CHECK(entry[time] == wanted.t);  // of a state; those of rods are below
  };
  check(json["forces"], "peak_rod_force_N", force, "peak_rod", "peak_t_s");
  check(json["strength"]["axial_stress"], "peak_Pa", stress, "rod", "t_s");
  check(json["strength"]["stress"], "peak_ratio", share, "rod", "t_s");
  check(json["strength"]["buckling"], "peak_ratio", buckling, "rod", "t_s");
  CHECK(json["forces"]["peak_rod_force_N"] == json["measures"]["peak_rod_force_N"]);
  CHECK(json["strength"]["stress"]["margin"] == json["measures"]["stress_margin"]);
  check(json["reactions"]["P"], "peak_N", at_p, nullptr, "t_s");
  check(json["reactions"]["Q"], "peak_N", at_q, nullptr, "t_s");
  CHECK(json["strength"]["stress"]["margin"].get<double>() == Approx(1 / share.size - 1).epsilon(2e-6));
  CHECK(json["strength"]["buckling"]["margin"].get<double>() == Approx(1 / buckling.size - 1).epsilon(2e-6));
  CHECK((json["forces"]["rods"] == 2 && json["forces"]["unique_rods"] == 2));
  REQUIRE((stress.rod == "two" && share.rod == "one" && buckling.rod == "two"));  // each quantity has its own
  for (const char* column : {"axial_force_max_unique", "axial_force_min_unique"})
    for (const double x : d.at(column).values) CHECK(x == 1.0);
  for (std::size_t i = 0; i < d.t.size(); ++i)
    CHECK(d.at("constraint_round_off_max").values[i] ==
          Approx(d.at("constraint_relative_max").values[i] / 2.220446049250313e-16));
}

// A bob let go level on a massless rod is at the bottom after K(1/2) sqrt(l / g), K the complete elliptic
// integral of parameter 1/2, and pulls 3 m g there; another hangs at rest. At both ends of a step of 0.4 s
// the hanging one bears more. Of two rods side by side each bears what it likes.
TEST_CASE("the rod and the time of a peak within a step are its own") {
  const std::string fixed = R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [3, 0, 0], fixed = true},
         {name = "A", position = [1, 0, 0], mass = 2}, {name = "B", position = [3, 0, -1], mass = 5}]
)",
                    motion = R"([gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 6
step = 0.4
end_time = 1
)",
                    one = R"(youngs_modulus = 7e10
rods = [{name = "swings", nodes = ["O", "A"], mass = 1e-6, area = 1e-4},
        {name = "hangs", nodes = ["P", "B"], mass = 1e-6, area = 1e-4}]
)",
                    two = R"(rods = [{name = "swings", nodes = ["O", "A"], mass = 1e-6},
        {name = "beside", nodes = ["O", "A"], mass = 1e-6}]
)";
  for (const bool twice : {false, true}) {
    CAPTURE(twice);
    const Simulation run = testing::run_scene(fixed + (twice ? two : one) + motion);
    const Diagnostics d = diagnose(run);
    const Model& model = run.trajectory.model();
    const auto json = nlohmann::json::parse(
        summary_json("two", run, d, analyse_mobility(model.system, run.trajectory.node_positions(0))));
    const double force = 3 * 2 * g / (twice ? 2 : 1), bottom = 1.8540746773013719 / std::sqrt(g);
    const auto& forces = json["forces"];
    // The step is long: forces are good to 1e-6, their flat top to its root in time.
    CHECK(forces["peak_rod_force_N"].get<double>() == Approx(force).epsilon(1e-5));
    CHECK(forces["peak_t_s"].get<double>() == Approx(bottom).epsilon(0).margin(1e-3));
    CHECK(forces["peak_rod"] != "hangs");
    CHECK(forces["peak_unique"] == !twice);
    CHECK(find_measure("peak_rod_force_unique").value(run, d) == (twice ? 0 : 1));
    if (twice) continue;
    const auto& stress = json["strength"]["axial_stress"];
    CHECK(stress["peak_Pa"].get<double>() == Approx(force / 1e-4).epsilon(1e-5));
    CHECK(stress["t_s"].get<double>() == Approx(bottom).epsilon(0).margin(1e-3));
    CHECK(stress["rod"] == "swings");
  }
}

// A rod along a guide that its load pulls, or presses: to round-off of 40 N.
TEST_CASE("where no rod is pressed the peak compression is none, where none is pulled the peak tension is") {
  for (const double load : {40.0, -40.0}) {
    const Simulation run = testing::run_scene(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1.3, 0, 0]},
         {name = "free", position = [0, 1, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 0.4}]
[[constraints]]
kind = "line"
nodes = ["B"]
direction = [1, 0, 0]
[[loads]]
nodes = ["B"]
force = [)" + std::to_string(load) + R"(, 0, 0]
[solver]
step = 0.01
end_time = 0.02
)");
    const Diagnostics d = diagnose(run);
    const auto measure = [&](const char* name) { return find_measure(name).value(run, d); };
    CHECK(measure("peak_tension") == Approx(load > 0 ? 40 : 0).epsilon(0).margin(1e-9));
    CHECK(measure("peak_compression") == Approx(load > 0 ? 0 : 40).epsilon(0).margin(1e-9));
    CHECK((measure("peak_tension") >= 0 && measure("peak_compression") >= 0));
    CHECK(measure("peak_rod_force") == Approx(40).epsilon(0).margin(1e-9));
    CHECK(d.at("axial_force_min_N").values.back() == Approx(load).epsilon(0).margin(1e-9));  // with its sign
  }
}

// A mast of one cell that is pushed through its bundle: it has turned over and stops where it has the energy
// of its start again, at 360 - 84 degrees, whatever the steps.
TEST_CASE("a fold angle counts on within steps as it does at states") {
  for (const char* step : {"0.1", "0.3", "0.35"}) {
    INFO(step);
    const Scene scene = read_scene_file(find_scene("scissor_mast"),
                                        {"structure.cells=1", "structure.tip_force=-20", "solver.end_time=3",
                                         "solver.stages=6", std::string("solver.step=") + step});
    const Simulation run = simulate(build_model(scene), scene.solver);
    const Diagnostics d = diagnose(run);
    // Tops are those of quintics through states up to a third of a second apart.
    CHECK(find_measure("min:fold_angle_deg").value(run, d) == Approx(84).epsilon(0).margin(0.2));
    CHECK(find_measure("max:fold_angle_deg").value(run, d) == Approx(276).epsilon(0).margin(0.2));
    CHECK(find_measure("max:fold_angle_rad").value(run, d) ==
          Approx(276 * pi / 180).epsilon(0).margin(0.004));
  }
}

// Sweeps and solve ask it of every measure: what peaks.hpp looks for beside singular poses must be among
// these, else a value depends on what else is measured.
TEST_CASE("extremes of forces of every kind may have no bound beside singular poses") {
  for (const char* name :
       {"max:A.reaction_N", "min:A.reaction_x_N", "max:hub.torque_N_m", "min:winch.force_N", "peak_tension",
        "max:latch_torque_max_N_m", "max:axial_force_max_N", "max:axial_stress_max_Pa", "buckling_margin",
        "max:buckling_ratio_max", "max:stress_ratio_max"}) {
    INFO(name);
    CHECK(may_have_no_bound(name));
  }
  for (const char* name : {"final:A.reaction_N", "max:kinetic_energy_J", "max:hub.angle_rad", "deploy_time",
                           "max:hub.torque_unique", "peak_speed", "max:hub.power_W"}) {
    INFO(name);
    CHECK_FALSE(may_have_no_bound(name));
  }
}

TEST_CASE("a measure that is a column by its name says how it is measured") {
  const std::vector<std::string> columns{"t_s", "surface_rms_m"};
  for (const char* name : {"surface_rms", "surface_rms_m"})
    CHECK_THROWS_WITH(find_measure(name, columns),
                      Catch::Contains("max:surface_rms_m, min:surface_rms_m or final:surface_rms_m"));
  CHECK_THROWS_WITH(find_measure("surface", {"t_s"}), Catch::Contains("no measure 'surface'"));
  const std::vector<std::string> named{"kinetic_energy_J", "my_pin.reaction_x_N", "hub.torque_N_m",
                                       "fraction"};
  CHECK(find_measure("max:kinetic_energy_J", named).label == "largest kinetic energy (J)");
  CHECK(find_measure("max:my_pin.reaction_x_N", named).label == "largest my_pin.reaction x (N)");
  CHECK(find_measure("max:hub.torque_N_m", named).label == "largest hub.torque (N m)");
  CHECK(find_measure("max:fraction", named).label == "largest fraction");
  const auto label = [](const char* name) { return find_measure(name, {}).label; };
  CHECK(label("max:dissipated_J") == "largest energy taken by dampers and friction (J)");
  CHECK(label("max:constraint_max_m") == "largest constraint error (m)");
  CHECK(label("max:axial_force_max_N") == "largest axial force (N)");
  CHECK(label("min:axial_force_min_N") == "smallest axial force (N)");
  CHECK(label("final:axial_force_max_N") == "final largest axial force (N)");
  CHECK(label("max:drive_work_J") == "largest drive work (J)");
}

// Of a name with a comma the longest that is a column; without one a comma ends a name, as ever.
TEST_CASE("lists of measures take names with commas") {
  const std::vector<std::string> columns{"t_s", "spring, left.force_N", "hub,torque_N_m", "hub"};
  const auto names = [&](const char* list) {
    std::vector<std::string> out;
    for (const RunMeasure& measure : find_measures(list, columns)) out.push_back(measure.name);
    return out;
  };
  using Names = std::vector<std::string>;
  CHECK(names("energy,,cpu,") == Names{"energy", "cpu"});
  CHECK(names("max:spring, left.force_N") == Names{"max:spring, left.force_N"});
  CHECK(names("energy,min:spring, left.force_N,max:hub,torque_N_m,final:hub,cpu") ==
        Names{"energy", "min:spring, left.force_N", "max:hub,torque_N_m", "final:hub", "cpu"});
  CHECK_THROWS_WITH(names("energy,max:spring, right.force_N"), Catch::Contains("no column 'spring'"));
  CHECK(find_measures("", columns).empty());
  CHECK(find_measures(",", columns).empty());
  CHECK_THROWS_WITH(find_measures("max:a,b", {"a"}), Catch::Contains("no measure 'b'"));
}

// A force by the name of its column is the same force: the ring's largest tension is of its last pose at
// 200 N, where it is not unique.
TEST_CASE("extremes of columns are said to be open where the measures of the same forces are") {
  bool open[2] = {};
  for (const bool moduli : {false, true}) {
    INFO(moduli);
    std::vector<std::string> changes{"solver.end_time=6", "solver.step=0.02"};
    if (moduli) changes.push_back("structure.youngs_modulus=7e10");
    const Scene scene = read_scene_file(find_scene("hoop6"), changes);
    const Simulation run = simulate(build_model(scene), scene.solver);
    const Diagnostics d = diagnose(run);
    const auto flag = [&](const char* measure) { return find_measure(uniqueness_of(measure)).value(run, d); };
    open[flag("peak_tension") != 0] = true;
    CHECK(flag("max:axial_force_max_N") == flag("peak_tension"));
    CHECK(flag("min:axial_force_min_N") == flag("peak_compression"));
    CHECK(flag("final:axial_force_min_N") == d.at("axial_force_min_unique").values.back());
    if (!moduli) continue;
    CHECK(flag("max:axial_stress_max_Pa") == flag("peak_tension"));  // rods of one section
    CHECK(flag("max:buckling_ratio_max") == flag("buckling_margin"));
  }
  CHECK((open[0] && open[1]));
  CHECK(uniqueness_of("max:my_hub.torque_N_m") == "max:my_hub.torque_N_m_unique");
  CHECK(uniqueness_of("final:my_pin.reaction_x_N") == "final:my_pin.reaction_unique");
  CHECK(uniqueness_of("max:kinetic_energy_J").empty());
  CHECK_THROWS_AS(find_measure("max:no_force_N_unique", {"axial_force_max_N"}), StudyError);
}

// Three rods along guides at rest, of which loads pull two and push one more and more, and a pendulum that
// swings from rest through its lowest point. The second tie bears most, the first one has the largest stress.
TEST_CASE("a stress is as unique as the force of the rod that has it at the states around") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
youngs_modulus = 2e11
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1.1, 0, 0], mass = 1},
  {name = "B", position = [0, 1.2, 0], mass = 1}, {name = "C", position = [0, 0, 1.3], mass = 1}]
rods = [{name = "first", nodes = ["O", "A"], mass = 0, area = 1.1e-5},
        {name = "second", nodes = ["O", "B"], mass = 0, area = 3.3e-5},
        {name = "strut", nodes = ["O", "C"], mass = 0, area = 2.2e-5}]
constraints = [{kind = "line", nodes = ["A"], direction = [1, 0, 0]},
  {kind = "line", nodes = ["B"], direction = [0, 1, 0]}, {kind = "line", nodes = ["C"], direction = [0, 0, 1]}]
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [70, 0, 0]
times = [0, 1]
values = [0.2, 1]
[[forces]]
kind = "load_over_time"
nodes = ["B"]
force = [0, 110, 0]
times = [0, 1]
values = [0.3, 1]
[[forces]]
kind = "load_over_time"
nodes = ["C"]
force = [0, 0, -90]
times = [0, 1]
values = [0.1, 1]
[solver]
step = 0.1
end_time = 1
)");
  const Diagnostics d = diagnose(run);
  const Index last = d.axial_force.rows() - 1;
  const auto unique = [&](const char* column, Index state, Index rod) {
    Diagnostics open = d;
    open.force_unique(state, rod) = false;
    return find_measure(uniqueness_of(column)).value(run, open);
  };
  const char *pull = "max:axial_stress_max_Pa", *push = "min:axial_stress_min_Pa";
  CHECK(find_measure(pull).value(run, d) == Approx(70 / 1.1e-5).epsilon(1e-9));
  CHECK(find_measure(push).value(run, d) == Approx(-90 / 2.2e-5).epsilon(1e-9));
  CHECK(unique(pull, last, 0) == 0);
  CHECK(unique(pull, last, 1) == 1);
  CHECK(unique(pull, last, 2) == 1);
  CHECK(unique(push, last, 2) == 0);
  CHECK(unique(push, last, 0) == 1);
  CHECK(unique(push, last, 1) == 1);
  for (Index state = 0; state < last; ++state) CHECK(unique(pull, state, 0) == 1);
  // The largest of what is pressed least, at the start.
  CHECK(unique("max:axial_stress_min_Pa", 0, 2) == 0);
  CHECK(unique("max:axial_stress_min_Pa", 1, 2) == 1);

  Diagnostics hidden = d;
  hidden.rod_shown = {0, 1, 1};
  hidden.force_unique(last, 0) = false;
  CHECK(find_measure(uniqueness_of(pull)).value(run, hidden) == 1);
  hidden.force_unique(last, 1) = false;
  CHECK(find_measure(uniqueness_of(pull)).value(run, hidden) == 0);
}

TEST_CASE("a stress within a step is as unique as that of the states at its ends") {
  const Simulation run = testing::run_scene(R"toml(
[structure]
kind = "custom"
youngs_modulus = 2e11
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = ["=0.9*sin(67*deg)", 0, "=-0.9*cos(67*deg)"], mass = 1.3}]
rods = [{nodes = ["O", "A"], mass = 0, area = 1.1e-6}]
constraints = [{kind = "plane", nodes = ["A"], normal = [0, 1, 0]}]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 6
step = 0.08
end_time = 0.8
)toml");
  const Diagnostics d = diagnose(run);
  Index before = 0;  // the bob passes its lowest point
  while (run.trajectory.node_positions(static_cast<std::size_t>(before) + 1)[3] > 0) ++before;
  REQUIRE(before > 1);
  for (Index state = 0; state < d.axial_force.rows(); ++state) {
    INFO(state << " of " << before);
    Diagnostics open = d;
    open.force_unique(state, 0) = false;
    CHECK((find_measure(uniqueness_of("max:axial_stress_max_Pa")).value(run, open) == 0) ==
          (state == before || state == before + 1));
  }
}

}  // namespace measures_test
