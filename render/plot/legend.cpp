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

// Of its sample and the gap behind it.
double sample_width(const LegendEntry& e) {
  return e.curve || e.band ? legend_sample + sample_gap : 0;
}

double entry_width(const LegendEntry& e) {
  return sample_width(e) + text_width(e.label.text, small_size);
}

void put(LegendEntry& e, double x, double middle) {
  e.sample = {x, middle};
  e.label.at = {x + sample_width(e), middle + cap_height * small_size / 2};
}

using Rows = std::vector<std::vector<LegendEntry>>;

// As many entries in each row as fit.
Rows rows_of(std::vector<LegendEntry> entries, double width) {
  Rows rows;
  double x = 0;
  for (LegendEntry& e : entries) {
    e.label.text = shorten_text(e.label.text, small_size, std::max(10.0, width - legend_sample - sample_gap));
    const double w = entry_width(e);
    if (rows.empty() || x + w > width) rows.emplace_back(), x = 0;
    x += w + entry_gap;
    rows.back().push_back(std::move(e));
  }
  return rows;
}

// What does not fit into so many rows is counted in the last entry, which has no sample.
Rows rows_of(const Panel& panel, double width, int most) {
  const std::vector<LegendEntry> all = entries_of(panel);
  if (most < 1) return {};
  Rows rows = rows_of(all, width);
  const auto limit = static_cast<std::size_t>(most);
  std::size_t fit = 0;
  for (std::size_t r = 0; r < std::min(limit, rows.size()); ++r) fit += rows[r].size();
  for (std::size_t shown = fit + 1; shown-- > 0 && rows.size() > limit;) {
    std::vector<LegendEntry> some(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(shown));
    const std::string rest = "and " + std::to_string(all.size() - shown) + " more";
    some.push_back({nullptr, nullptr, {}, {{}, rest, {small_size, ink}}});
    rows = rows_of(std::move(some), width);
  }
  return rows;
}

}  // namespace

bool has_legend(const Panel& panel) {
  return !entries_of(panel).empty();
}

int legend_rows(const Panel& panel, double width, int most) {
  return static_cast<int>(rows_of(panel, width, most).size());
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

Legend legend_above(const Panel& panel, Point at, double width, int most) {
  Rows rows = rows_of(panel, width, most);
  Legend out;
  out.inside = false;
  out.box = {at.x, at.y - static_cast<double>(rows.size()) * legend_row_height, at.x + width, at.y};
  double middle = out.box.y0 + legend_row_height / 2;
  for (auto& row : rows) {
    double x = at.x;
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
