// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/reproduce.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/integrators/integrator.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"

namespace unfurl {
namespace {

constexpr std::size_t printed = 0, runge_kutta = 1, nodes3 = 2;

ReproducedScheme scheme(SolverOptions o, const char* name, const char* what, const char* method, int stages,
                        const char* nodes, const char* constraints_at) {
  o.method = method;
  o.stages = stages;
  o.nodes = nodes;
  o.constraints_at = constraints_at;
  return {name, what, o, {}, {}, nan};
}

std::vector<ReproducedScheme> schemes(const SolverOptions& o) {
  return {
      scheme(o, "variational, as printed", "equidistant nodes, constraints at the ends of a step (eq. 17)",
             "dvm", 3, "equidistant", "ends"),
      scheme(o, "Runge-Kutta 4", "index-1 equations", "rk4", 3, "lobatto", "nodes"),
      scheme(o, "variational, 3 nodes", "Lobatto nodes, constraints at every node", "dvm", 3, "lobatto",
             "nodes"),
      scheme(o, "variational, 4 nodes", "Lobatto nodes, constraints at every node", "dvm", 4, "lobatto",
             "nodes"),
  };
}

// The run once more, for what a figure shows over time.
void record(const std::shared_ptr<const Model>& model, SolverOptions options, const Reference& reference,
            ReproducedRun& out) {
  options.end_time = reference.t.back();
  options.step = out.measured.step;
  const Simulation run = simulate(model, options);
  const Trajectory& trajectory = run.trajectory;
  VectorXd phi(model->system.all_constraints());
  std::size_t k = 0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const VectorXd q = trajectory.node_positions(i);
    model->system.all_constraint_values(trajectory.time(i), q, phi);
    out.t.push_back(trajectory.time(i));
    out.constraint_error.push_back(phi.lpNorm<Eigen::Infinity>());
    if (k < reference.t.size() && std::abs(trajectory.time(i) - reference.t[k]) < 1e-9) {
      out.comparison_t.push_back(reference.t[k]);
      out.position_error.push_back(node_distance(q, reference.q[k++]));
    }
  }
}

const MeasuredRun& at(const Reproduction& r, std::size_t scheme, std::size_t step) {
  return r.schemes[scheme].runs[step].measured;
}

void add_check(Reproduction& r, std::string claim, std::string found, bool holds) {
  r.checks.push_back({std::move(claim), std::move(found), holds});
}

// What a reader should be able to rely on; none of it depends on the machine.
void check(Reproduction& r) {
  const double time = deployment_time(*r.motion);
  add_check(r, "the ring deploys in 4.92 s", short_number(time, 7) + " s",
            std::abs(time - printed_deployment_time) < 0.005);
  const double ratio =
      at(r, runge_kutta, paper_step).constraint_max / at(r, runge_kutta, paper_step + 1).constraint_max;
  add_check(r, "half the step makes the constraint error of Runge-Kutta 2^4 times smaller (paper: 15.95)",
            short_number(ratio, 4), std::abs(ratio - 16) < 1);
  for (const std::size_t s : {printed, nodes3}) {
    const double error = at(r, s, paper_step).constraint_relative_max;
    add_check(r, "constraint error at round-off: " + r.schemes[s].name,
              short_number(error) + " of the length", error < 100 * std::numeric_limits<double>::epsilon());
  }
  for (const ReproducedScheme& s : r.schemes) {
    const int claimed = find_method(s.options.method)->claims(s.options).order;
    add_check(r, "order " + std::to_string(claimed) + " of the trajectory: " + s.name,
              short_number(s.order.order), std::abs(s.order.order - claimed) < 0.1 * claimed);
  }
}

// The order by which the error falls, up to where round-off keeps it from falling at half the claimed rate.
void fit(ReproducedScheme& scheme, double floor) {
  const int claimed = find_method(scheme.options.method)->claims(scheme.options).order;
  std::vector<double> step, error;
  for (const ReproducedRun& run : scheme.runs) {
    const MeasuredRun& m = run.measured;
    if (!m.ok()) continue;
    if (m.position_error < floor) break;
    if (!error.empty() && m.position_error > error.back() * std::pow(m.step / step.back(), claimed / 2.0))
      break;
    step.push_back(m.step);
    error.push_back(m.position_error);
  }
  scheme.order = fit_order(step, error);
}

}  // namespace

bool Reproduction::verified() const {
  return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.holds; });
}

Reproduction reproduce_paper(const StudyHooks& hooks) {
  const Scene scene = read_scene_file(find_scene("hoop6"));
  const auto model = build_model(scene);
  Reproduction r;
  r.motion = std::make_shared<Simulation>(simulate(model, scene.solver));
  hooks.tell(0.02);
  const Reference reference =
      solve_reference(model, r.end, static_cast<int>(std::lround(r.end / comparison_step)), hooks);
  r.reference = reference.how;
  r.reference_uncertainty = reference.uncertainty;
  r.schemes = schemes(scene.solver);
  double done = 0;
  for (ReproducedScheme& s : r.schemes) {
    for (const double step : reproduced_steps) {
      hooks.tell(0.2 + 0.8 * done++ / static_cast<double>(r.schemes.size() * reproduced_steps.size()));
      ReproducedRun run;
      run.measured =
          measure_run(model, s.options, std::lround(r.end / step), reference, {.repeats = 5}, hooks);
      record(model, s.options, reference, run);
      s.runs.push_back(std::move(run));
    }
    // Errors known to a fifth: log2(6/5) is a quarter of an order.
    fit(s, std::max(5 * reference.uncertainty, 1e-12));
    SolverOptions whole = s.options;
    whole.step = 0.01;
    s.deployment_time = deployment_time(simulate(model, whole));
  }
  check(r);
  return r;
}

Table reproduced_table(const Reproduction& r, std::size_t step) {
  const PrintedResults& paper = printed_results[step];
  const std::size_t i = paper_step + step;
  Table table{{"method", "paper: CPU (s)", "paper: CPU / RK4", "paper: constraint error", "ours: CPU (s)",
               "ours: CPU / RK4", "ours: constraint error (m)", "ours: trajectory error (m)"},
              {}};
  for (std::size_t s = 0; s < r.schemes.size(); ++s) {
    const MeasuredRun& run = at(r, s, i);
    std::vector<std::string> row{r.schemes[s].name, "", "", ""};
    if (s == printed)
      row = {row[0], short_number(paper.variational_cpu, 6),
             short_number(paper.variational_cpu / paper.runge_kutta_cpu),
             short_number(paper.variational_error, 5)};
    if (s == runge_kutta)
      row = {row[0], short_number(paper.runge_kutta_cpu, 6), "1", short_number(paper.runge_kutta_error, 5)};
    row.push_back(short_number(run.cpu_median));
    row.push_back(short_number(run.cpu_median / at(r, runge_kutta, i).cpu_median));
    row.push_back(short_number(run.constraint_max));
    row.push_back(short_number(run.position_error));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table trajectory_table(const Reproduction& r) {
  Table table{{"method", "what"}, {}};
  for (const double step : reproduced_steps) table.columns.push_back("h = " + short_number(step) + " s");
  table.columns.insert(table.columns.end(), {"observed order", "deployed at (s)"});
  for (const ReproducedScheme& s : r.schemes) {
    std::vector<std::string> row{s.name, s.what};
    for (const ReproducedRun& run : s.runs) row.push_back(short_number(run.measured.position_error));
    row.push_back(short_number(s.order.order));
    row.push_back(short_number(s.deployment_time, 8));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table runs_table(const Reproduction& r) {
  Table table{{"method", "step_s", "steps", "outcome", "constraint_max_m", "constraint_relative_max",
               "position_error_m", "energy_error_max_J", "newton_iterations", "linear_solves", "cpu_median_s",
               "cpu_min_s", "cpu_max_s", "repeats"},
              {}};
  for (const ReproducedScheme& s : r.schemes)
    for (const ReproducedRun& run : s.runs) {
      const MeasuredRun& m = run.measured;
      std::vector<std::string> row{s.name, exact_number(m.step), std::to_string(m.steps), m.outcome};
      for (const double x : {m.constraint_max, m.constraint_relative_max, m.position_error, m.energy_error})
        row.push_back(exact_number(x));
      row.push_back(std::to_string(m.newton_iterations));
      row.push_back(std::to_string(m.linear_solves));
      for (const double x : {m.cpu_median, m.cpu_min, m.cpu_max}) row.push_back(exact_number(x));
      row.push_back(std::to_string(m.repeats));
      table.rows.push_back(std::move(row));
    }
  return table;
}

}  // namespace unfurl
