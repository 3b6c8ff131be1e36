// SPDX-License-Identifier: BSD-3-Clause
// What a run shows about itself, as series over its accepted steps. One function and one row per diagnostic.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
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

struct PeakInMotion {
  double value = std::numeric_limits<double>::quiet_NaN();  // NaN: there is none
  double t = std::numeric_limits<double>::quiet_NaN();      // [s], of a state or within a step
  // False: it rises towards a time beside rise_t as 1 / (time left), as forces do where a singular pose is
  // passed; where that is the largest yet, the value is that of the nearest pose that was looked at, at
  // rise_t.
  bool bounded = true;
  double rise_t = std::numeric_limits<double>::quiet_NaN();  // [s]
};

// What was found within a step of a run of which only some states are left (run_digest.hpp).
struct FoundWithin {
  std::string column;  // or "peak_speed"
  bool largest = true;
  PeakInMotion peak = {};
  VectorXd rod_forces = {};  // [N] then, of rods' columns
};

struct Diagnostics {
  std::vector<double> t;        // [s], one entry per state
  std::vector<Series> columns;  // in the table's order; each as long as t
  std::size_t left_open = 0;    // states at the end that were not looked at: NaN
  // [states x rods of the solved model], tension positive [N]. A rod's multiplier is by virtual work the mean
  // of its axial force over its length: one with mass carries more at one end than at the other.
  MatrixXd axial_force;
  // The same shape: whether the rigid model determines that force (force_uniqueness.hpp).
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> force_unique;
  std::vector<char> rod_unique;  // per rod of the solved model: at every pose that is not singular
  // The same: whether it is shown. Largest and smallest forces are those of such rods; empty: all are.
  std::vector<char> rod_shown;
  std::vector<FoundWithin> found = {};              // larger, or smaller, than what any state has
  const Series* find(std::string_view name) const;  // nullptr where the scene has no such column
  const Series& at(std::string_view name) const;    // throws std::out_of_range
  // Whether what is unique was looked for; else the columns that would say it are NaN.
  bool unique_known() const {
    const Series* unique = find("axial_force_max_unique");
    return !unique || unique->values.empty() || !std::isnan(unique->values.front());
  }
  bool whole() const { return left_open == 0 && unique_known(); }
  bool shows(Index rod) const { return rod_shown.empty() || rod_shown[static_cast<std::size_t>(rod)] != 0; }
};

struct SolvedPoint;
struct EnergyFlow;
class DiagnosisAhead;

// What is known of a run before its diagnosis; the same bits come of it.
struct KnownAhead {
  const std::vector<SolvedPoint>* forces = nullptr;  // at its first states
  const EnergyFlow* flow = nullptr;                  // at all of them
  // Sees to it that the run's events name its singular poses: called once, where forces that may not be
  // unique are asked for. Empty: they do.
  std::function<void()> name_poses = {};
  DiagnosisAhead* judged = nullptr;  // its first states, by these forces and this flow
};

// Column names: kinetic_energy_J potential_energy_J work_J energy_balance_J constraint_max_m
// constraint_relative_max constraint_round_off_max constraint_velocity_max_m_s axial_force_max_N
// axial_force_min_N step_s newton_iterations axial_force_max_unique axial_force_min_unique (1: the rod has no
// other force); where a scene has such, fold_angle_rad fold_rate_rad_s deployed_fraction, dissipated_J
// drive_work_J impact_loss_J, axial_stress_max_Pa axial_stress_min_Pa stress_ratio_max buckling_ratio_max (a
// modulus), latch_force_max_N latch_torque_max_N_m; of drives NAME.angle_rad NAME.torque_N_m NAME.power_W
// NAME.torque_unique (or NAME.value_m NAME.force_N ...); the structure's own lengths and poisson_ratio.
// `cancelled` is asked before every state and before what is unique is looked for: once it says so, the rest
// stays NaN.
Diagnostics diagnose(const Simulation& run, const std::function<bool()>& cancelled = {},
                     const KnownAhead& ahead = {});

// Names of all columns that a scene may have.
std::vector<std::string_view> diagnostic_names();

}  // namespace unfurl
