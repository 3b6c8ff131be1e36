// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/rod_strength.hpp"

#include <cmath>

#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/rod_bands.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

std::string at_rod(const Structure& structure, const WorstRod& worst) {
  return " (rod " + structure.rods[static_cast<std::size_t>(worst.rod)].name + " at " +
         plot::format_number(worst.t, 5) + " s" + (worst.unique ? "" : open_force) + ")";
}

std::string margin_text(double ratio) {
  return ratio > 0 ? ", a margin of " + plot::format_number(margin_of(ratio), 3) : "";
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
  add_rod_curves(structure, d, 1e-6 * over_rods(structure, d, axial_stress), stress);
  Panel buckling = time_panel(run, "compression / Euler load");
  const WorstRod peak = worst_rod(structure, d, axial_stress),
                 compressed = worst_rod(structure, d, buckling_ratio),
                 stressed = worst_rod(structure, d, stress_ratio);
  if (compressed.value > 0.3) buckling.lines.push_back({1.0, true, "it buckles", 7});
  add_rod_curves(structure, d, over_rods(structure, d, buckling_ratio), buckling);
  share_time_axis(stress, buckling);
  f.caption =
      "Axial stress of the rods, force over area, and their compression as a share of Euler's load with "
      "pinned ends, both of the mean force over a rod's length.";
  if (peak.rod >= 0)
    f.caption += " Largest stress " + plot::format_number(1e-6 * std::abs(peak.value), 4) + " MPa" +
                 at_rod(structure, peak) + ".";
  if (any_strength(structure) && stressed.rod >= 0)
    f.caption += " Largest share of the strength " + plot::format_number(stressed.value, 3) +
                 at_rod(structure, stressed) + margin_text(stressed.value) + ".";
  if (compressed.rod >= 0 && compressed.value > 0)
    f.caption += " Largest share of Euler's load " + plot::format_number(compressed.value, 3) +
                 at_rod(structure, compressed) + margin_text(compressed.value) + ".";
  f.caption += " " + method_sentence(run);
  f.panels.push_back(std::move(stress));
  f.panels.push_back(std::move(buckling));
  return f;
}

}  // namespace unfurl
