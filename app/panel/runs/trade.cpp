// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/trade.hpp"

#include <algorithm>
#include <cmath>

#include "core/diagnostics/accuracy.hpp"
#include "core/integrators/integrator.hpp"
#include "core/study/tolerance.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {

namespace {

using plot::format_number;

double largest(const Diagnostics& diagnostics, const char* column) {
  const Series* series = diagnostics.find(column);
  double most = 0;
  if (series != nullptr)
    for (const double x : series->values)
      if (std::isfinite(x)) most = std::max(most, std::abs(x));
  return most;
}

std::string cpu_text(double cpu_s) {
  return cpu_s < 1 ? format_number(1e3 * cpu_s, 3) + " ms" : format_number(cpu_s, 3) + " s";
}

}  // namespace

std::string setting_caption(const SolverOptions& options) {
  std::string text = options.method;
  if (order_depends_on_stages(options)) {
    text += ", " + std::to_string(options.stages) + " stages";
    if (options.nodes != "lobatto") text += ", " + options.nodes;
    if (options.constraints_at != "nodes") text += ", constraints at " + options.constraints_at;
  }
  return text + (options.adaptive ? ", steps up to " : ", step ") + format_number(options.step, 4) + " s";
}

TradePoint trade_point(const LiveRun& run) {
  const Diagnostics& d = run.diagnostics;
  const double energy = energy_turned_over(d);
  const double error = largest(d, "energy_balance_J");
  const SolverOptions& options = run.simulation.options;  // with a tolerance: as they were picked
  const std::string model = solved_as(run.simulation).name;
  return {.method = options.method,
          .setting = (model == "full" ? "" : model + ": ") + setting_caption(options),
          .cpu_s = run.simulation.cpu_s,
          .whole_cpu_s = run.simulation.cpu_s,
          .error = energy > 0 ? error / energy : error,
          .constraint_error = largest(d, "constraint_max_m"),
          .estimate = run.simulation.position_estimate,
          .run = run.id,
          .motion = run.motion};
}

void note_error(std::vector<TradePoint>& points, const RunError& error) {
  for (TradePoint& point : points) {
    if (point.run != error.run) continue;
    point.position_error = error.error;
    point.uncertainty = error.uncertainty;
    point.why = error.why;
    point.end = error.end;
    if (error.cpu_s > 0 && std::isfinite(error.error)) point.cpu_s = error.cpu_s;
    point.accuracy = std::isfinite(error.error) ? Accuracy::known
                     : error.why.empty()        ? Accuracy::no_answer
                                                : Accuracy::no_reference;
  }
}

const TradePoint* point_of(const std::vector<TradePoint>& points, const LiveRun& run) {
  const auto at =
      std::find_if(points.begin(), points.end(), [&](const TradePoint& p) { return p.run == run.id; });
  return at == points.end() ? nullptr : &*at;
}

bool below_uncertainty(const TradePoint& point) {
  return point.accuracy == Accuracy::known && point.position_error < point.uncertainty;
}

namespace {

std::string error_text(const TradePoint& point) {
  if (below_uncertainty(point)) return "below " + format_number(point.uncertainty, 2) + " m";
  return format_number(point.position_error, 3) + " m";
}

}  // namespace

std::string point_caption(const TradePoint& point) {
  std::string text = point.setting + "\nCPU time " + cpu_text(point.cpu_s);
  if (point.cpu_s != point.whole_cpu_s)
    text += " up to " + format_number(point.end, 4) + " s, " + cpu_text(point.whole_cpu_s) + " in all";
  if (point.accuracy == Accuracy::known)
    text += "\nposition error " + error_text(point) + "\nthe reference agrees with itself to " +
            format_number(point.uncertainty, 2) + " m";
  if (std::isfinite(point.estimate))
    text += "\nestimated position error " + format_number(point.estimate, 3) + " m";
  return text + "\nenergy error " + format_number(point.error, 3) + " of the energy\nconstraint error " +
         format_number(point.constraint_error, 3) + " m";
}

std::string present_sentence(const TradePoint& point) {
  const std::string cpu = cpu_text(point.cpu_s);
  switch (point.accuracy) {
    case Accuracy::waiting:
      return cpu + "; measuring the position error ...";
    case Accuracy::known:
      return "position error " + error_text(point) + " in " + cpu;
    case Accuracy::no_answer:
      return cpu + "; the run did not get to its end";
    case Accuracy::no_reference:
      break;
  }
  return "energy error " + format_number(point.error, 3) + " in " + cpu +
         "; position errors are not measured: " + point.why;
}

plot::Point mark_of(const TradePoint& point, bool positions, const plot::PanelLayout& panel) {
  const double error = shown_error(point, positions);
  if (std::isnan(error)) return {error, error};
  const double y = error > 0 ? panel.y.scale(error) : panel.frame.y1;
  return {panel.x.scale(point.cpu_s), std::clamp(y, panel.frame.y0, panel.frame.y1)};
}

std::size_t nearest_point(const std::vector<TradePoint>& points, const plot::PanelLayout& panel,
                          const plot::Point& at, double reach) {
  const bool positions = shows_positions(points);
  std::size_t best = points.size();
  for (std::size_t i = points.size(); i-- > 0;) {  // of marks on one another the latest
    const plot::Point mark = mark_of(points[i], positions, panel);
    const double way = std::hypot(mark.x - at.x, mark.y - at.y);
    if (way < reach) best = i, reach = way;
  }
  return best;
}

}  // namespace unfurl
