// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/path_watch.hpp"

#include <algorithm>
#include <cmath>

#include "core/structure/node_positions.hpp"

namespace unfurl {
namespace {

// As the time loop has them (simulate/stepper_loop.hpp): the deployed pose counts as reached anew from this
// sine of the fold angle on; what is met with it.
constexpr double singular_margin = 1e-4, at_once = 1e-8;
constexpr double now = 1e-12;          // of a step
constexpr double no_rate = 1e-11;      // a rate that is none, in a step
constexpr int samples = 24;            // within a step
constexpr double never_moves = 1e-11;  // over a piece of the path, of a turn or of the structure's length

}  // namespace

PathWatch::PathWatch(const Structure& structure, const OneSided& sides, double step, bool deployed)
    : sides_(sides),
      deploys_(deployed && !structure.deployment.empty()),
      folds_(!structure.deployment.measured),
      step_(step),
      shift_(sides.stops().size(), 0.0),
      margin_(singular_margin),
      rounded_(structure.deployment.rounded(node_positions(structure))) {
  for (const Force& force : structure.forces)
    if (force.kind == "friction" && force.holding > 0) frictions_.push_back(force.measure);
}

void PathWatch::watch(PathLaw& law) {
  law_ = &law;
  stop_columns_.clear();
  for (std::size_t i = 0; i < sides_.stops().size(); ++i)
    stop_columns_.push_back(law.forces().add_measure(sides_.stops()[i].measure));
  friction_columns_.clear();
  for (std::size_t i = sides_.first_friction(); i < sides_.first_motor(); ++i)
    friction_columns_.push_back(law.forces().add_measure(frictions_[i - sides_.first_friction()]));
  if (deploys_) deployed_column_ = law.forces().add_remaining();
}

void PathWatch::begin(const State& start, const System& system) {
  for (std::size_t i = 0; i < shift_.size(); ++i)
    shift_[i] = std::min(0.0, sides_.stops().gap(i, system, start));
  if (!deploys_) return;
  const double fold = remaining(0.0);
  if (fold > rounded_) margin_ = std::min(singular_margin, 0.1 * fold);
  armed_ = fold > margin_;
}

ValueAndSlope PathWatch::remaining_at(double s) const {
  ValueAndSlope m = law_->table().at(deployed_column_, s);
  if (!folds_) return m;
  const double cosine = law_->table().at(deployed_column_ + 1, s).value;
  return {remaining_of_fold(m.value, cosine), cosine >= 0 ? m.slope : -m.slope};
}

bool PathWatch::clear(const PathMotion& motion, double t) const {
  double s = 0, v = 0;
  motion.at(t, s, v);
  return remaining(s) > margin_;
}

double PathWatch::gap_slope(std::size_t stop, double s) const {
  return sides_.stops()[stop].sign * law_->table().at(stop_columns_[stop], s).slope;
}

double PathWatch::gap(std::size_t stop, double s) const {
  const StopSide& side = sides_.stops()[stop];
  const double m = law_->table().at(stop_columns_[stop], s).value;
  return (side.sign * (m - side.limit) - shift_[stop]) / sides_.touching(stop);
}

// A slope of rounding has a sign, too; no friction slips by that.
bool PathWatch::friction_moves(std::size_t i) const {
  const PathTable::Segment* here = law_->table().segment(0.0);
  if (!here) return true;
  const Index column = friction_columns_[i - sides_.first_friction()];
  const double least = never_moves * here->scale[column] / (here->b - here->a);
  for (const double x : {0.0, 0.37, 0.81})
    if (std::abs(here->at(column, here->a + x * (here->b - here->a)).slope) > least) return true;
  return false;
}

bool PathWatch::meets(const PathMotion& motion, std::size_t stop) const {
  VectorXd margin, rates;
  margins(motion, motion.t(), margin, rates);
  const auto i = static_cast<Index>(stop);
  return margin[i] <= 1 && rates[i] < 0;
}

// In units of what counts as zero, as OneSided has them; positive where nothing happens.
void PathWatch::margins(const PathMotion& motion, double t, VectorXd& out, VectorXd& rates) const {
  double s = 0, v = 0;
  motion.at(t, s, v);
  const std::size_t stops = sides_.stops().size();
  out.setConstant(static_cast<Index>(sides_.size()) + 1, std::numeric_limits<double>::quiet_NaN());
  rates.setZero(out.size());
  for (std::size_t i = 0; i < stops; ++i) {
    const StopSide& stop = sides_.stops()[i];
    const ValueAndSlope m = law_->table().at(stop_columns_[i], s);
    out[static_cast<Index>(i)] = (stop.sign * (m.value - stop.limit) - shift_[i]) / sides_.touching(i);
    rates[static_cast<Index>(i)] = stop.sign * m.slope * v / sides_.touching(i);
  }
  for (std::size_t k = 0; k < law_->forces().cables().size(); ++k) {
    const PathForces::Cable& cable = law_->forces().cables()[k];
    const ValueAndSlope m = law_->table().at(cable.measure, s);
    const double e = m.value - cable.rest, n = cable.stiffness * e + cable.damping * m.slope * v;
    const double stretch = cable.damping > 0 ? std::min(e, n / (cable.stiffness + cable.damping / step_)) : e;
    const int sign = sides_.active(stops + k) ? 1 : -1;
    const double zero = sides_.stops().touching();
    out[static_cast<Index>(stops + k)] = sign * stretch / zero;
    if (sign < 0 || !(cable.damping > 0)) rates[static_cast<Index>(stops + k)] = sign * m.slope * v / zero;
  }
  for (std::size_t i = sides_.first_friction(); i < sides_.first_motor(); ++i)
    if (sides_.slip(i) != 0)
      out[static_cast<Index>(i)] = sides_.slip(i) * friction_slope(i, s) * v / sides_.rounded_rate(i);
  if (deployed_column_ < 0 || deployed_) return;
  const ValueAndSlope m = remaining_at(s);
  out[out.size() - 1] = m.value;
  rates[out.size() - 1] = m.slope * v;
}

double PathWatch::margin(const PathMotion& motion, double t, Index i) const {
  VectorXd out, rates;
  margins(motion, t, out, rates);
  return out[i];
}

// Otherwise it would have gone through by what counts as zero before it is told. A load may begin with
// nothing: what presses is asked for a moment later, too.
bool PathWatch::pressed(const PathMotion& motion, double t, double to, Index i, double margin) const {
  constexpr double rounded = 1e-12;  // of what the force is the sum of
  constexpr double moment = 1e-3;    // of the way to `to`
  if (i >= static_cast<Index>(sides_.stops().size()) || !(std::abs(margin) <= 1)) return false;
  double s = 0, v = 0;
  motion.at(t, s, v);
  if (v != 0) return false;
  const int into = gap_slope(static_cast<std::size_t>(i), s) > 0 ? -1 : 1;
  const auto push = [&](double at, double least) {
    const ScalarLaw::Value pull = law_->at(s, 0.0, at);
    return into * pull.Q > least * (rounded * pull.scale + pull.noise);
  };
  return push(t, -1) && push(t + moment * (to - t), 1);
}

std::pair<double, int> PathWatch::first_event(const PathMotion& motion, double from, double to, bool edge) {
  VectorXd a, b, rates_a, rates_b;
  margins(motion, from, a, rates_a);
  const Index deployed = a.size() - 1;
  for (Index i = 0; i < deployed; ++i)
    if (a[i] < -1 || pressed(motion, from, to, i, a[i])) return {from, static_cast<int>(i)};
  std::pair<double, int> first{to, -1};
  double t0 = from;
  // The deployed pose is passed where rounding does not say so, or at speed. Slower than that, as a share of
  // the way in a step, it may be a dead centre or the end of a drive.
  const double slow = 2 * std::sqrt(rounded_);
  for (int part = 1; part <= samples; ++part) {
    const double t1 = part == samples ? to : from + (to - from) * part / samples;
    margins(motion, t1, b, rates_b);
    if (a[deployed] > margin_) armed_ = true;
    const bool turned_back = !(rates_a[deployed] < 0) && rates_b[deployed] > 0 && b[deployed] > rounded_;
    if (armed_ && std::abs(a[deployed]) <= rounded_ && turned_back) return {t0, static_cast<int>(deployed)};
    if (armed_ && folds_ && b[deployed] <= 0 && !is_fold_passed(a[deployed], b[deployed])) armed_ = false;
    const auto below = [&](Index i, double m, double rate) {
      return i < deployed ? m < -1 : armed_ && (m < -rounded_ || (m <= 0 && rate * step_ < -slow));
    };
    for (Index i = 0; i <= deployed; ++i) {
      double end = t1, left = b[i];
      // At a dead centre, or where the motion turns.
      const auto touched = [&] { return i == deployed && armed_ && std::abs(left) <= rounded_; };
      bool touches =
               touched() && std::abs(rates_b[i]) * step_ <= no_rate && a[i] + rates_a[i] * (t1 - t0) < 0,
           is_below = below(i, left, rates_b[i]);
      if (!is_below && rates_a[i] < 0 && rates_b[i] > 0) {
        // It cannot have fallen further than at the steeper of both rates.
        const double reach = std::max(-rates_a[i], rates_b[i]) * (t1 - t0);
        if (std::min(a[i], b[i]) - reach > (i == deployed ? rounded_ : -1)) continue;
        end = least_between(motion, i, t0, t1);
        left = margin(motion, end, i);
        touches = touched();
        is_below = below(i, left, 0.0);
      }
      if (!touches && !(is_below && a[i] > left)) continue;
      double t = touches ? end : zero_of(motion, i, t0, end);
      if (t - from <= now * step_) t = from;  // rounding puts it there
      const double tie = i == deployed && !stands_before(motion, first, t) ? at_once * step_ : 0;
      if (t < first.first + tie || first.second < 0) first = {t, static_cast<int>(i)};
    }
    if (first.second >= 0) break;
    a = b;
    rates_a = rates_b;
    t0 = t1;
  }
  // A drive that ends in the deployed pose stays within rounding of it, whose sign is no event.
  if (edge && armed_) {  // with which there is nothing else to meet
    const double nothing = std::max(1e-9, rounded_);
    margins(motion, to, b, rates_b);
    if (std::abs(b[deployed]) <= nothing && std::abs(rates_b[deployed]) * step_ <= nothing)
      first = {to, static_cast<int>(deployed)};
  }
  return first;
}

bool PathWatch::stands_before(const PathMotion& motion, const std::pair<double, int>& met, double t) const {
  const Index i = met.second;
  if (i < 0 || i >= static_cast<Index>(sides_.stops().size())) return false;
  VectorXd at_stop, rates;
  margins(motion, met.first, at_stop, rates);
  return at_stop[at_stop.size() - 1] > rounded_ && margin(motion, t, i) < -1;
}

double PathWatch::least_between(const PathMotion& motion, Index i, double a, double b) const {
  VectorXd m, rates;
  for (int it = 0; it < 60 && b - a > 2e-16 * b; ++it) {
    const double t = 0.5 * (a + b);
    margins(motion, t, m, rates);
    (rates[i] < 0 ? a : b) = t;
  }
  return b;
}

// Regula falsi and, every third time, bisection: to the last bit of the time. A margin that begins at zero
// and rises first, as behind a rebound, is followed to where it falls again; one that begins at the height of
// a rebound, which may count as zero, too, falls at once.
double PathWatch::zero_of(const PathMotion& motion, Index i, double a, double b) const {
  double fa = margin(motion, a, i), fb = margin(motion, b, i);
  if (i < static_cast<Index>(sides_.size()) && fa <= 1) {
    double up = b, down = b, m = fb;
    for (int it = 0; it < 60 && !(m > std::max(fa, 0.0)); ++it) {
      down = up;
      up = a + 0.5 * (down - a);
      m = margin(motion, up, i);
    }
    if (m > std::max(fa, 0.0) && down > up) {
      a = up, fa = m;
      b = down, fb = margin(motion, b, i);
    } else if (!(fa > 0)) {
      return a;
    }
  }
  for (int it = 0; it < 200 && b - a > 2e-16 * b; ++it) {
    double t = it % 3 == 2 ? 0.5 * (a + b) : b - fb * (b - a) / (fb - fa);
    if (!(t > a && t < b)) t = 0.5 * (a + b);
    if (!(t > a && t < b)) break;
    const double m = margin(motion, t, i);
    if (m == 0) return t;
    if (m > 0)
      a = t, fa = m;
    else
      b = t, fb = m;
  }
  return b;
}

}  // namespace unfurl
