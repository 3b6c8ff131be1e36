// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
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

TEST_CASE("a range meets the whole numbers between its ends") {
  const SweepAxis axis = parse_axis("structure.cells=1:50:50");
  REQUIRE(axis.numbers.size() == 50);
  for (int i = 0; i < 50; ++i) CHECK(axis.numbers[static_cast<std::size_t>(i)] == i + 1);
  CHECK(parse_axis("x=-7:993:1001").numbers[777] == 770);
  CHECK(parse_axis("x=0.5:2.5:21").values[3] == "0.8");
  CHECK(parse_axis("x=1:1000:4:log").values[2] == "100");
  CHECK(parse_axis("x=1e-3:1e15:19:log").numbers[1] == 0.01);
  CHECK(parse_axis("x=0.001:1000:7:log").numbers == std::vector<double>{0.001, 0.01, 0.1, 1, 10, 100, 1000});
  CHECK(parse_axis("x=0.3:3e-9:9:log").values[4] == "3e-05");
  CHECK(parse_axis("x=1e-6:1e3:4:log").numbers == std::vector<double>{1e-6, 1e-3, 1, 1000});
  CHECK(parse_axis("x=0:1.5:6").values == std::vector<std::string>{"0", "0.3", "0.6", "0.9", "1.2", "1.5"});
  CHECK(parse_axis("x=0.12345678901234567:1:3:log").numbers[0] == 0.12345678901234567);  // ends as they are
  CHECK(parse_axis("x=0.001:1e15:3").numbers[0] == 0.001);
  CHECK(parse_axis("x=1e15:0.12345678901234567:3").numbers.back() == 0.12345678901234567);  // 0.125 by steps
  CHECK(parse_axis("x=1:0.12345678901234567:3:log").numbers.back() == 0.12345678901234567);
}

TEST_CASE("axes are ranges, log ranges or lists") {
  CHECK(parse_axis("a.b=1:3:5").numbers == std::vector<double>{1, 1.5, 2, 2.5, 3});
  CHECK(parse_axis("a=1:100:3:log").numbers == std::vector<double>{1, 10, 100});
  CHECK(parse_axis("solver.method=dvm,rk4").values == std::vector<std::string>{"dvm", "rk4"});
  CHECK(parse_axis("solver.method=dvm,rk4").numbers.empty());
  for (const char* bad : {"a", "a=", "=1:2:3", "a=1:2", "a=1:2:0", "a=1:2:2.5", "a=1:1:3", "a=0:1:3:log",
                          "a=1:2:3:lin", "a=x:2:3", "a=1,,2", "a=1,1"})
    CHECK_THROWS_AS(parse_axis(bad), StudyError);
}

// The inner nodes of seven units meet at 9/14 of 100 degrees; the scene's own fold angle is 70.
TEST_CASE("a sweep stands on a point that is right where the scene as it stands is not") {
  const auto plan_of = [](const std::vector<std::string>& axes) {
    SweepPlan plan{{find_scene("hoberman"), {"structure.units=7"}}, {}, {}, {}};
    for (const std::string& axis : axes) plan.axes.push_back(parse_axis(axis));
    plan.measures.push_back(find_measure("deploy_time"));
    return plan;
  };
  SweepPlan plan = plan_of({"structure.fold_angle=68,20,40", "solver.end_time=3,4"});
  CHECK_THROWS_AS(build_model(plan.source.read()), SceneError);
  stand_on_a_point(plan);
  check_plan(plan);
  CHECK(scene_number(plan.source.read(), "structure.fold_angle") == 20.0);
  CHECK(plan.axes[0].unit == "deg");
  CHECK(scene_number(plan.source.read(plan.changes(5)), "structure.fold_angle") == 40.0);
  CHECK(scene_number(plan.source.read(plan.changes(5)), "solver.end_time") == 4.0);
  // With no such point what is wrong is said of the scene; one that is right is left as it is.
  SweepPlan none = plan_of({"structure.fold_angle=66:80:3"}), right = plan_of({"structure.units=4,5"});
  CHECK_THROWS_WITH(stand_on_a_point(none), Catch::Contains("with 7 units the inner nodes meet"));
  right.source.overrides.clear();
  stand_on_a_point(right);
  CHECK(right.source.overrides.empty());
}

TEST_CASE("what does nothing at every point of a sweep is told, what does something at one is not") {
  // No two rods meet at A; a weight is given back where there is one.
  const auto text = std::make_shared<const std::string>(R"(
structure.kind = "custom"
structure.nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1, 0, 0]}]
structure.rods = [{nodes = ["O", "A"], mass = 1}]
[[forces]]
kind = "joint_damping"
nodes = ["A"]
damping = 0.1
[[forces]]
kind = "offload"
nodes = ["A"]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
end_time = 0.1
)");
  const auto told = [&](const char* axis) {
    SweepPlan plan{{"one.toml", {}, text, "."}, {parse_axis(axis)}, {}, {}};
    plan.measures.push_back(find_measure("final:kinetic_energy_J"));
    Journal journal({}, plan.columns(), plan.axes.size(), plan.number_columns());
    const Sweep sweep = run_sweep(plan, journal, {});
    CHECK(unanswered(plan, sweep) == 0);
    return sweep.warnings;
  };
  const std::string damping =
      "at every point: force \"joint_damping of A\" does nothing: no two rods meet at A";
  CHECK(told("solver.end_time=0.1,0.2,0.3") == std::vector<std::string>{damping});
  CHECK(told("gravity.acceleration[2]=-1,0") == std::vector<std::string>{damping});
  CHECK(told("gravity.acceleration[2]=0,-1,-2") == std::vector<std::string>{damping});
}

TEST_CASE("what does nothing is told of the points that have a run") {
  const auto text = std::make_shared<const std::string>(R"(
variables.L = 1
structure.kind = "custom"
structure.nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = ["=L", 0, 0]}]
structure.rods = [{nodes = ["O", "A"], mass = 1}]
[[forces]]
kind = "joint_damping"
nodes = ["A"]
damping = 0.1
[solver]
end_time = 0.1
)");
  const auto told = [&](const char* axis) {
    SweepPlan plan{{"one.toml", {}, text, "."}, {parse_axis(axis)}, {}, {}};
    plan.measures.push_back(find_measure("final:kinetic_energy_J"));
    Journal journal({}, plan.columns(), plan.axes.size(), plan.number_columns());
    return run_sweep(plan, journal, {}).warnings.at(0);
  };
  CHECK(told("variables.L=1,2").starts_with("at every point: "));
  CHECK(told("variables.L=0,1,2").starts_with("at all 2 points with a run: "));  // a rod of no length is none
  CHECK(told("variables.L=0,1").starts_with("at the one point with a run: "));
  // With the point of 1 m there already.
  const auto told_now = [&](const char* axis) {
    SweepPlan plan{{"one.toml", {}, text, "."}, {}, {}, {}};
    plan.measures.push_back(find_measure("final:kinetic_energy_J"));
    plan.axes = {parse_axis("variables.L=1")};
    Journal journal({}, plan.columns(), plan.axes.size(), plan.number_columns());
    run_sweep(plan, journal, {});
    plan.axes = {parse_axis(axis)};
    return run_sweep(plan, journal, {}).warnings.at(0);
  };
  CHECK(told_now("variables.L=1,2").starts_with("at the one point computed now: "));
  CHECK(told_now("variables.L=0,1,2,3").starts_with("at all 2 points computed now with a run: "));
}

TEST_CASE("a range of one is its beginning") {
  CHECK(parse_axis("a=2.5:7:1").numbers == std::vector<double>{2.5});
  CHECK(parse_axis("a=2.5:7:1:log").numbers == std::vector<double>{2.5});
}

TEST_CASE("ranges run evenly from end to end, log ranges by equal factors") {
  for (const int count : {2, 3, 7, 11}) {
    const SweepAxis even = parse_axis("a.b=-1.7:5.3:" + std::to_string(count));
    const SweepAxis log = parse_axis("a.b=0.3:47:" + std::to_string(count) + ":log");
    CHECK_FALSE(even.log);
    CHECK(log.log);
    REQUIRE((even.numbers.size() == static_cast<std::size_t>(count) &&
             log.numbers.size() == even.numbers.size()));
    for (std::size_t i = 0; i < even.numbers.size(); ++i) {
      const double u = static_cast<double>(i) / (count - 1);
      CHECK(even.numbers[i] == Approx(-1.7 + 7 * u).epsilon(1e-14).margin(1e-15));
      CHECK(std::log(log.numbers[i]) == Approx(std::log(0.3) + u * std::log(47 / 0.3)).epsilon(1e-14));
      CHECK(number_of(even.values[i]) == even.numbers[i]);
    }
    CHECK(even.numbers.back() == 5.3);  // as it was written, not rounded
    CHECK(log.numbers.back() == 47);
    CHECK(even.key == "a.b");
  }
  CHECK(parse_axis("a=5:2:4").numbers == std::vector<double>{5, 4, 3, 2});
  CHECK(parse_axis("a=1:2:1000000").numbers.size() == 1000000);
  CHECK(parse_axis("a=3,1,2.5").numbers == std::vector<double>{3, 1, 2.5});
  CHECK(parse_axis("a=1,x,2").values == std::vector<std::string>{"1", "x", "2"});
  CHECK(parse_axis("a=1,inf").numbers.empty());  // no place on an axis of numbers
}

TEST_CASE("values that differ in late digits only have names that differ") {
  const SweepAxis axis = parse_axis("structure.length=1.0000001,1.0000002,3");
  CHECK(axis.title(0) == "length = 1.0000001");
  CHECK(axis.title(1) == "length = 1.0000002");
  // Of many, those around them tell them apart: twenty to each side.
  std::string many = "structure.length=3";
  for (int i = 1; i < 60; ++i)
    many += "," + std::string(i == 15 || i == 35 ? "0.12345670" : "0.5432100") + std::to_string(100 + i);
  const SweepAxis list = parse_axis(many);
  CHECK(list.title(15) == "length = 0.1234567012");  // ...0115 and ...0135: ten digits
  CHECK(list.title(35) == "length = 0.1234567014");
  std::string far = "structure.length=0.123456701";
  for (int i = 1; i < 65; ++i)
    far += "," + (i == 32 ? "0.123456702" : i == 64 ? "0.123456703" : std::to_string(i) + ".5");
  CHECK(parse_axis(far).title(32) == "length = 0.123457");
  const SweepAxis thirds = parse_axis("structure.length=0:1:4");
  CHECK(thirds.title(1) == "length = 0.333333");
}

TEST_CASE("what is no axis is told why") {
  const struct {
    const char *axis, *why;
  } rows[] = {
      {"a", "must be KEY=FROM:TO:COUNT, KEY=FROM:TO:COUNT:log or KEY=A,B,C"},
      {"=1:2:3", "must be KEY=FROM:TO:COUNT, KEY=FROM:TO:COUNT:log or KEY=A,B,C"},
      {"a=", "must be KEY=FROM:TO:COUNT, KEY=FROM:TO:COUNT:log or KEY=A,B,C"},
      {"a=1:2", "a range is FROM:TO:COUNT"},
      {"a=1:2:3:log:5", "a range is FROM:TO:COUNT"},
      {"a=1:inf:3", "a range runs from one finite number to another"},
      {"a=x:2:3", "a range runs from one finite number to another"},
      {"a=1:2:0", "the count must be a whole number from 1 to 1000000; got '0'"},
      {"a=1:2:2.5", "the count must be a whole number from 1 to 1000000; got '2.5'"},
      {"a=1:2:1000001", "the count must be a whole number from 1 to 1000000; got '1000001'"},
      {"a=1:2:3:lin", "only 'log' may follow the count"},
      {"a=0:2:3:log", "a log range needs numbers > 0"},
      {"a=2:-1:3:log", "a log range needs numbers > 0"},
      {"a=2:2:3", "the range is empty; its ends are equal"},
      {"a=-1e308:1e308:3", "the range is wider than numbers are"},
      {"a=1e300:1e-300:3:log", "the range is wider than numbers are"},
      {"a=1:1.0000000000000004:5", "there are not so many numbers between its ends"},
      {"a=1,,2", "the list has an empty entry"},
      {"a=1,2,1", "'1' is there twice"},
      {"a=2,30,30.0", "'30' and '30.0' are the same number"},
      {"a=1e1,10", "'1e1' and '10' are the same number"},
      {"a=[0,0,-9.81],[0,0,0]", "lists and tables cannot be varied; vary one of their entries, a[2]=A,B,C"}};
  for (const auto& row : rows)
    CHECK_THROWS_WITH(parse_axis(row.axis), "'" + std::string(row.axis) + "': " + row.why);
  CHECK(parse_axis("a=2:2:1").numbers == std::vector<double>{2});
}

TEST_CASE("points of a grid are counted with the last axis fastest") {
  SweepPlan plan{{find_scene("hoop6_sector"), {}},
                 {parse_axis("a=1,2"), parse_axis("b=x,y,z"), parse_axis("c=0.5,0.25,0.75,4")},
                 {},
                 {}};
  REQUIRE(plan.points() == 24);
  std::size_t point = 0;
  for (const char* a : {"1", "2"})
    for (const char* b : {"x", "y", "z"})
      for (const char* c : {"0.5", "0.25", "0.75", "4"})
        CHECK(plan.key(point++) == std::vector<std::string>{a, b, c});
  plan.measures = {find_measure("deploy_time"), find_measure("peak_rod_force")};
  CHECK(plan.columns() ==
        std::vector<std::string>{"a", "b", "c", "outcome", "deploy_time_s", "peak_rod_force_N"});
  CHECK(plan.number_columns() == std::vector<std::size_t>{4, 5});
  // More than anybody can count is only known to be too many.
  plan.axes.assign(5, parse_axis("a=1:2:10000"));
  CHECK(plan.points() == 10'000'001);
  plan.axes.resize(1);
  CHECK(plan.points() == 10'000);
}

TEST_CASE("a plan is refused with its reason, and says which forces are unique") {
  const auto refusal = [](std::vector<std::string> axes, std::vector<std::string> measures) -> std::string {
    SweepPlan plan{{find_scene("hoop6_sector"), {}}, {}, {}, {}};
    for (const auto& axis : axes) plan.axes.push_back(parse_axis(axis));
    for (const auto& name : measures) plan.measures.push_back(find_measure(name));
    try {
      check_plan(plan);
    } catch (const Error& error) {
      return error.what();
    }
    std::string names;
    for (const RunMeasure& measure : plan.measures) names += measure.name + " ";
    return names;
  };
  const std::vector<std::string> angle = {"structure.fold_angle=40:80:3"};
  CHECK(refusal({}, {"deploy_time"}) == "nothing to vary; give --vary KEY=FROM:TO:COUNT");
  CHECK(refusal(angle, {}) == "nothing to measure; give --measure NAME,...");
  CHECK(refusal({angle[0], "solver.step=0.01:0.02:2", angle[0]}, {"deploy_time"}) ==
        "the key 'structure.fold_angle' is varied twice");
  CHECK(refusal({"structure.units=4:9:2", "solver.step=0.01:0.02:2"}, {"deploy_time"}) == "deploy_time ");
  CHECK(refusal({"structure.units=4:9:3"}, {"deploy_time"}) ==
        "'structure.units' takes whole numbers; 6.5 is none: give a COUNT that leads to some, or list them "
        "(structure.units=4,6,12)");
  CHECK(refusal({"structure.fold_angle=40:80:4000", "solver.step=0.01:0.02:2500"}, {"deploy_time"}) ==
        "deploy_time ");
  CHECK(refusal({"structure.fold_angle=40:80:4000", "solver.step=0.01:0.02:2501"}, {"deploy_time"}) ==
        "the grid has more than 1e7 points, 1e7: structure.fold_angle (4000) x solver.step (2501)");
  CHECK(refusal(angle, {"peak_tension", "deploy_time"}) == "peak_tension deploy_time peak_tension_unique ");
  CHECK(refusal(angle, {"peak_tension_unique", "peak_tension"}) == "peak_tension_unique peak_tension ");
}

TEST_CASE("two names of one thing are not varied together, two things are") {
  const auto said = [](const char* scene, const char* first, const char* second) -> std::string {
    SweepPlan plan{{find_scene(scene), {}}, {parse_axis(first), parse_axis(second)}, {}, {}};
    plan.measures = {find_measure("peak_energy")};
    try {
      check_plan(plan);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::string same = " are names of the same thing, or one is part of the other: vary one of them";
  CHECK(said("double_pendulum", "structure.nodes.tip.mass=0,1", "structure.nodes[2].mass=2,3") ==
        "'structure.nodes.tip.mass' and 'structure.nodes[2].mass'" + same);
  CHECK(said("double_pendulum", "structure.nodes['tip'].mass=0,1", "structure.nodes[tip].mass=2,3")
            .ends_with(same));
  CHECK(said("double_pendulum", "structure.nodes.tip.mass=0,1", "structure.nodes[1].mass=2,3").empty());
  CHECK(said("double_pendulum", "gravity.acceleration[2]=-9,-8", "gravity.acceleration[1]=1,2").empty());
}

TEST_CASE("shards part the points and nothing else is one") {
  CHECK(parse_shard("2/8").index == 2);
  CHECK(parse_shard("2/8").count == 8);
  CHECK(parse_shard("1000000/1000000").index == 1000000);
  for (const char* bad : {"0/8", "9/8", "1/0", "1", "a/b", "1.5/3", "1/2.5", "1/1000001", "1/2/3", ""})
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
    CHECK(number_of(row[2]) == Approx(exact.time(0)).epsilon(0).margin(1e-6));
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
  CHECK(titles("hoop6", {}, "structure.density=1000:3000:3") ==
        Pair("density (kg/m\u00B3)", "density = 1000 kg/m\u00B3"));
  const std::string spring = "forces[0]={kind='torsion_spring', fold_angle=true, stiffness=1}";
  CHECK(titles("hoop6", {spring}, "forces[0].stiffness=1:2:3").first == "forces[0] stiffness (N m/rad)");
  CHECK(titles("four_bar", {"structure.nodes.A.mass=1"}, "structure.nodes.B.mass=1:2:3").first ==
        "nodes B mass (kg)");
  const auto called = [](const char* axis) { return parse_axis(axis).title(); };
  CHECK(called("forces[drag_1].damping=1:2:3") == "drag_1 damping");  // by its own name
  CHECK(called("forces[\"a.b\"].free_length=1:2:3") == "a.b free length");
  CHECK(called("forces[0].damping=1:2:3") == "forces[0] damping");
  CHECK(called("variables.crank_mass=1:2:3") == "crank mass");
}

TEST_CASE("a value that no scene takes is a row of its own wherever it stands in the list") {
  const auto unit = [](const std::string& axis) {
    SweepPlan plan{{find_scene("hoop6_sector"), {}}, {parse_axis(axis)}, {find_measure("deploy_time")}, {}};
    check_plan(plan);
    return plan.axes[0].unit;
  };
  for (const char* values : {"30,0,60", "0,30,60", "30,60,0", "0,-1,60"}) {
    INFO(values);
    CHECK(unit(std::string("structure.fold_angle=") + values) == "deg");
  }
  CHECK_THROWS_WITH(unit("structure.fold_angle=0,-1"), Catch::Contains("fold_angle"));
  SweepPlan plan{{find_scene("hoop6_sector"), {}}, {parse_axis("structure.fold_angle=0,60")}, {}, {}};
  plan.measures.push_back(find_measure("end_time"));
  check_plan(plan);
  Journal journal({}, plan.columns(), plan.axes.size());
  const Sweep sweep = run_sweep(plan, journal, {});
  REQUIRE(sweep.table.rows.size() == 2);
  CHECK(sweep.table.rows[0][1] == "invalid");
  CHECK(sweep.table.rows[1][1] != "invalid");
}

TEST_CASE("rows of a sweep that no run leaves are not finished") {
  SweepPlan plan = ring_plan();
  plan.measures.clear();
  for (const char* name : {"deploy_time", "energy", "stress_margin", "max:energy_balance_J"})
    plan.measures.push_back(find_measure(name));
  using Row = std::vector<std::string>;
  // A run that ends before it is deployed would be deployed later (inf), and margins may have no bound.
  for (const Row& row :
       {Row{"40", "deployed", "5.6", "12", "nan", "-1e-9"}, Row{"40", "completed", "inf", "0", "inf", "0"},
        Row{"40", "completed", "nan", "0", "-1", "0"}, Row{"40", "failed", "nan", "nan", "nan", "nan"},
        Row{"40", "invalid", "nan", "nan", "nan", "nan"}}) {
    INFO(csv_line(row));
    CHECK(plan.is_finished(row));
  }
  for (const Row& row :
       {Row{"40", "banana", "5.6", "12", "1", "0"}, Row{"40", "", "5.6", "12", "1", "0"},
        Row{"40", "stopped", "5.6", "12", "1", "0"}, Row{"40", "deployed", "inf", "12", "1", "0"},
        Row{"40", "deployed", "nan", "12", "1", "0"}, Row{"40", "deployed", "-1", "12", "1", "0"},
        Row{"40", "completed", "-inf", "12", "1", "0"}, Row{"40", "completed", "inf", "nan", "1", "0"},
        Row{"40", "completed", "inf", "inf", "1", "0"}, Row{"40", "completed", "inf", "-12", "1", "0"},
        Row{"40", "completed", "inf", "12", "1", "nan"}}) {
    INFO(csv_line(row));
    CHECK_FALSE(plan.is_finished(row));
  }
}

// Whether a margin is unique is no question where no rod has one.
TEST_CASE("what has no value is unique or not, or has no such value either") {
  SweepPlan plan = ring_plan();
  plan.measures = {find_measure("peak_stress"), find_measure("peak_stress_unique")};
  for (const char* unique : {"0", "1", "nan"}) CHECK(plan.is_finished({"40", "deployed", "nan", unique}));
  for (const char* damaged : {"0.5", "-1", "inf"})
    CHECK_FALSE(plan.is_finished({"40", "deployed", "nan", damaged}));
}

TEST_CASE("unknown measures and keys are named") {
  CHECK_THROWS_WITH(find_measure("deploytime"), Catch::Contains("did you mean 'deploy_time'"));
  CHECK_THROWS_WITH(find_measure("max:kinetic_energy"), Catch::Contains("did you mean 'kinetic_energy_J'"));
  SweepPlan plan = ring_plan();
  plan.axes[0].key = "structure.fold_angl";
  CHECK_THROWS_WITH(check_plan(plan), Catch::Contains("did you mean 'fold_angle'"));
  plan = ring_plan();
  plan.measures.push_back(plan.measures.front());
  CHECK_THROWS_WITH(check_plan(plan), Catch::Contains("is asked for twice"));
  plan.axes.clear();
  CHECK_THROWS_WITH(check_plan(plan), Catch::Contains("nothing to vary"));
}

}  // namespace sweep_test
