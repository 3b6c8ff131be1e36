// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/force_round_off.hpp"
#include "core/diagnostics/force_uniqueness.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/diagnostics/rod_strength.hpp"
#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/rod_bands.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/same_curves.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

std::string uniqueness_sentence(const Structure& structure, const Diagnostics& d) {
  const std::size_t rods = structure.rod_copies.size(), open = rods - unique_rods(structure, d);
  const char* symmetric = structure.sectors > 1 ? " under the symmetry of the sector" : "";
  const std::string shared =
      any_elastic(structure) ? " Rods share by their stiffness what rigid ones leave open." : "";
  if (open == 0) return shared + " The model determines all of them" + symmetric + ".";
  return shared + " Dashed or dotted: not unique, the model does not determine the force of " +
         std::to_string(open) + " of the " + std::to_string(rods) + " rods" + symmetric +
         "; shown is the choice of least norm, scaled by mass.";
}

// What it names is marked in the panel.
std::string peak_sentence(const Simulation& run, const Diagnostics& d, Panel& panel) {
  const RememberedExtremes once;
  const PeakForce peak = peak_rod_force(run, d);
  if (peak.rod < 0 || only_round_off(run, d)) return " Largest magnitude 0 N.";
  const double force = find_measure("peak_rod_force").value(run, d);
  mark_peak(peak.t, peak.force_N, panel);
  const bool bounded = extreme_of_column(run, d, "axial_force_max_N", true).bounded &&
                       extreme_of_column(run, d, "axial_force_min_N", false).bounded;
  return " Largest magnitude " + plot::format_number(force, 4) + " N" +
         whose_peak(run.trajectory.structure(),
                    {force, peak.force_N, peak.rod, peak.t, peak.unique || !bounded}) +
         "." +
         (bounded
              ? ""
              : " Forces grow without bound towards a singular pose on the way: the largest is that of the "
                "nearest pose that was looked at.");
}

}  // namespace

Figure rod_forces_figure(const Simulation& run, const Diagnostics& d) {
  const Structure& structure = run.trajectory.structure();
  Figure f;
  f.name = "rod_forces";
  f.title = "Rod forces";
  f.height_mm = 85;
  Panel p = time_panel(run, "axial force (N), tension > 0");
  p.lines.push_back({0.0, true, "", 7});
  add_rod_curves(structure, d, without_round_off(run, d, d.axial_force), p);
  f.caption = "Axial force of every rod, tension positive, the mean over its length.";
  if (!each_rod_alone(structure))
    f.caption =
        "Axial force of the rods by group, tension positive, the mean over a rod's length: one line where "
        "the forces of a group differ by less than its width, else the range between the extremes.";
  f.caption += uniqueness_sentence(structure, d) + peak_sentence(run, d, p);
  f.panels.push_back(std::move(p));
  f.caption += " " + method_sentence(run) + plot::same_curves_sentence(f);
  return f;
}

}  // namespace unfurl
