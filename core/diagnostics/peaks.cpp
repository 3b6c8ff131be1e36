// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/peaks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "core/diagnostics/books.hpp"
#include "core/diagnostics/energy_tops.hpp"
#include "core/diagnostics/force_round_off.hpp"
#include "core/diagnostics/motion_samples.hpp"
#include "core/diagnostics/peak_by_states.hpp"
#include "core/diagnostics/peak_samples.hpp"
#include "core/diagnostics/quintic.hpp"
#include "core/diagnostics/reactions.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/integrators/index1.hpp"
#include "core/math/largest.hpp"
#include "core/simulate/dense_output.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {
namespace {

constexpr std::size_t most_candidates = most_tops, most_alone = 16;
constexpr double good_constraint = 1e-4;  // of a rod's length: beyond it there is no motion of the structure
// Of the largest velocity, what accelerations in a step may miss of its change: for the quintic, for steps.
constexpr double good_quintic = 1e-5, good_step = 0.1;
constexpr double still = 1e-14, no_step = 1e-8;  // of the coordinates, of the longest step: rounding alone

bool follows(const Trajectory& run, std::size_t a, std::size_t b) {
  const double h = run.time(b) - run.time(a), least = no_step * run.options().step;
  return h > least && !same_instant(run.time(a), run.time(b)) && &run.model(a) == &run.model(b);
}

// What is kept of a run that is not kept whole (RunDigest) stands alone: no step leads to or from it.
bool alone(const Trajectory& run, std::size_t i) {
  const VectorXd& lambda = run.state(i).lambda;
  return run.report(i).singular_event && run.model(i).system.constraints() > 0 &&
         (lambda.size() == 0 || !lambda.allFinite());
}

// A step with a smooth motion leads from state a to state b. Into a singular pose, which has no
// accelerations, only a long one: of others the states before it tell.
bool joined(const Trajectory& run, std::size_t a, std::size_t b) {
  return follows(run, a, b) && !run.report(a).singular_event &&
         !(run.report(b).singular_event && is_short_step(run.state(a), run.state(b)));
}

// The motion around state i: two steps at most, where they are smooth; of each the quintic through positions,
// velocities and accelerations at its ends where that obeys the equations of motion, else what a step of the
// method leads to.
class Neighbourhood {
 public:
  enum class Of { smooth_steps, all_steps };  // the latter as the method has them, whatever they lead through
  Neighbourhood(const Simulation& run, std::size_t i, Of of = Of::smooth_steps)
      : run_(run), i_(i), first_(i), last_(i), all_(of == Of::all_steps) {
    const Trajectory& t = run.trajectory;
    const Model* model = &t.model(i);
    if (all_) {
      const auto step = [&t](std::size_t k) {
        return follows(t, k, k + 1) && !alone(t, k) && !alone(t, k + 1);
      };
      while (first_ > 0 && i - first_ < 8 && step(first_ - 1)) --first_;
      while (last_ + 1 < t.size() && last_ - i < 8 && step(last_)) ++last_;
      return;
    }
    if (i > 0 && joined(t, i - 1, i)) first_ = i - 1;
    if (i + 1 < t.size() && joined(t, i, i + 1)) last_ = i + 1;
    from_ = first_;
    System system = model->system;  // follows the states
    Index1 index1(system);
    for (std::size_t k = first_; k <= last_; ++k) {
      VectorXd a;
      accelerate(system, index1, t.state(k), t.report(k).singular_event, a);
      accelerations_.push_back(std::move(a));
    }
    if (first_ < i && !smooth(system, index1, first_)) first_ = i;
    if (last_ > i && !smooth(system, index1, i)) last_ = i;
  }

  double begin() const { return run_.trajectory.time(first_); }
  double end() const { return run_.trajectory.time(last_); }
  bool empty() const { return first_ == last_; }

  // Values at these times; NaN where there is no motion of the structure. The quintic misses the constraints
  // by its own error, and redundant rows that contradict each other by d, off their common surface by d, have
  // multipliers of any size: states are moved onto the constraints first.
  std::vector<double> sample(const std::vector<double>& times, const StateValues& values) const {
    MotionSamples* const samples = remembered_samples();
    const MotionSamples::Key key(&run_, i_, all_, samples ? times : std::vector<double>());
    const MotionSamples::Sample* known = samples ? samples->find(key) : nullptr;
    std::optional<MotionSamples::Sample> made;
    if (!known) made = states_at(times);
    if (!known) known = samples ? &samples->keep(key, std::move(*made)) : &*made;
    std::vector<double> out = values(known->piece);
    for (std::size_t k = 0; k < out.size(); ++k)
      if (!known->moves[k]) out[k] = std::numeric_limits<double>::quiet_NaN();
    return out;
  }

 private:
  MotionSamples::Sample states_at(const std::vector<double>& times) const {
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
      const bool singular = t >= end() && run_.trajectory.report(last_).singular_event;
      moves.push_back(!singular && (phi.size() == 0 ||
                                    phi.cwiseQuotient(lengths).lpNorm<Eigen::Infinity>() <= good_constraint));
      if (moves.back() && phi.size() > 0) move_onto_constraints(model, state);
      piece.trajectory.append(std::move(state), StepReport{});
    }
    return {std::move(piece), std::move(moves)};
  }

  // Accelerations at a state; nothing where they are not known.
  static bool accelerate(System& system, Index1& index1, const State& state, bool singular, VectorXd& a) {
    VectorXd lambda(system.constraints());
    a.resize(state.z.size());
    system.follow(state);
    const bool known = a.size() == 0 || (!singular && index1.evaluate(state, a, lambda));
    if (!known) a.resize(0);
    return known;
  }
  const VectorXd& acceleration(std::size_t k) const { return accelerations_[k - from_]; }

  // Whether the step from state k on is known within, and by what. Tried by accelerations in it, which add up
  // to the change of the velocities: by Simpson's rule of the quintic, by Boole's of steps of the method.
  // What dampers stop within a small part of a step has a first acceleration that says nothing of the rest.
  // Up to a singular pose, which has no acceleration, most of the step is looked at.
  bool smooth(System& system, Index1& index1, std::size_t k) {
    const Trajectory& run = run_.trajectory;
    const State &a = run.state(k), &b = run.state(k + 1);
    if (a.z.size() == 0) return true;
    if (acceleration(k).size() == 0) return false;
    if (acceleration(k + 1).size() > 0 && adds_up<3>(system, index1, k, b, {1, 4, 1}, good_quintic))
      return true;
    by_steps_.push_back(k);
    if (run_.solved_as.name == "path") return true;  // its motion is known at any time
    const bool open = acceleration(k + 1).size() == 0;
    return adds_up<5>(system, index1, k, open ? state_in(k, a.t + 0.875 * (b.t - a.t)) : b,
                      {7, 32, 12, 32, 7}, good_step);
  }

  // Whether the velocity's change from state k to `end` is that of the accelerations between, by a rule of
  // these weights at equal distances, to this share of the largest velocity.
  template <std::size_t N>
  bool adds_up(System& system, Index1& index1, std::size_t k, const State& end,
               const std::array<double, N>& weights, double good) const {
    const State& a = run_.trajectory.state(k);
    const auto size = [&](const VectorXd& w) { return std::sqrt(w.dot(system.mass() * w)); };
    VectorXd gained = VectorXd::Zero(a.w.size()), accel;
    double largest = std::max(size(a.w), size(end.w)), sum = 0;
    for (std::size_t j = 0; j < N; ++j) {
      State s = j + 1 == N ? end : state_in(k, a.t + (end.t - a.t) * static_cast<double>(j) / (N - 1));
      if (j > 0 && j + 1 < N && system.all_constraints() > 0)
        move_onto_constraints(run_.trajectory.model(k), s);
      if (!accelerate(system, index1, s, false, accel)) return false;
      gained += weights[j] * accel;
      sum += weights[j];
      largest = std::max(largest, size(s.w));
    }
    const double h = end.t - a.t;
    return size(end.w - a.w - h / sum * gained) * h <= good * largest * h + still * size(a.z);
  }

  State state_at(double t) const {
    if (all_) return run_.trajectory.state_at(t);
    return state_in(t < run_.trajectory.time(i_) || last_ == i_ ? first_ : i_, t);
  }
  State state_in(std::size_t k, double t) const {
    const State &a = run_.trajectory.state(k), &b = run_.trajectory.state(k + 1);
    if (t <= a.t) return a;
    if (t >= b.t) return b;
    if (std::find(by_steps_.begin(), by_steps_.end(), k) != by_steps_.end())
      return run_.trajectory.state_at(t);
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
  bool all_;
  std::vector<VectorXd> accelerations_;  // at state from_ and those after it; empty where there is none
  std::vector<std::size_t> by_steps_;    // of the steps from these states the quintic is not good enough
};

std::shared_ptr<const Neighbourhood> neighbourhood(const Simulation& run, std::size_t i) {
  MotionSamples* const samples = remembered_samples();
  std::shared_ptr<const void> made, &known = samples ? samples->around[{&run, i}] : made;
  if (!known) known = std::make_shared<const Neighbourhood>(run, i);
  return std::static_pointer_cast<const Neighbourhood>(known);
}

// States around which the motion may top `best`: local maxima whose parabola reaches it, and those beside a
// corner that does, of each the highest first. What happened between two events within one step has no state
// to say how high it went: the longest of these.
std::vector<std::size_t> candidates(const Trajectory& run, const std::vector<double>& x, double best) {
  std::vector<std::pair<double, std::size_t>> found, corners, alone;
  const auto time = [&](std::size_t k) { return run.time(k); };
  const auto leads = [&](std::size_t k) { return k + 1 < x.size() && joined(run, k, k + 1); };
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
    if (2 * reach - x[i] >= best) found.push_back({reach, i});  // values may bend more than a parabola does
    const double corner =
        std::fmax(i > 0 ? corner_in(x, i - 1, leads, time).value : best, corner_in(x, i, leads, time).value);
    if (corner > best) corners.push_back({corner, i});
  }
  std::vector<std::size_t> out;
  const auto take = [&](std::vector<std::pair<double, std::size_t>>& from, std::size_t most) {
    std::stable_sort(from.begin(), from.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t k = 0; k < std::min(from.size(), most); ++k)
      if (std::find(out.begin(), out.end(), from[k].second) == out.end()) out.push_back(from[k].second);
  };
  take(found, most_candidates);
  take(corners, most_candidates);
  take(alone, most_alone);
  return out;
}

// Steps too long for their ends to tell of what is between; of many, or single ones among many, states tell.
std::vector<std::size_t> long_steps(const Trajectory& t) {
  constexpr std::size_t most_long = 128, few = 8;
  std::vector<std::size_t> steps;
  for (std::size_t k = 0; k + 1 < t.size() && steps.size() <= most_long; ++k)
    if (joined(t, k, k + 1) && !is_short_step(t.state(k), t.state(k + 1))) steps.push_back(k);
  if (steps.size() > most_long || (t.size() > 2 * most_long && few * steps.size() < t.size())) return {};
  return steps;
}

// Those that hold the largest values: at a quarter, the middle and three quarters, of which closer() tries
// whether they are true.
std::vector<std::size_t> long_steps(const Simulation& run, const StateValues& values) {
  MotionSamples* const samples = remembered_samples();
  std::optional<std::vector<std::size_t>> own, &known = samples ? samples->long_steps[&run] : own;
  if (!known) known = long_steps(run.trajectory);
  std::vector<std::pair<double, std::size_t>> found;
  for (const std::size_t k : *known) {
    std::optional<MotionSamples::Sample> made;
    double most = -std::numeric_limits<double>::infinity();
    for (const double x : values(inside_step(run, k, made))) most = std::max(most, x);  // not a NaN
    found.push_back({most, k});
  }
  std::ranges::stable_sort(found, std::greater(), [](const auto& f) { return f.first; });
  std::vector<std::size_t> steps;
  for (std::size_t k = 0; k < std::min(found.size(), 2 * most_candidates); ++k)
    steps.push_back(found[k].second);
  return steps;
}

// The largest value of what is around a state: of 9 in all of it, 9 around each of those that may lead to it,
// and at the top of the parabola there; where that is a corner, of 9 in ever smaller parts.
PeakInMotion closer(const Neighbourhood& around, const StateValues& values, PeakInMotion best) {
  constexpr int most_zooms = 5;
  const auto take = [&best](double x, double t) {
    if (x > best.value) best = {x, t};
  };
  const auto samples = [&](double begin, double end) {
    PeakSamples all(begin, end);
    all.x = around.sample(all.t, values);
    for (std::size_t k = 0; k < all.x.size(); ++k) take(all.x[k], all.t[k]);
    return all;
  };
  const auto at_parabola = [&](const PeakSamples& some, std::size_t at) {
    if (!some.has_both(at) || some.is_known(at)) return;
    const PeakInMotion top = some.parabola(at);
    const double there = around.sample({top.t}, values).front(), above = top.value - some.x[at];
    // Next to a singular pose one state by itself may say anything. A corner has no parabola.
    if (std::abs(there - some.x[at]) <= 2 * above)
      take(there, top.t);
    else if (!some.is_corner(at))
      take(top.value, top.t);
  };
  const PeakSamples all = samples(around.begin(), around.end());
  for (const std::size_t k : all.tops(best.value)) {
    if (all.is_known(k)) continue;
    PeakSamples some = samples(all.t[k > 0 ? k - 1 : 0], all.t[std::min(k + 1, all.t.size() - 1)]);
    for (const std::size_t at : some.tops(best.value)) at_parabola(some, at);
    for (int zoom = 0; zoom < most_zooms; ++zoom) {
      const std::optional<std::size_t> at = some.largest();
      if (!at || !some.is_corner(*at)) break;
      some = samples(some.t[*at - 1], some.t[*at + 1]);
      if (const auto top = some.largest(); top && !some.is_corner(*top)) at_parabola(some, *top);
    }
    if (const auto at = some.largest()) {
      if (const PeakInMotion top = some.corner(*at); !std::isnan(top.value))
        take(around.sample({top.t}, values).front(), top.t);
    }
  }
  return best;
}

// Next to a singular pose no value is known; nearest to it, on one side, three at a distance, twice and four
// times it. Where their differences double, as those of c / |t - t*| do whatever else acts, the values rise
// without bound: the largest.
PeakInMotion rise_towards(const Neighbourhood& around, const StateValues& values, double t, double side) {
  constexpr double doubled = 1.6, seen = 0.05;  // of the value itself
  const double span = around.end() - around.begin();
  for (double d = span / 1024; d < span; d *= 2) {
    const std::array<double, 3> times{t + side * d, t + side * 2 * d, t + side * 4 * d};
    if (times[2] < around.begin() || times[2] > around.end()) break;
    const std::vector<double> x = around.sample({times.begin(), times.end()}, values);
    if (std::isnan(x[0])) continue;
    const double near = x[0] - x[1], far = x[1] - x[2];
    if (far > 0 && near >= doubled * far && near >= seen * x[0]) return {x[0], times[0], false, times[0]};
    break;
  }
  return {};
}

// Beside the singular poses that a run tells of, those whose states hold the largest values first, a force
// may be larger the nearer it is looked for; `least` may be round-off, which grows as fast.
PeakInMotion without_bound(const Simulation& run, const std::vector<double>& at_states,
                           const StateValues& values, double least) {
  constexpr std::size_t most_poses = 3;
  std::vector<std::pair<double, double>> poses;  // value beside it, time
  for (const Event& event : run.events) {
    if (event.kind != "singular_pose") continue;
    const std::size_t i = run.trajectory.state_before(event.t),
                      behind = std::min(i + 1, at_states.size() - 1);
    const double most = larger(at_states[i], at_states[behind]);
    poses.push_back({std::isnan(most) ? -std::numeric_limits<double>::infinity() : most, event.t});
  }
  std::ranges::stable_sort(poses, std::greater(), [](const auto& pose) { return pose.first; });
  PeakInMotion found;
  for (std::size_t k = 0; k < std::min(poses.size(), most_poses) && std::isnan(found.value); ++k) {
    const double t = poses[k].second;
    const std::size_t before = run.trajectory.state_before(t);
    const bool nearer = before + 1 < at_states.size() &&
                        run.trajectory.time(before + 1) - t < t - run.trajectory.time(before);
    const Neighbourhood around(run, before + (nearer ? 1 : 0), Neighbourhood::Of::all_steps);
    for (const double side : {-1.0, 1.0})
      if (const PeakInMotion rise = rise_towards(around, values, t, side); rise.value > least)
        if (!(rise.value <= found.value)) found = rise;
  }
  return found;
}

// Of a piece alone an angle begins anew within a turn: on from that of the run's state before.
void count_on(const Trajectory& run, const Simulation& piece, const std::vector<double>& known, double turn,
              std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::size_t i = run.state_before(piece.trajectory.time(k));
    if (i < known.size()) values[k] += turn * std::round((known[i] - values[k]) / turn);
  }
}

PeakInMotion looked_for_extreme(const Simulation& run, const Diagnostics& d, std::string_view name,
                                double sign) {
  const Series* column = d.find(name);
  if (!column) return {};
  const auto signed_values = [sign](std::vector<double> out) {
    for (double& x : out) x *= sign;
    return out;
  };
  const StateValues values = [&](const Simulation& piece) {
    Diagnostics made;
    std::vector<double> out = signed_values(judged_piece(piece, table_of(*column), made).at(name).values);
    if (name == "fold_angle_rad") count_on(run.trajectory, piece, signed_values(column->values), 2 * pi, out);
    if (name == "fold_angle_deg") count_on(run.trajectory, piece, signed_values(column->values), 360, out);
    return out;
  };
  const std::vector<double> at_states = signed_values(column->values);
  std::vector<std::size_t> also = rod_humps(run.trajectory, d, name, sign);
  if (sign < 0) std::ranges::copy(reaction_dips(d, name), std::back_inserter(also));
  PeakInMotion top = top_of_motion(run, at_states, of_the_state(*column) ? values : StateValues(), also);
  top = top_of_energy(run.trajectory, d, *column, sign, joined, top);
  if (is_force(*column) && at_states.size() == run.trajectory.size())
    if (const PeakInMotion rise = without_bound(run, at_states, values, round_off_within_steps(*column, d));
        !std::isnan(rise.value)) {
      if (!(rise.value <= top.value)) top = rise;
      top.bounded = false, top.rise_t = rise.t;
    }
  return top.value *= sign, top;
}

}  // namespace

PeakInMotion top_of_motion(const Simulation& run, const std::vector<double>& at_states,
                           const StateValues& values, const std::vector<std::size_t>& also) {
  const bool of_run = at_states.size() == run.trajectory.size();
  PeakInMotion best;
  for (std::size_t i = 0; i < at_states.size(); ++i)
    if (const double x = at_states[i]; !std::isnan(x) && !(x <= best.value))
      best = {x, of_run ? run.trajectory.time(i) : best.t};
  if (std::isnan(best.value) || !values || !of_run) return best;
  std::vector<std::size_t> around_these = candidates(run.trajectory, at_states, best.value);
  for (const auto& more : {long_steps(run, values), also})
    for (const std::size_t i : more)
      if (std::ranges::find(around_these, i) == around_these.end()) around_these.push_back(i);
  for (const std::size_t i : around_these) {
    const std::shared_ptr<const Neighbourhood> around = neighbourhood(run, i);
    if (around->empty()) continue;
    PeakInMotion found = closer(*around, values, best);
    if (found.value > best.value) found = by_states(run, at_states, found);
    if (found.value > best.value) best = found;
  }
  return best;
}

double largest_in_motion(const Simulation& run, const std::vector<double>& at_states,
                         const StateValues& values) {
  return top_of_motion(run, at_states, values).value;
}

VectorXd rod_forces_within_step(const Simulation& run, double t) {
  const Trajectory& states = run.trajectory;
  VectorXd forces;
  for (std::size_t i = 0; i + 1 < states.size() && states.time(i) < t; ++i)
    if (t < states.time(i + 1)) {
      const std::shared_ptr<const Neighbourhood> around = neighbourhood(run, i);
      if (t < around->end())
        around->sample({t}, [&](const Simulation& piece) {
          Diagnostics made;
          forces = judged_piece(piece, MotionSamples::Of::motion, made).axial_force.row(0).transpose();
          return std::vector<double>(piece.trajectory.size());
        });
    }
  return forces;
}

namespace {

thread_local RememberedExtremes* remembered = nullptr;

}  // namespace

MotionSamples* remembered_samples() {
  return remembered ? remembered->samples_.get() : nullptr;
}

RememberedExtremes::RememberedExtremes() : outermost_(remembered == nullptr) {
  if (!outermost_) return;
  samples_ = std::make_unique<MotionSamples>();
  remembered = this;
}
RememberedExtremes::~RememberedExtremes() {
  if (outermost_) remembered = nullptr;
}

PeakInMotion extreme_of_column(const Simulation& run, const Diagnostics& diagnostics, std::string_view column,
                               bool largest) {
  if (diagnostics.left_open > 0) return {};  // it may lie in what was not judged
  const auto look = [&] {
    return beyond(diagnostics, column, largest,
                  looked_for_extreme(run, diagnostics, column, largest ? 1.0 : -1.0));
  };
  if (!remembered) return look();
  const std::tuple key(&diagnostics, std::string(column), largest);
  if (const auto known = remembered->found_.find(key); known != remembered->found_.end())
    return known->second;
  return remembered->found_[key] = look();
}

double largest_of_column(const Simulation& run, const Diagnostics& diagnostics, std::string_view column) {
  return extreme_of_column(run, diagnostics, column, true).value;
}

double smallest_of_column(const Simulation& run, const Diagnostics& diagnostics, std::string_view column) {
  return extreme_of_column(run, diagnostics, column, false).value;
}

double peak_of_column(const Simulation& run, const Diagnostics& diagnostics, std::string_view column) {
  return larger(largest_of_column(run, diagnostics, column), -smallest_of_column(run, diagnostics, column));
}

}  // namespace unfurl
