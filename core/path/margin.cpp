// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/margin.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/math/golden_section.hpp"
#include "core/path/margin_loads.hpp"
#include "core/path/margin_motion.hpp"
#include "core/path/path_scope.hpp"
#include "core/path/path_time.hpp"

namespace unfurl {
namespace {

constexpr int poses = 400;       // at which margins are taken, at least
constexpr long far_enough = 64;  // pieces of the path, to the deployed pose
// What is left of forces across the path is rounding.
constexpr double rounding = 1e-13;
// Of what drives: next to a flat pose the path's own direction, and with it what acts across it, has some
// more.
constexpr double nothing = 1e-10;
// A measure that changes by less, of what is left of it, over a piece of the path is stationary.
constexpr double stationary = 1e-9;
constexpr double same_end = 1e-8;  // of the way: the motion gets there
// Of the way: what acts is not told from its rounding as near to a pose in which nothing has a lever.
constexpr double dead = 1e-5;
constexpr double infinite = std::numeric_limits<double>::infinity();

// drives / resistances - 1; what rounding leaves of sums that are the same is nothing.
double beyond(double drives, double resistances) {
  constexpr double same = 1e-14;
  return std::abs(drives - resistances) <= same * resistances ? 0.0 : drives / resistances - 1;
}

std::string in_degrees(double angle) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g deg", angle / radians_per_degree);
  return text;
}

std::shared_ptr<const Path> path_for_margins(const std::shared_ptr<const Model>& model) {
  std::shared_ptr<const Path> path = trace_path(model);
  if (driven_row(model->structure))
    throw PathRefused("a drive prescribes the motion: what it can give at most is not known, and no margin");
  return path;
}

class MarginMaker {
 public:
  MarginMaker(const std::shared_ptr<const Model>& model, const SolverOptions& options,
              const std::map<std::string, double>& factors)
      : structure_(model->structure),
        options_(options),
        motion_(model, options, path_for_margins(model), factors) {
    for (const MarginLaw::Group& group : motion_.law().groups())
      out_.sources.push_back({group.name, group.kind, group.factor});
  }

  Margin make() {
    find_way();
    motion_.run(out_.sense, end_, options_.end_time, true);
    out_.motion = motion_.reaches();
    for (MarginReach& reach : out_.motion) {
      reach.fold_angle = fold_angle(reach.s);
      for (double* energy : {&reach.kinetic, &reach.driven, &reach.resisted}) *energy *= structure_.sectors;
    }
    out_.end = motion_.ended();
    if (out_.end == MarginEnd::arrives && !out_.stop.empty()) out_.end = MarginEnd::stopped;
    if (out_.end == MarginEnd::stopped && !motion_.stop().empty()) out_.stop = motion_.stop();
    out_.arrives = out_.end == MarginEnd::arrives;
    if (!end_) end_ = out_.motion.back().s;
    take_dynamic();
    take_points();
    take_loads();
    return std::move(out_);
  }

 private:
  struct Pose {
    VectorXd q, dq;  // dq/ds, the way it deploys
  };

  Pose pose(double s, double sense) const {
    const Path& path = motion_.path();
    VectorXd z, tangent;
    if (!path.point(sense * s, z, tangent)) throw PathRefused("the path cannot be followed so far");
    Pose out{VectorXd(path.system().coordinates()), VectorXd(path.system().coordinates())};
    path.system().expand(z, out.q);
    path.system().expand_rate(sense * tangent, out.dq);
    return out;
  }
  Pose pose(double s) const { return pose(s, out_.sense); }

  double fold_angle(double s) const {
    return structure_.deployment.folds() ? structure_.deployment.fold_angle(pose(s).q)
                                         : std::numeric_limits<double>::quiet_NaN();
  }

  // The way to the deployed pose; where there is none, that of the motion.
  void find_way() {
    out_.sense = sets_out();
    if (structure_.deployment.empty()) return;
    const Pose here = pose(0.0, 1.0);
    const double rate = structure_.deployment.remaining_rate(here.q, here.dq);
    const PathPiece* piece = motion_.path().piece(0);
    // The measure says nothing of the way where it is stationary: the motion does, if it leads there.
    const bool by_motion = piece && std::abs(rate) * (piece->b - piece->a) <=
                                        stationary * std::abs(structure_.deployment.remaining(here.q));
    if (!by_motion) out_.sense = rate < 0 ? 1.0 : -1.0;
    auto zero = deployed_pose(motion_.path(), structure_.deployment, out_.sense > 0, far_enough);
    if (!zero && by_motion) {
      out_.sense = -out_.sense;
      zero = deployed_pose(motion_.path(), structure_.deployment, out_.sense > 0, far_enough);
    }
    if (!zero) throw PathRefused(why_not_deployed());
    end_ = out_.sense * *zero;
    if (const auto bar = motion_.barred(out_.sense, *end_)) std::tie(end_, out_.stop) = *bar;
  }

  std::string why_not_deployed() const {
    double end = 0;
    for (long k = 0; k < far_enough; ++k) {
      const PathPiece* piece = motion_.path().piece(out_.sense > 0 ? k : -k - 1);
      if (!piece)
        return "the path cannot be followed to a deployed pose" +
               (structure_.deployment.folds() ? ", no further than to " + in_degrees(fold_angle(end))
                                              : std::string());
      end = out_.sense > 0 ? piece->b : -piece->a;
    }
    return "the path does not lead to a deployed pose";
  }

  // The sense in which the motion begins, whatever may be deployed.
  double sets_out() const {
    if (motion_.speed() != 0) return motion_.speed() < 0 ? -1.0 : 1.0;
    if (const auto free = motion_.release(0.0, 0.0, options_.end_time)) return free->sense;
    return motion_.law().at_rest(0.0, 0.0).Q < 0 ? -1.0 : 1.0;
  }

  void take_dynamic() {
    // A motion that begins with a speed has resisted nothing yet there; what sets out at rest begins with the
    // margin of its forces, in which friction slips.
    const bool moves = out_.motion.back().s > 0;
    out_.dynamic_min = motion_.speed() != 0 ? infinite : static_margin(0.0, motion_.released(), moves);
    if (out_.end == MarginEnd::other_way && motion_.speed() != 0)
      out_.dynamic_min = std::numeric_limits<double>::quiet_NaN();
    const auto take_least = [&](const MarginReach& reach) {
      if (const double m = reach.margin(); reach.resisted > 0 && m < out_.dynamic_min)
        out_.dynamic_min = m, out_.dynamic_at = reach.s;
    };
    for (const MarginReach& reach : out_.motion) take_least(reach);
    if (motion_.least()) take_least(*motion_.least());
    if (!out_.arrives) out_.dynamic_at = out_.motion.back().s;
  }

  // Loads over time are taken as the motion finds them in that pose, or at its end.
  double time_at(double s) const { return motion_.law().timed() ? motion_.time_at(s) : 0.0; }

  // Of source k, at rest: what friction can hold counts against the way; as it sets out, what it takes then.
  ScalarLaw::Value force(std::size_t k, double s, double t, bool slips = false) const {
    ScalarLaw::Value out = motion_.law().at_rest(k, out_.sense * s, t);
    const MarginLaw& law = motion_.law();
    const double hold = slips ? law.slip(k, out_.sense * s) : law.hold(k, out_.sense * s);
    out.Q = out_.sense * out.Q - hold;
    out.scale += hold;
    return out;
  }

  struct Balance {
    double drives = 0, resistances = 0;
    double sum() const { return drives + resistances; }
    double margin() const {
      if (resistances <= nothing * drives) return drives > 0 ? infinite : 0.0;
      return beyond(drives, resistances);
    }
  };

  Balance balance(double s, double t, bool slips = false) const {
    Balance out;
    for (std::size_t k = 0; k < out_.sources.size(); ++k) {
      const ScalarLaw::Value at = force(k, s, t, slips);
      if (std::abs(at.Q) <= rounding * at.scale) continue;
      (at.Q > 0 ? out.drives : out.resistances) += std::abs(at.Q);
    }
    return out;
  }

  // Whether each source acts by less here than there, a part of it at most: friction that goes on holding
  // does not, and decides, however small.
  bool all_fade(double here, double t, double there, double t_there, bool slips) const {
    constexpr double part = 0.2;
    for (std::size_t k = 0; k < out_.sources.size(); ++k) {
      const ScalarLaw::Value at = force(k, here, t, slips), near = force(k, there, t_there, slips);
      if (std::abs(at.Q) > rounding * at.scale && std::abs(at.Q) >= part * std::abs(near.Q)) return false;
    }
    return true;
  }

  // At a dead centre, where all that acts fades away, the least of the limits from its sides. One that the
  // structure rests in at the start has nothing that drives it on.
  double static_margin(double s, double t, bool slips = false) const {
    const Balance here = balance(s, t, slips);
    if (s == 0 && here.sum() == 0) return 0.0;
    double limit = infinite;
    bool fades = false;
    for (const double side : {-3 * dead * *end_, 3 * dead * *end_}) {
      // A dead centre within `dead` of here: both of these are on one side of it.
      const double at_near = s + side, at_far = s + 2 * side;
      if (at_far < 0 || at_far > *end_) continue;
      const auto time = [&](double at) { return s > 0 ? time_at(at) : t; };
      if (!all_fade(s, t, at_near, time(at_near), slips)) continue;
      const Balance near = balance(at_near, time(at_near), slips), far = balance(at_far, time(at_far), slips);
      const double share = near.sum() / far.sum();
      if (share >= 0.6) continue;
      fades = true;
      // How far `near` is from where all is zero, of its way to `far`; that is here where it is to a higher
      // order.
      const double way = share > 0.4 ? share / (1 - share) : 1.0, a = near.margin(), b = far.margin();
      limit = std::min(limit, std::isfinite(a) && std::isfinite(b) ? std::max(a + way * (a - b), -1.0) : a);
    }
    return fades ? limit : here.margin();
  }

  // Of source k, in the margin's unit.
  double told_force(std::size_t k, double s, const Pose& at) const {
    const Deployment& d = structure_.deployment;
    const double by_angle = d.folds() ? 1 / std::abs(d.fold_rate(at.q, at.dq)) : 1.0;
    return structure_.sectors * by_angle * force(k, s, time_at(s)).Q;
  }

  MarginPoint point(double s) const {
    const Pose at = pose(s);
    const double t = time_at(s);
    MarginPoint out{s, std::numeric_limits<double>::quiet_NaN(), VectorXd(std::ssize(out_.sources)),
                    static_margin(s, t), t};
    if (structure_.deployment.folds()) out.fold_angle = structure_.deployment.fold_angle(at.q);
    for (std::size_t k = 0; k < out_.sources.size(); ++k)
      out.forces[static_cast<Index>(k)] = told_force(k, s, at);
    return out;
  }

  // Equal parts of the way; between them loads over time may pass, and cables pull: the motion's steps end
  // where those begin and end.
  std::vector<double> places() const {
    std::vector<double> out;
    for (int i = 0; i < poses; ++i) out.push_back(*end_ * i / (poses - 1));
    if (!motion_.law().timed() && motion_.law().forces().cables().empty()) return out;
    for (const MarginReach& reach : out_.motion)
      if (reach.s > 0 && reach.s < *end_) out.push_back(reach.s);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  // The most that source k drives (sign 1) or resists (-1): around the pose where it is most.
  double largest(std::size_t k, double sign) const {
    const auto at = [&](const MarginPoint& p) { return sign * p.forces[static_cast<Index>(k)]; };
    const auto most = std::ranges::max_element(out_.points, {}, at);
    if (!(at(*most) > 0)) return 0.0;
    const double a = most == out_.points.begin() ? most->s : (most - 1)->s;
    const double b = most + 1 == out_.points.end() ? most->s : (most + 1)->s;
    const auto force = [&](double s) { return sign * told_force(k, s, pose(s)); };
    return std::max(at(*most), force(golden_section([&](double s) { return -force(s); }, a, b, 32)));
  }

  void take_points() {
    out_.unit = structure_.deployment.folds() ? "N m" : "N/kg^1/2";
    for (const double s : places()) out_.points.push_back(point(s));
    for (std::size_t k = 0; k < out_.sources.size(); ++k) {
      out_.sources[k].largest_drive = largest(k, 1);
      out_.sources[k].largest_resistance = largest(k, -1);
    }
    const auto worst =
        std::min_element(out_.points.begin(), out_.points.end(), [](const auto& a, const auto& b) {
          // Where nothing drives, the strongest resistance.
          return a.margin != b.margin ? a.margin < b.margin
                                      : a.margin == -1 && a.forces.sum() < b.forces.sum();
        });
    out_.worst = *worst;
    if (!std::isfinite(worst->margin)) return;
    // Between the poses beside the worst.
    const double a = worst == out_.points.begin() ? worst->s : (worst - 1)->s;
    const double b = worst + 1 == out_.points.end() ? worst->s : (worst + 1)->s;
    const double at = golden_section([&](double s) { return static_margin(s, time_at(s)); }, a, b, 60);
    if (const MarginPoint refined = point(at); refined.margin < out_.worst.margin) out_.worst = refined;
  }

  void take_loads() {
    out_.end_s = *end_;
    out_.end_fold = fold_angle(*end_);
    const Pose at = pose(*end_);
    const double push = out_.sense * motion_.law().at_rest(out_.sense * *end_, time_at(*end_)).Q;
    WayEnd end{out_.sense, *end_, at.q, at.dq, structure_.sectors * push, 0.0};
    double way = 0;
    motion_.at(motion_.t(), way, end.speed);
    if (out_.end == MarginEnd::other_way || *end_ - way > same_end * *end_)
      end.speed = std::numeric_limits<double>::quiet_NaN();
    out_.loads = loads_at_end(structure_, motion_, end, options_.at_deployed == "latch");
  }

  const Structure& structure_;
  const SolverOptions& options_;
  MarginMotion motion_;
  Margin out_;
  std::optional<double> end_;
};

}  // namespace

double MarginReach::margin() const {
  return resisted > nothing * driven ? beyond(driven, resisted) : infinite;
}

Margin margin_of(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                 const std::map<std::string, double>& factors) {
  return MarginMaker(model, options, factors).make();
}

std::string told_end(const Margin& margin, const std::string& place) {
  switch (margin.end) {
    case MarginEnd::arrives:
      return "the motion arrives";
    case MarginEnd::stalls:
      return "the motion stalls at " + place;
    case MarginEnd::stopped:
      return "the motion ends at " + place + ", on the end stop " + margin.stop;
    case MarginEnd::time:
      return "the motion is at " + place + " when its time is up";
    case MarginEnd::other_way:
      return "the motion sets out the other way";
  }
  return "";
}

}  // namespace unfurl
