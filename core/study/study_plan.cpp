// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/books.hpp"
#include "core/integrators/integrator.hpp"
#include "core/study/reference_motion.hpp"
#include "core/study/study.hpp"
#include "core/study/table.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {
namespace {

constexpr int max_levels = 14;
constexpr double ladder_steps = 1e7, ladder_times = 1e5;  // of a run; at which errors are compared

SolverOptions with(SolverOptions o, int stages, const char* nodes, const char* constraints_at) {
  o.stages = stages;
  o.nodes = nodes;
  o.constraints_at = constraints_at;
  return o;
}

// The motion as the scene runs it or, where that cannot be trusted, with smaller steps: that a step is too
// large is what a study is asked about.
Simulation trusted_probe(const std::shared_ptr<const Model>& model, SolverOptions options,
                         const StudyHooks& hooks) {
  SimulationHooks probing;
  probing.cancelled = hooks.cancelled;
  std::string why;
  for (int tries = 0; tries < 3; ++tries, options.step /= 4) {
    Simulation probe = simulate(model, options, probing);
    if (probe.status == RunStatus::stopped) throw Cancelled();
    const std::string doubt =
        probe.status == RunStatus::failed ? probe.message : mistrust(probe, diagnose_books(probe));
    if (doubt.empty()) return probe;
    if (why.empty()) why = doubt;
  }
  throw ReferenceError("the scene as it stands does not run (" + why +
                       "); a study needs a motion to measure");
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

double largest_step(double scene_step, double given) {
  return given > 0 ? given : 8 * scene_step;
}

StepLadder make_ladder(double end, double scene_step, double largest, double smallest) {
  const bool given = largest > 0;
  largest = largest_step(scene_step, largest);
  if (!given) smallest = scene_step / 16;
  if (!(smallest > 0) || !(largest > smallest))
    throw StudyError("a ladder of steps falls from a larger to a smaller step, both > 0 s");
  if (!(2 * smallest <= largest))
    throw StudyError("a ladder of steps is halved at least once: the smallest step must be at most " +
                     short_number(largest / 2) + " s");
  if (given && largest > end / 4)
    throw StudyError("the largest step must fit four times into the motion of " + short_number(end, 6) +
                     " s: it is at most " + short_number(end / 4) + " s");
  const double levels = std::log2(largest / smallest);
  if (levels > max_levels)
    throw StudyError("a ladder spans at most a factor of " + std::to_string(1L << max_levels) +
                     " in the step");
  if (!(end / smallest <= ladder_steps))
    throw StudyError("the smallest step of " + short_number(smallest) +
                     " s makes more than 1e7 steps of the motion of " + short_number(end, 6) +
                     " s; the least is " + short_number(end / ladder_steps) + " s");
  if (!(end / largest <= 2 * ladder_times))
    throw StudyError("the largest step of " + short_number(largest) + " s is too small for the motion of " +
                     short_number(end, 6) +
                     " s: errors are compared at every second of its steps, at most 1e5; the least is " +
                     short_number(end / (2 * ladder_times)) + " s");
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
  const Simulation probe = trusted_probe(model, scene, hooks);
  StudyPlan plan;
  require_plain_start(probe);
  const JudgedSpan span = judged_span(probe);
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
    if (!find_method(name)) throw StudyError("no method " + in_quotes(name) + did_you_mean(name, known));
  if (names.empty()) return;
  std::erase_if(plan.settings, [&](const Setting& setting) {
    return std::find(names.begin(), names.end(), setting.options.method) == names.end();
  });
}

}  // namespace unfurl
