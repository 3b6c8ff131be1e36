// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

// Counts of values between edges[k] and edges[k + 1], the last edge included.
struct Histogram {
  std::vector<double> edges, counts;
};

Histogram histogram(const std::vector<double>& values, std::vector<double> edges) {
  Histogram h{std::move(edges), {}};
  h.counts.assign(h.edges.size() - 1, 0.0);
  for (const double v : values) {
    const auto after = std::upper_bound(h.edges.begin(), h.edges.end(), v) - h.edges.begin();
    const auto k = std::clamp<std::ptrdiff_t>(after - 1, 0, std::ssize(h.counts) - 1);
    ++h.counts[static_cast<std::size_t>(k)];
  }
  return h;
}

// Equal in ratio where the values span more than a factor of ten, else equal in size; `log` says which.
std::vector<double> step_edges(const std::vector<double>& h, bool log) {
  constexpr int bins = 31;  // odd: a single size stands in the middle of its bar
  double lo = *std::min_element(h.begin(), h.end()), hi = *std::max_element(h.begin(), h.end());
  if (hi - lo < 1e-3 * hi) lo *= 0.9, hi *= 1.1;  // one size, give or take what summing up times leaves
  std::vector<double> edges;
  for (int k = 0; k <= bins; ++k) {
    const double u = static_cast<double>(k) / bins;
    edges.push_back(log ? lo * std::pow(hi / lo, u) : lo + u * (hi - lo));
  }
  return edges;
}

// Bars from zero, as a band with steps and its outline.
void add_bars(const Histogram& h, int color, Panel& p) {
  Band bars;
  Curve outline;
  outline.x.push_back(h.edges.front()), outline.y.push_back(0);
  const auto corner = [&](double x, double count) {
    bars.x.push_back(x), bars.lower.push_back(0), bars.upper.push_back(count);
  };
  for (std::size_t k = 0; k < h.counts.size(); ++k) {
    for (const double x : {h.edges[k], h.edges[k + 1]}) {
      corner(x, h.counts[k]);
      outline.x.push_back(x), outline.y.push_back(h.counts[k]);
    }
    corner(h.edges[k + 1], std::nan(""));  // every bar is a piece of its own
  }
  outline.x.push_back(h.edges.back()), outline.y.push_back(0);
  bars.color = outline.color = color;
  outline.width = 0.9f;
  p.bands.push_back(std::move(bars));
  p.curves.push_back(std::move(outline));
  p.y.label = "steps";
  p.y.whole = true;
  p.y.max = 1.08 * std::max(1.0, *std::max_element(h.counts.begin(), h.counts.end()));
}

// Steps and their iterations; what happened at an instant, an impact, is a state of its own but no step.
struct Steps {
  std::vector<double> sizes, iterations;
};

Steps steps_of(const Diagnostics& d) {
  const std::vector<double>&sizes = d.at("step_s").values, &iterations = d.at("newton_iterations").values;
  Steps steps;
  for (std::size_t k = 1; k < sizes.size(); ++k)
    if (sizes[k] > 0) steps.sizes.push_back(sizes[k]), steps.iterations.push_back(iterations[k]);
  return steps;
}

double mean(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

}  // namespace

Figure steps_figure(const Simulation& run, const Diagnostics& diagnostics) {
  const auto [h, iterations] = steps_of(diagnostics);
  Figure f;
  f.name = "steps";
  f.title = "Steps";
  f.columns = 2;
  f.height_mm = 80;
  f.panels.resize(2);
  Panel &left = f.panels[0], &right = f.panels[1];
  left.x.label = "step (s)";
  right.x.label = "Newton iterations";
  right.x.whole = true;
  f.caption = std::to_string(h.size()) + " steps.";
  if (!h.empty()) {
    const auto [lo, hi] = std::minmax_element(h.begin(), h.end());
    left.x.log = *hi > 10 * *lo;
    add_bars(histogram(h, step_edges(h, left.x.log)), 0, left);
    const double most = *std::max_element(iterations.begin(), iterations.end());
    std::vector<double> edges;
    for (double x = -0.5; x < std::max(1.0, most) + 1; ++x) edges.push_back(x);
    add_bars(histogram(iterations, std::move(edges)), 1, right);
    const std::string average = plot::format_number(mean(iterations), 3);
    const std::string shortest = plot::format_number(*lo, 3), longest = plot::format_number(*hi, 3);
    f.caption = std::to_string(h.size()) + (h.size() == 1 ? " step" : " steps") +
                (shortest == longest ? " of " : " from " + shortest + " s to ") + longest + " s, " + average +
                (average == "1" ? " Newton iteration" : " Newton iterations") + " a step on average, " +
                plot::format_number(most, 3) +
                " at most; left: how many steps are how long, right: how many take how many iterations.";
  }
  f.caption += " " + method_sentence(run);
  return f;
}

}  // namespace unfurl
