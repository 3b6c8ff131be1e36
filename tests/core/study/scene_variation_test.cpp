// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/scene_variation.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "core/diagnostics/measures.hpp"
#include "core/scene/reader.hpp"

using namespace unfurl;

namespace scene_variation_test {

namespace {

SceneSource source(std::vector<std::string> overrides = {}) {
  const std::string text = R"(
[structure]
kind = "hoop"
units = 7
post_length = 1.3
fold_angle = 80
[solver]
step = 0.02
)";
  return {"ring.toml", std::move(overrides), std::make_shared<const std::string>(text), ""};
}

}  // namespace

TEST_CASE("a scene is read again with changes behind those of the command line") {
  const SceneSource plain = source(), changed = source({"structure.units=9", "solver.step=0.5"});
  CHECK(scene_number(plain.read(), "structure.units") == 7.0);
  CHECK(scene_number(changed.read(), "structure.units") == 9.0);
  CHECK(scene_number(changed.read({"structure.units=11"}), "structure.units") == 11.0);
  CHECK(changed.read({"structure.units=11"}).solver.step == 0.5);
  CHECK(changed.overrides.size() == 2);
  CHECK_THROWS_WITH(plain.read({"structure.unit=11"}), Catch::Contains("did you mean 'units'"));
}

TEST_CASE("what stands where a number is looked for is told and nothing of what is one or is not there") {
  const SceneSource text{
      "s.toml",
      {},
      std::make_shared<const std::string>("variables.n = 3\n[structure]\nkind = 'hoop'\nunits = "
                                          "7\npost_length = 1.3\n[solver]\nmethod = 'rk4'\n"),
      ""};
  const Scene scene = text.read();
  for (const char* key : {"variables.n", "structure.units", "structure.post_length", "structure.fold_angle"})
    CHECK(other_than_number(scene, key) == "");
  for (const char* key : {"solver.method", "structure.kind"}) CHECK(other_than_number(scene, key) == "text");
}

TEST_CASE("a file that is edited while its study runs changes none of its points") {
  namespace fs = std::filesystem;
  const fs::path file =
      fs::temp_directory_path() / ("unfurl_scene_variation_" + std::to_string(::getpid()) + ".toml");
  const auto write = [&](const std::string& mass) {
    std::ofstream(file) << "[structure]\nkind = 'pendulum'\nbob_mass = " << mass << "\n";
  };
  write("2.0");
  const SceneSource source = scene_source(file.string(), {"structure.length=1.5"});
  write("20.0");
  CHECK(scene_number(source.read({"structure.angle=80"}), "structure.bob_mass") == 2.0);
  CHECK(scene_number(source.read(), "structure.length") == 1.5);
  fs::remove(file);
  CHECK(scene_number(source.read(), "structure.bob_mass") == 2.0);
  CHECK_THROWS_AS(scene_source(file.string(), {}), UnreadableScene);
}

TEST_CASE("a file that a scene names is that of the first point in all of them") {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("unfurl_scene_variation_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const auto write = [&](const char* name, const std::string& z) {
    std::ofstream(folder / name) << "name,x_m,y_m,z_m,fixed,mass_kg\nO,0,0,0,1,0\nA,1,0," << z << ",0,2\n";
  };
  write("n.csv", "-0.5");
  write("m.csv", "-0.75");
  std::ofstream(folder / "s.toml") << "structure.kind = 'custom'\nstructure.nodes_file = 'n.csv'\n"
                                      "structure.rods = [{nodes = ['O', 'A'], mass = 1}]\n";
  const SceneSource source = scene_source((folder / "s.toml").string(), {});
  const auto height = [](const Scene& scene) { return scene.custom.nodes.back().position.z(); };
  CHECK(height(source.read()) == -0.5);
  write("n.csv", "-9");
  CHECK(height(source.read({"solver.step=0.02"})) == -0.5);
  CHECK(height(SceneSource(source).read()) == -0.5);
  CHECK(height(source.read({"structure.nodes_file=m.csv"})) ==
        -0.75);  // another one is read when it is asked for
  write("m.csv", "-8");
  fs::remove(folder / "n.csv");
  CHECK(height(source.read({"structure.nodes_file=m.csv"})) == -0.75);
  CHECK(height(source.read()) == -0.5);
  CHECK_THROWS_WITH(source.read({"structure.nodes_file=k.csv"}), Catch::Contains("k.csv"));
  CHECK_THROWS(read_scene_file((folder / "s.toml").string()));  // what is read by itself is read
  write("n.csv", "-7");
  CHECK(height(read_scene_file((folder / "s.toml").string())) == -7);
  fs::remove_all(folder);
}

TEST_CASE("numbers of a scene are found where they stand or by default, and are whole or not") {
  const Scene scene = source().read();
  CHECK(scene_number(scene, "structure.post_length") == 1.3);
  CHECK(scene_number(scene, "structure.fold_angle") == 80.0);
  CHECK(scene_number(scene, "solver.step") == 0.02);
  CHECK(scene_number(scene, "solver.stages") == static_cast<double>(scene.solver.stages));  // a default
  for (const char* none :
       {"structure.kind", "structure", "structure.post", "solver.step.x", "", "x", "solver."})
    CHECK_FALSE(scene_number(scene, none));
  for (const char* whole : {"structure.units", "solver.stages"}) CHECK(is_whole_number(scene, whole));
  for (const char* other : {"structure.post_length", "structure.fold_angle", "structure.kind", "structure.x"})
    CHECK_FALSE(is_whole_number(scene, other));
}

TEST_CASE("variables are numbers of a scene, worked out") {
  const std::string text = R"(
[variables]
n = 3
L = "=n/8"
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = ["=L", 0, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 1}]
)";
  const SceneSource variable{"v.toml", {}, std::make_shared<const std::string>(text), ""};
  CHECK(scene_number(variable.read(), "variables.L") == 0.375);
  CHECK(scene_number(variable.read({"variables.n=4"}), "variables.L") == 0.5);
  CHECK(scene_number(variable.read({"variables.L=0.7"}), "variables.L") == 0.7);
  CHECK_FALSE(scene_number(variable.read(), "variables.x"));
  CHECK_FALSE(scene_number(variable.read(), "variables"));
}

TEST_CASE("numbers of forces, constraints and nodes are found by index and by name") {
  const std::string text = R"(
structure = {kind = "custom", nodes = [{name = "A", position = [0, 0, 0], fixed = true},
             {name = "B", position = [1.5, 0, 0], mass = 2.5}], rods = [{nodes = ["A", "B"], mass = 1}]}
forces = [{kind = "spring", nodes = ["A", "B"], stiffness = 40},
          {kind = "drag", name = "air", nodes = ["B"], damping = 0.25}]
)";
  const Scene scene = SceneSource{"two.toml", {}, std::make_shared<const std::string>(text), ""}.read();
  CHECK(scene_number(scene, "forces[0].stiffness") == 40.0);
  for (const char* key : {"forces[1].damping", "forces[air].damping", "forces.air.damping"})
    CHECK(scene_number(scene, key) == 0.25);
  CHECK(scene_number(scene, "structure.nodes.B.mass") == 2.5);
  CHECK(scene_number(scene, "structure.nodes[1].position[0]") == 1.5);
  for (const char* none : {"forces[0]", "forces[2].stiffness", "forces[7].stiffness", "forces[fog].damping",
                           "forces.stiffness", "forces[0", "structure.nodes[1].position[3]"})
    CHECK_FALSE(scene_number(scene, none));
  CHECK_FALSE(is_whole_number(scene, "forces[0].stiffness"));
  // A vector that is left out is zero, and of real numbers.
  CHECK(scene_number(scene, "structure.nodes.B.velocity[1]") == 0.0);
  CHECK_FALSE(is_whole_number(scene, "structure.nodes.B.velocity[1]"));
}

TEST_CASE("many runs go by the model that costs least, unless the method itself is what is asked about") {
  const Scene scene = source().read();
  const auto model = [&](std::vector<std::string> varied, const char* measure) {
    return study_solver(scene, varied, {find_measure("end_time"), find_measure(measure)}).model;
  };
  CHECK(model({"structure.units"}, "deploy_time") == "auto");
  CHECK(model({"solver.end_time", "structure.units"}, "deploy_time") == "auto");
  CHECK(model({"solver.at_deployed"}, "deploy_time") == "auto");
  CHECK(model({"structure.units", "solver.stages"}, "deploy_time") == "full");
  CHECK(model({"solver.step"}, "deploy_time") == "full");
  CHECK(model({"structure.units"}, "newton_iterations") == "full");
  for (const char* given : {"path", "sector", "full"}) {
    const Scene asked = source({std::string("solver.model=") + given}).read();
    CHECK(study_solver(asked, {"solver.step"}, {}).model == given);
    CHECK(study_solver(asked, {"structure.units"}, {}).model == given);
  }
  const Scene automatic = source({"solver.model=auto"}).read();
  CHECK(study_solver(automatic, {"solver.step"}, {}).model == "full");
  CHECK(study_solver(automatic, {"structure.units"}, {}).model == "auto");
  CHECK(study_solver(scene, {}, {}).step == 0.02);
}

TEST_CASE("a model that is varied is that of its point whatever else is asked") {
  for (const char* given : {"auto", "path", "sector", "full"}) {
    const Scene point = source({std::string("solver.model=") + given}).read();
    CHECK(study_solver(point, {"solver.model"}, {find_measure("deploy_time")}).model == given);
    CHECK(study_solver(point, {"solver.step", "solver.model"}, {find_measure("newton_iterations")}).model ==
          given);
  }
}

TEST_CASE("a variable of which a key of the method is worked out is about the method") {
  const auto model = [](const std::string& solver, const std::string& key) {
    const std::string text = R"([variables]
h = 0.01
n = 6
[structure]
kind = "hoop"
units = "=n"
[solver]
)" + solver;
    const Scene scene = SceneSource{"x", {}, std::make_shared<const std::string>(text)}.read();
    return study_solver(scene, {key}, {find_measure("deploy_time")}).model;
  };
  CHECK(model("step = 0.01\nend_time = \"=100*h\"", "variables.h") == "auto");
  CHECK(model("step = 0.01", "variables.n") == "auto");
  CHECK(model("step = \"=h\"", "variables.h") == "full");
  CHECK(model("step = \"=h\"", "structure.fold_angle") == "auto");
  CHECK(model("method = \"rk{n - 2}\"", "variables.n") == "full");
}

}  // namespace scene_variation_test
