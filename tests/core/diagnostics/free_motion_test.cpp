// SPDX-License-Identifier: BSD-3-Clause
// Motions that nothing pulls at, beside what is stiff.
#include <catch2/catch.hpp>

#include "core/diagnostics/vibration.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/number.hpp"

using namespace unfurl;
using testing::number;

namespace free_motion_test {

namespace {

// A rigid triangle on a pin, with a spring in one of its corners, whose angle never changes.
Vibration of_triangle(double stiffness, double gravity) {
  const Scene scene = read_scene_text("gravity = {acceleration = [0, 0, " + number(-gravity) +
                                          "]}\n[structure]\nkind = 'custom'\nnodes = [{name = 'O', position "
                                          "= [0, 0, 0], fixed = true}, {name = "
                                          "'A', position = [0.7, 0, 0.3]}, {name = 'B', position = [0.1, 0, "
                                          "0.9]}]\nrods = [{nodes = ['O', 'A'], "
                                          "mass = 1}, {nodes = ['O', 'B'], mass = 1}, {nodes = ['A', 'B'], "
                                          "mass = 1}]\n[[constraints]]\nkind = "
                                          "'plane'\nnodes = ['*']\nnormal = [0, 1, 0]\n[[forces]]\nkind = "
                                          "'torsion_spring'\nnodes = ['O', 'A', "
                                          "'B']\nstiffness = " +
                                          number(stiffness) + "\n",
                                      "triangle.toml");
  const auto model = build_model(scene);
  return vibration(*model, initial_state(model->structure, model->system).state);
}

}  // namespace

TEST_CASE("a motion is free however stiff a spring is that it does not change") {
  for (const double stiffness : {1.0, 1e3, 1e6, 1e9, 1e12}) {
    CAPTURE(stiffness);
    const Vibration v = of_triangle(stiffness, 0);
    REQUIRE(v.modes.size() == 1);
    CHECK((v.modes[0].mechanism && v.modes[0].growth == 0 && v.modes[0].frequency == 0));
  }
}

// It stands on its pin and falls at a rate of its weight's: 1e6 N m/rad, of which rounding leaves 1e-10, are
// beside some 10 N m/rad.
TEST_CASE("a slow motion is told beside a spring that it does not change") {
  const Vibration bare = of_triangle(0, 9.81), sprung = of_triangle(1e6, 9.81);
  REQUIRE(bare.modes.size() == 1);
  REQUIRE(sprung.modes.size() == 1);
  CHECK(bare.modes[0].growth > 1);
  CHECK(sprung.modes[0].growth == Approx(bare.modes[0].growth).epsilon(1e-9));
}

}  // namespace free_motion_test
