// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/driven_deployed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/integrators/index1.hpp"
#include "core/math/lagrange.hpp"
#include "core/math/saddle_solver.hpp"
#include "core/simulate/deployed_event.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/measured_event.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {
namespace {

// States that a polynomial goes through, on both sides of the pose or before it.
constexpr int around_pose = 8, before_pose = 12;
// Of what remains at a drive's end: nothing but what a method drifts from the drive.
constexpr double nothing_left = 1e-9;
// Interpolated values are taken at once where the last degree changes them by less, of the structure's size.
constexpr double settled_to = 1e-13;
constexpr std::size_t most_back = 100;  // states of the run that nodes are solved from

struct DrivenSample {
  State state;
  VectorXd driven;  // of its rates what drives make of rest
};
using DrivenSamples = std::vector<DrivenSample>;

class DrivenLocator {
 public:
  DrivenLocator(const Trajectory& trajectory, const std::function<std::unique_ptr<Integrator>()>& fresh,
                const DrivenDeployed& where)
      : trajectory_(trajectory),
        model_(trajectory.last_model()),
        integrator_(fresh()),
        system_(model_.system),
        jacobian_(system_.jacobian_pattern()),
        saddle_(system_.mass(), jacobian_),
        where_(where) {
    first_ = trajectory.size() - 1;
    const std::vector<TimeEdge> edges = time_edges(model_.structure, where.h);
    const auto smooth = [&](std::size_t i) {
      const double before = trajectory.time(i - 1), after = trajectory.time(i);
      const auto edge = edge_after(edges, before_jump(before));
      return &trajectory.model(i - 1) == &model_ && !same_instant(before, after) &&
             (edge == edges.end() || edge->t > before + 1e-6 * where_.h);
    };
    while (first_ > 0 && trajectory.size() - first_ < most_back && smooth(first_)) --first_;
  }

  std::optional<State> locate() {
    go_ahead();
    DrivenSamples best;
    double least = std::numeric_limits<double>::infinity();
    State out;
    double apart = where_.h;
    for (const double share : {1.0, 0.5, 0.25, 2.0, 3.0, 4.0, 6.0, 8.0, 0.125}) {
      DrivenSamples samples;
      const std::optional<double> t = around(share * where_.h, samples);
      if (!t) continue;
      State all = at(*t, samples);
      const State lower = at(*t, {samples.begin() + 1, samples.end()});
      const double rough = (all.z - lower.z).lpNorm<Eigen::Infinity>() +
                           where_.h * (all.w - lower.w).lpNorm<Eigen::Infinity>();
      if (rough < least)
        least = rough, out = std::move(all), best = std::move(samples), apart = share * where_.h;
      if (least < settled_to * out.z.lpNorm<Eigen::Infinity>()) break;
    }
    if (best.empty()) return std::nullopt;
    out = polished(std::move(out), best);
    DrivenSamples before;
    finish(out, sample(out.t, apart, false, before) ? before : best);
    return out;
  }

 private:
  double left(const State& state) {
    VectorXd q(model_.system.coordinates());
    model_.system.expand(state.z, q);
    return model_.structure.deployment.remaining(q, state.angles);
  }

  // States of the run to come, as far as its steps get towards the pose.
  void go_ahead() {
    State state = trajectory_.state(trajectory_.size() - 1);
    while (where_.guess - state.t > 1.01 * where_.h) {
      integrator_->restart();
      const StepReport report = integrator_->step(state, where_.h);
      if (!report.ok() || report.weak_end) return;
      ahead_.push_back(state);
    }
  }
  const State& last_before(double t) const {
    for (auto state = ahead_.rbegin(); state != ahead_.rend(); ++state)
      if (state->t < t) return *state;
    std::size_t i = trajectory_.size() - 1;
    while (i > first_ && !(trajectory_.time(i) < t)) --i;
    return trajectory_.state(i);
  }

  // The pose's time by such states, once more where they lay around another.
  std::optional<double> around(double apart, DrivenSamples& samples) {
    std::optional<double> t = where_.guess;
    for (int i = 0; i < 3; ++i) {
      const double guess = *t;
      samples.clear();
      if (!sample(guess, apart, true, samples)) {
        samples.clear();
        if (!sample(guess, apart, false, samples)) return std::nullopt;
      }
      t = time(samples);
      if (!t || std::abs(*t - guess) < 0.05 * apart) break;
    }
    return t;
  }

  // On the constraints to the last digit, of weak directions too.
  bool put_on(DrivenSample& sample) {
    constexpr double near = 1e-3;
    State& state = sample.state;
    system_.follow(state);
    VectorXd q(system_.coordinates()), phi(system_.constraints()), x(state.z.size()), y(phi.size());
    const VectorXd none = VectorXd::Zero(x.size());
    for (int it = 0; it < 2; ++it) {
      system_.expand(state.z, q);
      system_.constraint(state.t, q, phi);
      system_.jacobian(q, jacobian_, scratch_);
      if (!saddle_.factorise(jacobian_)) return false;
      saddle_.solve(none, -phi, x, y);
      if (!(x.norm() <= near * state.z.norm())) return false;
      state.z += x;
    }
    VectorXd rate(phi.size());
    system_.target_rate(state.t, rate);
    const VectorXd p = system_.mass() * state.w;
    saddle_.solve(p, rate, state.w, y);
    sample.driven.resize(x.size());
    saddle_.solve(none, rate, sample.driven, y);
    return state.w.allFinite() && sample.driven.allFinite();
  }

  // States at times `apart`, on both sides of the pose or before it only.
  bool sample(double guess, double apart, bool both, DrivenSamples& out) {
    const int count = both ? around_pose : before_pose;
    const double behind = both ? 0.5 * around_pose - 0.5 : -1.0;
    if (both && guess + behind * apart >= before_jump(where_.edge)) return false;
    if (guess + (behind - count + 1) * apart < trajectory_.time(first_)) return false;
    for (int k = 0; k < count; ++k) {
      const double t = guess + (behind - (count - 1 - k)) * apart;
      const State& last = last_before(t);
      DrivenSample next{out.empty() || out.back().state.t < last.t ? last : out.back().state, {}};
      const double length = t - next.state.t;
      integrator_->restart();
      if (length > 0) {
        const StepReport report = integrator_->step(next.state, length);
        if (!report.ok() || report.weak_end) return false;
      }
      next.state.t = t;
      if (!put_on(next)) return false;
      out.push_back(std::move(next));
    }
    return true;
  }

  static std::vector<double> weights(double t, const DrivenSamples& samples) {
    std::vector<double> out;
    for (std::size_t k = 0; k < samples.size(); ++k)
      out.push_back(lagrange_weight(k, samples.size(), t, [&](std::size_t i) { return samples[i].state.t; }));
    return out;
  }

  bool at_rest(double t) const {
    if (!std::isfinite(t)) return false;
    VectorXd rate(model_.system.constraints());
    model_.system.target_rate(t, rate);
    return rate.lpNorm<Eigen::Infinity>() * where_.h <= nothing_left;
  }

  // Of the pose: the drives' end, where it is there, or the zero nearest to the guess.
  std::optional<double> time(const DrivenSamples& samples) {
    std::vector<double> values;
    for (const DrivenSample& sample : samples) values.push_back(left(sample.state));
    const auto remains = [&](double t) {
      const std::vector<double> share = weights(t, samples);
      double sum = 0;
      for (std::size_t k = 0; k < values.size(); ++k) sum += share[k] * values[k];
      return sum;
    };
    if (samples.back().state.t < where_.edge && at_rest(where_.edge)) {
      State there = at(where_.edge, samples);
      system_.follow(samples.back().state);
      project(system_, there);
      if (std::abs(left(there)) < nothing_left) return where_.edge;
    }
    double low = trajectory_.end_time(), high = std::min(where_.edge, where_.guess + where_.h);
    if (!(remains(low) > 0) || !(remains(high) <= 0)) return std::nullopt;
    for (int i = 0; i < 100 && low < high; ++i) {
      const double middle = low + 0.5 * (high - low);
      if (!(middle > low && middle < high)) break;
      (remains(middle) > 0 ? low : high) = middle;
    }
    return high;
  }

  // Where the drives are at rest, of the rates those that they leave.
  State at(double t, const DrivenSamples& samples) const {
    const std::vector<double> share = weights(t, samples);
    const bool rests = t == where_.edge;
    State out = samples.back().state;
    out.t = t;
    out.z.setZero(), out.w.setZero();
    out.stage_tension.resize(0, 0), out.tension_error.resize(0);
    const bool pull = std::ranges::all_of(
        samples, [&](const DrivenSample& s) { return s.state.tension.size() == out.tension.size(); });
    out.tension.setZero(pull ? out.tension.size() : 0);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      out.z += share[k] * samples[k].state.z;
      out.w += share[k] * samples[k].state.w;
      if (rests) out.w -= share[k] * samples[k].driven;
      if (out.tension.size() > 0) out.tension += share[k] * samples[k].state.tension;
    }
    return out;
  }

  // At the time at which the constraints themselves, and the drives among them, leave nothing.
  State polished(State out, const DrivenSamples& samples) {
    if (out.t == where_.edge) return out;
    for (int i = 0; i < 3; ++i) {
      State on = out;
      system_.follow(samples.back().state);
      project(system_, on);
      const double later = -left(on) / remaining_rate(model_, on);
      if (!(std::abs(later) < where_.h)) break;
      out = at(std::min(out.t + later, before_jump(where_.edge)), samples);
    }
    return out;
  }

  // On the constraints at its time, with multipliers from the poses before it.
  void finish(State& out, const DrivenSamples& samples) {
    system_.follow(samples.back().state);
    system_.count_on(out);
    project(system_, out);
    Index1 index1(system_, true);
    std::vector<NearDeployed> before;
    VectorXd acceleration(out.w.size());
    for (const DrivenSample& sample : samples) {
      if (sample.state.t >= out.t) break;
      State state = sample.state;
      system_.follow(state);
      if (index1.evaluate(state, acceleration, state.lambda))
        before.push_back({left(state), std::move(state)});
    }
    system_.follow(out);
    if (before.size() >= 3) out.lambda = multipliers_at_deployed(index1, std::move(before), out);
  }

  const Trajectory& trajectory_;
  const Model& model_;
  std::unique_ptr<Integrator> integrator_;
  System system_;  // follows each state in turn
  SparseRows jacobian_;
  SaddleSolver saddle_;
  std::vector<double> scratch_;
  DrivenDeployed where_;
  std::vector<State> ahead_;
  std::size_t first_;  // state of the run to go back to
};

}  // namespace

bool drives_lead_to_deployed(const Trajectory& trajectory) {
  constexpr double far = 1e-2, none = 1e-6;  // from the pose; of a rate
  const Model& model = trajectory.last_model();
  const Deployment& deployment = model.structure.deployment;
  if (model.system.drives().empty() || deployment.empty()) return false;
  VectorXd q(model.system.coordinates()), free(q.size());
  std::size_t i = trajectory.size() - 1;
  for (;; --i) {
    model.system.expand(trajectory.state(i).z, q);
    if (i == 0 || &trajectory.model(i - 1) != &model ||
        std::abs(deployment.remaining(q, trajectory.state(i).angles)) > far)
      break;
  }
  const State& state = trajectory.state(i);
  for (Index k = 0; k < free.size(); ++k) free[k] = std::sin(1.0 + static_cast<double>(k));  // any motion
  const System near = model.system.at(state);
  const auto rate = [&](const VectorXd& v) {
    return deployment.folds() ? deployment.fold_rate(q, v) : deployment.remaining_rate(q, v);
  };
  const auto fitted = [&](const VectorXd& v) {
    VectorXd out(q.size());
    near.expand_rate(fitted_rates(near, state.t, q, v), out);
    return rate(out);
  };
  return std::abs(fitted(free) - fitted(VectorXd::Zero(q.size()))) <= none * std::abs(rate(free));
}

std::optional<State> locate_driven(const Trajectory& trajectory,
                                   const std::function<std::unique_ptr<Integrator>()>& fresh,
                                   const DrivenDeployed& where) {
  return DrivenLocator(trajectory, fresh, where).locate();
}

}  // namespace unfurl
