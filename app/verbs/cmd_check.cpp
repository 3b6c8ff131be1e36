// SPDX-License-Identifier: BSD-3-Clause
// unfurl check SCENE: validate; print coordinates, constraints, rank, redundant ones by name, degrees of
// freedom, how near rods come to each other, and which forces the rigid model does not determine.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/output/progress.hpp"
#include "app/verbs/scene_run.hpp"
#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/books.hpp"
#include "core/diagnostics/clearance.hpp"
#include "core/simulate/elastic_period.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/study/tolerance.hpp"
#include "core/system/blocked_motion.hpp"
#include "core/system/mobility.hpp"
#include "core/system/rigid_twin.hpp"
#include "core/system/self_stress.hpp"
#include "render/scene/film_style.hpp"

namespace unfurl {

namespace {

VectorXd start_positions(const Structure& structure) {
  VectorXd q(static_cast<Index>(3 * structure.nodes.size()));
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    q.segment<3>(static_cast<Index>(3 * i)) = structure.nodes[i].position;
  return q;
}

// What is judged, and by what names.
struct Judged {
  const Model& model;
  Mobility mobility;
  double smallest_singular_value;
  ForceBalance balance;
  std::vector<std::string> names;  // of all constraints

  std::string name(int row) const { return names[static_cast<std::size_t>(row)]; }
  // Rods are the last constraints.
  int first_rod() const { return static_cast<int>(names.size() - model.structure.rods.size()); }
  // Shown rods whose force is unique.
  Index unique_rods() const {
    const auto& rods = model.structure.rod_copies;
    const auto first = static_cast<std::size_t>(first_rod());
    return std::count_if(rods.begin(), rods.end(), [&](const RodCopy& rod) {
      return balance.determined[first + static_cast<std::size_t>(rod.source)] != 0;
    });
  }
};

nlohmann::ordered_json self_stress_json(const Judged& judged) {
  auto states = nlohmann::ordered_json::array();
  for (const SelfStress& state : judged.balance.states) {
    auto members = nlohmann::ordered_json::array();
    for (const auto& member : state.members)
      members.push_back({{"member", judged.name(member.row)}, {"force", member.force}});
    states.push_back(std::move(members));
  }
  return states;
}

// How near rods come to each other, over the motion where that is quick to have, else as it starts.
struct NearRods {
  std::optional<Clearance> least;
  double until = 0;  // what was looked at [s]
  std::string why;   // it is not the whole motion; empty: it is
  std::vector<std::string> names;

  std::string name(int rod) const { return names[static_cast<std::size_t>(rod)]; }
};

NearRods near_rods(const std::shared_ptr<const Model>& model, const Scene& scene,
                   const Arguments& arguments) {
  constexpr double most_work = 3e6;  // rods times steps: about as many microseconds
  NearRods near;
  for (const RodCopy& rod : model->structure.rod_copies) near.names.push_back(rod.name);
  if (near.names.size() < 2) return near;
  SolverOptions solver = scene.solver;
  const double steps = solver.end_time / solver.step;
  if (steps * static_cast<double>(near.names.size()) > most_work) {
    near.why = "the motion is long: it was not looked at";
    solver.end_time = solver.step;
  }
  const Waiting waiting("distances of " + std::to_string(near.names.size()) + " rods over the motion",
                        arguments.quiet);
  try {
    Simulation run = simulate_as_asked(model, solver);
    // Nothing is near in what is wrong; forces, which cost most, do not tell.
    if (!mistrust(run, diagnose_books(run)).empty()) judge(run);
    const std::size_t states = near.why.empty() ? run.trajectory.size() : 1;
    near.least = least_clearance(run.trajectory, states);
    near.until = run.trajectory.time(states - 1);
    if (run.status == RunStatus::failed) near.why = "the solver fails there: " + run.message;
  } catch (const Error& error) {
    near.why = error.what();
  }
  return near;
}

nlohmann::ordered_json clearance_json(const NearRods& near) {
  nlohmann::ordered_json json = nullptr;
  if (near.least)
    json = {{"distance_m", near.least->distance},
            {"axes_m", near.least->axes},
            {"rods", {near.name(near.least->rod_a), near.name(near.least->rod_b)}},
            {"t_s", near.least->t},
            {"overlapping_pairs", near.least->overlapping},
            {"states", near.least->states},
            {"until_s", near.until},
            {"whole_motion", near.why.empty()}};
  return json;
}

void print_clearance(const NearRods& near) {
  if (near.least) {
    const Clearance& c = *near.least;
    std::cout << std::left << std::setw(24) << "smallest clearance" << std::right << std::setw(8)
              << std::setprecision(3) << c.distance << " m (axes " << c.axes << " m): " << near.name(c.rod_a)
              << " and " << near.name(c.rod_b) << " at " << c.t << " s of " << near.until << " s\n";
    if (c.overlapping > 0)
      std::cout << "  " << c.overlapping << (c.overlapping == 1 ? " pair" : " pairs")
                << " of rods that do not meet in a node pass through each other\n";
  }
  if (!near.why.empty()) std::cout << "  (" << near.why << ")\n";
}

void print_json(const Scene& scene, const Judged& judged, const NearRods& near) {
  const Model& model = judged.model;
  const Mobility& mobility = judged.mobility;
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
  json["smallest_singular_value"] = judged.smallest_singular_value;
  json["clearance"] = clearance_json(near);
  json["unique_rods"] = judged.unique_rods();
  json["not_unique"] = nlohmann::ordered_json::array();
  for (std::size_t r = 0; r < judged.names.size(); ++r)
    if (!judged.balance.determined[r]) json["not_unique"].push_back(judged.names[r]);
  json["self_stress"] = self_stress_json(judged);
  json["self_stress_listed"] = judged.balance.listed;
  std::cout << json.dump(2) << "\n";
}

void print_row(const char* name, Index value) {
  std::cout << std::left << std::setw(24) << name << std::right << std::setw(8) << value << "\n";
}

// A redundant member with those that it can be pre-stressed against.
void print_state(const Judged& judged, const SelfStress& state, int redundant) {
  constexpr std::size_t most = 4;
  std::string rods;
  std::size_t named = 0, more_rods = 0, others = 0;
  for (const auto& member : state.members) {
    if (member.row == redundant) continue;
    if (member.row < judged.first_rod())
      ++others;
    else if (named == most)
      ++more_rods;
    else
      rods += (named++ ? ", " : "") + judged.name(member.row);
  }
  std::string against = rods;
  if (more_rods > 0) against += " and " + std::to_string(more_rods) + " more";
  if (others > 0)
    against += (against.empty() ? "" : ", ") + std::to_string(others) + (rods.empty() ? " other" : "") +
               (others == 1 ? " constraint" : " constraints");
  std::cout << "  " << judged.name(redundant) << (against.empty() ? " alone" : " against " + against) << "\n";
}

// Last, since it may be long: the redundant members by name, where it is known with those that they share.
void print_forces(const Judged& judged) {
  constexpr std::size_t most = 8;
  const auto rods = static_cast<Index>(judged.model.structure.rod_copies.size());
  if (rods > 0) print_row("rods of unique force", judged.unique_rods());
  if (judged.model.structure.sectors > 1) std::cout << "  (among forces with the symmetry of the sector)\n";
  const auto& redundant = judged.mobility.redundant;
  print_row("states of self-stress", static_cast<Index>(redundant.size()));
  if (!judged.balance.listed) std::cout << "  (too large a structure to list their members)\n";
  for (std::size_t k = 0; k < std::min(most, redundant.size()); ++k)
    if (k < judged.balance.states.size())
      print_state(judged, judged.balance.states[k], judged.mobility.redundant_rows[k]);
    else
      std::cout << "  " << redundant[k] << "\n";
  if (redundant.size() > most)
    std::cout << "  and " << redundant.size() - most << " more: --json lists all\n";
}

void print_table(const Scene& scene, const Judged& judged, const NearRods& near) {
  const Model& model = judged.model;
  const Mobility& mobility = judged.mobility;
  std::cout << scene.name << ": " << scene.title << "\n";
  print_row("degrees of freedom", mobility.degrees_of_freedom);
  if (mobility.rigid_motions > 0) print_row("  as one rigid body", mobility.rigid_motions);
  print_row("redundant", static_cast<Index>(mobility.redundant.size()));
  print_row("nodes", static_cast<Index>(model.structure.node_copies.size()));
  print_row("rods", static_cast<Index>(model.structure.rod_copies.size()));
  print_row("coordinates", mobility.coordinates);
  print_row("solved coordinates", model.system.solved_coordinates());
  print_row("constraints", mobility.constraints);
  print_row("rank", mobility.rank);
  print_row("by Maxwell's count", mobility.count);
  if (!std::isnan(judged.smallest_singular_value))
    std::cout << std::left << std::setw(24) << "smallest singular value" << std::right << std::setw(8)
              << std::setprecision(3) << judged.smallest_singular_value << "\n";
  print_clearance(near);
  print_forces(judged);
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
  check_film_names(scene, model->structure);
  const VectorXd start = start_positions(model->structure);
  // Of rods that give, the mechanism is judged, and the forces that they share.
  Structure rods = rigid_twin(model->structure, start);
  System rows(rods, scene.solver.eliminate_linear);
  const Model mechanism{std::move(rods), std::move(rows)};
  Judged judged{mechanism, mobility_of(mechanism, arguments), 0, {}, mechanism.system.all_names()};
  judged.smallest_singular_value = smallest_singular_value(mechanism.system, start, judged.mobility.rank);
  judged.balance = force_balance(mechanism.system, start, judged.mobility, mechanism.structure.rods);
  for (const auto& note : model->structure.notes) std::cerr << "unfurl: warning: " << note << "\n";
  const InitialState at_start = initial_state(model->structure, model->system);
  const bool own = model->structure.kind == "custom";
  for (const std::string& warning : {own ? misfit_warning(model->system, start) : std::string(),
                                     velocity_warning(at_start, model->structure),
                                     scene.solver.tolerance > 0  // steps are found
                                         ? std::string()
                                         : elastic_step_warning(*model, at_start.state, scene.solver)})
    if (!warning.empty()) std::cerr << "unfurl: warning: " << warning << "\n";
  const NearRods near = near_rods(model, scene, arguments);
  if (arguments.json)
    print_json(scene, judged, near);
  else
    print_table(scene, judged, near);
  return exit_ok;
}

}  // namespace unfurl
