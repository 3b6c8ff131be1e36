// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/run_figures.hpp"

#include <cctype>
#include <span>
#include <string_view>

#include "app/output/interrupt.hpp"
#include "app/output/progress.hpp"
#include "core/export/atomic_file.hpp"
#include "core/text/nearest_name.hpp"
#include "render/plot/figure_data.hpp"

namespace unfurl {

namespace {

struct OtherName {
  std::string_view given, leads_to;
};

// What a figure is called elsewhere, without its underscores, and ours.
constexpr OtherName other_figure_names[] = {
    {"forces", "rod_forces"},
    {"axialforces", "rod_forces"},
    {"loads", "rod_forces"},
    {"stress", "rod_strength"},
    {"stresses", "rod_strength"},
    {"buckling", "rod_strength"},
    {"strength", "rod_strength"},
    {"torque", "drives"},
    {"torques", "drives"},
    {"power", "drives"},
    {"motors", "drives"},
    {"motor", "drives"},
    {"poissonratio", "poisson"},
    {"phaseportrait", "phase"},
    {"phasespace", "phase"},
    {"stephistogram", "steps"},
    {"stepsizes", "steps"},
    {"iterations", "steps"},
    {"spectrum", "jacobian"},
    {"singularvalues", "jacobian"},
    {"conditionnumber", "jacobian"},
    {"posestrip", "poses"},
    {"strip", "poses"},
    {"snapshots", "poses"},
    {"foldangle", "deployment"},
    {"fraction", "deployment"},
    {"angle", "deployment"},
    {"drift", "constraint_error"},
    {"constraints", "constraint_error"},
    {"selfstresses", "self_stress"},
    {"energies", "energy"},
    {"energybalance", "energy"},
};

// Figures that are of no single run, and the verbs that draw them.
constexpr OtherName figures_of_verbs[] = {
    {"workprecision", "unfurl study SCENE -o DIR"},
    {"convergence", "unfurl study SCENE -o DIR"},
    {"order", "unfurl study SCENE -o DIR"},
    {"atlas", "unfurl stress SCENE -o DIR"},
    {"stability", "unfurl stress SCENE -o DIR"},
    {"map", "unfurl sweep SCENE --vary KEY=FROM:TO:COUNT --measure NAME -o DIR"},
    {"sweep", "unfurl sweep SCENE --vary KEY=FROM:TO:COUNT --measure NAME -o DIR"},
    {"margin", "unfurl margin SCENE -o DIR"},
    {"margins", "unfurl margin SCENE -o DIR"},
    {"modes", "unfurl modes SCENE -o DIR"},
    {"frequencies", "unfurl modes SCENE -o DIR"},
};

std::string_view known_as(std::span<const OtherName> names, const std::string& given) {
  std::string plain;
  for (const char c : given)
    if (c != '_' && c != '-' && c != ' ')
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const OtherName& other : names)
    if (other.given == plain) return other.leads_to;
  return "";
}

}  // namespace

const FigureKind& figure_named(const std::string& name) {
  if (const FigureKind* kind = find_figure(name)) return *kind;
  const std::string what = "no figure " + in_quotes(name);
  if (const auto verb = known_as(figures_of_verbs, name); !verb.empty())
    throw UsageError(what + " of a run; " + std::string(verb) + " draws it");
  if (const auto kind = known_as(other_figure_names, name); !kind.empty())
    throw UsageError(what + "; did you mean " + in_quotes(kind) + "?");
  std::vector<std::string_view> names;
  for (const auto& kind : figure_kinds()) names.push_back(kind.name);
  names.push_back("all");
  throw UsageError(what + did_you_mean(name, names, "unfurl list figures"));
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
  for (const FigureKind* kind : kinds)  // all, before the first is written
    if (kind->applies(run, diagnostics)) refuse_other_data(directory / (std::string(kind->name) + ".png"));
  Progress progress("plotting", arguments.quiet);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (interrupted()) return false;
    progress.show(i, kinds.size(), "figures");
    if (!kinds[i]->applies(run, diagnostics)) continue;
    const Figure figure = kinds[i]->make(run, diagnostics);
    const std::string name(kinds[i]->name);
    for (const char* extension : {".svg", ".pdf", ".png"}) {
      if (interrupted()) return false;
      writer.write(figure, directory / (name + extension));
    }
    write_figure_data(figure, directory / (name + ".png"));
  }
  return true;
}

}  // namespace unfurl
