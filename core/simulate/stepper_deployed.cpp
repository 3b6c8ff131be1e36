// SPDX-License-Identifier: BSD-3-Clause
// A step of a run and the deployed pose.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/constraints/linear_rows.hpp"
#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/run_words.hpp"
#include "core/simulate/stepper_loop.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {
namespace {

bool same_state(const State& a, const State& b, double h) {
  constexpr double same = 1e-9, rates = 5e-6;
  const auto size = [](const VectorXd& x) { return x.lpNorm<Eigen::Infinity>(); };
  return std::abs(a.t - b.t) <= same * h && size(a.z - b.z) <= same * size(a.z) &&
         size(a.w - b.w) <= rates * size(a.w);
}

}  // namespace

// Could the fold angle reach zero within a time? Where sine * rate is constant, after sine / (2 rate). Not
// where a stop has just thrown it back.
bool Stepper::Loop::may_cross(double within) {
  if (deployment_.empty() || deployed_) return false;
  const double sine = fold(now());
  const double rate = remaining_rate(model(), now());
  const std::size_t last = run_.trajectory.size() - 1;
  const bool thrown_back = rate > 0 && last > 0 && run_.trajectory.time(last - 1) == now().t;
  return sine > 0 && ((sine <= stepping::singular_margin && !thrown_back) || sine + 2 * within * rate <= 0);
}

// A drive comes to its end in the deployed pose: from then on what is left is zero but for rounding, and for
// what the method drifts from the drive, and whose sign that has says nothing.
bool Stepper::Loop::arrives(const Probe& to) {
  constexpr double nothing = 1e-9, at_rest = 1e-2;  // rates are off by what a method makes of them
  if (!edge_ || part_end_ != target_ || margin_ > rounded_ || fold(now()) <= margin_) return false;
  const VectorXd& lengths = system().constraint_lengths();
  VectorXd phi(lengths.size());
  system().expand(to.state.z, q_);
  system().at(to.state).constraint(part_end_, q_, phi);
  const double drift = phi.cwiseQuotient(lengths).lpNorm<Eigen::Infinity>();
  return std::abs(fold(to.state)) <= std::max(nothing, rounded_) + 2 * drift &&
         std::abs(remaining_rate(model(), to.state)) * run_.options.step <= at_rest;
}

// The next time at which something begins or ends.
double Stepper::Loop::next_edge() const {
  for (const TimeEdge& edge : time_edges(model().structure, run_.options.step))
    if (edge.t > now().t) return edge.t;
  return std::numeric_limits<double>::infinity();
}

// The first state of the run from which on its motion is smooth: behind its last switch, impact and edge.
std::size_t Stepper::Loop::smooth_since() const {
  double edge = -std::numeric_limits<double>::infinity();
  for (const TimeEdge& e : time_edges(model().structure, run_.options.step))
    if (e.t <= now().t) edge = std::max(edge, e.t);
  std::size_t i = run_.trajectory.size() - 1;
  const auto begins = [&](std::size_t k) {
    const double before = run_.trajectory.time(k - 1), t = run_.trajectory.time(k);
    return same_instant(before, t) || &run_.trajectory.model(k - 1) != &model() ||
           (t >= edge && before < edge);
  };
  while (i > 0 && !begins(i)) --i;
  return i;
}

// The run goes on from a state that counted as the deployed pose.
void Stepper::Loop::come_nearer(const State& state) {
  constexpr double part = 0.1;
  if (deployment_.empty() || deployed_) return;
  if (const double left = fold(state); left > rounded_) margin_ = std::min(margin_, part * left);
}

// What begins or ends at an edge of time so shortly before the pose that the step that ends there counts as
// there, or cannot be solved, still comes before it.
bool Stepper::Loop::edge_comes_first(Probe& to, double h, std::optional<State>& event) {
  // From the pose, to be told from it, or for steps to be more than rounding.
  const double apart = rest_ahead_ ? stepping::singular_margin : 1e-8;
  if (!event || regular_ || !(event->t > next_edge())) return false;
  const std::vector<TimeEdge> edges = time_edges(model().structure, run_.options.step);
  const auto edge = edge_after(edges, now().t);
  const double t = edge->jump ? before_jump(edge->t) : edge->t;
  const std::size_t first = smooth_since();
  const std::shared_ptr<const Model> smooth = model_beside_pose(first);
  std::optional<State> there =
      locate_before_deployed(run_.trajectory, *smooth, *careful(*smooth), h, first, t);
  if (!there || !(fold(*there) > apart)) return false;
  to = {.at = t - now().t, .state = std::move(*there)};
  part_end_ = t;
  come_nearer(to.state);
  event.reset();
  return true;
}

// A step over the pose that another one ends short of; where none can be solved, to the pose.
Probe Stepper::Loop::beyond(const Probe& to, const State& event) {
  const double way = event.t - now().t;
  if (to.report.ok() && !led_way_)
    for (const double longer : {1.02, 1.1, 1.3}) {
      Probe past{.at = longer * way, .state = now()};
      if (now().t + past.at > next_edge()) break;
      if (past.report = fresh_integrator()->step(past.state, past.at); past.report.ok()) return past;
    }
  return {.at = way, .state = event};
}

// The present state, or one of the same motion that lies far off the pose ahead.
State Stepper::Loop::far_off(const Model& smooth, Integrator& integrator, double h) {
  if (!(fold(now()) > 0) || !(remaining_rate(model(), now()) < 0)) return now();
  return far_off_deployed(run_.trajectory, smooth, integrator, h, smooth_since());
}

// The end of a step over the pose that cannot be solved from the present state.
void Stepper::Loop::step_from_far_off(Probe& to, double h) {
  const std::shared_ptr<const Model> smooth = smooth_model(run_.trajectory.time(smooth_since()));
  const auto integrator = fresh_integrator(*find_method(run_.options.method), smooth->system);
  Probe end{.at = h, .state = far_off(*smooth, *integrator, h)};
  end.report = step_in_parts(*integrator, end.state, now().t + h - end.state.t,
                             [&](State& state, double length) { return integrator->step(state, length); });
  if (end.report.ok() && !end.report.weak_end) to = std::move(end);
}

// A step may get through to a singular pose, with coordinates to half of their digits and rates to none.
bool Stepper::Loop::singular_at(const State& state) {
  run_.trajectory.append(state, {});
  const bool singular = singular_at_end(run_.trajectory);
  run_.trajectory.pop_back();
  return singular;
}

std::unique_ptr<Integrator> Stepper::Loop::fresh_integrator(const Method& method,
                                                            const System& system) const {
  auto integrator = method.make(system, run_.options);
  if (contradictions_) integrator->expect_contradictions();
  return integrator;
}
std::unique_ptr<Integrator> Stepper::Loop::careful(const Model& model) const {
  const bool low_order = run_.options.method == "generalized_alpha";  // on a motion of its own
  const Method& method = low_order ? *find_method(run_.options.method) : careful_dvm();
  return fresh_integrator(method, model.system);
}

// By what is prescribed from a time on: what begins or ends there, or later, is nothing then.
std::shared_ptr<const Model> Stepper::Loop::smooth_model(double t) const {
  if (time_edges(model().structure, run_.options.step).empty()) return present_;
  Structure structure = pieces_at(model().structure, t);
  System system(structure, run_.options.eliminate_linear);
  return std::make_shared<const Model>(Model{std::move(structure), std::move(system)});
}

// The model for states next to the pose, which no others tell of where the motion is smooth from there on.
std::shared_ptr<const Model> Stepper::Loop::model_beside_pose(std::size_t first) {
  const bool nearby = first > 0 && fold(run_.trajectory.state(first)) < 1.1 * farthest_sample;
  return nearby ? smooth_model(run_.trajectory.time(first)) : present_;
}

// By shortened steps.
std::optional<State> Stepper::Loop::locate_near(double h, bool touched) {
  const std::size_t first = smooth_since();
  const std::shared_ptr<const Model> smooth = model_beside_pose(first);
  return locate_deployed(run_.trajectory, *smooth, *careful(*smooth), h, first, touched);
}

// The deployed pose that what remains touches, by a step that ends there or, where it is singular, by those
// next to it; nothing where it is not reached.
std::optional<State> Stepper::Loop::locate_touched(const Dip& dip, double h) {
  constexpr double reached = 1e-9;
  std::optional<State> event = now();
  regular_ = dip.solved && fresh_integrator()->step(*event, dip.length).ok() && !singular_at(*event);
  if (regular_) return event;
  event = locate_near(h, true);
  return event && fold(*event) <= reached && singular_at(*event) ? event : std::nullopt;
}

// Do drives alone say what remains? Found out where it matters, next to the pose.
bool Stepper::Loop::leads() {
  if (std::exchange(asked_, &system()) != &system()) leads_ = drives_lead_to_deployed(run_.trajectory);
  return leads_;
}

std::optional<State> Stepper::Loop::locate_led(double guess, double h) {
  const std::size_t last = run_.trajectory.size() - 1;
  for (std::size_t i = last; i > 0 && i + 4 > last; --i)  // this step may be cut short
    if (const double before = run_.trajectory.time(i) - run_.trajectory.time(i - 1);
        before < 2 * run_.options.step)  // or was none, but gone at once
      h = std::max(h, before);
  auto led = locate_driven(
      run_.trajectory, [this] { return fresh_integrator(); }, guess, h);
  resting_.clear(), led_way_ = nullptr, rest_ahead_ = false;
  if (!led) return std::nullopt;
  led_off_ = led->error;
  resting_ = std::move(led->held);
  led_way_ = std::move(led->before);
  rest_ahead_ = led_way_ && (run_.options.at_deployed != "pass" || !resting_.empty());
  return std::move(led->state);
}

std::optional<State> Stepper::Loop::locate(double h, double latest) {
  std::optional<State> reached = step_to_deployed(model(), *fresh_integrator(), now(), h, margin_);
  regular_ =
      reached && !singular_at(*reached) && !(leads() && !regular_when_deployed(run_.trajectory, *reached));
  if (regular_) return reached;
  std::optional<State> event = locate_near(h);
  if (!leads() && !event && reached) event = std::move(reached), regular_ = true;
  // So near the pose the motion at hand leads there.
  const double left = fold(now()), rate = remaining_rate(model(), now());
  if (!leads() && !event && left > 0 && left <= stepping::singular_margin && rate < 0) {
    event = now();
    drift(system(), *event, left / -rate);
  }
  if (leads() && !(event && regular_when_deployed(run_.trajectory, *event))) {
    // Where a drive goes on at speed both may be right, and multipliers are those of more poses.
    std::optional<State> led = locate_led(now().t, h);
    const bool passed = std::isinf(latest);  // and is there
    if (led ? !(event && same_state(*led, *event, h)) : !passed)
      event = std::move(led);
    else
      led_off_ = 0;
  }
  if (event && event->t > latest) event.reset();
  return event;
}

// How far into a step that its ends' cubic does not tell the pose is passed first, to come back from it or to
// stay, where the step's own polynomial leads near it.
std::optional<Dip> Stepper::Loop::dip_inside(const Probe& to) {
  State state;
  if (!deploys_regularly(model().structure) || fold(now()) <= margin_ ||
      !(off_cubic(to, 0.25, state) || off_cubic(to, 0.625, state)))
    return {};
  std::vector<double> left{fold(now()) - margin_};
  for (int k = 1; k < stepping::fine_parts; ++k) {
    inside(to, static_cast<double>(k) / stepping::fine_parts, state);
    left.push_back(fold(state) - margin_);
  }
  left.push_back(fold(to.state) - margin_);
  for (std::size_t k = 1; k < left.size(); ++k)
    if (left[k - 1] > 0 && left[k] <= 0 && !deployment_.is_passed(left[k - 1], left[k])) return {};
  const double near_zero = 0.1 * *std::ranges::max_element(left);
  const auto integrator = fresh_integrator();
  const auto solve = [&](std::size_t k, Probe& probe) {
    probe.at = to.at * static_cast<double>(k) / stepping::fine_parts;
    probe.state = now();
    integrator->restart();
    return k == 0 || integrator->step(probe.state, probe.at).ok();
  };
  for (std::size_t k = 1; k + 1 < left.size(); ++k) {
    if (!(left[k] < near_zero && left[k] < left[k - 1] && left[k] <= left[k + 1])) continue;
    Probe before, after;
    if (!solve(k - 1, before) || !solve(k + 1, after)) continue;
    if (fold(before.state) <= margin_) return Dip{before.at};
    if (fold(after.state) <= margin_) return Dip{after.at};
    const auto bottom = step_to_dip(
        model(), [this] { return fresh_integrator(); }, now(), after.state, after.at, rounded_, &before);
    if (bottom) return bottom;
  }
  return {};
}

// Where the pose is touched as a step ends, rounding says on which side of that.
std::optional<Dip> Stepper::Loop::dip_at_end(const Probe& to, double h) {
  if (!deploys_regularly(model().structure) || margin_ > rounded_ || fold(now()) <= rounded_ ||
      std::abs(fold(to.state)) > 2 * rounded_)
    return {};
  State behind = now();
  const double longer = 1.1 * h;
  if (behind.t + longer > next_edge() || !fresh_integrator()->step(behind, longer).ok()) return {};
  return step_to_dip(
      model(), [this] { return fresh_integrator(); }, now(), behind, longer, rounded_);
}

// Does something change in a step so near the pose that those behind it would be of rounding?
bool Stepper::Loop::strikes_nearby(const Probe& to) {
  if (!watched() || fold(to.state) > stepping::singular_margin) return false;
  Probe there;
  sides_.measure(model(), to.state, true, there);
  return there.margins.minCoeff() < -1;
}

// So near the pose steps, and what forces they have, are of rounding: where drives come to rest in it, it is
// gone there at once.
bool Stepper::Loop::goes_to_rest(double h, std::optional<State>& event) {
  const double edge = next_prescribed_edge(run_.trajectory);
  event.reset();
  if (edge <= grid_.end()) event = locate_led(edge, h);
  if (!rest_ahead_) event.reset();
  regular_ = regular_ && !rest_ahead_;
  return rest_ahead_;
}

// What a drive leads may come to rest in the deployed pose: near is not there.
bool Stepper::Loop::rests_deployed(const Probe& to, double h, std::optional<State>& event) {
  const bool near = fold(now()) > stepping::singular_margin && fold(to.state) <= stepping::singular_margin,
             nearby = near || (margin_ > rounded_ && crosses(to.state)) || strikes_nearby(to);
  if (nearby && !system().drives().empty()) {
    const bool regular = regular_when_deployed(run_.trajectory, to.state);
    if (!regular && leads() && goes_to_rest(h, event)) return true;
    if (regular || leads()) margin_ = stepping::deployed_already;
  }
  if (!arrives(to)) return false;
  if (leads() && !regular_when_deployed(run_.trajectory, to.state)) {
    event = locate_led(part_end_, h);
    if (!event) led_off_ = std::numeric_limits<double>::infinity();
    if (run_.options.at_deployed == "pass" && resting_.empty()) event.reset();
  }
  regular_ = !event;
  if (event) return true;
  event = to.state;
  event->t = part_end_;
  return true;
}

// The deployed pose where this step reaches it; a step that failed without that is tried in parts. False
// where the run ends.
bool Stepper::Loop::find_deployed(Probe& to, double& h, std::optional<State>& event) {
  led_off_ = 0;
  if (rest_ahead_ && !deployed_ && goes_to_rest(h, event)) return true;
  if (!to.report.ok() && may_cross(1.5 * h) && !leads()) event = locate(h, now().t + 1.05 * h);
  if (!event && !to.report.ok()) {
    to.state = now();
    to.report = step_in_parts(*integrator_, to.state, h, [this](State& state, double length) {
      return take_step(*integrator_, state, length);
    });
    if (to.report.weak_end) settle_in_pose(to, h);
  }
  const bool unsure = !to.report.ok() || to.report.weak_end;
  if (unsure && may_cross(stepping::near_deployed * h) && leads()) step_over(to, h);
  if (!event && !to.report.ok() && may_cross(stepping::near_deployed * h))
    event = locate(h, now().t + 2 * stepping::near_deployed * h);
  if (edge_comes_first(to, h, event)) return true;
  // No step that ends so near the pose can be solved: the run's end lies on the way there.
  if (event && event->t > grid_.end()) {
    to.state = on_cubic(now(), *event, std::min(now().t + h, grid_.end()));
    project(system(), to.state);
    to.report = {};
    return event.reset(), true;
  }
  if (event || !to.report.ok() || deployment_.empty() || deployed_) return true;
  if (rests_deployed(to, h, event)) return true;
  std::optional<Dip> dip = dip_inside(to);
  if (!dip) dip = dip_at_end(to, h);
  if (!dip && !crosses(to.state)) {
    dip = step_to_dip(
        model(), [this] { return fresh_integrator(); }, now(), to.state, h, rounded_);
    if (!dip) return true;
  }
  touched_ = dip && dip->touches;
  event = touched_ ? locate_touched(*dip, h)
                   : locate(dip ? dip->length : h, std::numeric_limits<double>::infinity());
  if (!event && touched_ && !dip->solved) return true;
  if (edge_comes_first(to, h, event)) return true;
  if (event && event->t > grid_.end()) return event.reset(), true;
  return event || fail("the deployed pose was passed but its time could not be located");
}

// By how much the parts of a structure that is deployed on the mean are off that, as a share of its size.
double Stepper::Loop::uneven(const State& event) {
  const std::vector<LinearForm>& parts = deployment_.parts.empty() ? deployment_.latches : deployment_.parts;
  if (parts.size() < 2) return 0.0;
  system().expand(event.z, q_);
  double most = 0.0;
  for (const LinearForm& part : parts) most = std::max(most, std::abs(part(q_)));
  return most / reference_length(base_->structure);
}

// Before the deployed pose (-1), behind it (1), or at it, where friction turns round that is none of it. What
// is passed neither in that pose nor on the way there, but for rounding, comes behind it; the time of the
// pose may be later than that of the step through it.
int Stepper::Loop::side(const Crossing& crossing, const State& event, double h) {
  const double from = crossing.probe.at, left = event.t - now().t - from;
  if (sides_.only_friction(crossing.which))
    return std::abs(left) < stepping::straight * h ? 0 : (left > 0 ? -1 : 1);
  if (left <= 0) return 1;
  const auto is_passed = [&](const State& state) {
    Probe there;
    sides_.measure(model(), state, true, there);
    return std::ranges::any_of(crossing.which,
                               [&](std::size_t i) { return there.margins[static_cast<Index>(i)] < -1; });
  };
  if (is_passed(event)) return -1;
  const auto integrator = fresh_integrator();
  for (const double share : {0.5, 0.25, 0.75}) {
    State between = now();
    integrator->restart();
    if (integrator->step(between, from + share * left).ok() && fold(between) > 0 && is_passed(between))
      return -1;
  }
  return 1;
}

// Next to a flat pose steps are of rounding, and what was found instead may be no better.
void Stepper::Loop::tell_led_off(double t) {
  constexpr double told = 1e-6;
  if (!(led_off_ > told * reference_length(base_->structure))) return;
  char off[64] = "the state is that of a step that ends next to it";
  if (std::isfinite(led_off_)) std::snprintf(off, sizeof off, "the state may be off by %.2g m", led_off_);
  run_.warnings.push_back("at t = " + seconds(t) +
                          ": the deployed pose to which a drive leads was not found well, and " + off +
                          ": try a smaller solver.step");
}

bool Stepper::Loop::deployed(State& event, Probe& to, double h) {
  constexpr double even = 1e-3;
  deployed_ = true;
  run_.events.push_back({.name = "deployed", .t = event.t, .kind = "deployed"});
  tell_led_off(event.t);
  look_for_turn(event);
  const double off = uneven(event);
  if (off > even) {
    char share[32];
    std::snprintf(share, sizeof share, "%.2g", 100 * off);
    const std::string how = "is deployed on the mean alone: single parts are off by up to " +
                            std::string(share) + " % of its size";
    if (run_.options.at_deployed == "latch" && !latch_gives(base_->structure))
      return fail("the structure " + how +
                  ", and latches that close at once would move them there; deploy its parts alike, or take "
                  "solver.at_deployed = \"stop\"");
    run_.warnings.push_back("at t = " + seconds(event.t) + ": the structure " + how);
  }
  if (run_.options.at_deployed == "pass" && resting_.empty()) {
    const bool in_it = time_ends_in_pose(to) || (!regular_ && std::abs(fold(to.state)) < margin_);
    if ((!to.report.ok() || in_it) && !step_over(to, h))
      end_in_pose(to, h, regular_ ? VectorXd() : event.lambda);
    if (!to.report.ok()) step_from_far_off(to, h);
    if (watched() && to.report.ok())
      if (auto crossing = find_crossing(to, h); crossing && side(*crossing, event, h) > 0) {
        run_.events.back().t = std::min(event.t, now().t + crossing->probe.at);
        return go_to(std::move(*crossing));
      }
    return accept(to, part_end_);
  }
  project(system(), event);
  while (run_.trajectory.size() > std::max<std::size_t>(1, new_) && run_.trajectory.end_time() >= event.t)
    run_.trajectory.pop_back();
  regular_ = regular_ || regular_when_deployed(run_.trajectory, event);
  const bool goes_on = run_.options.at_deployed == "pass";
  if (Probe there{.state = now()}; goes_on) end_in_pose(there, event.t - now().t, event.lambda);
  go_on(std::move(event), StepReport{.singular_event = !regular_});
  if (run_.options.at_deployed == "latch") return latch();
  if (run_.options.at_deployed == "stop") return run_.status = RunStatus::deployed, false;
  return rest_in_pose(), true;
}

// Lock the structure and go on with it: two states at this time, before and after the impulse. What rests
// on a stop may leave it, then and later.
bool Stepper::Loop::latch() {
  std::vector<bool> pulled;
  for (std::size_t i = 0; i < sides_.stops().size(); ++i) pulled.push_back(sides_.active(i));
  if (sides_.any_reeled()) stop_reels();
  const bool gives = latch_gives(base_->structure);
  // What is touched in passing is a dead centre of the measure, which holding it does not hold.
  VectorXd v(system().coordinates());
  system().expand_rate(now().w, v);
  constexpr double still = 1e-6;  // of the structure, in a step
  if (touched_ && !gives &&
      v.lpNorm<Eigen::Infinity>() * run_.options.step > still * reference_length(base_->structure))
    return fail(
        "a latch cannot hold the structure in a pose in which what tells it is deployed passes its largest "
        "or least value; give the latch a stiffness (forces, kind = \"latch\"), or tell the pose by another "
        "measure");
  if (gives && singular_at_end(run_.trajectory))
    return fail("a latch that gives cannot hold this deployed pose, in which the constraints lose rank");
  base_ = latched_model(*base_, run_.options.eliminate_linear);
  latched_ = true;
  held_.latched = held_.by_base;
  if (!resting_.empty()) hold_deployed();
  const Handover locked = hand_over(model(), now(), *base_);
  ModeChange change{.state = locked.state};
  if (!sides_.empty()) change = modes_after(change.state);
  if (!change.failure.empty()) return fail(change.failure);
  record(change);
  for (std::size_t i = 0; i < pulled.size(); ++i)  // winches have stopped
    if (sides_.stops()[i].reeled && sides_.active(i) != pulled[i] && !change.strikes(i))
      std::ranges::copy(sides_.events(i, change.state.t), std::back_inserter(run_.events));
  for (const std::size_t i : change.turned)
    if (sides_.is_cable(i) || sides_.is_motor(i))
      std::ranges::copy(sides_.events(i, change.state.t), std::back_inserter(run_.events));
  set_model(sides_.any_active() ? sides_.model(*base_) : base_, change.state, true);
  double taken = locked.energy_lost;
  for (const ModeChange::Impact& impact : change.impacts)
    if (impact.held && sides_.active(impact.stop)) taken += impact.energy_lost;  // pressed on it by the latch
  taken *= run_.trajectory.structure().sectors;
  run_.events.push_back(
      {.name = "latched", .t = now().t, .energy_lost = gives ? 0.0 : taken, .kind = "latch"});
  return true;
}

}  // namespace unfurl
