// SPDX-License-Identifier: BSD-3-Clause
// unfurl reproduce -o DIR: the paper's tables and figures, beside ours; with --validation published
// benchmarks.
#include <iostream>

#include "app/command.hpp"
#include "app/output/interrupt.hpp"
#include "app/verbs/reproduce_file.hpp"
#include "app/verbs/study_session.hpp"
#include "core/study/reproduce_report.hpp"
#include "core/study/validation.hpp"
#include "render/plot/figures/reproduce_figures.hpp"

namespace unfurl {

namespace {

int reproduce_validation(const Arguments& arguments) {
  StudySession session(arguments, "validating", "", "validation.csv");
  std::vector<ValidationRow> rows;
  try {
    rows = validate(session.hooks());
  } catch (const Cancelled&) {
    std::cerr << "unfurl: interrupted before there was anything to write\n";
    return exit_interrupted;
  }
  const Table table = validation_table(rows);
  const std::string text =
      markdown_text(table) + "\nWhat a scene cannot say yet:\n\n" + markdown_text(not_expressible_table());
  session.write("validation.csv", csv_text(table));
  session.write("validation.md", text);
  print_rows(arguments, true, table);
  if (!arguments.quiet && !arguments.json) std::cout << text;
  bool all = true;
  for (const ValidationRow& row : rows) {
    all = all && row.holds();
    if (!row.holds()) std::cerr << "unfurl: does not hold: " << row.problem << ", " << row.quantity << "\n";
  }
  const int code = finish(true, arguments, "");
  return all ? code : exit_verification_failed;
}

}  // namespace

int cmd_reproduce(const Arguments& arguments) {
  if (!arguments.names.empty() && arguments.json)
    throw UsageError(
        "--json is for unfurl reproduce -o DIR; unfurl verify FILE --json says whether a file is as it was");
  if (!arguments.names.empty()) return reproduce_file(arguments);
  if (arguments.output.empty()) throw UsageError("-o is missing; usage: unfurl reproduce -o DIR, or FILE");
  if (!arguments.exports.empty())
    throw UsageError("--export is for unfurl reproduce FILE; unfurl run SCENE --export exports a run");
  const InterruptGuard guard;
  if (arguments.study.validation) return reproduce_validation(arguments);
  StudySession session(arguments, "reproducing", "", "runs.csv");
  Reproduction r;
  try {
    r = reproduce_paper(session.hooks());
  } catch (const Cancelled&) {
    std::cerr << "unfurl: interrupted before there was anything to write\n";
    return exit_interrupted;
  }
  session.write("runs.csv", csv_text(runs_table(r)));
  const ReproductionPictures pictures{session.write(reproduced_poses_figure(r)),
                                      session.write(reproduced_constraint_figure(r)),
                                      session.write(reproduced_trajectory_figure(r))};
  const Report report = reproduction_report(r, pictures);
  session.write("report.md", report_markdown(report));
  session.write("report.html", report_html(report, session.directory()));
  for (const Check& check : r.checks)
    if (!check.holds)
      std::cerr << "unfurl: does not hold: " << check.claim << "; found " << check.found << "\n";
  print_rows(arguments, true, runs_table(r));
  const int code = finish(true, arguments, "");
  return r.verified() ? code : exit_verification_failed;
}

}  // namespace unfurl
