// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/spring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/forces/pulleys.hpp"
#include "core/forces/straight_springs.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/motion_params.hpp"

namespace unfurl {
namespace {

struct Spring {
  Force law;
  MeasureFunction measure;
  int followed;                         // index among the angles that count turns; -1: not one of them
  std::optional<Pulleys> pulleys = {};  // where it rubs on what it runs over
};

class Springs final : public ForceBlock {
 public:
  Springs(const std::vector<Force>& springs, const Deployment& deployment, const std::vector<int>& followed) {
    for (std::size_t i = 0; i < springs.size(); ++i) {
      const Force& f = springs[i];
      damped_ = damped_ || f.damping > 0 || Pulleys::rubs(f);
      reeled_ = reeled_ || f.unstressed.moves();
      if (StraightSprings::fits(f)) {
        straight_.push_back(f);
        continue;
      }
      springs_.push_back({f, MeasureFunction(f.measure, deployment), followed.empty() ? -1 : followed[i]});
      if (Pulleys::rubs(f)) springs_.back().pulleys.emplace(f, deployment);
      size_ = std::max(size_, springs_.back().measure.stencil().size());
    }
  }
  bool constant() const override { return false; }
  bool has_power() const override { return damped_ || reeled_; }
  bool dissipative() const override { return !reeled_; }
  bool dissipates() const override { return damped_; }
  bool supplies() const override { return reeled_; }

  void add(const Moment& at, const double* q, const double* v, double scale, double* f) const override {
    straight_.add(q, v, scale, f);
    Gradient g(size_);
    for (const Spring& spring : springs_) {
      const double s = spring.measure.value_and_gradient(q, v, g.data(), at, spring.followed);
      const SpringLaw law = spring_law(spring.law, at.t, q);
      const double rate = spring.law.damping > 0 ? spring.measure.rate(g.data(), v) - law.rest_rate : 0.0;
      if (law.drum >= 0 && !spring.law.slack)
        f[law.drum] -= scale * law.by_drum * pull_of(spring.law, s - law.rest).energy;
      const double pull = scale * spring_pull(spring.law, law, s, rate).tension;
      if (pull == 0.0) continue;
      if (spring.pulleys) spring.pulleys->weigh(v, g.data());
      const auto& stencil = spring.measure.stencil();
      for (std::size_t i = 0; i < stencil.size(); ++i) f[stencil[i]] -= pull * g.data()[i];
    }
  }

  double potential(const Moment& at, const double* q) const override {
    double sum = straight_.potential(q);
    for (const Spring& spring : springs_) sum += potential_of(spring, at, q);
    return sum;
  }

  double taken(const Moment& at, const double* q) const override {
    double sum = straight_.taken(q);
    for (const Spring& spring : springs_)
      if (lets_go(spring.law)) sum -= potential_of(spring, at, q);
    return sum;
  }

  double power(const Moment& at, const double* q, const double* v) const override {
    return dissipation(at, q, v) + reeling(at, q, v);
  }

  double dissipation(const Moment& at, const double* q, const double* v) const override {
    if (!damped_) return 0.0;
    Gradient g(size_);
    double sum = straight_.dissipation(q, v);
    for (const Spring& spring : springs_) {
      if (!(spring.law.damping > 0) && !spring.pulleys) continue;
      const double s = spring.measure.value_and_gradient(q, v, g.data(), at, spring.followed);
      const SpringLaw law = spring_law(spring.law, at.t, q);
      if (lets_go(spring.law)) {
        sum -= law.stiffness_rate * pull_of(spring.law, s - law.rest).energy;
        continue;
      }
      const double rate = spring.measure.rate(g.data(), v), stretching = rate - law.rest_rate;
      const double n = spring_pull(spring.law, law, s, stretching).tension;
      const double elastic = law.stiffness * pull_of(spring.law, s - law.rest).elastic;
      sum -= (n - elastic) * stretching;
      if (!spring.pulleys) continue;
      spring.pulleys->weigh(v, g.data());
      sum -= n * (spring.measure.rate(g.data(), v) - rate);
    }
    return sum;
  }

  void derivatives(const Moment& at, const double* q, const double* v, ForceDerivative& by_q,
                   ForceDerivative& by_v) const override {
    straight_.derivatives(q, v, by_q, by_v);
    VectorXd g, bend;
    for (const Spring& spring : springs_) {
      const auto& stencil = spring.measure.stencil();
      g.resize(static_cast<Index>(stencil.size()));
      const double s = spring.measure.value_and_gradient(q, v, g.data(), at, spring.followed);
      const SpringLaw law = spring_law(spring.law, at.t, q);
      const double rate = spring.measure.rate(g.data(), v) - law.rest_rate;
      const double n = spring_pull(spring.law, law, s, rate).tension;
      const PullByLength pull = pull_of(spring.law, s - law.rest);
      // Its drum's own, which the stretch pulls on where its damper lets nothing else pull.
      if (law.drum >= 0 && !spring.law.slack) {
        by_q.emplace_back(law.drum, law.drum, -law.by_drum_too * pull.energy);
        for (std::size_t i = 0; i < stencil.size(); ++i)
          by_q.emplace_back(law.drum, stencil[i], -law.by_drum * pull.elastic * g[static_cast<Index>(i)]);
      }
      if (spring.law.one_sided && n == 0.0) continue;
      if (spring.pulleys)
        spring.pulleys->derivatives(q, v, n, by_q, by_v);
      else
        spring.measure.add_hessian(q, -n, by_q);
      const double c = spring.law.damping;
      const bool in_line = std::abs(s - law.rest) <= rounding * (1 + std::abs(law.rest)) &&
                           spring.measure.add_square_in_line(q, -law.stiffness, by_q);
      const double by_stretch = in_line ? 0.0 : law.stiffness * pull.share + c * pull.bend * rate;
      bend = by_stretch * g;
      if (c > 0) spring.measure.add_hessian_times(q, v, c * pull.share, bend.data());
      const VectorXd along = g;  // of the rate; what pulls is weighed by the pulleys
      if (spring.pulleys) spring.pulleys->weigh(v, g.data());
      if (law.drum >= 0)
        for (std::size_t i = 0; i < stencil.size(); ++i)
          by_q.emplace_back(stencil[i], law.drum, -law.by_drum * pull.elastic * g[static_cast<Index>(i)]);
      for (std::size_t j = 0; j < stencil.size(); ++j)
        for (std::size_t i = 0; i < stencil.size(); ++i) {
          const double gi = g[static_cast<Index>(i)], gj = along[static_cast<Index>(j)];
          by_q.emplace_back(stencil[i], stencil[j], -gi * bend[static_cast<Index>(j)]);
          if (c > 0) by_v.emplace_back(stencil[i], stencil[j], -c * pull.share * gi * gj);
        }
    }
  }

 private:
  static constexpr double rounding = 1e-11;  // of an angle at rest in line [rad]

  // Slack while it is still stretched, as its damper would push: it gives no force, and what it has stored is
  // gone by and by as it comes to its length; of what is reeled less what its winch gives and takes.
  static bool lets_go(const Force& law) { return law.slack && law.damping > 0; }

  static double potential_of(const Spring& spring, const Moment& at, const double* q) {
    const SpringLaw law = spring_law(spring.law, at.t, q);
    const double s = spring.measure.value(q, at, spring.followed);
    return law.stiffness * pull_of(spring.law, s - law.rest).energy;
  }

  double reeling(const Moment& at, const double* q, const double* v) const {
    Gradient g(size_);
    double sum = 0;
    for (const Spring& spring : springs_) {
      if (!spring.law.unstressed.moves()) continue;
      const SpringLaw law = spring_law(spring.law, at.t, q);
      const double s = spring.measure.value_and_gradient(q, v, g.data(), at, spring.followed);
      sum += spring_pull(spring.law, law, s, spring.measure.rate(g.data(), v) - law.rest_rate).reeling;
    }
    return sum;
  }

  // Room for one gradient: on the stack for all but long fold measures, so that a step allocates nothing.
  class Gradient {
   public:
    explicit Gradient(std::size_t size) {
      if (size > near_.size()) far_.resize(size);
    }
    double* data() { return far_.empty() ? near_.data() : far_.data(); }

   private:
    std::array<double, 48> near_;
    std::vector<double> far_;
  };

  StraightSprings straight_;
  std::vector<Spring> springs_;  // the others
  std::size_t size_ = 0;
  bool damped_ = false, reeled_ = false;
};

std::unique_ptr<ForceBlock> block_of(const Structure& structure, std::string_view kind) {
  std::vector<Force> springs;
  std::vector<int> followed;
  const std::vector<int> of_force = followed_angles(structure).of_force;
  for (std::size_t i = 0; i < structure.forces.size(); ++i) {
    if (structure.forces[i].kind != kind) continue;
    springs.push_back(structure.forces[i]);
    followed.push_back(of_force[i]);
  }
  return spring_block(springs, structure.deployment, followed);
}

// `rest` [m] or [rad] where it is given.
void fill_spring(const ParamSet& values, double rest, Force& force) {
  force.stiffness = values.real("stiffness");
  force.damping = values.real("damping");
  if (!std::isnan(rest)) force.rest = rest;
}

// A winch's cable: its path and the coordinate of a drum, which goes with x.
int drum_of(const Force& force) {
  if (force.kind != "cable" || force.measure.terms.empty()) return -1;
  const Measure& last = force.measure.terms.back().measure;
  return last.kind == MeasureKind::coordinate ? 3 * last.nodes[0] : -1;
}

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double as_built = std::numeric_limits<double>::quiet_NaN();

}  // namespace

SpringLaw spring_law(const Force& force, double t, const double* q) {
  if (!(force.axial_stiffness > 0)) return {force.stiffness, force.rest, 0.0, 0.0};
  const double length = force.unstressed(t), rate = force.unstressed.derivative(1, t);
  if (const int drum = drum_of(force); drum >= 0) {
    const double left = length - q[drum], k = force.axial_stiffness / left;
    return {k, length, 0.0, 0.0, drum, k / left, 2 * k / (left * left)};
  }
  const double k = force.axial_stiffness / length;
  return {k, length, -k * rate / length, rate};
}

// What comes in is what T + V gain beside what is dissipated, (N - N_e)(s' - s_0'): k' V / k - N s_0'
SpringPull spring_pull(const Force& force, const SpringLaw& law, double s, double stretching) {
  const PullByLength pull = pull_of(force, s - law.rest);
  const double all = law.stiffness * pull.elastic + force.damping * pull.share * stretching;
  const double n = force.slack ? 0.0 : force.one_sided ? std::max(all, 0.0) : all;
  return {n, law.stiffness_rate * pull.energy - n * law.rest_rate};
}

std::unique_ptr<ForceBlock> spring_block(const std::vector<Force>& springs, const Deployment& deployment,
                                         const std::vector<int>& followed) {
  if (springs.empty()) return nullptr;
  return std::make_unique<Springs>(springs, deployment, followed);
}

std::unique_ptr<ForceBlock> axial_spring_block(const Structure& structure, const SparseRows&) {
  return block_of(structure, "spring");
}

std::unique_ptr<ForceBlock> cable_block(const Structure& structure, const SparseRows&) {
  return block_of(structure, "cable");
}

std::unique_ptr<ForceBlock> combination_block(const Structure& structure, const SparseRows&) {
  return block_of(structure, "combination");
}

std::unique_ptr<ForceBlock> torsion_spring_block(const Structure& structure, const SparseRows&) {
  return block_of(structure, "torsion_spring");
}

void fill_axial_spring(const ParamSet& values, Force& force) {
  fill_spring(values, values.real("free_length"), force);
  force.one_sided = values.boolean("tension_only");
}

const std::vector<ParamSpec>& cable_params() {
  static const std::vector<ParamSpec> params = [] {
    std::vector<ParamSpec> all = {
        real_param("axial_stiffness", "N", 0.0, 0.0, infinity,
                   "E A of an elastic cable, which pulls with E A (S / L - 1); 0: it does not stretch"),
        positive_param("length", "m", as_built,
                       "unstressed, at t = 0; by default the length of its path there"),
        only_given("axial_stiffness", real_param("damping", "N s/m", 0.0, 0.0, infinity,
                                                 "elastic: force per m/s of stretching")),
        only_given("axial_stiffness",
                   real_param("smoothing", "m", 0.0, 0.0, infinity,
                              "elastic: it begins to pull over this much on both sides of its length, for "
                              "nets of hundreds of cables; 0: at an event of its own")),
        pulley_friction_param(),
        pulley_creep_param()};
    for (ParamSpec& spec : motion_params("m")) all.push_back(std::move(spec));
    return all;
  }();
  return params;
}

void fill_cable(const ParamSet& values, Force& force) {
  force.one_sided = true;
  force.axial_stiffness = values.real("axial_stiffness");
  force.damping = values.real("damping");
  force.smoothing = values.real("smoothing");
  fill_pulleys(values, force);
  if (const double length = values.real("length"); !std::isnan(length)) force.rest = length;
  force.unstressed = motion_function(values, force.rest, 1.0);
}

ParamSpec pulley_friction_param() {
  return only_given("axial_stiffness",
                    real_param("pulley_friction", "", 0.0, 0.0, infinity,
                               "elastic: Coulomb's mu on all nodes between its ends; over a wrap angle beta "
                               "tensions differ by exp(mu beta)"));
}

ParamSpec pulley_creep_param() {
  return only_given(
      "pulley_friction",
      positive_param("pulley_creep", "m/s", 0.01,
                     "over a node it rubs fully where it runs at least so fast; slower it creeps"));
}

// Force::kinetic of a cable is mu, Force::holding the speed from which on it has all of that.
void fill_pulleys(const ParamSet& values, Force& cable) {
  cable.kinetic = values.real("pulley_friction");
  cable.holding = values.real("pulley_creep");
}

const std::vector<ParamSpec>& combination_params() {
  static const std::vector<ParamSpec> params = {
      real_param("stiffness", "", 0.0, 0.0, infinity,
                 "N/m, or N m/rad where all terms are angles: of the sum"),
      real_param("damping", "", 0.0, 0.0, infinity, "of the sum, per its rate"),
      only_given("stiffness", real_param("free_value", "", as_built, -infinity, infinity,
                                         "of the sum without a force, m or deg; by default that at t = 0"))};
  return params;
}

void fill_combination(const ParamSet& values, Force& force) {
  fill_spring(values, values.real("free_value") * (is_angle(force.measure) ? radians_per_degree : 1.0),
              force);
}

void fill_torsion_spring(const ParamSet& values, Force& force) {
  fill_spring(values, values.real("free_angle") * radians_per_degree, force);
}

const std::vector<ParamSpec>& axial_spring_params() {
  static const std::vector<ParamSpec> params = {
      real_param("stiffness", "N/m", 0.0, 0.0, infinity, "force per metre of stretch"),
      real_param("damping", "N s/m", 0.0, 0.0, infinity, "force per m/s of stretching"),
      // What only pulls is slack below it, a damper too.
      only_with("tension_only", {"true"},
                only_given("stiffness", real_param("free_length", "m", as_built, 0.0, infinity,
                                                   "without force; by default the length at t = 0"))),
      boolean_param("tension_only", false, "a cable: pulls, never pushes")};
  return params;
}

const std::vector<ParamSpec>& torsion_spring_params() {
  static const std::vector<ParamSpec> params = {
      real_param("stiffness", "N m/rad", 0.0, 0.0, infinity, "torque per radian"),
      real_param("damping", "N m s/rad", 0.0, 0.0, infinity, "torque per rad/s"),
      only_given("stiffness",
                 real_param("free_angle", "deg", as_built, -infinity, infinity,
                            "without torque, any number of turns away; by default the angle at t = 0")),
      vector_param(
          "axis", "", {0, 0, 0},
          "of the hinge: the angle then has a sign and counts any number of turns; none: in [0, 180]")};
  return params;
}

}  // namespace unfurl
