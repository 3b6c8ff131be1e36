// SPDX-License-Identifier: BSD-3-Clause
// A run that is judged while it goes on says what it says when it is judged at its end, to the bit.
#include <catch2/catch.hpp>
#include <cstring>
#include <string>
#include <vector>

#include "core/diagnostics/diagnosis_ahead.hpp"
#include "core/diagnostics/energy_flow.hpp"
#include "core/diagnostics/state_forces.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/singular_poses.hpp"

using namespace unfurl;

namespace diagnosis_ahead_test {

namespace {

// Its states come in pieces of this many; the last ones are left to diagnose().
Diagnostics judged_in_pieces(const Simulation& run, std::size_t piece) {
  const Trajectory& whole = run.trajectory;
  const auto shared = [](const Model& model) {
    return std::shared_ptr<const Model>(std::shared_ptr<const Model>(), &model);
  };
  Simulation seen{.trajectory = Trajectory(shared(whole.model()), whole.options()), .options = run.options};
  Trajectory& states = seen.trajectory;
  StateForces solver(states);
  RunEnergyFlow flow(states, true);
  std::vector<SolvedPoint> forces;
  DiagnosisAhead ahead(seen, {&forces, &flow.so_far()});
  while (states.size() < whole.size()) {
    for (std::size_t k = 0; k < piece && states.size() < whole.size(); ++k) {
      const std::size_t i = states.size();
      if (&whole.model(i) != &states.last_model()) states.change_model(shared(whole.model(i)));
      states.append(whole.state(i), whole.report(i));
    }
    for (std::size_t i = forces.size(); i < states.size(); ++i) {
      if (i > 0) flow.step_to(i, &solver);
      forces.push_back(solver.at(i));
    }
    ahead.judge();
  }
  return diagnose(run, {}, {&forces, &flow.so_far(), {}, &ahead});
}

void check_same_bits(const double* a, const double* b, std::size_t size) {
  CHECK(std::memcmp(a, b, size * sizeof(double)) == 0);
}

}  // namespace

// A ring that unfolds; one that swings 0.03 degrees past its flat pose, where forces of single states are
// those through states before and behind; a motor that brings it to rest there; a latch that locks it, with
// another model from then on; rods that stretch, of which nothing is judged ahead.
TEST_CASE("a run judged while it goes on is judged the same", "[diagnostics][ahead]") {
  const auto [name, changes, piece] = GENERATE(table<std::string, std::vector<std::string>, std::size_t>(
      {{"hoop6", {}, 28},
       {"hoop6",
        {"structure.fold_angle=57", "solver.at_deployed=pass", "solver.end_time=1.3", "solver.stages=6",
         "solver.step=0.0025"},
        1},
       {"hoop6_motor", {}, 5},
       {"hoop6", {"solver.at_deployed=latch", "solver.end_time=6"}, 28},
       {"hoop6", {"structure.youngs_modulus=7e10", "solver.end_time=0.5"}, 28}}));
  const Scene scene = read_scene_file(find_scene(name), changes);
  Simulation run = simulate(build_model(scene), scene.solver);
  record_singular_poses(run);
  const Diagnostics at_end = diagnose(run), ahead = judged_in_pieces(run, piece);
  REQUIRE(ahead.t.size() == run.trajectory.size());
  check_same_bits(at_end.t.data(), ahead.t.data(), at_end.t.size());
  REQUIRE(ahead.columns.size() == at_end.columns.size());
  for (std::size_t c = 0; c < at_end.columns.size(); ++c) {
    CAPTURE(at_end.columns[c].name);
    REQUIRE(ahead.columns[c].values.size() == at_end.t.size());
    check_same_bits(at_end.columns[c].values.data(), ahead.columns[c].values.data(), at_end.t.size());
  }
  REQUIRE(ahead.axial_force.rows() == at_end.axial_force.rows());
  REQUIRE(ahead.axial_force.cols() == at_end.axial_force.cols());
  check_same_bits(at_end.axial_force.data(), ahead.axial_force.data(),
                  static_cast<std::size_t>(at_end.axial_force.size()));
  CHECK((ahead.force_unique == at_end.force_unique).all());
  CHECK(ahead.rod_unique == at_end.rod_unique);
}

}  // namespace diagnosis_ahead_test
