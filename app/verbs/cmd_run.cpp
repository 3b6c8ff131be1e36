// SPDX-License-Identifier: BSD-3-Clause
// unfurl run SCENE -o DIR: simulate; write data.
#include <iostream>

#include "app/command.hpp"
#include "app/output/command_line.hpp"
#include "app/output/film_folder.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/output_directory.hpp"
#include "app/verbs/plan.hpp"
#include "app/verbs/scene_run.hpp"

namespace unfurl {

namespace {

// A film of the very motion that is run stays beside its data; another one is not thrown away unasked.
bool keeps_film(const std::filesystem::path& directory, const Scene& scene, bool force) {
  std::error_code error;
  if (!std::filesystem::exists(directory / "film.json", error)) return false;
  const FilmFolder folder(directory, scene);
  if (folder.holds_another() && !force)
    throw FileError(
        directory,
        "holds the film of another scene (or of other settings, or drawn by another version); use "
        "--force to replace it, or another -o");
  return folder.holds_this();
}

}  // namespace

int cmd_run(const Arguments& arguments) {
  if (arguments.output.empty() && !arguments.json)
    throw UsageError("-o DIR is missing (or --json, for the summary alone)");
  const auto formats = export_formats_of(arguments);
  const Scene scene = scene_of(arguments);
  if (arguments.plan) return show_plan(scene, arguments, false);
  auto model = model_of(scene, arguments);
  OwnDirectory output(arguments.output, arguments.force, "run");
  const std::filesystem::path& directory = output.path();
  const bool film = !directory.empty() && keeps_film(directory, scene, arguments.force);

  const InterruptGuard guard;
  const FinishedWork keeping;  // of a motion that is interrupted too
  Simulation run = simulate_scene(scene, std::move(model), arguments);
  const Diagnostics diagnostics = judge_run(run);
  if (!directory.empty() && !film) output.written().remove_all();
  const std::string summary = write_data(directory, scene, run, diagnostics, as_typed(arguments.words));
  write_exports(formats, directory, scene, run, diagnostics, arguments);
  report_run(run, diagnostics, arguments);
  if (arguments.json) std::cout << summary;
  return exit_code_of(run, diagnostics);
}

}  // namespace unfurl
