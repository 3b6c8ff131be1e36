// SPDX-License-Identifier: BSD-3-Clause
#include "core/structure/time_edges.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace unfurl {
namespace {

void add_bends_of_line(const TimeFunction& f, std::vector<TimeEdge>& edges) {
  const std::vector<double>&x = f.times, &y = f.values;
  const auto slope = [&](std::size_t i) { return (y[i + 1] - y[i]) / (x[i + 1] - x[i]); };
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i + 1 < x.size() && x[i] == x[i + 1]) {
      edges.push_back({x[i++], true});
      continue;
    }
    const double before = i > 0 ? slope(i - 1) : 0.0, after = i + 1 < x.size() ? slope(i) : 0.0;
    // Points of one straight line, up to their rounding, do not bend it.
    if (std::abs(after - before) > 1e-9 * std::abs(after)) edges.push_back({x[i], false});
  }
}

// What the jump of the third derivative at each point adds over the shorter of its two intervals.
std::vector<double> kinks(const TimeFunction& f) {
  const std::vector<double>&x = f.times, &m = f.bends;
  std::vector<double> out(x.size(), 0.0);
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    const double before = x[i] - x[i - 1], after = x[i + 1] - x[i], d = std::min(before, after);
    out[i] = std::abs((m[i + 1] - m[i]) / after - (m[i] - m[i - 1]) / before) * d * d * d / 6;
  }
  return out;
}

double median_of(std::vector<double> x) {
  if (x.empty()) return 0.0;
  const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
  std::nth_element(x.begin(), middle, x.end());
  return *middle;
}

void add_points_of_spline(const TimeFunction& f, double step, std::vector<TimeEdge>& edges) {
  const std::vector<double>& x = f.times;
  for (const double end : {x.front(), x.back()}) edges.push_back({end, true, true});
  const std::vector<double> kink = kinks(f);
  std::vector<double> moving;  // of rows that do not rest
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    if (f.values[i - 1] != f.values[i] || f.values[i] != f.values[i + 1]) moving.push_back(kink[i]);
  const double of_all = median_of(kink), of_moving = median_of(moving);
  const auto [low, high] = std::minmax_element(f.values.begin(), f.values.end());
  const double range = *high - *low, near = (1 - 1e-9) * step;
  double fastest = 0;
  for (std::size_t i = 1; i < x.size(); ++i)
    fastest = std::max(fastest, std::abs(f.values[i] - f.values[i - 1]) / (x[i] - x[i - 1]));
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
    // Of points that lie close, as those that follow an end at speed, none is seen in the values themselves.
    const bool in_value = kink[i] > std::max(1e-5 * range, 30 * of_all),
               in_rate = kink[i] > std::max(1e-6 * fastest * std::min(before, after), 30 * of_moving);
    if (in_value || in_rate || (before >= near && after >= near)) edges.push_back({x[i], false});
  }
}

void add_edges(const TimeFunction& f, double step, std::vector<TimeEdge>& edges) {
  switch (f.kind) {
    case TimeFunction::Kind::constant:
    case TimeFunction::Kind::piece:
    case TimeFunction::Kind::wave:
      return;
    case TimeFunction::Kind::rate:
    case TimeFunction::Kind::sine: {
      const bool sets_out =
          f.ramp == 0 && (f.rate != 0 || (f.kind == TimeFunction::Kind::sine && f.rise != 0));
      edges.push_back({f.start, sets_out, sets_out});
      if (f.ramp > 0) edges.push_back({f.start + f.ramp, false});
      return;
    }
    case TimeFunction::Kind::smooth:
      edges.push_back({f.start, false});
      // Between two states at rest there would be nothing to see of it.
      for (int part = 1; part < 4 && f.duration < 2 * step; ++part)
        edges.push_back({f.start + 0.25 * part * f.duration, false});
      edges.push_back({f.start + f.duration, false});
      return;
    case TimeFunction::Kind::spline:
      return add_points_of_spline(f, step, edges);
    case TimeFunction::Kind::linear:
      return add_bends_of_line(f, edges);
  }
}

// Where a fold angle is led to the deployed pose and turns round in it, for the first time: nothing passes
// it.
void add_turn_when_deployed(const Structure& structure, const Constraint& c, std::vector<TimeEdge>& edges) {
  constexpr double there = 1e-9;  // [rad]: of a wave, 1e-5 of its time
  const TimeFunction& f = c.target;
  if (f.kind != TimeFunction::Kind::sine || c.measure.kind != MeasureKind::fold) return;
  const double grown = f.start + f.ramp;
  for (const double turn : turning_times(f, grown, grown + f.duration))
    if (std::abs(f(turn) - structure.deployment.deployed_fold_angle) <= there)
      return edges.push_back({.t = turn, .smooth = true});
}

void add_prescribed(const Structure& structure, double step, std::vector<TimeEdge>& edges) {
  for (const Constraint& c : structure.constraints) {
    add_edges(c.target, step, edges);
    add_turn_when_deployed(structure, c, edges);
  }
  for (const Stop& stop : structure.stops) add_edges(stop.reel, step, edges);
  for (const Rod& rod : structure.rods)
    if (rod.expansion != 0) add_edges(rod.warming, step, edges);
}

// Times that differ by their rounding are one; it jumps if one of them does, at the last that does: there
// all of them have jumped, and before_jump() none.
std::vector<TimeEdge> distinct_edges(std::vector<TimeEdge> edges) {
  std::sort(edges.begin(), edges.end(), [](const TimeEdge& a, const TimeEdge& b) { return a.t < b.t; });
  std::vector<TimeEdge> distinct;
  for (const TimeEdge& edge : edges) {
    if (distinct.empty() || edge.t - distinct.back().t > 4e-16 * std::abs(edge.t)) {
      distinct.push_back(edge);
    } else {
      if (edge.jump || edge.impact) distinct.back().t = edge.t;
      distinct.back().jump |= edge.jump, distinct.back().impact |= edge.impact;
      distinct.back().smooth &= edge.smooth;
    }
  }
  return distinct;
}

}  // namespace

Structure pieces_at(Structure structure, double t) {
  const auto take = [t](TimeFunction& f) { f = f.piece_at(t); };
  for (Constraint& c : structure.constraints) take(c.target);
  for (Stop& stop : structure.stops) take(stop.reel);
  for (Rod& rod : structure.rods) take(rod.warming);
  for (Force& f : structure.forces) take(f.size), take(f.unstressed), take(f.motor.command);
  return structure;
}

std::vector<TimeEdge> prescribed_edges(const Structure& structure, double step) {
  std::vector<TimeEdge> edges;
  add_prescribed(structure, step, edges);
  return distinct_edges(std::move(edges));
}

std::vector<TimeEdge> time_edges(const Structure& structure, double step) {
  std::vector<TimeEdge> edges;
  add_prescribed(structure, step, edges);
  for (const Force& f : structure.forces)
    for (const TimeFunction* function : {&f.size, &f.unstressed, &f.motor.command}) {
      const std::size_t own = edges.size();
      add_edges(*function, step, edges);
      // A force that answers to rates jumps with them; none drives a velocity.
      const bool by_rate = function == &f.motor.command || (function == &f.unstressed && f.damping > 0);
      for (std::size_t i = own; i < edges.size(); ++i) {
        edges[i].jump = edges[i].jump && (by_rate || function->kind == TimeFunction::Kind::linear);
        edges[i].impact = false;
      }
    }
  return distinct_edges(std::move(edges));
}

}  // namespace unfurl
