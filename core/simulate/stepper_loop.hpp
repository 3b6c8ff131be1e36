// SPDX-License-Identifier: BSD-3-Clause
// What a Stepper is made of; for stepper.cpp and stepper_archive.cpp alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/integrators/dvm.hpp"
#include "core/integrators/integrator.hpp"
#include "core/simulate/across_pose.hpp"
#include "core/simulate/dead_centres.hpp"
#include "core/simulate/deployed_event.hpp"
#include "core/simulate/drift.hpp"
#include "core/simulate/driven_deployed.hpp"
#include "core/simulate/held_nodes.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/latch.hpp"
#include "core/simulate/measured_event.hpp"
#include "core/simulate/mode_change.hpp"
#include "core/simulate/one_sided.hpp"
#include "core/simulate/run_words.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/simulate/step_control.hpp"
#include "core/simulate/step_in_parts.hpp"
#include "core/simulate/stepper.hpp"
#include "core/simulate/time_grid.hpp"
#include "core/simulate/turned_frame.hpp"
#include "core/simulate/turning_back.hpp"
#include "core/structure/node_positions.hpp"

namespace unfurl {
namespace stepping {

// A state whose sin(fold) is below this has lost digits to the singular deployed pose and counts as having
// reached it.
inline constexpr double singular_margin = 1e-4, deployed_already = 1e-12;
// Where more than this many switches, and twice as many for each stop and cable, come at one time, no order
// of them leads on: what touches is held. Where that is of no use either, the rest of the step is taken as it
// is.
inline constexpr int most_switches = 20;
inline constexpr double one_time = 1e-9;  // share of a step
inline constexpr long most_in_step = 50;  // times as many in one step, at whatever times
// Steps of the method are at least so long, as a share of solver.step: multipliers are noise over the step.
inline constexpr double shortest = 1e-7;
// So many steps before the deployed pose a failed step is put down to it.
inline constexpr double near_deployed = 5;
// Friction that turns round within this share of a step before the deployed pose is at it, where rods in line
// let angles without a sign turn round.
inline constexpr double straight = 1e-3;
// Parts of a step for the hints where margins dip between solved states.
inline constexpr int parts = 8;
// The same where the step covers a swing or so, of which eight stages follow one.
inline constexpr int fine_parts = 16;
// By so much of a way the cubic of a step's ends may be off the step's own polynomial.
inline constexpr double cubic_share = 0.01;

// Where a force falls to zero is located to this share of what it was in the step.
inline constexpr double located = 1e-9;
// So much of a step later what begins with nothing has a size, and has moved nothing yet.
inline constexpr double moment = 1e-6;

inline constexpr const char* too_near =
    "so near the deployed pose, where the constraints lose rank, the motion cannot be told from rounding";

}  // namespace stepping

class Stepper::Loop {
 public:
  Loop(Simulation& run, std::shared_ptr<const Model> model, double start)
      : run_(run),
        original_(std::move(model)),
        base_(original_),
        present_(original_),
        deployment_(run.trajectory.structure().deployment),
        rounded_(deployment_.rounded(node_positions(run.trajectory.structure()))),
        sides_(run.trajectory.structure(), run.options),
        turning_back_(run.trajectory.structure()),
        turned_(run.trajectory.structure()),
        start_(start),
        grid_(start, run.options, time_edges(run.trajectory.structure(), run.options.step)) {}

  void begin_run() {
    model_changed();
    if (deploys_regularly(original_->structure)) margin_ = stepping::deployed_already;
    if (!deployment_.empty())
      margin_ = fold(now()) > rounded_ ? std::min(margin_, 0.1 * fold(now())) : std::max(margin_, rounded_);
    if (!sides_.empty()) find_first_modes();
  }

  bool step() { return !ended_ && now().t < grid_.end() && go(next_target()); }

  bool advance_to(double t, const std::function<bool()>& cancelled) {
    until_ = std::min(t, grid_.end());
    while (!ended_ && now().t < until_ && !(cancelled && cancelled())) {
      TimeGrid::Target target = next_target();
      if (target.t > until_) target = {until_, until_ - now().t};
      if (!go(target)) return false;
    }
    until_ = grid_.end();
    return !ended_;
  }

  void set_force(int node, const Vec3& force);
  void end() { ended_ = true; }
  std::size_t first_new() const { return new_; }
  double start() const { return start_; }
  double swing() const { return swing_; }

  Window take_window(std::size_t around);
  void archive(Archive& archive);
  std::function<void(const State&, const StepReport&)> on_step;

 private:
  const Model& model() const { return run_.trajectory.last_model(); }
  const System& system() const { return model().system; }
  const State& now() const { return run_.trajectory.state(run_.trajectory.size() - 1); }
  std::unique_ptr<Integrator> fresh_integrator() const {
    return fresh_integrator(*find_method(run_.options.method), system());
  }
  std::unique_ptr<Integrator> fresh_integrator(const Method& method, const System& system) const;

  void begin_anew_behind_part();

  TimeGrid::Target next_target() {
    begin_anew_behind_part();
    if (!run_.options.adaptive) return grid_.next(now().t);
    const double wanted = control().next(now());
    note_swing();
    return grid_.next(now().t, wanted);
  }

  StepControl& control();
  void note_swing();
  void plan_anew();

  bool go(const TimeGrid::Target& target) try {
    target_ = target.t;
    new_motion_ = false;
    edge_ = target.edge;
    pushed_.reset();
    double h = target.h;
    in_step_ = halved_ = 0;
    while (now().t < target_) {
      double short_of = integrator_->longest_step(now(), h, std::max(h, run_.options.step));
      if (std::exchange(lost_side_, false)) short_of = std::min(short_of, on_side_until_ - now().t);
      part_end_ = short_of < h ? now().t + short_of : target_;
      if (!part(short_of)) return ended_ = true, false;
      if (std::exchange(new_motion_, false) && run_.options.adaptive) plan_anew();
      h = target_ - now().t;
    }
    if (now().t < target.t) return true;
    if (target.edge) integrator_->restart();
    const bool over = !target.jumps || now().t > target.jump;  // at rest in a flat pose at once
    return over || jump(target.jump) || (ended_ = true, false);
  } catch (const CannotFactorise& error) {
    return ended_ = true, fail(error.what());
  }

  // The rest of the step, of size h, or what comes before the first event on it. False where the run ends.
  bool part(double h) {
    if (watched())
      if (const std::vector<std::size_t> over = passed(); !over.empty()) return act(over);
    resting_.clear(), led_way_ = nullptr;
    Probe to{.at = h, .state = now()};
    to.report = take_step(*integrator_, to.state, h);
    const bool beside = stays_beside(to);
    if (lost_side_) return true;
    const bool solved = to.report.ok() && !to.report.weak_end;
    if (gives_way(to)) return true;
    if (to.report.weak_end) settle_in_pose(to, h);
    std::optional<State> event;
    if (!find_deployed(to, h, event)) return false;
    const bool flat = !event && !beside && goes_flat(to, h);
    const bool poses = !event && !flat && (!to.report.ok() || (!beside && time_ends_in_pose(to)));
    if (poses && !step_over(to, h)) end_in_pose(to, h);
    if (!event && !flat && (poses || !solved)) stays_beside(to);
    if (lost_side_) return true;
    if (watched() && (event || to.report.ok())) {
      Probe past;
      const bool short_of = event && (led_way_ || !to.report.ok() || event->t > now().t + to.at);
      if (!event && !flat) led_way_ = nullptr;
      if (short_of) past = beyond(to, *event);
      auto crossing = find_crossing(short_of ? past : to, h);
      if (crossing && (!event || side(*crossing, *event, h) < 0)) return go_to(std::move(*crossing));
    }
    if (event) return deployed(*event, to, h);
    return accept(to, part_end_);
  }

  bool accept(Probe& to, double t);

  // What is said of waves that a step does not resolve holds for parts of steps behind it too: they resolve
  // them, but not what they came as.
  void go_on(State state, const StepReport& report) {
    if (const VectorXd& doubt = now().tension_error;
        doubt.size() > 0 && state.t - now().t < 0.99 * run_.options.step)
      state.tension_error =
          state.tension_error.size() > 0 ? state.tension_error.cwiseMax(doubt).eval() : doubt;
    std::ranges::move(turning_back_.between(system(), now(), state), std::back_inserter(run_.warnings));
    constexpr long first_steps = 64, every = 8;
    if (run_.steps < first_steps || run_.steps % every == 0) look_for_turn(state);
    append(std::move(state), report);
    ++run_.steps;
  }

  void look_for_turn(const State& state) {
    if (std::string told = turned_.at(system(), state); !told.empty())
      run_.warnings.push_back(std::move(told));
  }

  void append(State state, const StepReport& report) {
    run_.trajectory.append(std::move(state), report);
    behind_.reset();
    if (on_step) on_step(now(), report);
  }

  // What follows is no continuation of the states before.
  void append_after_impulse(State state) {
    append_behind(std::move(state));
    integrator_->restart();
    have_begin_ = false;
    new_motion_ = true;
  }

  bool fail(const std::string& why, bool in_a_step = false) {
    run_.status = RunStatus::failed;
    const bool at_stop = in_a_step && !run_.events.empty() &&
                         (run_.events.back().kind == "contact" || run_.events.back().energy_lost > 0) &&
                         run_.events.back().t == now().t && singular_at_end(run_.trajectory);
    run_.message =
        "at t = " + seconds(now().t) + ": " + why +
        (at_stop ? beside_a_stop : cure(model(), now(), latched_, in_a_step ? run_.options.step : 0.0));
    return false;
  }

  bool jump(double t);

  // --- steps ---

  StepReport take_step(Integrator& integrator, State& state, double h) {
    if (h < stepping::shortest * run_.options.step) {
      StepReport drifted = drift(system(), state, h);
      drifted.singular_event = in_pose_ && same_instant(in_pose_->t, state.t);
      return drifted;
    }
    if (in_pose_ && leave_pose(state, h)) return {};
    if (contradictions_) integrator.expect_contradictions();
    const StepReport report = integrator.step(state, h);
    run_.newton_iterations += report.newton_iterations;
    run_.factorisations += report.factorisations;
    contradictions_ = contradictions_ || report.contradictions;
    return report;
  }

  // --- stops and cables ---

  bool watched() const { return !sides_.empty() && now().t >= unwatched_until_; }

  // Margins of the present state, those of the last accepted one where they still hold.
  void begin() {
    if (have_begin_ && !(begin_.margins.minCoeff() < 0) && !sides_.any_leaving()) return;
    sides_.touch(system(), now());
    sides_.measure(model(), now(), true, begin_);
    have_begin_ = true;
  }

  // What has no margin left at the present state.
  std::vector<std::size_t> passed() {
    begin();
    std::vector<std::size_t> over;
    for (Index i = 0; i < begin_.margins.size(); ++i)
      if (begin_.margins[i] < -1) over.push_back(static_cast<std::size_t>(i));
    return over;
  }

  int side(const Crossing& crossing, const State& event, double h);
  std::optional<Crossing> find_crossing(Probe& to, double h);
  MatrixXd between(const Probe& to, bool cut_off);
  bool inside(const Probe& to, double share, State& state);
  // Of the fastest coordinate, by its rates at the step's ends.
  double fastest_way(const Probe& to) const {
    return to.at * std::max(now().w.lpNorm<Eigen::Infinity>(), to.state.w.lpNorm<Eigen::Infinity>());
  }
  bool off_cubic(const Probe& to, double share, State& state);
  bool leaves_cubic(const Probe& to, const MatrixXd& margins);
  void warn_of_long_step(const Probe& to, const VectorXd& off, const VectorXd& fastest);

  bool go_to(Crossing crossing);
  void settle_in_pose(Probe& to, double h);

  // What comes of it that these have crossed, now; `left`: Crossing's. False where the run ends.
  bool act(const std::vector<std::size_t>& which, const VectorXd& left = {});

  bool rests_from_start();
  void find_first_modes();

  State in_base(const State& state) const { return in_coordinates(system(), state, base_->system); }

  ModeChange modes_after(const State& state, const std::vector<std::size_t>& which = {},
                         const VectorXd& left = {}, double later = 0.0) {
    sides_.weigh(model(), now());
    return change_modes(sides_, *base_, state, which, left, later);
  }

  // Goes on in the modes that were found. False where there are none.
  bool apply(const ModeChange& change) {
    if (!change.failure.empty()) return fail(change.failure);
    record(change);
    for (const std::size_t i : change.turned)
      if (sides_.is_cable(i) && sides_.active(i) && !run_.options.adaptive) warn_of_cable(i, change.state);
    for (const std::size_t i : change.turned)
      if (!change.strikes(i))
        std::ranges::copy(sides_.events(i, change.state.t), std::back_inserter(run_.events));
    if (change.changed)
      set_model(sides_.model(*base_), change.state, true);
    else if (!change.impacts.empty())
      append_after_impulse(hand_over(*base_, change.state, model()).state);
    return true;
  }

  void record(const ModeChange& change) {
    for (const auto& [stop, energy_lost, held] : change.impacts) {
      if (held && sides_.active(stop)) continue;  // what held takes up speed: a drive's work
      Event event = sides_.events(stop, change.state.t).front();
      const bool cable = sides_.stops()[stop].reeled;  // that does not stretch
      if (!sides_.active(stop)) event.name = cable ? event.element + " pulls" : "stop " + event.element;
      event.kind = cable ? "taut" : "contact";
      event.energy_lost = energy_lost * run_.trajectory.structure().sectors;
      run_.events.push_back(std::move(event));
    }
  }

  void warn_of_cable(std::size_t i, const State& state);
  void warn_once(const char* what) {
    if (std::ranges::none_of(run_.warnings, [&](const std::string& w) { return w.ends_with(what); }))
      run_.warnings.push_back("at t = " + seconds(now().t) + what);
  }

  bool hold_what_touches() {
    std::vector<std::size_t> touched;
    for (std::size_t i = 0; i < sides_.stops().size(); ++i)
      if (!sides_.active(i) && sides_.touches(i, system(), now())) touched.push_back(i);
    if (!touched.empty()) warn_once(": impacts without end; what touches a stop is held");
    return apply(change_modes(sides_, *base_, in_base(now()), touched, {}, 0.0, true));
  }

  bool stop_watching();

  // Goes on from a state in the coordinates of the base with another model of the same structure.
  void set_model(const std::shared_ptr<const Model>& next, const State& from, bool handed_over) {
    enter(next, hand_over(*base_, from, *next).state, handed_over);
  }
  void enter(const std::shared_ptr<const Model>& next, State state, bool handed_over) {
    if (!handed_over) run_.trajectory.pop_back();  // the first state of all
    run_.trajectory.change_model(next);
    present_ = next;
    append_behind(std::move(state));
    model_changed();
  }

  void enter_pushed();
  void stop_reels();
  void forget();
  void archive_models(Archive& archive);
  void archive_states(Archive& archive);
  void archive_held(Archive& archive);

  void model_changed() {
    integrator_ = fresh_integrator();
    dead_centres_.emplace(system());
    probing_.reset();
    sides_.forget_model();
    have_begin_ = false;
    new_motion_ = true;
  }

  // --- the deployed pose ---

  double fold(const State& state) {
    q_.resize(system().coordinates());
    system().expand(state.z, q_);
    return deployment_.remaining(q_, state.angles);
  }
  bool crosses(const State& next) {
    if (deployment_.empty() || deployed_) return false;
    const double before = fold(now()), after = fold(next);
    return before > margin_ && after <= margin_ && deployment_.is_passed(before, after);
  }

  bool may_cross(double within);
  double next_edge() const;
  std::size_t smooth_since() const;
  bool edge_comes_first(Probe& to, double h, std::optional<State>& event);
  bool singular_at(const State& state);
  std::unique_ptr<Integrator> careful(const Model& model) const;
  std::shared_ptr<const Model> smooth_model(double t) const;
  std::shared_ptr<const Model> model_beside_pose(std::size_t first);
  std::optional<State> locate_near(double h, bool touched = false);
  std::optional<State> locate_touched(const Dip& dip, double h);
  State far_off(const Model& smooth, Integrator& integrator, double h);
  void step_from_far_off(Probe& to, double h);
  Probe beyond(const Probe& to, const State& event);
  void come_nearer(const State& state);
  std::optional<State> locate(double h, double latest);
  bool arrives(const Probe& to);
  std::optional<Dip> dip_inside(const Probe& to);
  std::optional<Dip> dip_at_end(const Probe& to, double h);
  bool leads();
  std::optional<State> locate_led(double guess, double h);
  bool goes_to_rest(double h, std::optional<State>& event);
  bool strikes_nearby(const Probe& to);
  bool rests_deployed(const Probe& to, double h, std::optional<State>& event);
  bool find_deployed(Probe& to, double& h, std::optional<State>& event);
  double uneven(const State& event);
  void tell_led_off(double t);
  bool deployed(State& event, Probe& to, double h);
  bool latch();
  void hold_deployed();
  void hold_nodes(std::size_t end);
  void enter_held();
  bool gives_way(Probe& to);
  bool stays_beside(Probe& to);
  bool step_over(Probe& to, double& h);
  std::size_t led_since() const;
  State clear_of(double t, std::size_t first) const;
  bool ends_in_pose(const Probe& to) const;
  bool time_ends_in_pose(const Probe& to) const;
  enum class Samples { around, before, to_rest };
  std::optional<AroundPose> around_pose(double t, bool led, Samples samples) const;
  std::optional<AroundPose> end_in_pose(Probe& to, double h, const VectorXd& lambda = {});
  bool goes_flat(Probe& to, double& h);
  void go_led_way(double t);
  bool in_pose(double t) const;
  bool stays_in_pose(Probe& to);
  VectorXd find_resting(double t);
  void rest_in_pose();
  bool leave_pose(State& state, double h);
  bool find_behind(const State& there);
  void append_behind(State state);

  Simulation& run_;
  std::shared_ptr<const Model> original_;  // at the start
  std::shared_ptr<const Model> base_;      // the model without what is held or pulls
  std::shared_ptr<const Model> present_;   // the last one of the trajectory
  const Deployment& deployment_;
  double rounded_;  // what of the way to the deployed pose is nothing
  OneSided sides_;
  TurningBack turning_back_;
  TurnedFrame turned_;
  double start_;
  TimeGrid grid_;
  double target_ = 0, part_end_ = 0;  // of the present step, and of what is solved of it at once
  double until_ = grid_.end();        // no step may go beyond it
  bool edge_ = false;                 // time has an edge at target_
  bool new_motion_ = false;           // rates or forces have jumped within the present step
  std::unique_ptr<Integrator> integrator_, probing_;
  std::optional<DeadCentres> dead_centres_;  // of the present model
  int halved_ = 0;                           // in the present step, to stay on their sides
  bool lost_side_ = false;                   // of one, by the last step, which is to end here at the latest:
  double on_side_until_ = 0;
  std::optional<StepControl> control_;
  const System* controlled_ = nullptr;
  Probe begin_;  // the present state
  bool have_begin_ = false;
  // What the first force that was set since the last step found.
  struct Pushed {
    State from;         // in coordinates of the base
    std::string sides;  // archived
    std::size_t states, events, warnings;
    double crowd_time;
    long crowd;
  };
  std::optional<Pushed> pushed_;
  double crowd_time_ = -std::numeric_limits<double>::infinity(), unwatched_until_ = crowd_time_;
  long crowd_ = 0, in_step_ = 0;  // switches at crowd_time_, and in the present step
  bool deployed_ = false, ended_ = false, regular_ = false, touched_ = false, rest_ahead_ = false;
  bool contradictions_ = false;                // told by a step's report
  double margin_ = stepping::singular_margin;  // a tenth of where the run began, if that is less
  const System* asked_ = nullptr;              // whose drives
  bool leads_ = false;                         // lead to the deployed pose
  HeldNodes held_;                             // by drives, for good
  std::vector<int> resting_;                   // nodes to be held in the pose at the end of this step
  std::function<State(double t)> led_way_;  // of the present step, to where drives come to rest in the pose
  double led_off_ = 0;                      // by how much the state there may be off [m]
  VectorXd q_;
  std::size_t new_ = 0, part_ = 0;    // first state that was not handed over, first of the present part
  double last_step_ = 0, swing_ = 0;  // of the control of steps: where that begins anew, Stepper's
  std::optional<InPose> in_pose_;
  std::optional<BehindPose> behind_;  // the motion from there on, as long as the trajectory ends there
  bool latched_ = false;
  std::string locked_sides_;  // what was held when a latch locked it; empty: nothing was
  double locked_at_ = 0;
};

}  // namespace unfurl
