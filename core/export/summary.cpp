// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/summary.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/ending.hpp"
#include "core/diagnostics/force_uniqueness.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/diagnostics/reactions.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/diagnostics/rod_strength.hpp"
#include "core/math/largest.hpp"
#include "core/text/version.hpp"

namespace unfurl {

namespace {

using Json = nlohmann::ordered_json;

double max_abs(const Diagnostics& diagnostics, std::string_view name) {
  return largest_magnitude(diagnostics.at(name).values);
}

Json model_json(const Structure& structure, const System& system, const Mobility& mobility) {
  return {{"nodes", structure.node_copies.size()},  {"rods", structure.rod_copies.size()},
          {"coordinates", mobility.coordinates},    {"solved_coordinates", system.solved_coordinates()},
          {"constraints", mobility.constraints},    {"rank", mobility.rank},
          {"redundant", mobility.redundant.size()}, {"degrees_of_freedom", mobility.degrees_of_freedom}};
}

Json solver_json(const Simulation& run) {
  return {{"method", run.options.method},
          {"stages", run.options.stages},
          {"nodes", run.options.nodes},
          {"constraints_at", run.options.constraints_at},
          {"step_s", run.options.step},
          {"steps", run.steps},
          {"newton_iterations", run.newton_iterations},
          {"cpu_s", run.cpu_s}};
}

// What the run is asked for most: "deploy_time_s", "peak_rod_force_N", ...; null where there is none.
Json measures_json(const Simulation& run, const Diagnostics& diagnostics) {
  Json object = Json::object();
  for (const NamedMeasure& named : named_measures()) {
    if (named.name == "cpu" || named.name == "frequency") continue;  // solver.cpu_s; work of its own
    const RunMeasure measure = find_measure(std::string(named.name));
    object[measure.column] = measure.value(run, diagnostics);
  }
  return object;
}

// The largest magnitude of what each drive gives: "motor": {"peak_torque_N_m": 2005, "peak_power_W": 812,
// "peak_energy_J": 90}.
Json drives_json(const Simulation& run, const Diagnostics& diagnostics) {
  Json object = Json::object();
  for (const Series& column : diagnostics.columns)
    for (const std::string_view end : {".torque_N_m", ".force_N", ".power_W", ".energy_J"})
      if (column.name.ends_with(end))
        object[column.name.substr(0, column.name.size() - end.size())]["peak_" + std::string(end.substr(1))] =
            peak_of_column(run, diagnostics, column.name);
  return object;
}

// No two have one name, which is not looked for among those before it.
Json by_node(const Structure& structure, const VectorXd& x) {
  Json object = Json::object();
  auto& members = object.get_ref<Json::object_t&>();
  for (std::size_t i = 0; i < structure.node_copies.size(); ++i) {
    const auto at = static_cast<Index>(3 * i);
    members.emplace_back(structure.node_copies[i].name, Json{x[at], x[at + 1], x[at + 2]});
  }
  return object;
}

Json final_json(const Trajectory& trajectory) {
  const std::size_t last = trajectory.size() - 1;
  return {{"t_s", trajectory.time(last)},
          {"positions_m", by_node(trajectory.structure(), trajectory.positions(last))},
          {"velocities_m_s", by_node(trajectory.structure(), trajectory.velocities(last))}};
}

// Peaks are those of the motion, as in the measures. The rod that carries the peak by the name of its first
// copy.
Json forces_json(const Simulation& run, const Diagnostics& diagnostics) {
  const Structure& structure = run.trajectory.structure();
  const PeakForce peak = peak_rod_force(run, diagnostics);
  const auto shown = std::find_if(structure.rod_copies.begin(), structure.rod_copies.end(),
                                  [&](const RodCopy& copy) { return copy.source == peak.rod; });
  Json forces = {{"rods", structure.rod_copies.size()}, {"unique_rods", unique_rods(structure, diagnostics)}};
  if (!diagnostics.whole()) forces["unique_rods"] = Json();
  if (diagnostics.left_open > 0) return forces;
  if (shown == structure.rod_copies.end()) return forces;
  forces["peak_rod_force_N"] = find_measure("peak_rod_force").value(run, diagnostics);
  forces["peak_rod"] = shown->name;
  forces["peak_t_s"] = peak.t;
  forces["peak_unique"] = diagnostics.whole() ? Json(peak.unique) : Json();
  return forces;
}

// What each support gives at most: "A": {"peak_N": 29.4, "t_s": 0.7, "unique": true}.
Json reactions_json(const Structure& structure, const Diagnostics& diagnostics) {
  Json object = Json::object();
  if (diagnostics.left_open > 0) return object;
  for (const PeakReaction& peak : peak_reactions(structure, diagnostics))
    object[structure.nodes[static_cast<std::size_t>(peak.node)].name] = {
        {"peak_N", peak.force_N},
        {"t_s", peak.t},
        {"unique", diagnostics.whole() ? Json(peak.unique) : Json()}};
  return object;
}

// What the rods that have a modulus bear; a margin is null where nothing is borne.
Json strength_json(const Simulation& run, const Diagnostics& diagnostics) {
  const Structure& structure = run.trajectory.structure();
  Json strength;
  const auto add = [&](const char* name, double (*quantity)(const Rod&, double), double peak, auto&& values) {
    const WorstRod worst = worst_rod(run, diagnostics, quantity);
    Json& entry = strength[name];
    values(entry, peak);
    const auto shown = std::find_if(structure.rod_copies.begin(), structure.rod_copies.end(),
                                    [&](const RodCopy& copy) { return copy.source == worst.rod; });
    entry["rod"] = shown == structure.rod_copies.end() ? Json() : Json(shown->name);
    entry["t_s"] = worst.t;
    entry["unique"] = diagnostics.whole() && worst.rod >= 0 ? Json(worst.unique) : Json();
  };
  add("axial_stress", axial_stress, find_measure("peak_stress").value(run, diagnostics),
      [](Json& entry, double value) { entry["peak_Pa"] = value; });
  const auto with_margin = [](Json& entry, double ratio) {
    entry["peak_ratio"] = ratio;
    entry["margin"] = margin_of(ratio);
  };
  const auto largest = [&](const char* column) { return largest_of_column(run, diagnostics, column); };
  if (any_strength(structure)) add("stress", stress_ratio, largest("stress_ratio_max"), with_margin);
  add("buckling", buckling_ratio, largest("buckling_ratio_max"), with_margin);
  return strength;
}

}  // namespace

std::string summary_json(const std::string& scene_name, const Simulation& run, const Diagnostics& diagnostics,
                         const Mobility& mobility, const RunRecord& record) {
  const RememberedExtremes once;
  const Model& model = run.trajectory.model();
  Json summary = {{"unfurl", version()}, {"scene", scene_name}, {"status", to_string(run.status)}};
  if (!record.command.empty()) summary["command"] = record.command;
  if (!record.scene_hash.empty()) summary["scene_hash"] = record.scene_hash;
  if (record.wall_s > 0) summary["wall_s"] = record.wall_s;
  summary["message"] = run.message;
  summary["warnings"] = warnings_of(run, diagnostics);
  summary["notes"] = notes_of(run, diagnostics);
  summary["model"] = model_json(model.structure, model.system, mobility);
  const SolvedAs solved = solved_as(run);
  summary["model"]["solved_as"] = solved.name;
  summary["model"]["why"] = solved.why;
  summary["solver"] = solver_json(run);
  for (const char* name : {"constraint_max_m", "constraint_relative_max", "constraint_velocity_max_m_s"})
    summary["errors"][name] = max_abs(diagnostics, name);
  summary["errors"]["energy_balance_max_J"] = max_abs(diagnostics, "energy_balance_J");
  if (!std::isnan(run.position_estimate)) summary["errors"]["position_estimate_m"] = run.position_estimate;
  summary["forces"] = forces_json(run, diagnostics);
  for (const auto& [column, key] : {std::pair("latch_force_max_N", "peak_latch_force_N"),
                                    std::pair("latch_torque_max_N_m", "peak_latch_torque_N_m")})
    if (diagnostics.find(column)) summary["forces"][key] = largest_of_column(run, diagnostics, column);
  if (Json supports = reactions_json(model.structure, diagnostics); !supports.empty())
    summary["reactions"] = std::move(supports);
  if (any_elastic(model.structure) && diagnostics.left_open == 0)
    summary["strength"] = strength_json(run, diagnostics);
  summary["events"] = Json::array();
  for (const auto& event : run.events) {
    summary["events"].push_back({{"name", event.name}, {"t_s", event.t}, {"text", event.name}});
    if (!event.kind.empty()) summary["events"].back()["kind"] = event.kind;
    if (!event.element.empty()) summary["events"].back()["element"] = event.element;
    if (event.energy_lost != 0.0) summary["events"].back()["energy_lost_J"] = event.energy_lost;
    if (!std::isnan(event.singular_value)) summary["events"].back()["singular_value"] = event.singular_value;
  }
  summary["measures"] = measures_json(run, diagnostics);
  if (Json drives = drives_json(run, diagnostics); !drives.empty()) summary["drives"] = std::move(drives);
  if (!run.trajectory.empty()) summary["final"] = final_json(run.trajectory);
  return summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace unfurl
