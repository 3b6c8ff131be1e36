// SPDX-License-Identifier: BSD-3-Clause
// Which runs a study may have measured, and which points of a sweep a quadrature may tell.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "core/scene/library.hpp"
#include "core/study/measured_run.hpp"
#include "core/study/path_sweep.hpp"

using namespace unfurl;

namespace possible_runs_test {

TEST_CASE("a run is possible if all of its numbers are, failed or not") {
  MeasuredRun good;
  good.outcome = "ok";
  good.steps = 35, good.repeats = 3, good.step = 0.02;
  good.cpu_min = 0.01, good.cpu_median = 0.015, good.cpu_max = 0.02;
  good.position_error = 1e-5, good.constraint_max = 2e-12, good.constraint_relative_max = 1e-12;
  good.constraint_velocity_max = 3e-11, good.energy_error = 0.4;
  good.newton_iterations = 70, good.factorisations = 35, good.linear_solves = 140;
  CHECK(is_possible(good));
  const auto with = [&](const std::function<void(MeasuredRun&)>& change, const char* outcome = "ok") {
    MeasuredRun run = good;
    run.outcome = outcome;
    change(run);
    return is_possible(run);
  };
  const auto nothing = [](MeasuredRun&) {};
  for (const char* outcome : {"too slow", "solver failed", "other motion", "not trusted"})
    CHECK(with(nothing, outcome));
  CHECK_FALSE(with(nothing, "fast"));
  for (long MeasuredRun::*count :
       {&MeasuredRun::newton_iterations, &MeasuredRun::factorisations, &MeasuredRun::linear_solves}) {
    CHECK(with([&](MeasuredRun& r) { r.*count = 0; }));
    CHECK_FALSE(with([&](MeasuredRun& r) { r.*count = -1; }));
  }
  for (double MeasuredRun::*error :
       {&MeasuredRun::position_error, &MeasuredRun::constraint_max, &MeasuredRun::constraint_relative_max,
        &MeasuredRun::constraint_velocity_max, &MeasuredRun::energy_error}) {
    CHECK(with([&](MeasuredRun& r) { r.*error = 0; }));
    CHECK_FALSE(with([&](MeasuredRun& r) { r.*error = -1e-9; }, "solver failed"));
    for (const double unknown : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      CHECK_FALSE(with([&](MeasuredRun& r) { r.*error = unknown; }));
      CHECK(with([&](MeasuredRun& r) { r.*error = unknown; }, "other motion"));
    }
  }
  for (double MeasuredRun::*time :
       {&MeasuredRun::step, &MeasuredRun::cpu_min, &MeasuredRun::cpu_median, &MeasuredRun::cpu_max})
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -0.01})
      CHECK_FALSE(with([&](MeasuredRun& r) { r.*time = bad; }, "too slow"));
  CHECK_FALSE(with([](MeasuredRun& r) { r.steps = 0; }));
  CHECK_FALSE(with([](MeasuredRun& r) { r.repeats = 0; }));
  CHECK(with([](MeasuredRun& r) { r.steps = r.repeats = 1; }));
  // The median lies between the others.
  CHECK_FALSE(with([](MeasuredRun& r) { r.cpu_min = 0.016; }));
  CHECK_FALSE(with([](MeasuredRun& r) { r.cpu_max = 0.014; }));
  CHECK(with([](MeasuredRun& r) { r.cpu_min = r.cpu_max = 0.015; }));
}

// A plain ring is told by a quadrature; with anything that this does not know it goes the usual way.
TEST_CASE("a point of a sweep with stops or forces of its own is not told by a quadrature") {
  const auto told = [](const std::vector<std::string>& changes) {
    SweepPlan plan{{find_scene("hoop6_sector"), changes},
                   {parse_axis("structure.fold_angle=50,70")},
                   {find_measure("deploy_time")},
                   {}};
    check_plan(plan);
    std::vector<std::string> row;
    const bool yes = PathSweep(plan).measure(0, row);
    CHECK(row.size() == (yes ? 2 : 0));
    return yes;
  };
  CHECK(told({}));
  CHECK(told({"solver.at_deployed=\"pass\""}));
  CHECK_FALSE(told({"constraints=[{kind=\"angle_stop\", fold_angle=true, min=20}]"}));
  CHECK_FALSE(told({"forces=[{kind=\"torsion_spring\", fold_angle=true, stiffness=3, free_angle=0}]"}));
  CHECK_FALSE(told({"solver.model=\"full\""}));
}

}  // namespace possible_runs_test
