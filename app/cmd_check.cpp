// unfurl check SCENE: validate; print coordinates, constraints, rank, redundant ones by name, degrees of
// freedom.
#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/progress.hpp"
#include "app/scene_run.hpp"
#include "core/model/mobility.hpp"
#include "core/simulate/initial_state.hpp"

namespace unfurl {

namespace {

VectorXd start_positions(const Structure& structure) {
  VectorXd q(static_cast<Index>(3 * structure.nodes.size()));
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    q.segment<3>(static_cast<Index>(3 * i)) = structure.nodes[i].position;
  return q;
}

void print_json(const Scene& scene, const Model& model, const Mobility& mobility) {
  nlohmann::ordered_json json = {{"scene", scene.name},
                                 {"title", scene.title},
                                 {"structure", scene.kind},
                                 {"nodes", model.structure.node_copies.size()},
                                 {"rods", model.structure.rod_copies.size()},
                                 {"coordinates", mobility.coordinates},
                                 {"solved_coordinates", model.system.solved_coordinates()},
                                 {"constraints", mobility.constraints},
                                 {"rank", mobility.rank},
                                 {"redundant", mobility.redundant},
                                 {"degrees_of_freedom", mobility.degrees_of_freedom},
                                 {"rigid_motions", mobility.rigid_motions},
                                 {"maxwell_count", mobility.count}};
  json["smallest_singular_value"] = mobility.smallest_singular_value;
  std::cout << json.dump(2) << "\n";
}

void print_row(const char* name, Index value) {
  std::cout << std::left << std::setw(24) << name << std::right << std::setw(8) << value << "\n";
}

void print_table(const Scene& scene, const Model& model, const Mobility& mobility) {
  std::cout << scene.name << ": " << scene.title << "\n";
  print_row("nodes", static_cast<Index>(model.structure.node_copies.size()));
  print_row("rods", static_cast<Index>(model.structure.rod_copies.size()));
  print_row("coordinates", mobility.coordinates);
  print_row("solved coordinates", model.system.solved_coordinates());
  print_row("constraints", mobility.constraints);
  print_row("rank", mobility.rank);
  print_row("redundant", static_cast<Index>(mobility.redundant.size()));
  for (const auto& name : mobility.redundant) std::cout << "  " << name << "\n";
  print_row("degrees of freedom", mobility.degrees_of_freedom);
  if (mobility.rigid_motions > 0) print_row("  as one rigid body", mobility.rigid_motions);
  print_row("by Maxwell's count", mobility.count);
  if (!std::isnan(mobility.smallest_singular_value))
    std::cout << std::left << std::setw(24) << "smallest singular value" << std::right << std::setw(8)
              << std::setprecision(3) << mobility.smallest_singular_value << "\n";
}

Mobility mobility_of(const Model& model, const Arguments& arguments) {
  const Waiting waiting("ranking " + std::to_string(model.system.constraints()) + " constraints of " +
                            std::to_string(model.system.solved_coordinates()) + " coordinates",
                        arguments.quiet);
  return analyse_mobility(model.system, start_positions(model.structure));
}

}  // namespace

int cmd_check(const Arguments& arguments) {
  const Scene scene = scene_of(arguments);
  const auto model = model_of(scene, arguments);
  const Mobility mobility = mobility_of(*model, arguments);
  for (const auto& note : model->structure.notes) std::cerr << "unfurl: warning: " << note << "\n";
  const std::string warning =
      velocity_warning(initial_state(model->structure, model->system), model->structure);
  if (!warning.empty()) std::cerr << "unfurl: warning: " << warning << "\n";
  if (arguments.json)
    print_json(scene, *model, mobility);
  else
    print_table(scene, *model, mobility);
  return exit_ok;
}

}  // namespace unfurl
