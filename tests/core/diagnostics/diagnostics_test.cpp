// SPDX-License-Identifier: BSD-3-Clause
// What is left of the diagnostics of a run where nobody wants to wait for them.
#include "core/diagnostics/diagnostics.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/accuracy.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/singular_poses.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace diagnostics_test {

TEST_CASE("diagnostics that are cancelled keep what they have and leave the rest open") {
  const Simulation run = simulate(make_model(hoop_structure()), dvm_options(3, 0.01, 0.5));
  const Diagnostics whole = diagnose(run);
  CHECK(whole.left_open == 0);
  int states = 0;
  const Diagnostics part = diagnose(run, [&] { return ++states > 20; });
  REQUIRE(part.t == whole.t);
  CHECK(part.left_open == whole.t.size() - 20);
  REQUIRE(part.columns.size() == whole.columns.size());
  for (std::size_t c = 0; c < whole.columns.size(); ++c) {
    REQUIRE(part.columns[c].values.size() == whole.t.size());
    for (std::size_t i = 0; i < whole.t.size(); ++i) {
      if (i >= 20)
        CHECK(std::isnan(part.columns[c].values[i]));
      else
        CHECK(part.columns[c].values[i] == whole.columns[c].values[i]);
    }
  }
  CHECK(part.axial_force.topRows(20) == whole.axial_force.topRows(20));
  CHECK(part.axial_force.bottomRows(31).array().isNaN().all());
  const auto warnings = accuracy_warnings(run, part);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].find("judged up to t = 0.19 s only") != std::string::npos);
}

TEST_CASE("angles are in degrees as well, as scenes have them") {
  const Scene scene =
      read_scene_file(find_scene("hoop6_motor"), {"structure.fold_angle=71.3", "solver.end_time=0.3"});
  const Diagnostics d = diagnose(simulate(build_model(scene), scene.solver));
  const std::pair<const char*, const char*> pairs[] = {{"fold_angle_rad", "fold_angle_deg"},
                                                       {"fold_rate_rad_s", "fold_rate_deg_s"},
                                                       {"motor.angle_rad", "motor.angle_deg"}};
  for (const auto& [radians, degrees] : pairs) {
    CAPTURE(degrees);
    const Series &in_radians = d.at(radians), &in_degrees = d.at(degrees);
    CHECK(in_degrees.unit.starts_with("deg"));
    REQUIRE(in_degrees.values.size() == d.t.size());
    for (std::size_t i = 0; i < d.t.size(); ++i)  // two roundings
      CHECK(in_degrees.values[i] == Approx(in_radians.values[i] * 57.29577951308232).epsilon(1e-15));
  }
  CHECK(d.at("fold_angle_deg").values.front() == Approx(71.3).epsilon(1e-13));
  const auto names = diagnostic_names();
  CHECK(std::ranges::count(names, "fold_angle_deg") == 1);
}

TEST_CASE("a search for singular poses that is cancelled ends at once") {
  Simulation run = simulate(make_model(ladder_structure(1, 30.0)), dvm_options(6, 0.01, 1.0));
  int asked = 0;
  record_singular_poses(run, [&] { return ++asked > 10; });
  CHECK(run.events.empty());
  CHECK(asked <= 15);
  record_singular_poses(run);
  CHECK(run.events.size() >= 9);  // 30 rad/s for a second
}

}  // namespace diagnostics_test
