// SPDX-License-Identifier: BSD-3-Clause
#include "core/structure/shown_lines.hpp"

#include <algorithm>

namespace unfurl {
namespace {

// Two lengths that follow each other and of which one grows as the other does: stages.
bool are_stages(const Constraint& constraint) {
  const std::vector<MeasureTerm>& terms = constraint.measure.terms;
  return terms.size() == 2 && terms[0].measure.kind == MeasureKind::length &&
         terms[1].measure.kind == MeasureKind::length && terms[0].coefficient * terms[1].coefficient < 0 &&
         terms[0].measure.nodes[1] == terms[1].measure.nodes[0];
}

}  // namespace

std::vector<CableSpan> cable_spans(const Structure& structure) {
  std::vector<CableSpan> found;
  std::vector<int> copy_of(structure.nodes.size(), -1);
  for (std::size_t i = 0; i < structure.node_copies.size(); ++i)
    if (int& copy = copy_of[static_cast<std::size_t>(structure.node_copies[i].source)]; copy < 0)
      copy = static_cast<int>(i);
  const auto add_span = [&](const Measure& length, CableSpan span) {
    if (length.kind != MeasureKind::length) return;
    span.line.a = copy_of[static_cast<std::size_t>(length.nodes[0])];
    span.line.b = copy_of[static_cast<std::size_t>(length.nodes[1])];
    if (span.line.a >= 0 && span.line.b >= 0) found.push_back(std::move(span));
  };
  const auto add = [&](const Measure& measure, CableSpan span) {
    add_span(measure, span);
    for (; span.term < measure.terms.size(); ++span.term) add_span(measure.terms[span.term].measure, span);
  };
  for (std::size_t k = 0; k < structure.forces.size(); ++k)
    if (const Force& force = structure.forces[k]; force.kind == "cable")
      add(force.measure, {{0, 0, force.smoothing > 0 ? "net" : "cable"}, static_cast<int>(k)});
  for (std::size_t k = 0; k < structure.stops.size(); ++k)
    if (const Stop& stop = structure.stops[k]; stop.reeled)
      add(stop.measure, {{0, 0, "cable"}, -1, static_cast<int>(k)});
  return found;
}

void show_cables(Structure& structure) {
  structure.lines.clear();
  for (CableSpan& span : cable_spans(structure)) structure.lines.push_back(std::move(span.line));
}

std::vector<std::pair<int, int>> stretches(const Measure& path) {
  std::vector<std::pair<int, int>> found;
  const auto add = [&](const Measure& m) {
    if (m.kind == MeasureKind::length) found.emplace_back(m.nodes[0], m.nodes[1]);
  };
  add(path);
  for (const MeasureTerm& term : path.terms) add(term.measure);
  return found;
}

std::vector<std::vector<int>> telescopes(const Structure& structure) {
  std::vector<std::vector<int>> found;
  const auto add_length = [&](const Measure& measure) {
    const bool one = measure.kind == MeasureKind::combination && measure.terms.size() == 1;
    const Measure& length = one ? measure.terms[0].measure : measure;
    if (length.kind != MeasureKind::length) return;
    const std::vector<int>& n = length.nodes;
    const bool rod = std::ranges::any_of(structure.rods, [&](const Rod& r) {
      return (r.a == n[0] && r.b == n[1]) || (r.a == n[1] && r.b == n[0]);
    });
    if (!rod) found.push_back({n[0], n[1]});
  };
  for (const Constraint& c : structure.constraints) {
    if (c.kind != "measure" || c.of_stop) continue;
    if (!are_stages(c)) {
      add_length(c.measure);
      continue;
    }
    const auto two = stretches(c.measure);
    const bool goes_on = !found.empty() && found.back().back() == two[0].second &&
                         found.back()[found.back().size() - 2] == two[0].first;
    if (goes_on)
      found.back().push_back(two[1].second);
    else
      found.push_back({two[0].first, two[0].second, two[1].second});
  }
  return found;
}

std::vector<ShownLine> lines_between_nodes(const Structure& structure) {
  std::vector<ShownLine> lines = structure.lines;
  const auto copy_of = [&](int node) {
    for (std::size_t i = 0; i < structure.node_copies.size(); ++i)
      if (structure.node_copies[i].source == node) return static_cast<int>(i);
    return -1;
  };
  const auto add = [&](int from, int to, const char* group) {
    const int a = copy_of(from), b = copy_of(to);
    if (a >= 0 && b >= 0) lines.push_back({a, b, group});
  };
  for (const Force& force : structure.forces)
    if (force.kind == "spring" && force.measure.kind == MeasureKind::length)
      add(force.measure.nodes[0], force.measure.nodes[1], force.one_sided ? "cable" : "spring");
  for (const std::vector<int>& stages : telescopes(structure))
    for (std::size_t k = 0; k + 1 < stages.size(); ++k) add(stages[k], stages[k + 1], "actuator");
  return lines;
}

double shown_line_radius(const Structure& structure, double size) {
  double radius = size > 0 ? 0.004 * size : 0.004;
  for (const Rod& rod : structure.rods)
    radius = std::min(radius, rod.radius > 0 ? rod.radius : rod.pinned_length() / 60);
  return 0.4 * radius;
}

}  // namespace unfurl
