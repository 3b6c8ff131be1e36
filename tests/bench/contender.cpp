// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/contender.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/simulate/initial_state.hpp"
#include "core/simulate/step_control.hpp"
#include "tests/support/models.hpp"

namespace unfurl::bench {
namespace {

double distance(const System& system, const State& state, const VectorXd& exact) {
  VectorXd q(exact.size());
  system.expand(state.z, q);
  double worst = 0;
  for (Index i = 0; i < q.size(); i += 3) worst = std::max(worst, (q - exact).segment<3>(i).norm());
  return worst;
}

void run_ida(Contender& c, const Track& track) {
  const System& system = track.model->system;
  const testing::IdaRun run = testing::solve_with_ida(
      system, initial_state(track.model->structure, system).state, track.times,
      {.relative_tolerance = c.h, .absolute_tolerance = c.absolute_tolerance, .max_steps = 100000});
  c.failure = run.ok ? "" : run.message;
  if (run.ok) c.best = std::min(c.best, run.cpu_s);
  c.error = 0;
  for (std::size_t i = 0; i < run.states.size(); ++i)
    c.error = std::max(c.error, distance(system, run.states[i], track.exact[i]));
}

// One step of it is as many as the control asks for.
class StepsThatFollow final : public Integrator {
 public:
  StepsThatFollow(const Model& model, const SolverOptions& options)
      : control_(model.structure, model.system, options),
        method_(find_method(options.method)->make(model.system, options)) {}

  StepReport step(State& state, double h) override {
    const double end = state.t + h, nearly = 1e-9 * h;
    StepReport report;
    while (state.t < end - nearly) {
      const double wanted = control_.next(state), left = end - state.t;
      report = method_->step(state, wanted < left - nearly ? wanted : left);
      if (!report.ok()) break;
    }
    return report;
  }
  void restart() override { method_->restart(); }

 private:
  StepControl control_;
  std::unique_ptr<Integrator> method_;
};

}  // namespace

Contender adaptive_dvm(int stages, double largest_step, double turn) {
  SolverOptions options = testing::dvm_options(stages, largest_step, 1.0);
  options.adaptive = true;
  options.turn = turn;
  char settings[60];
  std::snprintf(settings, sizeof settings, ", steps up to %g s, turn %g", largest_step, turn);
  Contender c{"dvm, " + std::to_string(stages) + " stages",
              [options](const Model& m) { return std::make_unique<StepsThatFollow>(m, options); }, 0};
  c.settings = settings;
  return c;
}

Contender dvm(int stages, double h) {
  SolverOptions options = testing::dvm_options(stages, h, 1.0);
  return {"dvm, " + std::to_string(stages) + " stages",
          [options](const Model& m) { return find_method(options.method)->make(m.system, options); }, h};
}

Contender rk4(double h) {
  return {"rk4", [](const Model& m) { return find_method("rk4")->make(m.system, {}); }, h};
}

Contender ida(double relative_tolerance, double absolute_tolerance) {
  Contender c{"SUNDIALS IDA", {}, relative_tolerance};
  c.absolute_tolerance = absolute_tolerance;
  return c;
}

void run(Contender& c, const Track& track) {
  if (!c.make) return run_ida(c, track);
  const auto integrator = c.make(*track.model);
  State state = initial_state(track.model->structure, track.model->system).state;
  const double of_its_own = track.times.front();
  const auto steps = static_cast<long>(std::ceil(track.end / (c.h > 0 ? c.h : of_its_own) - 1e-9));
  const double h = track.end / static_cast<double>(steps);
  double spent = 0;
  c.error = 0;
  long done = 0;
  for (std::size_t i = 0; i < track.times.size(); ++i) {
    const long until = std::lround(track.times[i] / h);
    const double begin = cpu_seconds();
    for (; done < until; ++done)
      if (!integrator->step(state, h).ok()) {
        c.failure = "a step failed";
        return;
      }
    spent += cpu_seconds() - begin;
    c.error = std::max(c.error, distance(track.model->system, state, track.exact[i]));
  }
  c.best = std::min(c.best, spent);
}

void race(const std::vector<Contender*>& contenders, const Track& track, int repeats) {
  for (int r = 0; r < repeats; ++r)
    for (Contender* c : contenders) run(*c, track);
}

void add(Report& report, const std::string& group, const Contender& c) {
  char h[40];
  const bool own_steps = c.relative_tolerance > 0;
  std::snprintf(h, sizeof h, c.make && !own_steps ? ", h = %.4g s" : ", rtol = %.0e",
                own_steps ? c.relative_tolerance : c.h);
  const std::string name = c.name + (c.settings.empty() ? h : c.settings);
  if (c.failure.empty())
    report.add({group, name, c.best, "s", "", c.error});
  else
    report.add({group, name + " (" + c.failure + ")", std::nan(""), "s", "", c.error});
}

void ratio(Report& report, const std::string& group, const std::string& what, const Contender& a,
           const Contender& b, const char* target) {
  const bool both = a.failure.empty() && b.failure.empty();
  report.add({group, what, both ? a.best / b.best : std::nan(""), "ratio", target});
}

}  // namespace unfurl::bench
