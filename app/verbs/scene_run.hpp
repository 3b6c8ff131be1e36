// SPDX-License-Identifier: BSD-3-Clause
// The work that verbs share: a scene from the command line, its simulation, its data on disk.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "app/command.hpp"
#include "app/output/written_files.hpp"
#include "app/verbs/run_ahead.hpp"
#include "core/diagnostics/diagnostics.hpp"
#include "core/export/formats.hpp"
#include "core/scene/scene.hpp"

namespace unfurl {

// An interrupt that a run has not obeyed for half a second: what is not judged by then is left open.
bool waited_enough();

// The scene that the first word names, with the overrides.
Scene scene_of(const Arguments& arguments);

// Its structure and equations; a large one says that it takes long.
std::shared_ptr<const Model> model_of(const Scene& scene, const Arguments& arguments);

// Simulate with a progress bar; Ctrl-C stops it. Its events name singular poses, unless those are looked for
// later.
Simulation simulate_scene(const Scene& scene, std::shared_ptr<const Model> model, const Arguments& arguments,
                          bool poses = true);

// scene.toml, series.csv, trajectory.csv, rod_forces.csv and summary.json; returns the text of the latter. An
// empty directory name writes nothing. command: what was typed, for the summary; tables: those in CSV, too;
// make_room: called when all bytes are on the disk, before the files get their names. Half a second after
// Ctrl-C the last state is left open in the diagnostics, and so are extremes within steps.
std::string write_data(const std::filesystem::path& directory, const Scene& scene, const Simulation& run,
                       Diagnostics& diagnostics, const std::string& command, RunAhead& ahead,
                       bool tables = true, const std::function<void()>& make_room = {});

// What the run before left in DIR goes, but for the five files of a run, which new ones replace at one
// moment, and `unfinished`, where a run goes on. A film that shows the motion stays: all of it, and what was
// exported beside it unless that run was stopped, whose exports end early.
enum class Beside { nothing, film };
enum class Unfinished { goes, stays };
void make_room(WrittenFiles& written, Beside beside, Unfinished unfinished = Unfinished::goes);

// The formats that --export names, in that order; throws UsageError with the nearest name of an unknown one.
std::vector<const ExportFormat*> export_formats_of(const Arguments& arguments);

// What a run warns of that is about how the scene is written; pages, with the scene in them, leave it out.
std::vector<std::string> warnings_about_text(const Scene& scene);

// The run in these formats, beside the data in the directory.
void write_exports(const std::vector<const ExportFormat*>& formats, const std::filesystem::path& directory,
                   const Scene& scene, const Simulation& run, const Diagnostics& diagnostics,
                   const Arguments& arguments);

// What the run warns of, and why it failed where it did, on stderr.
void warn_of_run(const Simulation& run, const Diagnostics& diagnostics);

// That and a few lines for a person on stderr; nothing where `quiet` was asked for.
void report_run(const Simulation& run, const Diagnostics& diagnostics, const Arguments& arguments);

// The run's diagnostics, which decide its end (judge()); half a second after Ctrl-C what is not computed yet
// is left open. What was found `ahead` is used.
Diagnostics judge_run(Simulation& run, const KnownAhead& ahead = {});

// 0, solver failed, or interrupted.
int exit_code_of(const Simulation& run, const Diagnostics& diagnostics);

}  // namespace unfurl
