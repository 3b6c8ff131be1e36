// SPDX-License-Identifier: BSD-3-Clause
// unfurl run SCENE -o DIR: simulate; write data.
#include <algorithm>
#include <iostream>

#include "app/command.hpp"
#include "app/output/checkpoint_head.hpp"
#include "app/output/command_line.hpp"
#include "app/output/film_folder.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/output_directory.hpp"
#include "app/output/progress.hpp"
#include "app/output/receipt.hpp"
#include "app/verbs/plan.hpp"
#include "app/verbs/scene_run.hpp"
#include "app/verbs/unfinished_run.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/math/largest.hpp"
#include "core/scene/write.hpp"
#include "core/simulate/parts.hpp"
#include "core/simulate/singular_poses.hpp"

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

// Only what is solved once and needs no look back at all states is written as it goes.
bool in_parts(const Scene& scene, const Arguments& arguments) {
  return !arguments.output.empty() && arguments.exports.empty() && scene.solver.model == "full" &&
         scene.solver.tolerance == 0;
}

[[noreturn]] void refuse_to_resume(const std::filesystem::path& directory) {
  throw FileError(directory, "holds no unfinished run of this scene to go on with; leave --resume out");
}

// Singular poses are looked for beside the longest table and the diagnosis, which asks for them where it
// needs them.
Diagnostics judged(Simulation& run, const std::filesystem::path& directory, RunAhead& ahead) {
  std::vector<Event> poses;
  const TaskQueue::Scope scope(ahead.beside());
  ahead.beside().add([&] { poses = find_singular_poses(run.trajectory, waited_enough); });
  if (!directory.empty()) ahead.trajectory_csv(directory, run.trajectory);
  const auto name_poses = [&] {
    ahead.beside().finish();
    record_singular_poses(run, poses);
  };
  return judge_run(run, {&ahead.forces(), ahead.flow(), name_poses, ahead.diagnosis()});
}

int write_run(const Scene& scene, Simulation& run, const Arguments& arguments, OwnDirectory& output,
              Beside film, RunAhead& ahead) {
  const std::filesystem::path& directory = output.path();
  ahead.take(run.trajectory);
  Diagnostics diagnostics = judged(run, directory, ahead);
  const RememberedExtremes once;  // of the summary and of what is said
  // An earlier run's results stay until these are whole: the disk may be full.
  const std::string summary = write_data(directory, scene, run, diagnostics, as_typed(arguments.words), ahead,
                                         true, [&] { make_room(output.written(), film); });
  write_exports(export_formats_of(arguments), directory, scene, run, diagnostics, arguments);
  report_run(run, diagnostics, arguments);
  if (arguments.json) std::cout << summary;
  return exit_code_of(run, diagnostics);
}

int write_end(const Scene& scene, UnfinishedRun& unfinished, Simulation& rest, std::size_t first,
              const Arguments& arguments, RunAhead& ahead) {
  ahead.beside().finish();
  Digest whole = unfinished.finish(rest, first);
  Diagnostics& d = whole.diagnostics;
  receipt_errors({{"constraint_error_m", largest_magnitude(d.at("constraint_max_m").values)},
                  {"energy_balance_J", largest_magnitude(d.at("energy_balance_J").values)}});
  const std::string summary = write_data(arguments.output, scene, whole.run, d, as_typed(arguments.words),
                                         ahead, false, [&] { unfinished.take_places(); });
  if (!unfinished.goes_on() || !holds_checkpoint(arguments.output)) unfinished.forget();
  report_run(whole.run, d, arguments);
  if (holds_checkpoint(arguments.output) && !arguments.quiet)
    std::cerr << "unfurl: the same command goes on with it\n";
  if (arguments.json) std::cout << summary;
  return exit_code_of(whole.run, d);
}

// Nothing ends it before there are more states than one part has.
bool is_long(const Model& model, const SolverOptions& options, const Parts& parts) {
  const bool may_end_early = !model.structure.deployment.empty() && options.at_deployed == "stop";
  return !may_end_early &&
         options.end_time >= static_cast<double>(parts.states + parts.around) * options.step;
}

int run_in_parts(const Scene& scene, const std::shared_ptr<const Model>& model, const Arguments& arguments,
                 OwnDirectory& output, Beside film) {
  UnfinishedRun unfinished(output.written(), scene, model, arguments.checkpoint, film);
  Parts parts = parts_for(*model);
  if (arguments.force && !arguments.resume) unfinished.forget();
  if (unfinished.find()) {
    parts.archived = &unfinished.stepper();
    if (!arguments.quiet)
      std::cerr << "unfurl: goes on with the unfinished run from t = " << unfinished.begins_at() << " s\n";
  } else if (arguments.resume) {
    refuse_to_resume(output.path());
  }
  RunAhead ahead(arguments.threads);
  parts.take = [&](Stepper::Window window, Stepper& stepper) {
    ahead.stop();
    unfinished.take(std::move(window), stepper, ahead.beside());
  };
  // Not of what is displaced afterwards. Of a run that is handed over in parts it is for nothing.
  if (!model->structure.quasi_static && !parts.archived && !is_long(*model, scene.solver, parts))
    parts.look = [&](const Simulation& so_far) {
      ahead.look(so_far, std::clamp<std::size_t>(parts.states / 64 * 4, 4, 48));
    };
  Progress progress("simulating", arguments.quiet);
  SimulationHooks hooks;
  hooks.progress = [&](double fraction) { progress.show(fraction); };
  hooks.cancelled = interrupted;
  std::size_t first = 0;
  Simulation run = simulate_in_parts(model, scene.solver, hooks, parts, first);
  if (unfinished.any()) return write_end(scene, unfinished, run, first, arguments, ahead);
  return write_run(scene, run, arguments, output, film, ahead);
}

}  // namespace

int cmd_run(const Arguments& arguments) {
  if (arguments.output.empty() && !arguments.json)
    throw UsageError("-o DIR is missing (or --json, for the summary alone)");
  export_formats_of(arguments);  // refuses unknown ones before any work
  const Scene scene = scene_of(arguments);
  if (arguments.plan && arguments.resume &&
      !(in_parts(scene, arguments) && holds_checkpoint(arguments.output)))
    refuse_to_resume(arguments.output);
  if (arguments.plan) return show_plan(scene, arguments, false);
  Scene built = scene;
  if (in_parts(scene, arguments))
    built.solver.adaptive = true;  // no number of states is too large to be kept
  auto model = model_of(built, arguments);
  OwnDirectory output(arguments.output, arguments.force, "run");
  output.require_scene(scene_text(scene), arguments.force);
  output.require_files({"scene.toml", "series.csv", "trajectory.csv", "rod_forces.csv", "summary.json"});
  const std::filesystem::path& directory = output.path();
  const Beside film =
      !directory.empty() && keeps_film(directory, scene, arguments.force) ? Beside::film : Beside::nothing;

  const InterruptGuard guard;
  const FinishedWork keeping;  // of a motion that is interrupted too
  if (in_parts(scene, arguments)) return run_in_parts(scene, model, arguments, output, film);
  if (!arguments.force)
    UnfinishedRun::refuse_in(directory, "a run with --export, a tolerance or another model");
  if (arguments.resume) refuse_to_resume(directory);
  Simulation run = simulate_scene(scene, std::move(model), arguments, false);
  RunAhead beside(arguments.threads);
  return write_run(scene, run, arguments, output, film, beside);
}

}  // namespace unfurl
