#include "core/export/summary.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/ending.hpp"

namespace unfurl {

namespace {

using Json = nlohmann::ordered_json;

// Largest magnitude of a column; NaN where any entry is NaN.
double max_abs(const Diagnostics& diagnostics, std::string_view name) {
  double largest = 0.0;
  for (const double x : diagnostics.at(name).values)
    largest = std::isnan(x) ? x : std::max(largest, std::abs(x));
  return largest;
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

Json by_node(const Structure& structure, const VectorXd& x) {
  Json object = Json::object();
  for (std::size_t i = 0; i < structure.node_copies.size(); ++i) {
    const auto at = static_cast<Index>(3 * i);
    object[structure.node_copies[i].name] = {x[at], x[at + 1], x[at + 2]};
  }
  return object;
}

Json final_json(const Trajectory& trajectory) {
  const std::size_t last = trajectory.size() - 1;
  return {{"t_s", trajectory.time(last)},
          {"positions_m", by_node(trajectory.structure(), trajectory.positions(last))},
          {"velocities_m_s", by_node(trajectory.structure(), trajectory.velocities(last))}};
}

}  // namespace

std::string summary_json(const std::string& scene_name, const Simulation& run, const Diagnostics& diagnostics,
                         const Mobility& mobility) {
  const Model& model = run.trajectory.model();
  Json summary = {{"unfurl", UNFURL_VERSION}, {"scene", scene_name}, {"status", to_string(run.status)}};
  summary["message"] = run.message;
  summary["warnings"] = run.warnings;
  for (const auto& warning : accuracy_warnings(diagnostics)) summary["warnings"].push_back(warning);
  summary["notes"] = Json::array();
  if (const std::string note = ending_note(run, diagnostics); !note.empty()) summary["notes"].push_back(note);
  summary["model"] = model_json(model.structure, model.system, mobility);
  summary["solver"] = solver_json(run);
  for (const char* name : {"constraint_max_m", "constraint_relative_max", "constraint_velocity_max_m_s"})
    summary["errors"][name] = max_abs(diagnostics, name);
  summary["errors"]["energy_balance_max_J"] = max_abs(diagnostics, "energy_balance_J");
  if (!std::isnan(run.position_estimate)) summary["errors"]["position_estimate_m"] = run.position_estimate;
  summary["events"] = Json::array();
  for (const auto& event : run.events) {
    summary["events"].push_back({{"name", event.name}, {"t_s", event.t}});
    if (event.energy_lost != 0.0) summary["events"].back()["energy_lost_J"] = event.energy_lost;
    if (!std::isnan(event.singular_value)) summary["events"].back()["singular_value"] = event.singular_value;
  }
  if (!run.trajectory.empty()) summary["final"] = final_json(run.trajectory);
  return summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace unfurl
