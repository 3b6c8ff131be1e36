// SPDX-License-Identifier: BSD-3-Clause
// Peaks in a singular pose in which the forces are smooth: what is between states has errors that such a pose
// makes large.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/measures.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"

using namespace unfurl;

namespace flat_peaks_test {

// A scissor that is driven through flat at 0.607 s, where its tension is largest. Truth: the top of the
// parabola through three states 4 steps apart, of which the middle one alone is near the pose, 5e-6 of the
// tension in doubt; what the parabola leaves out is below that in 3 ms. Peaks had been 4e-4 above it.
TEST_CASE("a peak in a flat pose whose forces are smooth is that of the states around it") {
  for (const double step : {0.0007, 0.0008, 0.0009, 0.0011}) {
    INFO("step " << step);
    const Scene scene = read_scene_file(
        find_scene("scissor_mast"), {"structure.cells=1", "structure.tip_force=-20", "solver.end_time=0.8",
                                     "solver.stages=4", "solver.step=" + std::to_string(step)});
    const Simulation run = simulate(build_model(scene), scene.solver);
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    const std::vector<double>& x = d.at("axial_force_max_N").values;
    const auto top = static_cast<std::size_t>(std::max_element(x.begin(), x.end()) - x.begin());
    REQUIRE((top >= 4 && top + 4 < x.size()));
    const double left = x[top] - x[top - 4], right = x[top + 4] - x[top], bend = right - left;
    const double truth = x[top] - std::pow(0.5 * (left + right), 2) / (2 * bend);
    CHECK(find_measure("peak_rod_force").value(run, d) == Approx(truth).epsilon(2e-5));
    const PeakForce peak = peak_rod_force(run, d);
    CHECK(peak.force_N == Approx(truth).epsilon(2e-5));
    CHECK(std::abs(peak.t - d.t[top]) <= 2 * step);
  }
}

}  // namespace flat_peaks_test
