// SPDX-License-Identifier: BSD-3-Clause
// Whole rings of many units on the path: up to the flat pose, where they lose rank.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/path/path_run.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "tests/support/gauss_panel.hpp"

using namespace unfurl;

namespace ring_path_test {

// Posts stand at the corners of a polygon of n sides 2 L cos(th), on a circle of R = L cos(th) / sin(pi / n).
// Four chords L of each unit go from there to the middle of the side, which is L sin(th) off along the axis:
// uniform rods whose ends move by dR / dth, and by its share cos(pi / n) and L cos(th). A spring k on the
// fold angle th, free at -10 deg, opens the ring from rest at 75 deg: with th + 10 deg = 85 deg cos(p) its
// energy has fallen by k / 2 (85 deg sin(p))^2, and the time to the flat pose is the integral of sqrt(I / k)
// over p.
double deployed_after(int n) {
  const double pi = std::acos(-1.0), degree = pi / 180, L = 1.5, k = 60;
  const double chord = 1600 * 2e-4 * L, post = 1600 * 2e-4 * 0.8;
  const auto inertia = [&](double th) {
    const double out = L * std::sin(th) / std::sin(pi / n), c = std::cos(pi / n), up = L * std::cos(th);
    const double squares = out * out + 2 * (out * c) * (out * c) + up * up;
    return n * (4 * chord / 3 * squares + post * out * out);
  };
  const double last = std::acos(10.0 / 85);
  double sum = 0;
  for (int panel = 0; panel < 16; ++panel)
    sum +=
        exact::gauss_panel([&](double p) { return std::sqrt(inertia((85 * std::cos(p) - 10) * degree) / k); },
                           last * panel / 16, last * (panel + 1) / 16);
  return sum;
}

TEST_CASE("whole rings of more than a dozen units follow their path to the flat pose") {
  for (const int units : {12, 15, 18, 20, 24}) {
    CAPTURE(units);
    const Scene scene = read_scene_text(
        "[structure]\nkind = 'hoop'\nmodel = 'full'\nunits = " + std::to_string(units) +
            "\nchord_rod_length = 1.5\npost_length = 0.8\ndensity = 1600\nsection_area = 2e-4\n"
            "fold_angle = 75\nhinge_force = 0\n[[forces]]\nkind = 'torsion_spring'\nfold_angle = true\n"
            "stiffness = 60\nfree_angle = -10\n[solver]\nend_time = 30\n",
        "ring.toml");
    const Simulation run = simulate_on_path(build_model(scene), scene.solver);
    CHECK(run.status == RunStatus::deployed);
    // Times are as good as the energy's and the inertia's rounding, whatever of its pose a ring does not
    // know.
    CHECK(run.trajectory.end_time() == Approx(deployed_after(units)).epsilon(1e-12));
  }
}

}  // namespace ring_path_test
