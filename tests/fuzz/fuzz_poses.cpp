// SPDX-License-Identifier: BSD-3-Clause
// What is said of a pose: the mobility of whatever can be built, its states of self-stress, its modes, its
// margins.
#include <algorithm>
#include <cmath>

#include "core/diagnostics/vibration.hpp"
#include "core/path/margin.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/system/mobility.hpp"
#include "core/system/self_stress.hpp"
#include "core/text/error.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace unfurl;

void unfurl::fuzz::try_text(std::string_view text) {
  if (large_structure(text)) return;
  try {
    Scene scene = read_scene_text(text, "fuzz.toml");
    scene.solver.end_time = std::min(scene.solver.end_time, 12 * scene.solver.step);
    const auto model = build_model(scene);
    const State start = initial_state(model->structure, model->system).state;
    VectorXd q(model->system.coordinates());
    model->system.expand(start.z, q);
    const Mobility mobility = analyse_mobility(model->system, q);
    require(mobility.rank <= mobility.constraints, "no more rows are independent than there are");
    for (const SelfStress& state : force_balance(model->system, q, mobility).states)
      for (const SelfStress::Member& member : state.members)
        require(std::abs(member.force) <= 1, "relative to the largest");
    const Vibration vibration = unfurl::vibration(*model, start);
    require(vibration.mechanism_motions <= static_cast<Index>(vibration.modes.size()), "motions are modes");
    for (const VibrationMode& mode : vibration.modes)
      require(std::isfinite(mode.frequency) && std::isfinite(mode.growth) && mode.shape.allFinite(),
              "a mode is finite");
    const Margin margin = margin_of(model, scene.solver);
    for (const StuckHinge& hinge :
         stuck_hinges(model, scene.solver, margin, margin.sources.size() < 4 ? 12 : 0))
      require(!std::isnan(hinge.stall_torque), "a torque is a number");
  } catch (const Error&) {
  }
}
