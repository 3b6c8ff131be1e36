// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/margin_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/math/quadrature.hpp"
#include "core/path/path_scope.hpp"
#include "core/path/path_time.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/run_words.hpp"

namespace unfurl {
namespace {

constexpr int parts_of_step = 8;
constexpr double rounding_of_pull = 1e-13;  // of what pulls both ways
constexpr double same_place = 1e-8;         // of the way: a stop in the deployed pose
constexpr double same_energy = 1e-5;        // of all work, in which a motion must balance
constexpr int most_turns_at_once = 100, most_steps = 100000;
constexpr int poses_for_stops = 400;
constexpr double level = 1e-9;  // slope of the margin, of what it is the difference of, that is none
constexpr double next_to = 1e-6, near_start = 1e-2;  // the ends of a part of a step, as shares of it

bool exceeds(const ScalarLaw::Value& pull, double hold) {
  return std::abs(pull.Q) > hold + rounding_of_pull * (pull.scale + hold);
}

}  // namespace

MarginMotion::MarginMotion(std::shared_ptr<const Model> model, const SolverOptions& options,
                           std::shared_ptr<const Path> path, const std::map<std::string, double>& factors)
    : model_(std::move(model)),
      options_(options),
      path_(std::move(path)),
      law_(*path_, model_->structure, factors),
      sides_(model_->structure, options),
      watch_(model_->structure, sides_, options.step, false),  // where the way ends is known
      start_(initial_state(model_->structure, model_->system).state),
      edges_(time_edges(model_->structure, options.step)) {
  watch_.watch(law_);
  law_.tabulate();
  VectorXd z, tangent, v(path_->system().coordinates());
  if (!path_->point(0.0, z, tangent)) throw PathRefused("no path leads on from the pose at the start");
  model_->system.expand_rate(start_.w, v);
  speed_ = tangent.dot(path_->system().mass() * path_->system().reduce_rate(v));
  begin();
}

void MarginMotion::begin() {
  motion_ = PathMotion();
  motion_.begin(0.0, 0.0, speed_);
  law_.look_from(0.0);
  watch_.begin(start_, model_->system);
  sides_.find_laws(model_->system, start_);
  for (std::size_t k = 0; k < law_.forces().cables().size(); ++k)
    law_.set_pulling(k, sides_.active(sides_.stops().size() + k));
  driven_ = 0.5 * speed_ * speed_;
  resisted_ = 0;
  released_ = 0;
  crowd_time_ = -1;
  crowd_ = 0;
  stop_.clear();
  reaches_.clear();
  least_.reset();
}

void MarginMotion::at(double t, double& way, double& speed) const {
  motion_.at(t, way, speed);
  way *= sense_;
  speed *= sense_;
}

double MarginMotion::speed_at(double t) const {
  double way = 0, speed = 0;
  at(t, way, speed);
  return speed;
}

double MarginMotion::pull_at(double t) const {
  double s = 0, v = 0;
  motion_.at(t, s, v);
  return sense_ * law_.at(s, v, t).Q;
}

std::optional<std::size_t> MarginMotion::against_stop(double sense) const {
  for (std::size_t i = 0; i < sides_.stops().size(); ++i)
    if (std::abs(watch_.gap(i, 0.0)) <= 1 && watch_.gap_slope(i, 0.0) * sense < 0) return i;
  return std::nullopt;
}

std::optional<MarginMotion::Release> MarginMotion::release(double s, double from, double end) const {
  const double hold = law_.hold(s);
  // What pulls more than is held, with its sign.
  const auto excess = [&](double t) {
    const ScalarLaw::Value pull = law_.at_rest(s, t);
    if (!exceeds(pull, hold)) return 0.0;
    return s == 0 && against_stop(pull.Q) ? 0.0 : pull.Q;
  };
  if (const double now = excess(from); now != 0) return Release{from, std::copysign(1.0, now)};
  if (!law_.timed()) return std::nullopt;
  const double t = first_time_above([&](double at) { return std::abs(excess(at)); }, from, end,
                                    std::min(options_.step, (end - from) / 8), edges_);
  if (const double then = excess(t); then != 0) return Release{t, std::copysign(1.0, then)};
  return std::nullopt;
}

// Where between two poses a gap is least that closes at the first and opens at the other one; else the other.
double MarginMotion::nearest_to_stop(std::size_t stop, double sense, double a, double b) const {
  const auto closes = [&](double way) { return sense * watch_.gap_slope(stop, sense * way) < 0; };
  if (!closes(a) || closes(b)) return b;
  for (int it = 0; it < 60; ++it) (closes(0.5 * (a + b)) ? a : b) = 0.5 * (a + b);
  return b;
}

std::optional<std::pair<double, std::string>> MarginMotion::barred(double sense, double end) const {
  std::optional<std::pair<double, std::string>> first;
  for (std::size_t i = 0; i < sides_.stops().size(); ++i) {
    double a = 0;
    for (int k = 1; k < poses_for_stops; ++k) {
      const double next = end * k / (poses_for_stops - 1);
      double b = watch_.gap(i, sense * next) < -1 ? next : nearest_to_stop(i, sense, a, next);
      if (watch_.gap(i, sense * b) >= -1) {
        a = next;
        continue;
      }
      for (int it = 0; it < 60; ++it) (watch_.gap(i, sense * 0.5 * (a + b)) < 0 ? b : a) = 0.5 * (a + b);
      if (end - b > same_place * end && (!first || b < first->first)) first = {b, sides_.stops()[i].name};
      break;
    }
  }
  return first;
}

std::vector<MarginMotion::Met> MarginMotion::met(double sense, double end) const {
  std::vector<Met> out;
  for (std::size_t i = 0; i < sides_.stops().size(); ++i) {
    const double closing = -sense * watch_.gap_slope(i, sense * end), touching = sides_.touching(i);
    const double gap = watch_.gap(i, sense * end) * touching;
    if (closing > 0 && std::abs(gap) <= same_place * end * closing + touching)
      out.push_back({&sides_.stops()[i], closing, watch_.gap(i, 0.0) * touching - gap});
  }
  return out;
}

// At the start, when what pulls this way first exceeds what holds there but for stops.
std::optional<double> MarginMotion::pushed_on(double end) const {
  const double from = motion_.t(), hold = law_.hold(0.0);
  const auto push = [&](double t) {
    const ScalarLaw::Value pull = law_.at_rest(0.0, t);
    return exceeds(pull, hold) ? sense_ * pull.Q : 0.0;
  };
  double t = from;
  if (!(push(t) > 0) && law_.timed())
    t = first_time_above(push, from, end, std::min(options_.step, (end - from) / 8), edges_);
  return push(t) > 0 ? std::optional(t) : std::nullopt;
}

// Waits until it sets out; false: it does not, or not this way.
bool MarginMotion::set_out(double end_time, bool first) {
  const auto free = release(motion_.s(), motion_.t(), end_time);
  if (!free || free->sense != sense_) {
    ended_ = free && first ? MarginEnd::other_way : MarginEnd::stalls;
    if (const auto bar = against_stop(sense_); bar && !free && first)
      if (const auto push = pushed_on(end_time))
        ended_ = MarginEnd::stopped, stop_ = sides_.stops()[*bar].name, released_ = *push;
    if (!free && law_.timed()) motion_.rest(std::max(end_time, motion_.t()));
    return false;
  }
  if (free->t > motion_.t()) motion_.rest(free->t);
  if (first) released_ = free->t;
  resting_ = false;
  return true;
}

void MarginMotion::run(double sense, std::optional<double> goal, double end_time, bool record,
                       double patience) {
  begin();
  sense_ = law_.going = sense;
  goal_ = goal;
  record_ = record;
  if (record_) reaches_.push_back({0.0, 0.0, 0.0, driven_, driven_, 0.0});
  ended_ = MarginEnd::other_way;
  if (sense * speed_ < 0) return;
  resting_ = speed_ == 0;
  bool first = resting_;
  for (int round = 0; round < most_steps; ++round) {
    if (motion_.t() > crowd_time_) crowd_time_ = motion_.t(), crowd_ = 0;
    if (++crowd_ > most_turns_at_once)
      throw PathRefused("at t = " + seconds(motion_.t()) + ": cables or friction switch without end");
    if (resting_) {
      if (!set_out(end_time, first)) return check_energy();
      first = false;
    }
    const double from = motion_.t();
    if (from >= patience * end_time) {
      ended_ = goal_ ? MarginEnd::time : MarginEnd::arrives;
      return check_energy();
    }
    double latest = from < end_time ? end_time : patience * end_time;
    if (const auto edge = edge_after(edges_, from * (1 + 1e-15) + 1e-15 * end_time); edge != edges_.end())
      latest = std::min(latest, edge->t);
    motion_.advance(law_, latest);
    const auto [t, side] = watch_.first_event(motion_, from, motion_.t());
    if (follow(from, t)) {
      if (!resting_) return check_energy();
      continue;
    }
    if (side < 0) continue;
    motion_.cut(t);
    if (!sides_.is_stop(static_cast<std::size_t>(side))) {
      turn_cable(static_cast<std::size_t>(side));
      continue;
    }
    stop_ = sides_.stops()[static_cast<std::size_t>(side)].name;
    ended_ = goal_ && *goal_ - way() <= same_place * *goal_ ? MarginEnd::arrives : MarginEnd::stopped;
    return check_energy();
  }
  ended_ = MarginEnd::time;
}

void MarginMotion::turn_cable(std::size_t side) {
  sides_.set_active(side, !sides_.active(side));
  law_.set_pulling(side - sides_.stops().size(), sides_.active(side));
}

// Part by part; true: it has come to rest, or to its goal, on the way.
bool MarginMotion::follow(double from, double to) {
  for (int p = 0; p < parts_of_step && to > from; ++p) {
    const double a = from + (to - from) * p / parts_of_step;
    double b = p + 1 == parts_of_step ? to : from + (to - from) * (p + 1) / parts_of_step;
    if (const double least = turn_between(a, b); least > a && speed_at(least) <= 0) b = least;
    double s = 0, v = 0;
    motion_.at(b, s, v);
    // Until it turns it is under way: only what it reaches before counts, and by b it may have come back.
    const bool turns = sense_ * v <= 0;
    if (turns) b = last_time(a, b, true);
    motion_.at(b, s, v);
    const bool passes = goal_ && sense_ * s >= *goal_;
    if (passes) b = last_time(a, b, false);
    account(a, b);
    if (!turns && !passes) continue;
    motion_.cut(b);
    if (passes) {
      ended_ = MarginEnd::arrives;
      return true;
    }
    motion_.set_speed(0);
    return resting_ = true;
  }
  return false;
}

// When the speed is least between two times, where it falls first and rises then; else the first of them. A
// load may jump away at the last of them.
double MarginMotion::turn_between(double a, double b) const {
  if (!(pull_at(a) < 0 && std::max(pull_at(before_jump(b)), pull_at(b)) > 0)) return a;
  double low = a, high = b;
  for (int it = 0; it < 60; ++it) (pull_at(0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
  return high;
}

// When the speed falls to zero, or the goal is reached.
double MarginMotion::last_time(double a, double b, bool turns) const {
  for (int it = 0; it < 60; ++it) {
    const double middle = 0.5 * (a + b);
    double s = 0, v = 0;
    motion_.at(middle, s, v);
    ((turns ? sense_ * v > 0 : sense_ * s < *goal_) ? a : b) = middle;
  }
  return a;
}

double MarginMotion::force_at(std::size_t group, double t) const {
  double s = 0, v = 0;
  motion_.at(t, s, v);
  return sense_ * law_.force(group, s, v, t);
}

// Every source on its own side: where it turns from a drive to a resistance, or back, its power has a kink.
MarginMotion::Work MarginMotion::work_between(double a, double b) const {
  static const Quadrature gauss = gauss_legendre(8);
  Work work;
  for (std::size_t g = 0; g < law_.groups().size(); ++g) {
    const auto add = [&](double from, double to) {
      double sum = 0;
      for (Index i = 0; i < gauss.nodes.size(); ++i) {
        const double t = from + (to - from) * gauss.nodes[i];
        sum += (to - from) * gauss.weights[i] * force_at(g, t) * speed_at(t);
      }
      (sum > 0 ? work.driven : work.resisted) += std::abs(sum);
    };
    double low = a, high = b;
    const double first = force_at(g, a);
    if (first * force_at(g, b) < 0)
      for (int it = 0; it < 60; ++it)
        (force_at(g, 0.5 * (low + high)) * first > 0 ? low : high) = 0.5 * (low + high);
    if (high < b) add(high, b);
    add(a, high);
  }
  return work;
}

MarginReach MarginMotion::reach_at(double t, const Work& since) const {
  double way = 0, speed = 0;
  at(t, way, speed);
  return {way, t, 0.0, 0.5 * speed * speed, driven_ + since.driven, resisted_ + since.resisted};
}

// The slope of driven / resisted along the way has the sign of drives * resisted - driven * resistances.
void MarginMotion::look_for_least(double a, double b) {
  const auto slope = [&](double t) {
    const MarginReach reach = reach_at(t, work_between(a, t));
    double drives = 0, resistances = 0;
    for (std::size_t g = 0; g < law_.groups().size(); ++g)
      if (const double force = force_at(g, t); force > 0)
        drives += force;
      else
        resistances -= force;
    const double up = drives * reach.resisted, down = reach.driven * resistances;
    return std::abs(up - down) > level * (up + down) ? up - down : 0.0;
  };
  // Within the part: a load may jump at its ends, and nothing has been resisted yet at the start of the
  // motion.
  double low = a + (resisted_ > 0 ? next_to : near_start) * (b - a), high = b - next_to * (b - a);
  if (!(slope(low) < 0 && slope(high) > 0)) return;
  for (int it = 0; it < 50; ++it) (slope(0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
  const MarginReach found = reach_at(high, work_between(a, high));
  if (!least_ || found.margin() < least_->margin()) least_ = found;
}

void MarginMotion::account(double a, double b) {
  if (!record_) return;
  look_for_least(a, b);
  const MarginReach reached = reach_at(b, work_between(a, b));
  driven_ = reached.driven;
  resisted_ = reached.resisted;
  reaches_.push_back(reached);
}

// A load that was stepped over would show here.
void MarginMotion::check_energy() const {
  if (!record_) return;
  const double kinetic = reaches_.back().kinetic;
  if (!(std::abs(kinetic - driven_ + resisted_) <= same_energy * (driven_ + resisted_)))
    throw PathRefused("the energies of the motion on the path do not balance");
}

double MarginMotion::time_at(double way) const {
  double low = 0, high = motion_.t(), s = 0, v = 0;
  motion_.at(high, s, v);
  if (!(sense_ * s > way)) return high;
  for (int it = 0; it < 100 && high > low; ++it) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    motion_.at(middle, s, v);
    (sense_ * s > way ? high : low) = middle;
  }
  return low;
}

}  // namespace unfurl
