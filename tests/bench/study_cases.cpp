// SPDX-License-Identifier: BSD-3-Clause
// One number where one number is enough: the path, margins, sweeps, a sector that the program finds itself.
#include <algorithm>
#include <cmath>

#include "core/path/margin.hpp"
#include "core/path/path_run.hpp"
#include "core/path/sector.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/reference.hpp"
#include "core/study/sweep.hpp"
#include "tests/bench/cases.hpp"

namespace unfurl::bench {
namespace {

constexpr int repeats = 3;

Scene scene_of(const std::string& name, const std::vector<std::string>& changes = {}) {
  return read_scene_file(find_scene(name), changes);
}

// The largest distance of a node at the states, of which both runs have as many.
double apart(const Simulation& a, const Simulation& b) {
  double off = 0;
  for (std::size_t i = 0; i < std::min(a.trajectory.size(), b.trajectory.size()); ++i)
    off = std::max(off, node_distance(a.trajectory.positions(i), b.trajectory.positions(i)));
  return off;
}

template <class Work>
double least_seconds(const Work& work) {
  double best = 1e300;
  for (int i = 0; i < repeats; ++i) {
    const double begin = cpu_seconds();
    work();
    best = std::min(best, cpu_seconds() - begin);
  }
  return best;
}

void paths(Report& report) {
  for (const char* name : {"hoop6", "hoop6_sector", "hoop12", "hoop6_motor", "four_bar", "hoberman", "ladder",
                           "reentrant_sheet", "scissor_mast", "scissor_ring"}) {
    const Scene scene = scene_of(name);
    const auto model = build_model(scene);
    SolverOptions accurate = scene.solver;
    accurate.stages = 7;
    const Simulation truth = simulate(model, accurate);
    const Simulation along = simulate_on_path(model, scene.solver);
    const double full = least_seconds([&] { simulate(model, scene.solver); });
    const double path = least_seconds([&] { simulate_on_path(model, scene.solver); });
    report.add({"path", std::string(name) + ": the full model as the scene is", full, "s"});
    report.add({"path", std::string(name) + ": path, tracing included", path, "s", "", apart(along, truth)});
  }
}

void sectors(Report& report) {
  for (const int units : {6, 24, 100}) {
    const Scene scene = scene_of("hoop6", {"structure.units=" + std::to_string(units), "solver.end_time=1"});
    const auto model = build_model(scene);
    const auto solve = [](const std::shared_ptr<const Model>& what, const SolverOptions& how) {
      return simulate(what, how);
    };
    const double off = apart(simulate_sector(model, scene.solver, solve), simulate(model, scene.solver));
    double full = 1e300, one = 1e300;
    for (int i = 0; i < repeats; ++i) {
      full = std::min(full, simulate(model, scene.solver).cpu_s);
      one = std::min(one, simulate_sector(model, scene.solver, solve).cpu_s);
    }
    const std::string name = std::to_string(units) + " units: ";
    report.add({"sector", name + "stepping of the full ring", full, "s"});
    report.add({"sector", name + "of the sector that was found", one, "s", "", off});
  }
}

void margins(Report& report) {
  for (const char* name : {"hoop6", "hoop6_sector", "scissor_mast"}) {
    const Scene scene = scene_of(name);
    const auto model = build_model(scene);
    report.add({"margin", std::string(name) + ": the path and its margins",
                least_seconds([&] { margin_of(model, scene.solver); }), "s"});
  }
}

void sweeps(Report& report) {
  for (const auto& [name, target] : {std::pair{"hoop6_sector", "<= 10"}, std::pair{"hoop6", ""}}) {
    SweepPlan plan{{find_scene(name)}, {}, {find_measure("deploy_time")}, {}};
    plan.axes = {parse_axis("structure.fold_angle=10:89.5:400"),
                 parse_axis("structure.hinge_force=100:400:250")};
    check_plan(plan);
    StudyHooks hooks;
    hooks.threads = 1;
    const double begin = cpu_seconds();
    Journal journal({}, plan.columns(), plan.axes.size());
    const Sweep sweep = run_sweep(plan, journal, hooks);
    report.add({"sweep",
                std::string(name) + ": " + std::to_string(sweep.table.rows.size()) +
                    " points, deploy_time over fold angle and hinge force",
                cpu_seconds() - begin, "s", target});
  }
}

}  // namespace

void study_cases(Report& report) {
  report.begin("One number where one is enough: CPU time, distance from the full model with 7 stages");
  paths(report);
  sectors(report);
  margins(report);
  sweeps(report);
}

}  // namespace unfurl::bench
