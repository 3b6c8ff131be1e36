// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/stress_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

// Of the palette, by verdict.
int color_of(Verdict verdict) {
  constexpr std::array colors{6, 7, 3, 1, 4, 5, 2};
  return colors[static_cast<std::size_t>(verdict)];
}

// Where the cell around values[i] begins (side 0) or ends (side 1): half way to the neighbours, by equal
// factors.
double edge(const std::vector<double>& values, std::size_t i, std::size_t side) {
  const bool has = side == 0 ? i > 0 : i + 1 < values.size();
  if (has) return std::sqrt(values[i] * values[side == 0 ? i - 1 : i + 1]);
  const double other = edge(values, i, 1 - side);
  return values[i] * values[i] / other;
}

Panel atlas_panel(const StressPlan& plan, const Stress& stress, const Extreme& extreme,
                  const Setting& setting) {
  std::vector<double> steps(plan.steps.begin(), plan.steps.end());
  std::vector<double> values = extreme.values;
  std::sort(values.begin(), values.end());
  Panel p;
  p.title = setting.name;
  p.x = {.label = "steps over the motion",
         .log = true,
         .min = edge(steps, 0, 0),
         .max = edge(steps, steps.size() - 1, 1)};
  p.y = {.label = extreme.label,
         .log = true,
         .min = edge(values, 0, 0),
         .max = edge(values, values.size() - 1, 1)};
  for (const StressCell& cell : stress.cells) {
    if (cell.extreme != extreme.name || cell.setting != setting.name) continue;
    const auto i = static_cast<std::size_t>(std::find(plan.steps.begin(), plan.steps.end(), cell.steps) -
                                            plan.steps.begin());
    const auto j =
        static_cast<std::size_t>(std::find(values.begin(), values.end(), cell.value) - values.begin());
    if (i >= steps.size() || j >= values.size()) continue;
    p.cells.push_back({edge(steps, i, 0), edge(values, j, 0), edge(steps, i, 1), edge(values, j, 1),
                       palette(color_of(cell.verdict)), std::string(to_string(cell.verdict))});
  }
  return p;
}

// Curves without points, for their legend entries alone.
void add_key(const Stress& stress, const Extreme& extreme, Panel& panel) {
  for (const Verdict v : verdicts()) {
    const bool used = std::any_of(stress.cells.begin(), stress.cells.end(), [&](const StressCell& c) {
      return c.extreme == extreme.name && c.verdict == v;
    });
    if (!used) continue;
    Curve c;
    c.label = to_string(v);
    c.color = color_of(v);
    c.width = 4;
    panel.curves.push_back(std::move(c));
  }
}

}  // namespace

std::vector<Figure> atlas_figures(const StressPlan& plan, const Stress& stress, const std::string& scene) {
  std::vector<Figure> figures;
  for (const Extreme& extreme : plan.extremes) {
    if (std::ranges::none_of(stress.cells, [&](const StressCell& c) { return c.extreme == extreme.name; }))
      continue;
    Figure f;
    f.name = "atlas_" + extreme.name;
    f.title = "Stability atlas: " + scene;
    const int panels = static_cast<int>(plan.settings.size()) + 1;  // and one for the key
    f.columns = panels <= 4 ? panels : (panels + 1) / 2;
    f.rows = panels <= 4 ? 1 : 2;
    f.width_mm = 50.0 * f.columns + 10;
    f.height_mm = 62.0 * f.rows + 22;
    for (const Setting& setting : plan.settings)
      f.panels.push_back(atlas_panel(plan, stress, extreme, setting));
    for (std::size_t i = 0; i < f.panels.size(); ++i) {
      const auto columns = static_cast<std::size_t>(f.columns);
      if (i % columns > 0) f.panels[i].y.label.clear();
      if (i + columns < f.panels.size()) f.panels[i].x.label.clear();
    }
    Panel key;
    key.bare = true;
    add_key(stress, extreme, key);
    f.panels.push_back(std::move(key));
    for (const Verdict v : verdicts())
      if (v != Verdict::right)
        f.caption += (f.caption.empty() ? "" : "; ") + std::string(to_string(v)) + ": " + criterion(v);
    f.caption += ".";
    const auto known = [&](double value) {
      return std::ranges::any_of(
          stress.cells, [&](const StressCell& c) { return c.extreme == extreme.name && c.value == value; });
    };
    if (stress.complete && !std::ranges::all_of(extreme.values, known))
      f.caption += " White: values of which there is no reference.";
    figures.push_back(std::move(f));
  }
  return figures;
}

Figure long_run_figure(const Stress& stress, const std::string& scene) {
  Figure f;
  f.name = "long_run";
  f.title = "Very many steps: " + scene;
  f.columns = 2;
  f.width_mm = 180;
  f.height_mm = 95;
  Panel energy, constraint;
  energy.x.label = constraint.x.label = "steps";
  energy.y.label = "energy error (of the largest kinetic energy)";
  constraint.y.label = "constraint error (of a rod's length)";
  for (Axis* axis : {&energy.x, &energy.y, &constraint.x, &constraint.y}) axis->log = true;
  energy.y.zeros_at_floor = constraint.y.zeros_at_floor = true;
  for (std::size_t i = 0; i < stress.long_runs.size(); ++i) {
    const LongRun& run = stress.long_runs[i];
    Curve c;
    c.label = run.setting;
    c.color = static_cast<int>(i);
    c.dash = static_cast<Dash>(i % 4);
    c.marker = static_cast<Marker>(i / 4 % 5);
    c.x = run.step_count;
    c.y = run.energy_error;
    energy.curves.push_back(c);
    c.label.clear();
    c.y = run.constraint;
    constraint.curves.push_back(std::move(c));
  }
  f.caption = "Largest error so far";
  if (!stress.long_runs.empty())
    f.caption += ", step " + plot::format_number(stress.long_runs.front().step, 3) + " s";
  f.caption += ".";
  for (const LongRun& run : stress.long_runs)
    if (run.end != "done")
      f.caption += " " + run.setting + ": " + run.end + " after " + std::to_string(run.steps) + " steps.";
  f.panels = {std::move(energy), std::move(constraint)};
  return f;
}

}  // namespace unfurl
