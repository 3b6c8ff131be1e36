// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/path_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/integrators/index1.hpp"
#include "core/path/path_deployed.hpp"
#include "core/path/path_scope.hpp"
#include "core/path/path_time.hpp"
#include "core/path/path_watch.hpp"
#include "core/simulate/elastic_period.hpp"
#include "core/simulate/force_sizes.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/latch.hpp"
#include "core/simulate/run_words.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/simulate/stretched.hpp"
#include "core/simulate/time_grid.hpp"

namespace unfurl {
namespace {

constexpr long most_switches = 100;  // at one time; in one step as many as in the full model (stepping)
// Two solutions of one equation, next to a pose where it is nearly singular.
constexpr double same_equations = 1e-7, rounded_sum = 1e-12;
constexpr double beside = 1e-8;  // of a piece: there no rounding decides, and all else is as good as the same

class PathRun {
 public:
  PathRun(std::shared_ptr<const Model> model, const SolverOptions& options, const SimulationHooks& hooks,
          double nudge)
      : base_(std::move(model)),
        nudge_(nudge),
        options_(options),
        hooks_(hooks),
        path_(trace_path(base_)),
        sides_(base_->structure, options),
        watch_(base_->structure, sides_, options.step),
        edges_(time_edges(base_->structure, options.step)),
        grid_(0.0, options, edges_),
        poses_(base_->structure, options.step),
        run_{.trajectory = Trajectory(base_, closest_steps(options)), .options = options} {
    refuse_friction(sides_, base_->structure, options);
  }

  Simulation run() {
    begin();
    while (!ended_ && motion_.t() < grid_.end()) {
      if (hooks_.cancelled && hooks_.cancelled()) {
        run_.status = RunStatus::stopped;
        run_.message = "stopped by the user at t = " + seconds(motion_.t());
        break;
      }
      if (hooks_.progress) hooks_.progress(motion_.t() / grid_.end());
      resting_ ? rest() : move();
    }
    if (hooks_.progress && run_.status != RunStatus::stopped) hooks_.progress(1.0);
    run_.newton_iterations = motion_.iterations();
    return std::move(run_);
  }

 private:
  const Structure& structure() const { return base_->structure; }
  const Model& model() const { return run_.trajectory.last_model(); }
  const State& last() const { return run_.trajectory.state(run_.trajectory.size() - 1); }

  // --- start ---

  void begin() {
    InitialState start = initial_state(structure(), base_->system);
    run_.warnings = structure().notes;
    for (auto said : {velocity_warning(start, structure()), wave_step_warning(structure(), options_, true)})
      if (!said.empty()) run_.warnings.push_back(std::move(said));
    set_law(structure());
    VectorXd z, tangent, q(base_->system.coordinates());
    if (!path_->point(0.0, z, tangent)) throw PathRefused("no path leads on from the pose at the start");
    base_->system.expand_rate(start.state.w, q);
    const double v = tangent.dot(path_->system().mass() * path_->system().reduce_rate(q));
    path_->system().expand_rate(tangent, q);
    motion_.begin(0.0, nudge_ / q.lpNorm<Eigen::Infinity>(), v);
    if (const Constraint* drive = driven_row(structure())) {
      drive_ = {drive->target, drive_column_};
      motion_.prescribe(*law_, drive_);
    }
    run_.trajectory.append(std::move(start.state), StepReport{});
    compare_equations();
    watch_.begin(last(), base_->system);
    if (sides_.empty()) return;
    sides_.find_laws(base_->system, last());
    if (const std::size_t i = sides_.first_friction(); sides_.any_friction())
      watch_.friction_moves(i) ? choose_slip() : sides_.stand(i);
    tell_law();
    if (sides_.any_active()) change_model(sides_.model(*base_), true);
  }

  void set_law(const Structure& acting) {
    law_ = std::make_unique<PathLaw>(*path_, acting);
    watch_.watch(*law_);
    if (const Constraint* drive = driven_row(structure()))
      drive_column_ = law_->forces().add_measure(drive->measure);
    law_->tabulate();
    tell_law();
  }

  void tell_law() {
    for (std::size_t k = 0; k < law_->forces().cables().size(); ++k)
      law_->set_pulling(k, sides_.active(sides_.stops().size() + k));
    for (std::size_t k = 0; k < law_->forces().frictions().size(); ++k)
      law_->set_slip(k, sides_.slip(sides_.first_friction()));  // the only one, of all that act there
  }

  // The path's equation and all the structure's must say the same of the start and of a pose on the way from
  // it, at the start's speed and at one that is not zero: whatever the path has overlooked shows there.
  void compare_equations() {
    const PathPiece* piece = path_->piece(0);
    compare_equations(*piece, -1, motion_.v());
    if (drive_.there()) return;
    const double length = piece->b - piece->a;
    const double speed = std::sqrt(std::abs(law_->at(0.0, 0.0, 0.0).Q) * length) + std::abs(motion_.v());
    compare_equations(*piece, -1, speed);
    for (const double way : {-0.37, 0.61}) compare_equations(*piece, law_->known_place(*piece, way), speed);
    law_->look_from(0.0);
  }

  // At x in [-1, 1] of a piece, at the speed v; forces that balance leave rounding of their sizes.
  void compare_equations(const PathPiece& piece, double x, double v) {
    double s = 0.5 * (piece.a + piece.b) + 0.5 * x * (piece.b - piece.a);
    law_->look_from(s);
    if (!law_->pull_where_taut(s, v)) law_->pull_where_taut(s += beside * (piece.b - piece.a), v);
    const State state = state_at(0.0, s, v);
    const System followed = base_->system.at(last());
    Index1 index1(followed);
    VectorXd a(state.z.size()), lambda = VectorXd::Zero(base_->system.constraints());
    if (!index1.evaluate(0.0, state.z, state.w, a, lambda))
      throw PathRefused("the equations of motion have no solution at the start");
    VectorXd z, tangent, q(base_->system.coordinates());
    path_->point(s, z, tangent);
    const ScalarLaw::Value law = law_->at(s, v, 0.0);
    const VectorXd bend = v * v * piece.bend(x);
    const double along_path = drive_.there() ? driven_along(structure(), path_->system(), *law_, drive_, 0.0,
                                                            s, z, v * tangent, bend)
                                             : law.Q;
    double sum = law.scale + free_acceleration(followed, structure(), state, lambda) + v * v / path_->unit();
    path_->system().expand_rate(along_path * tangent + bend, q);
    const VectorXd in_model = base_->system.reduce_rate(q);
    const auto size = [&](const VectorXd& u) { return std::sqrt(u.dot(followed.mass() * u)); };
    if (!(size(a - in_model) <= same_equations * (size(a) + size(in_model)) + rounded_sum * sum))
      throw PathRefused("the equations of motion hold something that the path does not know");
  }

  // --- states ---

  State state_at(double t, double s, double v) const {
    VectorXd z, tangent;
    if (!path_->point(s, z, tangent)) throw PathRefused("the path ends at t = " + seconds(t));
    State out;
    out.t = t;
    const System& system = model().system;
    if (&system == &path_->system()) {
      out.z = std::move(z);
      out.w = v * tangent;
    } else {
      VectorXd q(system.coordinates());
      path_->system().expand(z, q);
      out.z = system.reduce(q);
      path_->system().expand_rate(v * tangent, q);
      out.w = system.reduce_rate(q);
    }
    out.lambda.setZero(system.constraints());
    if (system.followed_angles() > 0) {
      System followed = system.at(last());
      followed.count_on(out);
    }
    return out;
  }

  void append(State state, const StepReport& report = {}) {
    run_.trajectory.append(std::move(state), report);
  }

  void append_at(double t) {
    double s = motion_.s(), v = 0;
    if (!resting_) motion_.at(t, s, v);
    append(state_at(t, s, v));
    if (drive_.there() && poses_.singular_at(run_.trajectory, watch_, path_->unit(), s, v)) tell_forces(s, v);
  }

  // Of the last state, which a drive has led into a singular pose.
  void tell_forces(double s, double v) {
    State here = last();
    run_.trajectory.pop_back();
    here.lambda.setConstant(std::numeric_limits<double>::quiet_NaN());
    if (poses_.just_deployed())
      limit_here(here);
    else if (poses_.rests(drive_, here.t))
      poses_.limit_at_rest(model().system.at(last()), s, path_->unit(), law_->timed(), states_, here);
    poses_.tell_effort(*path_, *law_, drive_, s, v, here.t, model().system, here);
    append(std::move(here), {.singular_event = true});
  }
  void limit_here(State& event) const {
    limit_multipliers(model().system.at(last()), watch_, motion_, options_.step, states_, event);
  }

  // All times of the grid up to t.
  void append_grid(double until) {
    for (TimeGrid::Target next = grid_.next(last().t); next.t <= until && last().t < grid_.end();
         next = grid_.next(last().t)) {
      if (next.t > last().t) {
        append_unseen(next.t);
        append_at(next.t);
        ++run_.steps;
      }
      if (!next.jumps) continue;
      if (next.jump > until) return;
      append_at(next.jump);
    }
  }

  // States between the last one and one at t.
  void append_unseen(double until) {
    if (!resting_ && !drive_.there())
      for (const double t : motion_.unseen_between(*law_, last().t, until)) append_at(t), ++run_.steps;
  }

  // Where an event ended what could be solved at once.
  void append_here(bool counted) {
    if (!(motion_.t() > last().t)) return;
    tell_pull(last().t);
    append_unseen(motion_.t());
    append(state_at(motion_.t(), motion_.s(), motion_.v()));
    run_.steps += counted ? 1 : 0;
  }

  // A cable that pulls for less than a step: peaks are looked for between states.
  void tell_pull(double from) {
    if (run_.events.empty() || run_.events.back().t != from || run_.events.back().kind != "taut") return;
    const double h = (motion_.t() - from) / 8;
    for (int k = 1; k < 8; ++k) append_at(from + k * h);
  }

  double change_model(const std::shared_ptr<const Model>& next, bool instead = false) {
    Handover after = hand_over(model(), last(), *next);
    if (instead) run_.trajectory.pop_back();
    run_.trajectory.change_model(next);
    append(std::move(after.state));
    return after.energy_lost * structure().sectors;
  }

  double latest() const {
    if (!drive_.there()) {
      const double end = grid_.end();
      const auto edge = edge_after(edges_, motion_.t() * (1 + 1e-15) + 1e-15 * end);
      return edge != edges_.end() ? std::min(end, edge->t) : end;
    }
    const TimeGrid::Target next = grid_.next(motion_.t());
    return next.jumps ? next.jump : next.t;
  }

  void move() {
    const double from = motion_.t();
    motion_.advance(*law_, latest());
    const auto [t, which] =
        watch_.first_event(motion_, from, motion_.t(), drive_.there() && grid_.next(from).edge);
    if (which < 0) return append_grid(motion_.t());
    motion_.cut(t);
    append_grid(before(t));
    which == static_cast<int>(sides_.size()) ? deployed() : turn(static_cast<std::size_t>(which));
  }

  // The grid's times that lie before an event.
  static double before(double t) { return std::nextafter(t, 0.0); }

  // --- stops and cables ---

  void add_event(Event event, double taken) {
    event.energy_lost = taken;
    run_.events.push_back(std::move(event));
  }
  void add_events(std::size_t i, double t, double taken) {
    for (Event& event : sides_.events(i, t)) add_event(std::move(event), std::exchange(taken, 0.0));
  }
  void add_events(const std::vector<std::size_t>& laws) {
    for (const std::size_t k : laws) add_events(k, motion_.t(), 0.0);
  }
  Event impact(const StopSide& stop) const {
    return {.name = "stop " + stop.name, .t = motion_.t(), .kind = "contact", .element = stop.name};
  }

  void turn(std::size_t i) {
    if (motion_.t() > crowd_time_) crowd_time_ = motion_.t(), crowd_ = 0;
    if (motion_.t() >= step_end_) step_end_ = motion_.t() + options_.step, in_step_ = 0;
    if (++crowd_ > most_switches || ++in_step_ > 1000 * (20 + 2 * static_cast<long>(sides_.size())))
      throw PathRefused("at t = " + seconds(motion_.t()) + ": stops or cables switch without end");
    append_here(true);
    if (sides_.is_stop(i)) return strike(i);
    if (sides_.is_friction(i)) return slip_or_stick(i);
    sides_.set_active(i, !sides_.active(i));
    tell_law();
    const double taken = change_model(sides_.model(*base_));
    add_events(i, motion_.t(), taken);
  }

  void strike(std::size_t i) {
    for (std::size_t other = 0; other < sides_.stops().size(); ++other)
      if (other != i && watch_.meets(motion_, other))
        throw PathRefused("at t = " + seconds(motion_.t()) + ": two stops are met at once");
    const StopSide& stop = sides_.stops()[i];
    const double slope = watch_.gap_slope(i, motion_.s());
    const double approach = -slope * motion_.v();
    if (approach < 0) return;
    if (motion_.v() != 0)
      refuse_other_ways(sides_, i, model().system, state_at(motion_.t(), motion_.s(), motion_.v()));
    const double e = stop.restitution, pull = -pull_off(slope, motion_.t(), 0);
    if (sides_.impact_rests(i, approach) || (e < 1 && sides_.series_ends(i, e * approach, pull)))
      return stop_at(i, slope);
    const double taken = 0.5 * (1 - e * e) * motion_.v() * motion_.v();
    add_event(impact(stop), taken);
    motion_.set_speed(-e * motion_.v());
    append(state_at(motion_.t(), motion_.s(), motion_.v()));
  }

  // It comes to rest on stop i, or is stopped there and goes back at once.
  void stop_at(std::size_t i, double slope) {
    const double lost = 0.5 * motion_.v() * motion_.v();
    const bool from_start = run_.trajectory.size() == 1 && motion_.v() == 0;
    const std::vector<std::size_t> laws = stand_still();
    if (pull_off(slope, motion_.t(), rounded_sum) > 0) {
      add_event(impact(sides_.stops()[i]), lost);
      append(state_at(motion_.t(), motion_.s(), 0));
      if (!laws.empty()) change_model(sides_.model(*base_), true);
      return add_events(laws);
    }
    sides_.set_active(i, true);
    held_ = i;
    held_slope_ = slope;
    resting_ = true;
    const double taken = change_model(sides_.model(*base_), from_start);
    Event rests = sides_.events(i, motion_.t()).front();
    rests.kind = "contact";
    add_event(std::move(rests), taken);
    add_events(laws);
  }

  // What pulls it off a stop whose gap has this slope, less a share of what that is the sum of.
  double pull_off(double slope, double t, double share) const {
    const ScalarLaw::Value pull = law_->at(motion_.s(), 0.0, t);
    return slope * pull.Q - std::abs(slope) * share * pull.scale;
  }

  // Which cables are stretched and pull may jump with the rates: those that did.
  std::vector<std::size_t> stand_still() {
    const System& system = model().system;
    const State here = state_at(motion_.t(), motion_.s(), 0);
    const std::vector<std::size_t> laws = sides_.laws_left(system, here);
    for (const std::size_t k : laws) sides_.turn_law(k, system, here);
    motion_.set_speed(0);
    tell_law();
    return laws;
  }

  // Held by a stop until that would have to pull, by friction until that gives way, or locked until the end.
  void rest() {
    double until = grid_.end();
    const double now = motion_.t();
    if ((held_ || stuck_) && law_->timed()) {
      const auto pull = [&](double t) { return stuck_ ? excess(t) : pull_off(held_slope_, t, 1e-14); };
      until = first_time_above(pull, now, until, std::min(options_.step, (until - now) / 8), edges_);
    }
    append_grid(until < grid_.end() ? before(until) : until);
    motion_.rest(until);
    if ((!held_ && !stuck_) || until >= grid_.end()) return;
    // What jumps is no state of what held before it.
    const bool jumps = last().t < until && same_instant(last().t, until);
    append_here(!jumps);
    if (std::exchange(stuck_, false)) {
      resting_ = false;
      return slip_or_stick(sides_.first_friction(), jumps);
    }
    sides_.set_active(*held_, false);
    resting_ = false;
    change_model(sides_.model(*base_), jumps);
    add_events(*held_, until, 0.0);
    held_.reset();
  }

  // --- friction ---

  // What pulls where nothing moves, less what friction can hold of it: it slips where that is positive.
  double excess(double t) const {
    return std::abs(law_->at(motion_.s(), 0.0, t).Q) - law_->holding(motion_.s());
  }

  // The mode of the only friction, now: it follows the motion; at rest it sticks, or slips where it is
  // pulled.
  void choose_slip() {
    constexpr double still = 1e-6;  // of the speed that what acts makes in a step
    const std::size_t i = sides_.first_friction();
    const double slope = watch_.friction_slope(i, motion_.s()), v = motion_.v();
    for (std::size_t k = 0; k < law_->forces().frictions().size(); ++k) law_->set_slip(k, 0);
    const double pull = law_->at(motion_.s(), 0.0, motion_.t()).Q, most = law_->holding(motion_.s());
    if (std::abs(v) > still * options_.step * (std::abs(pull) + most)) {
      const int slip = sides_.slip(i);  // what it acts on turns while the motion goes on
      return sides_.set_slip(i, slip != 0 ? -slip : slope * v > 0 ? 1 : -1);
    }
    if (std::abs(pull) > most) return sides_.set_slip(i, slope * pull > 0 ? 1 : -1);
    sides_.stick(i, model().system, last());
    motion_.set_speed(0);
    resting_ = stuck_ = true;
  }

  void slip_or_stick(std::size_t i, bool jumps = false) {
    choose_slip();
    tell_law();
    change_model(sides_.model(*base_), jumps);
    add_events(i, motion_.t(), 0.0);
  }

  // --- the deployed pose ---

  void deployed() {
    watch_.deployed();
    const double t = motion_.t();
    run_.events.push_back({.name = "deployed", .t = t, .kind = "deployed"});
    if (options_.at_deployed == "pass") return append_grid(t);
    State event = state_at(t, motion_.s(), motion_.v());
    if (last().t >= t) run_.trajectory.pop_back();
    const bool regular = regular_when_deployed(run_.trajectory, event);
    if (!regular) {
      // States so near to a singular pose have lost digits; the time loop has none there either.
      while (run_.trajectory.size() > 1 && !watch_.clear(motion_, last().t))
        run_.trajectory.pop_back(), --run_.steps;
      limit_here(event);
      if (drive_.there())
        poses_.tell_effort(*path_, *law_, drive_, motion_.s(), motion_.v(), before(t), model().system, event);
    }
    append(std::move(event), StepReport{.singular_event = !regular});
    ++run_.steps;
    if (options_.at_deployed == "latch") return latch();
    run_.status = RunStatus::deployed;
    ended_ = true;
  }

  void latch() {
    if (drive_.there()) throw PathRefused("a drive goes on behind a latch");
    const bool gives = latch_gives(base_->structure);
    if (gives && singular_at_end(run_.trajectory))
      throw PathRefused("a latch that gives, in a deployed pose in which the constraints lose rank");
    base_ = latched_model(*base_, options_.eliminate_linear);
    const double speed = std::abs(motion_.v());
    add_events(gives ? std::vector<std::size_t>() : stand_still());
    const double impulse = change_model(sides_.any_active() ? sides_.model(*base_) : base_);
    run_.events.push_back(
        {.name = "latched", .t = motion_.t(), .energy_lost = gives ? 0.0 : impulse, .kind = "latch"});
    if (gives) return set_law(base_->structure);
    const VectorXd& w = last().w;
    if (std::sqrt(w.dot(model().system.mass() * w)) > 1e-6 * speed)
      throw PathRefused("what is latched in the deployed pose can still move");
    resting_ = true;
  }

  std::shared_ptr<const Model> base_;  // without what is held or pulls
  const double nudge_;                 // of the fastest coordinate, at the start
  const SolverOptions options_;
  const SimulationHooks& hooks_;
  std::shared_ptr<const Path> path_;
  OneSided sides_;
  PathWatch watch_;
  const std::vector<TimeEdge> edges_;
  TimeGrid grid_;
  DrivenPoses poses_;
  const StateOnPath states_ = [this](double t, double s, double v) { return state_at(t, s, v); };
  Simulation run_;
  std::unique_ptr<PathLaw> law_;
  PathMotion motion_;
  PathDrive drive_;
  Index drive_column_ = -1;
  std::optional<std::size_t> held_;
  double held_slope_ = 0;  // of the gap along the path
  double crowd_time_ = -1;
  double step_end_ = 0;
  long crowd_ = 0, in_step_ = 0;
  bool resting_ = false, stuck_ = false, ended_ = false;
};

}  // namespace

Simulation simulate_on_path(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                            const SimulationHooks& hooks, double nudge) {
  const double begin = thread_cpu_seconds();
  Simulation run = PathRun(model, with_steps_inside(options), hooks, nudge).run();
  run.cpu_s = thread_cpu_seconds() - begin;
  if (model->structure.quasi_static) add_stretch(run.trajectory);
  return run;
}

}  // namespace unfurl
