// What a run shows about itself, as series over its accepted steps. One function and one row per diagnostic.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/simulate/simulation.hpp"

namespace unfurl {

// One column: `name` carries the unit as a suffix ("kinetic_energy_J") and is the CSV header.
struct Series {
  std::string name;
  std::string label;  // for axes and legends: "kinetic energy"
  std::string unit;   // "J"; empty: a pure number
  std::vector<double> values;
};

struct Diagnostics {
  std::vector<double> t;        // [s], one entry per state
  std::vector<Series> columns;  // in the table's order; each as long as t
  MatrixXd axial_force;         // [states x rods of the solved model], tension positive [N]
  const Series* find(std::string_view name) const;  // nullptr where the scene has no such column
  const Series& at(std::string_view name) const;    // throws std::out_of_range
};

// Column names: kinetic_energy_J potential_energy_J work_J energy_balance_J constraint_max_m
// constraint_relative_max constraint_round_off_max constraint_velocity_max_m_s fold_angle_rad fold_rate_rad_s
// deployed_fraction axial_force_max_N axial_force_min_N step_s newton_iterations; fold columns only where the
// structure has a fold angle. Then the structure's own lengths and, where it names strains, poisson_ratio.
Diagnostics diagnose(const Simulation& run);

// Names of all columns that a scene may have.
std::vector<std::string_view> diagnostic_names();

}  // namespace unfurl
