// SPDX-License-Identifier: BSD-3-Clause
// A long run, seen window by window, is trusted as far as one that is seen whole.
#include <catch2/catch.hpp>
#include <string>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/math/largest.hpp"
#include "core/scene/reader.hpp"
#include "tests/support/windows_of_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace long_run_books_test {

// A pendulum of 1 m and 1 kg that starts level under 10 m/s^2 passes below, with 10 J, between two states,
// which miss it by 4 in 10^4 or more: the energy turned over is that of states, the peak is not.
TEST_CASE("what a long run has turned over is told by its states") {
  constexpr double quarter = 1.8540746773013719 / 3.1622776601683795;  // K(1/sqrt 2) / sqrt 10
  for (const double states_before : {17.5, 18.5, 19.5, 20.5}) {
    INFO(states_before);
    const Scene scene = read_scene_text(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true},\n"
        "{name = 'P', position = [1, 0, 0], mass = 1}]\nrods = [{nodes = ['O', 'P'], mass = 0}]\n"
        "[gravity]\nacceleration = [0, 0, -10]\n[solver]\nstages = 5\nend_time = 1.6\nstep = " +
            std::to_string(quarter / states_before) + "\n",
        "s.toml", {});
    const auto model = build_model(scene);
    const Simulation run = simulate(model, scene.solver);
    const Diagnostics d = diagnose(run);
    REQUIRE(energy_turned_over(d) < 10 - 1e-3);
    Windows w = windows_of(scene, 20);
    REQUIRE(w.parts.size() == 2);
    const Digest whole = from_checkpoint_to_checkpoint(w, model, scene);
    CHECK(energy_turned_over(whole.diagnostics) == Approx(energy_turned_over(d)).epsilon(1e-12));
    CHECK(find_measure("peak_energy").value(whole.run, whole.diagnostics) == Approx(10).epsilon(1e-6));
  }
}

// A rigid winch that has wound its load up to the pulley, after 2.9 s, leads nowhere: its states are off by
// hundreds of J at once, of some 300 J that are turned over beside it, and between two of them, within 7.6 s,
// the motion reaches a thousand times that.
TEST_CASE("what a long run reaches within steps of a lost motion does not make it trusted") {
  const Scene scene = read_scene_text(R"([structure]
kind = 'custom'
nodes = [{name = 'O1', position = [3, 0, 2], fixed = true}, {name = 'B1', position = [3, 0, 0], mass = 1},
         {name = 'B2', position = [6, 0, 0], mass = 0.6327748257089789, velocity = [0, 0, 0.9375047936817321]},
         {name = 'O2', position = [6, 0, 2], fixed = true}]
[gravity]
acceleration = [0, 0, -9.81]
[[constraints]]
kind = 'line'
nodes = ['B1']
direction = [0, 0, 1]
[[constraints]]
kind = 'line'
nodes = ['B2']
direction = [0, 0, 1]
[[forces]]
kind = 'winch'
name = 'w'
nodes = ['B1', 'O1']
stall_torque = 3
no_load_speed = 600
drum_radius = 0.1
inertia = 0.01
axial_stiffness = 0
[[forces]]
kind = 'spring'
name = 's'
nodes = ['B2', 'O2']
stiffness = 26.22368300127267
damping = 0.0012013671768896896
free_length = 1.8
[solver]
step = 0.002
stages = 4
end_time = 7.9
)",
                                      "s.toml", {});
  const auto model = build_model(scene);
  Simulation run = simulate(model, scene.solver);
  const Diagnostics judged = judge(run);
  REQUIRE(run.status == RunStatus::failed);
  Windows w = windows_of(scene, 3906);
  REQUIRE(w.parts.size() == 1);
  const Digest whole = from_checkpoint_to_checkpoint(w, model, scene);
  CHECK(whole.run.status == RunStatus::failed);
  CHECK(whole.run.trajectory.end_time() == Approx(run.trajectory.end_time()).epsilon(0).margin(1e-9));
  CHECK(find_measure("peak_energy").value(whole.run, whole.diagnostics) ==
        Approx(find_measure("peak_energy").value(run, judged)));
}

// A rod is pulled by 20 N and let go, twice, each time at once: waves of 0.4 ms, which steps of 10 ms stop,
// take a tenth of the work of the load with them each time. Long behind that nothing is stored any more.
TEST_CASE("what steps of a long run have stopped is known as long as of a short one") {
  const Scene scene = read_scene_text(R"([structure]
kind = 'custom'
youngs_modulus = 1.5e11
rod_model = 'elastic'
nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [0, 0, -1], mass = 0.3}]
rods = [{nodes = ['A', 'B'], mass = 0, area = 4.64e-4}]
[[forces]]
kind = 'load_over_time'
nodes = ['B']
force = [0, 0, -20]
times = [0, 0.2, 0.2, 0.3, 0.3, 0.5, 0.5, 0.6]
values = [1, 1, 0, 0, 1, 1, 0, 0]
[solver]
stages = 4
step = 0.01
end_time = 2
)",
                                      "s.toml", {});
  const auto model = build_model(scene);
  const Simulation run = simulate(model, scene.solver);
  const Diagnostics d = diagnose(run);
  REQUIRE(mistrust(run, d).empty());
  REQUIRE(largest_magnitude(d.at("energy_balance_J").values) > trusted_share * energy_turned_over(d));
  Windows w = windows_of(scene, 40);
  REQUIRE(w.parts.size() >= 4);
  const Digest whole = from_checkpoint_to_checkpoint(w, model, scene);
  CHECK(whole.run.message.empty());
  CHECK(whole.run.status == RunStatus::completed);
  CHECK(accuracy_warnings(whole.run, whole.diagnostics) == accuracy_warnings(run, d));
}

}  // namespace long_run_books_test
