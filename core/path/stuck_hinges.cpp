// SPDX-License-Identifier: BSD-3-Clause
// Hinges that jam: path/margin.hpp.
#include <algorithm>
#include <cmath>

#include "core/path/hinge_turns.hpp"
#include "core/path/margin.hpp"
#include "core/path/margin_motion.hpp"
#include "core/path/path_scope.hpp"

namespace unfurl {
namespace {

constexpr double still = 1e-9;         // [rad]
constexpr double hardly_turns = 1e-6;  // of the hinge's fastest turn: a pose that no torque of it holds
constexpr double torque_found = 1e-7;  // as a share
constexpr double loose_steps = 1e-9;   // of motions that only tell whether they arrive
// A motion without loads over time that creeps is followed for so many end times.
constexpr double patience = 1e9;
constexpr double unbounded_torque = std::numeric_limits<double>::infinity();

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
    for (const Hinge& hinge : hinges_of(structure_)) take(hinge);
    for (std::size_t j = 0; j < margin_.points.size(); ++j) rest_.push_back(rest_force(margin_.points[j]));
    by_pose_ = depends_on_pose();
    if (!by_pose_) {
      rates_ = std::make_unique<HingeRates>(hinges_);
      table_ = std::make_unique<PathTable>(*path_, *rates_);
    }
  }

  std::vector<StuckHinge> make(std::size_t most_for_pairs) {
    std::vector<StuckHinge> out;
    for (std::size_t i = 0; i < hinges_.size(); ++i) out.push_back(stuck(hinges_[i].name, {i}));
    if (hinges_.size() > most_for_pairs) return out;
    for (std::size_t i = 0; i < hinges_.size(); ++i)
      for (std::size_t k = i + 1; k < hinges_.size(); ++k)
        out.push_back(stuck(hinges_[i].name + " and " + hinges_[k].name, {i, k}));
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
    std::vector<double> turned{0.0};
    double before = hinge_angle(hinge, poses_[0].q), rate = hinge_rate(hinge, poses_[0].q, poses_[0].dq);
    for (std::size_t i = 1; i < poses_.size(); ++i) {
      const double angle = hinge_angle(hinge, poses_[i].q);
      const double next = hinge_rate(hinge, poses_[i].q, poses_[i].dq);
      double turn = std::abs(angle - before);
      if (rate * next < 0) {
        const double between = turn_of(hinge, margin_.motion[i - 1].s, margin_.motion[i].s, rate);
        turn = std::abs(between - before) + std::abs(angle - between);
      }
      turned.push_back(turned.back() + turn);
      before = angle;
      rate = next;
    }
    if (turned.back() < still) return;
    std::vector<double> rates;
    for (const Pose& at : points_) rates.push_back(std::abs(hinge_rate(hinge, at.q, at.dq)));
    hinges_.push_back(hinge);
    turned_.push_back(std::move(turned));
    rate_.push_back(std::move(rates));
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

  // Of the whole structure along the path, the way it deploys.
  double rest_force(const MarginPoint& point) const {
    const double s = margin_.sense * point.s;
    return structure_.sectors * (margin_.sense * motion_.law().at_rest(s, point.t).Q - motion_.law().hold(s));
  }

  bool depends_on_pose() const {
    if (motion_.law().timed()) return false;
    for (const MarginPoint& point : margin_.points)
      for (std::size_t g = 0; g < margin_.sources.size(); ++g)
        if (motion_.law().damps(g, margin_.sense * point.s)) return false;
    return true;
  }

  StuckHinge stuck(const std::string& name, const Some& some) {
    StuckHinge out{name, static_torque(some), unbounded_torque, 0.0, 0.0, 0.0};
    for (const std::size_t i : some) out.turn += turned_[i].back();
    if (by_pose_)
      stall_by_energy(some, out);
    else
      stall_by_motion(some, out);
    return out;
  }

  double rate_in(const Some& some, std::size_t point) const {
    double sum = 0;
    for (const std::size_t i : some) sum += rate_[i][point];
    return sum;
  }

  double static_torque(const Some& some) const {
    double fastest = 0, least = unbounded_torque;
    for (std::size_t j = 0; j < rest_.size(); ++j) fastest = std::max(fastest, rate_in(some, j));
    for (std::size_t j = 0; j < rest_.size(); ++j)
      if (const double rate = rate_in(some, j); rate > hardly_turns * fastest)
        least = std::min(least, std::max(0.0, rest_[j] / rate));
    return least;
  }

  void stall_by_energy(const Some& some, StuckHinge& out) const {
    const auto take_least = [&](double torque, const MarginReach& at) {
      if (torque < out.stall_torque)
        out.stall_torque = torque, out.stall_at = at.s, out.stall_fold = at.fold_angle;
    };
    // At rest at the start it does not set out.
    if (margin_.motion[0].kinetic == 0 && rate_in(some, 0) > 0)
      take_least(std::max(0.0, rest_[0]) / rate_in(some, 0), margin_.motion[0]);
    for (std::size_t m = 1; m < margin_.motion.size(); ++m) {
      double turned = 0;
      for (const std::size_t i : some) turned += turned_[i][m];
      take_least(margin_.motion[m].kinetic / turned, margin_.motion[m]);
    }
  }

  // |d angle / ds|, of the table of squares.
  ValueAndSlope turn_rate(const Some& some, double s) const {
    ValueAndSlope sum{0.0, 0.0};
    for (const std::size_t i : some) {
      const ValueAndSlope square = table_->at(static_cast<Index>(i), s);
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
    const bool timed = motion_.law().timed();
    motion_.run(margin_.sense, goal, (timed ? 1.0 : patience) * options_.end_time, false);
    return motion_.ended() == MarginEnd::arrives;
  }

  void stall_by_motion(const Some& some, StuckHinge& out) {
    const auto at = [&](double way) {
      out.stall_at = way;
      out.stall_fold = structure_.deployment.folds() ? structure_.deployment.fold_angle(pose(way).q)
                                                     : std::numeric_limits<double>::quiet_NaN();
    };
    if (margin_.end == MarginEnd::stalls) {
      out.stall_torque = 0;
      return at(margin_.motion.back().s);
    }
    motion_.law().jam_turn = [this, &some](double s) { return turn_rate(some, s); };
    motion_.law().looseness = loose_steps;
    double low = 0, high = std::max(first_guess(some), std::numeric_limits<double>::min());
    double stalls_at = 0;
    for (int it = 0; it < 60 && arrives(high); ++it) {
      low = high;
      high *= 2;
    }
    stalls_at = motion_.way();
    while (high - low > torque_found * high) {
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

  // Some torque of the size of what acts.
  double first_guess(const Some& some) const {
    double most = 0;
    for (std::size_t j = 0; j < rest_.size(); ++j)
      if (const double rate = rate_in(some, j); rate > 0) most = std::max(most, std::abs(rest_[j]));
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
  std::vector<std::vector<double>> turned_, rate_;
  std::vector<double> rest_;
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
