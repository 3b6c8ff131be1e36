// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/elastic_period.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/forces/spring.hpp"
#include "core/integrators/integrator.hpp"
#include "core/math/saddle_solver.hpp"
#include "core/simulate/one_sided.hpp"
#include "core/simulate/push_responses.hpp"

namespace unfurl {
namespace {

constexpr int power_steps = 60;
constexpr double settled_share = 1e-3;   // of w^2, from one step to the next
constexpr double followed_share = 0.25;  // of a period: steps up to that follow it

bool has_waves(const Structure& structure) {
  return std::any_of(structure.rods.begin(), structure.rods.end(), [](const Rod& r) { return r.gives; }) ||
         std::any_of(structure.forces.begin(), structure.forces.end(),
                     [](const Force& f) { return f.kind == "bending"; });
}

// Cables are looked at when they begin to pull.
bool has_springs(const Structure& structure) {
  return std::ranges::any_of(structure.forces,
                             [](const Force& f) { return f.stiffness > 0 && !f.one_sided; });
}

// Of a period, the longest step that leaves a swing's phase within 0.05 rad in each, and no less than those
// above: n Gauss points are behind by (h w)^(2 n) n!^2 / ((2 n)! (2 n + 1)!) of the phase (the diagonal Pade
// approximation of exp(i h w)).
double swing_share_of(const SolverOptions& options) {
  if (options.method != "dvm") return followed_share;
  const double n = options.stages - 1.0;
  const double logs = std::lgamma(2 * n + 1) + std::lgamma(2 * n + 2) - 2 * std::lgamma(n + 1);
  return std::max(followed_share, std::exp((std::log(0.05 / (2 * pi)) + logs) / (2 * n)) / (2 * pi));
}

std::string spring_step_warning(double period, const SolverOptions& options) {
  const double followed = period * swing_share_of(options);
  if (!(options.step > followed)) return {};
  std::ostringstream text;
  text.precision(3);
  text
      << "the step of " << options.step << " s does not resolve the fastest swing on springs, " << period
      << " s: where in it the structure is at a time, and what these springs pull with, is not to be "
         "trusted; to follow it, solver.step = "
      << followed
      << "; to let it die out, damping of the spring or solver.method = \"generalized_alpha\" with rho_inf < "
         "1";
  return text.str();
}

}  // namespace

double fastest_elastic_period(const Model& model, const State& state) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  if (!has_waves(model.structure) && !has_springs(model.structure)) return endless;
  const System system = model.system.at(state);
  VectorXd q(system.coordinates());
  system.expand(state.z, q);
  SparseRows by_z, by_w, G = system.jacobian_pattern();
  system.force_derivatives(state.t, q, VectorXd::Zero(q.size()), by_z, by_w);
  std::vector<double> scratch;
  system.jacobian(q, G, scratch);
  SaddleSolver saddle(system.mass(), G);
  if (!saddle.factorise(G)) return endless;
  VectorXd x(system.solved_coordinates()), a(x.size()), y(G.rows());
  for (Index i = 0; i < x.size(); ++i) x[i] = std::sin(1.0 + 2.3 * static_cast<double>(i));
  const VectorXd none = VectorXd::Zero(G.rows());
  double square = 0;
  for (int it = 0; it < power_steps; ++it) {
    saddle.solve(by_z * x, none, a, y);
    // Rayleigh's quotient in the mass metric: from below.
    const double before = square;
    square = std::sqrt(std::max(a.dot(system.mass() * a), 0.0) / x.dot(system.mass() * x));
    if (!(square > 0) || !a.allFinite()) return endless;
    x = a / a.lpNorm<Eigen::Infinity>();
    if (it > 8 && std::abs(square - before) <= settled_share * square) break;
  }
  const double rate = -x.dot(by_w * x) / x.dot(system.mass() * x);
  if (!has_waves(model.structure) && rate > 2 * std::sqrt(square)) return endless;  // it does not swing
  return 2 * pi / std::sqrt(square);
}

std::string elastic_step_warning(const Model& model, const State& start, const SolverOptions& options) {
  const Method* method = find_method(options.method);
  if (!method || method->claims(options).damps) return {};
  const double period = fastest_elastic_period(model, start);
  if (!has_waves(model.structure)) return spring_step_warning(period, options);
  if (!(options.step > followed_share * period)) return {};
  std::ostringstream text;
  text.precision(3);
  text << "the step of " << options.step << " s does not resolve the fastest elastic period, " << period
       << " s: such waves are not followed, and forces at single states are theirs (axial_force_unique "
          "= 0 where by more than 1 %); dvm stops those whose period is less than a sixteenth of the step. "
          "To follow them, solver.step = "
       << followed_share * period
       << (options.step > period && options.stages < 4
               ? "; with fewer than four stages they spoil velocities, and forces of all rods that dvm does "
                 "not stop: solver.stages = 4"
               : "")
       << "; to let them die out, structure.damping_ratio or solver.method = \"generalized_alpha\"; to leave "
          "them out, structure.rod_model = \"quasi-static\"";
  return text.str();
}

namespace {

// The same number of stages in a period, of which more follow it to a higher order: eight by the usual three
// in a step. Fewer stages stand for no shorter steps.
double followed_share_of(const SolverOptions& options) {
  return followed_share * (options.method == "dvm" ? std::max(1.0, 0.5 * (options.stages - 1)) : 1.0);
}

}  // namespace

std::string cable_step_warning(const OneSided& sides, std::size_t i, const System& system, const State& state,
                               const SolverOptions& options) {
  PushResponses responses(system, state);
  if (!responses.ok()) return {};
  responses.add(sides.cable_length(i), 1.0, sides.cable_length(i).reference());
  VectorXd q(system.coordinates());
  system.expand(state.z, q);
  const double k = spring_law(sides.cable(i), state.t, q.data()).stiffness, c = sides.cable(i).damping,
               by_force = responses.matrix()(0, 0), square = k * by_force;
  const double period = 2 * pi / std::sqrt(square);
  const double followed = period * followed_share_of(options);
  if (!(options.step > followed) || c * by_force > 2 * std::sqrt(square)) return {};
  std::ostringstream text;
  text.precision(3);
  text
      << "what " << sides.cable(i).name << " holds swings on it in " << period << " s, which the step of "
      << options.step
      << " s does not resolve: how far it stretches, how long it pulls and what it throws back are not to be "
         "trusted; solver.step = "
      << followed << ", or solver.model = \"auto\" where the structure moves in one way only";
  return text.str();
}

}  // namespace unfurl
