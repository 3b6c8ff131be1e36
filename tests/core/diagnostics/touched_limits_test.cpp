// SPDX-License-Identifier: BSD-3-Clause
// What acts to one side only where a pose is at the end of that side.
#include "core/diagnostics/touched_limits.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/simulate/initial_state.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace touched_limits_test {

namespace {

// A mass that hangs on a rod, with what an entry has it meet at the side, 1 m away.
std::vector<std::string> touched(const std::string& entry) {
  const auto model = testing::model_of(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [0, 0, -1], mass = 1},
         {name = "D", position = [1, 0, -1], fixed = true}]
rods = [{nodes = ["A", "B"], mass = 0}]
)" + entry);
  return touched_limits(*model, initial_state(model->structure, model->system).state);
}

const std::string spring = "[[forces]]\nname = 'it'\nnodes = ['D', 'B']\n",
                  stop = "[[constraints]]\nname = 'it'\nnodes = ['B']\n";

}  // namespace

TEST_CASE("cables and springs that only pull are told where they are just taut, as they are by default") {
  const std::vector<std::string> it = {"it"}, none;
  for (const auto& [entry, length] :
       {std::pair{spring + "kind = 'spring'\nstiffness = 5\ntension_only = true\n", "free_length"},
        {spring + "kind = 'cable'\naxial_stiffness = 5\n", "length"}}) {
    CAPTURE(entry);
    CHECK(touched(entry) == it);
    CHECK(touched(entry + length + " = 1\n") == it);
    CHECK(touched(entry + length + " = 0.999\n") == none);
    CHECK(touched(entry + length + " = 1.001\n") == none);
  }
  // 1 N on 1e12 N/m stretches it by 1e-12 m, which is no rounding.
  CHECK(touched(spring + "kind = 'cable'\naxial_stiffness = 1e12\nlength = 0.999999999999\n") == none);
  CHECK(touched(spring + "kind = 'spring'\nstiffness = 5\n") == none);  // it pushes, too
  CHECK(touched(spring + "kind = 'cable'\naxial_stiffness = 5\nsmoothing = 0.01\n") == none);
}

TEST_CASE("stops and cables that do not stretch are told where they are touched and do not hold") {
  const std::vector<std::string> it = {"it"}, none;
  const std::string along = stop + "kind = 'coordinate_stop'\ndirection = [1, 0, 0]\n";
  CHECK(touched(along + "max = 0\n") == it);
  CHECK(touched(along + "min = 0\nmax = 0.1\n") == it);
  CHECK(touched(along + "min = -0.1\nmax = 0.1\n") == none);
  CHECK(touched("[[constraints]]\nname = 'it'\nkind = 'cable'\nnodes = ['D', 'B']\n") == it);
  CHECK(touched(stop + "kind = 'coordinate'\ndirection = [1, 0, 0]\n") == none);  // held, both ways
}

// The load presses the mass against the stop: it holds from the start of a run on, and is no side.
TEST_CASE("a stop that holds is none of those that are touched") {
  const Simulation run = testing::run_scene(R"([structure]
kind = "custom"
nodes = [{name = "B", position = [0, 0, 0], mass = 1}]
[[constraints]]
kind = "coordinate_stop"
nodes = ["B"]
direction = [1, 0, 0]
max = 0
[[loads]]
nodes = ["B"]
force = [5, 0, 0]
[solver]
end_time = 0.02
)");
  const Trajectory& t = run.trajectory;
  CHECK(touched_limits(t.model(t.size() - 1), t.state(t.size() - 1)).empty());
}

}  // namespace touched_limits_test
