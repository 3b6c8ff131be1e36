// SPDX-License-Identifier: BSD-3-Clause
// What names and patterns of entries mean, and what the scene's own nodes are.
#include <catch2/catch.hpp>
#include <string>

#include "tests/support/scene_run.hpp"

namespace element_names_test {

namespace {

using unfurl::testing::error_of;

bool refused(const std::string& text, const std::string& why, const std::vector<std::string>& changes = {}) {
  const std::string error = error_of(text, changes);
  if (error.find(why) != std::string::npos) return true;
  UNSCOPED_INFO("said: " << error << "\nnot: " << why);
  return false;
}

}  // namespace

TEST_CASE("a pattern that matches nodes within cut rods only is refused, not passed by") {
  const std::string beam = R"(
structure.kind = "custom"
structure.youngs_modulus = 7e10
structure.rod_model = "elastic"
structure.nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "C", position = [1, 0, 0], mass = 1}]
structure.rods = [{nodes = ["A", "C"], name = "AB", mass = 1, area = 1e-4, second_moment = 1e-9, segments = 3}]
)";
  const std::string why =
      "'A*1' matches nodes within cut rods only: give their names with the point, as ROD.1";
  for (const char* table :
       {"[[loads]]\n", "[[forces]]\nkind = 'load_over_time'\ntimes = [0, 1]\nvalues = [0, 1]\n",
        "[[forces]]\nkind = 'drag'\ndamping = 1\n"})
    for (const char* nodes : {"nodes = ['A*1']\n", "nodes = ['C', 'A*1']\n"}) {
      CAPTURE(table, nodes);
      const bool drag = std::string(table).find("drag") != std::string::npos;
      CHECK(refused(beam + table + nodes + (drag ? "" : "force = [0, 0, 1]\n"), why));
      CHECK(error_of(beam + table + "nodes = ['C', 'A*.1']\n" + (drag ? "" : "force = [0, 0, 1]\n")).empty());
    }
}

// 500 km from the origin, where a motor's rotor stands: what nine digits of a length of 1.4 m are.
TEST_CASE("a limit beyond the start is refused wherever the structure and a rotor stand") {
  const std::string far = R"(
structure.kind = "custom"
structure.nodes = [{name = "A", position = [500000, 0, 0], fixed = true}, {name = "B", position = [500001, 0, 0]},
  {name = "C", position = [500001, 0, 1]}]
structure.rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 1}]
[[forces]]
kind = "motor"
nodes = ["A", "B", "C"]
axis = [0, 1, 0]
stall_torque = 1
no_load_speed = 100
inertia = 0.01
[[constraints]]
kind = "length_stop"
name = "s"
nodes = ["A", "C"]
min = )";
  CHECK(refused(far + "1.4145", "is passed already at t = 0"));
  CHECK(error_of(far + "1.4142").empty());
}

}  // namespace element_names_test
