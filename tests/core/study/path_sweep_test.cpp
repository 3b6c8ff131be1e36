// SPDX-License-Identifier: BSD-3-Clause
// Sweeps along a path traced once.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/library.hpp"
#include "core/study/path_sweep.hpp"
#include "tests/support/hoop_exact.hpp"

using namespace unfurl;

namespace path_sweep_test {

namespace {

SweepPlan plan_of(const std::string& scene, const std::vector<std::string>& axes,
                  const std::vector<std::string>& changes = {}, const std::string& measure = "deploy_time") {
  SweepPlan plan{{find_scene(scene), changes}, {}, {find_measure(measure)}, {}};
  for (const std::string& axis : axes) plan.axes.push_back(parse_axis(axis));
  check_plan(plan);
  return plan;
}

Table run(const SweepPlan& plan, int threads = 1) {
  Journal journal({}, plan.columns(), plan.axes.size());
  StudyHooks hooks;
  hooks.threads = threads;
  return run_sweep(plan, journal, hooks).table;
}

double time_of(const SweepPlan& plan, const std::vector<std::string>& row) {
  return number_of(row[plan.axes.size() + 1]);
}

}  // namespace

TEST_CASE("a sweep along the path has the exact deployment times of the ring") {
  // Close to dead centre, 90 degrees, and close to the deployed pose.
  const SweepPlan plan =
      plan_of("hoop6_sector", {"structure.fold_angle=2:89.9:23", "structure.hinge_force=37,911"},
              {"solver.end_time=60"});
  std::vector<std::string> ignored;
  CHECK(PathSweep(plan).measure(0, ignored));  // this is how they are computed
  const Table table = run(plan, 2);
  REQUIRE(table.rows.size() == 46);
  for (const auto& row : table.rows) {
    INFO(row[0] << " " << row[1]);
    const exact::Hoop hoop{.fold_angle_deg = number_of(row[0]), .f = number_of(row[1])};
    // A fold angle is rounded to 1e-14 degrees and its pose to 1e-16 m; next to dead centre, 0.1 degrees
    // from it, that is 1e-13 of the time.
    CHECK(time_of(plan, row) == Approx(hoop.time(0.0)).epsilon(2e-12));
  }
}

TEST_CASE("a point's digits do not depend on the shard or the order in which points are computed") {
  SweepPlan plan = plan_of("hoop6_sector", {"structure.fold_angle=20:85:6", "structure.hinge_force=100:400:3",
                                            "structure.density=2000,3000"});
  const Table whole = run(plan, 2);
  for (int i = 1; i <= 5; ++i) {
    plan.shard = {i, 5};
    const auto points = points_of_shard(plan);
    const Table part = run(plan);
    REQUIRE(part.rows.size() == points.size());
    for (std::size_t k = 0; k < points.size(); ++k) CHECK(part.rows[k] == whole.rows[points[k]]);
  }
}

TEST_CASE("masses and lengths that are varied have paths of their own") {
  const SweepPlan plan =
      plan_of("hoop6_sector", {"structure.density=1000,4000", "structure.post_length=0.7,1.9"});
  for (const auto& row : run(plan).rows) {
    const exact::Hoop hoop{.l2 = number_of(row[1]), .density = number_of(row[0])};
    CHECK(time_of(plan, row) == Approx(hoop.time(0.0)).epsilon(1e-12));
  }
}

TEST_CASE("what a quadrature cannot tell goes the usual way, with the same answer") {
  // A spring at the fold angle: no constant force. A pulling force: it folds up and never deploys in time.
  const std::string spring =
      R"(forces=[{kind="torsion_spring",fold_angle=true,stiffness=1e-9,free_angle=0}])";
  const std::vector<std::string> axis{"structure.fold_angle=41,73"};
  const SweepPlan plain = plan_of("hoop6", axis), sprung = plan_of("hoop6", axis, {spring});
  std::vector<std::string> ignored;
  CHECK_FALSE(PathSweep(sprung).measure(0, ignored));
  const Table a = run(plain), b = run(sprung);
  for (std::size_t i = 0; i < a.rows.size(); ++i)
    // 1e-9 N m of 1e3 are 1e-12 of the motion.
    CHECK(time_of(plain, a.rows[i]) == Approx(time_of(sprung, b.rows[i])).epsilon(3e-12));
  const SweepPlan closing = plan_of("hoop6_sector", {"structure.hinge_force=-50,50"}, {"solver.end_time=2"});
  const Table c = run(closing);
  CHECK(c.rows[0][1] == "completed");
  CHECK(std::isinf(time_of(closing, c.rows[0])));
}

TEST_CASE("gravity and loads work along the path of a sweep as in a run") {
  const std::string weak = R"(forces=[{kind="torsion_spring",fold_angle=true,stiffness=1e-9,free_angle=0}])";
  const std::vector<std::string> axis{"structure.fold_angle=41,63"};
  double without = 0;
  for (const std::string more :
       {"", "gravity.acceleration=[0.4,-1.1,-2.3]", "loads=[{nodes=[\"*\"],force=[0.2,0.1,-0.3]}]"}) {
    INFO(more);
    std::vector<std::string> changes{"solver.end_time=20", "solver.stages=5"};
    if (!more.empty()) changes.push_back(more);
    const SweepPlan plain = plan_of("scissor_mast", axis, changes);
    std::vector<std::string> row;
    CHECK(PathSweep(plain).measure(0, row));
    changes.push_back(weak);
    const SweepPlan full = plan_of("scissor_mast", axis, changes);
    CHECK_FALSE(PathSweep(full).measure(0, row));
    const Table a = run(plain), b = run(full);
    for (std::size_t i = 0; i < a.rows.size(); ++i)  // 1e-9 N m of some 100, and steps of 0.01 s at order 8
      CHECK(time_of(plain, a.rows[i]) == Approx(time_of(full, b.rows[i])).epsilon(1e-10));
    if (more.empty())
      without = time_of(plain, a.rows[1]);
    else
      CHECK(std::abs(time_of(plain, a.rows[1]) - without) > 1e-3);
  }
}

// Their points are what every other run of them is: errors.
TEST_CASE("values that are no TOML are no numbers of a path") {
  for (const char* value : {".5", "5.", "011"}) {
    INFO(value);
    std::vector<std::string> ignored;
    CHECK_FALSE(PathSweep(plan_of("scissor_mast", {"structure.tip_force=10," + std::string(value) + ",20"}))
                    .measure(0, ignored));
  }
  std::vector<std::string> row;
  CHECK(PathSweep(plan_of("scissor_mast", {"structure.tip_force=10,2e1,0.5,40"})).measure(0, row));
}

TEST_CASE("a sweep over the method, or of what it makes, solves the full model") {
  for (const SweepPlan& plan :
       {plan_of("hoop6_sector", {"solver.stages=2,3"}, {"structure.fold_angle=40"}),
        plan_of("hoop6_sector", {"structure.fold_angle=40,41"}, {}, "newton_iterations")}) {
    std::vector<std::string> ignored;
    CHECK_FALSE(PathSweep(plan).measure(0, ignored));
    const Table table = run(plan);
    CHECK(table.rows[0][2] != table.rows[1][2]);
  }
  const Table two = run(plan_of("hoop6_sector", {"solver.stages=2,3"}, {"structure.fold_angle=40"}));
  // Order 2 at h = 0.01 is off by some 1e-5 s.
  CHECK(std::abs(number_of(two.rows[0][2]) - exact::Hoop{.fold_angle_deg = 40}.time(0.0)) > 1e-8);
}

}  // namespace path_sweep_test
