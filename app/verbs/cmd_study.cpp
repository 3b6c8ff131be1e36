// SPDX-License-Identifier: BSD-3-Clause
// unfurl study SCENE -o DIR: speed against accuracy.
#include <iostream>

#include "app/command.hpp"
#include "app/output/interrupt.hpp"
#include "app/verbs/scene_run.hpp"
#include "app/verbs/study_session.hpp"
#include "app/verbs/team_work.hpp"
#include "core/scene/library.hpp"
#include "core/scene/write.hpp"
#include "core/study/models.hpp"
#include "core/study/study.hpp"
#include "render/plot/figures/study_figures.hpp"

namespace unfurl {

namespace {

struct Range {
  double from = 0, to = 0;
};

Range step_range(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t colon = text.find(':');
  Range range;
  if (colon != std::string::npos)
    range = {number_of(std::string_view(text).substr(0, colon)),
             number_of(std::string_view(text).substr(colon + 1))};
  if (!(range.from > 0) || !(range.to > 0))
    throw UsageError("--steps is LARGEST:SMALLEST, two numbers of seconds; got '" + text + "'");
  return range;
}

Report study_report(const Study& study, const Scene& scene, const std::vector<std::string>& pictures) {
  Report report{"Speed against accuracy: " + scene.title};
  report.paragraph("**" + cheapest_sentence(study) + "**");
  report.paragraph("Errors are the largest distance of a node from the reference at " +
                   std::string("equally spaced times up to ") + short_number(study.end, 6) + " s" +
                   (study.before.empty() ? "" : ", shortly before " + as_plain(study.before)) +
                   ". The reference: " + study.reference + "; " + reference_words(study) +
                   ". CPU times are medians of runs that had the machine's "
                   "core to themselves; smallest and largest are in `study.csv`.");
  report.heading("Observed orders");
  report.add(orders_table(study));
  report.heading("Figures");
  for (const auto& picture : pictures) report.picture(picture, picture);
  return report;
}

// What --models has no use for.
void refuse_what_models_lack(const Arguments& arguments) {
  const auto refuse = [](bool given, const char* option) {
    if (given) throw UsageError(std::string(option) + " is not for --models; leave it out");
  };
  refuse(!arguments.study.ladder.empty(), "--steps");
  refuse(!arguments.study.methods.empty(), "--methods");
  refuse(arguments.join, "--join");
  refuse(!arguments.style.empty(), "--style");
  refuse(!arguments.font.empty(), "--font");
  refuse(arguments.dpi > 0, "--dpi");
}

int study_models(const Arguments& arguments) {
  refuse_what_models_lack(arguments);
  const SceneSource source = scene_source(find_scene(arguments.names.front()), arguments.overrides);
  const Scene scene = source.read();
  const InterruptGuard guard;
  const int repeats = arguments.study.repeats > 0 ? arguments.study.repeats : 5;
  const std::string asked = "A comparison of models with " + std::to_string(repeats) + " repeats";
  StudySession session(arguments, "measuring", study_identity(asked, scene), "models.csv");
  session.grows(session.journal());
  std::vector<MeasuredModel> models;
  try {
    Journal journal(session.journal(), models_columns(), 1, models_number_columns(), is_measured_model,
                    session.room_for_first());
    warn_of_damage(journal);
    models = compare_models(source, repeats, journal, session.hooks());
  } catch (const Cancelled&) {
    return finish(false, arguments, "");
  }
  session.write("models.csv", csv_text(models_table(models)));
  Report report{"What each modelling choice costs and changes: " + scene.title};
  report.paragraph(
      "The scene as it stands, and with one choice made otherwise at a time. CPU times are medians; the "
      "memory is that of the model and the solver; the difference is the largest distance of a node from "
      "where it is in the first row, over the whole motion.");
  report.add(models_summary(models));
  const std::string text = report_markdown(report);
  session.write("models.md", text);
  for (const MeasuredModel& model : models)
    if (model.outcome == "failed")
      std::cerr << "unfurl: warning: " << model.choice.name << ": failed: " << model.message << "\n";
  print_rows(arguments, true, models_table(models));
  const int code = finish(true, arguments, markdown_text(models_summary(models)));
  return models.front().outcome == "failed" ? exit_solver_failed : code;  // all others are compared with it
}

}  // namespace

int cmd_study(const Arguments& arguments) {
  if (arguments.study.models) return study_models(arguments);
  const Range range = step_range(arguments.study.ladder);
  const Scene scene = scene_of(arguments);
  warn_of_own_steps(scene);
  auto model = model_of(scene, arguments);
  const InterruptGuard guard;
  // What cannot be studied is told before anything is written.
  StudyHooks asking;
  asking.cancelled = interrupted;
  StudyPlan plan = plan_study(std::move(model), scene.solver, range.from, range.to, asking);
  keep_methods(plan, arguments.study.methods);
  const int repeats = arguments.study.repeats > 0 ? arguments.study.repeats : TimingOptions{}.repeats;
  // Errors of another largest step are of other times, and go into no curve with these.
  const std::string asked = "A study from steps of " +
                            exact_number(largest_step(scene.solver.step, range.from)) + " s with " +
                            std::to_string(repeats) + " repeats";
  StudySession session(arguments, "measuring", study_identity(asked, scene), "study.csv");
  const StudyHooks hooks = session.hooks();
  plan.timing.repeats = repeats;
  const auto team = join_team(arguments, session);
  Journal earlier({}, study_columns(), study_key_columns, study_number_columns(), is_study_point);
  session.require_asked(earlier, [&](const auto& row) { return asks_for(plan, row); });
  std::optional<Worked<Study>> found;
  {
    Journal journal(team ? team->journal() : session.journal(), study_columns(), study_key_columns,
                    study_number_columns(), is_study_point, session.room_for_first());
    found = alone_or_joined(
        team.get(), arguments, journal, hooks,
        [&](Journal& all, const StudyHooks& own) { return run_study(plan, all, own); },
        [](const Study& result) { return result.complete; });
  }
  if (!found) return nothing_to_write(arguments);
  const Study& study = found->result;
  if (!found->writes) {
    print_rows(arguments, true, points_table(study));
    return exit_ok;
  }
  if (study.complete) session.write("study.csv", csv_text(points_table(study)));
  std::vector<std::string> pictures;
  for (const Figure& figure :
       {work_precision_figure(study, scene.title), convergence_figure(study, scene.title)})
    pictures.push_back(session.write(figure));
  session.write("study.md", report_markdown(study_report(study, scene, pictures)));
  results_written(team.get());
  print_rows(arguments, study.complete, points_table(study));
  return finish(study.complete, arguments, cheapest_sentence(study));
}

}  // namespace unfurl
