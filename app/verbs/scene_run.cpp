// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/scene_run.hpp"

#include "app/output/command_line.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/output/film_folder.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/json_text.hpp"
#include "app/output/progress.hpp"
#include "app/output/receipt.hpp"
#include "app/own_options.hpp"
#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/ending.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/export/atomic_file.hpp"
#include "core/export/checksum.hpp"
#include "core/export/csv.hpp"
#include "core/export/summary.hpp"
#include "core/math/largest.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/study/tolerance.hpp"
#include "core/text/nearest_name.hpp"
#include "render/scene/exported_looks.hpp"

namespace unfurl {

namespace {

const auto started = std::chrono::steady_clock::now();  // the program

}  // namespace

bool waited_enough() {
  return interrupted_for(0.5);
}

Scene scene_of(const Arguments& arguments) {
  Scene scene = read_scene_file(find_scene(arguments.names.front()), arguments.overrides);
  receipt_scene(scene.name, scene_text(scene, IdleValues::written));
  return scene;
}

std::shared_ptr<const Model> model_of(const Scene& scene, const Arguments& arguments) {
  const Waiting waiting("building the structure", arguments.quiet);
  return build_model(scene);
}

Simulation simulate_scene(const Scene& scene, std::shared_ptr<const Model> model, const Arguments& arguments,
                          bool poses) {
  Progress progress("simulating", arguments.quiet);
  SimulationHooks hooks;
  hooks.progress = [&](double fraction) { progress.show(fraction); };
  hooks.cancelled = interrupted;
  Simulation run = simulate_as_asked(model, scene.solver, hooks);
  if (poses) record_singular_poses(run, waited_enough);
  return run;
}

namespace {

// The tables, beside the summary; all of them take their places together.
std::string write_tables(const std::filesystem::path& directory, const std::string& scene,
                         const Simulation& run, const Diagnostics& diagnostics, RunAhead& ahead,
                         const std::function<std::string()>& summary,
                         const std::function<void()>& make_room) {
  PendingFile text(directory / "scene.toml"), series(directory / "series.csv"),
      rod_forces(directory / "rod_forces.csv"), end(directory / "summary.json");
  const TaskQueue::Scope scope(ahead.beside());
  ahead.beside().add([&] {
    ahead.trajectory_csv(directory, run.trajectory);
    write_rod_forces_csv(rod_forces, run.trajectory, diagnostics);
    write_series_csv(series, diagnostics);
  });
  text.write(scene);
  text.send();
  std::string json = summary();
  end.write(json);
  end.send();
  ahead.beside().finish();
  PendingFile& trajectory = ahead.trajectory_csv(directory, run.trajectory);
  const std::array files{&text, &series, &trajectory, &rod_forces, &end};
  for (PendingFile* file : files) file->complete();
  if (make_room) make_room();
  commit_together(files);
  return json;
}

}  // namespace

std::string write_data(const std::filesystem::path& directory, const Scene& scene, const Simulation& run,
                       Diagnostics& diagnostics, const std::string& command, RunAhead& ahead, bool tables,
                       const std::function<void()>& make_room) {
  const std::string text = scene_text(scene);
  const auto summary = [&] {
    const Model& model = run.trajectory.model();
    const Mobility mobility = ahead.mobility()
                                  ? *ahead.mobility()
                                  : analyse_mobility(model.system, run.trajectory.node_positions(0));
    Checksum hash;
    hash.add(text);
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    const RunRecord record{command, hash.text(), wall};
    try {
      const LooksUntil end(waited_enough);
      return summary_json(scene.name, run, diagnostics, mobility, record);
    } catch (const LookedEnough&) {  // what tops the states between them was not found
      diagnostics.left_open = 1;
      return summary_json(scene.name, run, diagnostics, mobility, record);
    }
  };
  if (directory.empty()) return summary();
  if (tables) return write_tables(directory, text, run, diagnostics, ahead, summary, make_room);
  const std::string json = summary();
  PendingFile origin(directory / "scene.toml"), end(directory / "summary.json");
  origin.write(text);
  end.write(json);
  for (PendingFile* file : {&origin, &end}) file->complete();
  if (make_room) make_room();
  commit_together(std::array{&origin, &end});
  return json;
}

namespace {

// Was what DIR has of a run written to its end and judged to its end?
bool is_whole(const std::filesystem::path& directory) {
  const auto json =
      nlohmann::json::parse(read_text_file((directory / "summary.json").string()).text, nullptr, false);
  const std::string status = text_in(json, "status");
  const auto forces = json.is_object() ? json.find("forces") : json.end();
  return !status.empty() && status != to_string(RunStatus::stopped) && forces != json.end() &&
         forces->is_object() && forces->contains("unique_rods") && !(*forces)["unique_rods"].is_null();
}

}  // namespace

void make_room(WrittenFiles& written, Beside beside, Unfinished unfinished) {
  constexpr std::array of_run{"scene.toml", "series.csv", "trajectory.csv", "rod_forces.csv", "summary.json"};
  const bool film = beside == Beside::film, whole = film && is_whole(written.directory());
  written.remove_all([&](const std::string& name) {
    return whole
               ? !name.starts_with("unfinished/") || unfinished == Unfinished::stays
               : std::ranges::find(of_run, name) != of_run.end() || (film && FilmFolder::is_of_film(name)) ||
                     (unfinished == Unfinished::stays && name.starts_with("unfinished/"));
  });
}

std::vector<std::string> warnings_about_text(const Scene& scene) {
  std::vector<std::string> texts;
  for (const SceneProblem& warning : scene.warnings) texts.push_back(problem_text(warning));
  return texts;
}

std::vector<const ExportFormat*> export_formats_of(const Arguments& arguments) {
  std::vector<const ExportFormat*> formats;
  std::vector<std::string_view> known;
  for (const auto& row : export_formats()) known.push_back(row.name);
  for (const auto& name : arguments.exports) {
    const ExportFormat* format = find_export_format(name);
    if (!format) throw UsageError("no export format " + in_quotes(name) + did_you_mean(name, known));
    if (std::find(formats.begin(), formats.end(), format) == formats.end()) formats.push_back(format);
  }
  return formats;
}

void write_exports(const std::vector<const ExportFormat*>& formats, const std::filesystem::path& directory,
                   const Scene& scene, const Simulation& run, const Diagnostics& diagnostics,
                   const Arguments& arguments) {
  const std::string text = scene_text(scene);
  const std::string command =
      as_typed(command_of_result(arguments.words, place_of_first_name(arguments.words), scene.name));
  const double interval = scene.render.speed / scene.render.fps;
  const ExportedLooks looks = exported_looks(scene, run.trajectory);
  const std::vector<std::string> about_text = warnings_about_text(scene);
  std::vector<std::string> said;
  for (const ExportFormat* format : formats)
    format->write({run, diagnostics, directory, scene.name, interval, scene.render.speed, scene.title, text,
                   command, &looks, about_text, &said});
  for (const std::string& warning : said) std::cerr << "unfurl: warning: " << warning << "\n";
}

void warn_of_run(const Simulation& run, const Diagnostics& diagnostics) {
  for (const auto& warning : warnings_of(run, diagnostics))
    std::cerr << "unfurl: warning: " << warning << "\n";
  if (run.status == RunStatus::failed) std::cerr << "unfurl: the solver failed: " << run.message << "\n";
}

void report_run(const Simulation& run, const Diagnostics& diagnostics, const Arguments& arguments) {
  warn_of_run(run, diagnostics);
  if (run.status == RunStatus::stopped || !diagnostics.whole())
    std::cerr << "unfurl: interrupted; what is finished is kept\n";
  if (arguments.quiet) return;
  std::ostringstream text;
  text << std::setprecision(9) << to_string(run.status) << " at " << run.trajectory.end_time()
       << " s: " << run.steps << (run.steps == 1 ? " step, " : " steps, ") << std::setprecision(3)
       << run.cpu_s << " s of CPU time";
  if (diagnostics.left_open == 0)
    text << ", constraint error " << largest_magnitude(diagnostics.at("constraint_max_m").values)
         << " m, energy balance " << largest_magnitude(diagnostics.at("energy_balance_J").values) << " J";
  text << "\n";
  for (const std::string& note : notes_of(run, diagnostics)) text << note << "\n";
  std::cerr << text.str();
}

Diagnostics judge_run(Simulation& run, const KnownAhead& ahead) {
  Diagnostics diagnostics = judge(run, waited_enough, ahead);
  receipt_errors({{"constraint_error_m", largest_magnitude(diagnostics.at("constraint_max_m").values)},
                  {"energy_balance_J", largest_magnitude(diagnostics.at("energy_balance_J").values)}});
  return diagnostics;
}

int exit_code_of(const Simulation& run, const Diagnostics& diagnostics) {
  if (run.status == RunStatus::failed) return exit_solver_failed;
  return run.status == RunStatus::stopped || !diagnostics.whole() ? exit_interrupted : exit_ok;
}

}  // namespace unfurl
