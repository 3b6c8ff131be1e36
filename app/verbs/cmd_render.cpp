// SPDX-License-Identifier: BSD-3-Clause
// unfurl render SCENE -o DIR: simulate; write data, frames, animation and figures.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>

#include "app/command.hpp"
#include "app/output/command_line.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/output_directory.hpp"
#include "app/verbs/film.hpp"
#include "app/verbs/frame_range.hpp"
#include "app/verbs/mode_film.hpp"
#include "app/verbs/plan.hpp"
#include "app/verbs/run_figures.hpp"
#include "app/verbs/run_report.hpp"
#include "app/verbs/scene_run.hpp"
#include "app/verbs/team_work.hpp"
#include "app/verbs/unfinished_run.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/write.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/still.hpp"

namespace unfurl {

namespace {

void refuse_another_film(OwnDirectory& output, const FilmFolder& folder, const Arguments& arguments) {
  folder.refuse_to_encode_another(arguments.encode_only);
  if (folder.holds_another() && !arguments.force)
    throw FileError(output.path(),
                    "holds frames of another film (the scene, its settings or the program changed); "
                    "use --force to start over, or another -o");
  if (output.lock().shared() && !arguments.join && !folder.holds_this())
    throw FileError(output.path(), "another unfurl is writing another film into it; use another -o");
}

// The same words and exit code as the worker's that has written the film of a --join.
int written_by_another(const std::filesystem::path& directory, const Simulation& run,
                       const Diagnostics& diagnostics, const Arguments& arguments) {
  if (interrupted()) return exit_interrupted;
  if (arguments.json) std::cout << std::ifstream(directory / "summary.json").rdbuf() << std::flush;
  return exit_code_of(run, diagnostics);
}

}  // namespace

int cmd_render(const Arguments& arguments) {
  if (arguments.mode > 0) return render_mode(arguments);
  if (!arguments.at.empty()) throw UsageError("--at is the pose of --mode; leave it out, or add --mode K");
  const FigureOptions style = figure_options(arguments);
  const auto formats = export_formats_of(arguments);
  const Scene scene = scene_of(arguments);
  check_film(scene);
  if (arguments.plan) return show_plan(scene, arguments, true);
  auto model = model_of(scene, arguments);
  check_film_names(scene, model->structure);
  if (arguments.join && (arguments.force || !arguments.frames.empty()))
    throw UsageError(
        "--join shares the frames by itself and replaces nothing; leave out --frames and --force");
  OwnDirectory output(arguments.output, arguments.force, "run",
                      arguments.join ? DirectoryLock::Use::joined : DirectoryLock::Use::shareable);
  output.require_scene(scene_text(scene), arguments.force);
  output.require_files({"scene.toml", "series.csv", "trajectory.csv", "rod_forces.csv", "summary.json"});
  const std::filesystem::path& directory = output.path();
  DirectoryLock& lock = output.lock();
  if (!arguments.force) UnfinishedRun::refuse_in(directory, "a film");
  FilmFolder folder(directory, scene, arguments.gpu);
  refuse_another_film(output, folder, arguments);
  if (!arguments.frames.empty()) frame_range(arguments.frames, 100000);
  if (folder.fresh() || arguments.join) folder.claim();  // others may join before the simulation ends
  if (folder.holds_this()) lock.share();
  const auto context = make_offscreen_context(
      {arguments.threads, arguments.gpu});  // missing graphics are found before the work

  const InterruptGuard guard;
  std::optional<FinishedWork> keeping(std::in_place);  // of a motion that is interrupted too
  Simulation run = simulate_scene(scene, std::move(model), arguments);
  Diagnostics diagnostics = judge_run(run);
  const bool another = !folder.holds_this();  // whose results stay until the new ones are whole
  const auto claim = [&] {
    folder.claim();
    lock.share();
  };
  if (!another) claim();
  const Scene shown = fitted(scene, run);
  folder.fit(shown);
  FrameMemory memory;
  const auto team = join_team(arguments, directory);
  if (team) {
    const bool writes = work_together(*team, arguments, [&] {
      return draw_frames(folder, shown, run, diagnostics, *context, arguments, memory, team.get()) &&
             all_frames(folder, shown, run);
    });
    if (!writes) return written_by_another(directory, run, diagnostics, arguments);
  }
  RunAhead beside(arguments.threads);
  std::optional<RememberedExtremes> once(std::in_place);  // of the summary and of what is said
  const std::string summary = write_data(
      directory, scene, run, diagnostics, as_typed(arguments.words), beside, true,
      [&] { another ? FilmFolder::clear(output.written()) : make_room(output.written(), Beside::film); });
  if (another) claim();
  write_exports(formats, directory, scene, run, diagnostics, arguments);
  keeping.reset();
  report_run(run, diagnostics, arguments);
  once.reset();
  if (arguments.json) std::cout << summary << std::flush;
  if (exit_code_of(run, diagnostics) == exit_interrupted) return exit_interrupted;

  if (arguments.encode_only) {
    require_all_frames(folder, shown, run, arguments);
    if (!encode_films(directory, folder, shown, run, arguments)) return exit_interrupted;
    write_run_report(directory, scene, run, diagnostics, arguments);
    results_written(team.get());
    return exit_code_of(run, diagnostics);
  }
  FigureWriter writer(*context, style);
  if (!draw_frames(folder, shown, run, diagnostics, *context, arguments, memory) ||
      !write_figures(directory / "figures", all_figures(), run, diagnostics, writer, arguments) ||
      !encode_films(directory, folder, shown, run, arguments, memory)) {
    std::cerr << "unfurl: interrupted; what is finished is kept\n";
    return exit_interrupted;
  }
  if (all_frames(folder, shown, run)) write_run_report(directory, scene, run, diagnostics, arguments);
  results_written(team.get());
  return exit_code_of(run, diagnostics);
}

}  // namespace unfurl
