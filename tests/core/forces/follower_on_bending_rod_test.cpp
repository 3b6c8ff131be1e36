// SPDX-License-Identifier: BSD-3-Clause
// A load along the tangent of a rod that bends: Beck's column, which does not buckle and flutters at
// 20.0509536 E I / L^2 (M. Beck, Z. angew. Math. Phys. 3 (1952) 225; the digits of Bolotin and others since).
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/diagnostics/vibration.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace follower_on_bending_rod_test {

namespace {

constexpr double modulus = 7e10, second_moment = 1e-9, length = 1.3;

// A column of so many parts in the plane, clamped at A, with such a load at B towards A.
Vibration column(int parts, double load) {
  const std::string text =
      "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\n"
      "nodes = [{name = 'C', position = [-0.5, 0, 0], fixed = true}, {name = 'A', position = [0, 0, 0], "
      "fixed = true}, {name = 'B', position = [1.3, 0, 0]}]\n"
      "rods = [{nodes = ['C', 'A'], mass = 0, area = 1e-4}, {nodes = ['A', 'B'], density = 2700, area = "
      "1e-4, "
      "second_moment = 1e-9, segments = " +
      std::to_string(parts) +
      "}]\n"
      "[[constraints]]\nkind = 'angle'\nnodes = ['C', 'A', 'B']\naxis = [0, 0, 1]\n"
      "[[constraints]]\nkind = 'plane'\nnodes = ['*']\nnormal = [0, 0, 1]\n"
      "[[forces]]\nkind = 'follower'\nrod = 'A-B'\nforce = " +
      testing::number(-load) + "\n";
  const auto model = build_model(read_scene_text(text, "beck.toml"));
  return vibration(*model, initial_state(model->structure, model->system).state);
}

// The least load at which a mode grows, by halving, in E I / L^2.
double flutter(int parts) {
  constexpr double unit = modulus * second_moment / (length * length);
  double low = 10, high = 40;
  for (int k = 0; k < 30; ++k) {
    const double middle = 0.5 * (low + high);
    bool grows = false;
    for (const VibrationMode& mode : column(parts, middle * unit).modes)
      grows = grows || mode.growth > 1e-3 * mode.frequency;
    (grows ? high : low) = middle;
  }
  return low;
}

}  // namespace

// Of second order in the length of a part, as the bends are: four times less with twice the parts, 3.3 times
// here, where the next order is still seen.
TEST_CASE("a follower is tangent to a rod that bends and makes it flutter at the load of Beck") {
  constexpr double exact = 20.0509536;
  const double coarse = flutter(24) - exact, fine = flutter(48) - exact;
  CHECK(std::abs(fine) <= 0.002 * exact);
  CHECK(std::abs(coarse / fine) == Approx(4).epsilon(0.2));
  // It grows by flutter, never without a swing: pi^2 E I / L^2 is where a load towards A would buckle it.
  constexpr double unit = modulus * second_moment / (length * length);
  for (const VibrationMode& mode : column(24, 15 * unit).modes) CHECK(mode.growth <= 1e-3 * mode.frequency);
}

TEST_CASE("the tangent at a bending rod's end is that of its last two parts") {
  const auto model = testing::model_of(
      "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\nnodes = [{name = 'A', position = [0, 0, 0], "
      "fixed = true}, "
      "{name = 'B', position = [2, 0, 0]}]\nrods = [{nodes = ['A', 'B'], density = 2700, area = 1e-4, "
      "second_moment = "
      "1e-9, segments = 5}]\n[[forces]]\nkind = 'follower'\nrod = 'A-B'\nforce = 3\n");
  for (const Force& force : model->structure.forces) {
    if (force.kind != "follower") continue;
    REQUIRE(force.nodes.size() == 3);
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = std::array{1.6, 2.0, 1.2}[k];  // ends of the last part, and of that before it
      CHECK(model->structure.nodes[static_cast<std::size_t>(force.nodes[k])].position.x() == Approx(x));
    }
  }
}

}  // namespace follower_on_bending_rod_test
