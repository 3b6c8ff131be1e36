// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <string>

#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {

Figure poisson_figure(const Simulation& run, const Diagnostics& diagnostics) {
  const Structure& structure = run.trajectory.structure();
  Panel top = time_panel(run, "length (m)");
  int color = 0;
  for (const int i : {structure.strain_along, structure.strain_across}) {
    const ReportedLength& m = structure.lengths[static_cast<std::size_t>(i)];
    top.curves.push_back(over_time(diagnostics, diagnostics.at(m.name).values, m.label, color));
    if (color++ > 0) top.curves.back().dash = Dash::dashed;
  }
  const std::vector<double>& ratio = diagnostics.at("poisson_ratio").values;
  Panel bottom = time_panel(run, "Poisson\u2019s ratio");
  bottom.curves.push_back(over_time(diagnostics, ratio, "", 2));

  // It has no bound in a flat pose, where there is no strain along.
  const auto known = [](double x) { return std::isfinite(x); };
  const auto first = std::ranges::find_if(ratio, known);
  const auto last = std::find_if(ratio.rbegin(), ratio.rend(), known);
  const std::string range = first == ratio.end()
                                ? "known in no state"
                                : "from " + plot::format_number(*first, 4) + " to " +
                                      plot::format_number(*last, 4) +
                                      (known(ratio.back()) ? "" : ", the last that is known");

  Figure f;
  f.name = "poisson";
  f.title = "Poisson\u2019s ratio";
  f.rows = 2;
  f.height_mm = 105;
  f.caption =
      "a, the lengths along and across the stretch. b, the ratio of their strain increments, "
      "\u2212(across\u2032/across) / (along\u2032/along), " +
      range + "; negative: the structure grows both ways. " + method_sentence(run);
  share_time_axis(top, bottom);
  f.panels = {std::move(top), std::move(bottom)};
  return f;
}

}  // namespace unfurl
