// SPDX-License-Identifier: BSD-3-Clause
// Every scene that comes with the program, found by listing the folder: it loads, moves, keeps its
// constraints and accounts for its energy.
#include <algorithm>
#include <catch2/catch.hpp>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/system/mobility.hpp"
#include "tests/support/deployment_check.hpp"
#include "tests/support/family_structure.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace every_scene_test {

namespace {

// A longer run is cut: what goes wrong in a scene does so within this many steps, and the suite stays fast.
constexpr double most_steps = 1500;

// The energy that may go astray, relative to the largest of kinetic energy, potential energy and work: what
// the order of the scene's method leaves at its step, near the end of a deployment, where hinges move
// fastest.
double energy_tolerance(const Scene& scene) {
  if (scene.name == "chain") return 1e-5;                  // the tip whips: a wave that 1 ms hardly resolves
  if (scene.solver.constraints_at == "ends") return 1e-2;  // order 2
  return scene.solver.stages <= 3 ? 2e-4 : 1e-6;           // order 4; 6 and more
}

// Scenes that end before their mean fold angle is that of the deployed pose.
bool ends_early(const std::string& scene) {
  return scene == "hoop_arc";  // stops when the first of its uneven units is straight
}

Simulation run(const Scene& scene) {
  SolverOptions options = scene.solver;
  options.end_time = std::min(options.end_time, most_steps * options.step);
  return simulate(build_model(scene), options);
}

}  // namespace

TEST_CASE("every scene loads, runs, holds its constraints and closes its energy balance") {
  const auto scenes = library_scenes();
  REQUIRE(scenes.size() >= 6);
  for (const LibraryScene& entry : scenes) {
    INFO(entry.name);
    const Scene scene = read_scene_file(entry.path, {});
    CHECK_FALSE(scene.title.empty());
    CHECK(scene.title != entry.name);
    const Simulation result = run(scene);
    INFO(result.message);
    CHECK(result.status != RunStatus::failed);
    CHECK(result.warnings.empty());
    const Diagnostics d = diagnose(result);
    // Round-off of coordinates of some 10 rod lengths is 1e-15 of a rod's length; a hundredfold for long
    // chains of them.
    CHECK(largest(d.at("constraint_relative_max")) <= 1e-13);
    const double energy = std::max(
        {largest(d.at("kinetic_energy_J")), largest(d.at("potential_energy_J")), largest(d.at("work_J"))});
    CHECK(energy > 0);
    CHECK(largest(d.at("energy_balance_J")) <= energy_tolerance(scene) * energy);
    // It moves: by more than a tenth of its longest rod.
    const auto& rods = result.trajectory.structure().rods;
    const double longest = std::max_element(rods.begin(), rods.end(), [](const Rod& a, const Rod& b) {
                             return a.length < b.length;
                           })->length;
    const VectorXd first = result.trajectory.positions(0);
    double moved = 0;
    for (std::size_t i = 0; i < result.trajectory.size(); ++i)
      moved = std::max(moved, (result.trajectory.positions(i) - first).lpNorm<Eigen::Infinity>());
    CHECK(moved > 0.1 * longest);
  }
}

TEST_CASE("every scene that can deploy does, where its time suffices") {
  for (const LibraryScene& entry : library_scenes()) {
    const Scene scene = read_scene_file(entry.path, {});
    const auto model = build_model(scene);
    if (!model->system.drives().empty()) continue;  // goes where its motor takes it
    if (model->structure.deployment.empty() || scene.solver.at_deployed != "stop" || ends_early(entry.name) ||
        scene.solver.end_time > most_steps * scene.solver.step)
      continue;
    INFO(entry.name);
    const Simulation result = run(scene);
    REQUIRE(result.status == RunStatus::deployed);
    CHECK(diagnose(result).at("deployed_fraction").values.back() == Approx(1.0).epsilon(1e-9));
  }
}

TEST_CASE("every scene's mobility is counted, and its redundant members are named") {
  for (const LibraryScene& entry : library_scenes()) {
    INFO(entry.name);
    const auto model = build_model(read_scene_file(entry.path, {}));
    const Mobility m = analyse_mobility(model->system, node_positions(model->structure));
    CHECK(m.degrees_of_freedom + static_cast<Index>(model->system.drives().size()) >= 1);
    CHECK(m.degrees_of_freedom >= m.rigid_motions);
    CHECK(m.degrees_of_freedom - static_cast<Index>(m.redundant.size()) == m.count);
    for (const std::string& name : m.redundant) CHECK_FALSE(name.empty());
  }
}

}  // namespace every_scene_test
