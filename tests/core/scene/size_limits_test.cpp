// SPDX-License-Identifier: BSD-3-Clause
// What cannot be built or kept is refused before it is tried.
#include "core/scene/size_limits.hpp"

#include <catch2/catch.hpp>
#include <ctime>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/structure/structure_error.hpp"
#include "core/structures/family.hpp"

namespace unfurl::size_limits_test {

namespace {

Scene scene_of(const std::string& text) {
  return read_scene_text("[structure]\n" + text, "test", {}, "");
}

std::string refusal(const std::string& text) {
  try {
    build_model(scene_of(text));
  } catch (const SceneError& error) {
    return error.problems().front().key + ": " + error.problems().front().message;
  }
  return "built";
}

}  // namespace

TEST_CASE("products of parameters have a limit, and the refusal takes no time") {
  const std::clock_t start = std::clock();
  CHECK(refusal("kind = \"reentrant_sheet\"\nrows = 10000\ncolumns = 9000") ==
        "structure.rows: rows x columns = 90000000 is more than 100000, the most that is built");
  CHECK(refusal("kind = \"reentrant_sheet\"\nrows = 317\ncolumns = 316").starts_with("structure.rows: "));
  CHECK(refusal("kind = \"scissor_mast\"\ncells = 100000\nsides = 26") ==
        "structure.cells: cells x sides = 2600000 is more than 100000, the most that is built");
  CHECK(static_cast<double>(std::clock() - start) < 1.0 * CLOCKS_PER_SEC);
}

TEST_CASE("no family can be made larger by its whole numbers together than by one of them") {
  for (const Family& family : families()) {
    Scene scene = scene_of("kind = \"" + std::string(family.kind) + "\"");
    long numbers = 0;
    for (const ParamSpec& spec : family.params()) {
      if (!counts(spec)) continue;
      ++numbers;
      REQUIRE(spec.max <= static_cast<double>(most_units));
      scene.structure.set(spec.name, static_cast<long>(spec.max));
    }
    INFO(family.kind);
    if (numbers > 1)
      CHECK_THROWS_AS(require_buildable(scene), StructureError);
    else
      CHECK_NOTHROW(require_buildable(scene));
  }
}

TEST_CASE("lists have a limit too") {
  Scene scene = scene_of("kind = \"pendulum\"");
  scene.kind = "custom";
  scene.custom.nodes.resize(most_custom_nodes + 1);
  CHECK_THROWS_WITH(require_buildable(scene),
                    "their number of 400001 is more than 400000, the most that is built");
  scene.custom.nodes.resize(2);
  scene.custom.rods.resize(most_custom_rods + 1);
  CHECK_THROWS_AS(require_buildable(scene), StructureError);
}

TEST_CASE("steps that no memory holds are refused, unless the motion may end earlier") {
  const Scene scene = scene_of("kind = \"pendulum\"\n[solver]\nstep = 1e-3\nend_time = 3");
  const auto model = build_model(scene);
  // A state is at least its time, coordinates, rates and multipliers.
  const double numbers = 1.0 + 2.0 * static_cast<double>(model->system.solved_coordinates()) +
                         static_cast<double>(model->system.constraints());
  CHECK(bytes_of_states(scene, *model) >= 3000 * 8 * numbers);
  CHECK(bytes_of_states(scene, *model) <= 3000 * (8 * numbers + 400));
  CHECK(too_many_states(scene, *model, 1e9).empty());
  CHECK(too_many_states(scene, *model, 1e5).starts_with("3e+03 steps to solver.end_time are "));
  Scene adaptive = scene;
  adaptive.solver.adaptive = true;
  CHECK(too_many_states(adaptive, *model, 1e5).empty());
  const Scene ring = scene_of("kind = \"hoop\"\n[solver]\nstep = 1e-3\nend_time = 3");
  CHECK(too_many_states(ring, *build_model(ring), 1e5).empty());  // it ends when it is deployed
  CHECK(refusal("kind = \"pendulum\"\n[solver]\nstep = 1e-15\nend_time = 10").starts_with("solver.step: "));
}

}  // namespace unfurl::size_limits_test
