// SPDX-License-Identifier: BSD-3-Clause
// A deployed pose that the measure touches and does not cross: the dead centre of a crank and slider.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/path/path_run.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "tests/support/gauss_panel.hpp"
#include "tests/support/number.hpp"

using namespace unfurl;
using testing::number;

namespace dead_centre_deployment_test {

namespace {

// Crank r with 1 kg at its pin, slider of 0.5 kg on a massless rod l, nothing acts: with s(th) the slider's
// place T = (r^2 + s'^2 / 2) th'^2 / 2 stays, so that the time to an angle is the integral of sqrt of that
// bracket over what it was at the start, where th' = w. Rounding puts the least of what remains on either
// side of zero.
struct Crank {
  static constexpr double w = -4, first = 0.9;
  double r, l, far;  // far: of its bearing from the origin
  bool out;          // deployed at its outer dead centre

  double s(double th) const {
    return r * std::cos(th) + std::sqrt(l * l - r * r * std::sin(th) * std::sin(th));
  }
  double slope(double th) const {
    return -r * std::sin(th) *
           (1 + r * std::cos(th) / std::sqrt(l * l - r * r * std::sin(th) * std::sin(th)));
  }
  double inertia(double th) const { return r * r + 0.5 * slope(th) * slope(th); }
  double time() const {
    const double last = out ? 0 : -std::acos(-1.0);
    double sum = 0;
    for (int panel = 0; panel < 16; ++panel) {
      const double a = first + (last - first) * panel / 16, b = first + (last - first) * (panel + 1) / 16;
      sum += exact::gauss_panel([&](double th) { return std::sqrt(inertia(th) / inertia(first)) / w; }, a, b);
    }
    return sum;
  }
  Scene scene() const {
    return read_scene_text(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [" + number(far) +
            ", 0, 0], fixed = true}, {name = 'A', mass = 1, position = [" +
            number(far + r * std::cos(first)) + ", 0, " + number(r * std::sin(first)) + "], velocity = [" +
            number(-r * w * std::sin(first)) + ", 0, " + number(r * w * std::cos(first)) +
            "]}, {name = 'S', mass = 0.5, position = [" + number(far + s(first)) + ", 0, 0], velocity = [" +
            number(slope(first) * w) + ", 0, 0]}]\nrods = [{nodes = ['O', 'A'], mass = 0, length = " +
            number(r) + "}, {nodes = ['A', 'S'], mass = 0, length = " + number(l) +
            "}]\n[[constraints]]\nkind = 'line'\nnodes = ['S']\ndirection = [1, 0, 0]\n[[constraints]]\n"
            "kind = 'plane'\nnodes = ['A']\nnormal = [0, 1, 0]\n[deployment]\nmeasure = 'length O S'\n"
            "deployed = " +
            number(out ? l + r : l - r) +
            "\n[solver]\nstages = 6\nstep = 0.004\nend_time = 3\nat_deployed = 'stop'\n",
        "crank.toml");
  }
};

void check_touched(const Crank& crank, bool on_path, double margin) {
  CAPTURE(crank.r, crank.l, crank.far, crank.out, on_path);
  const Scene scene = crank.scene();
  const auto model = build_model(scene);
  const Simulation run = on_path ? simulate_on_path(model, scene.solver) : simulate(model, scene.solver);
  CHECK(run.status == RunStatus::deployed);
  CHECK(run.trajectory.end_time() == Approx(crank.time()).epsilon(0).margin(margin));
}

}  // namespace

TEST_CASE("a deployed pose at a dead centre is reached when it is touched") {
  for (int k = 0; k < 20; ++k)
    for (const bool out : {true, false})
      for (const bool on_path : {true, false}) {
        const double r = 0.4 + 0.03 * k;
        // The rate's zero is known to some 1e-14 of the speed: 1e-12 s, and steps of 6 stages are as good.
        check_touched({r, r + 0.55 + 0.071 * k, 0.0, out}, on_path, 1e-11);
      }
}

// eps far is what rounding leaves of each coordinate and so, of this size and speed, of directions and times
// in each of some 200 steps. A table on the path has slopes of that with the square of its degree, 24, over a
// piece of a third of the size. As a crossing of what rounding leaves it would be told sqrt(eps far) early,
// or never: 2e-6 s at 1e4 m.
TEST_CASE("a deployed pose that is only touched is reached there as far from the origin as one likes") {
  const double eps = std::numeric_limits<double>::epsilon();
  for (const double far : {40.0, 1.1e3, 9.9e3, 1.2345e5, 1e6})
    for (int k = 0; k < 3; ++k)
      for (const bool out : {true, false})
        for (const bool on_path : {true, false}) {
          const double r = 0.3 + 0.07 * k;
          check_touched({r, r + 0.7 - 0.031 * k, far, out}, on_path,
                        1e-11 + (on_path ? 3 * 24 * 24 : 250) * eps * far);
        }
}

}  // namespace dead_centre_deployment_test
