// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/reentrant_sheet.hpp"

#include <catch2/catch.hpp>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/system/mobility.hpp"
#include "tests/support/deployment_check.hpp"
#include "tests/support/family_structure.hpp"
#include "tests/support/models.hpp"
#include "tests/support/reentrant_exact.hpp"

using namespace unfurl;
using namespace unfurl::testing;

TEST_CASE("a re-entrant sheet widens as its energy quadrature says, with the Poisson's ratio of its cells") {
  for (const auto& [rows, columns] : {std::pair{1L, 1L}, {2L, 3L}, {3L, 2L}, {5L, 6L}}) {
    const Changes changes = {
        {"rows", rows}, {"columns", columns}, {"fold_angle", 65.0}, {"deployed_angle", 7.0}};
    const ParamSet p = family_params("reentrant_sheet", changes);
    const exact::ReentrantSheet sheet{static_cast<int>(rows),
                                      static_cast<int>(columns),
                                      p.real("chord_rod_length"),
                                      p.real("post_length"),
                                      p.real("density") * p.real("section_area"),
                                      65,
                                      7,
                                      p.real("stretch_force")};
    const double end = sheet.motion().time(sheet.deployed());
    const Simulation run = simulate(make_model(family_structure("reentrant_sheet", changes)),
                                    dvm_options(5, end / 200, 2 * end));
    INFO(rows << " x " << columns << ": " << run.message);
    REQUIRE(run.status == RunStatus::deployed);
    const Diagnostics d = diagnose(run);
    // Order 8 with 200 steps on a motion of a radian: below round-off of the extrapolated event, 1e-12 or so.
    CHECK(std::abs(run.events.at(0).t - end) <= 1e-10 * end);
    CHECK(fold_error(sheet.motion(), d, 10) <= 1e-10);
    CHECK(largest(d.at("constraint_relative_max")) <= 1e-13);
    const auto& ratio = d.at("poisson_ratio").values;
    for (std::size_t i = 0; i < ratio.size(); i += 20)  // at rest, too, where the motion only begins
      CHECK(ratio[i] == Approx(sheet.poisson(d.at("fold_angle_rad").values[i])).epsilon(1e-9));
    // Pressed together it is the same ratio, of rates of the other sign.
    const Changes pressing = {{"rows", rows},
                              {"columns", columns},
                              {"fold_angle", 65.0},
                              {"deployed_angle", 7.0},
                              {"stretch_force", -p.real("stretch_force")}};
    const Diagnostics back = diagnose(simulate(make_model(family_structure("reentrant_sheet", pressing)),
                                               dvm_options(5, end / 200, 0.2 * end)));
    const auto& pressed = back.at("poisson_ratio").values;
    for (std::size_t i = 0; i < pressed.size(); i += 10)
      CHECK(pressed[i] == Approx(sheet.poisson(back.at("fold_angle_rad").values[i])).epsilon(1e-9));
    CHECK(back.at("fold_angle_rad").values.back() > back.at("fold_angle_rad").values.front());
    CHECK(d.at("column_pitch_m").values.back() ==
          Approx(2 * p.real("chord_rod_length") * std::cos(7 * radians_per_degree)).epsilon(1e-10));
  }
}

// Its length, the cosine of the fold angle, is greatest where that is zero: the widths still change there.
TEST_CASE("a sheet that opens flat has no Poisson's ratio there") {
  const Structure flat = family_structure("reentrant_sheet", {{"deployed_angle", 0.0}});
  const Simulation run = simulate(make_model(flat), dvm_options(5, 0.005, 10));
  REQUIRE(run.status == RunStatus::deployed);
  const Diagnostics d = diagnose(run);
  const auto& ratio = d.at("poisson_ratio").values;
  CHECK(std::isnan(ratio.back()));
  CHECK(std::abs(ratio[ratio.size() - 2]) < 1e4);
  for (std::size_t i = 0; i + 1 < ratio.size(); ++i) CHECK_FALSE(std::isnan(ratio[i]));
}

// No force: its velocities and accelerations are rounding, as is their ratio.
TEST_CASE("a sheet that rests has no Poisson's ratio") {
  const auto ratios = [](const std::vector<std::string>& changes) {
    const Scene scene = read_scene_file(find_scene("reentrant_sheet"), changes);
    return diagnose(simulate(build_model(scene), scene.solver)).at("poisson_ratio").values;
  };
  for (const double ratio : ratios({"structure.stretch_force=0", "solver.end_time=0.1"}))
    CHECK(std::isnan(ratio));
  const auto latched =
      ratios({"solver.at_deployed=latch", "structure.deployed_angle=10", "solver.end_time=20"});
  CHECK_FALSE(std::isnan(latched.front()));
  CHECK(std::isnan(latched.back()));
}

TEST_CASE("a re-entrant sheet has one degree of freedom at every fold angle on its way") {
  for (const auto& [rows, columns] : {std::pair{1L, 1L}, {1L, 4L}, {4L, 1L}, {3L, 5L}})
    for (const double angle : {70.0, 40.0, 5.0}) {
      const Structure s = family_structure(
          "reentrant_sheet",
          {{"rows", rows}, {"columns", columns}, {"fold_angle", angle}, {"deployed_angle", 1.0}});
      INFO(rows << " x " << columns << " at " << angle);
      CHECK(analyse_mobility(System(s, true), node_positions(s)).degrees_of_freedom == 1);
    }
}

TEST_CASE("a re-entrant sheet whose chords would cross is refused") {
  CHECK(refusal("reentrant_sheet", {{"post_length", 0.8}}) ==
        "post_length: chords would cross inside the units: post_length must be more than 2 chord_rod_length "
        "sin(fold_angle) = 0.866025403784 m");  // sqrt(3) / 2
}

TEST_CASE("columns of a structure's own stand behind those that all have, and only where it has them") {
  const auto run = [](const Structure& s) {
    return diagnose(simulate(make_model(s), dvm_options(3, 0.01, 0.02)));
  };
  const Diagnostics sheet = run(family_structure("reentrant_sheet")), hoop = run(hoop_structure());
  CHECK(hoop.find("poisson_ratio") == nullptr);
  REQUIRE(sheet.columns.size() == hoop.columns.size() + 3);
  CHECK(sheet.columns[hoop.columns.size()].name == "column_pitch_m");
  for (const Series& column : sheet.columns) CHECK(column.values.size() == sheet.t.size());
}
