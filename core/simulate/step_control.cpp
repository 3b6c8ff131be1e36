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
      moving_mass_(system.moving_mass()) {}

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

// w . K w over w . M w for x = w or h_0 w', whichever way the energy is, of forces that vary with the pose,
// damped by as much of them as varies with rates; rods that give are left to methods that stop their waves.
// Nothing where a swing is too small to matter: with r = K x its frequency is (r . M^-1 r / x . r)^1/2, and
// its amplitude max |r_i| / m_i over the third power of that for x = w, over the fourth for x = w'.
StepControl::Swing StepControl::swing(const State& state) {
  constexpr double small = 1e-6;    // of a length, of a rate: rounding leaves 1e-10 of a stretch
  constexpr double matters = 1e-6;  // of a length, an amplitude
  if (system_.constant_forces() || bends_ || driven(state.t)) return {};  // what is driven swings not
  const VectorXd still = VectorXd::Zero(system_.elastic_rods() ? std::ssize(system_.giving_rods()) : 0);
  const auto add = [&](const VectorXd& q, const VectorXd& v, double scale) {
    if (system_.elastic_rods())
      system_.add_other_force(state.t, q, v, still, scale, f_);
    else
      system_.add_applied_force(state.t, q, v, scale, f_);
  };
  double stiffness = 0, damping = 0, mass = 0, square_of_force = 0, most[2] = {};
  const auto frequency = [&] {
    const double square = stiffness / mass - std::pow(0.5 * damping / mass, 2);
    return square > 0 ? std::sqrt(square) : 0.0;
  };
  VectorXd r(state.w.size());
  const auto look_along = [&](const VectorXd& x, const VectorXd& w, double weight, double& largest) {
    const double size = x.lpNorm<Eigen::Infinity>();
    if (!(size > 0)) return;
    const double d = small * length_ / size;
    f_.setZero();
    add(q_ + d * x, v_, -1), add(q_ - d * x, v_, 1);
    stiffness += weight * x.dot(f_) / (2 * d);
    system_.reduce_force(f_, r);
    const VectorXd a = (r.array() / moving_mass_.array()) / (2 * d);
    square_of_force += weight * r.dot(a) / (2 * d);
    largest = a.lpNorm<Eigen::Infinity>();
    f_.setZero();
    add(q_, v_ + x, -1), add(q_, v_ - x, 1);
    damping += weight * x.dot(f_) / 2;
    mass += weight * 2 * system_.kinetic_energy(w);
  };
  look_along(v_, state.w, 1, most[0]);
  const double of_rates = frequency();
  look_along(a_, acceleration_, largest_ * largest_, most[1]);
  if (!(stiffness > 0)) return {};
  const double omega = std::sqrt(square_of_force / stiffness);
  const double least = matters * length_ * omega * omega * omega;
  if (!(std::max(most[0], most[1] / omega) > least)) return {};
  return {frequency(), most[0] > least ? of_rates : 0.0};
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
