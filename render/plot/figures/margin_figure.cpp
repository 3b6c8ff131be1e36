// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/margin_figure.hpp"

#include <algorithm>
#include <cmath>

#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

constexpr double most_margin = 20;  // drawn: where hardly anything resists a margin means little
constexpr int zero_line = 7;

double along(const Margin& margin, double fold_angle, double s) {
  return margin.unit == "N m" ? fold_angle / radians_per_degree : s;
}

// Values of all sources at a pose, those of one sign above each other.
void add_stack(const Margin& margin, double sign, Panel& panel) {
  double largest = 0;
  for (const MarginPoint& p : margin.points) largest = std::max(largest, p.forces.lpNorm<Eigen::Infinity>());
  std::vector<double> floor(margin.points.size(), 0.0);
  for (std::size_t k = 0; k < margin.sources.size(); ++k) {
    Band band{margin.sources[k].name, {}, {}, {}, static_cast<int>(k)};
    bool any = false;
    for (std::size_t i = 0; i < margin.points.size(); ++i) {
      const MarginPoint& p = margin.points[i];
      const double own = sign * std::max(0.0, sign * p.forces[static_cast<Index>(k)]);
      any = any || std::abs(own) > 1e-12 * largest;  // less is rounding
      band.x.push_back(along(margin, p.fold_angle, p.s));
      band.lower.push_back(std::min(floor[i], floor[i] + own));
      band.upper.push_back(std::max(floor[i], floor[i] + own));
      floor[i] += own;
    }
    if (!any) continue;
    const bool named = std::any_of(panel.bands.begin(), panel.bands.end(),
                                   [&](const Band& other) { return other.label == band.label; });
    if (named) band.label.clear();
    panel.bands.push_back(std::move(band));
  }
}

double drawn(double margin) {
  return margin <= most_margin ? margin : std::numeric_limits<double>::quiet_NaN();
}

std::string words(double margin) {
  if (std::isnan(margin)) return "none";
  return std::isfinite(margin) ? plot::format_number(margin, 4) : "without bound";
}

// "bar bears 12 N m at rest, and is met at 0.4 rad/s with 3 J."
std::string told(const MarginLoad& load) {
  const bool pulls = load.load < 0;
  std::string out = load.name + (pulls ? " holds " : " bears ") + words(std::abs(load.load));
  if (std::isfinite(load.load)) out += load.turns ? " N m" : " N";
  if (pulls) out += " back";
  if (std::isnan(load.speed)) return out + " at rest, and is not reached.";
  return out + " at rest, and is met at " + plot::format_number(load.speed, 4) +
         (load.turns ? " rad/s" : " m/s") + " with " + plot::format_number(load.energy, 4) + " J.";
}

}  // namespace

Figure margin_figure(const Margin& margin, const std::string& title) {
  const bool folds = margin.unit == "N m";
  const std::string across = folds ? "fold angle (\u00B0)" : "way along the path (m \u221Akg)";
  Panel forces, margins;
  forces.title = "Drives above, resistances below zero";
  forces.y.label = folds ? "torque about the fold angle (N m)" : "force along the path (N/\u221Akg)";
  forces.x.label = margins.x.label = across;
  forces.x.shown = false;
  add_stack(margin, 1.0, forces);
  add_stack(margin, -1.0, forces);
  forces.lines.push_back({0.0, true, "", zero_line});
  margins.title = "Margins";
  margins.y.label = "margin";
  Curve still{"static, at rest", {}, {}, 0}, moving{"dynamic, along the motion", {}, {}, 1, Dash::dashed};
  for (const MarginPoint& p : margin.points) {
    still.x.push_back(along(margin, p.fold_angle, p.s));
    still.y.push_back(drawn(p.margin));
  }
  for (const MarginReach& r : margin.motion) {
    moving.x.push_back(along(margin, r.fold_angle, r.s));
    moving.y.push_back(drawn(r.margin()));
  }
  const auto shown = [](const Curve& curve) {
    return std::ranges::any_of(curve.y, [](double y) { return std::isfinite(y); });
  };
  const bool any = shown(still) || shown(moving);
  std::string high;  // what is above the panel everywhere
  if (any && !shown(still)) high = "static";
  const bool sets_out = shown(moving) || !(margin.dynamic_min <= most_margin);
  if (any && !shown(moving) && margin.dynamic_min > most_margin) high = "dynamic";
  for (Curve* curve : {&still, &moving})
    if (shown(*curve)) margins.curves.push_back(std::move(*curve));
  margins.lines.push_back({0.0, true, "", zero_line});
  Figure figure{"margin", "Margins: " + title, "", 2, 1, {std::move(forces), std::move(margins)}};
  figure.height_mm = 150;
  if (!any) {  // hardly anything resists
    figure.panels.pop_back();
    figure.rows = 1;
    figure.height_mm = 85;
    figure.panels[0].x.shown = true;
  }
  const MarginReach& last = margin.motion.back();
  const auto place = [&](double fold_angle, double s) {
    return plot::format_number(along(margin, fold_angle, s), 4) + (folds ? "\u00B0" : " m \u221Akg");
  };
  figure.caption = "Least static margin " + words(margin.worst.margin) + " at " +
                   place(margin.worst.fold_angle, margin.worst.s) + ", least dynamic margin " +
                   words(margin.dynamic_min) + "; " + told_end(margin, place(last.fold_angle, last.s)) + ".";
  if (!sets_out) figure.caption += " The motion does not set out, and no dynamic margin is drawn.";
  if (!any)
    figure.caption += sets_out ? " No margin is as low as 20, and none is drawn."
                               : " No static margin is as low as 20, and none is drawn.";
  if (!high.empty()) figure.caption += " No " + high + " margin is as low as 20, and none is drawn.";
  for (const MarginSource& source : margin.sources)
    if (source.factor != 1.0)
      figure.caption += " " + source.name + " times " + plot::format_number(source.factor, 4) + ".";
  for (const MarginLoad& load : margin.loads)
    figure.caption += (load.kind == "stop" ? " Stop " : " ") + told(load);
  return figure;
}

}  // namespace unfurl
