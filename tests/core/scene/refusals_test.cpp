// SPDX-License-Identifier: BSD-3-Clause
// What a scene says must act, or be refused or warned of with its place: nothing is accepted in silence.
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "core/integrators/integrator.hpp"
#include "core/scene/library.hpp"
#include "core/scene/write.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace refusals_test {

namespace {

using testing::end_positions, testing::error_of, testing::run_scene;

bool refused(const std::string& text, const std::string& why, const std::vector<std::string>& changes = {}) {
  const std::string error = error_of(text, changes);
  if (error.find(why) != std::string::npos) return true;
  UNSCOPED_INFO("said: " << error << "\nnot: " << why);
  return false;
}
std::string warnings_of(const std::string& text, const std::vector<std::string>& changes = {}) {
  std::string all;
  for (const std::string& warning : run_scene(text, changes).warnings) all += warning + "\n";
  return all;
}

// An arm O-A of 1.3 m and a second one A-B, in space, and a fixed point P.
const std::string arms = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "P", position = [0, -1, 0.5], fixed = true},
  {name = "A", position = [0.5, 1.2, 0], mass = 0.7},
  {name = "B", position = [0.5, 1.2, 0.9], mass = 1.1}]
rods = [
  {nodes = ["O", "A"], mass = 2},
  {nodes = ["A", "B"], mass = 0.5}]
[solver]
step = 0.01
end_time = 0.2
)";

std::string entry(const std::string& table, const std::string& lines) {
  return "[[" + table + "]]\n" + lines + "\n";
}
std::string constraint(const std::string& lines) {
  return arms + entry("constraints", lines);
}
std::string force(const std::string& lines) {
  return arms + entry("forces", lines);
}

// A mass at x = 0.3 m, `far` metres from the origin along y.
std::string point(double far, const std::string& rest) {
  std::ostringstream text;
  text << "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'A'\nposition = [0.3, " << far
       << ", 0.1]\nvelocity = [0, 0, 0.4]\nmass = 2\n[solver]\nstep = 0.01\nend_time = 0.5\n"
       << rest;
  return text.str();
}

}  // namespace

TEST_CASE("an angle about an axis that its rods are parallel to is refused with its place") {
  // A-B points along z.
  for (const char* kind : {"kind = 'angle'", "kind = 'angle_stop'\nmax = 90"})
    CHECK(refused(constraint(std::string(kind) + "\nnodes = ['O', 'A', 'B']\naxis = [0, 0, 2]"),
                  "constraints[0].axis: is along the line from 'A' to 'B' at t = 0"));
  CHECK(refused(force("kind = 'torsion_spring'\nstiffness = 1\nnodes = ['O', 'A', 'B']\naxis = [0, 0, 2]"),
                "forces[0].axis: is along the line from 'A' to 'B' at t = 0"));
  CHECK(error_of(force("kind = 'torsion_spring'\nstiffness = 1\nnodes = ['O', 'A', 'B']\naxis = [0, 0.1, 2]"))
            .empty());
}

TEST_CASE("a measure of nodes at one place is refused with its key and their names") {
  // A and H at one place: no line goes from the one to the other, whatever is measured from it.
  std::string points = "[structure]\nkind = 'custom'\nnodes = [\n";
  for (const char* node : {"'A', position = [0.3, 0.1, 7]", "'H', position = [0.3, 0.1, 7]",
                           "'B', position = [1, 0, 7]", "'C', position = [1, 1, 8]"})
    points += std::string("{name = ") + node + ", mass = 1},\n";
  points += "]\n";
  struct Case {
    std::string table, lines, key;
  };
  const std::string three = "\nnodes = ['A', 'H', 'B']";
  for (const Case& c : std::vector<Case>{
           {"forces", "kind = 'torsion_spring'\nstiffness = 1" + three, "nodes"},
           {"forces", "kind = 'torsion_spring'\nstiffness = 1\nnodes = ['B', 'A', 'H']", "nodes"},
           {"forces", "kind = 'torsion_spring'\nstiffness = 1\naxis = [0, 0, 1]" + three, "nodes"},
           {"forces", "kind = 'motor'\nstall_torque = 1\nno_load_speed = 10\naxis = [0, 0, 1]" + three,
            "nodes"},
           {"forces", "kind = 'friction'\nkinetic = 1" + three, "nodes"},
           {"forces", "kind = 'bending'\nstiffness = 1" + three, "nodes"},
           {"forces", "kind = 'spring'\nstiffness = 1\nnodes = ['A', 'H']", "nodes"},
           {"forces", "kind = 'cable'\naxial_stiffness = 1\nnodes = ['B', 'A', 'H']", "nodes"},
           {"forces", "kind = 'combination'\nstiffness = 1\nterms = ['1 angle A H B']", "terms"},
           {"forces", "kind = 'combination'\nstiffness = 1\nterms = ['1 angle B H A about 0 0 1']", "terms"},
           {"forces", "kind = 'combination'\nstiffness = 1\nterms = ['1 length A H']", "terms"},
           {"forces", "kind = 'combination'\nstiffness = 1\nterms = ['1 dihedral B A H C']", "terms"},
           {"forces", "kind = 'combination'\nstiffness = 1\nterms = ['1 dihedral A H B C']", "terms"},
           {"forces", "kind = 'combination'\nstiffness = 1\nterms = ['1 dihedral A B H C']", "terms"},
           {"forces", "kind = 'combination'\nstiffness = 1\nterms = ['1 dihedral C A B H']", "terms"},
           {"constraints", "kind = 'angle'" + three, "nodes"},
           {"constraints", "kind = 'angle_stop'\nmax = 170" + three, "nodes"},
           {"constraints", "kind = 'collinear'" + three, "nodes"},
           {"constraints", "kind = 'coplanar'\nnodes = ['A', 'B', 'H', 'C']", "nodes"},
           {"constraints", "kind = 'length'\nnodes = ['A', 'H']", "nodes"},
           {"constraints", "kind = 'gear'\nradii = [1, 1]\nnodes = ['A', 'H', 'B', 'A', 'B', 'C']", "nodes"},
           {"constraints", "kind = 'rack'\nradius = 1\ndirection = [1, 0, 0]\nnodes = ['A', 'H', 'B', 'C']",
            "nodes"},
           {"constraints", "kind = 'telescope'\nnodes = ['A', 'B', 'H']", "nodes"},
           {"constraints", "kind = 'combination'\nterms = ['1 angle A H B']", "terms"}}) {
    INFO(c.lines);
    const std::string error = error_of(points + entry(c.table, c.lines));
    INFO(error);
    CHECK(error.find(c.table + "[0]." + c.key + ": ") != std::string::npos);
    CHECK((error.find("'A' and 'H' must not be at the same place at t = 0") != std::string::npos ||
           error.find("'H' and 'A' must not be at the same place at t = 0") != std::string::npos));
  }
  // The third of nodes in line may be where the first is, and a way may begin at nothing.
  CHECK(error_of(points + entry("constraints", "kind = 'collinear'\nnodes = ['A', 'B', 'H']")).empty());
  CHECK(error_of(points + "[deployment]\nmeasure = '1 length A H'\ndeployed = 1\n").empty());
}

TEST_CASE("relations of any size hold the structure where it is") {
  for (const double size : {1e-9, 1e-3, 1.0, 1e9}) {
    std::ostringstream wrong, right;
    wrong << "[[constraints]]\nkind = 'relation'\nnodes = ['A']\ncoefficients = [" << size
          << ", 0, 0]\nvalue = " << 0.30001 * size << "\n";
    right << "[[constraints]]\nkind = 'relation'\nnodes = ['A']\ncoefficients = [" << size << ", 0, "
          << 2 * size << "]\n[gravity]\nacceleration = [3, 0, -10]\n";
    CHECK(refused(point(0, wrong.str()), "is violated at t = 0"));
    // Wherever the origin lies.
    CHECK(refused(point(1e6, wrong.str()), "is violated at t = 0"));
    // x + 2 z stays: along (2, -1) / sqrt 5 of x and z the acceleration (3, -10) is 16 / sqrt 5 and the
    // velocity (0, 0.4) is -0.4 / sqrt 5, in x thus 6.4 and -0.16.
    const Simulation run = run_scene(point(0, right.str()));
    const double t = 0.5;
    CHECK(end_positions(run)[0] == Approx(0.3 - 0.16 * t + 3.2 * t * t).epsilon(1e-12));
  }
  // A second one that says otherwise is not dropped as if it followed from the first.
  CHECK(refused(
      point(0,
            "[[constraints]]\nkind = 'relation'\nnodes = ['A']\ncoefficients = [1, 0, 0]\n"
            "[[constraints]]\nkind = 'relation'\nname = 'small'\nnodes = ['A']\ncoefficients = [1e-10, 0, "
            "0]\nvalue = 6e-11\n"),
      "small is violated at t = 0"));
}

TEST_CASE("contradictory drives are named when the scene is read, for every method") {
  const auto drive = [](const char* name, double to) {
    std::ostringstream text;
    text << "[[constraints]]\nkind = 'coordinate'\nname = '" << name
         << "'\nnodes = ['A']\ndirection = [1, 0, 0]\nmotion = 'smooth'\nduration = 0.4\nto = " << to << "\n";
    return text.str();
  };
  for (const Method& method : methods())
    CHECK(refused(point(0, drive("one", 1) + drive("two", 2)), "one, two hold or drive the same motion",
                  {"solver.method=" + std::string(method.name)}));
  CHECK(
      refused(point(0, drive("one", 1) + drive("two", 1) + "start = 0.1\n"), "drives contradict each other"));
  // Two that never end, and begin alike.
  CHECK(refused(point(0,
                      "[[constraints]]\nkind = 'coordinate'\nname = 'slow'\nnodes = ['A']\n"
                      "direction = [1, 0, 0]\nmotion = 'rate'\nrate = 0.2\n"
                      "[[constraints]]\nkind = 'coordinate'\nname = 'fast'\nnodes = ['A']\n"
                      "direction = [1, 0, 0]\nmotion = 'rate'\nrate = 0.7\n"),
                "drives contradict each other"));
  CHECK(run_scene(point(0, drive("one", 1) + drive("two", 1))).status == RunStatus::completed);  // they agree
}

// Where drives hold measures that are not the same in every pose, only the run comes to know: a distance and
// an angle of a crank; a rod that warms beside them.
TEST_CASE("what is driven against what is held is named where the run ends") {
  const std::string crank = R"(
[structure]
kind = "custom"
nodes = [
  {name = "P", position = [1, 0, 0], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [0.6, 0.8, 0], mass = 1}]
rods = [{name = "arm", nodes = ["O", "A"], mass = 0}]
constraints = [{kind = "plane", nodes = ["A"], normal = [0, 0, 1]}]
[[constraints]]
kind = "angle"
name = "turn"
nodes = ["P", "O", "A"]
axis = [0, 0, 1]
motion = "smooth"
to = 80
duration = 0.5
[solver]
step = 0.01
end_time = 0.4
)";
  const Simulation two = run_scene(crank + R"(
[[constraints]]
kind = "length"
name = "pull"
nodes = ["P", "A"]
motion = "smooth"
to = 1.5
duration = 0.5
)");
  CHECK(two.status == RunStatus::failed);
  CHECK(two.message.find("no motion follows what is driven there (turn, pull)") != std::string::npos);
  const Simulation one = run_scene(crank);
  CHECK(one.status == RunStatus::completed);
  const Simulation warm = run_scene(R"(
[structure]
kind = "custom"
nodes = [
  {name = "P", position = [1, 0, 0], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
  {name = "Q", position = [-0.5, 2, 0], fixed = true}, {name = "A", position = [0.6, 0.8, 0], mass = 1}]
rods = [
  {name = "arm", nodes = ["O", "A"], mass = 0}, {name = "low", nodes = ["P", "A"], mass = 0},
  {name = "high", nodes = ["Q", "A"], mass = 0}]
constraints = [{kind = "plane", nodes = ["A"], normal = [0, 0, 1]}]
[[forces]]
kind = "temperature"
rods = ["arm"]
expansion = 1e-3
times = [0, 0.2]
values = [0, 10]
[solver]
step = 0.01
end_time = 0.4
)");
  CHECK(warm.status == RunStatus::failed);
  CHECK(warm.message.find("no motion follows what is driven there (rod arm)") != std::string::npos);
  // Nor where there is nothing that could move at all.
  const Simulation held = run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 0], fixed = true}, {name = "Q", position = [1, 0, 0], fixed = true}]
rods = [{name = "arm", nodes = ["P", "Q"], mass = 1}]
[[forces]]
kind = "temperature"
rods = ["arm"]
expansion = 1e-5
times = [0, 0.2, 0.4]
values = [0, 0, 100]
[solver]
step = 0.01
end_time = 0.4
)");
  CHECK(held.status == RunStatus::failed);
  CHECK(held.message.find("no motion follows what is driven there (rod arm)") != std::string::npos);
}

TEST_CASE("drives that leave what their measure can be are refused with the time") {
  CHECK(refused(constraint("kind = 'length'\nnodes = ['P', 'A']\nmotion = 'smooth'\nto = -1\nduration = 0.2"),
                "constraints[0].to: takes the length to "));
  CHECK(refused(constraint("kind = 'length'\nnodes = ['P', 'A']\nmotion = 'smooth'\nto = 0\nduration = 0.2"),
                "it must stay > 0"));
  CHECK(refused(constraint("kind = 'length'\nnodes = ['P', 'A']\nmotion = 'rate'\nrate = -20"),
                "constraints[0].rate: takes the length to "));
  CHECK(refused(
      constraint("kind = 'angle'\nnodes = ['P', 'O', 'A']\nmotion = 'smooth'\nto = 190\nduration = 0.1"),
      "without an axis the angle stays between 0 and 180 deg; give the axis of the hinge"));
  CHECK(refused(constraint("kind = 'angle_stop'\nnodes = ['P', 'O', 'A']\nmax = 190"),
                "constraints[0].max: is never met"));
  // Not within the run.
  CHECK(error_of(constraint("kind = 'length'\nnodes = ['P', 'A']\nmotion = 'rate'\nrate = -1")).empty());
}

TEST_CASE("a table of motion holds its last value, and starts clean") {
  const Simulation run = run_scene(
      point(0,
            "[[constraints]]\nkind = 'coordinate'\nname = 'slide'\nnodes = ['A']\ndirection = [1, 0, 0]\n"
            "motion = 'table'\ntimes = [0, 0.5, 1]\nvalues = [0.3, 0.5, 1.3]\n"),
      {"solver.end_time=3", "structure.nodes.A.velocity=[0,0,0]"});
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.warnings.empty());
  CHECK(end_positions(run)[0] == Approx(1.3).epsilon(1e-13));
  CHECK(run.trajectory.velocities(0)[0] == Approx(0).epsilon(0).margin(1e-14));
}

TEST_CASE("entries that would say nothing, or twice the same, are refused") {
  CHECK(refused(constraint("kind = 'relation'\nnodes = ['A', 'B']\ncoefficients = [0, 0, 0, 0, 0, 0]"),
                "constraints[0].coefficients: must not all be zero"));
  CHECK(refused(constraint("kind = 'equal'\nnodes = ['A', 'A']\ndirection = [1, 0, 0]"),
                "constraints[0].nodes: names 'A' more than once"));
  CHECK(refused(constraint("kind = 'coordinate'\nnodes = ['A', 'A']\ndirection = [1, 0, 0]"),
                "constraints[0].nodes: names 'A' more than once"));
  CHECK(refused(force("kind = 'drag'\nnodes = ['A*', 'A']\ndamping = 1"),
                "forces[0].nodes: names 'A' more than once"));
  CHECK(refused(arms + entry("loads", "nodes = ['*', 'A']\nforce = [1, 0, 0]"),
                "loads[0].nodes: names 'A' more than once"));
  CHECK(refused(force("kind = 'spring'\nnodes = ['O', 'B']"), "forces[0].stiffness: "));
  CHECK(refused(arms, "structure.rods[0].length: must be ", {"structure.rods[0].length=0"}));
  CHECK(refused(arms, "structure.rods[0].density: give mass, or density and area, not both",
                {"structure.rods[0].density=7800", "structure.rods[0].area=1e-4"}));
  CHECK(refused("[structure]\nkind = 'custom'\nnodes_file = \"nodes.csv\\u0000x\"\n", "u0000"));
}

TEST_CASE("keys that do nothing as the others are given are warned of with their place") {
  const std::string hold = "kind = 'coordinate'\nnodes = ['A']\ndirection = [1, 0, 0]\n";
  CHECK(warnings_of(constraint(hold)).empty());
  for (const char* idle : {"to = 2", "rate = 1", "duration = 3"}) {
    const std::string key(idle, std::string_view(idle).find(' '));
    const std::string warnings = warnings_of(constraint(hold + idle));
    INFO(warnings);
    CHECK(warnings.find("s.toml:19:") != std::string::npos);
    CHECK(warnings.find("constraints[0]." + key + ": does nothing with motion = 'hold'") !=
          std::string::npos);
  }
}

TEST_CASE("what a structure's table gives and does nothing is warned of with its line") {
  const auto said = [](const std::string& keys) {
    std::string text;
    for (const SceneProblem& warning :
         read_scene_text("[structure]\nkind = 'hoop'\nyoungs_modulus = 7e10\n" + keys, "s.toml").warnings)
      text += problem_text(warning) + "\n";
    return text;
  };
  CHECK(said("damping_ratio = 0.02\n") ==
        "s.toml:4:17: structure.damping_ratio: does nothing with rod_model = 'rigid'\n");
  CHECK(said("damping_ratio = 0.02\nrod_model = 'elastic'\n").empty());
  CHECK(said("arc_angle = 90\n") == "s.toml:4:13: structure.arc_angle: does nothing with closed = true\n");
}

TEST_CASE("a scene that is written with all of its keys is not warned of those at their defaults") {
  for (const LibraryScene& library : library_scenes()) {
    INFO(library.name);
    const std::string text = scene_text(read_scene_file(library.path));
    std::string said;
    for (const SceneProblem& warning : read_scene_text(text, "s.toml").warnings)
      said += problem_text(warning) + "\n";
    CHECK(said == "");
  }
  const std::string torque =
      "kind = 'torsion_spring'\nfold_angle = true\nstiffness = 1\naxis = [0, 0, 0]\n";  // none: what it is
                                                                                        // without the key
  for (const SceneProblem& warning :
       read_scene_text("structure.kind = 'hoop'\n" + entry("forces", torque), "s.toml").warnings)
    FAIL_CHECK(problem_text(warning));
}

TEST_CASE("what is set on the command line and does nothing is warned of in every table") {
  const auto said = [](const std::vector<std::string>& changes) {
    std::string text;
    for (const SceneProblem& warning : read_scene_file(find_scene("hoop6"), changes).warnings)
      text += problem_text(warning) + "\n";
    return text;
  };
  CHECK(said({"solver.turn=0.2"}) == "--set solver.turn: does nothing with adaptive = false\n");
  CHECK(said({"solver.turn=0.2", "solver.adaptive=true"}).empty());
  CHECK(said({"solver.tolerance=1e-6", "solver.turn=0.2", "solver.adaptive=true"}) ==
        "--set solver.adaptive: does nothing with tolerance > 0, which picks steps that are all equal\n");
  const std::string picks = "does nothing with tolerance > 0, which picks stages and step\n";
  CHECK(said({"solver.tolerance=1e-6", "solver.step=0.1", "solver.stages=7"}) ==
        "--set solver.step: " + picks + "--set solver.stages: " + picks);
  CHECK(said({"solver.tolerance=1e-6"}).empty());
  CHECK(said({"solver.step=0.1", "solver.stages=7"}).empty());
  for (const std::string setting : {"method=rk4", "nodes=chebyshev", "stages=7", "constraints_at=ends"})
    CHECK(said({"solver.model=path", "solver." + setting}) ==
          "--set solver." + setting.substr(0, setting.find('=')) +
              ": does nothing with model = 'path', whose motion is at round-off whatever the method\n");
  CHECK(said({"solver.model=path", "solver.step=0.1"}).empty());
  CHECK(said({"solver.model=auto", "solver.method=rk4"}).empty());
  CHECK(said({"solver.rho_inf=0.5"}) == "--set solver.rho_inf: does nothing with method = 'dvm'\n");
  CHECK(said({"structure.wall_thickness=0.001"}) ==
        "--set structure.wall_thickness: does nothing with section = 'round'\n");
  for (const std::string key : {"damping_ratio", "damping_time"}) {
    CHECK(said({"structure.youngs_modulus=7e10", "structure." + key + "=0.01"}) ==
          "--set structure." + key + ": does nothing with rod_model = 'rigid'\n");
    CHECK(said({"structure.youngs_modulus=7e10", "structure.rod_model=elastic", "structure." + key + "=0.01"})
              .empty());
  }
  CHECK(said({"structure.arc_angle=90"}) == "--set structure.arc_angle: does nothing with closed = true\n");
  // What the scene itself keeps for other methods is not what was asked for: its stages here.
  CHECK(said({"solver.method=rk4"}).empty());
}

TEST_CASE("numbers that need another number beside them are warned of where they stand alone") {
  const auto notes = [](std::vector<std::string> changes) {
    changes.emplace_back("structure.model=joints");
    return build_model(read_scene_file(find_scene("hoop6"), changes))->structure.notes;
  };
  using Notes = std::vector<std::string>;
  CHECK(notes({"structure.perturbed_force=190"}) ==
        Notes{"perturbed_force does nothing: perturbed_unit says which unit has it"});
  CHECK(notes({"structure.perturbed_force=190", "structure.perturbed_unit=2"}).empty());
  CHECK(notes({"structure.error_seed=7"}) ==
        Notes{"--set structure.error_seed: does nothing with length_error = 0"});
}

TEST_CASE("entries are addressed by name in brackets, too") {
  const std::string text =
      constraint(
          "kind = 'coordinate'\nname = 'push'\nnodes = ['A']\ndirection = [1, 0, 0]\nmotion = 'smooth'\nto = "
          "2") +
      entry("constraints", "kind = 'plane'\nname = 'my plane'\nnodes = ['B']\nnormal = [0, 0, 1]");
  const Scene scene = read_scene_text(
      text, "s.toml", {"constraints[push].duration=0.7", "constraints['my plane'].normal=[0,1,0]"});
  CHECK(scene.constraints[0].values.real("duration") == 0.7);
  CHECK(scene.constraints[1].values.vector("normal") == std::vector<double>{0, 1, 0});
  CHECK(refused(text, "constraints has no entry named 'pus'; did you mean 'push'?",
                {"constraints[pus].duration=1"}));
}

TEST_CASE("the angle of two rods opens at the node that they share, whichever way they are listed") {
  // Q-P points along x, Q-R is 68 deg away from it, S-T of no common node 31 deg from x.
  const double a = 68 * radians_per_degree, b = 31 * radians_per_degree;
  const auto said = [&](const char* first, const char* second, const std::string& rods) {
    std::ostringstream text;
    text.precision(17);
    text << "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [1.7, 0.2, 0], mass = 1},\n"
            "{name = 'Q', position = [0.4, 0.2, 0], mass = 1}, {name = 'R', position = ["
         << 0.4 + 2 * std::cos(a) << ", " << 0.2 + 2 * std::sin(a) << ", 0], mass = 1},\n"
         << "{name = 'S', position = [3, 3, 0], mass = 1}, {name = 'T', position = [" << 3 + std::cos(b)
         << ", " << 3 + std::sin(b) << ", 0], mass = 1}]\n"
         << "rods = [{name = 'one', nodes = " << first << ", mass = 1}, {name = 'two', nodes = " << second
         << ", mass = 1},\n{name = 'far', nodes = ['S', 'T'], mass = 1}]\n"
         << "[[constraints]]\nkind = 'angle'\nrods = " << rods
         << "\nmotion = 'table'\ntimes = [0, 1]\nvalues = [1, 2]\n";
    const std::string error = error_of(text.str());
    const std::size_t at = error.find("the structure at ");
    return at == std::string::npos ? error : error.substr(at + 17, 3);
  };
  for (const char* first : {"['Q', 'P']", "['P', 'Q']"})
    for (const char* second : {"['Q', 'R']", "['R', 'Q']"})
      for (const char* rods : {"['one', 'two']", "['two', 'one']"}) {
        INFO(first << " " << second << " " << rods);
        CHECK(said(first, second, rods).substr(0, 2) == "68");
      }
  CHECK(said("['Q', 'P']", "['Q', 'R']", "['one', 'far']").substr(0, 2) == "31");
  CHECK(said("['P', 'Q']", "['Q', 'R']", "['one', 'far']").substr(0, 3) == "149");
}

TEST_CASE("a hoop that is deployed as it starts has nothing to run to") {
  const std::string hoop = "[structure]\nkind = 'hoop'\nmodel = 'sector'\nfold_angle = ";
  CHECK(refused(hoop + "0\n", "s.toml:4:14: structure.fold_angle: must be in (0, 90) deg; got 0"));
  CHECK(refused(hoop + "3e-8\n",  // 5e-10 rad
                "s.toml:4:14: structure.fold_angle: fold_angle must be larger than 0 degrees, at which the "
                "structure is deployed"));
  CHECK(error_of(hoop + "1e-6\n").empty());
}

TEST_CASE("what is missing is asked for by what it is: nodes, rods, the name of one rod") {
  CHECK(refused(force("kind = 'follower'\nforce = 1"),
                "forces[0].rod: is missing; must be the name of one rod"));
  CHECK(refused(force("kind = 'follower'\nrod = ['O-A', 'A-B']\nforce = 1"),
                "forces[0].rod: must be 1 name; got 2"));
  CHECK(refused(force("kind = 'temperature'\nexpansion = 1e-5"),
                "forces[0].rods: is missing; must be a list of names or globs of rods or groups"));
  CHECK(refused(force("kind = 'drag'\ndamping = 1"),
                "forces[0].nodes: is missing; must be a list of node names"));
}

TEST_CASE("an angle of a rod with itself is refused, and a misspelt table of variables is answered") {
  const std::string why =
      "an angle between a line and itself is 0 whatever moves; name two rods, or three different nodes";
  for (const char* kind : {"kind = 'torsion_spring'\nstiffness = 1\n", "kind = 'friction'\nkinetic = 1\n"})
    CHECK(refused(force(kind + std::string("rods = ['O-A', 'O-A']\n")), "forces[0].rods: " + why));
  for (const char* key : {"variable", "Variables"})
    CHECK(refused(force("kind = 'drag'\nnodes = ['A']\ndamping = 1\n[" + std::string(key) + "]\nn = 1"),
                  key + std::string(": unknown key; did you mean 'variables'?")));
}

TEST_CASE("values beside a table are refused") {
  const std::string load = "kind = 'load_over_time'\nnodes = ['A']\nforce = [1, 0, 0]\ntable = 'f.csv'\n";
  CHECK(refused(force(load + "values = [1, 2]"), "table: give either table, or times and values"));
}

TEST_CASE("a rigid rod that is warm at t = 0 already is named with what warms it and the cure") {
  const std::string warm = "kind = 'temperature'\nrods = ['O-A']\nexpansion = 2e-5\n";
  const std::string why =
      "warms the rigid rod 'O-A' at t = 0 already, where its nodes stand as they are given: give times and "
      "values "
      "that begin with 0, or let the rod give (elastic = true)";
  CHECK(refused(force(warm + "change = 60"), "s.toml:19:10: forces[0].change: " + why));
  CHECK(refused(force(warm + "change = 60\ntimes = [0, 1]\nvalues = [0.5, 1]"), "forces[0].values: " + why));
  CHECK(error_of(force(warm + "change = 60\ntimes = [0, 1]\nvalues = [0, 1]")).empty());
  // Of a rod that shrinks by all of its length, or more, nothing is left.
  const std::string gone = "shrinks 'O-A' to nothing: expansion times the change must stay above -1";
  CHECK(refused(force(warm + "change = -6e4\ntimes = [0, 1]\nvalues = [0, 1]"), "forces[0].values: " + gone));
  CHECK(refused(force(warm + "change = 6e4\ntimes = [0, 1, 2]\nvalues = [0, -0.84, 1]"),
                "forces[0].values: " + gone));
  CHECK(refused(force(warm + "change = -5e4"), "forces[0].change: " + gone));
  // Between points a spline turns: that through 0, 1, 1, 0 is 1.25 times as high in the middle as its points.
  const std::string hump = "times = [0, 1, 2, 3]\nvalues = [0, 1, 1, 0]";
  CHECK(refused(force(warm + "change = -4.01e4\n" + hump), "forces[0].values: " + gone));
  CHECK(error_of(force(warm + "change = -3.99e4\n" + hump)).empty());
  CHECK(error_of(force(warm + "change = -4.9e4\ntimes = [0, 1]\nvalues = [0, 1]")).empty());
  // What has nothing to do with it is told as before.
  const std::string apart =
      arms + entry("constraints", "kind = 'plane'\nnodes = ['A']\nnormal = [0, 0, 1]\noffset = 3");
  CHECK(error_of(apart + entry("forces", warm + "change = 60\nenabled = false")).find("warms") ==
        std::string::npos);
}

}  // namespace refusals_test
