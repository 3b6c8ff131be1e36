// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/diagnostics/force_uniqueness.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {

namespace {

constexpr double round_off = 1e-12;  // of the largest value on the way: what was given and taken back
constexpr double none = std::numeric_limits<double>::quiet_NaN();

double largest(const LiveRun& run, std::string_view column) {
  const Series* series = run.diagnostics.find(column);
  if (series == nullptr) return none;
  double most = 0;
  for (const double x : series->values)
    if (std::isfinite(x)) most = std::max(most, std::abs(x));
  return most;
}

double deployed_at(const LiveRun& run) {
  for (const Event& event : run.simulation.events)
    if (event.name == "deployed") return event.t;
  return none;
}

double peak_force(const LiveRun& run) {
  const PeakForce peak = peak_rod_force(run.diagnostics);
  return peak.rod < 0 ? none : std::abs(peak.force_N);
}

double last(const LiveRun& run, std::string_view column) {
  const Series* series = run.diagnostics.find(column);
  return series == nullptr || series->values.empty() ? none : series->values.back();
}

// The columns of either run's drives, each once.
std::vector<const Series*> drive_columns(const LiveRun& a, const LiveRun& b) {
  std::vector<const Series*> found;
  const auto there = [&](const Series& column) {
    return std::ranges::any_of(found, [&](const Series* have) { return have->name == column.name; });
  };
  for (const LiveRun* run : {&a, &b})
    for (const Series& column : run->diagnostics.columns)
      for (const std::string_view end : {".torque_N_m", ".force_N", ".power_W", ".energy_J"})
        if (column.name.ends_with(end) && !there(column)) found.push_back(&column);
  return found;
}

struct Quantity {
  const char *label, *unit;
  double (*of)(const LiveRun&);
  bool factor;  // compared by factors rather than by per cent
};

constexpr Quantity quantities[] = {
    {"deployed at", "s", deployed_at, false},
    {"peak rod force", "N", peak_force, false},
    {"energy error", "J", [](const LiveRun& r) { return largest(r, "energy_balance_J"); }, true},
    {"constraint error", "m", [](const LiveRun& r) { return largest(r, "constraint_max_m"); }, true},
    {"steps", "", [](const LiveRun& r) { return static_cast<double>(r.simulation.steps); }, true},
    {"CPU time", "s", [](const LiveRun& r) { return r.simulation.cpu_s; }, true}};

std::string number(double x, const std::string& unit) {
  if (std::isnan(x)) return "\u2013";
  return plot::format_number(x, 4) + (unit.empty() ? "" : " " + unit);
}

std::string change(double a, double b, bool factor) {
  if (!(std::abs(a) > 0) || !std::isfinite(b)) return "";
  if (factor) return "\u00D7" + plot::format_number(b / a, 3);
  char text[40];
  std::snprintf(text, sizeof text, "%+.3g %%", 100 * (b - a) / std::abs(a));
  return text;
}

}  // namespace

std::vector<ComparisonRow> compare(const LiveRun& a, const LiveRun& b, const TradePoint* point_a,
                                   const TradePoint* point_b) {
  std::vector<ComparisonRow> rows;
  const auto add = [&](const std::string& label, const std::string& unit, double x, double y, bool factor) {
    if (std::isnan(x) && std::isnan(y)) return;
    rows.push_back({label, number(x, unit), number(y, unit), change(x, y, factor)});
  };
  const auto error = [](const TradePoint* point) { return point ? point->position_error : none; };
  add("position error", "m", error(point_a), error(point_b), true);
  for (auto [point, text] : {std::pair{point_a, &ComparisonRow::a}, std::pair{point_b, &ComparisonRow::b}})
    if (point && below_uncertainty(*point)) {
      rows.back().*text = "below " + number(point->uncertainty, "m");
      rows.back().change.clear();
    }
  for (const Quantity& q : quantities) add(q.label, q.unit, q.of(a), q.of(b), q.factor);
  for (const Series* column : drive_columns(a, b)) {
    const bool energy = column->unit == "J";
    const auto of = [&](const LiveRun& run) { return (energy ? last : largest)(run, column->name); };
    const double x = of(a), y = of(b), most = std::fmax(largest(a, column->name), largest(b, column->name));
    add(energy ? column->label : "peak " + column->label, column->unit, x, y, false);
    if (std::fmax(std::abs(x), std::abs(y)) <= round_off * most) rows.back().change.clear();
  }
  for (ComparisonRow& row : rows) {
    if (row.label != "peak rod force") continue;
    if (!peak_rod_force(a.diagnostics).unique) row.a += "*";
    if (!peak_rod_force(b.diagnostics).unique) row.b += "*";
    if (row.a.ends_with("*") || row.b.ends_with("*")) row.label += " (* not unique)";
  }
  return rows;
}

}  // namespace unfurl
