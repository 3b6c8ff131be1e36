// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "core/math/types.hpp"
#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

std::vector<double> in_degrees(std::vector<double> radians) {
  for (double& a : radians) a /= radians_per_degree;
  return radians;
}

}  // namespace

Figure phase_figure(const Simulation& run, const Diagnostics& diagnostics) {
  Panel p;
  p.x.label = "fold angle (\u00B0)";
  p.y.label = "fold rate (\u00B0/s)";
  p.x.degrees = true;
  Curve path;
  path.x = in_degrees(diagnostics.at("fold_angle_rad").values);
  path.y = in_degrees(diagnostics.at("fold_rate_rad_s").values);
  Figure f;
  f.name = "phase";
  f.title = "Phase portrait";
  f.height_mm = 90;
  f.caption = "Fold rate over fold angle.";
  if (!path.x.empty()) {
    const auto end = [&](const char* label, double x, double y, int color, Marker marker) {
      Curve c;
      c.label = label;
      c.x = {x}, c.y = {y};
      c.color = color;
      c.marker = marker;
      p.curves.push_back(std::move(c));
    };
    const double size = largest_magnitude(path.x);
    const auto place = [&](double x, double y) {
      if (std::abs(x) < 1e-6 * size) x = 0;  // located by extrapolation, to some 1e-8
      return plot::format_number(x, 5) + "\u00B0 and " + plot::format_number(y, 4) + "\u00B0/s";
    };
    f.caption +=
        " From " + place(path.x.front(), path.y.front()) + " to " + place(path.x.back(), path.y.back()) + ".";
    const double x0 = path.x.front(), y0 = path.y.front(), x1 = path.x.back(), y1 = path.y.back();
    p.curves.push_back(std::move(path));
    end("start", x0, y0, 2, Marker::circle);
    end("end", x1, y1, 1, Marker::diamond);
  }
  f.caption += " " + method_sentence(run);
  f.panels.push_back(std::move(p));
  return f;
}

}  // namespace unfurl
