// SPDX-License-Identifier: BSD-3-Clause
// Stops beside the deployed pose, by nanometres and less.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/study/table.hpp"
#include "core/study/tolerance.hpp"

using namespace unfurl;

namespace stop_beside_deployed_test {

namespace {

const std::string sliding = R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [1.5, 0, 0], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["P"]
direction = [1, 0, 0]
[[constraints]]
kind = "coordinate_stop"
name = "wall"
nodes = ["P"]
direction = [1, 0, 0]
min = 0.7
[[forces]]
kind = "spring"
nodes = ["O", "P"]
stiffness = 1
free_length = 1
[deployment]
measure = "1 coordinate P along 1 0 0"
[solver]
stages = 7
step = 0.5
end_time = 4
)";

}  // namespace

// On a spring x = 1 + cos(t) / 2, until it meets 0.7 at t = acos(-0.6) and is thrown back, or is stopped and
// pushed off again. Lengths of a metre and two count as the same up to 1e-11 of them.
TEST_CASE("of a stop and the deployed pose a nanometre apart the nearer one is met first") {
  const double met = std::acos(-0.6);
  for (const std::string model : {"path", "full"})
    for (const std::string at : {"pass", "stop"})
      for (const double rebound : {0.0, 0.5})
        for (const double behind : {1e-7, 1e-9, 1e-10, -1e-10, -1e-9, -1e-7}) {  // the stop: where it lies
          INFO(model << " " << at << " " << rebound << " " << behind);
          const Scene scene = read_scene_text(sliding, "s.toml",
                                              {"solver.model=" + model, "solver.at_deployed=" + at,
                                               "constraints[1].restitution=" + exact_number(rebound),
                                               "deployment.deployed=" + exact_number(0.7 + behind)});
          const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
          REQUIRE(run.status != RunStatus::failed);
          std::vector<std::string> kinds;
          for (const Event& event : run.events)
            if (std::abs(event.t - met) < 1e-6) kinds.push_back(event.kind);
          if (behind < 0)
            CHECK(kinds == std::vector<std::string>{"contact"});
          else if (at == "stop")
            CHECK(kinds == std::vector<std::string>{"deployed"});
          else
            CHECK(kinds == std::vector<std::string>{"deployed", "contact"});
        }
}

}  // namespace stop_beside_deployed_test
