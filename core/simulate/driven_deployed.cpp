// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/driven_deployed.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "core/integrators/index1.hpp"
#include "core/math/coupled_columns.hpp"
#include "core/math/lagrange.hpp"
#include "core/math/saddle_solver.hpp"
#include "core/simulate/deployed_event.hpp"
#include "core/simulate/driven_parts.hpp"
#include "core/simulate/free_motion.hpp"
#include "core/simulate/held_nodes.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/led_forces.hpp"
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
constexpr double clear_of_pose = 1e-3;  // of what remains

struct DrivenSample : State {
  VectorXd driven = {};  // of its rates what drives make of rest
};
using DrivenStates = std::vector<DrivenSample>;

class DrivenLocator {
 public:
  DrivenLocator(const Trajectory& trajectory, const std::function<std::unique_ptr<Integrator>()>& fresh,
                double guess, double h)
      : trajectory_(trajectory),
        model_(trajectory.last_model()),
        integrator_(fresh()),
        system_(model_.system),
        jacobian_(system_.jacobian_pattern()),
        saddle_(system_.mass(), jacobian_),
        parts_(driven_parts(trajectory)),
        free_(system_, parts_.free),
        guess_(guess),
        h_(h) {
    first_ = trajectory.size() - 1;
    const std::vector<TimeEdge> all = time_edges(model_.structure, h),
                                edges = parts_.led ? prescribed_edges(model_.structure, h) : all;
    const auto next = edge_after(edges, trajectory.end_time());
    edge_ = next == edges.end() ? std::numeric_limits<double>::infinity() : next->t;
    const auto smooth = [&](std::size_t i) {
      const double before = trajectory.time(i - 1), after = trajectory.time(i);
      const auto edge = edge_after(edges, before_jump(before));
      return (parts_.led || (&trajectory.model(i - 1) == &model_ && !same_instant(before, after))) &&
             (edge == edges.end() || edge->t > before + 1e-6 * h);
    };
    while (first_ > 0 && trajectory.size() - first_ < most_back && smooth(first_)) --first_;
    for (std::size_t i = first_ + 1; i < trajectory.size(); ++i)
      if (same_instant(trajectory.time(i - 1), trajectory.time(i))) struck_ = i;
    switched_ = &trajectory.model(first_) != &model_;
    for (const TimeEdge& edge : all) edges_.push_back(edge.t);
    find_resting();
  }

  std::optional<DrivenDeployed> locate() {
    go_ahead();
    VectorXd led = VectorXd::Ones(system_.solved_coordinates());
    led(free_.coordinates()).setZero();
    Tried& best = best_;
    for (const double share : {1.0, 0.5, 0.25, 2.0, 3.0, 4.0, 6.0, 8.0, 0.125}) {
      Tried next{.apart = share * h_};
      const std::optional<double> t = around(next.apart, next.samples);
      if (!t) continue;
      next.t = *t;
      next.rough = rough(*t, next.samples, led);
      const double size = next.samples.back().z.lpNorm<Eigen::Infinity>();
      if (next.rough < best.rough) best = next;
      tried_.push_back(std::move(next));
      if (best.rough < settled_to * size) break;
    }
    if (best.samples.empty()) return std::nullopt;
    DrivenDeployed out{polished(at(best.t, best.samples), best.samples), best.rough};
    out.error = std::max(out.error, move_free(out.state, best.samples));
    if (out.state.t == edge_ && parts_.led) {
      rests_(free_.coordinates()).setZero();
      if (comes_to_rest(system_, rests_, 0.5 * (best_.samples.front().t + edge_), h_))
        out.held = nodes_at_rest(model_, rests_, edge_, h_);
    }
    DrivenStates before;
    finish(out.state, sample(out.state.t, best.apart, false, before) ? before : best.samples);
    return out;
  }

  double edge() const { return edge_; }
  // On the way to the pose that was found.
  State before(double t) {
    State out = at(t, best_.samples);
    move_free(out, best_.samples);
    return out;
  }

 private:
  struct Tried {
    double apart = 0, t = 0, rough = std::numeric_limits<double>::infinity();
    DrivenStates samples{};
  };

  void find_resting() {
    rests_ = std::isfinite(edge_) ? resting_coordinates(system_, edge_, h_)
                                  : VectorXd::Zero(system_.solved_coordinates());
    pose_rests_ =
        std::isfinite(edge_) && !LeftRate(trajectory_).takes(VectorXd::Ones(rests_.size()) - rests_);
  }

  // How far some coordinates depend on the highest degree.
  double rough(double t, const DrivenStates& samples, const VectorXd& of) {
    const State all = at(t, samples), lower = at(t, {samples.begin() + 1, samples.end()});
    return (all.z - lower.z).cwiseProduct(of).lpNorm<Eigen::Infinity>() +
           h_ * (all.w - lower.w).cwiseProduct(of).lpNorm<Eigen::Infinity>();
  }

  // What is free goes its own way from a state that is clear of the pose; where it is too stiff for that, as
  // polynomials have it. Returns how far it may be off.
  double move_free(State& out, const DrivenStates& samples) {
    const std::vector<Index>& free = free_.coordinates();
    if (std::ranges::any_of(samples, [](const State& s) { return s.tension.size() > 0; })) pull(out, samples);
    if (free.empty()) return 0;
    std::size_t from = 0;
    for (std::size_t i = 1; i < samples.size() && samples[i].t < out.t; ++i)
      if (std::abs(left(samples[i])) > clear_of_pose) from = i;
    State state = samples[from];
    if (State run = last_before(state.t); switched_ && run.t >= samples.front().t) state = std::move(run);
    if (struck_ > 0 && trajectory_.time(struck_) > state.t) state = trajectory_.state(struck_);
    if (state.tension.size() == 0) {
      system_.follow(state);
      const double error =
          free_.move(state, out.t, edges_, [&](double t, State& led, VectorXd& acceleration) {
            led = at(t, samples);
            acceleration = acceleration_at(t, samples);
          });
      if (std::isfinite(error)) {
        out.z(free) = state.z(free);
        out.w(free) = state.w(free);
        return error;
      }
    }
    pull(out, samples);
    VectorXd of = VectorXd::Zero(out.z.size());
    of(free).setOnes();
    double least = std::numeric_limits<double>::infinity();
    for (const Tried& tried : tried_) {
      const double error = rough(out.t, tried.samples, of);
      if (!(error < least)) continue;
      least = error;
      const State there = at(out.t, tried.samples);
      out.z(free) = there.z(free);
      out.w(free) = there.w(free);
    }
    return least;
  }

  double left(const State& state) {
    VectorXd q(model_.system.coordinates());
    model_.system.expand(state.z, q);
    return model_.structure.deployment.remaining(q, state.angles);
  }

  // States of the run to come, as far as its steps get towards the pose.
  void go_ahead() {
    State state = trajectory_.state(trajectory_.size() - 1);
    while (guess_ - state.t > 1.01 * h_) {
      if (!step_to(state, state.t + h_)) return;
      ahead_.push_back(state);
    }
  }
  // No step leads over an edge of time.
  bool step_to(State& state, double t) {
    while (t > state.t) {
      const auto edge = std::upper_bound(edges_.begin(), edges_.end(), state.t);
      const bool ends = edge != edges_.end() && *edge < t;
      const double end = ends ? *edge : t, length = (ends ? before_jump(end) : end) - state.t;
      if (length > 0) {
        integrator_->restart();
        const StepReport report = integrator_->step(state, length);
        if (!report.ok() || report.weak_end) return false;
      }
      state.t = end;
    }
    return true;
  }
  State last_before(double t) const {
    for (auto state = ahead_.rbegin(); state != ahead_.rend(); ++state)
      if (state->t < t) return *state;
    std::size_t i = trajectory_.size() - 1;
    while (i > first_ && !(trajectory_.time(i) < t)) --i;
    return in_last_model(trajectory_, i);
  }

  // The pose's time by such states, once more where they lay around another.
  std::optional<double> around(double apart, DrivenStates& samples) {
    std::optional<double> t = guess_;
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
  bool put_on(DrivenSample& state) {
    constexpr double near = 1e-3;
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
    state.driven.resize(x.size());
    saddle_.solve(none, rate, state.driven, y);
    return state.w.allFinite() && state.driven.allFinite();
  }

  // States at times `apart`, on both sides of the pose or before it only.
  bool sample(double guess, double apart, bool both, DrivenStates& out) {
    const int count = both ? around_pose : before_pose;
    const double behind = both ? 0.5 * around_pose - 0.5 : -1.0;
    if (both && guess + behind * apart >= before_jump(edge_)) return false;
    if (guess + (behind - count + 1) * apart < trajectory_.time(first_)) return false;
    for (int k = 0; k < count; ++k) {
      const double t = guess + (behind - (count - 1 - k)) * apart;
      const State last = last_before(t);
      DrivenSample next{out.empty() || out.back().t < last.t ? last : State(out.back())};
      if (!step_to(next, t) || !put_on(next)) return false;
      out.push_back(std::move(next));
    }
    return true;
  }

  static std::vector<double> weights(double t, const DrivenStates& samples) {
    std::vector<double> out;
    for (std::size_t k = 0; k < samples.size(); ++k)
      out.push_back(lagrange_weight(k, samples.size(), t, [&](std::size_t i) { return samples[i].t; }));
    return out;
  }
  // The slope of the polynomial through their rates.
  static VectorXd acceleration_at(double t, const DrivenStates& samples) {
    VectorXd out = VectorXd::Zero(samples.front().w.size());
    const auto time = [&](std::size_t i) { return samples[i].t; };
    for (std::size_t k = 0; k < samples.size(); ++k)
      out += lagrange_slope(k, samples.size(), t, time) * samples[k].w;
    return out;
  }

  // Of the pose: the drives' end, where it is there, or the zero nearest to the guess.
  std::optional<double> time(const DrivenStates& samples) {
    std::vector<double> values;
    for (const State& sample : samples) values.push_back(left(sample));
    const auto remains = [&](double t) {
      return std::inner_product(values.begin(), values.end(), weights(t, samples).begin(), 0.0);
    };
    if (samples.back().t < edge_ && pose_rests_) {
      // On the constraints, or, where rounding has what is left move in a weak mode, as the samples have it.
      State there = at(edge_, samples);
      system_.follow(samples.back());
      project(system_, there);
      if (std::min(std::abs(left(there)), std::abs(remains(edge_))) < nothing_left) return edge_;
    }
    double low = trajectory_.end_time(), high = std::min(edge_, guess_ + h_);
    if (!(remains(low) > 0) || !(remains(high) <= 0)) return std::nullopt;
    for (int i = 0; i < 100 && low < high; ++i) {
      const double middle = low + 0.5 * (high - low);
      if (!(middle > low && middle < high)) break;
      (remains(middle) > 0 ? low : high) = middle;
    }
    return high;
  }

  State at(double t, const DrivenStates& samples) const {
    const std::vector<double> share = weights(t, samples);
    State out = samples.back();
    out.t = t;
    out.z.setZero(), out.w.setZero();
    out.stage_tension.resize(0, 0), out.tension.resize(0), out.tension_error.resize(0);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      out.z += share[k] * samples[k].z;
      out.w += share[k] * samples[k].w;
      if (t == edge_) out.w -= share[k] * samples[k].driven.cwiseProduct(rests_);
    }
    return out;
  }

  // At the time at which the constraints themselves, and the drives among them, leave nothing.
  State polished(State out, const DrivenStates& samples) {
    if (out.t == edge_) return out;
    for (int i = 0; i < 3; ++i) {
      State on = out;
      system_.follow(samples.back());
      project(system_, on);
      const double later = -left(on) / remaining_rate(model_, on);
      if (!(std::abs(later) < h_)) break;
      out = at(std::min(out.t + later, before_jump(edge_)), samples);
    }
    return out;
  }

  // What rods that give pull with there.
  void pull(State& out, const DrivenStates& samples) const {
    std::vector<NearDeployed> near;
    for (const State& sample : samples) near.push_back({out.t - sample.t, sample});
    tension_at_zero(system_, near, out);
  }

  // On the constraints at its time, with multipliers from poses before it: functions of time where the pose
  // is at rest, as accelerations are, which go with its cube root then.
  void finish(State& out, const DrivenStates& samples) {
    system_.follow(samples.back());
    system_.count_on(out);
    project(system_, out);
    Index1 index1(system_, true);
    std::vector<NearDeployed> before;
    VectorXd acceleration(out.w.size());
    const bool rests = out.t == edge_;
    for (const State& sample : samples) {
      if (sample.t >= out.t) break;
      State state = sample;
      system_.follow(state);
      if (index1.evaluate(state, acceleration, state.lambda))
        before.push_back({rests ? out.t - state.t : left(state), std::move(state)});
    }
    if (parts_.led) feel_as_at(system_, free_, index1, out, acceleration_at(out.t, samples), before);
    system_.follow(out);
    if (before.size() >= 3)
      out.lambda = multipliers_at_deployed(index1, std::move(before), out, rests ? 3 : 1);
  }

  const Trajectory& trajectory_;
  const Model& model_;
  std::unique_ptr<Integrator> integrator_;
  System system_;  // follows each state in turn
  SparseRows jacobian_;
  SaddleSolver saddle_;
  std::vector<double> scratch_;
  DrivenParts parts_;
  FreeMotion free_;
  double guess_, h_;
  double edge_;                // the next time at which what is interpolated is not smooth
  std::vector<double> edges_;  // those of all that acts
  VectorXd rests_;             // 1 of coordinates whose drives are at rest at the edge
  bool pose_rests_ = false;    // so are all that lead there
  Tried best_;
  std::vector<Tried> tried_;
  std::vector<State> ahead_;
  std::size_t first_;       // state of the run to go back to
  bool switched_ = false;   // what is free was another one's, in states since then, which samples go on from
  std::size_t struck_ = 0;  // the one behind the last impact since, which what drives lead does not feel
};

}  // namespace

double next_prescribed_edge(const Trajectory& trajectory) {
  const std::vector<TimeEdge> edges =
      prescribed_edges(trajectory.last_model().structure, trajectory.options().step);
  const auto edge = edge_after(edges, trajectory.end_time());
  return edge == edges.end() ? std::numeric_limits<double>::infinity() : edge->t;
}

std::optional<DrivenDeployed> locate_driven(const Trajectory& trajectory,
                                            const std::function<std::unique_ptr<Integrator>()>& fresh,
                                            double guess, double h) {
  const auto locator = std::make_shared<DrivenLocator>(trajectory, fresh, guess, h);
  std::optional<DrivenDeployed> out = locator->locate();
  if (out && out->state.t == locator->edge())
    out->before = [locator](double t) { return locator->before(t); };
  return out;
}

}  // namespace unfurl
