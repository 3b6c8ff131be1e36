#include <algorithm>
#include <limits>

#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

struct Share {
  const char *column, *label;
  int color;
  Dash dash;
};
constexpr Share shares[] = {{"kinetic_energy_J", "kinetic energy", 0, Dash::solid},
                            {"potential_energy_J", "potential energy", 2, Dash::dash_dot},
                            {"work_J", "work of the loads", 1, Dash::dashed}};

}  // namespace

Figure energy_figure(const Simulation& run, const Diagnostics& diagnostics) {
  Panel top = time_panel(run, "energy (J)");
  double largest = 0;
  for (const Share& s : shares) {
    const std::vector<double>& values = diagnostics.at(s.column).values;
    const double size = largest_magnitude(values);
    largest = std::max(largest, size);
    if (size == 0 && s.color != 0) continue;  // a scene without loads or gravity
    top.curves.push_back(over_time(diagnostics, values, s.label, s.color));
    top.curves.back().dash = s.dash;
  }

  const std::vector<double> error = magnitudes(diagnostics.at("energy_balance_J").values);
  Panel bottom = time_panel(run, "error of balance (J)");
  bottom.y.log = bottom.y.zeros_at_floor = true;
  bottom.curves.push_back(over_time(diagnostics, error, "", 3));
  if (largest > 0)
    bottom.lines.push_back(
        {largest * std::numeric_limits<double>::epsilon(), true, "round-off of the largest energy", 1});

  Figure f;
  f.name = "energy";
  f.title = "Energy";
  f.rows = 2;
  f.height_mm = 105;
  f.caption =
      "Above: energies and the work done by the loads. Below: magnitude of kinetic + potential energy \u2212 "
      "work \u2212 "
      "the energy at the start, at most " +
      plot::format_number(largest_magnitude(error), 2) + " J." + zeros_sentence(error) + " " +
      method_sentence(run);
  share_time_axis(top, bottom);
  f.panels = {std::move(top), std::move(bottom)};
  return f;
}

}  // namespace unfurl
