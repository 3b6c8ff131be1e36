// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/scene_objective.hpp"

#include <limits>
#include <utility>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/ending.hpp"
#include "core/path/path.hpp"
#include "core/scene/build.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/study/reference.hpp"
#include "core/study/table.hpp"
#include "core/study/tolerance.hpp"

namespace unfurl {

SceneObjective::SceneObjective(SceneSource source, std::string key, RunMeasure measure, SimulationHooks hooks)
    : source_(std::move(source)),
      key_(std::move(key)),
      measure_(std::move(measure)),
      hooks_(std::move(hooks)) {}

double SceneObjective::at(double x) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  try {
    const Scene scene = source_.read({key_ + "=" + exact_number(x)});
    Simulation run = simulate_as_asked(build_model(scene), study_solver(scene, {key_}, {measure_}), hooks_);
    if (run.status == RunStatus::stopped) throw Cancelled();
    if (may_have_no_bound(measure_.name)) record_singular_poses(run);
    const Diagnostics diagnostics = judge(run);
    if (run.status == RunStatus::failed) {
      none_[x] = run.message;
      return none;
    }
    Told& told = told_[x];
    told.warnings = warnings_of(run, diagnostics);
    told.note = ending_note(run, diagnostics);
    if (const std::string flag = uniqueness_of(measure_.name); !flag.empty())
      told.unique = find_measure(flag).value(run, diagnostics) != 0.0;
    return measure_.value(run, diagnostics);
  } catch (const SceneError& error) {
    none_[x] = error.problems().front().message;
  } catch (const PathRefused& refused) {  // solver.model = "path"
    none_[x] = refused.what();
  }
  return none;
}

std::string SceneObjective::why_none(double x) const {
  const auto at = none_.find(x);
  return at == none_.end() ? std::string() : at->second;
}

std::vector<std::string> SceneObjective::warnings(double x) const {
  const auto at = told_.find(x);
  return at == told_.end() ? std::vector<std::string>() : at->second.warnings;
}

std::optional<bool> SceneObjective::unique(double x) const {
  const auto at = told_.find(x);
  return at == told_.end() ? std::nullopt : at->second.unique;
}

std::string SceneObjective::note(double x) const {
  const auto at = told_.find(x);
  return at == told_.end() ? std::string() : at->second.note;
}

}  // namespace unfurl
