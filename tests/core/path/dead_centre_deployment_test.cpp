// SPDX-License-Identifier: BSD-3-Clause
// A deployed pose that the measure touches and does not cross: the dead centre of a crank and slider.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/path/path_run.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "tests/support/gauss_panel.hpp"
#include "tests/support/number.hpp"

using namespace unfurl;
using testing::number;

namespace dead_centre_deployment_test {

// Crank r with 1 kg at its pin, slider of 0.5 kg on a massless rod l, nothing acts: with s(th) the slider's
// place T = (r^2 + s'^2 / 2) th'^2 / 2 stays, so that the time to an angle is the integral of sqrt of that
// bracket over what it was at the start, where th' = w. Rounding puts the least of what remains on either
// side of zero.
TEST_CASE("a deployed pose at a dead centre is reached when it is touched") {
  const double w = -4, first = 0.9;
  for (int k = 0; k < 20; ++k)
    for (const bool out : {true, false}) {
      const double r = 0.4 + 0.03 * k, l = r + 0.55 + 0.071 * k, end = out ? l + r : l - r;
      CAPTURE(r, l, out);
      const auto s = [&](double th) {
        return r * std::cos(th) + std::sqrt(l * l - r * r * std::sin(th) * std::sin(th));
      };
      const auto slope = [&](double th) {
        return -r * std::sin(th) *
               (1 + r * std::cos(th) / std::sqrt(l * l - r * r * std::sin(th) * std::sin(th)));
      };
      const auto inertia = [&](double th) { return r * r + 0.5 * slope(th) * slope(th); };
      const double last = out ? 0 : -std::acos(-1.0);
      double expected = 0;
      for (int panel = 0; panel < 16; ++panel) {
        const double a = first + (last - first) * panel / 16, b = first + (last - first) * (panel + 1) / 16;
        expected +=
            exact::gauss_panel([&](double th) { return std::sqrt(inertia(th) / inertia(first)) / w; }, a, b);
      }
      const Scene scene = read_scene_text(
          "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name = "
          "'A', mass "
          "= 1, position = [" +
              number(r * std::cos(first)) + ", 0, " + number(r * std::sin(first)) + "], velocity = [" +
              number(-r * w * std::sin(first)) + ", 0, " + number(r * w * std::cos(first)) +
              "]}, {name = 'S', mass = 0.5, position = [" + number(s(first)) + ", 0, 0], velocity = [" +
              number(slope(first) * w) +
              ", 0, 0]}]\nrods = [{nodes = ['O', 'A'], mass = 0}, {nodes = ['A', 'S'], mass = "
              "0}]\n[[constraints]]\n"
              "kind = 'line'\nnodes = ['S']\ndirection = [1, 0, 0]\n[[constraints]]\nkind = 'plane'\nnodes = "
              "['A']\nnormal = [0, 1, 0]\n[deployment]\nmeasure = '1 coordinate S along 1 0 0'\ndeployed = " +
              number(end) + "\n[solver]\nstages = 6\nstep = 0.004\nend_time = 3\nat_deployed = 'stop'\n",
          "crank.toml");
      for (const bool on_path : {true, false}) {
        CAPTURE(on_path);
        const auto model = build_model(scene);
        const Simulation run =
            on_path ? simulate_on_path(model, scene.solver) : simulate(model, scene.solver);
        CHECK(run.status == RunStatus::deployed);
        // The rate's zero is known to some 1e-14 of the speed: 1e-12 s, and steps of 6 stages are as good.
        CHECK(run.trajectory.end_time() == Approx(expected).epsilon(0).margin(1e-11));
      }
    }
}

}  // namespace dead_centre_deployment_test
