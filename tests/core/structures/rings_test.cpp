// SPDX-License-Identifier: BSD-3-Clause
// Rings that open from a bundle: pantograph and Hoberman.
#include <catch2/catch.hpp>

#include "core/system/mobility.hpp"
#include "tests/support/deployment_check.hpp"
#include "tests/support/family_structure.hpp"
#include "tests/support/hoberman_exact.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scissor_exact.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace rings_test {

namespace {

double mass_of(const ParamSet& p, const char* length) {
  return p.real("density") * p.real("section_area") * p.real(length);
}

// The deployment of `structure` beside its exact solution up to x = `deployed`.
void check_motion(const Structure& structure, const exact::OneFreedom& exact, double deployed) {
  const double end = exact.time(deployed);
  const Simulation run = simulate(make_model(structure), dvm_options(5, end / 400, 2 * end));
  INFO(run.message);
  REQUIRE(run.status == RunStatus::deployed);
  const Diagnostics d = diagnose(run);
  // Order 8 with 400 steps, and positions of a few metres that an extrapolated event knows to 1e-14 or so;
  // the margin is for the rings that start near closing, where the first steps turn fast.
  CHECK(std::abs(run.events.at(0).t - end) <= 1e-9 * end);
  CHECK(fold_error(exact, d, 20) <= 1e-9);
  CHECK(largest(d.at("constraint_relative_max")) <= 1e-13);
  CHECK(largest(d.at("energy_balance_J")) <= 1e-8 * d.at("work_J").values.back());
}

}  // namespace

TEST_CASE("a pantograph ring opens as its energy quadrature says") {
  for (const long n : {3L, 4L, 7L, 12L}) {
    const Changes changes = {
        {"units", n}, {"rod_length", 0.9}, {"fold_angle", 80.0}, {"deployed_angle", 15.0}};
    const ParamSet p = family_params("scissor_ring", changes);
    const exact::ScissorRing ring{static_cast<int>(n),   0.9, mass_of(p, "rod_length"), 80, 15,
                                  p.real("radial_force")};
    INFO(n << " units");
    check_motion(family_structure("scissor_ring", changes), ring.motion(), ring.deployed());
  }
}

// All rods of such a ring act on its radius and height: with 100 units some linear constraints stay
// equations.
TEST_CASE(
    "a pantograph ring of 100 units opens as its energy quadrature says, solved in sparse coordinates") {
  const Changes changes = {{"units", 100L}};
  const ParamSet p = family_params("scissor_ring", changes);
  const exact::ScissorRing ring{100, 1.0, mass_of(p, "rod_length"), 85, 20, p.real("radial_force")};
  const Structure structure = family_structure("scissor_ring", changes);
  const auto model = make_model(structure);
  CHECK(model->system.solved_coordinates() > 101);  // with every linear constraint eliminated
  CHECK(model->system.solved_coordinates() < 500);  // with none
  const double end = ring.motion().time(ring.deployed());
  const Simulation run = simulate(model, dvm_options(4, end / 200, 2 * end));
  INFO(run.message);
  REQUIRE(run.status == RunStatus::deployed);
  // Order 6 with 200 steps, and relative positions 100 times weaker determined than those of a small ring.
  CHECK(std::abs(run.events.at(0).t - end) <= 1e-8 * end);
  CHECK(largest(diagnose(run).at("constraint_relative_max")) <= 1e-12);
}

TEST_CASE("a Hoberman ring opens as its energy quadrature says") {
  for (const auto& [n, fold] : {std::pair{3L, 29.0}, {4L, 40.0}, {7L, 60.0}, {16L, 78.0}}) {
    const Changes changes = {
        {"units", n}, {"bar_length", 0.4}, {"fold_angle", fold}, {"deployed_angle", 6.0}};
    const ParamSet p = family_params("hoberman", changes);
    const exact::Hoberman ring{static_cast<int>(n),   0.4, mass_of(p, "bar_length"), fold, 6,
                               p.real("radial_force")};
    INFO(n << " units");
    check_motion(family_structure("hoberman", changes), ring.motion(), ring.deployed());
  }
}

TEST_CASE("pantograph and Hoberman rings have one degree of freedom on their whole way") {
  for (const long n : {3L, 4L, 5L, 6L, 8L, 11L})
    for (const auto& [kind, angle] : {std::pair{"scissor_ring", 85.0},
                                      {"scissor_ring", 30.0},
                                      {"scissor_ring", 5.0},
                                      {"hoberman", 29.0},
                                      {"hoberman", 5.0}}) {
      const Structure s =
          family_structure(kind, {{"units", n}, {"fold_angle", angle}, {"deployed_angle", 2.0}});
      INFO(kind << " of " << n << " at " << angle);
      const Mobility m = analyse_mobility(System(s, true), node_positions(s));
      CHECK(m.degrees_of_freedom == 1);
      CHECK(m.constraints - m.rank == static_cast<Index>(m.redundant.size()));
    }
}

TEST_CASE("a Hoberman ring folded beyond its centre is refused") {
  CHECK(refusal("hoberman", {{"units", 12L}, {"fold_angle", 75.0}}) ==
        "fold_angle: with 12 units the inner nodes meet at the centre at a fold angle of 75 degrees: "
        "fold_angle must be "
        "smaller");
  CHECK(refusal("scissor_ring", {{"fold_angle", 10.0}})
            .starts_with("deployed_angle: deployed_angle must be smaller"));
}

}  // namespace rings_test
