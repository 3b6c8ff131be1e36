// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/latch_spring.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/forces/spring.hpp"
#include "core/structure/measure.hpp"

namespace unfurl {
namespace {

class LatchSprings final : public ForceBlock {
 public:
  explicit LatchSprings(const std::vector<Force>& latches) {
    for (const Force& f : latches) {
      std::map<int, double> gradient;
      for (std::size_t i = 0; i < f.form.nodes.size(); ++i)
        for (int k = 0; k < 3; ++k) gradient[3 * f.form.nodes[i] + k] += f.form.coefficients[i][k];
      Latch latch{f.stiffness, f.damping, f.form.offset, {}, {}};
      for (const auto& [coordinate, c] : gradient) {
        if (c == 0.0) continue;
        latch.stencil.push_back(coordinate);
        latch.gradient.push_back(c);
      }
      latches_.push_back(std::move(latch));
      damped_ = damped_ || f.damping > 0;
    }
  }
  bool constant() const override { return false; }
  bool has_power() const override { return damped_; }
  bool dissipative() const override { return true; }

  void add(const Moment&, const double* q, const double* v, double scale, double* f) const override {
    for (const Latch& latch : latches_) {
      const double pull = scale * (latch.k * latch.value(q) + latch.c * latch.along(v));
      for (std::size_t i = 0; i < latch.stencil.size(); ++i) f[latch.stencil[i]] -= pull * latch.gradient[i];
    }
  }

  double potential(const Moment&, const double* q) const override {
    double sum = 0;
    for (const Latch& latch : latches_) sum += 0.5 * latch.k * latch.value(q) * latch.value(q);
    return sum;
  }

  double power(const Moment&, const double*, const double* v) const override {
    double sum = 0;
    for (const Latch& latch : latches_) sum -= latch.c * latch.along(v) * latch.along(v);
    return sum;
  }

  void derivatives(const Moment&, const double*, const double*, ForceDerivative& by_q,
                   ForceDerivative& by_v) const override {
    for (const Latch& latch : latches_)
      for (std::size_t i = 0; i < latch.stencil.size(); ++i)
        for (std::size_t j = 0; j < latch.stencil.size(); ++j) {
          const double g = latch.gradient[i] * latch.gradient[j];
          by_q.emplace_back(latch.stencil[i], latch.stencil[j], -latch.k * g);
          if (latch.c > 0) by_v.emplace_back(latch.stencil[i], latch.stencil[j], -latch.c * g);
        }
  }

 private:
  struct Latch {
    double k, c, offset;
    std::vector<int> stencil;
    std::vector<double> gradient;

    double along(const double* x) const {
      double sum = 0;
      for (std::size_t i = 0; i < stencil.size(); ++i) sum += gradient[i] * x[stencil[i]];
      return sum;
    }
    double value(const double* q) const { return offset + along(q); }
  };

  std::vector<Latch> latches_;
  bool damped_ = false;
};

}  // namespace

std::unique_ptr<ForceBlock> latch_spring_block(const Structure& structure, const SparseRows&) {
  std::vector<Force> latches, measured;
  std::vector<int> followed;
  const std::vector<int> of_force = followed_angles(structure).of_force;
  for (std::size_t i = 0; i < structure.forces.size(); ++i) {
    const Force& force = structure.forces[i];
    if (force.kind != "latch" || latch_waits(force)) continue;
    if (!force.form.empty()) {
      latches.push_back(force);
    } else {
      measured.push_back(force);
      followed.push_back(of_force[i]);
    }
  }
  if (latches.empty()) return spring_block(measured, structure.deployment, followed);
  return std::make_unique<LatchSprings>(latches);
}

const std::vector<ParamSpec>& latch_spring_params() {
  constexpr double endless = std::numeric_limits<double>::infinity();
  static const std::vector<ParamSpec> params = {
      positive_param("stiffness", "", 1.0,
                     "in N m/rad where a latch holds the fold angle, in N/m where it holds a distance"),
      real_param("damping", "", 0.0, 0.0, endless, "in N s/m or N m s/rad")};
  return params;
}

void fill_latch_spring(const ParamSet& values, Force& force) {
  force.stiffness = values.real("stiffness");
  force.damping = values.real("damping");
}

bool latch_waits(const Force& force) {
  const bool measured = !force.measure.nodes.empty() || !force.measure.terms.empty();
  return force.kind == "latch" && force.form.empty() && (force.slack || !measured);
}

double latch_load(const Structure& structure, const Moment& at, const VectorXd& q, const VectorXd& v) {
  double most = 0;
  std::vector<double> gradient;
  for (std::size_t i = 0; i < structure.forces.size(); ++i) {
    const Force& latch = structure.forces[i];
    if (latch.kind != "latch" || latch_waits(latch)) continue;
    double s = latch.form(q), rate = latch.form.rate(v);
    if (latch.form.empty()) {
      const MeasureFunction measure(latch.measure, structure.deployment);
      gradient.resize(measure.stencil().size());
      s = measure.value_and_gradient(q.data(), gradient.data(), at, followed_angles(structure).of_force[i]) -
          latch.rest;
      rate = measure.rate(gradient.data(), v.data());
    }
    most = std::max(most, std::abs(latch.stiffness * s + latch.damping * rate));
  }
  return most;
}

}  // namespace unfurl
