#include "core/study/tolerance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/integrators/integrator.hpp"
#include "core/study/reference.hpp"
#include "core/study/table.hpp"

namespace unfurl {
namespace {

// The estimate aims here, as shares of the tolerance: below `most`, and not much more work than for `least`.
constexpr double most = 0.5, least = 0.02, aim = 0.2;
constexpr long first_steps = 128, max_steps = 100'000'000;
constexpr int tries = 8;  // per number of stages

// Two solutions, the second more accurate.
struct Pair {
  Simulation run;
  double estimate = std::numeric_limits<double>::infinity();  // [m]
  double work = 0;                                            // of `run`, in solves
};

double work_of(const Simulation& run) {
  double solves = 8.0 * static_cast<double>(run.factorisations);
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) solves += run.trajectory.report(i).right_hand_sides;
  return solves;
}

// Largest distance of a node at the times that both have; the located deployed pose, a third time, is not
// compared.
double distance(const Simulation& a, const Simulation& b) {
  if (a.status == RunStatus::failed || b.status == RunStatus::failed || a.status != b.status)
    return std::numeric_limits<double>::infinity();
  const double near = 1e-9 * a.options.step;
  double largest = 0;
  std::size_t k = 0;
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    while (k < b.trajectory.size() && b.trajectory.time(k) < a.trajectory.time(i) - near) ++k;
    if (k == b.trajectory.size()) break;
    if (b.trajectory.time(k) > a.trajectory.time(i) + near) continue;
    largest =
        std::max(largest, node_distance(a.trajectory.node_positions(i), b.trajectory.node_positions(k)));
  }
  return largest;
}

class Picker {
 public:
  Picker(const std::shared_ptr<const Model>& model, const SolverOptions& options,
         const SimulationHooks& hooks)
      : model_(model),
        options_(options),
        hooks_(hooks),
        method_(*find_method(options.method)),
        size_(structure_size(*model)),
        fewest_steps_(model->structure.deployment.empty() ? 32 : 32) {
    quiet_.cancelled = hooks.cancelled;
    options_.adaptive = false;
  }

  Simulation pick() {
    for (const int stages : stage_choices()) {
      try_stages(stages);
      if (stopped_) return std::move(*stopped_);
      if (round_off_ > 1) break;  // fewer stages and more steps would meet it all the more
      if (stages == 2 && best_ && best_->estimate <= most * options_.tolerance) break;
    }
    if (!best_) return simulate(model_, options_, hooks_);  // nothing ran through: as the scene says
    Simulation run = std::move(best_->run);
    run.position_estimate = best_->estimate;
    run.options.tolerance = options_.tolerance;
    if (!(best_->estimate <= options_.tolerance))
      run.warnings.push_back("the tolerance of " + short_number(options_.tolerance) +
                             " m is out of reach; the estimated error is " + short_number(best_->estimate) +
                             " m");
    return run;
  }

 private:
  bool by_stages() const { return order_depends_on_stages(options_); }

  std::vector<int> stage_choices() const {
    if (!by_stages()) return {options_.stages};
    // Locating the deployed pose solves steps next to a singular one, at a price that grows fast with the
    // stages.
    if (!model_->structure.deployment.empty()) return {4, 3, 2, 5, 6, 7};
    return {5, 6, 7, 4, 3, 2};
  }

  // A pair with so many steps to the end; nothing where the user stopped it.
  std::optional<Pair> solve(int stages, long steps) {
    SolverOptions o = options_, better;
    o.stages = stages;
    o.step = options_.end_time / static_cast<double>(steps);
    better = o;
    if (by_stages())
      ++better.stages;
    else
      better.step /= 2;
    Pair pair{simulate(model_, o, quiet_)};
    if (pair.run.status != RunStatus::stopped) {
      const Simulation second = simulate(model_, better, quiet_);
      if (second.status != RunStatus::stopped) {
        pair.estimate = distance(pair.run, second);
        pair.work = work_of(pair.run);
        return pair;
      }
      pair.run.status = RunStatus::stopped;
    }
    stopped_ = std::move(pair.run);
    return std::nullopt;
  }

  // Steps are adjusted by the claimed order until the estimate is where it should be.
  void try_stages(int stages) {
    SolverOptions o = options_;
    o.stages = stages;
    const double order = std::max(1, method_.claims(o).order);
    long steps = first_steps, enough = 0;  // `enough`: the fewest steps known to suffice
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < tries; ++i) {
      auto pair = solve(stages, steps);
      if (!pair) return;
      const double share = pair->estimate / options_.tolerance;
      const bool hopeless = share > most && pair->estimate > 0.7 * last && pair->estimate < 1e-6 * size_;
      last = pair->estimate;
      const double work = pair->work;
      if (share <= most) enough = enough == 0 ? steps : std::min(enough, steps);
      keep(std::move(*pair));
      if (hopeless) ++round_off_;
      if (hopeless || (share <= most && share >= least) || (share < least && steps == fewest_steps_)) return;
      const double factor = std::isfinite(share) ? std::pow(share / aim, 1 / order) : 4.0;
      const long next = std::lround(static_cast<double>(steps) * std::clamp(factor, 0.125, 8.0));
      const double cost = work * static_cast<double>(next) / static_cast<double>(steps);
      if (next == steps || next > max_steps || (enough > 0 && next >= enough)) return;
      if (best_ && best_->estimate <= most * options_.tolerance && cost > 1.3 * best_->work) return;
      steps = std::max(fewest_steps_, next);
    }
  }

  // The least work among those that reach the tolerance; without any, the smallest estimate.
  void keep(Pair pair) {
    const double goal = most * options_.tolerance;
    const auto reaches = [&](const Pair& p) { return p.estimate <= goal; };
    if (!std::isfinite(pair.estimate)) return;
    if (!best_ || (reaches(pair) && (!reaches(*best_) || pair.work < best_->work)) ||
        (!reaches(pair) && !reaches(*best_) && pair.estimate < best_->estimate))
      best_ = std::move(pair);
  }

  const std::shared_ptr<const Model>& model_;
  SolverOptions options_;
  const SimulationHooks& hooks_;
  SimulationHooks quiet_;
  const Method& method_;
  double size_;  // of the structure [m]
  long fewest_steps_;
  std::optional<Pair> best_;
  std::optional<Simulation> stopped_;
  int round_off_ = 0;  // numbers of stages that met it
};

}  // namespace

bool order_depends_on_stages(const SolverOptions& options) {
  const Method& method = *find_method(options.method);
  SolverOptions two = options, four = options;
  two.stages = 2, four.stages = 4;
  return method.claims(two).order != method.claims(four).order;
}

Simulation simulate_as_asked(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                             const SimulationHooks& hooks) {
  if (options.tolerance > 0) return Picker(model, options, hooks).pick();
  return simulate(model, options, hooks);
}

}  // namespace unfurl
