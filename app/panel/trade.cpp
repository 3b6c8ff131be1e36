#include "app/panel/trade.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {

namespace {

double largest(const Diagnostics& diagnostics, const char* column) {
  const Series* series = diagnostics.find(column);
  double most = 0;
  if (series != nullptr)
    for (const double x : series->values)
      if (std::isfinite(x)) most = std::max(most, std::abs(x));
  return most;
}

}  // namespace

TradePoint trade_point(const LiveRun& run) {
  const Diagnostics& d = run.diagnostics;
  const double energy =
      std::max({largest(d, "kinetic_energy_J"), largest(d, "potential_energy_J"), largest(d, "work_J")});
  const double error = largest(d, "energy_balance_J");
  return {run.scene.solver.method, run.simulation.cpu_s, energy > 0 ? error / energy : error};
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
      made.color = static_cast<int>(panel.curves.size());
      made.marker = Marker::circle;
      made.width = 0;  // points only
      curve = panel.curves.insert(panel.curves.end(), std::move(made));
    }
    for (const double x : {point.cpu_s, std::nan("")}) curve->x.push_back(x);  // NaN parts it from the next
    for (const double y : {point.error, std::nan("")}) curve->y.push_back(y);
  }
  if (points.empty()) return figure;
  Curve present;
  present.x = {points.back().cpu_s};
  present.y = {points.back().error};
  present.marker = Marker::diamond;
  present.color = 6;
  present.width = 2.4f;
  present.label = "now";
  panel.curves.push_back(std::move(present));
  return figure;
}

}  // namespace unfurl
