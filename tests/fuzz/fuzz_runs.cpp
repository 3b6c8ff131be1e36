// SPDX-License-Identifier: BSD-3-Clause
// From scene text to numbers: a dozen steps of whatever can be built, its diagnostics, its summary.
#include "tests/fuzz/fuzz.hpp"

#include "core/diagnostics/diagnostics.hpp"
#include "core/export/summary.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/scene_error.hpp"
#include "core/simulate/simulation.hpp"
#include "core/system/mobility.hpp"

using namespace unfurl;

namespace {

// A JSON text without its strings: names may hold anything.
std::string without_strings(const std::string& json) {
  std::string out;
  bool inside = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    if (inside && json[i] == '\\')
      ++i;
    else if (json[i] == '"')
      inside = !inside;
    else if (!inside)
      out += json[i];
  }
  return out;
}

}  // namespace

void unfurl::fuzz::try_text(std::string_view text) {
  if (large_structure(text)) return;
  try {
    Scene scene = read_scene_text(text, "fuzz.toml");
    scene.solver.end_time = std::min(scene.solver.end_time, 12 * scene.solver.step);
    scene.solver.tolerance = 0;
    const auto model = build_model(scene);
    int steps = 0;
    SimulationHooks hooks;
    hooks.cancelled = [&] { return ++steps > 200; };
    const Simulation run = simulate(model, scene.solver, hooks);
    const Diagnostics diagnostics = diagnose(run);
    const Mobility mobility = analyse_mobility(model->system, run.trajectory.node_positions(0));
    const std::string summary = summary_json("fuzz", run, diagnostics, mobility);
    require(run.status == RunStatus::failed || without_strings(summary).find("nan") == std::string::npos,
            "a number is a number");
  } catch (const SceneError&) {
  }
}
