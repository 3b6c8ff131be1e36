#include "core/simulate/simulation.hpp"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>

#include "core/integrators/integrator.hpp"
#include "core/simulate/contact.hpp"
#include "core/simulate/deployed_event.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/latch.hpp"
#include "core/simulate/step_control.hpp"
#include "core/simulate/stops.hpp"
#include "core/simulate/time_grid.hpp"

namespace unfurl {
namespace {

// A state whose sin(fold) is below this has lost digits to the singular deployed pose and counts as having
// reached it.
constexpr double singular_margin = 1e-4;

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string seconds(double t) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g s", t);
  return text;
}

const char* reason(StepStatus status) {
  switch (status) {
    case StepStatus::converged:
      return "converged";
    case StepStatus::stalled:
      return "the Newton iteration did not converge to round-off";
    case StepStatus::diverged:
      return "the Newton matrix could not be factorised";
    case StepStatus::not_finite:
      return "the state is not finite any more";
  }
  return "";
}

class TimeLoop {
 public:
  TimeLoop(Simulation& run, const SimulationHooks& hooks)
      : run_(run),
        integrator_(fresh_integrator()),
        hooks_(hooks),
        deployment_(run.trajectory.structure().deployment),
        stops_(run.trajectory.structure()) {}

  void drive() {
    const SolverOptions& o = run_.options;
    const TimeGrid grid(now().t, o, time_edges(run_.trajectory.structure(), o.step));
    std::optional<StepControl> control;
    const System* controlled = nullptr;
    while (now().t < o.end_time) {
      if (o.adaptive && controlled != &system()) {  // the first step, or the model has changed
        controlled = &system();
        control.emplace(run_.trajectory.structure(), *controlled, o);
      }
      const TimeGrid::Target target =
          o.adaptive ? grid.next(now().t, control->next(now())) : grid.next(now().t);
      if (!go_on()) return;
      if (target.h > 0 && !advance_to(target.t, target.h)) return;
      if (target.edge) integrator_->restart();
      if (target.jumps) jump(target.jump);
    }
    report_progress(1.0);
  }

 private:
  const System& system() const { return run_.trajectory.last_model().system; }
  std::unique_ptr<Integrator> fresh_integrator() const {
    return find_method(run_.options.method)->make(system(), run_.options);
  }
  const State& now() const { return run_.trajectory.state(run_.trajectory.size() - 1); }

  bool go_on() {
    report_progress(run_.trajectory.end_time() / run_.options.end_time);
    if (!hooks_.cancelled || !hooks_.cancelled()) return true;
    run_.status = RunStatus::stopped;
    run_.message = "stopped by the user at t = " + seconds(run_.trajectory.end_time());
    return false;
  }

  // False where the run ends here.
  bool advance_to(double target) { return advance_to(target, target - now().t); }
  bool advance_to(double target, double h) {
    State next = now();
    StepReport report = step(next, h);
    std::optional<State> event;
    if (!report.ok() && may_cross(h)) event = locate(h, target + 0.05 * h);
    if (!event && !report.ok()) report = retry(next, h, report);
    if (!event && report.ok() && crosses(next)) {
      event = locate(h, std::numeric_limits<double>::infinity());
      if (!event) return fail("the deployed pose was passed but its time could not be located");
    }
    if (event) {
      deployed_ = true;
      run_.events.push_back({"deployed", event->t});
      if (run_.options.at_deployed == "stop") return finish_deployed(*event), false;
      if (run_.options.at_deployed == "latch") return latch(*event, target);
      if (!report.ok() || std::abs(fold(next)) < singular_margin) return step_over(target, h);
    }
    return accept(next, target, report);
  }

  // A drive's velocity jumps: what it drives is taken along by an impulse of the constraints.
  void jump(double t) {
    State before = now();
    before.t = t;
    Handover after = hand_over(run_.trajectory.last_model(), before, run_.trajectory.last_model());
    run_.trajectory.append(std::move(after.state), StepReport{});
    integrator_->restart();
  }

  bool fail(const std::string& why) {
    run_.status = RunStatus::failed;
    run_.message = "at t = " + seconds(now().t) + ": " + why;
    return false;
  }

  bool accept(State& next, double target, const StepReport& report) {
    if (!report.ok()) return fail(reason(report.status));
    if (!stops_.empty())
      if (const auto hit = first_hit(next, target)) return strike(hit->stop, hit->time, target);
    next.t = target;
    run_.trajectory.append(std::move(next), report);
    ++run_.steps;
    return held_.empty() || release_stops();
  }

  struct Hit {
    std::size_t stop;
    double time;
  };

  // The first stop that the step from now to `next` runs into.
  std::optional<Hit> first_hit(const State& next, double target) {
    std::optional<Hit> first;
    std::unique_ptr<Integrator> fresh;
    const auto after = [&](double step) {
      std::optional<State> state = now();
      if (!fresh) fresh = fresh_integrator();
      fresh->restart();
      if (!fresh->step(*state, step).ok()) state.reset();
      return state;
    };
    for (std::size_t i = 0; i < stops_.size(); ++i) {
      if (held_.contains(i)) continue;
      const auto time = time_to_contact(stops_, i, system(), now(), next, target - now().t, after);
      if (time && (!first || now().t + *time < first->time)) first = Hit{i, now().t + *time};
    }
    return first;
  }

  // Go to the contact, rebound or rest, and on to `target`.
  bool strike(std::size_t i, double time, double target) {
    if (time > now().t) {
      State contact = now();
      integrator_->restart();
      const StepReport report = step(contact, time - now().t);
      if (!report.ok()) return fail(reason(report.status));
      run_.trajectory.append(std::move(contact), report);
      ++run_.steps;
    }
    State after = now();
    const double approach = -stops_.gap_rate(i, system(), after);
    const bool rests = stops_[i].restitution * approach <= stops_[i].rest_speed;
    if (rests) return hold(i) && (now().t >= target || advance_to(target));
    const double lost = stops_.rebound(i, system(), after);
    if (std::isnan(lost)) return fail("a drive pushes against the stop " + stops_[i].name);
    run_.events.push_back({"stop " + stops_[i].name, after.t, lost});
    run_.trajectory.append(std::move(after), StepReport{});
    integrator_->restart();
    return now().t >= target || advance_to(target);
  }

  bool hold(std::size_t i) {
    State trial = now();
    if (std::isnan(stops_.rebound(i, system(), trial)))
      return fail("a drive pushes against the stop " + stops_[i].name);
    if (held_.empty()) base_ = &run_.trajectory.last_model();
    held_.insert(i);
    switch_held("rests on stop " + stops_[i].name);
    return true;
  }

  // Stops that would have to pull let go.
  bool release_stops() {
    for (const std::size_t i : std::set<std::size_t>(held_)) {
      if (stops_.push(i, run_.trajectory.last_model(), held_, now()) >= 0) continue;
      held_.erase(i);
      switch_held("leaves stop " + stops_[i].name);
    }
    return true;
  }

  void switch_held(const std::string& event) {
    const auto model = stops_.held_model(*base_, held_, run_.options.eliminate_linear);
    Handover after = hand_over(run_.trajectory.last_model(), now(), *model);
    run_.events.push_back({event, now().t, after.energy_lost * run_.trajectory.structure().sectors});
    run_.trajectory.change_model(model);
    run_.trajectory.append(std::move(after.state), StepReport{});
    integrator_ = fresh_integrator();
  }

  // The step would land on the singular pose: end it a little behind instead. The grid goes on after that.
  bool step_over(double target, double h) {
    State next = now();
    StepReport report;
    for (const double length : {1.41, 1.73, 1.19, 2.24}) {
      next = now();
      integrator_->restart();
      report = step(next, length * h);
      if (report.ok()) return accept(next, target + (length - 1) * h, report);
    }
    return accept(next, target, report);
  }

  StepReport step(State& state, double h) {
    const StepReport report = integrator_->step(state, h);
    run_.newton_iterations += report.newton_iterations;
    run_.factorisations += report.factorisations;
    return report;
  }

  // A failed step is tried again in 2, 4, ... 64 parts.
  StepReport retry(State& state, double h, StepReport report) {
    for (int parts = 2; parts <= 64 && !report.ok(); parts *= 2) {
      state = now();
      integrator_->restart();
      report = StepReport{};
      for (int i = 0; i < parts && report.ok(); ++i) report = step(state, h / parts);
    }
    if (!report.ok()) state = now();
    return report;
  }

  double fold(const State& state) {
    q_.resize(system().coordinates());
    system().expand(state.z, q_);
    return deployment_.remaining_sine(q_);
  }

  bool crosses(const State& next) {
    if (deployment_.empty() || deployed_) return false;
    return fold(now()) > singular_margin && fold(next) <= singular_margin;
  }

  // Could the fold angle reach zero within a step? Where sine * rate is constant it does so after sine / 2
  // rate.
  bool may_cross(double h) {
    if (deployment_.empty() || deployed_) return false;
    const double sine = fold(now());
    system().expand_rate(now().w, q_);
    return sine > 0 && sine + 3.0 * h * deployment_.remaining_rate(q_) <= 0;
  }

  std::optional<State> locate(double h, double latest) {
    const auto fresh = fresh_integrator();
    std::optional<State> event = locate_deployed(run_.trajectory, *fresh, h);
    if (event && event->t > latest) event.reset();
    return event;
  }

  void append_deployed(State& event) {
    project(system(), event);
    while (run_.trajectory.size() > 1 && run_.trajectory.end_time() >= event.t) run_.trajectory.pop_back();
    run_.trajectory.append(std::move(event), StepReport{.singular_event = true});
    ++run_.steps;
  }

  // Lock the structure and go on with it: two states at this time, before and after the impulse.
  bool latch(State& event, double target) {
    append_deployed(event);
    const auto locked = latched_model(run_.trajectory.last_model(), run_.options.eliminate_linear);
    Handover after = hand_over(run_.trajectory.last_model(), now(), *locked);
    run_.events.push_back({"latched", now().t, after.energy_lost * run_.trajectory.structure().sectors});
    held_.clear();  // what rests on a stop is locked there
    run_.trajectory.change_model(locked);
    run_.trajectory.append(std::move(after.state), StepReport{});
    integrator_ = fresh_integrator();
    return now().t < target ? advance_to(target) : true;
  }

  void finish_deployed(State& event) {
    append_deployed(event);
    run_.status = RunStatus::deployed;
    report_progress(1.0);
  }

  void report_progress(double fraction) {
    if (!hooks_.progress) return;
    const auto now = std::chrono::steady_clock::now();
    if (fraction < 1.0 && now - last_progress_ < std::chrono::milliseconds(50)) return;
    last_progress_ = now;
    hooks_.progress(fraction);
  }

  Simulation& run_;
  std::unique_ptr<Integrator> integrator_;
  const SimulationHooks& hooks_;
  const Deployment& deployment_;
  VectorXd q_;
  bool deployed_ = false;
  Stops stops_;
  std::set<std::size_t> held_;   // stops that the structure rests on
  const Model* base_ = nullptr;  // the model without them
  std::chrono::steady_clock::time_point last_progress_{};
};

}  // namespace

std::string_view to_string(RunStatus status) {
  switch (status) {
    case RunStatus::completed:
      return "completed";
    case RunStatus::deployed:
      return "deployed";
    case RunStatus::stopped:
      return "stopped";
    case RunStatus::failed:
      return "failed";
  }
  return "failed";
}

Simulation simulate(std::shared_ptr<const Model> model, const SolverOptions& options,
                    const SimulationHooks& hooks) {
  if (!find_method(options.method)) throw std::invalid_argument("no method is called " + options.method);
  Simulation run{.trajectory = Trajectory(model), .options = options};
  run.warnings = model->structure.notes;
  InitialState start = initial_state(model->structure, model->system);
  if (std::string warning = velocity_warning(start, model->structure); !warning.empty())
    run.warnings.push_back(std::move(warning));
  run.trajectory.append(std::move(start.state), StepReport{});
  const double begin = thread_cpu_seconds();
  TimeLoop(run, hooks).drive();
  run.cpu_s = thread_cpu_seconds() - begin;
  return run;
}

}  // namespace unfurl
