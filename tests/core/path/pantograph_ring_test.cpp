// SPDX-License-Identifier: BSD-3-Clause
// A custom ring of scissor pairs whose first piece of path leads on into a pose that nothing can be tabulated
// to: full model and path, which share no equation of motion.
#include <catch2/catch.hpp>

#include "core/path/path_run.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "tests/support/runs_apart.hpp"

using namespace unfurl;

namespace pantograph_ring_test {

namespace {

const std::string ring = R"toml(
[variables]
n = 5
th0 = 12
h = "=sin((90-th0)*deg)"
r = "=sin(th0*deg)/(2*sin(pi/n))"
[structure]
kind = "custom"
[[structure.nodes]]
repeat = {i = "0:n"}
name = "B{i}"
position = ["=r*cos(2*pi*i/n)", "=r*sin(2*pi*i/n)", 0]
mass = 0.2
[[structure.nodes]]
repeat = {i = "0:n"}
name = "T{i}"
position = ["=r*cos(2*pi*i/n)", "=r*sin(2*pi*i/n)", "=h"]
mass = 0.3
[[structure.rods]]
repeat = {i = "0:n"}
nodes = ["B{i}", "T{(i+1)%n}"]
mass = 0.5
[[structure.rods]]
repeat = {i = "0:n"}
nodes = ["T{i}", "B{(i+1)%n}"]
mass = 0.5
[[constraints]]
kind = "plane"
repeat = {i = "0:n"}
nodes = ["B{i}", "T{i}"]
normal = ["=-sin(2*pi*i/n)", "=cos(2*pi*i/n)", 0]
[[constraints]]
kind = "plane"
nodes = ["B*"]
normal = [0,0,1]
[[forces]]
kind = "torsion_spring"
name = "spring{i}"
repeat = {i = "0:n"}
nodes = ["T{(i+1)%n}", "B{i}", "T{(i+n-1)%n}"]
stiffness = 3
damping = 0.05
free_angle = 110
[gravity]
acceleration = [0, 0, -1]
[solver]
step = 0.005
end_time = 0.4
)toml";

// The middles of two crossing rods meet, in one coordinate.
std::string pivots(const std::string& coefficients) {
  return R"toml([[constraints]]
kind = "relation"
repeat = {i = "0:n-1"}
nodes = ["B{i}", "T{(i+1)%n}", "T{i}", "B{(i+1)%n}"]
coefficients = [)toml" +
         coefficients + "]\n";
}

}  // namespace

TEST_CASE("a path whose first piece leads into a pose without a table is taken as far as it is known") {
  const std::string text = ring + pivots("1,0,0, 1,0,0, -1,0,0, -1,0,0") +
                           pivots("0,1,0, 0,1,0, 0,-1,0, 0,-1,0") + pivots("0,0,1, 0,0,1, 0,0,-1, 0,0,-1");
  for (const char* fold : {"5", "8", "12", "16"}) {
    CAPTURE(fold);
    const Scene scene = read_scene_text(text, "ring.toml", {std::string("variables.th0=") + fold});
    const auto model = build_model(scene);
    SolverOptions fine = scene.solver;
    fine.stages = 7;
    const Simulation path = simulate_on_path(model, scene.solver), full = simulate(model, fine);
    REQUIRE(path.status == full.status);
    CHECK(testing::runs_apart(path, full) <= 1e-10);  // both are good to round-off
  }
}

}  // namespace pantograph_ring_test
