// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/scene/build.hpp"
#include "core/simulate/one_sided.hpp"
#include "core/study/stress.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

std::string_view to_string(Verdict verdict) {
  constexpr std::array names{"solver failed", "too slow", "constraint lost", "energy growth", "wrong branch",
                             "inaccurate",    "right"};
  return names[static_cast<std::size_t>(verdict)];
}

std::span<const Verdict> verdicts() {
  static constexpr std::array all{Verdict::right,         Verdict::inaccurate,      Verdict::wrong_branch,
                                  Verdict::energy_growth, Verdict::constraint_lost, Verdict::solver_failed,
                                  Verdict::too_slow};
  return all;
}

std::string criterion(Verdict verdict) {
  const StressLimits limits;
  switch (verdict) {
    case Verdict::solver_failed:
      return "the solver stops and says so (Newton iteration or factorisation)";
    case Verdict::too_slow:
      return "no end within " + short_number(limits.seconds) + " s of CPU time";
    case Verdict::constraint_lost:
      return "a constraint is off by more than " + short_number(100 * limits.constraint) +
             " % of a rod's length";
    case Verdict::energy_growth:
      return "the energy balance is off by more than " + short_number(100 * limits.energy) +
             " % of the energy turned over";
    case Verdict::wrong_branch:
      return "a node is off by more than " + short_number(100 * limits.branch) + " % of the structure's size";
    case Verdict::inaccurate:
      return "a node is off by more than " + short_number(100 * limits.right) + " % of the structure's size";
    case Verdict::right:
      return "none of these";
  }
  return "";
}

StressPlan plan_stress(const SceneSource& source, const std::vector<std::string>& names) {
  StressPlan plan;
  plan.source = source;
  std::vector<std::string_view> known;
  for (const ExtremeKind& kind : extreme_kinds()) {
    known.push_back(kind.name);
    if (!names.empty() && std::find(names.begin(), names.end(), kind.name) == names.end()) continue;
    auto extreme = kind.make(source);
    if (extreme)
      plan.extremes.push_back(std::move(*extreme));
    else if (!names.empty())
      throw StudyError("the scene cannot be driven to the extreme " + in_quotes(kind.name));
  }
  for (const auto& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw StudyError("no extreme " + in_quotes(name) + did_you_mean(name, known));
  if (plan.extremes.empty()) throw StudyError("the scene has nothing that can be driven to an extreme");
  const Scene scene = source.read();
  for (Setting& setting : study_settings(scene.solver))
    if (!setting.name.ends_with("s=3") && !setting.name.ends_with("s=5") && !setting.name.ends_with("s=6"))
      plan.settings.push_back(std::move(setting));
  const double own = std::clamp(scene.solver.end_time / scene.solver.step, 128.0, 4096.0);
  for (int level = -5; level <= 2; ++level) plan.steps.push_back(1L << (std::lround(std::log2(own)) + level));
  // Very many steps are those of the method by itself, which knows nothing that is one-sided.
  if (const Structure structure = build_structure(scene);
      structure.deployment.empty() && OneSided(structure, scene.solver).empty())
    plan.long_steps = 1'000'000;
  return plan;
}

}  // namespace unfurl
