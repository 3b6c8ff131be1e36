// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include "core/integrators/dvm.hpp"
#include "core/integrators/generalized_alpha.hpp"
#include "core/integrators/index1.hpp"
#include "core/integrators/integrator.hpp"
#include "core/integrators/rk4.hpp"
#include "core/integrators/rk4_baumgarte.hpp"
#include "core/integrators/rk4_projected.hpp"

namespace unfurl {

Claims dvm_claims(const SolverOptions& options) {
  Claims claims{.symplectic = true,
                .symmetric = true,
                .implicit = true,
                .holds_positions = true,
                .holds_velocities = true,
                .conserves_momentum_maps = true};
  const int s = options.stages;
  if (options.constraints_at == "ends")
    claims.order = 2;
  else if (options.nodes == "lobatto")
    claims.order = 2 * s - 2;
  else  // a symmetric interpolatory quadrature is exact to degree s - 1, s for odd s; multipliers allow no
        // more
    claims.order = s == 2 ? 2 : s % 2 == 0 ? 4 : std::min(6, s + 1);
  return claims;
}

std::span<const Method> methods() {
  static const std::array rows{
      Method{"dvm",
             "discrete variational (Galerkin) method, constraints held to round-off; symplectic and "
             "symmetric, but "
             "waves of elastic rods with h omega > 100 lose their energy",
             dvm_claims, make_dvm},
      Method{"rk4", "classical Runge-Kutta on the index-1 equations; constraints drift", rk4_claims,
             make_rk4},
      Method{"rk4_baumgarte", "rk4 with constraint errors that decay at the rate `baumgarte`",
             rk4_baumgarte_claims, make_rk4_baumgarte},
      Method{"rk4_projected", "rk4 with positions and velocities projected on the constraints every step",
             rk4_projected_claims, make_rk4_projected},
      Method{"generalized_alpha", "generalized-alpha on the index-3 equations, damped by `rho_inf`",
             generalized_alpha_claims, make_generalized_alpha},
  };
  return rows;
}

namespace {

// Steps of a method on a system of its own, which follows the state that each of them begins with.
class Following final : public Integrator {
 public:
  Following(const Method& method, const System& system, const SolverOptions& options)
      : system_(system), plain_(method.plain(system_, options)) {}
  StepReport step(State& state, double h) override {
    system_.follow(state);
    const StepReport report = plain_->step(state, h);
    if (report.ok()) system_.count_on(state);
    return report;
  }
  double longest_step(const State& state, double h, double whole) override {
    system_.follow(state);
    return plain_->longest_step(state, h, whole);
  }
  bool inside(const State& start, double h, double share, VectorXd& z, VectorXd& w) const override {
    return plain_->inside(start, h, share, z, w);
  }
  void restart() override { plain_->restart(); }
  void expect_contradictions() override { plain_->expect_contradictions(); }
  void stop_waves_of(double h) override { plain_->stop_waves_of(h); }

 private:
  System system_;
  std::unique_ptr<Integrator> plain_;
};

// Without a coordinate to solve for, time goes by and forces change with it: no method does more. What rows
// ask to move does not.
class Still final : public Integrator {
 public:
  explicit Still(const System& system) : system_(system), index1_(system), none_(0) {}
  StepReport step(State& state, double h) override {
    StepReport report;
    VectorXd lambda(system_.constraints()), phi(system_.constraints()), q(system_.coordinates());
    VectorXd before = phi;
    system_.expand(none_, q);
    system_.constraint(state.t, q, before);
    system_.constraint(state.t + h, q, phi);
    constexpr double rounding = 1e-15;
    if (((phi - before).array().abs() > rounding * system_.constraint_lengths().array()).any()) {
      report.status = StepStatus::stalled;
      return report;
    }
    if (!index1_.evaluate(state.t + h, none_, none_, none_, lambda)) {
      report.status = StepStatus::not_finite;
      return report;
    }
    state.t += h;
    state.lambda = lambda;
    if (phi.size() > 0) report.constraint_norm = phi.lpNorm<Eigen::Infinity>();
    return report;
  }
  void restart() override {}

 private:
  const System& system_;
  Index1 index1_;
  VectorXd none_;
};

}  // namespace

std::unique_ptr<Integrator> Method::make(const System& system, const SolverOptions& options) const {
  if (system.solved_coordinates() == 0) return std::make_unique<Still>(system);
  if (system.followed_angles() == 0) return plain(system, options);
  return std::make_unique<Following>(*this, system, options);
}

const Method* find_method(std::string_view name) {
  const auto rows = methods();
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const Method& m) { return m.name == name; });
  return it == rows.end() ? nullptr : &*it;
}

bool order_depends_on_stages(const SolverOptions& options) {
  const Method& method = *find_method(options.method);
  SolverOptions two = options, four = options;
  two.stages = 2, four.stages = 4;
  return method.claims(two).order != method.claims(four).order;
}

}  // namespace unfurl
