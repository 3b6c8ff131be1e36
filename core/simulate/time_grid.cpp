// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/time_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl {
namespace {

// Times closer than this share of a step are one: what a bend does within it is below round-off, and a step
// of that size would only make noise. So are times that rounding does not tell apart: of 1e7 steps the last
// ones end some 1e-9 of a step off.
constexpr double together = 1e-9;

double one_time(double t, double step) {  // t is not below 0
  return std::max(together * step, 4 * std::numeric_limits<double>::epsilon() * t);
}

}  // namespace

SolverOptions with_steps_inside(SolverOptions options) {
  if (options.end_time > 0) options.step = std::min(options.step, options.end_time);
  return options;
}

TimeGrid::TimeGrid(double start, const SolverOptions& options, std::vector<TimeEdge> edges)
    : start_(start),
      step_(options.step),
      end_(options.end_time),
      count_(std::max(
          1L, static_cast<long>(std::ceil(
                  (end_ - start_ - one_time(std::max(std::abs(start_), std::abs(end_)), step_)) / step_)))),
      edges_(std::move(edges)) {
  // Who passes the deployed pose has no state in it, from which no step leads on where it is singular.
  if (options.at_deployed == "pass") std::erase_if(edges_, [](const TimeEdge& edge) { return edge.smooth; });
}

TimeGrid::Target TimeGrid::next(double now) const {
  const double near = one_time(std::max(std::abs(start_), std::abs(now)), step_);
  const long k = static_cast<long>(std::floor((now - start_ + near) / step_)) + 1;
  const double t = k >= count_ ? end_ : start_ + static_cast<double>(k) * step_;
  const double h = t - now, rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(t);
  return cut(now, {t, std::abs(h - step_) <= rounding ? step_ : h});
}

TimeGrid::Target TimeGrid::next(double now, double wanted) const {
  const bool last = now + 1.001 * wanted >= end_;
  return cut(now, last ? Target{end_, end_ - now} : Target{now + wanted, wanted});
}

TimeGrid::Target TimeGrid::cut(double now, Target target) const {
  const double near = one_time(now, step_);
  auto edge = std::upper_bound(edges_.begin(), edges_.end(), now,
                               [](double t, const TimeEdge& e) { return t < e.t; });
  for (; edge != edges_.end() && edge->t <= target.t + near; ++edge) {
    if (edge->jump ? edge->t > end_ : edge->t >= end_ - near) break;
    if (edge->jump) {
      const double before = before_jump(edge->t);
      if (edge->t <= now + near) return {now, 0.0, true, true, edge->t};
      return {before, before - now, true, true, edge->t};
    }
    if (edge->t > now + near && edge->t < target.t - near) return {edge->t, edge->t - now, true};
    target.edge = target.edge || edge->t > now + near;
  }
  return target;
}

double TimeGrid::next_edge(double now) const {
  for (const TimeEdge& edge : edges_)
    if (edge.t > now) return std::min(edge.t, end_);
  return end_;
}

}  // namespace unfurl
