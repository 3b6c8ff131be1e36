// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/study_job.hpp"

#include <algorithm>
#include <utility>

#include "core/scene/build.hpp"
#include "core/scene/write.hpp"
#include "core/study/sweep.hpp"
#include "render/plot/figures/study_figures.hpp"
#include "render/plot/figures/sweep_figures.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {

namespace {

// The last panel of the command line's figure is the key to the others; a pane has room for one with both.
Figure for_pane(Figure figure) {
  Panel& first = figure.panels.front();
  const Panel& key = figure.panels.back();
  std::size_t i = 0;
  for (Curve& curve : first.curves)
    if (curve.marker != Marker::none && i < key.curves.size()) curve.label = key.curves[i++].label;
  figure.panels.resize(1);
  figure.columns = figure.rows = 1;
  return figure;
}

void study_precision(const StudyHooks& hooks, StudyOutcome& out) {
  const StudyRequest& request = out.request;
  const Scene scene = read_document(out.document);
  StudyPlan plan =
      plan_study(build_model(scene), scene.solver, request.largest_step, request.smallest_step, hooks);
  keep_methods(plan, request.methods);
  plan.timing = {3, 0.3, 10.0};  // a person waits
  Journal journal({}, study_columns(), study_key_columns);
  auto measured = std::make_shared<const Study>(run_study(plan, journal, hooks));
  const Study& study = *measured;
  const bool any =
      std::any_of(study.curves.begin(), study.curves.end(), [](const auto& c) { return !c.runs.empty(); });
  if (!any) throw Cancelled();
  out.figures = {for_pane(work_precision_figure(study, scene.title))};
  out.sentence = cheapest_sentence(study);
  if (!study.complete) out.sentence += " (Cancelled: of the points so far.)";
  out.study = std::move(measured);
  out.motion = motion_of(scene);
}

std::string axis_text(const StudyRequest& request) {
  return request.key + "=" + toml_value(request.from) + ":" + toml_value(request.to) + ":" +
         std::to_string(request.count);
}

void study_sweep(const StudyHooks& hooks, StudyOutcome& out) {
  const SceneDocument& d = out.document;
  SweepPlan plan{{d.name, overrides_of(d), d.text, d.folder}, {parse_axis(axis_text(out.request))}, {}, {}};
  plan.measures.push_back(find_measure(out.request.measure));
  check_plan(plan);
  for (const auto* end : {&plan.axes[0].values.front(), &plan.axes[0].values.back()})
    plan.source.read({plan.axes[0].key + "=" + *end});  // what is wrong with them is said before it runs
  Journal journal({}, plan.columns(), plan.axes.size());
  const Sweep sweep = run_sweep(plan, journal, hooks);
  if (sweep.table.rows.empty()) throw Cancelled();
  out.figures = sweep_figures(plan, sweep, read_document(d).title);
  const std::size_t measured = plan.axes.size() + 1;  // behind it may stand whether it is unique
  double low = 0, high = 0;
  std::string at_low, at_high;
  for (const auto& row : sweep.table.rows) {
    const double value = number_of(row[measured]);
    if (!(value == value)) continue;
    if (at_low.empty() || value < low) low = value, at_low = row.front();
    if (at_high.empty() || value > high) high = value, at_high = row.front();
  }
  out.sentence = at_low.empty()
                     ? "No run has this measure."
                     : plan.measures[0].label + ": from " + plot::format_number(low, 4) + " (at " + at_low +
                           ") to " + plot::format_number(high, 4) + " (at " + at_high + ").";
  if (!sweep.missing.empty()) out.sentence += " (Cancelled: of the points so far.)";
}

}  // namespace

std::string study_command(const StudyRequest& request, const SceneDocument& document) {
  if (request.kind == StudyRequest::Kind::sweep)
    return command_line(document, "sweep", "sweep") + " --vary " + shell_word(axis_text(request)) +
           " --measure " + shell_word(request.measure);
  std::string line = command_line(document, "study", "study"), names;
  if (request.largest_step > 0)
    line += " --steps " + toml_value(request.largest_step) + ":" + toml_value(request.smallest_step);
  for (const std::string& name : request.methods) names += (names.empty() ? "" : ",") + name;
  return names.empty() ? line : line + " --methods " + names;
}

namespace {

std::shared_ptr<const StudyOutcome> outcome_of_study(const std::pair<StudyRequest, SceneDocument>& asked,
                                                     const StudyJob::Task& task) {
  const auto& [request, document] = asked;
  auto out = std::make_shared<StudyOutcome>(StudyOutcome{request, document, {}, "", "", nullptr, nullptr});
  StudyHooks hooks;
  hooks.progress = [&task](double fraction) { task.progress(fraction); };
  hooks.cancelled = [&task] { return task.stopped(); };
  try {
    (request.kind == StudyRequest::Kind::sweep ? study_sweep : study_precision)(hooks, *out);
  } catch (const Cancelled&) {
    out->message = "cancelled before there was anything to show";
  } catch (const std::exception& error) {
    out->message = error.what();
  }
  return out;
}

}  // namespace

StudyJob::StudyJob(std::function<void()> wake) : Worker(outcome_of_study, std::move(wake)) {}

}  // namespace unfurl
