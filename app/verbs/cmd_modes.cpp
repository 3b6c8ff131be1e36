// SPDX-License-Identifier: BSD-3-Clause
// unfurl modes SCENE [--at TIME|start|end|deployed] [-o DIR]: free motions and natural frequencies at a pose.
#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/output/interrupt.hpp"
#include "app/verbs/scene_run.hpp"
#include "app/verbs/study_session.hpp"
#include "core/diagnostics/rod_strength.hpp"
#include "core/diagnostics/vibration.hpp"
#include "core/scene/build.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/study/table.hpp"
#include "core/text/nearest_name.hpp"
#include "render/plot/figures/mode_shapes.hpp"

namespace unfurl {

namespace {

// What the pose belongs to lives as long as the run.
struct Pose {
  std::shared_ptr<const Model> model;
  Simulation run;
  const Model* at = nullptr;
  State state;
};

Pose at_start(const Scene& scene, const Arguments& arguments) {
  auto model = model_of(scene, arguments);
  Pose pose{model, Simulation{.trajectory = Trajectory(model, scene.solver)}, model.get(), {}};
  pose.state = initial_state(model->structure, model->system).state;
  return pose;
}

// Throws UsageError where the motion has no such time.
double time_of(const std::string& at, const Simulation& run) {
  const Trajectory& trajectory = run.trajectory;
  if (at == "end") return trajectory.end_time();
  if (at == "deployed") {
    for (const Event& event : run.events)
      if (event.name == "deployed") return event.t;
    throw UsageError("--at deployed: the run does not reach the deployed pose");
  }
  const double t = number_of(at);
  if (!(t >= trajectory.start_time() && t <= trajectory.end_time()))
    throw UsageError("--at takes start, end, deployed or a time from " +
                     short_number(trajectory.start_time(), 6) + " to " +
                     short_number(trajectory.end_time(), 6) + " s; got " + in_quotes(at));
  return t;
}

Pose in_motion(const Scene& scene, const Arguments& arguments) {
  auto model = model_of(scene, arguments);
  Pose pose{model, simulate_scene(scene, model, arguments), nullptr, {}};
  const Trajectory& trajectory = pose.run.trajectory;
  const double t = time_of(arguments.at, pose.run);
  const std::size_t i = trajectory.state_before(t);
  pose.at = &trajectory.model(i);
  pose.state = trajectory.time(i) == t ? trajectory.state(i) : trajectory.state_at(t);
  return pose;
}

std::string name_of(const VibrationMode& mode) {
  if (mode.growth > 0) return "unstable";
  if (!mode.mechanism) return "elastic";
  return mode.frequency > 0 ? "mechanism, pulled back" : "mechanism, free";
}

Table modes_table(const Vibration& vibration) {
  Table table{{"mode", "frequency_Hz", "growth_rate_1_s", "mechanism"}, {}};
  for (std::size_t k = 0; k < vibration.modes.size(); ++k) {
    const VibrationMode& mode = vibration.modes[k];
    table.rows.push_back({std::to_string(k + 1), exact_number(mode.frequency), exact_number(mode.growth),
                          mode.mechanism ? "1" : "0"});
  }
  return table;
}

Table shapes_table(const Vibration& vibration, const Structure& structure) {
  Table table{{"mode", "node", "x", "y", "z"}, {}};
  for (std::size_t k = 0; k < vibration.modes.size(); ++k)
    for (std::size_t n = 0; n < structure.node_copies.size(); ++n) {
      const Vec3 v = vibration.modes[k].shape.segment<3>(static_cast<Index>(3 * n));
      table.rows.push_back({std::to_string(k + 1), structure.node_copies[n].name, exact_number(v.x()),
                            exact_number(v.y()), exact_number(v.z())});
    }
  return table;
}

nlohmann::ordered_json modes_json(const Scene& scene, const Vibration& vibration) {
  nlohmann::ordered_json json{{"scene", scene.name},
                              {"pose_t_s", vibration.t},
                              {"mechanism_motions", vibration.mechanism_motions},
                              {"prestress_unique", vibration.unique}};
  for (const char* list : {"frequencies_Hz", "mechanism_frequencies_Hz", "growth_rates_1_s"})
    json[list] = nlohmann::ordered_json::array();
  for (const VibrationMode& mode : vibration.modes) {
    if (mode.growth > 0)
      json["growth_rates_1_s"].push_back(mode.growth);
    else
      json[mode.mechanism ? "mechanism_frequencies_Hz" : "frequencies_Hz"].push_back(mode.frequency);
  }
  return json;
}

void print_modes(const Scene& scene, const Vibration& vibration, bool elastic) {
  constexpr std::size_t most = 24;
  const auto elastic_modes = vibration.modes.size() - static_cast<std::size_t>(vibration.mechanism_motions);
  std::cout << scene.name << " at " << short_number(vibration.t, 6) << " s: mechanism motions "
            << vibration.mechanism_motions << ", modes of elastic rods " << elastic_modes << "\n";
  if (!elastic) std::cout << "  (no rod has a youngs_modulus: rods are rigid)\n";
  if (!vibration.unique)
    std::cout << "  (forces are not unique at this pose, and with them the stiffness that they give)\n";
  if (!vibration.modes.empty()) std::cout << "mode   frequency (Hz)\n";
  for (std::size_t k = 0; k < std::min(most, vibration.modes.size()); ++k) {
    const VibrationMode& mode = vibration.modes[k];
    const double shown = mode.growth > 0 ? mode.growth : mode.frequency;
    std::cout << std::setw(4) << k + 1 << std::setw(17) << short_number(shown, 7)
              << (mode.growth > 0 ? " 1/s  " : "      ") << name_of(mode) << "\n";
  }
  if (vibration.modes.size() > most)
    std::cout << "  and " << vibration.modes.size() - most << " more (modes.csv with -o, or --json)\n";
}

}  // namespace

int cmd_modes(const Arguments& arguments) {
  const Scene scene = scene_of(arguments);
  const InterruptGuard guard;
  const bool start = arguments.at.empty() || arguments.at == "start";
  const Pose pose = start ? at_start(scene, arguments) : in_motion(scene, arguments);
  if (interrupted()) return exit_interrupted;
  const Structure& structure = pose.at->structure;
  if (pose.at->system.solved_coordinates() > max_vibration_coordinates)
    throw UsageError("modes are for " + std::to_string(max_vibration_coordinates) +
                     " solved coordinates at most; the structure has " +
                     std::to_string(pose.at->system.solved_coordinates()));
  const Vibration vibration = unfurl::vibration(*pose.at, pose.state);
  if (arguments.json)
    std::cout << modes_json(scene, vibration).dump(2) << "\n";
  else
    print_modes(scene, vibration, any_elastic(structure));
  if (arguments.output.empty()) return exit_ok;
  StudySession session(arguments, "modes",
                       study_identity("Modes at " + exact_number(vibration.t) + " s", scene), "modes.csv");
  session.write("modes.csv", csv_text(modes_table(vibration)));
  session.write("mode_shapes.csv", csv_text(shapes_table(vibration, structure)));
  VectorXd q(pose.at->system.coordinates());
  pose.at->system.expand(pose.state.z, q);
  if (!vibration.modes.empty() && !structure.rod_copies.empty())
    session.write(mode_shapes_figure(structure, whole_positions(structure, q), vibration, scene.title));
  return exit_ok;
}

}  // namespace unfurl
