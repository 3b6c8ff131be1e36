// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/path_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/simulate/run_words.hpp"

namespace unfurl {

PathLaw::PathLaw(const Path& path, const Structure& structure, bool separately)
    : path_(path),
      forces_(structure, path, separately),
      pulling_(forces_.cables().size(), 0),
      slips_(forces_.frictions().size(), 0) {}

void PathLaw::tabulate() {
  table_.emplace(path_, forces_);
}

bool PathLaw::timed() const {
  return std::any_of(forces_.sources().begin(), forces_.sources().end(),
                     [](const PathForces::Source& source) { return source.timed; });
}

void PathLaw::look_from(double s) {
  if (low_ < high_ && s > low_ + 0.3 * (high_ - low_) && s < high_ - 0.3 * (high_ - low_)) return;
  const auto here = path_.piece_of(s);
  if (!here) return;
  const auto reach = [&](long number) {
    const PathPiece* piece = path_.piece(number);
    return piece ? piece : path_.piece(*here);
  };
  low_ = reach(*here - 1)->a;
  high_ = reach(*here + 1)->b;
}

double PathLaw::known_place(const PathPiece& piece, double x) const {
  while (x > -0.99 && !in_reach(0.5 * (piece.a + piece.b) + 0.5 * x * (piece.b - piece.a))) x = 0.5 * (x - 1);
  return x;
}

bool PathLaw::pull_where_taut(double s, double v) {
  constexpr double rounding = 1e-12;
  bool clear = true;
  for (std::size_t k = 0; k < pulling_.size(); ++k) {
    const PathForces::Cable& cable = forces_.cables()[k];
    const ValueAndSlope length = table_->at(cable.measure, s);
    const double e = length.value - cable.rest, damper = cable.damping * length.slope * v;
    pulling_[k] = e > 0 && cable.stiffness * e + damper > 0;
    clear = clear && (damper <= 0 || std::abs(e) > rounding * std::abs(length.value));
  }
  return clear;
}

ScalarLaw::Value PathLaw::at(double s, double v, double t) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const PathTable::Segment* here = in_reach(s);
  if (!here) return {nan, nan, nan, nan, nan};
  Value out;
  const auto add = [&](Index position, Index damping, double size) {
    const ValueAndSlope p = here->at(position, s), c = here->at(damping, s);
    out.Q += size * p.value - c.value * v;
    out.by_s += size * p.slope - c.slope * v;
    out.by_v -= c.value;
    out.scale += std::abs(size) * here->scale[position] + std::abs(c.value * v);
    out.noise += std::abs(size) * here->noise[position] + std::abs(v) * here->noise[damping];
  };
  add(0, 1, 1.0);
  for (const PathForces::Source& source : forces_.sources()) {
    if (source.timed) {
      add(source.position, source.damping, source.size(t));
      out.noise += source.size_noise(t) * std::abs(here->at(source.position, s).value);
    }
    if (source.cable >= 0 && pulling_[static_cast<std::size_t>(source.cable)])
      add(source.position, source.damping, 1.0);
    if (source.friction < 0) continue;
    const auto i = static_cast<std::size_t>(source.friction);
    if (slips_[i] != 0) add(source.position, source.damping, slips_[i] * forces_.frictions()[i].kinetic);
  }
  return out;
}

double PathLaw::holding(double s) const {
  double most = 0;
  for (const PathForces::Source& source : forces_.sources())
    if (source.friction >= 0)
      most += forces_.frictions()[static_cast<std::size_t>(source.friction)].holding *
              std::abs(table_->at(source.position, s).value);
  return most;
}

void PathMotion::advance(PathLaw& law, double latest) {
  from_ = t_;
  if (drive_.there()) {
    refuse_turn_at_dead_centre(latest);
    t_ = latest;
    on_drive(t_, s_, v_);
    return;
  }
  constexpr double unit = 1e-15;  // steps this short, as a share of the time, are not told from none
  if (latest - t_ <= unit * std::abs(latest)) {
    s_ += (latest - t_) * v_;
    t_ = latest;
    return;
  }
  law.look_from(s_);
  if (!(h_ > 0)) h_ = 0.01 * (latest - t_);
  ScalarStep step;
  if (!scalar_step(law, t_, s_, v_, latest, h_, step)) {
    law.table().refuse_rough();
    throw PathRefused("at t = " + seconds(t_) +
                      ": the path cannot be followed any further, or the motion on it not be resolved");
  }
  const bool last = step.end() >= latest - unit * std::abs(latest);
  t_ = last ? latest : step.end();
  step.at(step.end(), s_, v_);
  iterations_ += step.iterations;
  steps_.push_back(step);
}

void PathMotion::cut(double t) {
  double s = s_, v = v_;
  at(t, s, v);
  t_ = t, s_ = s, v_ = v;
  while (!steps_.empty() && steps_.back().t0 >= t) steps_.pop_back();
}

// The step before was cut, and goes on, turning round, where this one begins.
void PathMotion::rest(double t) {
  v_ = 0;
  if (t > t_) steps_.push_back({.t0 = t_, .h = t - t_, .s0 = s_});
  t_ = t;
}

void PathMotion::at(double t, double& s, double& v) const {
  if (drive_.there()) return on_drive(t, s, v);
  if (t >= t_ || steps_.empty()) {
    s = s_, v = v_;
    return;
  }
  const auto behind = std::partition_point(steps_.begin(), steps_.end(),
                                           [&](const ScalarStep& step) { return step.t0 <= t; });
  const ScalarStep& step = behind == steps_.begin() ? steps_.front() : *(behind - 1);
  step.at(std::clamp(t, step.t0, step.end()), s, v);
}

// Newton's method from where it was last, on the one branch on which what is driven follows s: where it turns
// round, or where the path ends, the drive can go no further. No correction is longer than a part of a piece
// of the path, so that nothing is traced that the motion does not come to.
void PathMotion::on_drive(double t, double& s, double& v) const {
  constexpr double part = 0.3, least_slope = 1e-9, rounded = 1e-14;
  constexpr int most = 100;  // corrections that are no shorter than the ones before, or not whole
  const auto refuse = [&](const char* why) {
    throw PathRefused("at t = " + seconds(t) + ": the drive " + why);
  };
  const double wanted = drive_.target(t), unit = law_->unit();
  s = s_;
  const PathTable::Segment* here = law_->table().segment(s);
  if (!here) refuse("leads where the path cannot be followed");
  ValueAndSlope m = here->at(drive_.column, s);
  const double branch = m.slope > 0 ? 1 : -1;
  double turn = std::numeric_limits<double>::quiet_NaN();  // behind where it turns round
  for (int it = 0;; ++it) {
    const double change = (wanted - m.value) / m.slope;
    if (!std::isfinite(change) || std::abs(m.slope) * unit < least_slope * here->scale[drive_.column])
      refuse("does not determine the motion along the path");
    const bool at_round_off =
        std::abs(wanted - m.value) <= rounded * here->scale[drive_.column] + here->noise[drive_.column];
    if (std::abs(change) <= 4e-16 * (unit + std::abs(s)) || (it > 8 && at_round_off)) break;
    if (it == most) refuse("goes beyond what the structure can reach");
    const double longest = part * (here->b - here->a);
    double next = s + std::clamp(change, -longest, longest);
    if ((next - turn) * change >= 0) next = 0.5 * (s + turn);
    const PathTable::Segment* there = law_->table().segment(next);
    const ValueAndSlope found =
        there ? there->at(drive_.column, next) : ValueAndSlope{0, std::numeric_limits<double>::quiet_NaN()};
    if (!(found.slope * branch > 0)) {
      turn = next;
      continue;
    }
    if (std::isnan(turn) && std::abs(change) > longest) it = 0;
    s = next, m = found, here = there;
  }
  v = drive_.target.derivative(1, t) / m.slope;
}

// Where a drive turns round in a dead centre of what it drives, the structure goes on to the other side of
// that, and not back: there the branch is another one, and the rate 0 over 0.
void PathMotion::refuse_turn_at_dead_centre(double latest) const {
  constexpr int parts = 8;
  constexpr double dead = 1e-4;  // of a slope; half of its square is left of the way to the dead centre
  const auto rate = [this](double t) { return drive_.target.derivative(1, t); };
  const auto edge = [&](int k) { return k == parts ? latest : t_ + k * (latest - t_) / parts; };
  for (int k = 0; k < parts; ++k) {
    double a = edge(k), b = edge(k + 1);  // of two parts the same to the bit
    if (!(rate(a) * rate(b) <= 0) || (rate(a) == 0 && rate(b) == 0)) continue;
    for (int halves = 0; halves < 60; ++halves) {
      const double middle = 0.5 * (a + b);
      (rate(a) * rate(middle) > 0 ? a : b) = middle;
    }
    double s = s_, v = 0;
    on_drive(b, s, v);
    const PathTable::Segment* there = law_->table().segment(s);
    const ValueAndSlope m = there->at(drive_.column, s);
    if (std::abs(m.slope) * law_->unit() < dead * there->scale[drive_.column])
      throw PathRefused("at t = " + seconds(b) + ": the drive turns round in a dead centre");
  }
}

std::vector<double> PathMotion::unseen_between(const PathLaw& law, double from, double to) const {
  double seen = 1e-5;  // of the largest rate; where that is not so, it is well seen to:
  constexpr double well = 1e-6;
  constexpr double rounding = 1e-10;     // of the coordinate
  constexpr double rounded_sum = 1e-15;  // of what acts
  constexpr std::size_t most = 100;
  struct Point {
    double t, s, v, a, a_rounds;
  };
  const auto point = [&](double t) {
    Point p{t, 0, 0, 0, 0};
    at(t, p.s, p.v);
    const ScalarLaw::Value pull = law.at(p.s, p.v, t);
    p.a = pull.Q, p.a_rounds = rounded_sum * pull.scale + pull.noise;
    return p;
  };
  std::vector<double> times;
  std::vector<Point> ends{point(to)};  // of the parts that are still to be looked at, the first one last
  Point a = point(from);
  while (!ends.empty()) {
    const Point b = ends.back(), middle = point(0.5 * (a.t + b.t));
    const double h = b.t - a.t, tell = 1.875 / h * (b.s - a.s) - 0.4375 * (a.v + b.v) + h / 32 * (b.a - a.a);
    const double size = std::max({std::abs(a.v), std::abs(b.v), std::abs(middle.v)});
    const double nothing = rounding / h * std::max(std::abs(a.s), std::abs(b.s)) + h * b.a_rounds;
    if (std::abs(tell - middle.v) > seen * size + nothing && times.size() + ends.size() < most) {
      ends.push_back(middle);
      seen = well;
      continue;
    }
    a = b;
    ends.pop_back();
    if (!ends.empty()) times.push_back(b.t);
  }
  return times;
}

}  // namespace unfurl
