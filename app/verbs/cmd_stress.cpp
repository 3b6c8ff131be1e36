// SPDX-License-Identifier: BSD-3-Clause
// unfurl stress SCENE -o DIR: stability at the extremes.
#include "app/command.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/receipt.hpp"
#include "app/verbs/scene_run.hpp"
#include "app/verbs/study_session.hpp"
#include "app/verbs/team_work.hpp"
#include "core/scene/library.hpp"
#include "core/scene/write.hpp"
#include "core/study/reference.hpp"
#include "core/study/stress.hpp"
#include "render/plot/figures/stress_figures.hpp"

namespace unfurl {

namespace {

void explain(const StressPlan& plan, const Stress& stress, Report& report) {
  Table criteria{{"verdict", "criterion"}, {}};
  for (const Verdict v : verdicts()) criteria.rows.push_back({std::string(to_string(v)), criterion(v)});
  report.paragraph(
      "Every cell is one run over the whole motion (to 99 % of the deployment time where there is one), in " +
      std::to_string(plan.steps.front()) + " to " + std::to_string(plan.steps.back()) +
      " steps. The first criterion that applies from the table's end upwards decides it. A step that fails "
      "is repeated in 2 to 64 parts, which can make a coarse run better than its step.");
  report.add(std::move(criteria));
  report.heading("Summary");
  report.add(summary_table(plan, stress), "Cells by verdict.");
  for (const auto& note : stress.notes) report.paragraph("No reference, left out: " + as_plain(note));
}

void add_long_runs(const Stress& stress, Report& report) {
  Table table{{"setting", "steps", "end", "energy error (relative)", "constraint error (relative)"}, {}};
  for (const LongRun& run : stress.long_runs)
    table.rows.push_back({run.setting, std::to_string(run.steps), run.end,
                          run.energy_error.empty() ? "" : short_number(run.energy_error.back()),
                          run.constraint.empty() ? "" : short_number(run.constraint.back())});
  report.heading("Very many steps");
  report.add(std::move(table), "Largest errors up to the last step.");
}

}  // namespace

int cmd_stress(const Arguments& arguments) {
  const SceneSource source = scene_source(find_scene(arguments.names.front()), arguments.overrides);
  const Scene scene = source.read();
  receipt_scene(scene.name, scene_text(scene, IdleValues::written));
  warn_of_own_steps(scene);
  const StressPlan plan = plan_stress(source, arguments.study.extremes);
  const InterruptGuard guard;
  StudySession session(arguments, "stressing", study_identity("An atlas", scene), "stress.csv");
  const auto team = join_team(arguments, session);
  std::optional<Worked<Stress>> found;
  {
    const StudyHooks hooks = session.hooks();
    Journal journal(team ? team->journal() : session.journal(), stress_columns(), stress_key_columns,
                    stress_number_columns(), is_stress_cell, session.room_for_first());
    found = alone_or_joined(
        team.get(), arguments, journal, hooks,
        [&](Journal& all, const StudyHooks& own) { return run_stress(plan, all, own); },
        [](const Stress& result) { return result.complete; });
  }
  if (!found) return nothing_to_write(arguments);
  const Stress& stress = found->result;
  if (stress.complete && stress.cells.empty() && !stress.notes.empty())
    throw ReferenceError("none of the extremes has a reference; the first is " + stress.notes.front());
  if (!found->writes) {
    print_rows(arguments, true, cells_table(stress));
    return exit_ok;
  }
  if (stress.complete && arguments.study.extremes.empty())
    session.write("stress.csv", csv_text(cells_table(stress)));
  Report report{"Stability at the extremes: " + scene.title};
  explain(plan, stress, report);
  report.heading("Atlas");
  for (const Figure& figure : atlas_figures(plan, stress, scene.title))
    report.picture(session.write(figure), as_plain(figure.title));
  if (!stress.long_runs.empty()) {
    add_long_runs(stress, report);
    report.picture(session.write(long_run_figure(stress, scene.title)), "Errors over very many steps.");
  }
  session.write("stress.md", report_markdown(report));
  results_written(team.get());
  print_rows(arguments, stress.complete, cells_table(stress));
  const std::size_t left_out = stress.notes.size();
  return finish(stress.complete, arguments,
                std::to_string(stress.cells.size()) + " cells" +
                    (left_out == 0 ? ""
                                   : "; values of extremes left out, as they have no reference: " +
                                         std::to_string(left_out) + ", stress.md says why"));
}

}  // namespace unfurl
