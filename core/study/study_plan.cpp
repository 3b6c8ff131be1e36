#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/integrators/integrator.hpp"
#include "core/model/nearest_name.hpp"
#include "core/study/reference_motion.hpp"
#include "core/study/study.hpp"

namespace unfurl {
namespace {

constexpr int max_levels = 14;

SolverOptions with(SolverOptions o, int stages, const char* nodes, const char* constraints_at) {
  o.stages = stages;
  o.nodes = nodes;
  o.constraints_at = constraints_at;
  return o;
}

}  // namespace

std::vector<Setting> study_settings(const SolverOptions& base) {
  std::vector<Setting> out;
  for (const Method& method : methods()) {
    SolverOptions own = base;
    own.method = method.name;
    own.adaptive = false;  // the ladder says the step
    own.tolerance = 0;
    const std::string name(method.name);
    const auto order = [&](const SolverOptions& o) { return method.claims(o).order; };
    const SolverOptions two = with(own, 2, "lobatto", "nodes"), printed = with(own, 3, "equidistant", "ends");
    if (order(two) == order(with(own, 4, "lobatto", "nodes"))) {
      out.push_back({name, own, order(own)});
      continue;
    }
    for (int s = 2; s <= 6; ++s) {
      const SolverOptions o = with(own, s, "lobatto", "nodes");
      out.push_back({name + " s=" + std::to_string(s), o, order(o)});
    }
    if (order(printed) != order(with(own, 3, "lobatto", "nodes")))
      out.push_back({name + " s=3 as printed", printed, order(printed)});
  }
  return out;
}

StepLadder make_ladder(double end, double scene_step, double largest, double smallest) {
  const bool given = largest > 0;
  if (!given) {
    largest = 8 * scene_step;
    smallest = scene_step / 16;
  }
  if (!(smallest > 0) || !(largest > smallest))
    throw std::invalid_argument("a ladder of steps falls from a larger to a smaller step, both > 0 s");
  if (given && largest > end / 2)
    throw std::invalid_argument("the largest step must fit twice into the motion of " + std::to_string(end) +
                                " s");
  const double levels = std::log2(largest / smallest);
  if (levels > max_levels)
    throw std::invalid_argument("a ladder spans at most a factor of " + std::to_string(1L << max_levels) +
                                " in the step");
  StepLadder ladder;
  ladder.grid = std::max(2L, std::lround(end / largest / 2));
  const long finest = std::lround(end / smallest / static_cast<double>(ladder.grid));
  for (long n = 2; n <= std::max(finest * 7 / 5, 4L); n *= 2) {
    ladder.steps.push_back(n * ladder.grid);
    if (n * n <= finest * 2) ladder.steps.push_back(n / 2 * 3 * ladder.grid);
  }
  return ladder;
}

StudyPlan plan_study(std::shared_ptr<const Model> model, const SolverOptions& scene, double largest_step,
                     double smallest_step, const StudyHooks& hooks) {
  SimulationHooks probing;
  probing.cancelled = hooks.cancelled;
  const Simulation probe = simulate(model, scene, probing);
  if (probe.status == RunStatus::stopped) throw Cancelled();
  if (probe.status == RunStatus::failed)
    throw std::invalid_argument("the scene as it stands does not run (" + probe.message +
                                "); a study needs a motion to measure");
  StudyPlan plan;
  const JudgedSpan span = judged_span(probe);
  if (!(span.end > 0))
    throw std::invalid_argument("the motion begins at an end stop: there is nothing to measure");
  plan.end = span.end;
  plan.before = span.before;
  plan.settings = study_settings(scene);
  plan.ladder = make_ladder(plan.end, scene.step, largest_step, smallest_step);
  plan.model = std::move(model);
  return plan;
}

void keep_methods(StudyPlan& plan, const std::vector<std::string>& names) {
  std::vector<std::string_view> known;
  for (const Method& method : methods()) known.push_back(method.name);
  for (const std::string& name : names)
    if (!find_method(name))
      throw std::invalid_argument("no method " + in_quotes(name) + did_you_mean(name, known));
  if (names.empty()) return;
  std::erase_if(plan.settings, [&](const Setting& setting) {
    return std::find(names.begin(), names.end(), setting.options.method) == names.end();
  });
}

}  // namespace unfurl
