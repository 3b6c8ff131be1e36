// SPDX-License-Identifier: BSD-3-Clause
// Several states at once say what each says alone, to the bit: in every family, at weak modes, near singular
// poses, with rods that give and with angles that count turns.
#include <catch2/catch.hpp>
#include <cstring>

#include "core/integrators/index1.hpp"
#include "core/scene/library.hpp"
#include "core/simulate/simulation.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace index1_lanes_test {
namespace {

bool same_bits(const VectorXd& a, const VectorXd& b) {
  return a.size() == b.size() &&
         (a.size() == 0 ||
          std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0);
}

}  // namespace

TEST_CASE("the index-1 equations of several states at once have the bits of one after the other") {
  const std::vector<std::pair<const char*, std::vector<std::string>>> runs{
      {"hoop6", {"solver.step=0.11"}},
      {"hoop6", {"structure.fold_angle=89.9999", "solver.step=0.07", "solver.end_time=4"}},
      {"hoop6_sector", {"solver.step=0.13"}},
      {"hoop6_motor", {"structure.units=3", "solver.step=0.3"}},
      {"hoop6", {"structure.rod_model=elastic", "structure.youngs_modulus=7e10", "solver.end_time=0.4"}},
      {"four_bar", {"solver.end_time=0.7"}},
      {"double_pendulum", {"solver.end_time=0.3"}},
      {"scissor_mast", {"solver.step=0.09"}},
      {"bricard", {"solver.step=0.05"}}};
  for (const auto& [name, changes] : runs) {
    const Scene scene = read_scene_file(find_scene(name), changes);
    const Simulation run = simulate(build_model(scene), scene.solver);
    const Trajectory& trajectory = run.trajectory;
    const System& system = trajectory.model().system;
    System followed = system;
    Index1 alone(followed, true);
    Index1Lanes lanes(system);
    std::size_t compared = 0, wrong = 0;
    for (std::size_t i = 0; i < trajectory.size();) {
      std::vector<const State*> states;  // 1, 2, 3 or 4 of them
      for (const std::size_t most = 1 + i % SaddleLanes::lanes; i < trajectory.size(); ++i) {
        if (states.size() == most || &trajectory.model(i) != &trajectory.model()) break;
        if (!trajectory.report(i).singular_event) states.push_back(&trajectory.state(i));
      }
      if (states.empty()) break;
      lanes.evaluate(states);
      for (std::size_t k = 0; k < states.size(); ++k, ++compared) {
        VectorXd acceleration(system.solved_coordinates()), lambda(system.constraints());
        followed.follow(*states[k]);
        const bool ok = alone.evaluate(*states[k], acceleration, lambda);
        if (lanes.ok(k) != ok) ++wrong;
        if (ok && (!same_bits(lanes.acceleration(k), acceleration) || !same_bits(lanes.lambda(k), lambda)))
          ++wrong;
      }
    }
    INFO(name);
    CHECK(compared > 5);
    CHECK(wrong == 0);
  }
}

}  // namespace index1_lanes_test
