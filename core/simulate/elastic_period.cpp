// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/elastic_period.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/forces/bending.hpp"
#include "core/forces/spring.hpp"
#include "core/integrators/index1.hpp"
#include "core/integrators/integrator.hpp"
#include "core/math/factors.hpp"
#include "core/math/saddle_solver.hpp"
#include "core/simulate/one_sided.hpp"
#include "core/simulate/push_responses.hpp"
#include "core/simulate/step_control.hpp"
#include "core/structure/prescribed_waves.hpp"

namespace unfurl {
namespace {

constexpr int most_directions = 60;
constexpr double settled_share = 1e-3;   // of w^2, what is left of the fastest one's equation
constexpr double known_share = 0.05;     // the same of the others that count
constexpr double followed_share = 0.25;  // of a period: steps up to that follow it

// In the three digits that are said of it, and no longer than it is: who takes that step is not warned again.
double rounded_down(double step) {
  const double unit = std::pow(10.0, std::floor(std::log10(step)) - 2);
  return std::floor(step / unit) * unit;
}

bool bends(const Structure& structure) {
  return std::ranges::any_of(structure.forces, [](const Force& f) { return f.kind == "bending"; });
}

bool has_waves(const Structure& structure) {
  return std::ranges::any_of(structure.rods, [](const Rod& r) { return r.gives; }) || bends(structure);
}

// Those that are slack at a pose have no stiffness there.
bool has_springs(const Structure& structure) {
  return std::ranges::any_of(structure.forces, [](const Force& f) {
    return f.kind != "bending" && (f.stiffness > 0 || f.axial_stiffness > 0);
  });
}

}  // namespace

// Of a period, the longest step that leaves a swing's phase within 0.05 rad in each, and no less than those
// above: n Gauss points are behind by (h w)^(2 n) n!^2 / ((2 n)! (2 n + 1)!) of the phase (the diagonal Pade
// approximation of exp(i h w)).
double swing_share_of(const SolverOptions& options) {
  if (options.method != "dvm") return followed_share;
  const double n = options.stages - 1.0;
  const double logs = std::lgamma(2 * n + 1) + std::lgamma(2 * n + 2) - 2 * std::lgamma(n + 1);
  return std::max(followed_share, std::exp((std::log(0.05 / (2 * pi)) + logs) / (2 * n)) / (2 * pi));
}

namespace {

std::string spring_step_warning(double period, const SolverOptions& options) {
  const double followed = period * swing_share_of(options);
  if (!(options.step > followed)) return {};
  std::ostringstream text;
  text.precision(3);
  text
      << "the step of " << options.step << " s does not resolve the fastest swing on springs, " << period
      << " s: where in it the structure is at a time, and what these springs pull with, is not to be "
         "trusted; to follow it, solver.step = "
      << rounded_down(followed)
      << "; to let it die out, damping of the spring or solver.method = \"generalized_alpha\" with rho_inf < "
         "1";
  return text.str();
}

struct FastestPeriods {
  double of_rods = std::numeric_limits<double>::infinity(), on_springs = of_rods;  // [s]
};

// Small motions about a pose at rest, M x'' + C x' + K x + G^T y = 0, G x = 0, K with what the rows' forces
// lambda . Phi'' make of it: of what turns freely under pretension the two cancel. A mode of w^2 = k that is
// damped by c swings where k > c^2 / 4: the largest eigenvalues of K - C M^-1 C / 4 are those of modes that
// do, whatever is stiffer and does not. Without damping this is K, as it is where rods that give are all
// there is: which of their waves a step does not follow matters though they die out.
class SmallMotions {
 public:
  SmallMotions(const Model& model, const State& state)
      : structure_(model.structure),
        system_(model.system.at(state)),
        t_(state.t),
        q_(system_.coordinates()),
        G_(system_.jacobian_pattern()) {
    system_.expand(state.z, q_);
    std::vector<double> scratch;
    system_.jacobian(q_, G_, scratch);
    const VectorXd still = VectorXd::Zero(q_.size());
    system_.force_derivatives(t_, q_, still, by_z_, by_w_);
    add_rows(state);
    if (!has_waves(structure_)) return;
    const VectorXd no_tension = VectorXd::Zero(std::ssize(system_.giving_rods()));
    system_.force_derivatives(t_, q_, still, no_tension, without_rods_, by_w_);
    const auto bending = bending_block(structure_, system_.node_mass());
    ForceDerivative by_v;
    if (bending) bending->derivatives(t_, q_.data(), still.data(), bending_, by_v);
    if (!has_springs(structure_)) by_w_.setZero();
  }

  FastestPeriods fastest() const {
    SaddleSolver saddle(system_.mass(), G_);
    if (!saddle.factorise(G_)) return {};
    const Index most = std::min<Index>(most_directions, system_.solved_coordinates());
    MatrixXd V(system_.solved_coordinates(), most), H = MatrixXd::Zero(most, most);
    VectorXd x(V.rows()), y(G_.rows());
    const VectorXd none = VectorXd::Zero(G_.rows());
    const auto answer = [&](const VectorXd& force) {
      saddle.solve(force, none, x, y);
      return x;
    };
    for (Index i = 0; i < x.size(); ++i) x[i] = std::sin(1.0 + 2.3 * static_cast<double>(i));
    VectorXd next = answer(system_.mass() * VectorXd(x));
    // Lanczos in the mass metric, each direction kept clear of all before it.
    for (Index m = 0; m < most; ++m) {
      const double norm = std::sqrt(next.dot(system_.mass() * next));
      if (!(norm > 0)) return {};
      V.col(m) = next / norm;
      next = -answer(pull(V.col(m)));
      if (by_w_.norm() > 0) next -= 0.25 * answer(by_w_ * answer(by_w_ * V.col(m)));
      if (!next.allFinite()) return {};
      const double size = std::sqrt(next.dot(system_.mass() * next));
      for (int again = 0; again < 2; ++again) {
        const VectorXd parts = V.leftCols(m + 1).transpose() * (system_.mass() * next);
        H.col(m).head(m + 1) += parts;
        next -= V.leftCols(m + 1) * parts;
      }
      const double left = std::sqrt(next.dot(system_.mass() * next));
      const bool whole = !(left > settled_share * settled_share * size) || m + 1 == most;
      if (!whole && (m < 8 || m % 4 > 0)) continue;
      const SymmetricEigen ritz =
          symmetric_eigen(H.topLeftCorner(m + 1, m + 1).transpose());  // the lower triangle
      const auto known = [&](Index i, double share) {
        return ritz.values[i] > 0 &&
               (m + 1 == V.rows() || left * std::abs(ritz.vectors(m, i)) <= share * ritz.values[i]);
      };
      if (!whole && (has_waves(structure_) || !known(m, settled_share))) continue;
      FastestPeriods found;
      for (Index i = 0; i <= m; ++i)
        if (known(i, known_share) || i == m) note(V.leftCols(m + 1) * ritz.vectors.col(i), found);
      return found;
    }
    return {};
  }

 private:
  void add_rows(const State& state) {
    rows_.resize(by_z_.rows(), by_z_.cols());
    if (!has_springs(structure_)) return;
    VectorXd acceleration(by_z_.rows()), lambda(G_.rows());
    if (Index1(system_).evaluate_at_rest(state, acceleration, lambda)) rows_ = system_.curvature(q_, lambda);
  }
  VectorXd pull(const VectorXd& x) const { return by_z_ * x - rows_ * x; }

  // Of a mode with |x| = 1 in the mass metric.
  void note(const VectorXd& x, FastestPeriods& found) const {
    const double square = -x.dot(pull(x)), rate = -x.dot(by_w_ * x);
    if (!(square > 0) || rate > 2 * std::sqrt(square)) return;
    double& period = of_rods(x) > 0.5 * square ? found.of_rods : found.on_springs;
    period = std::min(period, 2 * pi / std::sqrt(square));
  }

  // What of x . K x is of rods that give.
  double of_rods(const VectorXd& x) const {
    if (!has_waves(structure_)) return 0;
    if (!has_springs(structure_)) return std::numeric_limits<double>::infinity();
    double sum = x.dot(without_rods_ * x) - x.dot(by_z_ * x);
    VectorXd v(q_.size());
    system_.expand_rate(x, v);
    for (const auto& entry : bending_) sum -= v[entry.row()] * entry.value() * v[entry.col()];
    return sum;
  }

  const Structure& structure_;
  System system_;
  double t_;
  VectorXd q_;
  SparseRows G_, by_z_, by_w_, rows_, without_rods_;
  ForceDerivative bending_;
};

FastestPeriods fastest_periods(const Model& model, const State& state) {
  if (!has_waves(model.structure) && !has_springs(model.structure)) return {};
  return SmallMotions(model, state).fastest();
}

// Do steps of turn / swing resolve the fastest one?
bool is_followed(double period, const Model& model, const State& start, const SolverOptions& options,
                 double swing) {
  if (!options.adaptive || bends(model.structure) || !std::isfinite(period)) return false;
  StepControl control(model.structure, model.system, options);
  control.next(start);
  return swing >= 0 &&
         options.turn <= period * swing_share_of(options) * std::max(swing, control.swing().omega);
}

}  // namespace

double fastest_elastic_period(const Model& model, const State& state) {
  const FastestPeriods periods = fastest_periods(model, state);
  return std::min(periods.of_rods, periods.on_springs);
}

std::string elastic_step_warning(const Model& model, const State& start, const SolverOptions& options,
                                 double swing) {
  const Method* method = find_method(options.method);
  if (!method || method->claims(options).damps) return {};
  const FastestPeriods periods = fastest_periods(model, start);
  const double period = periods.of_rods;
  const bool followed = is_followed(periods.on_springs, model, start, options, swing);
  const std::string springs = followed ? "" : spring_step_warning(periods.on_springs, options);
  if (!(options.step > followed_share * period)) return springs;
  std::ostringstream text;
  text.precision(3);
  text << "the step of " << options.step << " s does not resolve the fastest elastic period, " << period
       << " s: such waves are not followed, and forces at single states are theirs (axial_force_unique "
          "= 0 where by more than 1 %); dvm stops those whose period is less than a sixteenth of the step. "
          "To follow them, solver.step = "
       << rounded_down(followed_share * period)
       << (options.step > period && options.stages < 4
               ? "; with fewer than four stages they spoil velocities, and forces of all rods that dvm does "
                 "not stop: solver.stages = 4"
               : "")
       << "; to let them die out, structure.damping_ratio or solver.method = \"generalized_alpha\"; to leave "
          "them out, structure.rod_model = \"quasi-static\""
       << (model.structure.kind == "custom" ? ", with elastic = true of no rod" : "");
  if (!springs.empty()) text << "; " << springs;
  return text.str();
}

std::string wave_step_warning(const Structure& structure, const SolverOptions& options, bool exact) {
  constexpr double seen_share = 0.5;  // of a period: with fewer states a motion to and fro looks like none
  const PrescribedWave wave = fastest_wave(structure, options.end_time);
  const double solved = wave.period * swing_share_of(options),
               followed = exact ? wave.period * followed_share : std::min(solved, wave.period * seen_share),
               by_turn = std::max(options.turn * wave.period / (2 * pi),
                                  StepControl::smallest_share * options.step),
               longest = options.adaptive && !exact ? std::min(options.step, by_turn) : options.step;
  if (!(longest > followed)) return {};
  std::ostringstream text;
  text.precision(3);
  text << "the step of " << options.step << " s does not resolve the sine of " << wave.name << ", "
       << wave.period << " s a wave: "
       << (exact || !(longest > solved)
               ? "what it does between states is not seen, and peaks are not to be trusted"
               : "motions and forces are not to be trusted")
       << "; to follow it, solver.step = " << rounded_down(followed);
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
      << rounded_down(followed) << ", or solver.model = \"auto\" where the structure moves in one way only";
  return text.str();
}

}  // namespace unfurl
