// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/tolerance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/books.hpp"
#include "core/integrators/integrator.hpp"
#include "core/math/largest.hpp"
#include "core/path/path_run.hpp"
#include "core/path/path_scope.hpp"
#include "core/path/sector.hpp"
#include "core/simulate/elastic_period.hpp"
#include "core/structure/node_positions.hpp"
#include "core/study/reference.hpp"
#include "core/study/table.hpp"

namespace unfurl {
namespace {

// The estimate aims here, as shares of the tolerance: below `most`, and not much more work than for `least`.
constexpr double most = 0.5, least = 0.02, aim = 0.2;
// Numbers of steps are multiples of 35, for what other grids share with them (solve).
// They are counted over the time that the motion takes.
constexpr long multiple = 35, first_steps = 4 * multiple, fewest_steps = multiple, max_steps = 100'000'000;
// Of what deploys it is looked for in shares of the time that is asked for, the least of them first. Next to
// the pose steps are costly, and so is one that ends there: the grid goes on behind it, by that share.
constexpr double least_share = 1.0 / 1024, next_share = 4, beyond_pose = 1.1;
constexpr int tries = 8;   // per number of stages
constexpr int doubts = 4;  // of them, runs whose own books do not agree: more steps do not mend them then
// States of a run beside which another one is solved, where their grids do not meet.
constexpr std::size_t most_between = 100;
// What a run along the path is off by at most, as a share of the structure's size.
constexpr double path_share = 1e-12;
// And what rounding leaves of its start, likewise.
constexpr double rounded_start = 1e-15;
// Work of the whole search, in solves times unknowns: a minute or two of one core.
constexpr double most_work = 2e8;

// A solution, judged by others that are more accurate and share neither its grid nor, where it has any, its
// stages.
struct Judged {
  Simulation run;
  double estimate = std::numeric_limits<double>::infinity();  // [m]
  bool trusted = true;                                        // by its own books, all of it
  bool compared = true;  // where its method damps, with one that does not
  double work = 0;       // of `run`, in solves
  double all_work = 0;   // of the others too
};

double work_of(const Simulation& run) {
  double solves = 8.0 * static_cast<double>(run.factorisations);
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) solves += run.trajectory.report(i).right_hand_sides;
  return solves;
}

// Largest distance of a node of a from b: at the times that both have, and at most_between others of a, to
// which b is solved from its state before; where a structure deploys, also of the deployed poses, and of what
// the fastest node goes in the time between both.
double distance(const Simulation& a, const Simulation& b) {
  if (a.status == RunStatus::failed || b.status == RunStatus::failed || a.status != b.status)
    return std::numeric_limits<double>::infinity();
  const double near = 1e-9 * a.options.step;
  const Index in_space = space_coordinates(a.trajectory.structure());
  const auto apart = [&](std::size_t i, std::size_t k) {
    return node_distance(a.trajectory.node_positions(i).head(in_space),
                         b.trajectory.node_positions(k).head(in_space));
  };
  double largest = 0;
  std::vector<std::size_t> between;
  std::size_t k = 0;
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    while (k < b.trajectory.size() && b.trajectory.time(k) < a.trajectory.time(i) - near) ++k;
    if (k == b.trajectory.size()) break;
    if (b.trajectory.time(k) > a.trajectory.time(i) + near)
      between.push_back(i);
    else
      largest = larger(largest, apart(i, k));
  }
  const std::size_t every = (between.size() + most_between - 1) / most_between;
  for (std::size_t n = 0; n < between.size(); n += every) {
    const double t = a.trajectory.time(between[n]);
    const System& system = b.trajectory.model(b.trajectory.state_before(t)).system;
    VectorXd q(system.coordinates());
    system.expand(b.trajectory.state_at(t).z, q);
    largest = larger(largest,
                     node_distance(a.trajectory.node_positions(between[n]).head(in_space), q.head(in_space)));
  }
  if (a.status == RunStatus::deployed) {
    const std::size_t last = a.trajectory.size() - 1;
    const double late = std::abs(a.trajectory.end_time() - b.trajectory.end_time());
    largest = larger(largest, apart(last, b.trajectory.size() - 1));
    const VectorXd v = a.trajectory.node_velocities(last).head(in_space);
    largest = larger(largest, late * node_distance(v, VectorXd::Zero(in_space)));
  }
  return largest;
}

std::string out_of_reach(double tolerance, double estimate) {
  return "the tolerance of " + short_number(tolerance) + " m is out of reach; the estimated error is " +
         short_number(estimate) + " m";
}

class Picker {
 public:
  Picker(const std::shared_ptr<const Model>& model, const SolverOptions& options,
         const SimulationHooks& hooks)
      : model_(model),
        options_(options),
        hooks_(hooks),
        method_(*find_method(options.method)),
        damps_(method_.claims(options).damps),
        unknowns_(static_cast<double>(model->system.solved_coordinates() + model->system.constraints())) {
    quiet_.cancelled = hooks.cancelled;
    options_.adaptive = false;
  }

  Simulation pick() {
    if (!model_->structure.deployment.empty()) find_span();
    if (stopped_) return std::move(*stopped_);
    for (const int stages : stage_choices()) {
      // Where fewer stages reach the tolerance, more do so at a lower price with few steps or not at all.
      const bool few = stages > 4 && !model_->structure.deployment.empty() && reached();
      if (few && steps_of(best_->run) <= fewest_steps) break;
      try_stages(stages, few ? fewest_steps : first_steps);
      if (stopped_) return std::move(*stopped_);
      if (round_off_ > 1) break;  // fewer stages and more steps would meet it all the more
    }
    if (!best_) return as_the_scene_says();
    Simulation run = std::move(best_->run);
    run.position_estimate = best_->estimate;
    run.options.tolerance = options_.tolerance;
    if (best_->estimate <= options_.tolerance)  // its states are right then
      for (std::string& warning : run.warnings)
        if (warning == wave_step_warning(model_->structure, run.options))
          warning = wave_step_warning(model_->structure, run.options, true);
    if (!(best_->estimate <= options_.tolerance))
      run.warnings.push_back(out_of_reach(options_.tolerance, best_->estimate));
    else if (!best_->compared)
      run.warnings.push_back("the estimated error is that of what " + options_.method +
                             " leaves: no run without its damping (dvm) went through to compare with");
    return run;
  }

 private:
  // Where the structure is deployed long before the end, steps that are shares of all the time would be as
  // long as the motion, and cost most where they do not follow it.
  void find_span() {
    double work = 0;
    for (double share = least_share; share < 1; share *= next_share) {
      SolverOptions o = options_;
      span_ = o.end_time = share * options_.end_time;
      const auto pilot = run(o, stage_choices().front(), fewest_steps, work);
      if (!pilot) return;
      if (pilot->status != RunStatus::deployed || !mistrust(*pilot, diagnose_books(*pilot)).empty()) continue;
      span_ = beyond_pose * pilot->trajectory.end_time();
      if (span_ > 0) return;
    }
    span_ = options_.end_time;
  }

  SolverOptions undamped() const {
    SolverOptions o = options_;
    o.method = "dvm", o.nodes = "lobatto", o.constraints_at = "nodes";
    return o;
  }

  bool by_stages() const { return order_depends_on_stages(options_); }

  // Elastic rods want four stages or more: with fewer, waves that steps do not resolve spoil velocities and
  // forces, that of a pin with friction among them.
  std::vector<int> stage_choices() const {
    if (!by_stages()) return {options_.stages};
    if (model_->system.elastic_rods()) return {4, 5, 6, 7};
    // Locating the deployed pose solves steps next to a singular one, at a price that grows fast with the
    // stages.
    if (!model_->structure.deployment.empty()) return {4, 3, 2, 5, 6, 7};
    return {5, 6, 7, 4, 3, 2};
  }

  // Nothing ran through that could be judged.
  Simulation as_the_scene_says() {
    Simulation run = simulate(model_, options_, hooks_);
    run.warnings.push_back(
        "the tolerance of " + short_number(options_.tolerance) +
        " m could not be looked after: no two solutions ran through; this is the run with the "
        "scene's own stages and step, and its error is not known");
    return run;
  }

  std::optional<Simulation> run(int stages, double steps, double& work) {
    return run(options_, stages, steps, work);
  }
  std::optional<Simulation> run(SolverOptions o, int stages, double steps, double& work) {
    o.stages = stages;
    o.step = span_ / std::round(steps);
    Simulation out = simulate(model_, o, quiet_);
    work += work_of(out);
    if (out.status != RunStatus::stopped) return out;
    stopped_ = std::move(out);
    return std::nullopt;
  }

  // With so many steps over the motion; nothing where the user stopped it. The second solution has a stage
  // more and 7/5 as many steps (without stages 12/5: an error of order 2 is a sixth then), which meet the
  // first ones at every fifth of those, so that what happens within a step falls elsewhere in its own. One
  // that agrees may do so by chance where the motion is not smooth (something that is seen only at the end of
  // a step, at a time that both have): a third, with 9/7 (16/7) as many, has to agree as well; all three meet
  // at every 35th step only. Of a method that damps what its steps do not resolve all grids may agree on
  // rest: there the third is dvm's, which keeps it; should that fail, the method's own.
  std::optional<Judged> solve(int stages, long steps) {
    double work = 0;
    auto first = run(stages, static_cast<double>(steps), work);
    if (!first) return std::nullopt;
    Judged out{std::move(*first)};
    out.work = work;
    const int more = by_stages() ? stages + 1 : stages;
    out.estimate = 0;
    const auto ratios = by_stages() ? std::array{7.0 / 5, 9.0 / 7} : std::array{12.0 / 5, 16.0 / 7};
    for (const double ratio : ratios) {
      if (out.run.status == RunStatus::failed) out.estimate = std::numeric_limits<double>::infinity();
      if (!(out.estimate <= most * options_.tolerance)) break;
      const double others = ratio * static_cast<double>(steps);
      std::optional<Simulation> other;
      if (damps_ && ratio == ratios.back()) {
        other = run(undamped(), 4, others, work);
        if (!other) return std::nullopt;
        out.compared = other->status != RunStatus::failed && mistrust(*other, diagnose_books(*other)).empty();
      }
      if (!other || !out.compared) other = run(more, others, work);
      if (!other) return std::nullopt;
      out.estimate = larger(out.estimate, distance(out.run, *other));
    }
    // Nodes may be where they should be while the energy balance is not: what hides within a step and is over
    // at its end.
    if (std::isfinite(out.estimate)) out.trusted = mistrust(out.run, diagnose_books(out.run)).empty();
    out.all_work = work;
    spent_ += work * unknowns_;
    return out;
  }

  // Steps are adjusted by the order that the last two estimates show, at most the claimed one, until the
  // estimate is where it should be; four times as many where a run is not trusted. Given up where smaller
  // steps gain nothing, at round-off or twice, or would take too long.
  void try_stages(int stages, long steps) {
    SolverOptions o = options_;
    o.stages = stages;
    const double claimed = std::max(1, method_.claims(o).order);
    long enough = 0, before = 0;  // `enough`: the fewest steps known to suffice
    double last = std::numeric_limits<double>::infinity();
    int stalls = 0, doubted = 0;
    for (int i = 0; i < tries; ++i) {
      auto judged = solve(stages, steps);
      if (!judged) return;
      if (!judged->trusted) ++doubted;
      const double estimate = judged->trusted ? judged->estimate : std::numeric_limits<double>::infinity();
      const double share = estimate / options_.tolerance;
      const double work = judged->work, all_work = judged->all_work;
      if (share > most && steps > before && estimate > 0.7 * last) ++stalls;
      const bool hopeless = doubted == doubts || stalls > 1 ||
                            (stalls > 0 && estimate < 1e-6 * size_of_motion(*model_, judged->run.trajectory));
      const double ratio = before > 0 ? static_cast<double>(steps) / static_cast<double>(before) : 1.0;
      const double seen = std::log(last / estimate) / std::log(ratio);
      const double order = std::isfinite(seen) ? std::clamp(seen, 0.5, claimed) : claimed;
      last = estimate, before = steps;
      if (share <= most) enough = enough == 0 ? steps : std::min(enough, steps);
      keep(std::move(*judged));
      if (hopeless) ++round_off_;
      if (hopeless || (share <= most && share >= least) || (share < least && steps == fewest_steps)) return;
      const double factor = std::isfinite(share) ? std::pow(share / aim, 1 / order) : 4.0;
      const double wanted = static_cast<double>(steps) * std::clamp(factor, 0.125, 8.0);
      const long next = multiple * std::max(1L, std::lround(wanted / static_cast<double>(multiple)));
      const double growth = static_cast<double>(next) / static_cast<double>(steps);
      if (next == steps || next > max_steps || (enough > 0 && next >= enough)) return;
      if (reached() && work * growth > 1.3 * best_->work) return;
      if (spent_ + all_work * growth * unknowns_ > most_work) return;
      steps = std::max(fewest_steps, next);
    }
  }

  bool reaches(const Judged& p) const { return p.trusted && p.estimate <= most * options_.tolerance; }
  bool reached() const { return best_ && reaches(*best_); }
  long steps_of(const Simulation& run) const { return std::lround(span_ / run.options.step); }

  // The least work among those that reach the tolerance; without any, the smallest estimate of those that are
  // trusted, or else of all.
  bool better(const Judged& a, const Judged& b) const {
    if (reaches(a) != reaches(b)) return reaches(a);
    if (reaches(a)) return a.work < b.work;
    if (a.trusted != b.trusted) return a.trusted;
    return a.estimate < b.estimate;
  }

  void keep(Judged pair) {
    if (!std::isfinite(pair.estimate)) return;
    if (!best_ || better(pair, *best_)) best_ = std::move(pair);
  }

  const std::shared_ptr<const Model>& model_;
  SolverOptions options_;
  const SimulationHooks& hooks_;
  SimulationHooks quiet_;
  const Method& method_;
  bool damps_;
  double unknowns_;
  double span_ = options_.end_time;  // of the motion [s]
  double spent_ = 0;                 // of most_work
  std::optional<Judged> best_;
  std::optional<Simulation> stopped_;
  int round_off_ = 0;  // numbers of stages that met it
};

}  // namespace

namespace {

// The full model, or one of its sectors where it is a ring whose sectors are alike and that is allowed.
Simulation without_path(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                        const SimulationHooks& hooks, const std::string& no_path) {
  const auto solve = [&](const std::shared_ptr<const Model>& what, const SolverOptions& how) {
    return how.tolerance > 0 ? Picker(what, how, hooks).pick() : simulate(what, how, hooks);
  };
  if (options.model == "full") return solve(model, options);
  std::string why = no_path;
  try {
    Simulation run = simulate_sector(model, options, solve);
    run.solved_as.why += (why.empty() ? "" : "; " + why);
    return run;
  } catch (const SectorRefused& refused) {
    const bool sector = model->structure.node_copies.size() > model->structure.nodes.size();
    if (options.model == "sector" && !sector)
      throw SectorRefused("solver.model = \"sector\": " + std::string(refused.what()) +
                          "; \"auto\" takes the full model where sectors are not alike");
    if (!sector) why += (why.empty() ? "no sector: " : "; no sector: ") + std::string(refused.what());
  }
  Simulation run = solve(model, options);
  run.solved_as.why = options.model == "sector" ? "" : why;
  return run;
}

// What the motion makes of rounding, at least path_share of its size: a run that sets out from a start off by
// some units of round-off ends up elsewhere. Either way, should there be no path the one way.
double path_estimate(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                     const SimulationHooks& hooks, const Simulation& run) {
  const double size = size_of_motion(*model, run.trajectory);
  if (run.status == RunStatus::stopped || driven_row(model->structure)) return path_share * size;
  SimulationHooks quiet;
  quiet.cancelled = hooks.cancelled;
  for (const double way : {1.0, -1.0}) {
    try {
      const Simulation other = simulate_on_path(model, options, quiet, way * rounded_start * size);
      if (other.status == RunStatus::stopped) return std::numeric_limits<double>::quiet_NaN();
      return larger(path_share * size, distance(run, other));
    } catch (const PathRefused&) {
      continue;
    }
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

Simulation simulate_as_asked(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                             const SimulationHooks& hooks) {
  if (options.model == "full" || options.model == "sector") return without_path(model, options, hooks, "");
  try {
    Simulation run = simulate_on_path(model, options, hooks);
    const auto& idle = model->structure.notes_on_path;
    run.warnings.insert(run.warnings.end(), idle.begin(), idle.end());
    run.solved_as = {"path", "one degree of freedom; solver.model = \"" + options.model + "\""};
    if (!(options.tolerance > 0)) return run;
    run.position_estimate = path_estimate(model, options, hooks, run);
    if (!(run.position_estimate > options.tolerance)) return run;  // NaN: stopped by the user
    const bool for_ever = path_share * size_of_motion(*model, run.trajectory) > options.tolerance;
    if (options.model == "auto" && !for_ever) {
      Simulation other = without_path(
          model, options, hooks,
          "no path: rounding of the start grows to " + short_number(run.position_estimate) + " m on it");
      if (other.position_estimate < run.position_estimate || other.status == RunStatus::stopped) return other;
    }
    run.warnings.push_back(out_of_reach(options.tolerance, run.position_estimate));
    return run;
  } catch (const PathRefused& refused) {
    if (options.model == "path")
      throw PathRefused("solver.model = \"path\": " + std::string(refused.what()) +
                        "; \"auto\" takes the full model where the path does not apply");
    return without_path(model, options, hooks, std::string("no path: ") + refused.what());
  }
}

}  // namespace unfurl
