// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/rod_bands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/plot/figures/rod_groups.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

// Without rods that are not shown, which no table has either.
MatrixXd of_shown(const Structure& structure, MatrixXd values) {
  const std::vector<char> shown = shown_rods(structure);
  for (std::size_t r = 0; r < shown.size(); ++r)
    if (!shown[r]) values.col(static_cast<Index>(r)).setConstant(std::nan(""));
  return values;
}

std::vector<double> column(const MatrixXd& values, int rod) {
  const VectorXd c = values.col(rod);
  return {c.begin(), c.end()};
}

// The smallest and largest value of some rods over time.
Band extremes(const Diagnostics& d, const MatrixXd& values, const std::vector<int>& rods) {
  Band band;
  band.x = d.t;
  for (Index i = 0; i < values.rows(); ++i) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const int r : rods) {
      const double x = values(i, r);
      low = std::isnan(x) || std::isnan(low) ? std::nan("") : std::min(low, x);
      high = std::isnan(x) || std::isnan(high) ? std::nan("") : std::max(high, x);
    }
    band.lower.push_back(low);
    band.upper.push_back(high);
  }
  return band;
}

double widest(const Band& band) {
  double width = 0;
  for (std::size_t i = 0; i < band.x.size(); ++i)
    if (band.upper[i] - band.lower[i] > width) width = band.upper[i] - band.lower[i];
  return width;
}

// The rods of a group whose forces are unique, or those whose are not.
struct Part {
  std::vector<int> rods;  // of the solved structure
  int shown = 0;          // of the whole
  bool unique = true;
};

std::array<Part, 2> parts_of(const RodGroup& group, const Structure& structure, const Diagnostics& d) {
  std::array<Part, 2> parts{Part{{}, 0, true}, Part{{}, 0, false}};
  const auto part = [&](int rod) -> Part& {
    return parts[d.rod_unique[static_cast<std::size_t>(rod)] ? 0 : 1];
  };
  for (const int r : group.rods) part(r).rods.push_back(r);
  for (const RodCopy& copy : structure.rod_copies)
    if (std::find(group.rods.begin(), group.rods.end(), copy.source) != group.rods.end())
      ++part(copy.source).shown;
  return parts;
}

std::string rods_text(const RodGroup& g, const Part& part) {
  return g.name + (part.shown == 1 ? " (1 rod)" : " (" + std::to_string(part.shown) + " rods)");
}

// Unique forces are solid or dash-dotted, others dashed or dotted, as captions say: neighbours differ without
// their colours.
Dash dash_of(bool unique, int color) {
  if (unique) return color % 2 == 0 ? Dash::solid : Dash::dash_dot;
  return color % 2 == 0 ? Dash::dashed : Dash::dotted;
}

// One line where all rods of the part carry the same to within the line's width, else the band between the
// extremes, dashed or dotted where the forces are not unique.
void add_part(const Diagnostics& d, const MatrixXd& values, const RodGroup& g, const Part& part, double same,
              Panel& p) {
  Band band = extremes(d, values, part.rods);
  const Dash dash = dash_of(part.unique, g.color);
  const std::string text = rods_text(g, part) + (part.unique ? "" : open_force);
  if (widest(band) <= same) {
    std::vector<double> middle(band.x.size());
    for (std::size_t i = 0; i < middle.size(); ++i) middle[i] = (band.lower[i] + band.upper[i]) / 2;
    p.curves.push_back(over_time(d, std::move(middle), text, g.color));
    p.curves.back().dash = dash;
    return;
  }
  for (const auto& edge : {band.lower, band.upper}) {
    p.curves.push_back(over_time(d, edge, "", g.color));
    p.curves.back().width = 0.8f;
    p.curves.back().dash = dash;
  }
  band.label = text + ", smallest to largest";
  band.color = g.color;
  p.bands.push_back(std::move(band));
}

void add_each(const Structure& structure, const Diagnostics& d, const MatrixXd& values, Panel& p) {
  const std::vector<Rod>& rods = structure.rods;
  const std::vector<char> shown = shown_rods(structure);
  const bool all = std::count(d.rod_unique.begin(), d.rod_unique.end(), 0) == 0;
  for (std::size_t r = 0; r < rods.size(); ++r) {
    if (!shown[r]) continue;
    const auto i = static_cast<int>(r);
    const bool unique = d.rod_unique[r] != 0;
    p.curves.push_back(over_time(d, column(values, i), rods[r].name + (unique ? "" : open_force), i));
    p.curves.back().dash = all ? static_cast<Dash>(i % 4) : dash_of(unique, i);
  }
}

// The groups whose values are known.
std::vector<RodGroup> known_groups(const Structure& structure, const MatrixXd& values) {
  std::vector<RodGroup> groups = rod_groups(structure);
  for (RodGroup& g : groups)
    std::erase_if(g.rods, [&](int r) { return values.rows() > 0 && values.col(r).array().isNaN().all(); });
  std::erase_if(groups, [](const RodGroup& g) { return g.rods.empty(); });
  return groups;
}

}  // namespace

std::string whose_peak(const Structure& structure, const RodPeak& peak) {
  const bool within_step = std::abs(peak.peak) > (1 + 1e-4) * std::abs(peak.at_state);
  return " (rod " + structure.rods[static_cast<std::size_t>(peak.rod)].name +
         (within_step ? " near " : " at ") + plot::format_number(peak.t, 5) + " s" +
         (peak.unique ? "" : open_force) + ")";
}

void mark_peak(double t, double value, Panel& p) {
  constexpr double seen = 0.005;  // beyond the line's own width
  double most = 0;
  const auto look = [&most](const std::vector<double>& values) {
    for (const double x : values)
      if (std::isfinite(x)) most = std::max(most, std::abs(x));
  };
  for (const Curve& curve : p.curves) look(curve.y);
  for (const Band& band : p.bands) look(band.lower), look(band.upper);
  if (!(std::abs(value) > (1 + seen) * most)) return;
  Curve mark;
  mark.label = "largest, within a step";
  mark.x = {t}, mark.y = {value};
  mark.color = 6, mark.marker = Marker::diamond, mark.width = 0;
  p.curves.push_back(std::move(mark));
}

bool each_rod_alone(const Structure& structure) {
  return structure.rods.size() <= 6 && rod_groups(structure).size() == 1;
}

double largest_finite(const MatrixXd& values) {
  double largest = 0;
  for (Index i = 0; i < values.size(); ++i)
    if (std::isfinite(values.data()[i])) largest = std::max(largest, std::abs(values.data()[i]));
  return largest;
}

void add_rod_curves(const Structure& structure, const Diagnostics& d, const MatrixXd& all, Panel& p) {
  const MatrixXd values = of_shown(structure, all);
  if (each_rod_alone(structure)) return add_each(structure, d, values, p);
  for (const RodGroup& g : known_groups(structure, values))
    for (const Part& part : parts_of(g, structure, d))
      if (part.shown > 0) add_part(d, values, g, part, 3e-3 * largest_finite(values), p);
}

}  // namespace unfurl
