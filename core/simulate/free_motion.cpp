// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/free_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/simulate/initial_state.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {
namespace {

// Of the method: what is far beyond a step's own error, columns of the extrapolation, and what stiff springs
// may cost before they are left to others.
constexpr double free_enough = 1e-14;
constexpr int free_columns = 8, most_halvings = 8, most_evaluations = 4000;

}  // namespace

std::vector<Index> free_coordinates(const System& system, const State& state) {
  constexpr double led = 1e-6;
  const System near = system.at(state);
  VectorXd q(system.coordinates()), any(q.size()), moved(q.size()), rests(q.size());
  system.expand(state.z, q);
  for (Index k = 0; k < any.size(); ++k) any[k] = std::sin(1.0 + static_cast<double>(k));
  near.expand_rate(fitted_rates(near, state.t, q, any), moved);
  near.expand_rate(fitted_rates(near, state.t, q, VectorXd::Zero(q.size())), rests);
  VectorXd of_nodes = VectorXd::Zero(q.size()), touched(system.solved_coordinates());
  for (Index k = 0; k < q.size(); ++k)
    if (std::abs(moved[k] - rests[k]) > led)
      of_nodes.segment(k - k % 3, std::min<Index>(3, q.size() - k + k % 3)).setOnes();
  system.reduce_sizes(of_nodes, touched);
  std::vector<Index> out;
  for (Index i = 0; i < touched.size(); ++i)
    if (touched[i] > 0) out.push_back(i);
  return out;
}

FreeMotion::FreeMotion(const System& system, std::vector<Index> free)
    : system_(system),
      jacobian_(system.jacobian_pattern()),
      part_(jacobian_, std::move(free)),
      rows_of_free_(part_.of(jacobian_)),
      saddle_(std::make_unique<SaddleSolver>(part_.of_square(system.mass()), rows_of_free_)),
      acceleration_(system.solved_coordinates()),
      lambda_(VectorXd::Zero(system.constraints())),
      q_(system.coordinates()),
      v_(system.coordinates()),
      f_(system.coordinates()),
      force_(system.solved_coordinates()),
      bias_(system.constraints()) {}

void FreeMotion::put(const VectorXd& y, State& state) const {
  const Index n = std::ssize(coordinates());
  state.z(coordinates()) = y.head(n);
  state.w(coordinates()) = y.tail(n);
}

// M_ff a + G_f^T lambda = F - M_fl a_l, G_f a = -bias - G_l a_l.
bool FreeMotion::solve(const State& state, VectorXd& acceleration, VectorXd& lambda) {
  const Index n = std::ssize(coordinates());
  acceleration(coordinates()).setZero();
  system_.expand(state.z, q_);
  system_.expand_rate(state.w, v_);
  system_.jacobian(q_, jacobian_, scratch_);
  f_.setZero();
  if (state.tension.size() > 0) {
    system_.add_other_force(state.t, q_, v_, state.tension, 1.0, f_);
    system_.add_giving_rod_forces(q_, state.tension, 1.0, f_);
  } else {
    system_.add_applied_force(state.t, q_, v_, 1.0, f_);
  }
  system_.reduce_force(f_, force_);
  force_ -= system_.mass() * acceleration;
  system_.constraint_bias(state.t, q_, v_, bias_);
  bias_ = -bias_ - jacobian_ * acceleration;
  rows_of_free_ = part_.of(jacobian_);
  if (!saddle_->factorise(rows_of_free_)) return false;
  VectorXd a(n), multipliers(std::ssize(rows()));
  saddle_->solve(force_(coordinates()), bias_(rows()), a, multipliers);
  acceleration(coordinates()) = a;
  lambda(rows()) = multipliers;
  return a.allFinite() && multipliers.allFinite();
}

bool FreeMotion::factorise(const State& state) {
  system_.expand(state.z, q_);
  system_.jacobian(q_, jacobian_, scratch_);
  rows_of_free_ = part_.of(jacobian_);
  return saddle_->factorise(rows_of_free_);
}
Index FreeMotion::rows_below(const State& state, double bound) {
  return factorise(state) ? saddle_->rows_below(bound) : 0;
}
double FreeMotion::weakest_pivot(const State& state, double bound) {
  return factorise(state) ? saddle_->weakest_pivot(bound) : bound;
}

VectorXd FreeMotion::felt(const State& state, const VectorXd& acceleration, const VectorXd& lambda) {
  VectorXd of_rows = VectorXd::Zero(lambda.size()), of_free = VectorXd::Zero(acceleration.size());
  of_rows(rows()) = lambda(rows());
  of_free(coordinates()) = acceleration(coordinates());
  system_.expand(state.z, q_);
  system_.jacobian(q_, jacobian_, scratch_);
  return jacobian_.transpose() * of_rows + system_.mass() * of_free;
}

bool FreeMotion::slope(double t, const VectorXd& y, VectorXd& out) {
  if (--left_ < 0) return false;
  const Index n = std::ssize(coordinates());
  (*led_)(t, state_, acceleration_);
  put(y, state_);
  state_.t = t;
  if (!solve(state_, acceleration_, lambda_)) return false;
  out.resize(2 * n);
  out << y.tail(n), acceleration_(coordinates());
  return true;
}

// Gragg's midpoint rule with 2, 4, 6, ... parts, extrapolated to none.
bool FreeMotion::extrapolate(double from, double to, const VectorXd& y, VectorXd& out, double& error) {
  const Index n = std::ssize(coordinates());
  VectorXd start, middle;
  if (!slope(from, y, start)) return false;
  std::vector<VectorXd> row;
  for (int j = 0; j < free_columns; ++j) {
    const int parts = 2 * (j + 1);
    const double h = (to - from) / parts;
    VectorXd before = y, now = y + h * start;
    for (int i = 1; i < parts; ++i) {
      if (!slope(from + i * h, now, middle)) return false;
      VectorXd next = before + 2 * h * middle;
      before = std::exchange(now, std::move(next));
    }
    if (!slope(to, now, middle)) return false;
    VectorXd column = 0.5 * (now + before + h * middle);
    for (int k = 0; k < j; ++k) {
      const double ratio = static_cast<double>(parts) / (2 * (j - k));
      VectorXd better = column + (column - row[static_cast<std::size_t>(k)]) / (ratio * ratio - 1);
      row[static_cast<std::size_t>(k)] = std::exchange(column, std::move(better));
    }
    row.push_back(column);
    if (j < 3) continue;
    const VectorXd change = row[static_cast<std::size_t>(j)] - row[static_cast<std::size_t>(j - 1)];
    error = change.head(n).lpNorm<Eigen::Infinity>() + (to - from) * change.tail(n).lpNorm<Eigen::Infinity>();
    if (error <= free_enough * size_) break;
  }
  out = row.back();
  return out.allFinite();
}

bool FreeMotion::go(double from, double to, VectorXd& y, double& error, int halvings) {
  VectorXd out;
  double off = 0;
  if (!extrapolate(from, to, y, out, off)) return false;
  if (halvings == 0 || off <= 10 * free_enough * size_) {
    y = std::move(out);
    error += off;
    return true;
  }
  const double middle = 0.5 * (from + to);
  return go(from, middle, y, error, halvings - 1) && go(middle, to, y, error, halvings - 1);
}

double FreeMotion::move(State& state, double end, const std::vector<double>& edges, const Led& led) {
  const Index n = std::ssize(coordinates());
  led_ = &led;
  left_ = most_evaluations;
  state_ = state;
  size_ = state.z.lpNorm<Eigen::Infinity>();
  VectorXd y(2 * n);
  y << state.z(coordinates()), state.w(coordinates());
  double error = 0, from = state.t;
  const auto reach = [&](double to) {
    const double start = std::exchange(from, to), last = before_jump(to);
    return !(last > start) || go(start, last, y, error, most_halvings);
  };
  bool found = true;
  for (const double edge : edges)
    if (found && edge > from && edge < end) found = reach(edge);
  if (!found || !reach(end)) return std::numeric_limits<double>::infinity();
  put(y, state);
  return error;
}

}  // namespace unfurl
