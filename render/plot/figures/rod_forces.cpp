// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/diagnostics/force_uniqueness.hpp"
#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/rod_groups.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

std::vector<double> column(const MatrixXd& forces, int rod) {
  const VectorXd c = forces.col(rod);
  return {c.begin(), c.end()};
}

// The smallest and largest force of some rods over time.
Band extremes(const Diagnostics& d, const std::vector<int>& rods) {
  Band band;
  band.x = d.t;
  for (Index i = 0; i < d.axial_force.rows(); ++i) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const int r : rods) {
      const double f = d.axial_force(i, r);
      low = std::isnan(f) || std::isnan(low) ? std::nan("") : std::min(low, f);
      high = std::isnan(f) || std::isnan(high) ? std::nan("") : std::max(high, f);
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

constexpr const char* open_text = ", not unique";

// Unique forces are solid or dash-dotted, others dashed or dotted: neighbours differ without their colours.
Dash dash_of(bool unique, int color) {
  if (unique) return color % 2 == 0 ? Dash::solid : Dash::dash_dot;
  return color % 2 == 0 ? Dash::dashed : Dash::dotted;
}

// One line where all rods of the part carry the same to within the line's width, else the band between the
// extremes, dashed or dotted where the forces are not unique.
void add_part(const Diagnostics& d, const RodGroup& g, const Part& part, double same, Panel& p) {
  Band band = extremes(d, part.rods);
  const Dash dash = dash_of(part.unique, g.color);
  const std::string text = rods_text(g, part) + (part.unique ? "" : open_text);
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

void add_rods(const Simulation& run, const Diagnostics& d, Panel& p) {
  const std::vector<Rod>& rods = run.trajectory.structure().rods;
  const bool all = std::count(d.rod_unique.begin(), d.rod_unique.end(), 0) == 0;
  for (std::size_t r = 0; r < rods.size(); ++r) {
    const auto i = static_cast<int>(r);
    const bool unique = d.rod_unique[r] != 0;
    p.curves.push_back(over_time(d, column(d.axial_force, i), rods[r].name + (unique ? "" : open_text), i));
    p.curves.back().dash = all ? static_cast<Dash>(i % 4) : dash_of(unique, i);
  }
}

std::string uniqueness_sentence(const Structure& structure, const Diagnostics& d) {
  const std::size_t rods = structure.rod_copies.size(), open = rods - unique_rods(structure, d);
  const char* symmetric = structure.sectors > 1 ? " under the symmetry of the sector" : "";
  if (open == 0) return std::string(" The model determines all of them") + symmetric + ".";
  return " Dashed or dotted: not unique, the rigid model does not determine the force of " +
         std::to_string(open) + " of the " + std::to_string(rods) + " rods" + symmetric +
         "; shown is the choice of least norm, scaled by mass.";
}

std::string peak_sentence(const Structure& structure, const Diagnostics& d) {
  const PeakForce peak = peak_rod_force(d);
  std::string text = " Largest magnitude " + plot::format_number(std::abs(peak.force_N), 4) + " N";
  if (peak.rod >= 0)
    text += " (rod " + structure.rods[static_cast<std::size_t>(peak.rod)].name + " at " +
            plot::format_number(peak.t, 5) + " s" + (peak.unique ? "" : open_text) + ")";
  return text + ".";
}

}  // namespace

Figure rod_forces_figure(const Simulation& run, const Diagnostics& d) {
  const Structure& structure = run.trajectory.structure();
  const std::vector<RodGroup> groups = rod_groups(structure);
  const auto rods = structure.rods.size();
  const bool one_by_one = rods <= 6 && groups.size() == 1;
  double largest = 0;
  for (Index i = 0; i < d.axial_force.size(); ++i)
    if (std::isfinite(d.axial_force.data()[i]))
      largest = std::max(largest, std::abs(d.axial_force.data()[i]));

  Figure f;
  f.name = "rod_forces";
  f.title = "Rod forces";
  f.height_mm = 85;
  Panel p = time_panel(run, "axial force (N), tension > 0");
  p.lines.push_back({0.0, true, "", 7});
  if (one_by_one)
    add_rods(run, d, p);
  else
    for (const RodGroup& g : groups)
      for (const Part& part : parts_of(g, structure, d))
        if (part.shown > 0) add_part(d, g, part, 3e-3 * largest, p);
  f.caption = "Axial force of every rod, tension positive, the mean over its length.";
  if (!one_by_one)
    f.caption =
        "Axial force of the rods by group, tension positive, the mean over a rod's length: one line where "
        "the "
        "forces of a group differ by less than its width, else the range between the extremes.";
  f.caption += uniqueness_sentence(structure, d) + peak_sentence(structure, d) + " " + method_sentence(run);
  f.panels.push_back(std::move(p));
  return f;
}

}  // namespace unfurl
