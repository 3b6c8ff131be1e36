// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/bricard.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "core/diagnostics/force_uniqueness.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/export/summary.hpp"
#include "core/system/mobility.hpp"
#include "tests/support/bricard_exact.hpp"
#include "tests/support/deployment_check.hpp"
#include "tests/support/family_structure.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

TEST_CASE("a Bricard loop moves although its 30 lengths leave no freedom by count") {
  for (const auto& [twist, opening] :
       {std::pair{120.0, 5.0}, {120.0, 30.0}, {120.0, 170.0}, {90.0, 80.0}, {100.0, 120.0}, {140.0, 110.0}}) {
    const Structure s = family_structure(
        "bricard", {{"twist_angle", twist}, {"opening_angle", opening}, {"deployed_angle", 0.5}});
    INFO(twist << ", " << opening);
    const System system(s, true);
    const Mobility m = analyse_mobility(system, node_positions(s));
    CHECK(m.coordinates == 36);
    CHECK(m.constraints == 30);
    CHECK(m.rank == 29);  // six rigid-body freedoms and one of its own
    CHECK(m.redundant.size() == 1);
    CHECK(m.count == 6);  // Maxwell sees a rigid body that floats
    CHECK(m.rigid_motions == 6);
    CHECK(m.degrees_of_freedom == 7);
  }
}

TEST_CASE("a Bricard loop opens as its energy quadrature says") {
  for (const auto& [twist, opening] : {std::pair{120.0, 30.0}, {90.0, 80.0}, {105.0, 70.0}, {135.0, 100.0}}) {
    const Changes changes = {{"twist_angle", twist}, {"opening_angle", opening}, {"deployed_angle", 4.0}};
    const ParamSet p = family_params("bricard", changes);
    const exact::Bricard loop{p.real("bar_length"),
                              p.real("pin_length"),
                              p.real("density") * p.real("section_area"),
                              twist,
                              opening,
                              p.real("radial_force")};
    const Structure s = family_structure("bricard", changes);
    const Simulation run = simulate(make_model(s), dvm_options(5, 0.005, 20));
    INFO(twist << ", " << opening << ": " << run.message);
    REQUIRE(run.status == RunStatus::deployed);
    const Diagnostics d = diagnose(run);
    // Round-off of coordinates up to ten times a pin's length.
    CHECK(largest(d.at("constraint_relative_max")) <= 1e-13);
    const double end = d.t.back();
    for (std::size_t i = 10; i < d.t.size(); i += d.t.size() / 7) {
      // The angle of a state from r_2, its time from the quadrature. r_2 to 1e-14 gives the angle to 1e-12 or
      // better where the bars at the odd hinges are not nearly in line; order 8 at these steps lies below.
      const VectorXd q = run.trajectory.positions(i);
      const double sine = 0.5 * std::sqrt(3.0) / loop.L * q.segment<2>(6).norm();
      const double x = std::asin(sine) - loop.half1(0);
      CHECK(std::abs(loop.motion().time(x) - d.t[i]) <= 1e-8 * end);
      CHECK(d.at("fold_angle_rad").values[i] == Approx(loop.fold(x)).epsilon(0).margin(1e-9));
    }
  }
}

TEST_CASE("a Bricard loop that cannot be closed is refused by the parameter at fault") {
  CHECK(refusal("bricard", {{"twist_angle", 90.0}, {"opening_angle", 50.0}}) ==
        "opening_angle: with twist_angle = 90 degrees the loop closes for an opening_angle above 60 degrees");
  CHECK(refusal("bricard", {{"opening_angle", 179.0}, {"deployed_angle", 20.0}})
            .starts_with("deployed_angle: "));
}

// The braces that hold a bar's pins apart are no rods of the loop: rod_forces.csv does not have them.
TEST_CASE("the peak force of a Bricard loop is that of a rod that is shown") {
  const Structure s = family_structure("bricard", {{"deployed_angle", 60.0}});
  const Simulation run = simulate(make_model(s), dvm_options(3, 0.02, 2));
  const Diagnostics d = diagnose(run);
  double high = -1e300, low = 1e300, hidden = 0;
  for (Index i = 0; i < d.axial_force.rows(); ++i) {
    double most = -1e300, least = 1e300;
    for (const RodCopy& copy : s.rod_copies) {
      most = std::max(most, d.axial_force(i, copy.source));
      least = std::min(least, d.axial_force(i, copy.source));
    }
    const auto at = static_cast<std::size_t>(i);
    CHECK(d.at("axial_force_max_N").values[at] == most);
    CHECK(d.at("axial_force_min_N").values[at] == least);
    high = std::max(high, most), low = std::min(low, least);
    hidden = std::max(hidden, d.axial_force.row(i).lpNorm<Eigen::Infinity>());
  }
  const double peak = std::max(high, -low);
  REQUIRE(hidden > 1.01 * peak);  // a brace bears more
  const PeakForce found = peak_rod_force(d);
  CHECK(std::abs(found.force_N) == peak);
  CHECK(s.rods[static_cast<std::size_t>(found.rod)].group != "brace");
  // Between the states it may be a little more: steps of 0.02 s of a motion of seconds.
  CHECK(find_measure("peak_rod_force").value(run, d) == Approx(peak).epsilon(0.01));
  const auto forces = nlohmann::json::parse(summary_json(
      "test", run, d,
      analyse_mobility(run.trajectory.model().system, run.trajectory.node_positions(0))))["forces"];
  CHECK(forces["peak_rod_force_N"] == find_measure("peak_rod_force").value(run, d));
  CHECK(forces.contains("peak_rod"));
  CHECK(forces.contains("peak_t_s"));
}
