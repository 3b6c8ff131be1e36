// SPDX-License-Identifier: BSD-3-Clause
// unfurl figure SCENE NAME... -o FILE: one figure, PNG, SVG or PDF by extension; several, or `all`,
// into a directory. Beside each its numbers and its caption.
#include <algorithm>
#include <iostream>
#include <limits>

#include "app/command.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/output_directory.hpp"
#include "app/verbs/run_figures.hpp"
#include "app/verbs/scene_run.hpp"
#include "core/diagnostics/jacobian_spectrum.hpp"
#include "core/system/self_stress.hpp"
#include "core/text/nearest_name.hpp"
#include "render/plot/figure_data.hpp"

namespace unfurl {

namespace {

bool asks_for_all(const Arguments& arguments) {
  return std::find(arguments.names.begin() + 1, arguments.names.end(), "all") != arguments.names.end();
}

// Every name is looked at, those beside `all`, too.
std::vector<const FigureKind*> chosen_figures(const Arguments& arguments) {
  std::vector<const FigureKind*> kinds;
  for (std::size_t i = 1; i < arguments.names.size(); ++i)
    if (arguments.names[i] != "all") kinds.push_back(&figure_named(arguments.names[i]));
  return asks_for_all(arguments) ? all_figures() : kinds;
}

// Does -o name one file (rather than a directory)?
bool single_file(const std::filesystem::path& output, const Arguments& arguments) {
  const std::string extension = output.extension().string();
  const bool one = arguments.names.size() == 2 && arguments.names[1] != "all";
  if (extension == ".png" || extension == ".svg" || extension == ".pdf") {
    if (!one)
      throw UsageError("several figures go into a directory; " + in_quotes(output.string()) + " is one file");
    return true;
  }
  if (one && !extension.empty())
    throw UsageError("a figure is written as .png, .svg or .pdf, not " + in_quotes(extension));
  return false;
}

// Of figures whose price is a cube of the size.
std::string too_large(const FigureKind& kind, const System& system) {
  const Index most = kind.name == "jacobian"      ? max_spectrum_size
                     : kind.name == "self_stress" ? max_listed_coordinates
                                                  : std::numeric_limits<Index>::max();
  const Index size = kind.name == "jacobian" ? std::max(system.coordinates(), system.all_constraints())
                                             : system.coordinates();
  if (size <= most) return "";
  return "it is drawn up to " + std::to_string(most) + " coordinates" +
         (kind.name == "jacobian" ? " and constraints" : "") + ", and the scene has " + std::to_string(size);
}

void require_data(const FigureKind& kind, const Scene& scene, const Simulation& run,
                  const Diagnostics& diagnostics) {
  if (kind.applies(run, diagnostics)) return;
  const std::string limit = too_large(kind, run.trajectory.model().system);
  throw UsageError("the scene " + scene.name + " has no data for the figure " + in_quotes(kind.name) +
                   (limit.empty() ? "" : ": " + limit));
}

void say_what_is_left_out(const std::vector<const FigureKind*>& kinds, const Simulation& run,
                          const Diagnostics& diagnostics) {
  for (const FigureKind* kind : kinds)
    if (const std::string limit = too_large(*kind, run.trajectory.model().system);
        !limit.empty() && !kind->applies(run, diagnostics))
      std::cerr << "unfurl: " << kind->name << " is left out: " << limit << "\n";
}

// With what is written beside it.
void require_writable_figure(const std::filesystem::path& output) {
  require_writable(output);
  for (const auto& beside : figure_data_files(output)) require_writable(beside);
  refuse_other_data(output);
}

}  // namespace

int cmd_figure(const Arguments& arguments) {
  const auto kinds = chosen_figures(arguments);
  const FigureOptions options = figure_options(arguments);
  const std::filesystem::path output(arguments.output);
  const bool file = single_file(output, arguments);
  const Scene scene = scene_of(arguments);
  auto model = model_of(scene, arguments);
  if (file) require_writable_figure(output);
  // A directory may hold whatever it does: nothing but figures of ours is replaced in it.
  OwnDirectory directory(file ? "" : arguments.output, true, "figure", DirectoryLock::Use::shareable);
  if (!file) directory.lock().share();
  std::unique_ptr<GlContext> context;
  if (!file || output.extension() == ".png") context = make_offscreen_context({0, arguments.gpu});

  const InterruptGuard guard;
  Simulation run = simulate_scene(scene, std::move(model), arguments);
  throw_if_interrupted();
  const Diagnostics diagnostics = judge_run(run);
  if (!asks_for_all(arguments))
    for (const FigureKind* kind : kinds) require_data(*kind, scene, run, diagnostics);
  else if (!arguments.quiet)
    say_what_is_left_out(kinds, run, diagnostics);
  const auto writer =
      context ? std::make_unique<FigureWriter>(*context, options) : std::make_unique<FigureWriter>(options);
  if (file) {
    const Figure figure = kinds[0]->make(run, diagnostics);
    refuse_other_data(output);
    writer->write(figure, output);
    write_figure_data(figure, output);
  } else if (!write_figures(output, kinds, run, diagnostics, *writer, arguments)) {
    std::cerr << "unfurl: interrupted; what is finished is kept\n";
    return exit_interrupted;
  }
  report_run(run, diagnostics, arguments);
  return exit_code_of(run, diagnostics);
}

}  // namespace unfurl
