// SPDX-License-Identifier: BSD-3-Clause
// Slow motions of rods that hardly bend: what bending gives in K must not drown what gravity gives.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/vibration.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/initial_state.hpp"

using namespace unfurl;

namespace stiff_beam_test {

// A uniform rod of 2 m on a pin at its end swings with w^2 = 3 g / 2 L in both planes; cut into 16 parts that
// are so stiff that it bends by 1e-15 of its length in that, K has terms of bending 1e12 times those of
// gravity, whose rounding alone would be 1e-4 of w^2.
TEST_CASE("a hanging rod of stiff parts swings as a compound pendulum to all digits") {
  const Scene scene = read_scene_text(R"([structure]
kind = 'custom'
youngs_modulus = 1e22
segments = 16
nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [0, 0, -2]}]
rods = [{nodes = ['A', 'B'], density = 2700, area = 1e-4}]
[gravity]
acceleration = [0, 0, -9.81]
)",
                                      "beam.toml");
  const auto model = build_model(scene);
  const Vibration v = vibration(*model, initial_state(model->structure, model->system).state);
  REQUIRE(v.mechanism_motions == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(v.modes[k].mechanism);
    CHECK(v.modes[k].growth == 0.0);
    CHECK(v.modes[k].frequency == Approx(std::sqrt(3 * 9.81 / (2 * 2.0)) / (2 * pi)).epsilon(1e-9));
  }
}

}  // namespace stiff_beam_test
