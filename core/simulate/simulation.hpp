// SPDX-License-Identifier: BSD-3-Clause
// The one time loop: drives an integrator from a model's start to its end, with events, progress and cancel.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/integrators/solver_options.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

enum class RunStatus { completed, deployed, stopped, failed };  // stopped: cancelled by the user
std::string_view to_string(RunStatus status);

struct Event {
  std::string name;          // what happened: "deployed", "cable pulls", ...
  double t = 0.0;            // [s]
  double energy_lost = 0.0;  // in an impact [J]
  // At a singular pose, that of the Jacobian (singular_poses.hpp); NaN: not said.
  double singular_value = std::numeric_limits<double>::quiet_NaN();
  // "deployed", "latch", "singular_pose"; of what acts on one side only "contact", "free" (stops), "taut",
  // "slack" (cables), "stick", "slip", "reversal" (friction); and of which element.
  std::string kind = {}, element = {};
};

struct SimulationHooks {
  std::function<void(double fraction)> progress;  // of end_time, 0..1; called at most about 20 times a second
  std::function<bool()> cancelled;                // asked before every step
};

// What was solved for a run.
struct SolvedAs {
  std::string name;  // "full", "sector", "path"; empty: full, or sector where the structure is one
  std::string why;   // and not another
};

struct Simulation {
  Trajectory trajectory;
  RunStatus status = RunStatus::completed;
  std::string message = {};  // why it stopped or failed; empty otherwise
  std::vector<std::string> warnings = {};
  std::vector<Event> events = {};
  SolverOptions options = {};
  SolvedAs solved_as = {};
  // Estimated error of the node positions, from a second solution [m]; NaN: none was made
  // (study/tolerance.hpp).
  double position_estimate = std::numeric_limits<double>::quiet_NaN();
  long steps = 0;
  long newton_iterations = 0;
  long factorisations = 0;
  double cpu_s = 0.0;  // CPU time of the stepping loop
};

// The same filled in: a run of the time loop solves what its model holds.
SolvedAs solved_as(const Simulation& run);

// Throws std::invalid_argument on an unknown method; everything that goes wrong while stepping is in the
// result.
Simulation simulate(std::shared_ptr<const Model> model, const SolverOptions& options,
                    const SimulationHooks& hooks = {});

// What a run says before its first step: notes of the structure, velocities and rods that do not fit, steps
// that are too long for what is stiff. A Stepper leaves that to whom it steps for, and add_stretch(), too.
// `swing`: what adaptive steps followed behind it, of Stepper.
std::vector<std::string> start_warnings(const Model& model, const SolverOptions& options, double swing = 0);

double thread_cpu_seconds();  // of the calling thread so far: what cpu_s is a difference of

}  // namespace unfurl
