// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

// The terms of the balance, kinetic + potential - the energy at the start - work of the loads + ... = 0, as
// far as a run has them.
struct Share {
  const char* column;
  int color;
  Dash dash;
  const char* sign;
};
constexpr Share shares[] = {
    {"kinetic_energy_J", 0, Dash::solid, "+"},
    {"potential_energy_J", 2, Dash::dash_dot, "+"},
    {"work_J", 1, Dash::dashed, "\u2212"},
    {"dissipated_J", 5, Dash::dash_dot_dot, "+"},
    {"drive_work_J", 4, Dash::long_dashed, "\u2212"},
    {"impact_loss_J", 6, Dash::dotted, "+"},
};

// Energies that hardly change are shown from zero on: their ripple is the lower panel's business.
void show_from_zero(Panel& p) {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (const Curve& c : p.curves)
    for (const double v : c.y)
      if (std::isfinite(v)) lo = std::min(lo, v), hi = std::max(hi, v);
  const double size = std::max(std::abs(lo), std::abs(hi));
  if (!(size > 0 && hi - lo < 0.01 * size)) return;
  p.y.min = lo < 0 ? -1.15 * size : 0;
  p.y.max = hi > 0 ? 1.15 * size : 0;
}

}  // namespace

Figure energy_figure(const Simulation& run, const Diagnostics& diagnostics) {
  Panel top = time_panel(run, "energy (J)");
  double largest = 0;
  std::string balance;
  for (const Share& s : shares) {
    const Series* series = diagnostics.find(s.column);
    const double size = series ? largest_magnitude(series->values) : 0.0;
    largest = std::max(largest, size);
    if (size == 0 && s.color != 0) continue;  // a scene without loads, gravity, dampers, ...
    top.curves.push_back(over_time(diagnostics, series->values, series->label, s.color));
    top.curves.back().dash = s.dash;
    balance += (balance.empty() ? std::string() : std::string(" ") + s.sign + " ") + series->label;
  }
  show_from_zero(top);

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
  f.caption = "a, energies and work since the start. b, magnitude of " + balance +
              " \u2212 the energy at the start (kinetic + potential), at most " +
              plot::format_number(largest_magnitude(error), 2) + " J." + zeros_sentence(error) + " " +
              method_sentence(run);
  share_time_axis(top, bottom);
  f.panels = {std::move(top), std::move(bottom)};
  return f;
}

}  // namespace unfurl
