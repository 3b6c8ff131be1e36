// unfurl render SCENE -o DIR: simulate; write data, frames, animation and figures.
#include <iostream>

#include "app/command.hpp"
#include "app/film.hpp"
#include "app/interrupt.hpp"
#include "app/output_directory.hpp"
#include "app/run_figures.hpp"
#include "app/scene_run.hpp"
#include "core/scene/build.hpp"

namespace unfurl {

int cmd_render(const Arguments& arguments) {
  const auto formats = export_formats_of(arguments);
  const Scene scene = scene_of(arguments);
  check_film(scene);
  auto model = build_model(scene);
  const auto directory = open_output_directory(arguments.output, arguments.force);
  const auto context = make_offscreen_context();  // missing graphics are found before the work

  const InterruptGuard guard;
  const Simulation run = simulate_scene(scene, std::move(model), arguments);
  const Diagnostics diagnostics = diagnose(run);
  clear_old_results(directory);
  const std::string summary = write_data(directory, scene, run, diagnostics);
  write_exports(formats, directory, scene, run, diagnostics);
  report_run(run, diagnostics, arguments);
  if (arguments.json) std::cout << summary << std::flush;
  if (run.status == RunStatus::stopped) return exit_interrupted;

  FigureWriter writer(*context);
  if (!write_film(directory, scene, run, *context, arguments) ||
      !write_figures(directory / "figures", all_figures(), run, diagnostics, writer, arguments)) {
    std::cerr << "unfurl: interrupted; what is finished is kept\n";
    return exit_interrupted;
  }
  return exit_code_of(run);
}

}  // namespace unfurl
