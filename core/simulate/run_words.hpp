// SPDX-License-Identifier: BSD-3-Clause
// What a run says of itself.
#pragma once

#include <cstdio>
#include <string>

#include "core/integrators/integrator.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Why a step has no answer.
inline const char* reason(StepStatus status) {
  switch (status) {
    case StepStatus::converged:
      return "converged";
    case StepStatus::stalled:
      return "the Newton iteration did not converge to round-off";
    case StepStatus::diverged:
      return "the Newton matrix could not be factorised";
    case StepStatus::not_finite:
      return "the state is not finite any more";
  }
  return "";
}

// "; ..." behind what ended a run at a state: a drive that moves on where the structure is latched, drives
// that cannot all be followed, or a hinge that its dry friction locks, with what to do; else, of what ended
// in a step of this size, another step. `step`: 0 where none ended it. May be empty.
std::string cure(const Model& model, const State& state, bool latched, double step);

// The same where a stop was met in a pose with more ways to move than elsewhere.
inline const std::string beside_a_stop =
    "; in this pose the structure has other ways to move, and rigid rods do not say which it takes when a "
    "stop throws it back: place the stop before it";

// "0.125 s"
inline std::string seconds(double t) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g s", t);
  return text;
}

}  // namespace unfurl
