// unfurl study SCENE -o DIR: speed against accuracy.
#include "app/command.hpp"
#include "app/interrupt.hpp"
#include "app/scene_run.hpp"
#include "app/study_session.hpp"
#include "core/scene/build.hpp"
#include "core/scene/write.hpp"
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
                   (study.early ? ", shortly before the deployed pose, which is singular" : "") +
                   ". The reference: " + study.reference + "; its last two solutions agree to " +
                   short_number(study.reference_uncertainty) +
                   " m. CPU times are medians of runs that had the machine's "
                   "core to themselves; smallest and largest are in `study.csv`.");
  report.heading("Observed orders");
  report.add(orders_table(study));
  report.heading("Figures");
  for (const auto& picture : pictures) report.picture(picture, picture);
  return report;
}

}  // namespace

int cmd_study(const Arguments& arguments) {
  const Range range = step_range(arguments.study.ladder);
  const Scene scene = scene_of(arguments);
  auto model = build_model(scene);
  const InterruptGuard guard;
  StudySession session(arguments, "measuring", scene_text(scene), "study.csv");
  const StudyHooks hooks = session.hooks();
  StudyPlan plan =
      as_usage([&] { return plan_study(std::move(model), scene.solver, range.from, range.to, hooks); });
  if (arguments.study.repeats > 0) plan.timing.repeats = arguments.study.repeats;
  Study study;
  {
    Journal journal(session.journal(), study_columns(), study_key_columns);
    study = run_study(plan, journal, hooks);
  }
  if (study.complete) session.write("study.csv", csv_text(points_table(study)));
  std::vector<std::string> pictures;
  for (const Figure& figure :
       {work_precision_figure(study, scene.title), convergence_figure(study, scene.title)})
    pictures.push_back(session.write(figure));
  session.write("study.md", report_markdown(study_report(study, scene, pictures)));
  return finish(study.complete, arguments, cheapest_sentence(study));
}

}  // namespace unfurl
