#include "app/panel/trade.hpp"

#include <algorithm>
#include <cmath>

#include "core/study/tolerance.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {

namespace {

constexpr int present_color = 6;  // ink; the methods have the colours before it

double largest(const Diagnostics& diagnostics, const char* column) {
  const Series* series = diagnostics.find(column);
  double most = 0;
  if (series != nullptr)
    for (const double x : series->values)
      if (std::isfinite(x)) most = std::max(most, std::abs(x));
  return most;
}

}  // namespace

std::string setting_caption(const SolverOptions& options) {
  std::string text = options.method;
  if (order_depends_on_stages(options)) {
    text += ", " + std::to_string(options.stages) + " stages";
    if (options.nodes != "lobatto") text += ", " + options.nodes;
    if (options.constraints_at != "nodes") text += ", constraints at " + options.constraints_at;
  }
  return text + (options.adaptive ? ", steps up to " : ", step ") + plot::format_number(options.step, 4) +
         " s";
}

TradePoint trade_point(const LiveRun& run) {
  const Diagnostics& d = run.diagnostics;
  const double energy =
      std::max({largest(d, "kinetic_energy_J"), largest(d, "potential_energy_J"), largest(d, "work_J")});
  const double error = largest(d, "energy_balance_J");
  const SolverOptions& options = run.simulation.options;  // with a tolerance: as they were picked
  return {options.method,
          setting_caption(options),
          run.simulation.cpu_s,
          energy > 0 ? error / energy : error,
          largest(d, "constraint_max_m"),
          run.simulation.position_estimate};
}

std::string point_caption(const TradePoint& point) {
  std::string text = point.setting + "\nCPU time " + plot::format_number(point.cpu_s, 3) +
                     " s\nenergy error " + plot::format_number(point.error, 3) + " of the energy\n" +
                     "constraint error " + plot::format_number(point.constraint_error, 3) + " m";
  if (std::isfinite(point.position_error))
    text += "\nestimated position error " + plot::format_number(point.position_error, 3) + " m";
  return text;
}

plot::Point mark_of(const TradePoint& point, const plot::PanelLayout& panel) {
  const double y = point.error > 0 ? panel.y.scale(point.error) : panel.frame.y1;
  return {panel.x.scale(point.cpu_s), std::clamp(y, panel.frame.y0, panel.frame.y1)};
}

std::size_t nearest_point(const std::vector<TradePoint>& points, const plot::PanelLayout& panel,
                          const plot::Point& at, double reach) {
  std::size_t best = points.size();
  for (std::size_t i = points.size(); i-- > 0;) {  // of marks on one another the latest
    const plot::Point mark = mark_of(points[i], panel);
    const double way = std::hypot(mark.x - at.x, mark.y - at.y);
    if (way < reach) best = i, reach = way;
  }
  return best;
}

Figure trade_figure(const std::vector<TradePoint>& points) {
  Figure figure;
  figure.name = "trade";
  figure.title = "Speed against accuracy";
  figure.caption = "A point for every run of this session; the diamond is the present one.";
  figure.panels.emplace_back();
  Panel& panel = figure.panels.back();
  panel.x.label = "CPU time (s)";
  panel.y.label = "energy error (relative)";
  panel.x.log = panel.y.log = true;
  panel.y.zeros_at_floor = true;
  for (const TradePoint& point : points) {
    auto curve = std::find_if(panel.curves.begin(), panel.curves.end(),
                              [&](const Curve& c) { return c.label == point.method; });
    if (curve == panel.curves.end()) {
      Curve made;
      made.label = point.method;
      made.color = static_cast<int>(panel.curves.size()) % present_color;
      made.marker = Marker::circle;
      made.width = 0;  // points only
      curve = panel.curves.insert(panel.curves.end(), std::move(made));
    }
    for (const double x : {point.cpu_s, std::nan("")}) curve->x.push_back(x);  // NaN parts it from the next
    for (const double y : {point.error, std::nan("")}) curve->y.push_back(y);
  }
  if (points.empty()) return figure;
  Curve trail;
  for (std::size_t i = points.size() - std::min(points.size(), trail_length); i < points.size(); ++i) {
    trail.x.push_back(points[i].cpu_s);
    trail.y.push_back(points[i].error);
  }
  trail.color = 7;
  trail.width = 0.8f;
  trail.dash = Dash::dotted;
  panel.curves.insert(panel.curves.begin(), std::move(trail));
  Curve present;
  present.x = {points.back().cpu_s};
  present.y = {points.back().error};
  present.marker = Marker::diamond;
  present.color = present_color;
  present.width = 2.4f;
  present.label = "now";
  panel.curves.push_back(std::move(present));
  return figure;
}

}  // namespace unfurl
