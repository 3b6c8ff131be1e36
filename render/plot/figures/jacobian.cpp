// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "core/diagnostics/jacobian_spectrum.hpp"
#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

std::string ordinal(std::size_t k) {
  static constexpr const char* names[] = {"smallest", "second smallest", "third smallest"};
  return k < 3 ? names[k] : std::to_string(k + 1) + "th smallest";
}

}  // namespace

Figure jacobian_figure(const Simulation& run, const Diagnostics&) {
  const JacobianSpectrum spectrum = jacobian_spectrum(run);
  static constexpr Dash dashes[] = {Dash::solid, Dash::dashed, Dash::dash_dot};
  Panel p = time_panel(run, "singular value of G");
  p.y.log = p.y.zeros_at_floor = true;
  const auto add = [&](std::string label, const std::vector<double>& values, int color, Dash dash) {
    Curve c;
    c.label = std::move(label);
    c.x = spectrum.t;
    c.y = values;
    c.color = color;
    c.dash = dash;
    p.curves.push_back(std::move(c));
  };
  add("largest", spectrum.largest, 7, Dash::dotted);
  for (std::size_t k = 0; k < spectrum.smallest.size(); ++k)
    add(ordinal(k), spectrum.smallest[k], static_cast<int>(k), dashes[k % 3]);

  Figure f;
  f.name = "jacobian";
  f.title = "Singular values of the constraints' Jacobian";
  f.height_mm = 90;
  f.caption = "Jacobian G of all " + std::to_string(spectrum.constraints) + " constraints in " +
              std::to_string(spectrum.coordinates) + " coordinates, rows scaled to length 1, of rank " +
              std::to_string(spectrum.rank) + ", at " + std::to_string(spectrum.t.size()) +
              (spectrum.t.size() == 1 ? " state of the run." : " states of the run.");
  if (!spectrum.smallest.empty()) {
    const std::vector<double>& least = spectrum.smallest.front();
    const auto at = std::min_element(least.begin(), least.end());
    f.caption += " The smallest nonzero one starts at " + plot::format_number(least.front(), 3);
    if (*at >= (1 - 1e-9) * least.front())
      f.caption += " and is never less";
    else
      f.caption += " and is least, " + (*at > 0 ? plot::format_number(*at, 3) : "zero to round-off") +
                   ", at " +
                   plot::format_number(spectrum.t[static_cast<std::size_t>(at - least.begin())], 4) + " s";
    f.caption += ": where it vanishes the structure gains ways to move." + zeros_sentence(least);
  }
  f.panels.push_back(std::move(p));
  return f;
}

}  // namespace unfurl
