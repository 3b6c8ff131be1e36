// SPDX-License-Identifier: BSD-3-Clause
// Peaks are those of the motion, not of the ends of steps.
#include "core/diagnostics/peaks.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/measures.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/diagnostics/rod_strength.hpp"
#include "core/path/path_run.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "tests/support/number.hpp"

using namespace unfurl;

namespace peaks_test {

namespace {

constexpr double pi = 3.14159265358979323846, g = 9.81;

double measured(const std::string& name, const Simulation& run) {
  return find_measure(name).value(run, diagnose(run));
}

// A bob on a massless rod of 0.8 m, let go at an angle to the vertical.
Simulation swing(double degrees, double step, const std::string& method = "dvm",
                 const std::string& more = "") {
  const double x = 0.8 * std::sin(degrees * pi / 180), z = -0.8 * std::cos(degrees * pi / 180);
  const Scene scene = read_scene_text(
      "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'P'\nposition = [" +
          std::to_string(x) + ", 0, " + std::to_string(z) +
          "]\nmass = 2.5\n[[structure.rods]]\nnodes = ['O', 'P']\nmass = 0\n[gravity]\nacceleration = [0, 0, "
          "-9.81]\n[solver]\nstages = 4\nend_time = 1.3\nmethod = '" +
          method + "'\nstep = " + std::to_string(step) + "\n" + more,
      "swing.toml", {});
  return simulate(build_model(scene), scene.solver);
}

}  // namespace

TEST_CASE("peaks of a pendulum are those of its lowest point, wherever steps end") {
  const double m = 2.5, length = 0.8, degrees = 73.0;
  const double energy = m * g * length * (1 - std::cos(degrees * pi / 180));
  for (const double step : {0.11, 0.05, 0.013}) {
    const Simulation run = swing(degrees, step);
    INFO(step);
    // The interpolation is of order 6 with a constant of some 1e-5, omega = 3.5 rad/s: 2e-8 at the largest
    // step, and the run itself is as good; the node positions are written with six digits.
    const double close = step > 0.1 ? 2e-5 : 2e-6;
    CHECK(measured("peak_energy", run) == Approx(energy).epsilon(close));
    CHECK(measured("max:kinetic_energy_J", run) == Approx(energy).epsilon(close));
    CHECK(measured("peak_speed", run) == Approx(std::sqrt(2 * energy / m)).epsilon(close));
    // Tension m g (3 - 2 cos phi_0) at the lowest point, m g cos phi_0 where it turns.
    const double tension = m * g * (3 - 2 * std::cos(degrees * pi / 180));
    CHECK(measured("peak_rod_force", run) == Approx(tension).epsilon(close));
    CHECK(measured("peak_tension", run) == Approx(tension).epsilon(close));
    CHECK(measured("min:axial_force_max_N", run) ==
          Approx(m * g * std::cos(degrees * pi / 180)).epsilon(close));
    CHECK(measured("min:potential_energy_J", run) == Approx(-m * g * length).epsilon(close));
    CHECK(measured("final:kinetic_energy_J", run) == diagnose(run).at("kinetic_energy_J").values.back());
  }
}

TEST_CASE("a peak between states is that of the load at its own time") {
  // A force along the rod moves nothing: T = m g (3 cos phi - 2 cos phi_0) + f t, largest a little behind the
  // lowest point, where a fine run tells phi.
  const double m = 2.5, slope = 12.0, cosine = std::cos(73.0 * pi / 180);
  const std::string growing =
      "[[forces]]\nkind = 'follower'\nrod = 'O-P'\nforce = 12\ntimes = [0, 1.3]\nvalues = [0, 1.3]\n";
  const Simulation fine = swing(73, 0.001, "dvm", growing);
  double most = 0;
  for (std::size_t k = 0; k < fine.trajectory.size(); ++k) {
    const double drop = -fine.trajectory.node_positions(k)[5] / 0.8, t = fine.trajectory.time(k);
    most = std::max(most, m * g * (3 * drop - 2 * cosine) + slope * t);
  }
  // The fine run's states are 1 ms apart: 0.5 T'' (0.5 ms)^2 = 1e-4 N of 80; interpolation as above.
  for (const double step : {0.11, 0.05})
    CHECK(measured("peak_rod_force", swing(73, step, "dvm", growing)) == Approx(most).epsilon(1e-4));
}

TEST_CASE("a peak in a corner is that of the corner") {
  // Off a floor with restitution: the speed is largest right before the impact, at states that both have its
  // time.
  const Scene scene = read_scene_text(
      "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'P'\nposition = [0.2, 0.4, 1.7]\nmass = "
      "2.5\n"
      "[[constraints]]\nkind = 'coordinate_stop'\nname = 'floor'\nnodes = ['P']\ndirection = [0, 0, 1]\nmin "
      "= 0.45\n"
      "restitution = 0.6\n[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstep = 0.07\nend_time = 1.1\n",
      "floor.toml", {});
  const Simulation run = simulate(build_model(scene), scene.solver);
  CHECK(measured("peak_speed", run) == Approx(std::sqrt(2 * g * 1.25)).epsilon(1e-9));
}

// A rod at rest that a follower pulls with 100 N of its table, which rises to 1 and falls more slowly or
// faster. No value of the motion is larger; the corner is found to a 4^-6 of the eighth of a step, some 2e-7
// of its height.
TEST_CASE("a peak in a corner of any slopes is no larger than the corner") {
  for (const double falls : {0.05, 0.15, 0.3, 0.4, 0.7, 1.0, 2.0})
    for (const char* step : {"0.01", "0.007", "0.005", "0.001"}) {
      const Scene scene = read_scene_text(R"(
structure.kind = "custom"
structure.nodes = [{name="A", position=[0,0,0], fixed=true}, {name="B", position=[1,0,0], mass=1}]
structure.rods = [{nodes=["A","B"], mass=0.1}]
[[forces]]
kind = "follower"
name = "f"
rod = "A-B"
force = 100
times = [0.09, 0.1, 0.12]
[solver]
end_time = 0.2
)",
                                          "s.toml",
                                          {"forces[0].values=[0,1," + std::to_string(1 - 2 * falls) + "]",
                                           std::string("solver.step=") + step});
      const Simulation run = simulate(build_model(scene), scene.solver);
      const double peak = peak_rod_force(run, diagnose(run), Pull::tension).force_N;
      INFO(falls << " " << step);
      CHECK(peak <= 100 * (1 + 1e-12));
      CHECK(peak >= 100 * (1 - 1e-5));
    }
}

// Two bobs of 1 kg that hang still, pulled by 30 t and by 20 - 17 t: the smaller tension rises and the larger
// one falls until t = 20 / 47 s, where another rod bears it.
TEST_CASE("a peak in a corner between two rods is that of the corner") {
  std::string text = "[structure]\nkind = 'custom'\n";
  const auto bob = [&](const std::string& name, const std::string& x, const std::string& values) {
    text += "[[structure.nodes]]\nname = 'O" + name + "'\nposition = [" + x +
            ", 0, 0]\nfixed = true\n[[structure.nodes]]\nname = '" + name + "'\nposition = [" + x +
            ", 0, -1]\nmass = 1\n[[structure.rods]]\nnodes = ['O" + name + "', '" + name +
            "']\nmass = 0\n[[forces]]\nkind = 'load_over_time'\nnodes = ['" + name +
            "']\nforce = [0, 0, -1]\ntimes = [0, 1]\nvalues = " + values + "\n";
  };
  bob("A", "0", "[0, 30]");
  bob("B", "2", "[20, 3]");
  text += "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 1\nstep = ";
  for (const char* step : {"0.1", "0.07", "0.013"}) {
    const Scene scene = read_scene_text(text + step + "\n", "bobs.toml", {});
    const Simulation run = simulate(build_model(scene), scene.solver);
    INFO(step);
    // 64 parts of two steps, five times a quarter of that: 3e-6 s at 47 N/s.
    CHECK(measured("max:axial_force_min_N", run) == Approx(9.81 + 600.0 / 47).epsilon(0).margin(2e-4));
    CHECK(measured("min:axial_force_max_N", run) == Approx(9.81 + 600.0 / 47).epsilon(0).margin(2e-4));
  }
}

TEST_CASE("what grows to the end has its peak there, and what is not there has none") {
  const Simulation run = swing(40, 0.05);
  const Diagnostics d = diagnose(run);
  CHECK(largest_of_column(run, d, "step_s") == Approx(0.05).epsilon(1e-12));
  CHECK(std::isnan(largest_of_column(run, d, "fold_angle_rad")));
}

TEST_CASE("a peak is found beside a state whose value is not known, on either side") {
  const Simulation run = swing(73, 0.08);
  const StateValues speeds = [](const Simulation& piece) {
    std::vector<double> out;
    for (std::size_t i = 0; i < piece.trajectory.size(); ++i)
      out.push_back(piece.trajectory.node_velocities(i).tail<3>().norm());
    return out;
  };
  const std::vector<double> at_states = speeds(run);
  const double top = std::sqrt(2 * g * 0.8 * (1 - std::cos(73 * pi / 180)));
  const auto highest =
      static_cast<std::size_t>(std::max_element(at_states.begin(), at_states.end()) - at_states.begin());
  REQUIRE(at_states[highest] < 0.99995 * top);
  CHECK(largest_in_motion(run, at_states, {}) == at_states[highest]);
  for (const int side : {-1, 0, 1}) {
    std::vector<double> known = at_states;
    if (side) known[highest + static_cast<std::size_t>(side)] = std::nan("");
    CHECK(largest_in_motion(run, known, speeds) == Approx(top).epsilon(2e-6));
  }
  std::vector<double> none(at_states.size(), std::nan(""));
  CHECK(std::isnan(largest_in_motion(run, none, speeds)));
  // One that is known alone, where the motion is faster by far.
  none[highest + 3] = 0.1;
  CHECK(largest_in_motion(run, none, speeds) > 0.5 * top);
}

namespace {

// A ring of scissors whose guides and rods are redundant: what they share has least norm.
Simulation redundant(int units, double step, bool on_path, double fold = 40, bool spring = true) {
  std::vector<std::string> changes{"structure.units=" + std::to_string(units),
                                   "structure.fold_angle=" + std::to_string(fold),
                                   "structure.deployed_angle=4",
                                   "structure.radial_force=3.5",
                                   "structure.density=3000",
                                   "gravity.acceleration=[0,0,-1.6]",
                                   "solver.stages=7",
                                   "solver.step=" + std::to_string(step)};
  if (spring)  // of one hinge: units are not alike then
    changes.push_back(
        R"(forces[0]={kind="torsion_spring",fold_angle=true,stiffness=6,damping=3,free_angle=48})");
  const Scene scene = read_scene_file(find_scene("hoberman"), changes);
  const auto model = build_model(scene);
  return on_path ? simulate_on_path(model, scene.solver) : simulate(model, scene.solver);
}

}  // namespace

// Between steps of 5 ms a motion is known to 1e-9 of its forces; a state every 0.3 ms misses a peak by the
// square of that over that of the motion's time, 1e-6.
TEST_CASE("peaks between states are those of the motion where rows are redundant, in every model") {
  const Simulation fine = redundant(6, 0.0003125, false);
  const Diagnostics states = diagnose(fine);
  for (const char* column : {"P4.reaction_x_N", "P4.reaction_y_N", "P4.reaction_N", "P1.reaction_N",
                             "axial_force_max_N", "axial_force_min_N"}) {
    const std::vector<double>& values = states.at(column).values;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double size = std::max(std::abs(*least), std::abs(*most));
    for (const double step : {0.005, 0.0025, 0.00125})
      for (const bool on_path : {false, true}) {
        CAPTURE(column, step, on_path);
        const Simulation run = redundant(6, step, on_path);
        const Diagnostics d = diagnose(run);
        CHECK(std::abs(largest_of_column(run, d, column) - *most) <= 1e-5 * size);
        CHECK(std::abs(smallest_of_column(run, d, column) - *least) <= 1e-5 * size);
      }
  }
}

// A sheet pulls most where it swings through its flat pose, in which it loses rank. In states as near to it
// as 1e-5 rad, what round-off makes of the forces was called unique (275.7 for 90.42 N), and in short steps
// all poses that such a state could be put right by were as near. States 1e-3 rad from the peak, which those
// of a fine run are, miss it by 1e-5 of it; what is left of round-off was seen to be 8e-5.
TEST_CASE("a peak in a singular pose is that of the motion through it") {
  const auto swinging = [](double fold, double step, bool on_path) {
    const Scene scene = read_scene_file(
        find_scene("reentrant_sheet"),
        {"structure.rows=1", "structure.columns=1", "structure.fold_angle=" + std::to_string(fold),
         "structure.deployed_angle=11.5", "structure.stretch_force=27.16", "solver.at_deployed=pass",
         "solver.stages=7", "solver.end_time=1", "solver.step=" + std::to_string(step)});
    const auto model = build_model(scene);
    return on_path ? simulate_on_path(model, scene.solver) : simulate(model, scene.solver);
  };
  for (const double fold : {45.0, 50.0, 60.67489, 63.97210322572671, 70.0}) {
    const auto states = diagnose(swinging(fold, 0.0001, false)).at("axial_force_max_N").values;
    const double most = *std::max_element(states.begin(), states.end());
    for (const double step : {0.005, 0.0025, 0.00125, 0.000625})
      for (const bool on_path : {false, true}) {
        CAPTURE(fold, step, on_path);
        const Simulation run = swinging(fold, step, on_path);
        CHECK(largest_of_column(run, diagnose(run), "axial_force_max_N") == Approx(most).epsilon(1e-4));
      }
  }
}

// A scissor cell that passes flat at 0.607 s under its tip force, just behind its largest forces, which are
// smooth there. States of four stages are better than 1e-8, but beside the pose, where their errors count:
// 5e-6. Within a step of 0.8 ms forces that follow from its own error were 6e-4 too large.
TEST_CASE("a peak beside a singular pose is that of smooth forces at every step") {
  const auto opened = [](double step) {
    const Scene scene = read_scene_file(
        find_scene("scissor_mast"),
        {"structure.cells=1", "structure.tip_force=-20", "solver.end_time=0.65",
         "structure.youngs_modulus=2e11", "solver.stages=4", "solver.step=" + std::to_string(step)});
    return simulate(build_model(scene), scene.solver);
  };
  // The polynomial through states from 1 to 3 ms away on either side, where the pose does not matter.
  const Diagnostics fine = diagnose(opened(1e-4));
  const std::vector<double>& x = fine.at("axial_force_max_N").values;
  double most = 0;
  for (int k = -100; k <= 100; ++k) {
    double sum = 0;
    for (const int a : {-30, -20, -10, 10, 20, 30}) {
      double term = x[static_cast<std::size_t>(6067 + a)];
      for (const int b : {-30, -20, -10, 10, 20, 30})
        if (b != a) term *= (0.1 * k - b) / (a - b);
      sum += term;
    }
    most = std::max(most, sum);
  }
  for (const double step : {0.0004, 0.0005, 0.0006, 0.0007, 0.0008, 0.0009, 0.0011, 0.002, 0.005}) {
    CAPTURE(step);
    const Simulation run = opened(step);
    const Diagnostics d = diagnose(run);
    const PeakForce peak = peak_rod_force(run, d, Pull::either);
    CHECK(measured("peak_rod_force", run) == Approx(most).epsilon(5e-6));
    CHECK(std::abs(peak.force_N) == Approx(measured("peak_rod_force", run)).epsilon(1e-7));
    const WorstRod stress = worst_rod(run, d, axial_stress);
    CHECK(stress.value == Approx(peak.force_N / 2e-4).epsilon(1e-7));
    CHECK(stress.t == Approx(peak.t).epsilon(0).margin(1e-5));
  }
}

// A slider of 10 kg on a rod of 1.001 m, driven by a crank of 1 m that turns by 1 rad/s from 40 degrees: m
// x'' over the cosine of the rod, and what the crank bears of it, have a peak of 30 ms beside the dead
// centre, of which states 50 ms apart may see nothing.
TEST_CASE("a peak that is narrower than the steps is no error of a state within them") {
  constexpr double l = 1.001, begin = 40 * pi / 180;
  double most = 0;
  for (int k = 0; k <= 1600000; ++k) {
    const double a = begin + 1e-6 * k, s = std::sin(a), c = std::cos(a), r = std::sqrt(l * l - s * s);
    const double pull = 10 * (c + (c * c - s * s) / r + s * s * c * c / (r * r * r)) * l / r;
    most = std::max({most, std::abs(pull), std::abs(10 + pull * (r * c - s * s) / l)});
  }
  for (const double step : {0.04, 0.05, 0.06, 0.07, 0.08}) {
    CAPTURE(step);
    const double x = std::cos(begin) + std::sqrt(l * l - std::sin(begin) * std::sin(begin));
    const Scene scene = read_scene_text(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name = "
        "'P', "
        "position = [1, 0, 0], fixed = true}, {name = 'A', position = ['=cos(40*deg)', '=sin(40*deg)', 0], "
        "mass = 10}, {name = 'B', position = [" +
            testing::number(x) +
            ", 0, 0], mass = 10}]\nrods = [{nodes = ['O', 'A'], mass = 0}, {nodes = ['A', 'B'], mass = 0}]\n"
            "[[structure.constraints]]\nkind = 'line'\nnodes = ['B']\ndirection = [1, 0, 0]\n"
            "[[structure.constraints]]\nkind = 'plane'\nnodes = ['A']\nnormal = [0, 0, 1]\n"
            "[[constraints]]\nkind = 'angle'\nnodes = ['P', 'O', 'A']\naxis = [0, 0, 1]\nmotion = 'rate'\n"
            "rate = 57.29577951308232\n[solver]\nstages = 8\nend_time = 1.6\nstep = " +
            testing::number(step) + "\n",
        "slider.toml", {});
    CHECK(measured("peak_rod_force", simulate(build_model(scene), scene.solver)) ==
          Approx(most).epsilon(1e-5));
  }
}

// All units are alike, in every state: what supports give is level with them nowhere but along their own
// guides, and as much at each. Doubles leave 1e-8 of it; the first state is worked out in more digits.
TEST_CASE("supports of a redundant ring give the same at every unit, from the first state on") {
  for (int units = 5; units <= 10; ++units)
    for (const double fold : {11.3, 17.7, 23.9, 31.1, 40.0}) {
      CAPTURE(units, fold);
      const Simulation run = redundant(units, 0.01, false, fold, false);
      const Diagnostics d = diagnose(run);
      for (std::size_t i = 0; i < d.t.size(); i += i < 3 ? 1 : 7)
        for (int p = 1; p < units; ++p) {
          CAPTURE(i, p);
          const double first = d.at("P0.reaction_N").values[i];
          CHECK(std::abs(d.at("P" + std::to_string(p) + ".reaction_N").values[i] - first) <=
                1e-6 * (1 + first));
        }
    }
}

// Two arms that a gear turns -1 : 3 have one angle th, with V = 2.4525 sin th - 0.981 sin 3 th [J] and
// T = (0.25 + 0.72) / 6 th'^2: the largest T is where th = -90 degrees and the other arm at 270, more than
// half a turn from where the row's angles began. States come 1 % short of it; the quintic's error within a
// step of 0.04 s, 0.6 rad of the faster arm, is some 0.6^6 / 46080 = 1e-6 of the arm.
TEST_CASE("a peak is found where a gear has turned by more than half a turn") {
  const Scene scene = read_scene_text(R"(
[structure]
kind = 'custom'
nodes = [{name = 'R', position = [1, 0, 0], fixed = true}, {name = 'H', position = [0, 0, 0], fixed = true},
  {name = 'B', position = [0.5, 0, 0], velocity = [0, -1, 0]}, {name = 'K', position = [3, 0, 0], fixed = true},
  {name = 'R2', position = [4, 0, 0], fixed = true}, {name = 'C', position = [3.4, 0, 0], velocity = [0, 2.4, 0]}]
rods = [{nodes = ['H', 'B'], mass = 1}, {nodes = ['K', 'C'], mass = 0.5}]
constraints = [{kind = 'plane', nodes = ['B', 'C'], normal = [0, 0, 1]}]
[gravity]
acceleration = [0, -9.81, 0]
[[constraints]]
kind = 'gear'
name = 'gear'
nodes = ['R', 'H', 'B', 'R2', 'K', 'C']
radii = [0.3, 0.1]
axis = [0, 0, 1]
[solver]
step = 0.04
stages = 6
end_time = 2
)",
                                      "gear.toml", {});
  const Simulation run = simulate(build_model(scene), scene.solver);
  REQUIRE(run.status == RunStatus::completed);
  const double inertia = 0.97 / 3, energy = 0.5 * inertia * 4 + 2.4525 + 0.981;
  CHECK(measured("peak_energy", run) == Approx(energy).epsilon(2e-5));
  CHECK(measured("peak_speed", run) == Approx(1.2 * std::sqrt(2 * energy / inertia)).epsilon(1e-5));
}

// Two links that a spring swings: the second link's force has two humps on either side of a state at a step
// of 0.1 s, and the lower one's samples are the higher. In steps of 0.5 ms states alone come within (4e-4
// s)^2 / 2 * 1e4 N/s^2 of the top.
TEST_CASE("of two humps around a state the higher one is found") {
  const auto run_in = [](double step, int stages) {
    const Scene scene = read_scene_text(R"(
[structure]
kind = 'custom'
rods = [{nodes = ['O', 'N0'], mass = 1.8053844534069095}, {nodes = ['N0', 'N1'], mass = 0.9377498940442912}]
[[structure.nodes]]
name = 'O'
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
name = 'N0'
position = [0.8742111348650353, 0, -0.5787979358684484]
mass = 0.5
[[structure.nodes]]
name = 'N1'
position = [0.29375270640528317, 0, -0.3266922352570371]
velocity = [-3.5854892403095997, 0, 2.03929505225354]
[[structure.nodes]]
name = 'W'
position = [1.7937527064052832, 0, 0.37330776474296284]
fixed = true
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = 'spring'
nodes = ['W', 'N1']
stiffness = 43.02353694027577
free_length = 1
[[forces]]
kind = 'drag'
nodes = ['N1']
damping = 0.8528867082122742
[solver]
end_time = 0.5087368926619714
)",
                                        "humps.toml", {});
    SolverOptions options = scene.solver;
    options.step = step, options.stages = stages;
    return simulate(build_model(scene), options);
  };
  const Simulation fine = run_in(0.0005, 3), coarse = run_in(0.1, 7);
  const Diagnostics states = diagnose(fine);
  const double most = states.axial_force.cwiseAbs().maxCoeff();
  CHECK(measured("peak_rod_force", coarse) == Approx(most).epsilon(1e-4));
}

// Two sliders of 1 kg and the rod between them, that F = 10 N pushes from rest against a drag c: v = F/c
// (1 - e^(-c t / m)), m = 2 kg, so that they are fastest at the end and the rod carries most, F / 2, at the
// start. The first acceleration is over within m / c: a curve through it and the ends of a step of 10 ms
// overshoots from h c / m = 7 on.
TEST_CASE("what a damper stops within a small part of a step has no peak there") {
  const std::string text = R"(
[structure]
kind = 'custom'
nodes = [{name = 'A', position = [0, 0, 0], mass = 1}, {name = 'C', position = [1, 0, 0], mass = 1}]
rods = [{nodes = ['A', 'C'], mass = 0}]
[[loads]]
nodes = ['A']
force = [10, 0, 0]
[[constraints]]
kind = 'line'
nodes = ['A', 'C']
direction = [1, 0, 0]
[solver]
step = 0.01
end_time = 1
[[forces]]
kind = 'drag'
nodes = ['A']
damping = )";
  for (const double c : {30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 1e6})
    for (const std::string by : {"path", "dvm", "generalized_alpha"}) {
      CAPTURE(c, by);
      if (by == "generalized_alpha" && c > 100) continue;  // its own states overshoot
      Scene scene = read_scene_text(text + std::to_string(c), "drag.toml", {});
      if (by != "path") scene.solver.method = by;
      const auto model = build_model(scene);
      const Simulation run =
          by == "path" ? simulate_on_path(model, scene.solver) : simulate(model, scene.solver);
      REQUIRE(run.status == RunStatus::completed);
      // The path is exact; the methods are of order 4 and 2, the largest h c / m that one resolves being 0.5.
      const double close = by == "path" ? 1e-9 : 1e-3, most = 10 / c * (1 - std::exp(-c / 2));
      CHECK(measured("peak_speed", run) == Approx(most).epsilon(close));
      CHECK(measured("peak_energy", run) == Approx(most * most).epsilon(2 * close));
      CHECK(measured("peak_rod_force", run) == Approx(5).epsilon(1e-9));
    }
}

}  // namespace peaks_test
