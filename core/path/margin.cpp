// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/margin.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/math/quadrature.hpp"
#include "core/path/path_forces.hpp"
#include "core/path/path_scope.hpp"
#include "core/path/path_time.hpp"
#include "core/path/scalar_motion.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {
namespace {

constexpr int poses = 400;       // at which margins are taken
constexpr int parts = 8;         // of a step of the motion
constexpr long far_enough = 64;  // pieces of the path, to the deployed pose
// What is left of forces across the path is rounding.
constexpr double rounding = 1e-13;
constexpr double infinite = std::numeric_limits<double>::infinity();

// The sources with their factors, and the law of motion that follows. The sense is the way it deploys.
class Sources final : public ScalarLaw {
 public:
  Sources(const Path& path, const Structure& structure)
      : forces_(structure, path.system(), true), table_(path, forces_) {}

  const std::vector<PathForces::Source>& list() const { return forces_.sources(); }
  std::vector<double> factors;
  double sense = 0;                         // in which friction is overcome at rest; 0: it is left out there
  double low = -infinite, high = infinite;  // where it may be asked

  // Of source k along the path, at rest or at a speed.
  double force(std::size_t k, double s, double v, double t) const { return of(k, s, v, t).Q; }
  Value of(std::size_t k, double s, double v, double t) const {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const PathTable::Segment* here = table_.segment(s);
    return here ? value_of(*here, k, s, v, t) : Value{nan, nan, nan, nan, nan};
  }

  Value at(double s, double v, double t) const override {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const PathTable::Segment* here = s >= low && s <= high ? table_.segment(s) : nullptr;
    if (!here) return {nan, nan, nan, nan, nan};
    Value sum;
    for (std::size_t k = 0; k < list().size(); ++k) {
      const Value q = value_of(*here, k, s, v, t);
      sum.Q += q.Q;
      sum.by_s += q.by_s;
      sum.by_v += q.by_v;
      sum.scale += q.scale;
      sum.noise += q.noise;
    }
    return sum;
  }

 private:
  Value value_of(const PathTable::Segment& here, std::size_t k, double s, double v, double t) const {
    const PathForces::Source& source = list()[k];
    if (source.cable >= 0) {
      const PathForces::Cable& cable = forces_.cables()[static_cast<std::size_t>(source.cable)];
      const ValueAndSlope m = here.at(cable.measure, s);
      const double e = m.value - cable.rest;
      if (!(e > 0 && cable.stiffness * e + cable.damping * m.slope * v > 0)) return {};
    }
    if (source.friction >= 0) return friction(here, k, s, v);
    const ValueAndSlope p = here.at(source.position, s), c = here.at(source.damping, s);
    const double f = factors[k], size = f * (source.timed ? source.size(t) : 1.0);
    return {size * p.value - f * c.value * v, size * p.slope - f * c.slope * v, -f * c.value,
            std::abs(size) * here.scale[source.position] + std::abs(f * c.value * v),
            std::abs(size) * here.noise[source.position] + std::abs(f * v) * here.noise[source.damping] +
                f * source.size_noise(t) * std::abs(p.value)};
  }

  // Against the motion; at rest, what holds it.
  Value friction(const PathTable::Segment& here, std::size_t k, double s, double v) const {
    const PathForces::Friction& law = forces_.frictions()[static_cast<std::size_t>(list()[k].friction)];
    const ValueAndSlope p = here.at(list()[k].position, s);
    const double against = v != 0 ? -std::copysign(1.0, v) : -sense;
    const double size = factors[k] * against * (v != 0 ? law.kinetic : law.holding);
    return {size * std::abs(p.value), size * std::copysign(p.slope, p.value * p.slope), 0.0,
            std::abs(size) * here.scale[list()[k].position], std::abs(size) * here.noise[list()[k].position]};
  }

  PathForces forces_;
  mutable PathTable table_;
};

class MarginMaker {
 public:
  MarginMaker(const std::shared_ptr<const Model>& model, const SolverOptions& options,
              const std::map<std::string, double>& factors)
      : model_(model),
        structure_(model->structure),
        options_(options),
        path_(trace_path(model)),
        sources_(*path_, structure_) {
    if (driven_row(structure_))
      throw PathRefused(
          "a drive prescribes the motion: what it can give at most is not known, and no margin");
    std::vector<std::string_view> names;
    for (const PathForces::Source& source : sources_.list()) {
      const auto found = factors.find(source.name);
      out_.sources.push_back({source.name, source.kind, found == factors.end() ? 1.0 : found->second});
      sources_.factors.push_back(out_.sources.back().factor);
      names.push_back(source.name);
    }
    for (const auto& [name, factor] : factors)
      if (std::find(names.begin(), names.end(), name) == names.end())
        throw StudyError("nothing that acts is called " + in_quotes(name) + did_you_mean(name, names));
  }

  Margin make() {
    find_way();
    move();
    if (!end_) end_ = out_.motion.back().s;
    take_points();
    return std::move(out_);
  }

 private:
  struct Pose {
    VectorXd q, dq;  // dq/ds, the way it deploys
  };

  Pose pose(double s) const {
    VectorXd z, tangent;
    if (!path_->point(sense_ * s, z, tangent)) throw PathRefused("the path cannot be followed so far");
    Pose out{VectorXd(path_->system().coordinates()), VectorXd(path_->system().coordinates())};
    path_->system().expand(z, out.q);
    path_->system().expand_rate(sense_ * tangent, out.dq);
    return out;
  }

  double fold_angle(double s) const {
    return structure_.deployment.folds() ? structure_.deployment.fold_angle(pose(s).q)
                                         : std::numeric_limits<double>::quiet_NaN();
  }

  // The way to the deployed pose; where there is none, that of the motion.
  void find_way() {
    const InitialState start = initial_state(structure_, model_->system);
    VectorXd z, tangent, v(path_->system().coordinates());
    if (!path_->point(0.0, z, tangent)) throw PathRefused("no path leads on from the pose at the start");
    model_->system.expand_rate(start.state.w, v);
    speed_ = tangent.dot(path_->system().mass() * path_->system().reduce_rate(v));
    const double push = speed_ != 0 ? speed_ : sources_.at(0.0, 0.0, 0.0).Q;
    sense_ = push < 0 ? -1.0 : 1.0;
    sources_.sense = sense_;
    if (structure_.deployment.empty()) return;
    sense_ = 1.0;
    const Pose here = pose(0.0);
    sense_ = structure_.deployment.remaining_rate(here.q, here.dq) < 0 ? 1.0 : -1.0;
    const auto zero = deployed_pose(*path_, structure_.deployment, sense_ > 0, far_enough);
    if (!zero) throw PathRefused("the path does not lead to a deployed pose");
    end_ = sense_ * *zero;
    sources_.sense = sense_;
  }

  void reach(double s, double t, double v, double driven, double resisted) {
    const double all = structure_.sectors;
    out_.motion.push_back({s, t, fold_angle(s), 0.5 * all * v * v, all * driven, all * resisted});
  }

  // The motion from the start until it arrives, turns back, or the end time.
  void move() {
    double t = 0, s = 0, v = speed_, h = 1e-3 * options_.end_time, driven = 0.5 * v * v, resisted = 0;
    reach(0, 0, v, driven, resisted);
    if (v == 0 && !(sense_ * sources_.at(0, 0, 0).Q > 0)) {
      out_.dynamic_min = static_margin(0.0, 0.0);
      return;
    }
    const Quadrature gauss = gauss_legendre(8);
    for (long count = 0; t < options_.end_time && !out_.arrives; ++count) {
      look_from(s);
      ScalarStep step;
      if (!scalar_step(sources_, t, s, v, options_.end_time, h, step))
        throw PathRefused("the motion on the path cannot be resolved");
      for (int p = 0; p < parts; ++p) {
        double a = step.t0 + step.h * p / parts, b = step.t0 + step.h * (p + 1) / parts;
        step.at(b, s, v);
        const bool turns = sense_ * v <= 0, passes = end_ && sense_ * s >= *end_;
        if (turns || passes) b = last_time(step, a, b, turns);
        work(step, a, b, gauss, driven, resisted);
        step.at(b, s, v);
        reach(sense_ * s, b, v, driven, resisted);
        out_.arrives = passes && !turns;
        if (turns || passes) return take_dynamic();
      }
      t = step.end();
    }
    out_.arrives = !end_;
    take_dynamic();
  }

  // When the speed falls to zero, or the end is reached.
  double last_time(const ScalarStep& step, double a, double b, bool turns) const {
    for (int it = 0; it < 60; ++it) {
      const double middle = 0.5 * (a + b);
      double s = 0, v = 0;
      step.at(middle, s, v);
      ((turns ? sense_ * v > 0 : sense_ * s < *end_) ? a : b) = middle;
    }
    return a;
  }

  void work(const ScalarStep& step, double a, double b, const Quadrature& gauss, double& driven,
            double& resisted) const {
    for (Index i = 0; i < gauss.nodes.size(); ++i) {
      const double t = a + (b - a) * gauss.nodes[i];
      double s = 0, v = 0;
      step.at(t, s, v);
      for (std::size_t k = 0; k < out_.sources.size(); ++k) {
        const double power = (b - a) * gauss.weights[i] * sources_.force(k, s, v, t) * v;
        (power > 0 ? driven : resisted) += std::abs(power);
      }
    }
  }

  void look_from(double s) {
    const auto here = path_->piece_of(s);
    if (!here) return;
    const PathPiece *before = path_->piece(*here - 1), *after = path_->piece(*here + 1);
    sources_.low = before ? before->a : path_->piece(*here)->a;
    sources_.high = after ? after->b : path_->piece(*here)->b;
  }

  void take_dynamic() {
    // A motion that begins with a speed has resisted nothing yet there.
    out_.dynamic_min = speed_ != 0 ? infinite : static_margin(0.0, 0.0);
    for (const MarginReach& reach : out_.motion)
      if (const double m = reach.margin(); reach.resisted > 0 && m < out_.dynamic_min)
        out_.dynamic_min = m, out_.dynamic_at = reach.s;
    if (!out_.arrives) out_.dynamic_at = out_.motion.back().s;
  }

  // Loads over time are taken as the motion finds them in that pose, or at its end.
  double time_at(double s) const {
    for (const MarginReach& reach : out_.motion)
      if (reach.s >= s) return reach.t;
    return out_.motion.back().t;
  }

  double static_margin(double s, double t) const {
    double drives = 0, resistances = 0;
    for (std::size_t k = 0; k < out_.sources.size(); ++k) {
      const ScalarLaw::Value at = sources_.of(k, sense_ * s, 0.0, t);
      if (std::abs(at.Q) <= rounding * at.scale) continue;
      (sense_ * at.Q > 0 ? drives : resistances) += std::abs(at.Q);
    }
    if (resistances <= rounding * drives) return drives > 0 ? infinite : 0.0;
    return drives / resistances - 1;
  }

  MarginPoint point(double s) const {
    const Pose at = pose(s);
    const double t = time_at(s);
    MarginPoint out{s, std::numeric_limits<double>::quiet_NaN(), VectorXd(std::ssize(out_.sources)),
                    static_margin(s, t)};
    double by_angle = 1;
    if (structure_.deployment.folds()) {
      out.fold_angle = structure_.deployment.fold_angle(at.q);
      by_angle = 1 / std::abs(structure_.deployment.fold_rate(at.q, at.dq));
    }
    for (std::size_t k = 0; k < out_.sources.size(); ++k)
      out.forces[static_cast<Index>(k)] =
          structure_.sectors * by_angle * sense_ * sources_.force(k, sense_ * s, 0.0, t);
    return out;
  }

  void take_points() {
    out_.unit = structure_.deployment.folds() ? "N m" : "N/kg^1/2";
    for (int i = 0; i < poses; ++i) out_.points.push_back(point(*end_ * i / (poses - 1)));
    const auto worst =
        std::min_element(out_.points.begin(), out_.points.end(), [](const auto& a, const auto& b) {
          // Where nothing drives, the strongest resistance.
          return a.margin != b.margin ? a.margin < b.margin
                                      : a.margin == -1 && a.forces.sum() < b.forces.sum();
        });
    out_.worst = *worst;
    if (!std::isfinite(worst->margin)) return;
    // Golden section between the poses beside the worst.
    constexpr double golden = 0.6180339887498949;
    double a = worst == out_.points.begin() ? worst->s : (worst - 1)->s;
    double b = worst + 1 == out_.points.end() ? worst->s : (worst + 1)->s;
    for (int it = 0; it < 60; ++it) {
      const double x = b - golden * (b - a), y = a + golden * (b - a);
      (static_margin(x, time_at(x)) < static_margin(y, time_at(y)) ? b : a) =
          static_margin(x, time_at(x)) < static_margin(y, time_at(y)) ? y : x;
    }
    if (const MarginPoint refined = point(0.5 * (a + b)); refined.margin < out_.worst.margin)
      out_.worst = refined;
  }

  std::shared_ptr<const Model> model_;
  const Structure& structure_;
  const SolverOptions& options_;
  std::shared_ptr<const Path> path_;
  Sources sources_;
  Margin out_;
  double sense_ = 1, speed_ = 0;
  std::optional<double> end_;
};

// Pairs of rods that meet at a node.
struct Hinge {
  std::string name;
  int pin = 0, first = 0, second = 0;  // nodes
};

std::vector<Hinge> hinges_of(const Structure& structure) {
  std::vector<Hinge> out;
  const auto other = [&](const Rod& rod, int node) { return rod.a == node ? rod.b : rod.a; };
  for (int node = 0; node < static_cast<int>(structure.nodes.size()); ++node)
    for (std::size_t i = 0; i < structure.rods.size(); ++i)
      for (std::size_t k = i + 1; k < structure.rods.size(); ++k) {
        const Rod &a = structure.rods[i], &b = structure.rods[k];
        if ((a.a != node && a.b != node) || (b.a != node && b.b != node)) continue;
        out.push_back({a.name + " / " + b.name, node, other(a, node), other(b, node)});
      }
  return out;
}

double angle_at(const Hinge& hinge, const VectorXd& q) {
  const auto at = [&](int node) { return Vec3(q.segment<3>(3 * static_cast<Index>(node))); };
  const Vec3 a = at(hinge.first) - at(hinge.pin), b = at(hinge.second) - at(hinge.pin);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// From the angle turned until each place of the motion.
StuckHinge stuck(const std::string& name, const std::vector<double>& turned, const Margin& margin) {
  StuckHinge out{name, infinite, infinite, 0.0, 0.0, turned.back()};
  for (std::size_t i = 1; i < turned.size(); ++i) {
    const MarginReach &a = margin.motion[i - 1], &b = margin.motion[i];
    if (const double torque = b.kinetic / turned[i]; torque < out.stall_torque)
      out.stall_torque = torque, out.stall_at = b.s, out.stall_fold = b.fold_angle;
    const double turn = turned[i] - turned[i - 1], net = b.driven - b.resisted - a.driven + a.resisted;
    if (turn > 0) out.static_torque = std::min(out.static_torque, std::max(0.0, net / turn));
  }
  return out;
}

}  // namespace

double MarginReach::margin() const {
  return resisted > rounding * driven ? driven / resisted - 1 : infinite;
}

Margin margin_of(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                 const std::map<std::string, double>& factors) {
  return MarginMaker(model, options, factors).make();
}

std::vector<StuckHinge> stuck_hinges(const std::shared_ptr<const Model>& model, const Margin& margin,
                                     bool pairs) {
  constexpr double still = 1e-9;  // [rad]
  const auto path = trace_path(model);
  const Structure& structure = model->structure;
  double sense = 1;
  VectorXd z, tangent, q(path->system().coordinates()), v(q.size());
  if (!structure.deployment.empty()) {
    path->point(0.0, z, tangent);
    path->system().expand_rate(tangent, v);
    path->system().expand(z, q);
    sense = structure.deployment.remaining_rate(q, v) < 0 ? 1.0 : -1.0;
  } else if (margin.motion.size() > 1) {
    sense = margin.motion.back().s >= 0 ? 1.0 : -1.0;
  }
  std::vector<std::string> names;
  std::vector<std::vector<double>> turned;
  for (const Hinge& hinge : hinges_of(structure)) {
    std::vector<double> sum{0.0};
    double before = 0;
    for (std::size_t i = 0; i < margin.motion.size(); ++i) {
      path->point(sense * margin.motion[i].s, z, tangent);
      path->system().expand(z, q);
      const double angle = angle_at(hinge, q);
      if (i > 0) sum.push_back(sum.back() + std::abs(angle - before));
      before = angle;
    }
    if (sum.back() < still) continue;
    names.push_back(hinge.name);
    turned.push_back(std::move(sum));
  }
  std::vector<StuckHinge> out;
  for (std::size_t i = 0; i < names.size(); ++i) out.push_back(stuck(names[i], turned[i], margin));
  for (std::size_t i = 0; pairs && i < names.size(); ++i)
    for (std::size_t k = i + 1; k < names.size(); ++k) {
      std::vector<double> both = turned[i];
      for (std::size_t m = 0; m < both.size(); ++m) both[m] += turned[k][m];
      out.push_back(stuck(names[i] + " and " + names[k], both, margin));
    }
  return out;
}

}  // namespace unfurl
