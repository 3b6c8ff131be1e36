// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/peaks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/diagnostics/books.hpp"
#include "core/diagnostics/quintic.hpp"
#include "core/integrators/index1.hpp"
#include "core/math/largest.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {
namespace {

constexpr std::size_t most_candidates = 3, most_alone = 16;
constexpr double good_constraint =
    1e-4;  // of a rod's length: beyond it the quintic is no motion of the structure

// A step with a smooth motion leads from state a to state b.
bool joined(const Trajectory& run, std::size_t a, std::size_t b) {
  return !same_instant(run.time(a), run.time(b)) && &run.model(a) == &run.model(b) &&
         !run.report(a).singular_event && !run.report(b).singular_event;
}

// The motion around state i: two steps at most, where they are smooth.
class Neighbourhood {
 public:
  Neighbourhood(const Simulation& run, std::size_t i) : run_(run), i_(i), first_(i), last_(i) {
    const Trajectory& t = run.trajectory;
    const Model* model = &t.model(i);
    if (i > 0 && joined(t, i - 1, i)) first_ = i - 1;
    if (i + 1 < t.size() && joined(t, i, i + 1)) last_ = i + 1;
    from_ = first_;
    System system = model->system;  // follows the states
    Index1 index1(system);
    VectorXd lambda(model->system.constraints());
    for (std::size_t k = first_; k <= last_; ++k) {
      VectorXd a(t.state(k).z.size());
      const State& s = t.state(k);
      system.follow(s);
      const bool known = index1.evaluate(s, a, lambda);
      accelerations_.push_back(known ? a : VectorXd());
    }
    if (!known(i)) first_ = last_ = i;
    if (first_ < i && !(known(first_) && follows(system, index1, first_))) first_ = i;
    if (last_ > i && !(known(last_) && follows(system, index1, i))) last_ = i;
  }

  double begin() const { return run_.trajectory.time(first_); }
  double end() const { return run_.trajectory.time(last_); }
  bool empty() const { return first_ == last_; }

  // Values at these times; NaN where the quintic is no motion of the structure. It misses the constraints by
  // its own error, and redundant rows that contradict each other by d, off their common surface by d, have
  // multipliers of any size: states are moved onto the constraints first.
  std::vector<double> sample(const std::vector<double>& times, const StateValues& values) const {
    const Model& model = run_.trajectory.model(i_);
    const std::shared_ptr<const Model> shared(std::shared_ptr<const Model>(), &model);
    Simulation piece{.trajectory = Trajectory(shared), .options = run_.options};
    const VectorXd lengths = model.system.all_lengths();
    VectorXd phi(lengths.size()), q(model.system.coordinates());
    std::vector<char> moves;
    for (const double t : times) {
      State state = state_at(t);
      const System there = model.system.at(state);
      there.expand(state.z, q);
      there.all_constraint_values(t, q, phi);
      moves.push_back(phi.size() == 0 ||
                      phi.cwiseQuotient(lengths).lpNorm<Eigen::Infinity>() <= good_constraint);
      if (moves.back() && phi.size() > 0) project(there, state);
      piece.trajectory.append(std::move(state), StepReport{});
    }
    std::vector<double> out = values(piece);
    for (std::size_t k = 0; k < out.size(); ++k)
      if (!moves[k]) out[k] = std::numeric_limits<double>::quiet_NaN();
    return out;
  }

 private:
  bool known(std::size_t k) const {
    return acceleration(k).size() > 0 || run_.trajectory.state(k).z.size() == 0;
  }
  const VectorXd& acceleration(std::size_t k) const { return accelerations_[k - from_]; }

  // Whether the quintic from state k to the next obeys the equations of motion: accelerations at both ends
  // and in its middle add up to the change of the velocities, by Simpson's rule. What dampers stop within a
  // small part of the step has a first acceleration that says nothing of the rest.
  bool follows(System& system, Index1& index1, std::size_t k) const {
    constexpr double good_velocity = 0.1;  // of the largest
    const Trajectory& run = run_.trajectory;
    const State &a = run.state(k), &b = run.state(k + 1);
    State middle = state_in(k, 0.5 * (a.t + b.t));
    if (middle.z.size() == 0) return true;
    system.follow(middle);
    if (system.all_constraints() > 0) project(system, middle);
    VectorXd accel(middle.z.size()), lambda(system.constraints());
    if (!index1.evaluate(middle, accel, lambda)) return false;
    const auto size = [&](const VectorXd& w) { return std::sqrt(w.dot(system.mass() * w)); };
    const VectorXd gained = (b.t - a.t) / 6 * (acceleration(k) + 4 * accel + acceleration(k + 1));
    return size(b.w - a.w - gained) <= good_velocity * std::max({size(a.w), size(b.w), size(middle.w)});
  }

  State state_at(double t) const {
    return state_in(t < run_.trajectory.time(i_) || last_ == i_ ? first_ : i_, t);
  }
  State state_in(std::size_t k, double t) const {
    const State &a = run_.trajectory.state(k), &b = run_.trajectory.state(k + 1);
    const Quintic motion{a, b, acceleration(k), acceleration(k + 1), b.t - a.t};
    State state = a;
    const double u = (t - a.t) / (b.t - a.t);
    state.t = t;
    state.z = motion.value(u);
    state.w = motion.rate(u);
    if (a.angles.size() == b.angles.size()) state.angles = (1 - u) * a.angles + u * b.angles;
    return state;
  }

  const Simulation& run_;
  std::size_t i_, first_, last_, from_ = 0;
  std::vector<VectorXd> accelerations_;  // at state from_ and those after it; empty where there is none
};

struct Vertex {
  double t, value;
};

// Of the parabola through three points, within their times; the middle one where there is none.
Vertex vertex(const std::array<double, 3>& t, const std::array<double, 3>& x) {
  const double left = (x[1] - x[0]) / (t[1] - t[0]), right = (x[2] - x[1]) / (t[2] - t[1]);
  const double bend = (right - left) / (t[2] - t[0]);
  if (!(bend < 0)) return {t[1], x[1]};
  const double at = std::clamp(0.5 * (t[0] + t[1]) - left / (2 * bend), t[0], t[2]);
  return {at, x[0] + (at - t[0]) * (left + bend * (at - t[1]))};
}

// States around which the motion may top `best`: local maxima whose parabola reaches it, the highest first.
// What happened between two events within one step has no state to say how high it went: the longest of
// these.
std::vector<std::size_t> candidates(const Trajectory& run, const std::vector<double>& x, double best) {
  std::vector<std::pair<double, std::size_t>> found, alone;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i])) continue;
    const bool from = i > 0 && joined(run, i - 1, i), on = i + 1 < x.size() && joined(run, i, i + 1);
    if (!from && on && (i + 2 == x.size() || !joined(run, i + 1, i + 2)))
      alone.push_back({run.time(i + 1) - run.time(i), i});
    if ((from && x[i - 1] > x[i]) || (on && x[i + 1] > x[i])) continue;
    const std::size_t middle = from && on ? i : on ? i + 1 : i - 1;  // of three
    double reach = x[i];
    if ((from || on) && middle > 0 && middle + 1 < x.size() && joined(run, middle - 1, middle) &&
        joined(run, middle, middle + 1) && std::isfinite(x[middle - 1]) && std::isfinite(x[middle]) &&
        std::isfinite(x[middle + 1]))
      reach = std::max(reach, vertex({run.time(middle - 1), run.time(middle), run.time(middle + 1)},
                                     {x[middle - 1], x[middle], x[middle + 1]})
                                  .value);
    if (reach >= best) found.push_back({reach, i});
  }
  std::vector<std::size_t> out;
  const auto take = [&](std::vector<std::pair<double, std::size_t>>& from, std::size_t most) {
    std::stable_sort(from.begin(), from.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t k = 0; k < std::min(from.size(), most); ++k)
      if (std::find(out.begin(), out.end(), from[k].second) == out.end()) out.push_back(from[k].second);
  };
  take(found, most_candidates);
  take(alone, most_alone);
  return out;
}

// The largest value between two times: of 9 in all of it, 9 around the largest of those, and at the top of
// the parabola there.
double closer(const Neighbourhood& around, const StateValues& values, double best) {
  double begin = around.begin(), end = around.end();
  for (int round = 0; round < 2; ++round) {
    std::vector<double> times;
    for (int k = 0; k <= 8; ++k) times.push_back(begin + (end - begin) * k / 8);
    const std::vector<double> x = around.sample(times, values);
    std::size_t at = x.size();
    for (std::size_t k = 0; k < x.size(); ++k)
      if (!std::isnan(x[k]) && (at == x.size() || x[k] > x[at])) at = k;
    if (at == x.size()) return best;
    best = std::max(best, x[at]);
    if (at > 0 && at + 1 < x.size() && std::isfinite(x[at - 1]) && std::isfinite(x[at + 1]) && round == 1) {
      const Vertex top = vertex({times[at - 1], times[at], times[at + 1]}, {x[at - 1], x[at], x[at + 1]});
      const double there = around.sample({top.t}, values).front(), above = top.value - x[at];
      // A corner has no parabola; next to a singular pose one state by itself may say anything.
      best = std::max(best, std::abs(there - x[at]) <= 2 * above ? there : top.value);
    }
    begin = times[at > 0 ? at - 1 : 0];
    end = times[std::min(at + 1, times.size() - 1)];
  }
  return best;
}

// Whether a column is a function of the state alone.
bool of_the_state(const Series& column) {
  if (column.unit == "J") return column.name == "kinetic_energy_J" || column.name == "potential_energy_J";
  return !column.name.starts_with("constraint_") && !column.name.ends_with("_unique") &&
         column.name != "step_s" && column.name != "newton_iterations";
}

double extreme_of_column(const Simulation& run, const Diagnostics& d, std::string_view name, double sign) {
  const Series* column = d.find(name);
  if (!column) return std::numeric_limits<double>::quiet_NaN();
  const auto signed_values = [sign](const Series& series) {
    std::vector<double> out = series.values;
    for (double& x : out) x *= sign;
    return out;
  };
  const StateValues values = [&](const Simulation& piece) {
    return signed_values((column->unit == "J" ? diagnose_energies(piece) : diagnose_states(piece)).at(name));
  };
  return sign *
         largest_in_motion(run, signed_values(*column), of_the_state(*column) ? values : StateValues());
}

}  // namespace

double largest_in_motion(const Simulation& run, const std::vector<double>& at_states,
                         const StateValues& values) {
  double best = std::numeric_limits<double>::quiet_NaN();
  for (const double x : at_states)
    if (!std::isnan(x) && !(x <= best)) best = x;
  if (std::isnan(best) || !values || at_states.size() != run.trajectory.size()) return best;
  for (const std::size_t i : candidates(run.trajectory, at_states, best)) {
    const Neighbourhood around(run, i);
    if (!around.empty()) best = closer(around, values, best);
  }
  return best;
}

namespace {

thread_local RememberedExtremes* remembered = nullptr;

}  // namespace

RememberedExtremes::RememberedExtremes() : before_(std::exchange(remembered, this)) {}
RememberedExtremes::~RememberedExtremes() {
  remembered = before_;
}

double extreme_of(const Simulation& run, const Diagnostics& d, std::string_view column, bool largest) {
  const double sign = largest ? 1.0 : -1.0;
  if (!remembered) return extreme_of_column(run, d, column, sign);
  const auto [found, made] = remembered->found_.try_emplace({&d, std::string(column), largest}, 0.0);
  if (made) found->second = extreme_of_column(run, d, column, sign);
  return found->second;
}

double largest_of_column(const Simulation& run, const Diagnostics& diagnostics, std::string_view column) {
  return extreme_of(run, diagnostics, column, true);
}

double smallest_of_column(const Simulation& run, const Diagnostics& diagnostics, std::string_view column) {
  return extreme_of(run, diagnostics, column, false);
}

double peak_of_column(const Simulation& run, const Diagnostics& diagnostics, std::string_view column) {
  return larger(largest_of_column(run, diagnostics, column), -smallest_of_column(run, diagnostics, column));
}

}  // namespace unfurl
