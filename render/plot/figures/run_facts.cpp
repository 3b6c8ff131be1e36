#include "render/plot/figures/run_facts.hpp"

#include <algorithm>
#include <cmath>

#include "render/plot/ticks.hpp"

namespace unfurl {

using plot::format_number;

Curve over_time(const Diagnostics& diagnostics, std::vector<double> values, std::string label, int color) {
  Curve c;
  c.label = std::move(label);
  c.x = diagnostics.t;
  c.y = std::move(values);
  c.color = color;
  return c;
}

Panel time_panel(const Simulation& run, std::string y_label) {
  Panel p;
  p.x.label = "time (s)";
  p.y.label = std::move(y_label);
  for (const Event& e : run.events) p.lines.push_back({e.t, false, e.name, 7});
  return p;
}

void share_time_axis(Panel& upper, Panel& lower) {
  upper.x.shown = false;
  for (ReferenceLine& line : lower.lines)
    if (!line.horizontal) line.label.clear();
}

double largest_magnitude(const std::vector<double>& values) {
  double largest = 0;
  for (const double v : values)
    if (std::isfinite(v)) largest = std::max(largest, std::abs(v));
  return largest;
}

std::vector<double> magnitudes(const std::vector<double>& values) {
  std::vector<double> out(values.size());
  std::transform(values.begin(), values.end(), out.begin(), [](double v) { return std::abs(v); });
  return out;
}

std::string method_sentence(const Simulation& run) {
  const SolverOptions& o = run.options;
  std::string text = "Method " + o.method;
  if (o.method == "dvm")
    text +=
        " with " + std::to_string(o.stages) + " " + o.nodes + " stages, constraints at " + o.constraints_at;
  text += ", step " + format_number(o.step, 4) + " s.";
  if (run.status == RunStatus::failed) text += " The solver failed " + run.message + ".";
  if (run.status == RunStatus::stopped) text += " The run was " + run.message + ".";
  return text;
}

std::string zeros_sentence(const std::vector<double>& values) {
  const auto zeros = std::count(values.begin(), values.end(), 0.0);
  if (zeros == 0) return {};
  return zeros == 1 ? " One exact zero is drawn at the bottom edge."
                    : " The " + std::to_string(zeros) + " exact zeros are drawn at the bottom edge.";
}

}  // namespace unfurl
