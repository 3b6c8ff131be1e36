// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/scissor_mast.hpp"

#include <catch2/catch.hpp>

#include "core/system/mobility.hpp"
#include "tests/support/deployment_check.hpp"
#include "tests/support/family_structure.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scissor_exact.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace scissor_mast_test {

namespace {

exact::ScissorMast exact_mast(long cells, long sides, const ParamSet& p) {
  return {static_cast<int>(cells), static_cast<int>(sides),
          p.real("rod_length"),    p.real("density") * p.real("section_area") * p.real("rod_length"),
          p.real("fold_angle"),    p.real("deployed_angle"),
          p.real("tip_force"),     p.real("tip_mass")};
}

}  // namespace

TEST_CASE("a scissor mast deploys as its energy quadrature says, with any number of cells and sides") {
  for (const auto& [cells, sides] :
       {std::pair{1L, 1L}, {2L, 1L}, {5L, 1L}, {20L, 1L}, {1L, 3L}, {4L, 3L}, {5L, 4L}, {2L, 9L}}) {
    const Changes changes = {{"cells", cells},     {"sides", sides},         {"rod_length", 0.8},
                             {"fold_angle", 80.0}, {"deployed_angle", 25.0}, {"tip_force", 30.0},
                             {"tip_mass", 1.5}};
    const exact::ScissorMast mast = exact_mast(cells, sides, family_params("scissor_mast", changes));
    const double end = mast.motion().time(mast.deployed());
    const Simulation run =
        simulate(make_model(family_structure("scissor_mast", changes)), dvm_options(5, end / 200, 2 * end));
    INFO(cells << " cells, " << sides << " sides: " << run.message);
    REQUIRE(run.status == RunStatus::deployed);
    const Diagnostics d = diagnose(run);
    // Order 8 with 200 steps: truncation of 1e-14 or so; the event is extrapolated over nine states, which
    // amplifies the round-off of positions (some 10 m: 1e-15) and of the quadrature a hundredfold.
    CHECK(std::abs(run.events.at(0).t - end) <= 1e-10 * end);
    CHECK(fold_error(mast.motion(), d, 10) <= 1e-10);
    CHECK(d.at("deployed_fraction").values.back() == Approx(1.0).epsilon(1e-10));
    CHECK(largest(d.at("constraint_relative_max")) <= 1e-13);
    const double work = d.at("work_J").values.back();
    CHECK(largest(d.at("energy_balance_J")) <= 1e-9 * work);
  }
}

TEST_CASE("a scissor mast has one degree of freedom at every fold angle on its way") {
  for (const long sides : {1L, 3L, 4L, 6L, 7L})
    for (const double angle : {85.0, 45.0, 10.0}) {
      const Structure s = family_structure(
          "scissor_mast", {{"cells", 3L}, {"sides", sides}, {"fold_angle", angle}, {"deployed_angle", 5.0}});
      INFO(sides << " sides at " << angle);
      CHECK(analyse_mobility(System(s, true), node_positions(s)).degrees_of_freedom == 1);
    }
}

TEST_CASE("a scissor mast that cannot be is refused by the parameter at fault") {
  CHECK(refusal("scissor_mast", {{"sides", 2L}}) ==
        "sides: a mast has 1 side (planar) or 3 and more; two faces cannot enclose a mast");
  CHECK(refusal("scissor_mast", {{"fold_angle", 30.0}, {"deployed_angle", 30.0}}) ==
        "deployed_angle: deployed_angle must be smaller than fold_angle, at which the motion starts");
}

}  // namespace scissor_mast_test
