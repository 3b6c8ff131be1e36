// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/same_curves.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "render/plot/limits.hpp"
#include "render/plot/scale.hpp"

namespace unfurl::plot {
namespace {

constexpr double line_width = 3e-3;  // of a panel's height: half a point of 60 mm

bool same_values(const std::vector<double>& a, const std::vector<double>& b, const Scale& scale) {
  return std::ranges::equal(a, b, [&](double u, double v) {
    return u == v || (std::isnan(u) && std::isnan(v)) || std::abs(scale(u) - scale(v)) < line_width;
  });
}

std::string name_of(const Curve& curve, const Figure& figure) {
  if (!curve.label.empty() || curve.marker == Marker::none) return curve.label;
  for (const Panel& panel : figure.panels)
    for (const Curve& other : panel.curves)
      if (!other.label.empty() && other.color == curve.color && other.dash == curve.dash &&
          other.marker == curve.marker)
        return other.label;
  return {};
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 4;
  const std::size_t told = names.size() <= most ? names.size() - 1 : most - 1;
  std::string text = names[0];
  for (std::size_t i = 1; i < told; ++i) text += ", " + names[i];
  return text + " and " +
         (told + 1 == names.size() ? names[told] : std::to_string(names.size() - told) + " more");
}

// Groups of curves on each other, in the order of their first ones.
std::vector<std::string> groups_in(const Panel& panel, const Figure& figure) {
  const auto unit = [&](AxisOf which, const Axis& axis) {
    const Limits l = axis_limits(panel, which);
    return Scale{l.lo, l.hi, 0, 1, axis.log};
  };
  const Scale x = unit(AxisOf::x, panel.x), left = unit(AxisOf::y, panel.y),
              right = unit(AxisOf::y2, panel.y2);
  std::vector<std::string> out;
  std::vector<char> told(panel.curves.size(), 0);
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& first = panel.curves[i];
    std::vector<std::string> names{name_of(first, figure)};
    if (told[i] || names[0].empty() || std::ranges::all_of(first.y, [](double v) { return std::isnan(v); }))
      continue;
    for (std::size_t k = i + 1; k < panel.curves.size(); ++k) {
      const Curve& c = panel.curves[k];
      const std::string name = name_of(c, figure);
      if (told[k] || name.empty() || c.right_axis != first.right_axis || !same_values(first.x, c.x, x) ||
          !same_values(first.y, c.y, c.right_axis ? right : left))
        continue;
      told[k] = 1;
      names.push_back(name);
    }
    if (names.size() > 1) out.push_back(listed(names));
  }
  return out;
}

// What a panel shows, without its unit; over what, where another panel shows it, too.
std::string shown_in(const Panel& panel, const Figure& figure) {
  const auto bare = [](const std::string& label) { return label.substr(0, label.find(" (")); };
  const auto alike = std::ranges::count_if(
      figure.panels, [&](const Panel& other) { return !other.bare && other.y.label == panel.y.label; });
  return bare(panel.y.label) + (alike > 1 ? " over " + bare(panel.x.label) : "");
}

}  // namespace

std::string same_curves_sentence(const Figure& figure) {
  std::vector<std::pair<std::string, std::string>>
      groups;  // of names, and the quantities of which they are one
  for (const Panel& panel : figure.panels) {
    if (panel.bare || !panel.cells.empty()) continue;
    const std::string quantity = shown_in(panel, figure);
    for (const std::string& names : groups_in(panel, figure)) {
      const auto same = std::ranges::find(groups, names, &std::pair<std::string, std::string>::first);
      if (same == groups.end())
        groups.emplace_back(names, quantity);
      else
        same->second += ", " + quantity;
    }
  }
  std::string text;
  for (const auto& [names, quantities] : groups)
    text += " " + names + " lie on each other" + (figure.panels.size() > 1 ? " (" + quantities + ")." : ".");
  return text;
}

}  // namespace unfurl::plot
