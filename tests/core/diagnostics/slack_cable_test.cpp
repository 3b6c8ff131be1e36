// SPDX-License-Identifier: BSD-3-Clause
// Chains that hang nearly straight: the weakest direction of their constraints is far below what the pivots
// of the equations show, as many small ones add up along the chain.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"

using namespace unfurl;

namespace slack_cable_test {

namespace {

constexpr double mass = 0.027, length = 0.1, gravity = 9.81;

// n links at rest under their weight: their slopes differ by u from one to the next.
std::string hanging(int n, double u) {
  std::string text = "[structure]\nkind = \"custom\"\n";
  double x = 0, z = 0;
  const auto node = [&](int i) {
    char line[200];
    std::snprintf(line, sizeof line, "[[structure.nodes]]\nname = \"P%d\"\nposition = [%.17g, 0, %.17g]\n%s",
                  i, x, z, i == 0 || i == n ? "fixed = true\n" : "");
    text += line;
  };
  node(0);
  for (int i = 0; i < n; ++i) {
    const double slope = (i - 0.5 * (n - 1)) * u, size = std::hypot(1, slope);
    x += length / size;
    z += length * slope / size;
    node(i + 1);
  }
  for (int i = 0; i < n; ++i)
    text += "[[structure.rods]]\nnodes = [\"P" + std::to_string(i) + "\", \"P" + std::to_string(i + 1) +
            "\"]\nmass = 0.027\n";
  for (int i = 0; i <= n; ++i)
    text +=
        "[[constraints]]\nkind = \"plane\"\nnodes = [\"P" + std::to_string(i) + "\"]\nnormal = [0, 1, 0]\n";
  return text + "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstep = 0.001\nend_time = 0.002\n";
}

}  // namespace

// Half the weight at each support, and the horizontal pull H = m g / u. Positions of 40 m in doubles make
// some 1e-14 / (l u) of a difference of slopes.
TEST_CASE("chains that hang nearly straight pull with what carries their weight") {
  for (const auto& [n, u] : {std::pair{20, 1e-2}, {20, 4e-4}, {20, 1e-4}, {400, 1e-3}, {400, 1e-4}}) {
    INFO(n << " links, " << u);
    const Scene scene = read_scene_text(hanging(n, u), "chain.toml");
    const Simulation run = simulate(build_model(scene), scene.solver);
    const Diagnostics figures = diagnose(run);
    const double pull = mass * gravity / u;
    for (Index rod = 0; rod < n; rod += 7)
      CHECK(figures.axial_force(0, rod) ==
            Approx(pull * std::hypot(1, (static_cast<double>(rod) - 0.5 * (n - 1)) * u)).epsilon(1e-8));
    CHECK(figures.at("P0.reaction_z_N").values[0] == Approx(0.5 * n * mass * gravity).epsilon(1e-5));
  }
}

}  // namespace slack_cable_test
