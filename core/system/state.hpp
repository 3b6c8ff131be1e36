// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/math/types.hpp"

namespace unfurl {

// A point of a trajectory in the coordinates that are solved for (System says how they map to nodes).
struct State {
  double t = 0.0;   // [s]
  VectorXd z;       // solved coordinates [m]
  VectorXd w;       // their rates [m/s]
  VectorXd lambda;  // multipliers of the kept constraints [N]; warm start of the next step
  // Of the rods that give, where a step does not resolve their waves: the axial forces of the method's stages
  // at the state, which its coordinates do not tell then; empty: they do [N].
  VectorXd tension = {};
  // Beside them what waves that the step does not resolve may change of each [N]; empty or 0: nothing.
  VectorXd tension_error = {};
  VectorXd angles =
      {};  // FollowedAngles (measure.hpp), counted on from turn to turn [rad]; none: those at t = 0
  // The axial forces at the Gauss points of the step that ended here [rods that give x points], where the
  // step had them as unknowns and powers depend on them; empty: lengths tell [N]. Below them, where drives
  // work beside other forces whose waves the step does not resolve, the multipliers of the constraints.
  MatrixXd stage_tension = {};
};

enum class StepStatus { converged, stalled, diverged, not_finite };

// What one step did. A Newton iteration that fails is data, not an exception.
struct StepReport {
  StepStatus status = StepStatus::converged;
  int newton_iterations = 0;
  int factorisations = 0;
  int right_hand_sides = 0;      // linear solves
  double residual = 0.0;         // last momentum residual, relative
  double constraint_norm = 0.0;  // max |Phi| at the step's end, rows in metres
  // The state is a located event at a singular pose; its multipliers are extrapolated from solved states, and
  // cannot be had from the equations there.
  bool singular_event = false;
  // The pose at its end is so near to a singular one that what rounding leaves of it is told as a velocity.
  bool weak_end = false;
  // Redundant rows have been seen to contradict each other beside the constraints (StageAccelerations).
  bool contradictions = false;
  bool ok() const { return status == StepStatus::converged; }
};

}  // namespace unfurl
