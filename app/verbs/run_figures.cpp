// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/run_figures.hpp"

#include "app/output/interrupt.hpp"
#include "app/output/progress.hpp"
#include "core/export/atomic_file.hpp"
#include "core/text/nearest_name.hpp"
#include "render/plot/figure_data.hpp"

namespace unfurl {

const FigureKind& figure_named(const std::string& name) {
  if (const FigureKind* kind = find_figure(name)) return *kind;
  std::vector<std::string_view> names;
  for (const auto& kind : figure_kinds()) names.push_back(kind.name);
  names.push_back("all");
  throw UsageError("no figure " + in_quotes(name) + did_you_mean(name, names));
}

FigureOptions figure_options(const Arguments& arguments) {
  FigureOptions options{.dpi = arguments.dpi};
  if (!arguments.font.empty()) {
    options.face = plot::find_typeface(arguments.font);
    std::vector<std::string_view> names;
    for (const plot::Typeface& face : plot::typefaces()) names.push_back(face.name);
    if (!options.face)
      throw UsageError("no font " + in_quotes(arguments.font) + did_you_mean(arguments.font, names));
    require_installed(*options.face);
  }
  if (arguments.style.empty()) return options;
  options.style = find_figure_style(arguments.style);
  if (options.style) return options;
  std::vector<std::string_view> names;
  for (const FigureStyle& style : figure_styles()) names.push_back(style.name);
  throw UsageError("no style " + in_quotes(arguments.style) + did_you_mean(arguments.style, names));
}

std::vector<const FigureKind*> all_figures() {
  std::vector<const FigureKind*> kinds;
  for (const auto& kind : figure_kinds()) kinds.push_back(&kind);
  return kinds;
}

bool write_figures(const std::filesystem::path& directory, const std::vector<const FigureKind*>& kinds,
                   const Simulation& run, const Diagnostics& diagnostics, FigureWriter& writer,
                   const Arguments& arguments) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw FileError(directory, error.value());
  Progress progress("plotting", arguments.quiet);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (interrupted()) return false;
    progress.show(i, kinds.size(), "figures");
    if (!kinds[i]->applies(run, diagnostics)) continue;
    const Figure figure = kinds[i]->make(run, diagnostics);
    const std::string name(kinds[i]->name);
    refuse_other_data(directory / (name + ".png"));
    for (const char* extension : {".svg", ".pdf", ".png"}) {
      if (interrupted()) return false;
      writer.write(figure, directory / (name + extension));
    }
    write_figure_data(figure, directory / (name + ".png"));
  }
  return true;
}

}  // namespace unfurl
