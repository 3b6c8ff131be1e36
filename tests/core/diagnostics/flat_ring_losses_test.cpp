// SPDX-License-Identifier: BSD-3-Clause
// What dampers take of a full ring that ends flat: all of its constraints are next to singular there.
#include <catch2/catch.hpp>
#include <string>

#include "core/diagnostics/diagnostics.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace flat_ring_losses_test {

namespace {

// Opened by forces at its hinges, or by springs on its fold angles.
std::string ring(int units, bool sprung) {
  std::string text = R"([structure]
kind = "hoop"
units = )" + std::to_string(units) +
                     R"(
chord_rod_length = 1.5
post_length = 0.8
density = 1600
section_area = 2e-4
fold_angle = 75
)";
  text += sprung ? "hinge_force = 0\n" : "hinge_force = 12\n";
  text += R"([[forces]]
kind = "joint_damping"
nodes = ["Mb*", "Mt*"]
damping = 0.4
)";
  if (sprung)
    text += R"([[forces]]
kind = "torsion_spring"
fold_angle = true
stiffness = 60
free_angle = -10
)";
  return text + "[solver]\nmodel = \"full\"\nstages = 4\nstep = 0.01\n";
}

}  // namespace

// No drive and no load that is not a potential's: what is missing of the energies, which are of single
// states, has been taken by the dampers.
TEST_CASE("what dampers took of a ring that ends flat is what its energies miss") {
  struct Case {
    int units;
    bool sprung;
  };
  for (const auto& [units, sprung] : {Case{14, false}, Case{18, true}, Case{19, false}, Case{30, false}}) {
    INFO(units << " units, " << (sprung ? "a spring" : "forces"));
    const Simulation run = testing::run_scene(ring(units, sprung));
    REQUIRE(run.status == RunStatus::deployed);
    const Diagnostics d = diagnose(run);
    const auto change = [&](const char* column) {
      return d.at(column).values.back() - d.at(column).values.front();
    };
    const double lost = change("work_J") - change("kinetic_energy_J") - change("potential_energy_J");
    CHECK(lost > 10);
    // Steps of 0.01 s leave up to some 3e-5 of it at the end, where the accelerations grow fast.
    CHECK(change("dissipated_J") == Approx(lost).epsilon(1e-4));
  }
}

}  // namespace flat_ring_losses_test
