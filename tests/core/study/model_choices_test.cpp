// SPDX-License-Identifier: BSD-3-Clause
// Which choices of a model a scene leaves, and by how much their motions differ.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/diagnostics/diagnostics.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/study/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace model_choices_test {

namespace {

using Lines = std::vector<std::string>;

SceneSource source_of(const std::string& text, Lines changes = {}) {
  return {"s.toml", std::move(changes), std::make_shared<const std::string>(text)};
}

// "name: change change"
Lines choices_of(const SceneSource& source) {
  Lines out;
  for (const ModelChoice& choice : model_choices(source)) {
    out.push_back(choice.name + ":");
    for (const std::string& change : choice.changes) out.back() += " " + change;
  }
  return out;
}

// Everything that can be chosen, and of each kind one that is switched off already.
const std::string all_kinds = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [1, 0, 0], mass = 1}, {name = "H", position = [0, 0, 0], fixed = true},
         {name = "B", position = [0, 1, 0], mass = 2}, {name = "C", position = [0, 0, 1], mass = 1}]
rods = [{nodes = ["H", "A"], mass = 1, area = 1e-4}, {nodes = ["H", "B"], mass = 1, area = 1e-4},
        {nodes = ["H", "C"], mass = 1, area = 1e-4}]
youngs_modulus = 2e11
damping_ratio = 0.02
[[constraints]]
kind = "gear"
name = "idle"
enabled = false
nodes = ["A", "H", "B", "B", "H", "C"]
radii = [1, 2]
[[constraints]]
kind = "gear"
name = "wheels"
nodes = ["A", "H", "B", "B", "H", "C"]
radii = [1, 2]
[[constraints]]
kind = "telescope"
name = "tubes"
nodes = ["A", "B", "C"]
shares = [1, 2]
[[constraints]]
kind = "rack"
name = "pinion"
nodes = ["A", "H", "H", "C"]
radius = 0.2
direction = [0, 0, 1]
axis = [0, 1, 0]
[[constraints]]
kind = "cable"
name = "tie"
nodes = ["A", "B", "C"]
axial_stiffness = 10
pulley_friction = 0.3
[[forces]]
kind = "cable"
name = "loose"
nodes = ["A", "C"]
axial_stiffness = 10
smoothing = 0.01
pulley_friction = 0.2
enabled = false
[[forces]]
kind = "cable"
name = "net"
nodes = ["A", "C"]
axial_stiffness = 10
smoothing = 0.01
[[forces]]
kind = "winch"
nodes = ["A", "B", "C"]
stall_torque = 0.2
no_load_speed = 6000
gear_ratio = 12
drum_radius = 0.05
inertia = 1e-4
pulley_friction = 0.1
[[forces]]
kind = "friction"
nodes = ["A", "B"]
kinetic = 3
[[forces]]
kind = "friction"
nodes = ["B", "C"]
kinetic = 3
enabled = false
[[forces]]
kind = "friction"
nodes = ["A", "C"]
kinetic = 2
[[forces]]
kind = "offload"
nodes = ["*"]
trolley = "following"
[[forces]]
kind = "spring"
nodes = ["A", "B"]
stiffness = 3
damping = 2
[[forces]]
kind = "drag"
nodes = ["A"]
damping = 2
[[forces]]
kind = "spring"
nodes = ["B", "C"]
stiffness = 3
damping = 4
enabled = false
[gravity]
acceleration = [0, 0, -9.81]
)";

}  // namespace

TEST_CASE("the choices of a scene are all that it did not make, each with the changes that make it") {
  CHECK(
      choices_of(source_of(all_kinds)) ==
      Lines{"as the scene says:", "path: one number along the only way to move: solver.model=path",
            "linear constraints kept as equations: solver.eliminate_linear=false",
            "dense matrices: solver.sparse=false",
            "lumped mass: half of a rod at each node: structure.mass=lumped",
            "rigid rods: forces of least norm: structure.rod_model=rigid structure.segments=1 "
            "structure.youngs_modulus=inf",
            "quasi-static rods: stretched by the rigid run's forces: structure.rod_model=quasi-static",
            "elastic rods, with waves: structure.rod_model=elastic",
            "bending rods: elastic, in 4 segments: structure.rod_model=elastic structure.segments=4",
            "without wheels: constraints[1].enabled=false", "without tubes: constraints[2].enabled=false",
            "without pinion: constraints[3].enabled=false", "without net: forces[1].enabled=false",
            "without damping: structure.damping_ratio=0 forces[7].damping=0 forces[8].enabled=false",
            "without pulley friction: constraints[4].pulley_friction=0 forces[2].pulley_friction=0",
            "without friction: forces[3].enabled=false forces[5].enabled=false",
            "0 g flight: neither weight nor offload: gravity.acceleration=[0,0,0] forces[6].enabled=false"});
}

TEST_CASE("rods that have moduli of their own keep them in models that give") {
  const std::string rods = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], fixed = true},
  {name = "C", position = [0.5, 0.5, 0], velocity = [0, 0, 1], mass = 1}]
rods = [{nodes = ["A", "C"], mass = 0.1, youngs_modulus = 7e10, area = 1e-4},
  {nodes = ["B", "C"], mass = 0.1, youngs_modulus = 2e11, area = 1e-4}]
)";
  Lines told;
  for (const std::string& line : choices_of(source_of(rods)))
    if (line.find("rods") != std::string::npos && line.find("mass") == std::string::npos)
      told.push_back(line);
  CHECK(told ==
        Lines{"rigid rods: forces of least norm: structure.rod_model=rigid structure.segments=1 "
              "structure.youngs_modulus=inf structure.rods[0].youngs_modulus=inf "
              "structure.rods[1].youngs_modulus=inf",
              "quasi-static rods: stretched by the rigid run's forces: structure.rod_model=quasi-static",
              "elastic rods, with waves: structure.rod_model=elastic",
              "bending rods: elastic, in 4 segments: structure.rod_model=elastic structure.segments=4"});
  int runs = 0;
  for (const MeasuredModel& model : compare_models(source_of(rods, {"solver.end_time=0.1"}), 1, {})) {
    if (model.choice.name.find("rods") == std::string::npos) continue;
    INFO(model.choice.name << ": " << model.message);
    CHECK(model.outcome == "completed");
    ++runs;
  }
  CHECK(runs >= 4);
}

TEST_CASE("a scene that chose otherwise is offered what it left") {
  const SceneSource other{find_scene("hoop6"),
                          {"solver.model=\"path\"", "solver.eliminate_linear=false", "solver.sparse=false",
                           "structure.mass=\"lumped\"", "structure.model=\"sector\""}};
  CHECK(choices_of(other) ==
        Lines{"as the scene says:", "full: every unit solved: structure.model=full",
              "linear constraints eliminated: solver.eliminate_linear=true",
              "sparse matrices: solver.sparse=true",
              "consistent mass: rigid uniform rods: structure.mass=consistent",
              "forces shared by stiffness: E = 70 GPa: structure.youngs_modulus=7e10",
              "quasi-static rods: stretched by the rigid run's forces: E = 70 GPa: "
              "structure.rod_model=quasi-static structure.youngs_modulus=7e10",
              "elastic rods, with waves: E = 70 GPa: structure.rod_model=elastic "
              "structure.youngs_modulus=7e10",
              "bending rods: elastic, in 4 segments: E = 70 GPa: structure.rod_model=elastic "
              "structure.segments=4 structure.youngs_modulus=7e10"});
  const auto of_rods = [](const Lines& changes) {
    Lines out;
    for (const std::string& line : choices_of({find_scene("hoop6"), changes}))
      if (line.find("rods") != std::string::npos && line.find("rigid uniform rods") == std::string::npos)
        out.push_back(line);
    return out;
  };
  const std::string rigid = "rigid rods: structure.rod_model=rigid",
                    least =
                        "rigid rods: forces of least norm: structure.rod_model=rigid "
                        "structure.segments=1 structure.youngs_modulus=inf",
                    still =
                        "quasi-static rods: stretched by the rigid run's forces: "
                        "structure.rod_model=quasi-static",
                    waves = "elastic rods, with waves: structure.rod_model=elastic",
                    bends =
                        "bending rods: elastic, in 4 segments: structure.rod_model=elastic "
                        "structure.segments=4";
  CHECK(of_rods({"structure.youngs_modulus=3e9", "structure.rod_model=\"elastic\""}) ==
        Lines{least, rigid, still, bends});
  CHECK(of_rods({"structure.youngs_modulus=3e9", "structure.rod_model=\"quasi-static\""}) ==
        Lines{least, rigid, waves, bends});
  CHECK(
      of_rods({"structure.youngs_modulus=3e9", "structure.rod_model=\"elastic\"", "structure.segments=2"}) ==
      Lines{least, rigid + " structure.segments=1", still + " structure.segments=1"});
}

// A mass of 2 kg on a spring against drag, x = 1 + exp(-d t) (a cos w t + b sin w t), which swings some
// three times, and one of 1 kg that coasts along y against drag and goes further.
TEST_CASE(
    "motions differ by the farthest two nodes at any time, and at the end by that which went farthest") {
  const double m = 2, k = 180, c = 1.2, start = 0.3, speed = 0.7, end = 1.2, h = 0.01, e = 0.03, v = 2;
  const SceneSource source = source_of(
      R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [1.3, 0, 0], velocity = [0.7, 0, 0], mass = 2},
         {name = "B", position = [0, 3.1, 0], velocity = [0, 2, 0], mass = 1}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 180
free_length = 1
[[forces]]
kind = "drag"
nodes = ["A"]
damping = 1.2
[[forces]]
kind = "drag"
nodes = ["B"]
damping = 0.03
[solver]
stages = 5
step = 0.01
end_time = 1.2
)");
  const double d = c / (2 * m), w0 = std::sqrt(k / m), w = std::sqrt(k / m - d * d);
  const auto apart = [&](double t) {
    const double damped =
        std::exp(-d * t) * (start * std::cos(w * t) + (speed + d * start) / w * std::sin(w * t));
    return std::abs(damped - start * std::cos(w0 * t) - speed / w0 * std::sin(w0 * t));
  };
  double largest = 0;
  for (int i = 0; i <= std::lround(end / h); ++i) largest = std::max(largest, apart(i * h));
  const double coasted = v / e * (1 - std::exp(-e * end));
  REQUIRE(largest > 1.02 * apart(end));        // somewhere on the way
  REQUIRE(v * end - coasted < 0.9 * largest);  // and not of the tip
  const auto models = compare_models(source, 1, {});
  int found = 0;
  for (const MeasuredModel& model : models) {
    if (model.choice.name != "without damping") continue;
    ++found;
    // Steps of a tenth of a radian at order 8.
    CHECK(model.difference == Approx(largest).epsilon(1e-9));
    CHECK(model.tip_difference == Approx(v * end - coasted).epsilon(1e-9));
    CHECK(model.outcome == "completed");
    CHECK(std::isnan(model.deployment_time));
  }
  CHECK(found == 1);
  // The mesh: what single precision makes of the positions of the scene's own run.
  const Scene scene = source.read();
  const Simulation run = simulate(build_model(scene), scene.solver);
  double rounded = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const VectorXd q = run.trajectory.positions(i);
    for (Index n = 0; n < q.size(); n += 3)
      rounded = std::max(rounded, (q.segment<3>(n) - q.segment<3>(n).cast<float>().cast<double>()).norm());
  }
  CHECK(models.back().choice.name == "single precision of the display's mesh");
  CHECK(models.back().difference == rounded);
  CHECK(models.front().difference == 0);
  CHECK(models.front().tip_difference == 0);
}

// A mass on a rod that falls from the horizontal, E A of 1000 N: the scene's own rod gives, or is a chain of
// four. Whether the rod says so itself or all rods do, in the scene or in a file, a row is the model that it
// names.
TEST_CASE("rows of rods are of the models that they name, whoever says what rods are") {
  const auto folder =
      std::filesystem::temp_directory_path() / ("unfurl_choices_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "rods.csv") << "a,b,mass,area,youngs_modulus\nA,B,1,1e-5,1e8\n";
  const auto scene = [&](const std::string& rods) {
    std::ofstream(folder / "s.toml") << R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 10}]
constraints = [{kind = "plane", nodes = ["*"], normal = [0, 1, 0]}]
)" + rods + R"(
[solver]
end_time = 0.5
step = 0.005
[gravity]
acceleration = [0, 0, -9.81]
)";
    return SceneSource{(folder / "s.toml").string()};
  };
  const std::string rod = "rods = [{nodes = ['A', 'B'], mass = 1, area = 1e-5, youngs_modulus = 1e8";
  const auto own_peak = [&](const std::string& rods) {
    const Scene read = scene(rods).read();
    const Simulation run = simulate(build_model(read), read.solver);
    return find_measure("peak_rod_force").value(run, diagnose(run));
  };
  const double rigid = own_peak("rods = [{nodes = ['A', 'B'], mass = 1, area = 1e-5}]");
  const double stretched = own_peak("rod_model = 'quasi-static'\n" + rod + "}]");
  const double waves = own_peak("rod_model = 'elastic'\n" + rod + "}]");
  REQUIRE(std::abs(rigid - waves) > 1);
  const double bent = own_peak("rod_model = 'elastic'\nsegments = 4\n" + rod + "}]");
  REQUIRE(std::abs(bent - waves) > 1e-3);
  for (const std::string& rods :
       {rod + ", elastic = true}]", rod + ", segments = 4}]", rod + ", elastic = true, segments = 2}]",
        "rod_model = 'elastic'\n" + rod + ", segments = 4}]",
        "rod_model = 'elastic'\nsegments = 4\n" + rod + "}]", "rod_model = 'elastic'\n" + rod + "}]",
        std::string("rods_file = 'rods.csv'"),
        std::string("rod_model = 'elastic'\nsegments = 4\nrods_file = 'rods.csv'")}) {
    INFO(rods);
    int found = 0;
    for (const MeasuredModel& m : compare_models(scene(rods), 1, {})) {
      const bool of_rigid = m.choice.name.starts_with("rigid rods"),
                 of_forces = m.choice.name.starts_with("quasi");
      if (m.choice.name.starts_with("elastic rods")) CHECK(m.peak_force == Approx(waves).epsilon(1e-9));
      if (m.choice.name.starts_with("bending rods")) {
        CHECK(m.peak_force == Approx(bent).epsilon(1e-9));
        // Of two parts and four, of a rod of 1 m: its middle is not compared with its quarter.
        if (rods.find("segments = 2") != std::string::npos) CHECK(m.difference < 0.1);
      }
      if (!of_rigid && !of_forces) continue;
      INFO(m.choice.name << ": " << m.outcome);
      ++found;
      CHECK(m.peak_force == Approx(of_rigid ? rigid : stretched).epsilon(1e-12));
    }
    CHECK(found >= 2);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace model_choices_test
