// SPDX-License-Identifier: BSD-3-Clause
// Steps that have to end in a singular pose, and the way on from there.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/constraints/linear_rows.hpp"
#include "core/integrators/index1.hpp"
#include "core/simulate/driven_parts.hpp"
#include "core/simulate/free_motion.hpp"
#include "core/simulate/led_forces.hpp"
#include "core/simulate/stepper_loop.hpp"
#include "core/simulate/weak_rows.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {
namespace {

constexpr int before_it = 8, behind_it = 6, before_rest = 12;  // states on both sides, or before alone
constexpr double lost_rank = 1e-10;                            // the square of a singular value
constexpr double agreed = 1e-8;                                // of the structure's size

// To times around t, none nearer than half of what they are `apart`, as far as they are clear of the start.
std::vector<double> lengths_around(double t, double apart, double from, double until,
                                   int before = before_it) {
  constexpr double clear = 0.3;
  std::vector<double> lengths;
  for (int k = -before;; ++k) {
    const double length = t + (k + 0.5) * apart - from;
    if (k >= behind_it && from + length > until) return lengths;
    if (length > clear * apart) lengths.push_back(length);
  }
}

// By steps no longer than a run's; of those that end too close to the pose other ones get through.
AcrossPose::Step steps_of(Integrator& integrator, double longest) {
  return [&integrator, longest](State& state, double length) {
    const State start = state;
    const int least = std::max(1, static_cast<int>(std::ceil(length / (1.5 * longest))));
    for (const int count : {least, least + 1, least + 2}) {
      state = start;
      bool good = true;
      for (int i = 0; i < count && good; ++i) {
        integrator.restart();
        const StepReport report = integrator.step(state, length / count);
        good = report.ok() && !report.weak_end;
      }
      if (good) return true;
    }
    return false;
  };
}

// From states before the pose.
VectorXd multipliers_there(const System& smooth, const AcrossPose& across, const std::vector<Index>& free,
                           const State& there) {
  constexpr std::size_t nearer_by = 5;
  System followed = smooth;
  Index1 index1(followed, true);
  std::vector<NearDeployed> before;
  VectorXd acceleration(there.w.size());
  for (State state : across.solved()) {
    if (!(state.t < there.t)) break;
    followed.follow(state);
    if (index1.evaluate(state, acceleration, state.lambda))
      before.push_back({there.t - state.t, std::move(state)});
  }
  if (!free.empty()) {
    FreeMotion beside(followed, free);
    State led = there;
    across.between(there.t, led, acceleration);
    feel_as_at(followed, beside, index1, there, acceleration, before);
  }
  followed.follow(there);
  VectorXd lambda = there.lambda;
  for (const std::size_t nearest : {before.size(), nearer_by}) {  // some may lie beside another pose
    if (before.size() < std::max<std::size_t>(nearest, 3)) break;
    before.erase(before.begin(), before.end() - static_cast<std::ptrdiff_t>(nearest));
    lambda = multipliers_at_deployed(index1, before, there, 3);
    if (!lambda.allFinite()) break;
  }
  return lambda;
}

}  // namespace

// A step that changes sides of a dead centre which its drives do not reach is not taken, but half of it.
// True where it is known to stay beside one.
bool Stepper::Loop::stays_beside(Probe& to) {
  constexpr double least = 1e-6;  // of a step
  constexpr int most = 100;
  if (!to.report.ok()) return false;
  const auto [side, turn] = dead_centres_->judge(now(), to.state);
  const double h = turn - now().t;
  if (side == DeadCentres::Side::kept) {
    to.report.weak_end = false;
    return true;
  }
  if (side == DeadCentres::Side::unknown) return false;
  if (side == DeadCentres::Side::turns) {
    const auto integrator = fresh_integrator();
    const auto step = [&](State& state, double length) { return integrator->step(state, length); };
    State there = now();
    if (!step(there, h).ok() && !step_in_parts(*integrator, there, h, step).ok()) return false;
    if (dead_centres_->in_one(there)) return false;
  }
  on_side_until_ = side == DeadCentres::Side::turns ? turn : 0.5 * (now().t + to.state.t);
  if (!(on_side_until_ - now().t > least * run_.options.step) || ++halved_ > most) {
    warn_once(
        ": a drive rests or turns round so near a dead centre that rods may have been thrown over it; "
        "a smaller solver.step tells");
    return false;
  }
  integrator_->restart();
  if (in_pose_ && in_pose_->t > now().t) in_pose_.reset();
  return lost_side_ = true;
}

// The first state of the run since which what drives lead is smooth, whatever has switched beside it.
std::size_t Stepper::Loop::led_since() const {
  double edge = -std::numeric_limits<double>::infinity();
  for (const TimeEdge& e : prescribed_edges(model().structure, run_.options.step))
    if (e.t <= now().t) edge = std::max(edge, e.t);
  std::size_t i = run_.trajectory.size() - 1;
  while (i > 0 && !(run_.trajectory.time(i) >= edge && run_.trajectory.time(i - 1) < edge)) --i;
  return i;
}

// The last state that lies clear of the pose at the end of this step, as far back as the motion comes nearer
// to it, but for what was before `first`.
State Stepper::Loop::clear_of(double t, std::size_t first) const {
  constexpr double clear = 0.02 * 0.02;  // the square of a singular value
  const double longest = std::max(60 * run_.options.step, 15 * (t - now().t));
  const double step = run_.options.step;
  WeakRows rows(system());
  std::size_t i = run_.trajectory.size() - 1;
  while (i > first && t - run_.trajectory.time(i) < 0.99 * step) --i;
  State state = in_last_model(run_.trajectory, i);
  std::size_t before_i = i;
  while (before_i > first && !(run_.trajectory.time(before_i) < state.t)) --before_i;
  if (const double d = state.t - run_.trajectory.time(before_i); d > 0)
    // What comes to its pose by then has come at least as fast; what needs twice the time comes to another.
    rows.count_falling(in_last_model(run_.trajectory, before_i), state,
                       std::pow(1 + 0.5 * d / (t - state.t), -2));
  double pivot = rows.pivot(state, clear);
  while (i > first && pivot < clear && t - run_.trajectory.time(i) < longest) {
    State before = in_last_model(run_.trajectory, i - 1);
    const double next = rows.pivot(before, clear);
    if (!(next >= pivot)) break;                          // two states of an impact have the same
    if (rows.another_falls(state, before, clear)) break;  // nor back to where another part comes from
    pivot = next, --i;
    state = std::move(before);
  }
  return state;
}

// A step that time or a switch ends in such a pose may be solved there, and tell rates with no digits: where
// drives lead there it is no matter of chance. Not where they are on the way to it, as slowly
// as steps can follow.
bool Stepper::Loop::ends_in_pose(const Probe& to) const {
  constexpr double soon = 0.1;  // of a step, to the pose
  constexpr double clear = 1;
  if (!to.report.ok() || to.report.weak_end) return to.report.weak_end;
  if (system().drives().empty()) return false;
  WeakRows rows(system());
  const Index below = rows.below(to.state, lost_rank);
  const double t = now().t + to.at;
  if (below == 0 || below <= rows.below(clear_of(t, led_since()), lost_rank)) return false;
  if (same_instant(t, next_prescribed_edge(run_.trajectory))) return true;
  constexpr double far_weaker = 0.1;
  rows.count_falling(now(), to.state, far_weaker);
  const double left = std::sqrt(rows.pivot(to.state, clear)), before = std::sqrt(rows.pivot(now(), clear));
  return left * to.at <= soon * run_.options.step * (before - left);
}
bool Stepper::Loop::time_ends_in_pose(const Probe& to) const {
  if (!to.report.ok() || to.report.weak_end) return to.report.weak_end;
  return part_end_ == target_ && (edge_ || target_ >= until_) && ends_in_pose(to);
}

// The motion across the pose in which this step ends: of what drives alone lead there, as far back as that is
// smooth, with what is free beside it as it goes on from the present state; or of all of it. From states
// before the pose alone where it is not gone through.
std::optional<AroundPose> Stepper::Loop::around_pose(double t, bool led, Samples samples) const {
  constexpr double shortest = 0.1;                  // of a step
  constexpr double to_rest = 1e-6, enough = 1e-11;  // of the structure's size
  const bool through = samples == Samples::around, rests = samples == Samples::to_rest;
  const double step = run_.options.step;
  const State from = clear_of(t, led ? led_since() : smooth_since());
  if (!(t - from.t > shortest * step)) return {};
  std::vector<Index> free;
  if (led) free = free_coordinates(system(), from);
  if (std::ssize(free) == system().solved_coordinates()) return {};
  const std::shared_ptr<const Model> smooth = smooth_model(now().t);
  const auto integrator = fresh_integrator(*find_method(run_.options.method), smooth->system);
  const double size = reference_length(base_->structure);
  double least = (rests ? to_rest : agreed) * size;
  std::optional<AroundPose> best;
  for (const double share : {1.0, 0.87, 0.73, 0.61, 0.5, 0.42, 0.36, 0.3, 0.25}) {
    if (share < 1 && !rests) break;
    const int before = rests ? before_rest : before_it;
    const double apart = share * (t - from.t) / before;
    std::vector<double> lengths = lengths_around(t, apart, from.t, 0, before);
    const double last = rests ? t - apart : t;  // a nearer one has too few digits
    if (!through) std::erase_if(lengths, [&](double length) { return from.t + length > last; });
    AroundPose out{smooth, {from, lengths, steps_of(*integrator, step)}, free, apart, {}, led};
    const AcrossPose& across = out.across;
    State &there = out.there, fewer;
    const auto moved = [&](State& state) { return across.move_free(smooth->system, free, now(), state); };
    const auto as_there = [&](State& state) {
      state.z(free) = there.z(free), state.w(free) = there.w(free);
      return true;
    };
    if (!across.at(system(), t, there, moved, !through, rests ? 12 : 9)) continue;
    // But for where others lie beside another pose, or at a dead centre, to which rods turn by the root of
    // the way that is left.
    if (!across.at(system(), t, fewer, as_there, !through, rests ? 10 : 7)) continue;
    double off = (there.z - fewer.z).lpNorm<Eigen::Infinity>();
    if (!rests) off = std::max(off, step * (there.w - fewer.w).lpNorm<Eigen::Infinity>());
    if (off <= least) least = out.off = off, best = std::move(out);
    if (least <= enough * size) break;
  }
  if (!best) return best;
  if (!free.empty()) {
    FreeMotion motion(system(), free);
    if (motion.rows_below(best->there, lost_rank) > motion.rows_below(from, lost_rank)) return {};
  }
  if (system().followed_angles() > 0) system().at(now()).count_on(best->there);
  return best;
}

// As time has an edge in that pose, or the run its end: a step to it says nothing of the weak modes, and no
// step sets out from it. But what leads there passes the pose as smoothly as if nothing began or ended in it;
// so does what leads out of it, if it had come from before.
std::optional<AroundPose> Stepper::Loop::end_in_pose(Probe& to, double h, const VectorXd& lambda) {
  const double t = now().t + h;
  const VectorXd rests = resting_.empty() ? find_resting(t) : VectorXd();
  const bool slows = rests.size() > 0 && !resting_.empty();
  std::optional<AroundPose> around;
  if (!slows) around = around_pose(t, true, Samples::around);
  if (!around) around = around_pose(t, true, slows ? Samples::to_rest : Samples::before);
  if (!around) around = around_pose(t, false, slows ? Samples::to_rest : Samples::around);
  if (!around) return {};
  State& there = around->there;
  if (slows) there.w = (rests.array() > 0).select(0.0, there.w);
  there.lambda = lambda.size() > 0
                     ? lambda
                     : multipliers_there(around->smooth->system, around->across, around->free, there);
  const auto& solved = around->across.solved();
  const auto before =
      std::ranges::find_if(solved, [&](const State& s) { return s.t > t - (before_it - 1) * around->apart; });
  InPose pose{.t = t, .apart = around->apart, .before = t - before->t, .angles = before->angles};
  pose.led = around->led;
  for (VectorXd* x : {&pose.q, &pose.v, &pose.v_there}) x->resize(system().coordinates());
  system().expand(before->z, pose.q);
  system().expand_rate(before->w, pose.v);
  system().expand_rate(there.w, pose.v_there);
  in_pose_ = std::move(pose);
  to.at = h, to.state = std::move(there), to.report = {.singular_event = true};
  integrator_->restart();
  return around;
}

// So near a flat pose in which drives come to rest for good steps are of rounding: it is gone there at once.
bool Stepper::Loop::goes_flat(Probe& to, double& h) {
  constexpr double soon = 1e-2;   // of the structure's size, of a drive's row
  constexpr double still = 1e-9;  // of a drive's row's length, in a step
  constexpr double near = stepping::singular_margin * stepping::singular_margin, flat = 1e-13;
  const double edge = system().drives().empty() ? until_ : grid_.next_edge(now().t);
  const bool slows = std::ranges::any_of(system().drives(), [&](const Drive& drive) {
    const double left = drive.scale * std::abs(drive.target(edge) - drive.target(now().t));
    return 0 < left && left < soon * reference_length(base_->structure) &&
           drive.scale * std::abs(drive.target.derivative(1, edge)) * run_.options.step <=
               still * system().constraint_lengths()[drive.row];
  });
  if (!slows || edge > until_ || in_pose(now().t)) return false;
  const double end = grid_.next(now().t, 2 * (edge - now().t)).t;
  if (!same_instant(end, next_prescribed_edge(run_.trajectory))) return false;
  WeakRows rows(system());
  const bool solved = to.report.ok() && !to.report.weak_end, again = in_pose_ && in_pose_->t > now().t;
  if (solved && !again && rows.below(to.state, near) <= rows.below(now(), near)) return false;
  Probe there{.state = now()};
  std::optional<AroundPose> around = end_in_pose(there, end - now().t);
  const bool other =
      around && !deployed_ && !deployment_.empty() && (crosses(there.state) || fold(there.state) <= margin_);
  const double most = agreed * reference_length(base_->structure);
  if (!around || other || (solved && around->off > most) || resting_.empty() ||
      rows.below(there.state, flat) <= rows.below(clear_of(edge, led_since()), flat))
    return in_pose_.reset(), resting_.clear(), false;
  led_way_ = [this, end = there.state, way = std::make_shared<AroundPose>(std::move(*around))](double t) {
    const AcrossPose& across = way->across;
    const System& smooth = way->smooth->system;
    State out;
    const auto moved = [&](State& state) { return across.move_free(smooth, way->free, now(), state); };
    if (!across.at(smooth, t, out, moved, across.solved().back().t < t)) return on_cubic(now(), end, t);
    if (system().followed_angles() > 0) system().at(now()).count_on(out);
    VectorXd acceleration(out.w.size());
    System followed = system();
    followed.follow(out);
    Index1(followed, true).evaluate(out, acceleration, out.lambda);
    return out;
  };
  part_end_ = end, h = there.at, to = std::move(there);
  return true;
}

// What drives alone lead and have brought to rest at a time, for good, is held from then on. Its coordinates.
VectorXd Stepper::Loop::find_resting(double t) {
  const double edge = next_prescribed_edge(run_.trajectory), h = run_.options.step;
  if (!same_instant(t, edge)) return {};
  const State from = clear_of(edge, led_since());
  VectorXd rests = resting_coordinates(system(), edge, h);
  rests(free_coordinates(system(), from)).setZero();
  if (!comes_to_rest(system(), rests, 0.5 * (from.t + edge), h)) return {};
  resting_ = nodes_at_rest(model(), rests, edge, h);
  std::erase_if(resting_, [this](int node) { return std::ranges::count(held_.nodes, node) > 0; });
  return rests;
}
void Stepper::Loop::rest_in_pose() {
  if (resting_.empty()) return;
  // Something else may pass such a pose of its own then.
  VectorXd nodes = VectorXd::Zero(system().coordinates()), held(now().z.size());
  for (const int node : resting_) nodes.segment<3>(3 * node).setOnes();
  system().reduce_sizes(nodes, held);
  std::vector<Index> others;
  for (Index i = 0; i < held.size(); ++i)
    if (!(held[i] > 0)) others.push_back(i);
  FreeMotion motion(system(), others);
  State before = now();
  if (in_pose(now().t)) before.z = system().reduce(in_pose_->q);
  const bool passes = motion.rows_below(now(), lost_rank) > motion.rows_below(before, lost_rank);
  if (!passes) in_pose_.reset();
  const std::size_t by_base = held_.by_base;
  hold_deployed();
  if (passes || std::isfinite(next_prescribed_edge(run_.trajectory))) hold_nodes(held_.nodes.size());
  if (held_.by_base > by_base) enter_held();
}

// The motion that goes on from a state in that pose, by what acts behind it.
bool Stepper::Loop::find_behind(const State& there) {
  constexpr int most = 8;
  constexpr double enough = 1e-13, at_all = 1e-7;  // of the structure's size
  const double t = there.t, d = in_pose_->before, step = run_.options.step,
               size = reference_length(base_->structure);
  const std::shared_ptr<const Model> smooth = smooth_model(t);
  const System& system = smooth->system;
  const auto integrator = fresh_integrator(*find_method(run_.options.method), system);
  State from = there;
  from.t = t - d;
  from.lambda.setZero(system.constraints());
  VectorXd v(system.coordinates());
  system.expand_rate(there.w, v);
  const VectorXd change = v - in_pose_->v_there;
  from.z = system.reduce(in_pose_->q - d * change);
  from.w = system.reduce_rate(in_pose_->v + change);
  from.angles = in_pose_->angles;
  project(system, from);
  std::vector<Index> free;
  if (in_pose_->led) free = free_coordinates(system, from);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most; ++i) {
    AcrossPose across(from, lengths_around(t, in_pose_->apart, from.t, t + 2 * step),
                      steps_of(*integrator, step));
    State found;
    const auto beside = [&](State& state) {
      state.z(free) = there.z(free), state.w(free) = there.w(free);
      return true;
    };
    if (!across.at(system, t, found, beside)) break;
    VectorXd z = there.z - found.z, w = there.w - found.w;
    z(free).setZero(), w(free).setZero();
    const double off = std::max(z.lpNorm<Eigen::Infinity>(), step * w.lpNorm<Eigen::Infinity>());
    if (!(off < least)) break;
    least = off;
    behind_ = BehindPose{std::move(across), free};
    if (off <= enough * size) break;
    from.w += w;
    from.z += z - d * w;
    project(system, from);
  }
  if (!(least <= at_all * size)) behind_.reset();
  return behind_.has_value();
}

bool Stepper::Loop::in_pose(double t) const {
  return in_pose_ && same_instant(std::min(in_pose_->t, t), std::max(in_pose_->t, t));
}

// A step out of it may end in it still: there the motion behind it goes on.
bool Stepper::Loop::stays_in_pose(Probe& to) {
  if (!to.report.ok() || !in_pose(now().t) || to.state.t <= now().t || (!behind_ && !find_behind(now())))
    return false;
  WeakRows rows(system());
  State before = to.state;
  before.z = system().reduce(in_pose_->q);
  if (!(rows.below(to.state, lost_rank) > rows.below(before, lost_rank))) return false;
  to.state.lambda = multipliers_there(system(), behind_->across, behind_->free, to.state);
  to.report.singular_event = true;
  in_pose_->before += to.state.t - in_pose_->t;
  in_pose_->t = to.state.t;
  system().expand_rate(to.state.w, in_pose_->v_there);
  return true;
}

// The grid's states on the way to where it is gone at once.
void Stepper::Loop::go_led_way(double t) {
  if (!led_way_ || !in_pose_ || !(in_pose_->t > now().t)) return;
  for (double next = grid_.next(now().t).t; next < before_jump(t) && next > now().t;
       next = grid_.next(now().t).t)
    go_on(led_way_(next), {});
}

// The end of a part of a step.
bool Stepper::Loop::accept(Probe& to, double t) {
  if (!to.report.ok()) return fail(may_cross(0) ? stepping::too_near : reason(to.report.status), true);
  to.state.t = t;
  go_led_way(t);
  stays_in_pose(to);
  have_begin_ = to.margins.size() > 0;
  if (have_begin_) begin_ = to;
  go_on(std::move(to.state), to.report);
  if (in_pose(now().t)) rest_in_pose();
  return true;
}

// The state behind what has changed at once, or began to act: in such a pose its equations say nothing.
void Stepper::Loop::append_behind(State state) {
  if (!in_pose(state.t) || !find_behind(state)) return append(std::move(state), StepReport{});
  state.lambda = multipliers_there(smooth_model(state.t)->system, behind_->across, behind_->free, state);
  append(std::move(state), {.singular_event = true});
}

// A step out of it, where the trajectory ends there.
bool Stepper::Loop::leave_pose(State& state, double h) {
  const bool ahead = in_pose_->t > now().t && !in_pose(now().t);
  if (state.t != now().t || ahead) return false;
  if (!in_pose(now().t) || (!behind_ && !find_behind(now()))) return in_pose_.reset(), false;
  const AcrossPose& across = behind_->across;
  const std::vector<Index>& free = behind_->free;
  State out;
  if (!across.at(system(), state.t + h, out,
                 [&](State& next) { return across.move_free(system(), free, now(), next); }))
    return false;
  if (system().followed_angles() > 0) system().at(now()).count_on(out);
  VectorXd acceleration(out.w.size());
  System followed = system();
  followed.follow(out);
  Index1 index1(followed, true);
  if (!index1.evaluate(out, acceleration, out.lambda)) return false;
  state = std::move(out);
  return true;
}

}  // namespace unfurl
