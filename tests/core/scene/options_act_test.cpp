// SPDX-License-Identifier: BSD-3-Clause
// Options do what they say in a run, not only when they are read.
#include <catch2/catch.hpp>

#include "core/scene/elements.hpp"
#include "core/scene/scene_error.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using testing::error_of, testing::run_scene;

namespace options_act_test {

namespace {

// A double pendulum of rods in a slanting plane: two rows of its constraints are linear.
const std::string swing = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [1.1, 0, 0.3]},
  {name = "B", position = [1.9, 0, -0.4], mass = 0.4}]
rods = [
  {name = "upper", nodes = ["O", "A"], mass = 1.3},
  {name = "lower", nodes = ["A", "B"], mass = 0.7}]
constraints = [{kind = "plane", nodes = ["A", "B"], normal = [0, 1, 0]}]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.01
end_time = 0.5
stages = 4
)";

// What a parameter may be, for entries made of a kind's own table.
std::string some_value(const ParamSpec& spec) {
  switch (spec.kind) {
    case ParamKind::boolean:
      return "true";
    case ParamKind::integer:
    case ParamKind::real:
      return "0.7";
    case ParamKind::choice:
      return '"' + std::string(spec.choices.front()) + '"';
    case ParamKind::text:
      return "\"x\"";
    case ParamKind::vector:
      return spec.length == 3 ? "[0.3, 0.5, 0.2]" : "[0.3, 0.5, 0.2, 0.7, 0.1, 0.4]";
    case ParamKind::names:
      return "[\"A\"]";
  }
  return "";
}

std::string members_of(Members members) {
  switch (members) {
    case Members::none:
      return "";
    case Members::each_node:
      return "nodes = [\"B\"]\n";
    case Members::node_list:
    case Members::path:
    case Members::two_nodes:
      return "nodes = [\"A\", \"B\"]\n";
    case Members::three_nodes:
      return "nodes = [\"O\", \"A\", \"B\"]\n";
    case Members::rods:
      return "rods = [\"lower\"]\n";
    case Members::rod:
      return "rod = \"lower\"\n";
    case Members::terms:
      return "terms = [\"1 length A B\"]\n";
    case Members::angle:
    case Members::measure:
      return "nodes = [\"O\", \"A\", \"B\"]\n";
  }
  return "";
}

}  // namespace

TEST_CASE("eliminate_linear = false solves all coordinates, to the same motion") {
  const Simulation less = run_scene(swing, {"solver.eliminate_linear=true"}),
                   all = run_scene(swing, {"solver.eliminate_linear=false"});
  REQUIRE(less.status == RunStatus::completed);
  REQUIRE(all.status == RunStatus::completed);
  CHECK(all.trajectory.model().system.solved_coordinates() == 9);
  CHECK(less.trajectory.model().system.solved_coordinates() == 4);  // O fixed; A and B in their plane
  const std::size_t last = all.trajectory.size() - 1;
  CHECK((all.trajectory.node_positions(last) - less.trajectory.node_positions(last))
            .lpNorm<Eigen::Infinity>() <= 1e-10);
}

TEST_CASE("every kind of element refuses to be without what it requires, and names it") {
  const auto try_all = [](const char* table, const std::vector<ElementKind>& kinds) {
    int tried = 0;
    for (const ElementKind& kind : kinds)
      for (const ParamSpec& left_out : kind.params()) {
        if (!left_out.required) continue;
        std::string entry = "[[" + std::string(table) + "]]\nkind = \"" + std::string(kind.kind) + "\"\n" +
                            members_of(kind.members);
        for (const ParamSpec& spec : kind.params())
          if (spec.required && spec.name != left_out.name)
            entry += std::string(spec.name) + " = " + some_value(spec) + "\n";
        const std::string key(left_out.name);
        INFO(kind.kind << " without " << key);
        CHECK(error_of(swing + entry).find(key + ": is missing") != std::string::npos);
        // With it there is no such complaint.
        const std::string with = error_of(swing + entry + key + " = " + some_value(left_out) + "\n");
        CHECK(with.find(key + ": is missing") == std::string::npos);
        ++tried;
      }
    return tried;
  };
  CHECK(try_all("forces", scene_forces()) >= 4);
  CHECK(try_all("constraints", scene_constraints()) >= 6);
}

}  // namespace options_act_test
