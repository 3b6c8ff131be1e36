// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/legend.hpp"

#include <algorithm>

#include "render/plot/obstacles_of.hpp"
#include "render/plot/panel_layout.hpp"
#include "render/plot/style.hpp"
#include "render/plot/text_metrics.hpp"

namespace unfurl::plot {
namespace {

constexpr double sample_gap = 4.0, padding = 3.0, entry_gap = 14.0;

std::vector<LegendEntry> entries_of(const Panel& panel) {
  std::vector<LegendEntry> entries;
  const auto add = [&](const std::string& label, const Curve* curve, const Band* band) {
    if (!label.empty()) entries.push_back({curve, band, {}, {{}, label, {small_size, ink}}});
  };
  if (panel.cells.empty())  // on a map, lines are labelled where they are
    for (const Curve& c : panel.curves) add(c.label, &c, nullptr);
  for (const Band& b : panel.bands) add(b.label, nullptr, &b);
  return entries;
}

double entry_width(const LegendEntry& e) {
  return legend_sample + sample_gap + text_width(e.label.text, small_size);
}

void put(LegendEntry& e, double x, double middle) {
  e.sample = {x, middle};
  e.label.at = {x + legend_sample + sample_gap, middle + cap_height * small_size / 2};
}

// The entries of each row above a frame: as many as fit.
std::vector<std::vector<LegendEntry>> rows_of(const Panel& panel, double width) {
  std::vector<std::vector<LegendEntry>> rows;
  double x = 0;
  for (LegendEntry& e : entries_of(panel)) {
    e.label.text = shorten_text(e.label.text, small_size, std::max(10.0, width - legend_sample - sample_gap));
    const double w = entry_width(e);
    if (rows.empty() || x + w > width) rows.emplace_back(), x = 0;
    x += w + entry_gap;
    rows.back().push_back(std::move(e));
  }
  return rows;
}

}  // namespace

int legend_rows(const Panel& panel, double width) {
  return static_cast<int>(rows_of(panel, width).size());
}

std::optional<Legend> inside_legend(const Panel& panel, const PanelLayout& layout) {
  Legend out;
  out.entries = entries_of(panel);
  if (out.entries.empty()) return std::nullopt;
  double width = 0;
  for (const LegendEntry& e : out.entries) width = std::max(width, entry_width(e));
  width += 2 * padding;
  const double height = static_cast<double>(out.entries.size()) * legend_row_height + padding;
  const Rect region = layout.frame.grown(-3);
  const double share = panel.bare ? 1.0 : 0.7;  // a bare panel may hold nothing but the legend
  if (width > share * region.width() || height > share * region.height()) return std::nullopt;
  const Spot spot = free_spot(obstacles_of(panel, layout), region, width, height);
  if (spot.hidden > 0) return std::nullopt;
  out.box = spot.box;
  double middle = out.box.y0 + padding / 2 + legend_row_height / 2;
  for (LegendEntry& e : out.entries) put(e, out.box.x0 + padding, middle), middle += legend_row_height;
  return out;
}

Legend legend_above(const Panel& panel, const Rect& frame, double bottom) {
  auto rows = rows_of(panel, frame.width());
  Legend out;
  out.inside = false;
  out.box = {frame.x0, bottom - static_cast<double>(rows.size()) * legend_row_height, frame.x1, bottom};
  double middle = out.box.y0 + legend_row_height / 2;
  for (auto& row : rows) {
    double x = frame.x0;
    for (LegendEntry& e : row) {
      put(e, x, middle);
      x += entry_width(e) + entry_gap;
      out.entries.push_back(std::move(e));
    }
    middle += legend_row_height;
  }
  return out;
}

}  // namespace unfurl::plot
