// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/run_facts.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "render/plot/ticks.hpp"

namespace unfurl {

using plot::format_number;

namespace {

// Events of one name: of more the first is labelled, with their number. And names in a sentence.
constexpr std::size_t most_named = 5;

// Events of one name, in the order of their first ones.
struct EventGroup {
  std::string name;
  std::vector<double> times;
};

std::vector<EventGroup> event_groups(const Simulation& run) {
  std::vector<EventGroup> groups;
  for (const Event& e : run.events) {
    const auto same =
        std::find_if(groups.begin(), groups.end(), [&](const EventGroup& g) { return g.name == e.name; });
    if (same == groups.end())
      groups.push_back({e.name, {e.t}});
    else
      same->times.push_back(e.t);
  }
  return groups;
}

std::string group_label(const EventGroup& group) {
  if (group.times.size() <= most_named) return group.name;
  return group.name + " (" + std::to_string(group.times.size()) + " times)";
}

}  // namespace

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
  for (const EventGroup& group : event_groups(run))
    for (const double t : group.times) {
      const bool many = group.times.size() > most_named, named = !many || t == group.times.front();
      p.lines.push_back({t, false, named ? group_label(group) : "", 7, many});
    }
  return p;
}

std::string events_sentence(const Simulation& run) {
  // A millionth of a second, or of a run that is shorter.
  const double span = run.trajectory.end_time() - run.trajectory.start_time();
  const int decimals =
      span > 0 ? static_cast<int>(std::clamp(std::ceil(6 - std::log10(span)), 6.0, 300.0)) : 6;
  const auto seconds = [&](double t) {  // what rounds to 0 is the start
    return plot::format_fixed(t, std::abs(t) < 0.5 * std::pow(10.0, -decimals) ? 0 : decimals) + " s";
  };
  std::vector<std::pair<double, std::string>> told;
  const std::vector<EventGroup> groups = event_groups(run);
  for (std::size_t k = 0; k < std::min(groups.size(), most_named); ++k) {
    const EventGroup& group = groups[k];
    const std::string name = " Event \u201C" + group.name + "\u201D ";
    if (group.times.size() > most_named) {
      told.emplace_back(group.times.front(), name + std::to_string(group.times.size()) + " times, from " +
                                                 seconds(group.times.front()) + " to " +
                                                 seconds(group.times.back()) + ".");
      continue;
    }
    for (const double t : group.times) told.emplace_back(t, name + "at " + seconds(t) + ".");
  }
  std::stable_sort(told.begin(), told.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string text;
  for (const auto& event : told) text += event.second;
  if (groups.size() <= most_named) return text;
  std::vector<double> rest;
  for (std::size_t k = most_named; k < groups.size(); ++k)
    rest.insert(rest.end(), groups[k].times.begin(), groups[k].times.end());
  std::sort(rest.begin(), rest.end());
  if (rest.size() == 1) return text + " One more event at " + seconds(rest.front()) + ".";
  return text + " " + std::to_string(rest.size()) + " more events from " + seconds(rest.front()) + " to " +
         seconds(rest.back()) + ".";
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
  std::string text;
  if (solved_as(run).name == "path") {  // by neither the method nor its steps
    text = "Solved along its path, states " + format_number(o.step, 4) + " s apart at most.";
  } else {
    text = "Method " + o.method;
    if (o.method == "dvm")
      text +=
          " with " + std::to_string(o.stages) + " " + o.nodes + " stages, constraints at " + o.constraints_at;
    text += (o.adaptive ? ", adaptive steps, at most " : ", step ") + format_number(o.step, 4) + " s.";
  }
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
