// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/summary.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"

using namespace unfurl;

namespace summary_test {

namespace {

nlohmann::ordered_json summary_of(const std::string& scene, const std::vector<std::string>& overrides) {
  const Scene s = read_scene_file(find_scene(scene), overrides);
  const Simulation run = simulate(build_model(s), s.solver);
  const Model& model = run.trajectory.model();
  return nlohmann::ordered_json::parse(summary_json(
      s.name, run, diagnose(run), analyse_mobility(model.system, run.trajectory.node_positions(0))));
}

std::vector<std::string> keys(const nlohmann::ordered_json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("the summary has exactly its documented keys") {
  const auto s = summary_of("hoop6", {"solver.end_time=0.05"});
  CHECK(keys(s) == Names{"unfurl", "scene", "status", "message", "warnings", "notes", "model", "solver",
                         "errors", "forces", "events", "measures", "final"});
  CHECK(keys(s["forces"]) ==
        Names{"rods", "unique_rods", "peak_rod_force_N", "peak_rod", "peak_t_s", "peak_unique"});
  CHECK(keys(s["model"]) == Names{"nodes", "rods", "coordinates", "solved_coordinates", "constraints", "rank",
                                  "redundant", "degrees_of_freedom", "solved_as", "why"});
  CHECK(keys(s["solver"]) == Names{"method", "stages", "nodes", "constraints_at", "step_s", "steps",
                                   "newton_iterations", "cpu_s"});
  CHECK(keys(s["errors"]) == Names{"constraint_max_m", "constraint_relative_max",
                                   "constraint_velocity_max_m_s", "energy_balance_max_J"});
  CHECK(keys(s["final"]) == Names{"t_s", "positions_m", "velocities_m_s"});
}

TEST_CASE("a summary tells of each event what is known of that one") {
  const Scene s = read_scene_file(find_scene("pendulum"), {"solver.end_time=0.05"});
  Simulation run = simulate(build_model(s), s.solver);
  run.events = {
      {.name = "stop A meets", .t = 0.012, .energy_lost = 0.37, .kind = "contact", .element = "stop A"},
      {.name = "passes a singular pose", .t = 0.023, .singular_value = 2e-4},
      {.name = "cable pulls", .t = 0.031, .kind = "taut", .element = "cable"},
      {.name = "stop B meets", .t = 0.041, .energy_lost = -0.02},
      {.name = "something", .t = 0.045}};
  const Model& model = run.trajectory.model();
  const auto told = nlohmann::ordered_json::parse(summary_json(
      s.name, run, diagnose(run), analyse_mobility(model.system, run.trajectory.node_positions(0))));
  const auto& events = told["events"];
  REQUIRE(events.size() == run.events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = run.events[i];
    INFO(event.name);
    CHECK(events[i]["name"] == event.name);
    CHECK(events[i]["t_s"] == event.t);
    CHECK(events[i].value("kind", "") == event.kind);
    CHECK(events[i].value("element", "") == event.element);
    CHECK(events[i].value("energy_lost_J", 0.0) == event.energy_lost);
    CHECK(events[i].contains("kind") == !event.kind.empty());
    CHECK(events[i].contains("element") == !event.element.empty());
    CHECK(events[i].contains("energy_lost_J") == (event.energy_lost != 0));
    CHECK(events[i].contains("singular_value") == !std::isnan(event.singular_value));
    if (events[i].contains("singular_value")) CHECK(events[i]["singular_value"] == event.singular_value);
  }
}

TEST_CASE("the model of the six-unit ring is counted as documented") {
  const auto s = summary_of("hoop6", {"solver.end_time=0.05"});
  CHECK(s["scene"] == "hoop6");
  CHECK(s["status"] == "completed");
  CHECK(
      s["model"].dump() ==
      R"({"nodes":24,"rods":30,"coordinates":72,"solved_coordinates":24,"constraints":78,"rank":71,"redundant":7,"degrees_of_freedom":1,"solved_as":"full","why":"solver.model = \"full\""})");
  CHECK(s["solver"]["steps"] == 5);
  CHECK(s["final"]["t_s"].get<double>() == Approx(0.05).epsilon(1e-12));  // five times 0.01, rounded
  CHECK(s["final"]["positions_m"].size() == 24);
}

TEST_CASE("the largest error is the largest magnitude, whatever its sign") {
  const Scene scene = read_scene_file(find_scene("pendulum"), {"solver.end_time=0.1"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  Diagnostics d = diagnose(run);
  for (Series& column : d.columns)
    if (column.name == "energy_balance_J") column.values = std::vector<double>(d.t.size(), 0.25);
  const auto off = [&](double last) {
    for (Series& column : d.columns)
      if (column.name == "energy_balance_J") column.values.back() = last;
    const auto text = summary_json(
        "x", run, d, analyse_mobility(run.trajectory.model().system, run.trajectory.node_positions(0)));
    return nlohmann::json::parse(text)["errors"]["energy_balance_max_J"];
  };
  CHECK(off(-29.5) == 29.5);
  CHECK(off(-0.1) == 0.25);
  CHECK(off(std::numeric_limits<double>::quiet_NaN()).is_null());
}

TEST_CASE("a summary tells what a run is asked for most") {
  const auto ring = summary_of("hoop6", {});
  // 4.92 s and 7199.5 J of the paper's ring; at its own step these are good to 1e-6.
  CHECK(ring["measures"]["deploy_time_s"].get<double>() == Approx(ring["final"]["t_s"].get<double>()));
  CHECK(ring["measures"]["deployed_fraction"].get<double>() == Approx(1).epsilon(0).margin(1e-12));
  CHECK(ring["measures"]["peak_energy_J"].get<double>() == Approx(7199.523).epsilon(1e-5));
  CHECK_FALSE(ring.contains("drives"));
  const auto driven = summary_of("hoop6_motor", {});
  CHECK(driven["measures"]["deploy_time_s"].is_null());  // it stops at 5 degrees
  // 80 of 85 degrees, of the sine: fractions are of the fold angle or of its sine, in any case most of it.
  CHECK(driven["measures"]["deployed_fraction"].get<double>() > 0.9);
  CHECK(driven["drives"]["motor"]["peak_torque_N_m"].get<double>() > 100);
  CHECK(driven["drives"]["motor"]["peak_power_W"].get<double>() > 100);
}

TEST_CASE("the summary says which rod carries most, when, and whether the model determines it") {
  const auto full = summary_of("hoop6", {"solver.end_time=0.05"})["forces"];
  CHECK(full["rods"] == 30);
  CHECK(full["unique_rods"] == 6);
  CHECK(full["peak_unique"].get<bool>());  // at the start a post's, 200 N against 100 N in the chords
  CHECK(full["peak_rod_force_N"].get<double>() > 0);
  const auto swing = summary_of("double_pendulum", {"solver.end_time=0.05"})["forces"];
  CHECK(swing["unique_rods"] == swing["rods"]);
  CHECK(swing["peak_unique"].get<bool>());
  CHECK(swing["peak_t_s"].get<double>() <= 0.05 + 1e-12);
}

TEST_CASE("a sector counts the nodes of the whole and the coordinates of what was solved") {
  const auto s = summary_of("hoop6_sector", {"solver.end_time=0.05"});
  CHECK(s["model"]["nodes"] == 24);
  CHECK(s["model"]["rods"] == 30);
  CHECK(s["model"]["coordinates"] == 12);
  CHECK(s["model"]["degrees_of_freedom"] == 1);
  CHECK(s["final"]["velocities_m_s"].size() == 24);
}

TEST_CASE("odd node names survive") {
  const Scene s = read_scene_text(
      "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = \"q\\\"\\n\\u00f6\"\nposition = [0, 0, "
      "0]\nmass = 1\n"
      "[solver]\nend_time = 0.02\n",
      "x");
  const Simulation run = simulate(build_model(s), s.solver);
  const auto json = nlohmann::json::parse(
      summary_json("x", run, diagnose(run),
                   analyse_mobility(run.trajectory.model().system, run.trajectory.node_positions(0))));
  CHECK(json["final"]["positions_m"].contains("q\"\n\xC3\xB6"));
}

}  // namespace summary_test
