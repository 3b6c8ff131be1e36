// SPDX-License-Identifier: BSD-3-Clause
// What a command line sets of the method where the motion is solved along a path, which has none.
#include <catch2/catch.hpp>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/tolerance.hpp"

using namespace unfurl;

namespace idle_on_path_test {

namespace {

Simulation run_of(const std::string& scene, const std::vector<std::string>& changes) {
  std::vector<std::string> overrides{"solver.end_time=0.1"};
  for (const std::string& change : changes) overrides.push_back("solver." + change);
  const Scene read = read_scene_file(find_scene(scene), overrides);
  return simulate_as_asked(build_model(read), read.solver);
}

std::size_t idle_in(const Simulation& run, const std::string& key) {
  std::size_t count = 0;
  for (const std::string& warning : run.warnings)
    count += warning.find("solver." + key + ": does nothing") != std::string::npos ? 1 : 0;
  return count;
}

}  // namespace

// Said if and only if it is so: the same motion to the bit without it. four_bar has a path, double_pendulum
// moves in two ways and has none.
TEST_CASE("what does nothing on the path is told where the path was taken, and only there") {
  for (const std::string model : {"model=path", "model=auto"}) {
    const Simulation plain = run_of("four_bar", {model});
    REQUIRE(plain.solved_as.name == "path");
    for (const std::string setting : {"method=rk4", "method=generalized_alpha", "stages=2", "nodes=chebyshev",
                                      "constraints_at=ends", "adaptive=true"}) {
      CAPTURE(model, setting);
      const Simulation run = run_of("four_bar", {model, setting});
      CHECK(idle_in(run, setting.substr(0, setting.find('='))) == 1);
      REQUIRE(run.trajectory.size() == plain.trajectory.size());
      const std::size_t last = plain.trajectory.size() - 1;
      CHECK(run.trajectory.node_positions(last) == plain.trajectory.node_positions(last));
    }
    const Simulation turn = run_of("four_bar", {model, "turn=0.2"});  // that says why without a path, too
    CHECK(idle_in(turn, "turn") == 1);
    CHECK(idle_in(run_of("four_bar", {model, "step=0.005"}), "step") == 0);
  }
  for (const std::string model : {"model=full", "model=auto"})
    for (const std::string setting : {"method=rk4", "stages=2", "adaptive=true"}) {
      CAPTURE(model, setting);
      CHECK(idle_in(run_of("double_pendulum", {model, setting}), setting.substr(0, setting.find('='))) == 0);
    }
}

}  // namespace idle_on_path_test
