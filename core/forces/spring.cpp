// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/spring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/structure/measure.hpp"

namespace unfurl {
namespace {

struct Spring {
  MeasureFunction measure;
  double stiffness, damping, rest;
  bool one_sided;
  int followed;  // index among the angles that count turns; -1: not one of them

  double near(const Moment& at) const { return at.near(followed, measure.reference()); }
  double stretch(double s) const { return one_sided ? std::max(s - rest, 0.0) : s - rest; }
  // N and what of it is elastic.
  double tension(double s, double rate) const {
    if (one_sided && s <= rest) return 0.0;
    const double n = stiffness * (s - rest) + damping * rate;
    return one_sided ? std::max(n, 0.0) : n;
  }
};

class Springs final : public ForceBlock {
 public:
  Springs(const std::vector<Force>& springs, const Deployment& deployment, const std::vector<int>& followed) {
    std::size_t largest = 0;
    for (std::size_t i = 0; i < springs.size(); ++i) {
      const Force& f = springs[i];
      springs_.push_back({MeasureFunction(f.measure, deployment), f.stiffness, f.damping, f.rest, f.one_sided,
                          followed.empty() ? -1 : followed[i]});
      largest = std::max(largest, springs_.back().measure.stencil().size());
      damped_ = damped_ || f.damping > 0;
    }
    size_ = largest;
  }
  bool constant() const override { return false; }
  bool has_power() const override { return damped_; }
  bool dissipative() const override { return true; }

  void add(const Moment& at, const double* q, const double* v, double scale, double* f) const override {
    Gradient g(size_);
    for (const Spring& spring : springs_) {
      const double s = spring.measure.value_and_gradient(q, g.data(), spring.near(at));
      const double rate = spring.damping > 0 ? spring.measure.rate(g.data(), v) : 0.0;
      const double pull = scale * spring.tension(s, rate);
      const auto& stencil = spring.measure.stencil();
      for (std::size_t i = 0; i < stencil.size(); ++i) f[stencil[i]] -= pull * g.data()[i];
    }
  }

  double potential(const Moment& at, const double* q) const override {
    double sum = 0;
    for (const Spring& spring : springs_) {
      const double stretch = spring.stretch(spring.measure.value(q, spring.near(at)));
      sum += 0.5 * spring.stiffness * stretch * stretch;
    }
    return sum;
  }

  double power(const Moment& at, const double* q, const double* v) const override {
    Gradient g(size_);
    double sum = 0;
    for (const Spring& spring : springs_) {
      const double s = spring.measure.value_and_gradient(q, g.data(), spring.near(at));
      const double rate = spring.measure.rate(g.data(), v);
      sum -= (spring.tension(s, rate) - spring.stiffness * spring.stretch(s)) * rate;
    }
    return sum;
  }

  void derivatives(const Moment& at, const double* q, const double* v, ForceDerivative& by_q,
                   ForceDerivative& by_v) const override {
    for (const Spring& spring : springs_) {
      const auto& stencil = spring.measure.stencil();
      const auto size = static_cast<Index>(stencil.size());
      VectorXd g(size), rates(size);
      MatrixXd hess(size, size);
      const double s = spring.measure.value_and_gradient(q, g.data(), spring.near(at));
      for (Index i = 0; i < size; ++i) rates[i] = v[stencil[static_cast<std::size_t>(i)]];
      const double n = spring.tension(s, g.dot(rates));
      if (spring.one_sided && n == 0.0) continue;
      spring.measure.hessian(q, hess.data());
      const MatrixXd k = -n * hess - g * (spring.stiffness * g + spring.damping * (hess * rates)).transpose();
      for (Index j = 0; j < size; ++j)
        for (Index i = 0; i < size; ++i) {
          const int row = stencil[static_cast<std::size_t>(i)], column = stencil[static_cast<std::size_t>(j)];
          by_q.emplace_back(row, column, k(i, j));
          if (spring.damping > 0) by_v.emplace_back(row, column, -spring.damping * g[i] * g[j]);
        }
    }
  }

 private:
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

  std::vector<Spring> springs_;
  std::size_t size_ = 0;
  bool damped_ = false;
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

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double as_built = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::unique_ptr<ForceBlock> spring_block(const std::vector<Force>& springs, const Deployment& deployment,
                                         const std::vector<int>& followed) {
  if (springs.empty()) return nullptr;
  return std::make_unique<Springs>(springs, deployment, followed);
}

std::unique_ptr<ForceBlock> axial_spring_block(const Structure& structure, const SparseRows&) {
  return block_of(structure, "spring");
}

std::unique_ptr<ForceBlock> torsion_spring_block(const Structure& structure, const SparseRows&) {
  return block_of(structure, "torsion_spring");
}

void fill_axial_spring(const ParamSet& values, Force& force) {
  fill_spring(values, values.real("free_length"), force);
  force.one_sided = values.boolean("tension_only");
}

void fill_torsion_spring(const ParamSet& values, Force& force) {
  fill_spring(values, values.real("free_angle") * radians_per_degree, force);
}

const std::vector<ParamSpec>& axial_spring_params() {
  static const std::vector<ParamSpec> params = {
      real_param("stiffness", "N/m", 0.0, 0.0, infinity, "force per metre of stretch"),
      real_param("damping", "N s/m", 0.0, 0.0, infinity, "force per m/s of stretching"),
      real_param("free_length", "m", as_built, 0.0, infinity,
                 "without force; by default the length at t = 0"),
      boolean_param("tension_only", false, "a cable: pulls, never pushes")};
  return params;
}

const std::vector<ParamSpec>& torsion_spring_params() {
  static const std::vector<ParamSpec> params = {
      real_param("stiffness", "N m/rad", 0.0, 0.0, infinity, "torque per radian"),
      real_param("damping", "N m s/rad", 0.0, 0.0, infinity, "torque per rad/s"),
      real_param("free_angle", "deg", as_built, -infinity, infinity,
                 "without torque, any number of turns away; by default the angle at t = 0"),
      vector_param(
          "axis", "", {0, 0, 0},
          "of the hinge: the angle then has a sign and counts any number of turns; none: in [0, 180]")};
  return params;
}

}  // namespace unfurl
