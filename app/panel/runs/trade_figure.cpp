// SPDX-License-Identifier: BSD-3-Clause
// The figures of trade.hpp.
#include <algorithm>
#include <cmath>

#include "app/panel/runs/trade.hpp"
#include "core/integrators/integrator.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {

namespace {

constexpr int present_color = 6, other_color = 7;  // ink and grey; the methods have the colours before them
constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

// The same for a method in every figure, whatever else is shown.
int color_of(const std::string& method) {
  const auto all = methods();
  const auto at = std::find_if(all.begin(), all.end(), [&](const Method& m) { return m.name == method; });
  return static_cast<int>(at - all.begin()) % present_color;
}

void add_dot(Curve& curve, double x, double y) {
  for (const double value : {x, no_value}) curve.x.push_back(value);  // NaN parts it from the next
  for (const double value : {y, no_value}) curve.y.push_back(value);
}

// The curve of dots with that label, made where it is missing.
Curve& dots_of(Panel& panel, const std::string& label, int color) {
  const auto at = std::find_if(panel.curves.begin(), panel.curves.end(),
                               [&](const Curve& c) { return c.label == label; });
  if (at != panel.curves.end()) return *at;
  Curve made;
  made.label = label;
  made.color = color;
  made.marker = Marker::circle;
  made.width = 0;
  return *panel.curves.insert(panel.curves.end(), std::move(made));
}

void add_points(Panel& panel, const std::vector<TradePoint>& points, bool positions) {
  const auto other = [&](const TradePoint& p) {
    return positions && !same_motion(p.motion, points.back().motion);
  };
  for (const TradePoint& point : points)
    if (other(point) && !std::isnan(shown_error(point, positions)))
      add_dot(dots_of(panel, "other motions", other_color), point.cpu_s, shown_error(point, positions));
  for (const TradePoint& point : points)
    if (!other(point) && !std::isnan(shown_error(point, positions)))
      add_dot(dots_of(panel, point.method, color_of(point.method)), point.cpu_s,
              shown_error(point, positions));
}

// Along the latest points of the present motion.
Curve trail_of(const std::vector<TradePoint>& points, bool positions) {
  Curve trail;
  for (std::size_t i = points.size(); i-- > 0 && trail.x.size() < trail_length;) {
    const double error = shown_error(points[i], positions);
    if (std::isnan(error) || (positions && !same_motion(points[i].motion, points.back().motion))) continue;
    trail.x.push_back(points[i].cpu_s);
    trail.y.push_back(error);
  }
  std::reverse(trail.x.begin(), trail.x.end());
  std::reverse(trail.y.begin(), trail.y.end());
  trail.color = other_color;
  trail.width = 0.8f;
  trail.dash = Dash::dotted;
  return trail;
}

void add_present(Panel& panel, const TradePoint& point, bool positions) {
  const double error = shown_error(point, positions);
  if (std::isnan(error)) {
    panel.lines.push_back({point.cpu_s, false, "now", present_color});
    return;
  }
  Curve present;
  present.x = {point.cpu_s};
  present.y = {error};
  present.marker = Marker::diamond;
  present.color = present_color;
  present.width = 0;
  present.marker_size = 1.6f;
  present.label = "now";
  panel.curves.push_back(std::move(present));
}

// Where errors come near it, how well they are known.
void add_floor(Panel& panel, const TradePoint& present) {
  if (present.accuracy == Accuracy::known && present.position_error < 1e3 * present.uncertainty)
    panel.lines.push_back({present.uncertainty, true, "uncertainty of the reference", other_color});
}

void add_study(Panel& panel, const Study& study) {
  for (const StudyCurve& from : study.curves) {
    Curve curve;
    for (const MeasuredRun& run : from.runs) {
      curve.x.push_back(run.cpu_median);
      curve.y.push_back(run.ok() ? std::max(run.position_error, study.reference_uncertainty) : no_value);
    }
    curve.color = color_of(from.setting.options.method);
    curve.width = 0.6f;
    panel.curves.push_back(std::move(curve));
  }
}

}  // namespace

bool shows_positions(const std::vector<TradePoint>& points) {
  for (std::size_t i = points.size(); i-- > 0;)
    if (points[i].accuracy == Accuracy::known || points[i].accuracy == Accuracy::no_reference)
      return points[i].accuracy == Accuracy::known;
  return false;
}

double shown_error(const TradePoint& point, bool positions) {
  if (!positions) return point.error;
  return below_uncertainty(point) ? point.uncertainty : point.position_error;
}

Figure trade_figure(const std::vector<TradePoint>& points, const Study* study) {
  const bool positions = shows_positions(points);
  Figure figure;
  figure.name = "trade";
  figure.title = "Speed against accuracy";
  figure.caption = "A point for every run of this session; the diamond is the present one.";
  if (positions)
    figure.caption += " Grey: of other motions, each against its own reference.";
  else
    figure.caption += " Energy errors: no position error is known.";
  figure.panels.emplace_back();
  Panel& panel = figure.panels.back();
  panel.x.label = "CPU time (s)";
  panel.y.label = positions ? "position error (m)" : "energy error (relative)";
  panel.x.log = panel.y.log = true;
  panel.y.zeros_at_floor = true;
  if (points.empty()) return figure;
  if (positions && study != nullptr) {
    add_study(panel, *study);
    figure.caption += " Thin lines: the study of this motion.";
  }
  panel.curves.push_back(trail_of(points, positions));
  add_points(panel, points, positions);
  add_present(panel, points.back(), positions);
  if (positions) add_floor(panel, points.back());
  return figure;
}

Figure with_present(Figure study, const std::vector<TradePoint>& points) {
  if (points.empty() || study.panels.empty()) return study;
  Panel& panel = study.panels.front();
  panel.curves.push_back(trail_of(points, true));
  add_present(panel, points.back(), true);
  return study;
}

}  // namespace unfurl
