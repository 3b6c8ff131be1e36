// SPDX-License-Identifier: BSD-3-Clause
// Hinges that jam: path/margin.hpp.
#include <algorithm>
#include <cmath>

#include "core/constraints/linear_rows.hpp"
#include "core/math/golden_section.hpp"
#include "core/path/hinge_turns.hpp"
#include "core/path/margin.hpp"
#include "core/path/margin_motion.hpp"
#include "core/path/path_scope.hpp"

namespace unfurl {
namespace {

constexpr double still = 1e-9;         // [rad]
constexpr double hardly_turns = 1e-6;  // of the hinge's fastest turn: a pose that no torque of it holds
constexpr double level_torque = 1e-9;  // by which it differs where it is not level, as a share
constexpr double told_turn = 1e-7;     // [rad] of differences of angles, that tells them to 1e-8
constexpr double torque_found = 1e-7;  // as a share
constexpr double loose_steps = 1e-9;   // of motions that only tell whether they arrive
// A jam makes a motion late, and that is no stall: it is followed for so many end times. One that still
// creeps then has stalled.
constexpr double patience = 1e9;
constexpr double no_torque = 1e-13;  // of the size of what acts: a torque that is less is none
constexpr double unbounded_torque = std::numeric_limits<double>::infinity();
constexpr int most_doublings = 200;  // of a first guess, beyond which nothing is said to stall it

class StuckMaker {
 public:
  StuckMaker(const std::shared_ptr<const Model>& model, const SolverOptions& options, const Margin& margin)
      : structure_(model->structure),
        options_(options),
        margin_(margin),
        path_(trace_path(model)),
        motion_(model, options, path_, factors_of(margin)) {
    for (const MarginReach& reach : margin_.motion) poses_.push_back(pose(reach.s));
    for (const MarginPoint& point : margin_.points) points_.push_back(pose(point.s));
    const std::vector<Hinge> hinges = hinges_of(structure_);
    for (const Hinge& hinge : hinges) take(hinge);
    if (hinges_.empty() && (margin_.end == MarginEnd::stalls || margin_.end == MarginEnd::other_way)) {
      at_once_ = true;
      for (const Hinge& hinge : hinges) take(hinge);
    }
    for (std::size_t j = 0; j < margin_.points.size(); ++j)
      rest_.push_back(rest_force(margin_.points[j].s, margin_.points[j].t));
    by_pose_ = depends_on_pose();
    if (!by_pose_) {
      rates_ = std::make_unique<HingeRates>(hinges_);
      table_ = std::make_unique<PathTable>(*path_, *rates_);
    }
  }

  std::vector<StuckHinge> make(std::size_t most_for_pairs) {
    std::vector<Some> all;
    for (std::size_t i = 0; i < hinges_.size(); ++i) all.push_back({i});
    if (hinges_.size() <= most_for_pairs)
      for (std::size_t i = 0; i < hinges_.size(); ++i)
        for (std::size_t k = i + 1; k < hinges_.size(); ++k) all.push_back({i, k});
    std::vector<StuckHinge> out;
    if (all.empty()) return out;
    // The motion of the margin again, to ask it between its states.
    const double end = margin_.end == MarginEnd::stalls ? options_.end_time : margin_.motion.back().t;
    motion_.run(margin_.sense, std::nullopt, end, false);
    for (const Some& some : all) out.push_back(stuck(some));
    if (!by_pose_ && !at_once_)
      for (std::size_t i = 0; i < all.size(); ++i) stall_by_motion(all[i], out[i]);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double none = no_torque * first_guess(all[i]);
      for (double* torque : {&out[i].static_torque, &out[i].stall_torque})
        if (*torque <= none && std::isfinite(none)) *torque = 0;
    }
    return out;
  }

 private:
  using Some = std::vector<std::size_t>;  // hinges that jam alike

  static std::map<std::string, double> factors_of(const Margin& margin) {
    std::map<std::string, double> out;
    for (const MarginSource& source : margin.sources)
      if (source.factor != 1.0) out[source.name] = source.factor;
    return out;
  }

  struct Pose {
    VectorXd q, dq;
  };
  struct Turns {
    std::vector<double> angle, rate, turned;  // at the places of the motion
    std::vector<double> rate_in_point;        // in those of the margin, its size
  };

  Pose pose(double s) const {
    VectorXd z, tangent;
    Pose out{VectorXd(path_->system().coordinates()), VectorXd(path_->system().coordinates())};
    if (!path_->point(margin_.sense * s, z, tangent)) throw PathRefused("the path cannot be followed so far");
    path_->system().expand(z, out.q);
    path_->system().expand_rate(margin_.sense * tangent, out.dq);
    return out;
  }

  // The angle turned until each place of the motion, and the rates in the poses of the margin.
  void take(const Hinge& hinge) {
    Turns turns;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      turns.angle.push_back(hinge_angle(hinge, poses_[i].q));
      turns.rate.push_back(hinge_rate(hinge, poses_[i].q, poses_[i].dq));
      if (i == 0) {
        turns.turned.push_back(0.0);
        continue;
      }
      const double before = turns.angle[i - 1], angle = turns.angle[i], rate = turns.rate[i - 1];
      double turn = std::abs(angle - before);
      if (rate * turns.rate[i] < 0) {
        const double between = turn_of(hinge, margin_.motion[i - 1].s, margin_.motion[i].s, rate);
        turn = std::abs(between - before) + std::abs(angle - between);
      }
      turns.turned.push_back(turns.turned.back() + turn);
    }
    const double size = reference_length(structure_);
    bool would_turn = false;
    for (const Pose& at : points_) {
      turns.rate_in_point.push_back(std::abs(hinge_rate(hinge, at.q, at.dq)));
      would_turn |= turns.rate_in_point.back() * size > still * at.dq.cwiseAbs().maxCoeff();
    }
    if (turns.turned.back() < still && !(at_once_ && would_turn)) return;
    hinges_.push_back(hinge);
    turns_.push_back(std::move(turns));
  }

  // The angle at which it turns back, or in line.
  double turn_of(const Hinge& hinge, double a, double b, double rate) const {
    Pose at;
    for (int it = 0; it < 50; ++it) {
      at = pose(0.5 * (a + b));
      (hinge_rate(hinge, at.q, at.dq) * rate > 0 ? a : b) = 0.5 * (a + b);
    }
    return hinge_angle(hinge, at.q);
  }

  // Until a pose between the places m and m + 1 of the motion.
  double turned_until(std::size_t hinge, std::size_t m, const Pose& here) const {
    const Turns& turns = turns_[hinge];
    const double angle = hinge_angle(hinges_[hinge], here.q);
    const bool turned_back = turns.rate[m] * hinge_rate(hinges_[hinge], here.q, here.dq) < 0;
    return turned_back ? turns.turned[m + 1] - std::abs(turns.angle[m + 1] - angle)
                       : turns.turned[m] + std::abs(angle - turns.angle[m]);
  }

  // Of the whole structure along the path, the way it deploys.
  double rest_force(double way, double t) const {
    const double s = margin_.sense * way;
    return structure_.sectors * (margin_.sense * motion_.law().at_rest(s, t).Q - motion_.law().hold(s));
  }

  bool depends_on_pose() const {
    if (motion_.law().timed()) return false;
    for (const MarginPoint& point : margin_.points)
      for (std::size_t g = 0; g < margin_.sources.size(); ++g)
        if (motion_.law().damps(g, margin_.sense * point.s)) return false;
    return true;
  }

  StuckHinge stuck(const Some& some) const {
    StuckHinge out{"", static_torque(some), unbounded_torque, 0.0, 0.0, 0.0};
    for (const std::size_t i : some) {
      out.name += (out.name.empty() ? "" : " and ") + hinges_[i].name;
      out.turn += turns_[i].turned.back();
    }
    if (at_once_) {
      out.stall_torque = 0;
      out.stall_at = margin_.motion.back().s;
      out.stall_fold = fold_angle(out.stall_at);
    } else if (by_pose_) {
      stall_by_energy(some, out);
    }
    return out;
  }

  double rate_in(const Some& some, std::size_t point) const {
    double sum = 0;
    for (const std::size_t i : some) sum += turns_[i].rate_in_point[point];
    return sum;
  }

  // The least torque at places, and between those beside any that is less than its neighbours, told from
  // rounding.
  struct Least {
    double torque = unbounded_torque, at = 0.0;
  };
  template <class Torque>
  static Least least_of(const std::vector<double>& places, const std::vector<double>& torques,
                        const Torque& torque) {
    Least least;
    const auto take = [&](double value, double at) {
      if (value < least.torque) least = {value, at};
    };
    for (std::size_t i = 0; i < places.size(); ++i) take(torques[i], places[i]);
    if (!(least.torque > 0)) return least;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::size_t before = i > 0 ? i - 1 : i, behind = std::min(i + 1, places.size() - 1);
      const double least_beside = std::min(before < i ? torques[before] : unbounded_torque,
                                           behind > i ? torques[behind] : unbounded_torque);
      const double most_beside = std::max(torques[before], torques[behind]);
      if (torques[i] > least_beside || most_beside <= (1 + level_torque) * torques[i]) continue;
      const double at = golden_section(torque, places[before], places[behind], 40);
      take(torque(at), at);
    }
    return least;
  }

  double static_torque(const Some& some) const {
    double fastest = 0;
    for (std::size_t j = 0; j < rest_.size(); ++j) fastest = std::max(fastest, rate_in(some, j));
    const auto holding = [&](double force, double rate) {
      return rate > hardly_turns * fastest ? std::max(0.0, force / rate) : unbounded_torque;
    };
    std::vector<double> places, torques;
    for (std::size_t j = 0; j < rest_.size(); ++j) {
      places.push_back(margin_.points[j].s);
      torques.push_back(holding(rest_[j], rate_in(some, j)));
    }
    const auto between = [&](double way) {
      const Pose at = pose(way);
      double rate = 0;
      for (const std::size_t i : some) rate += std::abs(hinge_rate(hinges_[i], at.q, at.dq));
      return holding(rest_force(way, motion_.law().timed() ? motion_.time_at(way) : 0.0), rate);
    };
    return least_of(places, torques, between).torque;
  }

  void stall_by_energy(const Some& some, StuckHinge& out) const {
    const std::vector<MarginReach>& states = margin_.motion;
    std::vector<double> times, torques;
    for (std::size_t m = 0; m < states.size(); ++m) {
      double turned = 0;
      for (const std::size_t i : some) turned += turns_[i].turned[m];
      times.push_back(states[m].t);
      torques.push_back(states[m].kinetic / turned);
    }
    // At rest at the start it does not set out.
    torques[0] = states[0].kinetic == 0 && rate_in(some, 0) > 0 ? std::max(0.0, rest_[0]) / rate_in(some, 0)
                                                                : unbounded_torque;
    const auto between = [&](double t) {
      double way = 0, speed = 0, turned = 0;
      motion_.at(t, way, speed);
      const Pose here = pose(way);
      const auto behind = std::upper_bound(times.begin() + 1, times.end() - 1, t);
      for (const std::size_t i : some)
        turned += turned_until(i, static_cast<std::size_t>(behind - times.begin()) - 1, here);
      return turned > told_turn ? 0.5 * structure_.sectors * speed * speed / turned : unbounded_torque;
    };
    const Least least = least_of(times, torques, between);
    out.stall_torque = least.torque;
    double speed = 0;
    if (least.torque < unbounded_torque) motion_.at(least.at, out.stall_at, speed);
    out.stall_fold = fold_angle(out.stall_at);
  }

  double fold_angle(double way) const {
    return structure_.deployment.folds() ? structure_.deployment.fold_angle(pose(way).q)
                                         : std::numeric_limits<double>::quiet_NaN();
  }

  // |d angle / ds|, of the table of squares.
  ValueAndSlope turn_rate(const Some& some, double s) const {
    ValueAndSlope sum{0.0, 0.0};
    const PathTable::Segment* here = table_->segment_within_reach(s);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    if (!here) return {nan, nan};
    for (const std::size_t i : some) {
      const ValueAndSlope square = here->at(static_cast<Index>(i), s);
      const double rate = std::sqrt(std::max(0.0, square.value));
      sum.value += rate;
      if (rate > 0) sum.slope += 0.5 * square.slope / rate;
    }
    return sum;
  }

  bool arrives(double torque) {
    motion_.law().jam_torque = torque / structure_.sectors;
    // Only the way on which it was followed is asked for, to rounding.
    const double goal = margin_.motion.back().s * (1 - 1e-9);
    motion_.run(margin_.sense, goal, options_.end_time, false, patience);
    return motion_.ended() == MarginEnd::arrives;
  }

  void stall_by_motion(const Some& some, StuckHinge& out) {
    const auto at = [&](double way) {
      out.stall_at = way;
      out.stall_fold = fold_angle(way);
    };
    if (margin_.end == MarginEnd::stalls) {
      out.stall_torque = 0;
      return at(margin_.motion.back().s);
    }
    motion_.law().jam_turn = [this, &some](double s) { return turn_rate(some, s); };
    motion_.law().looseness = loose_steps;
    double low = 0, high = std::max(first_guess(some), std::numeric_limits<double>::min());
    double stalls_at = 0;
    int tries = 0;
    for (; tries < most_doublings && arrives(high); ++tries) {
      low = high;
      high *= 2;
    }
    stalls_at = motion_.way();
    if (tries == most_doublings) high = low = unbounded_torque;
    const double none = no_torque * first_guess(some);
    while (low < unbounded_torque && high - low > torque_found * high && high > none) {
      const double middle = 0.5 * (low + high);
      if (arrives(middle)) {
        low = middle;
      } else {
        high = middle;
        stalls_at = motion_.way();
      }
    }
    motion_.law().jam_torque = 0;
    out.stall_torque = high;
    at(std::max(0.0, stalls_at));
  }

  // Some torque of the size of what acts, or of what stops the energy of the motion on all its way.
  double first_guess(const Some& some) const {
    double most = 0;
    for (std::size_t j = 0; j < rest_.size(); ++j)
      if (const double rate = rate_in(some, j); rate > 0) most = std::max(most, std::abs(rest_[j]));
    for (const MarginReach& reach : margin_.motion)
      if (const double way = std::abs(margin_.motion.back().s); way > 0)
        most = std::max(most, reach.kinetic / way);
    double fastest = 0;
    for (std::size_t j = 0; j < rest_.size(); ++j) fastest = std::max(fastest, rate_in(some, j));
    return most / fastest;
  }

  const Structure& structure_;
  const SolverOptions& options_;
  const Margin& margin_;
  std::shared_ptr<const Path> path_;
  MarginMotion motion_;
  std::vector<Pose> poses_, points_;  // of the motion, of the margin's points
  std::vector<Hinge> hinges_;         // that turn
  std::vector<Turns> turns_;          // of those
  std::vector<double> rest_;
  bool at_once_ = false;  // no hinge has turned where the motion ends, and those stand here that would
  bool by_pose_ = true;
  std::unique_ptr<HingeRates> rates_;
  std::unique_ptr<PathTable> table_;
};

}  // namespace

std::vector<StuckHinge> stuck_hinges(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                                     const Margin& margin, std::size_t most_for_pairs) {
  return StuckMaker(model, options, margin).make(most_for_pairs);
}

}  // namespace unfurl
