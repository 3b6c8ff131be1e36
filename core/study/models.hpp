// SPDX-License-Identifier: BSD-3-Clause
// What each modelling choice of a scene costs and changes.
#pragma once

#include "core/study/journal.hpp"
#include "core/study/reference.hpp"
#include "core/study/scene_variation.hpp"
#include "core/study/table.hpp"

namespace unfurl {

struct ModelChoice {
  std::string name;                  // "sector: one sector solved, all shown"
  std::vector<std::string> changes;  // to the scene; empty: the scene as it stands
};

// The scene as it stands, then every choice that it allows and does not make: full or sector, linear
// constraints eliminated or kept, the path of one that can move in one way only, sparse or dense matrices,
// consistent or lumped mass, rigid rods or forces shared by their stiffness, rigid, quasi-static, elastic or
// bending rods, without damping.
std::vector<ModelChoice> model_choices(const SceneSource& source);

struct MeasuredModel {
  ModelChoice choice;
  std::string outcome;  // the run's status, or why there is none
  std::string message;  // why it failed; it has no answer then
  Index solved_coordinates = 0, constraints = 0;
  double cpu_median = 0, cpu_min = 0, cpu_max = 0;  // [s]
  double memory = 0;      // of the model and the solver, without the trajectory [bytes]
  double difference = 0;  // largest distance of a node from the scene as it stands, at the times of both [m]
  double tip_difference = 0;   // of the node that moves furthest, at the last time of both [m]
  double deployment_time = 0;  // NaN: none [s]
  double peak_force = 0;       // largest axial force of any rod; NaN: there is none [N]
  bool peak_unique = true;
  double cpu_forces = 0;  // of all columns and forces of the run [s]
};

// One after another, timed alone; last, what the single precision of the display changes. Throws Cancelled;
// SceneError where the scene itself is wrong.
std::vector<MeasuredModel> compare_models(const SceneSource& source, int repeats, const StudyHooks& hooks);
// The same; what the journal has is not measured again, what is measured and has an answer goes into it.
std::vector<MeasuredModel> compare_models(const SceneSource& source, int repeats, Journal& journal,
                                          const StudyHooks& hooks);

// Of the journal: its columns, of which the first is its key, those that are numbers, and whether a row of it
// can be of a measured model.
std::vector<std::string> models_columns();
std::vector<std::size_t> models_number_columns();
bool is_measured_model(const std::vector<std::string>& row);
Table models_table(const std::vector<MeasuredModel>& models);    // exact
Table models_summary(const std::vector<MeasuredModel>& models);  // for a person, with ratios to the first

}  // namespace unfurl
