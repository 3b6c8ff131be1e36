// SPDX-License-Identifier: BSD-3-Clause
#include "app/python/run_files.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/export/atomic_file.hpp"
#include "core/export/formats.hpp"
#include "core/export/summary.hpp"
#include "core/math/largest.hpp"
#include "core/scene/write.hpp"
#include "core/study/table.hpp"
#include "core/text/nearest_name.hpp"
#include "render/gl/context.hpp"
#include "render/image/png.hpp"
#include "render/plot/figures.hpp"
#include "render/scene/exported_looks.hpp"
#include "render/scene/still.hpp"
#include "render/ui/write_figure.hpp"

namespace unfurl {

namespace {

std::string python_text(const std::string& word) {
  return "\"" + word + "\"";
}

}  // namespace

RunReceipt::RunReceipt(const JudgedRun& run, const std::string& call, const std::string& output)
    : writer_({std::string(from_python), run.scene.name, run.made_by + "." + call}, 1, output) {
  receipt_scene(run.scene.name, scene_text(run.scene));
  const auto most = [&](const char* column) { return largest_magnitude(run.diagnostics.at(column).values); };
  receipt_errors(
      {{"constraint_error_m", most("constraint_max_m")}, {"energy_balance_J", most("energy_balance_J")}});
}

std::string summary_of(const JudgedRun& run) {
  const Trajectory& trajectory = run.simulation.trajectory;
  const Mobility mobility = analyse_mobility(trajectory.model().system, trajectory.node_positions(0));
  return summary_json(run.scene.name, run.simulation, run.diagnostics, mobility);
}

std::vector<std::string> write_export(const JudgedRun& run, const std::string& format,
                                      const std::string& directory, const Between& between) {
  std::vector<std::string_view> known;
  for (const ExportFormat& row : export_formats()) known.push_back(row.name);
  const ExportFormat* found = find_export_format(format);
  if (!found) throw StudyError("no export format " + in_quotes(format) + did_you_mean(format, known));
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw FileError(directory, error.value());
  const RunReceipt receipt(run, "export(" + python_text(format) + ")", directory);
  const Scene& scene = run.scene;
  const std::string text = scene_text(scene);
  const ExportedLooks looks = exported_looks(scene, run.simulation.trajectory);
  std::vector<std::string> about_text, said;
  for (const SceneProblem& warning : scene.warnings) about_text.push_back(problem_text(warning));
  found->write({run.simulation,
                run.diagnostics,
                directory,
                scene.name,
                scene.render.speed / scene.render.fps,
                scene.render.speed,
                scene.title,
                text,
                {},
                &looks,
                about_text,
                &said,
                between});
  return said;
}

void write_plot(const JudgedRun& run, const std::string& name, const std::string& file,
                const std::string& style, const Between& between) {
  std::vector<std::string_view> known;
  for (const FigureKind& kind : figure_kinds())
    if (kind.applies(run.simulation, run.diagnostics)) known.push_back(kind.name);
  const FigureKind* kind = find_figure(name);
  if (!kind || std::find(known.begin(), known.end(), name) == known.end())
    throw StudyError("no figure " + in_quotes(name) + " of this run" + did_you_mean(name, known));
  FigureOptions options;
  options.style = find_figure_style(style);
  std::vector<std::string_view> styles;
  for (const FigureStyle& row : figure_styles()) styles.push_back(row.name);
  if (!options.style) throw StudyError("no style " + in_quotes(style) + did_you_mean(style, styles));
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension != ".png" && extension != ".svg" && extension != ".pdf")
    throw StudyError("a figure is written as .png, .svg or .pdf, not " + in_quotes(extension));
  const RunReceipt receipt(run, "plot(" + python_text(name) + ", style=" + python_text(style) + ")", file);
  const Figure figure = kind->make(run.simulation, run.diagnostics);
  between();
  write_figure(figure, file, options);
}

void write_still(const JudgedRun& run, double t, const std::string& file, const Between& between) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension != ".png") throw StudyError("a frame is written as .png, not " + in_quotes(extension));
  const RunReceipt receipt(run, "frame(" + exact_number(t) + ")", file);
  const auto context = make_offscreen_context();
  const Image image = still(run.scene, run.simulation, run.diagnostics, t, *context, between);
  between();
  write_png(file, image, has_alpha(run.scene.render));
}

}  // namespace unfurl
