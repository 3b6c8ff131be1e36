// SPDX-License-Identifier: BSD-3-Clause
// The pose about which a structure vibrates, and its modes by name: what `modes` and films of a mode share.
#pragma once

#include <memory>
#include <string>

#include "app/command.hpp"
#include "core/diagnostics/vibration.hpp"
#include "core/scene/scene.hpp"
#include "core/study/table.hpp"

namespace unfurl {

struct ModalPose {
  std::shared_ptr<const Model> model;  // holds what it belongs to
  std::shared_ptr<const Model> drawn;  // without stops, latches and frictions that hold at this pose
  State state;
  int code = 0;  // exit code: of a run that failed later on, which has been said, exit_solver_failed
};

// --at start, end, deployed or a time; the start where it is not given. The run that it is of is judged, and
// what it warns of said. Throws UsageError where the motion has no such time, NotFound where a run that
// failed does not get there, Interrupted.
ModalPose modal_pose(const Scene& scene, const Arguments& arguments);

// Throws UsageError where the structure is too large.
Vibration vibration_of(const ModalPose& pose);

std::string name_of(const VibrationMode& mode);  // "elastic", "mechanism, free"
Table modes_table(const Vibration& vibration);   // of modes.csv

}  // namespace unfurl
