// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/sweep.hpp"
#include "tests/support/hoop_exact.hpp"

using namespace unfurl;

namespace sweep_test {

namespace {

SweepPlan ring_plan() {
  SweepPlan plan{{find_scene("hoop6_sector"), {}}, {parse_axis("structure.fold_angle=40:80:3")}, {}, {}};
  plan.measures.push_back(find_measure("deploy_time"));
  return plan;
}

}  // namespace

TEST_CASE("axes are ranges, log ranges or lists") {
  CHECK(parse_axis("a.b=1:3:5").numbers == std::vector<double>{1, 1.5, 2, 2.5, 3});
  CHECK(parse_axis("a=1:100:3:log").numbers == std::vector<double>{1, 10, 100});
  CHECK(parse_axis("solver.method=dvm,rk4").values == std::vector<std::string>{"dvm", "rk4"});
  CHECK(parse_axis("solver.method=dvm,rk4").numbers.empty());
  for (const char* bad : {"a", "a=", "=1:2:3", "a=1:2", "a=1:2:0", "a=1:2:2.5", "a=1:1:3", "a=0:1:3:log",
                          "a=1:2:3:lin", "a=x:2:3", "a=1,,2", "a=1,1"})
    CHECK_THROWS_AS(parse_axis(bad), StudyError);
}

TEST_CASE("a range of one is its beginning") {
  CHECK(parse_axis("a=2.5:7:1").numbers == std::vector<double>{2.5});
  CHECK(parse_axis("a=2.5:7:1:log").numbers == std::vector<double>{2.5});
}

TEST_CASE("shards part the points and nothing else is one") {
  CHECK(parse_shard("2/8").index == 2);
  for (const char* bad : {"0/8", "9/8", "1/0", "1", "a/b", "1.5/3"})
    CHECK_THROWS_WITH(parse_shard(bad), Catch::Contains("a shard is I/N"));
}

TEST_CASE("a sweep finds the deployment times of the exact ring, on any number of threads and shards") {
  SweepPlan plan = ring_plan();
  check_plan(plan);
  Journal journal({}, plan.columns(), plan.axes.size());
  StudyHooks two;
  two.threads = 2;
  const Sweep sweep = run_sweep(plan, journal, two);
  REQUIRE(sweep.table.rows.size() == 3);
  for (const auto& row : sweep.table.rows) {
    exact::Hoop exact;
    exact.fold_angle_deg = number_of(row[0]);
    // Three Lobatto nodes at h = 0.01 s: 1e-7 s at the deployment in the six-unit ring's own tests.
    CHECK(number_of(row[2]) == Approx(exact.time(0)).margin(1e-6));
  }
  plan.shard = {2, 2};
  Journal other({}, plan.columns(), plan.axes.size());
  const Sweep shard = run_sweep(plan, other, {});
  REQUIRE(shard.table.rows.size() == 1);
  CHECK(shard.missing.empty());
  CHECK(shard.table.rows[0] == sweep.table.rows[points_of_shard(plan)[0]]);
}

TEST_CASE("shards part a grid evenly, and none gets one value of an axis alone") {
  // As many shards as the last axis has values: every fourth point would give each of them one of those, and
  // larger structures cost more.
  SweepPlan plan = ring_plan();
  plan.axes = {parse_axis("structure.fold_angle=40:80:50"), parse_axis("structure.units=4,8,16,64")};
  std::vector<int> seen(plan.points(), 0);
  for (int index = 1; index <= 4; ++index) {
    plan.shard = {index, 4};
    std::set<std::string> units;
    const auto points = points_of_shard(plan);
    CHECK(points.size() == 50);
    std::size_t large = 0;
    for (const std::size_t point : points) {
      ++seen[point];
      units.insert(plan.key(point)[1]);
      large += plan.key(point)[1] == "64" ? 1 : 0;
    }
    CHECK(units.size() == 4);
    // 12.5 on average, with a deviation of 2.7 in a random order: no shard with twice its part.
    CHECK(large < 25);
  }
  CHECK(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
}

TEST_CASE("a column that only this scene has is a measure") {
  const auto ring = build_model(read_scene_file(find_scene("hoop6_motor"), {}));
  const auto columns = columns_of(ring);
  CHECK(find_measure("max:motor.torque_N_m", columns).column == "max_motor.torque_N_m");
  CHECK_THROWS_WITH(find_measure("max:motor.torque_Nm", columns),
                    Catch::Contains("did you mean 'motor.torque_N_m'"));
  CHECK_THROWS_AS(
      find_measure("max:motor.torque_N_m", columns_of(build_model(read_scene_file(find_scene("hoop6"), {})))),
      StudyError);
}

TEST_CASE("axes of figures are called by words and units") {
  const auto titles = [](const char* scene, std::vector<std::string> overrides, const char* axis) {
    SweepPlan plan{{find_scene(scene), std::move(overrides)}, {parse_axis(axis)}, {}, {}};
    plan.measures.push_back(find_measure("deploy_time"));
    check_plan(plan);
    return std::pair(plan.axes[0].title(), plan.axes[0].title(0));
  };
  using Pair = std::pair<std::string, std::string>;
  CHECK(titles("hoop6", {}, "structure.fold_angle=30:80:3") ==
        Pair("fold angle (\u00B0)", "fold angle = 30\u00B0"));
  CHECK(titles("hoop6", {"solver.step=0.02"}, "solver.step=0.01,0.05") ==
        Pair("solver step (s)", "solver step = 0.01 s"));
  CHECK(titles("hoop6", {}, "solver.method=dvm,rk4") == Pair("solver method", "solver method = dvm"));
  CHECK(titles("pendulum", {}, "gravity.acceleration[2]=-9.81,0").first ==
        "gravity acceleration[2] (m/s\u00B2)");
  CHECK(titles("four_bar", {"structure.nodes.A.mass=1"}, "structure.nodes.B.mass=1:2:3").first ==
        "nodes B mass (kg)");
}

TEST_CASE("unknown measures and keys are named") {
  CHECK_THROWS_WITH(find_measure("deploytime"), Catch::Contains("did you mean 'deploy_time'"));
  CHECK_THROWS_WITH(find_measure("max:kinetic_energy"), Catch::Contains("did you mean 'kinetic_energy_J'"));
  SweepPlan plan = ring_plan();
  plan.axes[0].key = "structure.fold_angl";
  CHECK_THROWS_WITH(check_plan(plan), Catch::Contains("did you mean 'fold_angle'"));
  plan.axes.clear();
  CHECK_THROWS_WITH(check_plan(plan), Catch::Contains("nothing to vary"));
}

}  // namespace sweep_test
