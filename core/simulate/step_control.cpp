// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/step_control.hpp"

#include <algorithm>
#include <cmath>

#include "core/constraints/linear_rows.hpp"
#include "core/structure/prescribed_waves.hpp"

namespace unfurl {
namespace {

// Steps that alternate about what is wanted by more than this factor do so to the end: a start anew.
constexpr double out_of_step = 1.5;

// So many times what swings is sorted by its frequency.
constexpr int rounds = 4;

}  // namespace

StepControl::StepControl(const Structure& structure, const System& system, const SolverOptions& options)
    : structure_(structure),
      system_(system),
      index1_(system_),
      largest_(options.step),
      turn_(options.turn),
      length_(reference_length(structure)),
      bends_(std::ranges::any_of(structure.forces, [](const Force& f) { return f.kind == "bending"; })),
      acceleration_(system.solved_coordinates()),
      lambda_(system.constraints()),
      q_(system.coordinates()),
      v_(system.coordinates()),
      a_(system.coordinates()),
      f_(system.coordinates()),
      moving_(system.moving_mass().array().isFinite().cast<double>()) {}

// What a drive moves now or soon; a stop that holds, friction that sticks and what is held do not.
bool StepControl::driven(double t) const {
  if (!system_.rheonomic()) return false;
  constexpr double soon = 0.01;  // of the largest step: from rest a drive has no rate at once
  VectorXd rate(system_.constraints());
  for (const double when : {t, t + soon * largest_}) {
    system_.target_rate(when, rate);
    if (!rate.isZero(0)) return true;
  }
  return false;
}

// Of the swings in w and h_0 w' (whichever way the energy is) the fastest that is larger than `matters`: with
// x <- M^-1 K x along the constraints each has omega^2 as much of the next x, so that some rounds bring out
// what is light, beside heavy ones that are slower or stretch nothing. omega^2 is |M^-1 K x| over |x| in the
// mass norm, also of what springs drive apart, K of forces that vary with the pose, damped by as much of them
// as varies with rates; rods that give are left to methods that stop their waves, and hold nothing here (x .
// K x over x . M x). The amplitude is max |x_k+1| over omega^(2 k + 3) for x_0 = w, and over omega^(2 k + 4)
// for w'.
StepControl::Swing StepControl::swing(const State& state) {
  constexpr double small = 1e-6;    // of a length, of a rate: rounding leaves 1e-10 of a stretch
  constexpr double matters = 1e-6;  // of a length, an amplitude
  if (system_.constant_forces() || bends_) return {};
  const bool elastic = system_.elastic_rods(), is_driven = driven(state.t);
  const int last = elastic ? (is_driven ? 0 : 1) : rounds;
  const VectorXd still = VectorXd::Zero(elastic ? std::ssize(system_.giving_rods()) : 0);
  const auto add = [&](const VectorXd& q, const VectorXd& v, double scale) {
    if (elastic)
      system_.add_other_force(state.t, q, v, still, scale, f_);
    else
      system_.add_applied_force(state.t, q, v, scale, f_);
  };
  const Index n = state.w.size();
  VectorXd along(q_.size());
  const auto stretched = [&](const VectorXd& x) -> VectorXd {  // K x
    system_.expand_rate(x, along);
    const double size = along.lpNorm<Eigen::Infinity>();
    if (!(size > 0)) return VectorXd::Zero(n);
    const double d = small * length_ / size;
    f_.setZero();
    add(q_ + d * along, v_, -1), add(q_ - d * along, v_, 1);
    VectorXd r(n);
    system_.reduce_force(f_, r);
    return r / (2 * d);
  };
  const auto damping = [&](const VectorXd& x, double omega) {  // x . C x
    system_.expand_rate(x, along);
    const double size = along.lpNorm<Eigen::Infinity>(), d = small * length_ * omega / size;
    if (!(size > 0)) return 0.0;
    f_.setZero();
    add(q_, v_ + d * along, -1), add(q_, v_ - d * along, 1);
    return along.dot(f_) / (2 * d);
  };
  VectorXd of_w = moving_ * state.w.array(), of_a = largest_ * moving_ * acceleration_.array(), next_w(n),
           next_a(n);
  Swing found;
  for (int k = 0; k < last; ++k) {
    const VectorXd r_w = stretched(of_w), r_a = stretched(of_a);
    index1_.accelerate(r_w, next_w), index1_.accelerate(r_a, next_a);
    next_w.array() *= moving_, next_a.array() *= moving_;
    const auto energy = [&](const VectorXd& x) { return 2 * system_.kinetic_energy(x); };
    const auto stiffness = [&](const VectorXd& x, const VectorXd& r, const VectorXd& next) {
      return elastic ? std::abs(x.dot(r)) : std::sqrt(energy(x) * energy(next));
    };
    const double mass_w = energy(of_w), mass = mass_w + energy(of_a);
    const double by_w = stiffness(of_w, r_w, next_w), all = by_w + stiffness(of_a, r_a, next_a);
    if (!(all > 0)) break;
    const double omega = std::sqrt(all / mass), least = matters * length_ * std::pow(omega, 2 * k + 3);
    const bool by_rates = next_w.lpNorm<Eigen::Infinity>() > least;
    const bool moves = by_rates || next_a.lpNorm<Eigen::Infinity>() > largest_ * omega * least;
    if (moves && (k > 0 || !is_driven)) {  // what a drive moves itself swings not
      const auto damped = [](double K, double c, double m) {
        return std::sqrt(std::max(0.0, K / m - std::pow(0.5 * c / m, 2)));
      };
      const double c = damping(of_w, omega);
      found.omega = std::max(found.omega, damped(all, c + damping(of_a, omega), mass));
      if (by_rates) found.of_rates = std::max(found.of_rates, damped(by_w, c, mass_w));
    }
    of_w.swap(next_w), of_a.swap(next_a);
  }
  return found;
}

double StepControl::density(const State& state) {
  system_.follow(state);
  system_.expand(state.z, q_);
  system_.expand_rate(state.w, v_);
  known_ = index1_.evaluate(state, acceleration_, lambda_);
  if (known_)
    system_.expand_rate(acceleration_, a_);
  else
    a_.setZero();
  double omega = 2 * pi / fastest_wave(structure_, state.t).period, change = 0;
  swing_ = {};
  for (const Rod& rod : structure_.rods) {
    const auto of = [&](const VectorXd& x) -> Vec3 {
      return x.segment<3>(3 * rod.b) - x.segment<3>(3 * rod.a);
    };
    const double rate = of(v_).norm() / rod.length;
    const double bend = of(q_).normalized().cross(of(a_)).norm() / rod.length;
    omega = std::max(omega, 0.5 * (rate + std::sqrt(rate * rate + 2 * bend * turn_)));
  }
  if (known_) {
    swing_ = swing(state);
    omega = std::max(omega, swing_.omega);
    const double r0 = turn_ / largest_;
    const double w = std::sqrt(2 * system_.kinetic_energy(state.w));
    const double a = std::sqrt(2 * system_.kinetic_energy(acceleration_));
    if (a > 0) change = a / (w + a / r0);
  }
  const double x = largest_ * (omega + change) / turn_;
  return std::sqrt(1 + x * x);
}

// Of a step that others follow, each as long as the geometric mean of what is wanted at its ends: by where
// the motion leads to second order.
double StepControl::start(const State& state) {
  const double wanted = largest_ / density(state);
  if (!known_) return wanted;
  const VectorXd acceleration = acceleration_;
  double h = wanted;
  for (int round = 0; round < 3; ++round) {
    State to = state;
    to.t += h;
    to.z += h * state.w + 0.5 * h * h * acceleration;
    to.w += h * acceleration;
    h = std::sqrt(wanted * (largest_ / density(to)));
  }
  return h;
}

double StepControl::next(const State& state) {
  const double wanted = largest_ / density(state);
  asked_ = swing_;
  double h = previous_ > 0 ? wanted * wanted / previous_ : 0.0;
  if (!(h <= out_of_step * wanted && wanted <= out_of_step * h)) h = start(state);
  return previous_ = clamped(h);
}

double StepControl::clamped(double h) const {
  return std::clamp(h, smallest_share * largest_, largest_);
}

}  // namespace unfurl
