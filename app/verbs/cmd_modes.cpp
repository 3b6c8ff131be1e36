// SPDX-License-Identifier: BSD-3-Clause
// unfurl modes SCENE [--at TIME|start|end|deployed] [-o DIR]: free motions and natural frequencies at a pose.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/command.hpp"
#include "app/output/interrupt.hpp"
#include "app/verbs/modal_pose.hpp"
#include "app/verbs/scene_run.hpp"
#include "app/verbs/study_session.hpp"
#include "core/diagnostics/rod_strength.hpp"
#include "core/diagnostics/touched_limits.hpp"
#include "core/study/table.hpp"
#include "core/system/consistency.hpp"
#include "core/text/nearest_name.hpp"
#include "render/plot/figures/mode_shapes.hpp"

namespace unfurl {

namespace {

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

nlohmann::ordered_json modes_json(const Scene& scene, const Vibration& vibration,
                                  const std::vector<std::string>& one_sided) {
  nlohmann::ordered_json json{{"scene", scene.name},
                              {"pose_t_s", vibration.t},
                              {"mechanism_motions", vibration.mechanism_motions},
                              {"prestress_unique", vibration.unique},
                              {"one_sided", one_sided}};
  for (const char* list :
       {"frequencies_Hz", "mechanism_frequencies_Hz", "growth_rates_1_s", "growing_frequencies_Hz"})
    json[list] = nlohmann::ordered_json::array();
  for (const VibrationMode& mode : vibration.modes) {
    if (mode.growth > 0) {
      json["growth_rates_1_s"].push_back(mode.growth);
      json["growing_frequencies_Hz"].push_back(mode.frequency);
    } else {
      json[mode.mechanism ? "mechanism_frequencies_Hz" : "frequencies_Hz"].push_back(mode.frequency);
    }
  }
  return json;
}

void print_modes(const Scene& scene, const Vibration& vibration, bool elastic,
                 const std::vector<std::string>& one_sided) {
  constexpr std::size_t most = 24;
  const auto elastic_modes = vibration.modes.size() - static_cast<std::size_t>(vibration.mechanism_motions);
  std::cout << scene.name << " at " << short_number(vibration.t, 6) << " s: mechanism motions "
            << vibration.mechanism_motions << ", modes of elastic rods " << elastic_modes << "\n";
  if (!elastic) std::cout << "  (no rod has a youngs_modulus: rods are rigid)\n";
  if (vibration.modes.empty())
    std::cout << "  (nothing is free to move: constraints, stops and drives hold it)\n";
  else if (!vibration.unique)
    std::cout << "  (forces are not unique at this pose, and with them the stiffness that they give)\n";
  if (!one_sided.empty())
    std::cout
        << "  (just taut or touched without a force, so that it acts to one side only, which frequencies do "
           "not tell: "
        << unfurl::listed(one_sided, 4) << ")\n";
  if (!vibration.modes.empty()) std::cout << "mode   frequency (Hz)\n";
  for (std::size_t k = 0; k < std::min(most, vibration.modes.size()); ++k) {
    const VibrationMode& mode = vibration.modes[k];
    const double shown = mode.growth > 0 ? mode.growth : mode.frequency;
    std::cout << std::setw(4) << k + 1 << std::setw(17) << short_number(shown, 7)
              << (mode.growth > 0 ? " 1/s  " : "      ") << name_of(mode);
    if (mode.growth > 0 && mode.frequency > 0)
      std::cout << " at " << short_number(mode.frequency, 7) << " Hz";
    std::cout << "\n";
  }
  if (vibration.modes.size() > most)
    std::cout << "  and " << vibration.modes.size() - most << " more (modes.csv with -o, or --json)\n";
}

}  // namespace

int cmd_modes(const Arguments& arguments) {
  const Scene scene = scene_of(arguments);
  const InterruptGuard guard;
  const ModalPose pose = modal_pose(scene, arguments);
  if (interrupted()) return exit_interrupted;
  const Structure& structure = pose.model->structure;
  const Vibration vibration = vibration_of(pose);
  const std::vector<std::string> one_sided = touched_limits(*pose.model, pose.state);
  if (arguments.json)
    std::cout << modes_json(scene, vibration, one_sided).dump(2) << "\n";
  else if (!arguments.quiet)
    print_modes(scene, vibration, any_elastic(structure), one_sided);
  if (arguments.output.empty()) return pose.code;
  StudySession session(arguments, "modes",
                       study_identity("Modes at " + exact_number(vibration.t) + " s", scene), "modes.csv");
  session.write("modes.csv", csv_text(modes_table(vibration)));
  session.write("mode_shapes.csv", csv_text(shapes_table(vibration, structure)));
  VectorXd q(pose.model->system.coordinates());
  pose.model->system.expand(pose.state.z, q);
  if (!vibration.modes.empty())
    session.write(mode_shapes_figure(structure, whole_positions(structure, q), vibration, scene.title));
  return pose.code;
}

}  // namespace unfurl
