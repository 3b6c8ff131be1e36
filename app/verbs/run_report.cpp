// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/run_report.hpp"

#include <cmath>

#include "app/output/command_line.hpp"
#include "app/output/receipt.hpp"
#include "app/own_options.hpp"
#include "app/verbs/scene_run.hpp"
#include "core/diagnostics/ending.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/export/atomic_file.hpp"
#include "core/export/formats.hpp"
#include "core/math/largest.hpp"
#include "core/scene/write.hpp"
#include "core/study/report.hpp"
#include "core/text/version.hpp"
#include "render/plot/figures.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_film = std::uintmax_t{32} << 20U;  // that a page should carry [bytes]

Table outcome_of(const Simulation& run, const Diagnostics& diagnostics) {
  Table table{{"of the run", ""}, {}};
  const auto row = [&](const std::string& name, const std::string& value) {
    table.rows.push_back({name, as_plain(value)});
  };
  const auto number = [](double x, const char* unit) { return short_number(x, 9) + unit; };
  row("ended", std::string(to_string(run.status)) + " at " + number(run.trajectory.end_time(), " s"));
  if (!run.message.empty()) row("because", run.message);
  const SolverOptions& solver = run.options;
  if (solved_as(run).name == "path")
    row("method", "along its path, states " + number(solver.step, " s") + " apart at most, " +
                      std::to_string(run.steps) + " of them");
  else
    row("method", solver.method +
                      (solver.method == "dvm" ? ", " + std::to_string(solver.stages) + " stages" : "") +
                      ", step " + number(solver.step, " s") + (solver.adaptive ? " at most" : "") + ", " +
                      std::to_string(run.steps) + " steps");
  const auto largest = [&](const char* column) {  // rounding mostly, of which three digits say all
    return short_number(largest_magnitude(diagnostics.at(column).values));
  };
  row("largest constraint error", largest("constraint_max_m") + " m");
  row("largest energy balance", largest("energy_balance_J") + " J");
  for (const Event& event : run.events) row("event", event.name + " at " + number(event.t, " s"));
  return table;
}

Table measures_of(const Simulation& run, const Diagnostics& diagnostics) {
  Table table{{"measure", "value", "unit", "meaning"}, {}};
  for (const NamedMeasure& measure : named_measures()) {
    const double value = measure.name == "cpu" ? std::nan("") : measure.value(run, diagnostics);
    if (!std::isfinite(value)) continue;
    table.rows.push_back({std::string(measure.name), short_number(value, 9), std::string(measure.unit),
                          std::string(measure.help)});
  }
  return table;
}

// The figures that were written, in the order of the list; their captions are in them.
void add_figures(const fs::path& directory, Report& report) {
  std::error_code error;
  for (const FigureKind& kind : figure_kinds()) {
    const std::string stem = "figures/" + std::string(kind.name);
    if (!fs::exists(directory / (stem + ".svg"), error)) continue;
    report.picture(stem + ".svg", std::string(kind.help));
  }
}

}  // namespace

void write_run_report(const fs::path& directory, const Scene& scene, const Simulation& run,
                      const Diagnostics& diagnostics, const Arguments& arguments) {
  Report report{scene.title};
  report.paragraph("Made by unfurl " + version() + " with " +
                   as_code(as_typed(command_of_result(arguments.words, place_of_first_name(arguments.words),
                                                      scene.name))) +
                   " of the scene as it stands at the end of this page.");
  std::error_code error;
  const std::uintmax_t film = fs::file_size(directory / "animation.webp", error);
  if (!error && film <= largest_film) report.picture("animation.webp", "The motion.");
  report.heading("How it ended");
  report.add(outcome_of(run, diagnostics));
  for (const std::string& note : notes_of(run, diagnostics)) report.paragraph(as_plain(note));
  const auto warnings = lasting_warnings(run, diagnostics, warnings_about_text(scene));
  report.heading("Warnings");
  if (warnings.empty()) report.paragraph("None.");
  for (const std::string& warning : warnings) report.paragraph(as_plain(warning));
  report.heading("Measures");
  report.add(measures_of(run, diagnostics));
  report.heading("Figures");
  add_figures(directory, report);
  report.heading("Scene");
  report.listing(scene_text(scene));
  write_file_atomically(directory / "report.html", report_html(report, directory));
}

}  // namespace unfurl
