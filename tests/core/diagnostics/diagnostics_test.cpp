// SPDX-License-Identifier: BSD-3-Clause
// What is left of the diagnostics of a run where nobody wants to wait for them.
#include "core/diagnostics/diagnostics.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/books.hpp"
#include "core/diagnostics/energy_flow.hpp"
#include "core/export/summary.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/system/mobility.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

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
      if (i >= 20 || whole.columns[c].name.ends_with("_unique"))  // nobody looked for what is unique
        CHECK(std::isnan(part.columns[c].values[i]));
      else
        CHECK(part.columns[c].values[i] == whole.columns[c].values[i]);
    }
  }
  CHECK(part.axial_force.topRows(20) == whole.axial_force.topRows(20));
  CHECK(part.axial_force.bottomRows(31).array().isNaN().all());
  const auto warnings = accuracy_warnings(run, part);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].find("interrupted: the run was judged up to t = 0.19 s only") != std::string::npos);
}

TEST_CASE("what an interrupted diagnosis did not look at is null in the summary and called neither nor") {
  const Simulation run = simulate(make_model(hoop_structure()), dvm_options(3, 0.01, 0.5));
  const Mobility mobility = analyse_mobility(run.trajectory.model().system, run.trajectory.node_positions(0));
  const auto size = static_cast<int>(run.trajectory.size());
  for (const int judged : {0, 20, size}) {
    int states = 0;
    bool asked = false;
    KnownAhead ahead;
    ahead.name_poses = [&] { asked = true; };
    const Diagnostics d = diagnose(
        run, [&] { return ++states > judged; }, ahead);
    CHECK_FALSE(asked);  // what is unique takes long to find
    CHECK_FALSE(d.unique_known());
    const auto summary = nlohmann::json::parse(summary_json("hoop", run, d, mobility, {}));
    INFO(judged << summary.dump(1));
    CHECK(summary["warnings"][0].get<std::string>().starts_with("interrupted"));
    for (const char* name : {"peak_rod_force_unique", "peak_tension_unique", "stress_margin_unique"})
      CHECK(summary["measures"][name].is_null());
    CHECK(summary["forces"]["unique_rods"].is_null());
    CHECK((!summary["forces"].contains("peak_unique") || summary["forces"]["peak_unique"].is_null()));
    CHECK(summary["measures"]["peak_rod_force_N"].is_null() == (judged < size));
    CHECK(summary["measures"]["energy_J"].is_null() == (judged < size));
    CHECK(summary["errors"]["constraint_max_m"].is_null() == (judged < size));
  }
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

// The books that are kept alone solve the equations at every state themselves; those of a whole diagnosis
// take the factorisation that gives the rods' forces. Two solvers' round-off in the power of 60 W, at 100
// steps, through an impact after which the stop holds: another model.
TEST_CASE("energy put in by a motor is the same whether or not its forces are looked at") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "X", position = [1, 0, 0], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [0.9, 0, 0.3]}, {name = "B", position = [1.2, 0, -0.5], mass = 1.7}]
rods = [{nodes = ["O", "A"], mass = 2.1}, {nodes = ["A", "B"], mass = 0.9}]
[[structure.constraints]]
kind = "plane"
nodes = ["A", "B"]
normal = [0, 1, 0]
[[structure.constraints]]
kind = "coordinate_stop"
name = "wall"
nodes = ["B"]
direction = [1, 0, 0]
min = 0.7
restitution = 0
[[constraints]]
kind = "angle"
name = "motor"
nodes = ["X", "O", "A"]
axis = [0, -1, 0]
motion = "rate"
rate = 60
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 4
step = 0.007
end_time = 0.7
)");
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics all = diagnose(run), books = diagnose_books(run);
  REQUIRE(&run.trajectory.model(0) != &run.trajectory.model(run.trajectory.size() - 1));
  for (const char* name : {"drive_work_J", "impact_loss_J", "energy_balance_J"}) {
    const auto &a = all.at(name).values, &b = books.at(name).values;
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i] == Approx(b[i]).epsilon(0).margin(1e-11));
  }
  CHECK(testing::largest(all, "drive_work_J") > 1);
  CHECK(testing::largest(all, "impact_loss_J") > 0.1);
}

// A ring whose constraints are redundant, a latch that changes the model, a deployed pose that is singular;
// one that swings through it, next to which its forces are interpolated; and one that a motor drives.
TEST_CASE("what is found of a run ahead, while it grows, changes no bit of its diagnosis") {
  const auto [name, changes] = GENERATE(
      std::pair<const char*, std::vector<std::string>>{
          "hoop6", {"structure.fold_angle=63.7", "solver.at_deployed=latch", "solver.end_time=5.5"}},
      std::pair<const char*, std::vector<std::string>>{
          "hoop6", {"structure.fold_angle=57", "solver.at_deployed=pass", "solver.end_time=1.4"}},
      std::pair<const char*, std::vector<std::string>>{"hoop6_motor", {"solver.end_time=1.3"}});
  CAPTURE(name);
  const Scene scene = read_scene_file(find_scene(name), changes);
  const Simulation run = simulate(build_model(scene), scene.solver);
  Simulation alone = run;
  record_singular_poses(alone);
  const Diagnostics wanted = diagnose(alone);

  const auto shared = [](const Model& model) {
    return std::shared_ptr<const Model>(std::shared_ptr<const Model>(), &model);
  };
  std::vector<SolvedPoint> forces;
  Trajectory seen(shared(run.trajectory.model()));
  StateForces solver(seen);
  RunEnergyFlow flow(seen, true);
  for (std::size_t at = 0; at < run.trajectory.size(); at += 28) {
    for (std::size_t i = at; i < std::min(at + 28, run.trajectory.size()); ++i) {
      if (&run.trajectory.model(i) != &seen.last_model()) seen.change_model(shared(run.trajectory.model(i)));
      seen.append(run.trajectory.state(i), run.trajectory.report(i));
    }
    for (std::size_t i = at; i < seen.size(); ++i) {
      if (i > 0) flow.step_to(i, &solver);
      forces.push_back(solver.at(i));
    }
  }
  Simulation ahead = run;
  const Diagnostics d = diagnose(ahead, {}, {&forces, &flow.so_far(), [&] { record_singular_poses(ahead); }});
  REQUIRE(d.columns.size() == wanted.columns.size());
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (std::size_t c = 0; c < d.columns.size(); ++c) {
    CAPTURE(d.columns[c].name);
    CHECK(std::ranges::equal(d.columns[c].values, wanted.columns[c].values, same));
  }
  CHECK(std::equal(d.axial_force.data(), d.axial_force.data() + d.axial_force.size(),
                   wanted.axial_force.data(), same));
  CHECK((d.force_unique == wanted.force_unique).all());
  CHECK(d.rod_unique == wanted.rod_unique);
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
