#include "core/simulate/simulation.hpp"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "core/integrators/integrator.hpp"
#include "core/simulate/deployed_event.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/step_control.hpp"

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
  TimeLoop(Simulation& run, Integrator& integrator, const SimulationHooks& hooks)
      : run_(run),
        integrator_(integrator),
        hooks_(hooks),
        deployment_(run.trajectory.structure().deployment) {}

  void drive() {
    const SolverOptions& o = run_.options;
    if (o.adaptive) {
      StepControl control(run_.trajectory.structure(), run_.trajectory.model().system, o);
      while (now().t < o.end_time) {
        const double h = control.next(now());
        const bool last = now().t + 1.001 * h >= o.end_time;
        if (!go_on() || !advance_to(last ? o.end_time : now().t + h)) return;
      }
    } else {
      const auto count = std::max(1L, static_cast<long>(std::ceil(o.end_time / o.step - 1e-9)));
      for (long k = 1; k <= count; ++k)
        if (!go_on() || !advance_to(k == count ? o.end_time : static_cast<double>(k) * o.step)) return;
    }
    report_progress(1.0);
  }

 private:
  const State& now() const { return run_.trajectory.state(run_.trajectory.size() - 1); }

  bool go_on() {
    report_progress(run_.trajectory.end_time() / run_.options.end_time);
    if (!hooks_.cancelled || !hooks_.cancelled()) return true;
    run_.status = RunStatus::stopped;
    run_.message = "stopped by the user at t = " + seconds(run_.trajectory.end_time());
    return false;
  }

  // False where the run ends here.
  bool advance_to(double target) {
    State next = now();
    const double h = target - next.t;
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
      if (!report.ok() || std::abs(fold(next)) < singular_margin) return step_over(target, h);
    }
    return accept(next, target, report);
  }

  bool fail(const std::string& why) {
    run_.status = RunStatus::failed;
    run_.message = "at t = " + seconds(now().t) + ": " + why;
    return false;
  }

  bool accept(State& next, double target, const StepReport& report) {
    if (!report.ok()) return fail(reason(report.status));
    next.t = target;
    run_.trajectory.append(std::move(next), report);
    ++run_.steps;
    return true;
  }

  // The step would land on the singular pose: end it a little behind instead. The grid goes on after that.
  bool step_over(double target, double h) {
    State next = now();
    StepReport report;
    for (const double length : {1.41, 1.73, 1.19, 2.24}) {
      next = now();
      integrator_.restart();
      report = step(next, length * h);
      if (report.ok()) return accept(next, target + (length - 1) * h, report);
    }
    return accept(next, target, report);
  }

  StepReport step(State& state, double h) {
    const StepReport report = integrator_.step(state, h);
    run_.newton_iterations += report.newton_iterations;
    run_.factorisations += report.factorisations;
    return report;
  }

  // A failed step is tried again in 2, 4, ... 64 parts.
  StepReport retry(State& state, double h, StepReport report) {
    for (int parts = 2; parts <= 64 && !report.ok(); parts *= 2) {
      state = now();
      integrator_.restart();
      report = StepReport{};
      for (int i = 0; i < parts && report.ok(); ++i) report = step(state, h / parts);
    }
    if (!report.ok()) state = now();
    return report;
  }

  double fold(const State& state) {
    q_.resize(run_.trajectory.model().system.coordinates());
    run_.trajectory.model().system.expand(state.z, q_);
    return deployment_.remaining_sine(q_);
  }

  bool crosses(const State& next) {
    if (deployment_.empty() || deployed_) return false;
    return fold(now()) > singular_margin && fold(next) <= singular_margin;
  }

  // Could the fold angle reach zero within a step? Its rate may double on the way.
  bool may_cross(double h) {
    if (deployment_.empty() || deployed_) return false;
    const double sine = fold(now());
    run_.trajectory.model().system.expand_rate(now().w, q_);
    return sine > 0 && sine + 2.0 * h * deployment_.remaining_rate(q_) <= 0;
  }

  std::optional<State> locate(double h, double latest) {
    const auto fresh = find_method(run_.options.method)->make(run_.trajectory.model().system, run_.options);
    std::optional<State> event = locate_deployed(run_.trajectory, *fresh, h);
    if (event && event->t > latest) event.reset();
    return event;
  }

  void finish_deployed(State& event) {
    project(run_.trajectory.model().system, event);
    while (run_.trajectory.size() > 1 && run_.trajectory.end_time() >= event.t) run_.trajectory.pop_back();
    run_.trajectory.append(std::move(event), StepReport{.singular_event = true});
    ++run_.steps;
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
  Integrator& integrator_;
  const SimulationHooks& hooks_;
  const Deployment& deployment_;
  VectorXd q_;
  bool deployed_ = false;
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
  const Method* method = find_method(options.method);
  if (!method) throw std::invalid_argument("no method is called " + options.method);
  Simulation run{.trajectory = Trajectory(model), .options = options};
  InitialState start = initial_state(model->structure, model->system);
  if (std::string warning = velocity_warning(start, model->structure); !warning.empty())
    run.warnings.push_back(std::move(warning));
  run.trajectory.append(std::move(start.state), StepReport{});
  const std::unique_ptr<Integrator> integrator = method->make(model->system, options);
  const double begin = thread_cpu_seconds();
  TimeLoop(run, *integrator, hooks).drive();
  run.cpu_s = thread_cpu_seconds() - begin;
  return run;
}

}  // namespace unfurl
