#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

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

std::string rods_text(const RodGroup& g) {
  return g.name + (g.shown == 1 ? " (1 rod)" : " (" + std::to_string(g.shown) + " rods)");
}

// One line where all rods of the group carry the same to within the line's width, else the band between the
// extremes.
void add_group(const Diagnostics& d, const RodGroup& g, double same, Panel& p) {
  Band band = extremes(d, g.rods);
  const Dash dash = g.color % 2 == 0 ? Dash::solid : Dash::dashed;
  if (widest(band) <= same) {
    std::vector<double> middle(band.x.size());
    for (std::size_t i = 0; i < middle.size(); ++i) middle[i] = (band.lower[i] + band.upper[i]) / 2;
    p.curves.push_back(over_time(d, std::move(middle), rods_text(g), g.color));
    p.curves.back().dash = dash;
    return;
  }
  for (const auto& edge : {band.lower, band.upper}) {
    p.curves.push_back(over_time(d, edge, "", g.color));
    p.curves.back().width = 0.8f;
    p.curves.back().dash = dash;
  }
  band.label = rods_text(g) + ", smallest to largest";
  band.color = g.color;
  p.bands.push_back(std::move(band));
}

void add_rods(const Simulation& run, const Diagnostics& d, Panel& p) {
  const std::vector<Rod>& rods = run.trajectory.structure().rods;
  for (std::size_t r = 0; r < rods.size(); ++r) {
    const auto i = static_cast<int>(r);
    p.curves.push_back(over_time(d, column(d.axial_force, i), rods[r].name, i));
    p.curves.back().dash = static_cast<Dash>(i % 4);
  }
}

}  // namespace

Figure rod_forces_figure(const Simulation& run, const Diagnostics& d) {
  const std::vector<RodGroup> groups = rod_groups(run.trajectory.structure());
  const auto rods = run.trajectory.structure().rods.size();
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
    for (const RodGroup& g : groups) add_group(d, g, 3e-3 * largest, p);
  f.caption = "Axial force of every rod, tension positive.";
  if (!one_by_one)
    f.caption =
        "Axial force of the rods by group, tension positive: one line where the forces of a group differ by "
        "less than "
        "its width, else the range between the extremes.";
  f.caption += " Largest magnitude " + plot::format_number(largest, 4) + " N. " + method_sentence(run);
  f.panels.push_back(std::move(p));
  return f;
}

}  // namespace unfurl
