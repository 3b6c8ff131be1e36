// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/rod_strength.hpp"

#include "core/diagnostics/force_round_off.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/rod_bands.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/same_curves.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

std::string at_rod(const Structure& structure, const WorstRod& worst, double peak) {
  return whose_peak(structure, {peak, worst.value, worst.rod, worst.t, worst.unique});
}

std::string margin_text(double ratio) {
  return ratio > 0 ? ", a margin of " + plot::format_number(margin_of(ratio), 3) : "";
}

// Values are those of the motion, as in summary.json; marked in the panels.
std::string peak_sentences(const Simulation& run, const Diagnostics& d, Panel& stresses, Panel& buckling) {
  const Structure& structure = run.trajectory.structure();
  if (only_round_off(run, d)) return " Largest stress 0 MPa.";
  const RememberedExtremes once;
  std::string text;
  if (const WorstRod worst = worst_rod(run, d, axial_stress); worst.rod >= 0) {
    const double stress = find_measure("peak_stress").value(run, d);
    mark_peak(worst.t, 1e-6 * worst.value, stresses);
    text += " Largest stress " + plot::format_number(1e-6 * stress, 4) + " MPa" +
            at_rod(structure, worst, stress) + ".";
  }
  if (const WorstRod worst = worst_rod(run, d, stress_ratio); any_strength(structure) && worst.rod >= 0) {
    const double share = largest_of_column(run, d, "stress_ratio_max");
    text += " Largest share of the strength " + plot::format_number(share, 3) +
            at_rod(structure, worst, share) + margin_text(share) + ".";
  }
  if (const WorstRod worst = worst_rod(run, d, buckling_ratio); worst.rod >= 0) {
    const double share = largest_of_column(run, d, "buckling_ratio_max");
    if (share > 0) {
      mark_peak(worst.t, share, buckling);
      text += " Largest share of Euler's load " + plot::format_number(share, 3) +
              at_rod(structure, worst, share) + margin_text(share) + ".";
    }
  }
  return text;
}

}  // namespace

Figure rod_strength_figure(const Simulation& run, const Diagnostics& d) {
  const Structure& structure = run.trajectory.structure();
  Figure f;
  f.name = "rod_strength";
  f.title = "What the rods bear";
  f.rows = 2;
  f.height_mm = 140;
  Panel stress = time_panel(run, "axial stress (MPa), tension > 0");
  stress.lines.push_back({0.0, true, "", 7});
  const auto values = [&](double (*quantity)(const Rod&, double)) {
    return without_round_off(run, d, over_rods(structure, d, quantity));
  };
  add_rod_curves(structure, d, 1e-6 * values(axial_stress), stress);
  Panel buckling = time_panel(run, "compression / Euler load");
  if (worst_rod(structure, d, buckling_ratio).value > 0.3)
    buckling.lines.push_back({1.0, true, "it buckles", 7});
  add_rod_curves(structure, d, values(buckling_ratio), buckling);
  share_time_axis(stress, buckling);
  f.caption =
      "Axial stress of the rods, force over area, and their compression as a share of Euler's load with "
      "pinned ends, both of the mean force over a rod's length.";
  f.caption += peak_sentences(run, d, stress, buckling);
  f.panels.push_back(std::move(stress));
  f.panels.push_back(std::move(buckling));
  f.caption += " " + method_sentence(run) + plot::same_curves_sentence(f);
  return f;
}

}  // namespace unfurl
