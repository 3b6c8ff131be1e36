// SPDX-License-Identifier: BSD-3-Clause
// What studies plan and report, number by number: tables made of numbers that are known, plans of scenes that
// are.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/study/models.hpp"
#include "core/study/order_fit.hpp"
#include "core/study/stress.hpp"
#include "core/study/study.hpp"
#include "core/study/sweep.hpp"
#include "core/study/table.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace accounts_test {

namespace {

MeasuredRun measured(long steps, double step, double error, double cpu) {
  MeasuredRun r;
  r.outcome = "ok";
  r.steps = steps;
  r.step = step;
  r.position_error = error;
  r.constraint_max = 3e-12;
  r.constraint_relative_max = 4e-13;
  r.constraint_velocity_max = 5e-11;
  r.energy_error = 0.007;
  r.newton_iterations = 81;
  r.factorisations = 17;
  r.linear_solves = 99;
  r.cpu_min = 0.9 * cpu;
  r.cpu_median = cpu;
  r.cpu_max = 1.3 * cpu;
  r.repeats = 4;
  return r;
}

std::map<std::string, std::string> cells(const Table& table, std::size_t row) {
  std::map<std::string, std::string> out;
  REQUIRE(table.rows.at(row).size() == table.columns.size());
  for (std::size_t c = 0; c < table.columns.size(); ++c) out[table.columns[c]] = table.rows[row][c];
  return out;
}

// A custom scene with a load, gravity, two groups of rods, a velocity and a damped spring.
SceneSource pair_of_rods() {
  return {"pair.toml", {}, std::make_shared<const std::string>(R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [1.1, 0, 0.2], velocity = [0, 0.7, 0]},
  {name = "B", position = [1.9, 0.4, 0.2], mass = 0.3}]
rods = [
  {nodes = ["O", "A"], mass = 1.5, group = "thick"},
  {nodes = ["A", "B"], mass = 0.4, group = "thin"}]
[[loads]]
nodes = ["B"]
force = [0.5, -2, 3]
[[forces]]
kind = "spring"
nodes = ["O", "B"]
stiffness = 35
damping = 0.25
[gravity]
acceleration = [0, 0.3, -9]
[solver]
step = 0.01
end_time = 2.1
)")};
}

}  // namespace

TEST_CASE("the tables of a study say of each run what was measured") {
  Study study;
  study.reference_uncertainty = 2e-11;
  study.curves.resize(2);
  study.curves[0].setting = {"dvm s=4", dvm_options(4, 0.01, 1), 6};
  study.curves[0].runs = {measured(30, 0.1, 3e-4, 0.02), measured(60, 0.05, 7e-6, 0.04)};
  study.curves[0].order = {5.4, 5.1, 5.7, 2};
  study.curves[1].setting = {"rk4", dvm_options(4, 0.01, 1), 4};
  study.curves[1].setting.options.method = "rk4";
  study.curves[1].runs = {measured(30, 0.1, 1e-12, 0.03), measured(60, 0.05, 0.5, 0.01)};
  study.curves[1].runs[1].outcome = "solver failed";
  study.curves[1].order.order = std::nan("");
  study.curves[1].order.points = 1;
  const Table points = points_table(study);
  REQUIRE(points.rows.size() == 4);
  auto row = cells(points, 1);
  CHECK(row["setting"] == "dvm s=4");
  CHECK(row["method"] == "dvm");
  CHECK(row["stages"] == "4");
  CHECK(row["outcome"] == "ok");
  const std::map<std::string, double> numbers = {{"steps", 60},
                                                 {"step_s", 0.05},
                                                 {"position_error_m", 7e-6},
                                                 {"constraint_max_m", 3e-12},
                                                 {"constraint_relative_max", 4e-13},
                                                 {"constraint_velocity_max_m_s", 5e-11},
                                                 {"energy_error_max_J", 0.007},
                                                 {"newton_iterations", 81},
                                                 {"factorisations", 17},
                                                 {"linear_solves", 99},
                                                 {"cpu_median_s", 0.04},
                                                 {"cpu_min_s", 0.9 * 0.04},
                                                 {"cpu_max_s", 1.3 * 0.04},
                                                 {"repeats", 4}};
  for (const auto& [name, value] : numbers) {
    INFO(name);
    CHECK(number_of(row[name]) == value);
  }
  CHECK(cells(points, 3)["outcome"] == "solver failed");
  CHECK(cells(points, 2)["method"] == "rk4");
  const Table orders = orders_table(study);
  REQUIRE(orders.rows.size() == 2);
  row = cells(orders, 0);
  CHECK(row["claimed order"] == "6");
  CHECK(row["observed order"] == "5.4");
  CHECK(row["95 % interval"] == "5.1 to 5.7");
  CHECK(row["from points"] == "2");
  CHECK(row["best error (m)"] == "7e-6");
  CHECK(row["its step (s)"] == "0.05");
  CHECK(row["its CPU (s)"] == "0.04");
  CHECK(row["constraint error (m)"] == "3e-12");
  CHECK(row["energy error (J)"] == "0.007");
  row = cells(orders, 1);
  CHECK(row["observed order"] == "too few points");
  CHECK(row["best error (m)"] == "below 2e-11");  // of the run that did not fail
  CHECK(row["its step (s)"] == "0.1");
  CHECK(reference_words(study) == "it agrees with itself to 2e-11 m");
  study.reference_confirmed = true;
  CHECK(reference_words(study) == "dvm and extrapolation agree to 2e-11 m");
}

TEST_CASE("a run is measured by its own steps, work and errors") {
  const auto model = make_model(double_pendulum());
  const Reference reference = solve_reference(model, 0.6, 6, {});
  SolverOptions options = dvm_options(3, 0.5, 9.0);  // replaced by the steps and the reference's end
  const MeasuredRun m = measure_run(model, options, 30, reference, {.repeats = 3}, {});
  CHECK(m.outcome == "ok");
  CHECK(m.steps == 30);
  CHECK(m.step == Approx(0.02).epsilon(1e-15));
  CHECK(m.repeats == 3);
  CHECK(m.cpu_min <= m.cpu_median);
  CHECK(m.cpu_median <= m.cpu_max);
  const Simulation run = simulate(model, dvm_options(3, m.step, 0.6));
  CHECK(m.newton_iterations == run.newton_iterations);
  CHECK(m.factorisations == run.factorisations);
  long solves = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) solves += run.trajectory.report(i).right_hand_sides;
  CHECK(m.linear_solves == solves);
  double worst = 0;
  for (std::size_t k = 0; k < reference.t.size(); ++k)
    for (int n = 0; n < 3; ++n)
      worst = std::max(
          worst,
          (run.trajectory.positions(5 * k).segment<3>(3 * n) - reference.q[k].segment<3>(3 * n)).norm());
  REQUIRE(reference.t.size() == 7);
  CHECK(m.position_error == Approx(worst).epsilon(1e-12));
  CHECK(m.position_error > 1e-9);
  // With other steps there is no state at the comparison times; without time there is no run.
  CHECK(std::isnan(measure_run(model, options, 31, reference, {.repeats = 1}, {}).position_error));
  CHECK(measure_run(model, options, 3000, reference, {.repeats = 1, .limit = 0}, {}).outcome == "too slow");
  CHECK(measure_run(model, options, 30, reference, {.repeats = 9, .patience = 0}, {}).repeats == 1);
  // A millisecond or two each: nine fit into half a second of CPU time.
  CHECK(measure_run(model, options, 30, reference, {.repeats = 9, .patience = 0.5}, {}).repeats == 9);
}

TEST_CASE("a ladder reaches from the largest to the smallest step that are asked for, and no further") {
  for (const double end : {2.9, 11.3})
    for (const auto& [largest, smallest] :
         {std::pair{0.31, 0.011}, {0.17, 0.0043}, {0.09, 0.045}, {0.7, 0.35}}) {
      INFO(end << " s, " << largest << " to " << smallest);
      const StepLadder ladder = make_ladder(end, 0.01, largest, smallest);
      for (std::size_t i = 0; i < ladder.steps.size(); ++i) {
        CHECK(ladder.steps[i] % ladder.grid == 0);
        if (i > 0) {
          CHECK(ladder.steps[i] > ladder.steps[i - 1]);
          CHECK(ladder.steps[i] <= 2 * ladder.steps[i - 1]);
        }
      }
      // The grid is rounded to whole numbers, rungs are factors of 4/3 to 2 apart.
      CHECK(end / static_cast<double>(ladder.steps.front()) <= 1.3 * largest);
      CHECK(end / static_cast<double>(ladder.steps.front()) >= largest / 1.3);
      CHECK(end / static_cast<double>(ladder.steps.back()) <= 1.5 * smallest);
      CHECK(end / static_cast<double>(ladder.steps.back()) >= smallest / 1.5);
    }
  // Eight times the scene's step to a sixteenth of it.
  const StepLadder own = make_ladder(6.4, 0.01, 0, 0);
  CHECK(own.steps.front() == 80);
  CHECK(own.steps.back() >= 7168);  // 0.7 of 10240
  CHECK(own.steps.back() <= 14336);
  // Limits themselves are allowed.
  CHECK_NOTHROW(make_ladder(8, 0.01, 2, 0.1));
  CHECK_NOTHROW(make_ladder(8, 0.01, 1.0, 1.0 / (1L << 14)));
  CHECK_THROWS_AS(make_ladder(8, 0.01, 1.0, 0.9 / (1L << 14)), StudyError);
  CHECK_THROWS_AS(make_ladder(8, 0.01, 1.0, 1.0), StudyError);
  CHECK_THROWS_AS(make_ladder(8, 0.01, 1.0, 0.0), StudyError);
}

TEST_CASE("settings of a study can be kept by method, by names that exist") {
  StudyPlan plan;
  plan.settings = study_settings(dvm_options(3, 0.01, 1));
  const std::size_t all = plan.settings.size();
  keep_methods(plan, {});
  CHECK(plan.settings.size() == all);
  CHECK_THROWS_WITH(keep_methods(plan, {"rk5"}),
                    Catch::Contains("no method 'rk5'") && Catch::Contains("rk4"));
  keep_methods(plan, {"rk4", "generalized_alpha"});
  CHECK(plan.settings.size() >= 2);
  for (const Setting& s : plan.settings)
    CHECK((s.options.method == "rk4" || s.options.method == "generalized_alpha"));
}

TEST_CASE("the interval of an order is that of Student's t for its number of points") {
  // 97.5 % quantiles (Abramowitz & Stegun, table 26.10); errors alternate by a factor about a power law.
  const std::map<int, double> quantiles = {{3, 12.706}, {4, 4.303},  {5, 3.182}, {7, 2.571},
                                           {9, 2.365},  {12, 2.228}, {40, 1.96}};
  for (const auto& [n, t] : quantiles) {
    std::vector<double> step, error;
    for (int i = 0; i < n; ++i) {
      step.push_back(std::exp(0.3 * i));
      error.push_back(std::exp(0.3 * 2.6 * i + (i % 2 ? 0.04 : -0.04)));
    }
    // Least squares in logarithms, spelt out.
    double mx = 0, my = 0, sxx = 0, sxy = 0, rest = 0;
    for (int i = 0; i < n; ++i) mx += 0.3 * i / n, my += std::log(error[static_cast<std::size_t>(i)]) / n;
    for (int i = 0; i < n; ++i) {
      sxx += (0.3 * i - mx) * (0.3 * i - mx);
      sxy += (0.3 * i - mx) * std::log(error[static_cast<std::size_t>(i)]);
    }
    for (int i = 0; i < n; ++i)
      rest += std::pow(std::log(error[static_cast<std::size_t>(i)]) - my - sxy / sxx * (0.3 * i - mx), 2);
    const ObservedOrder fit = fit_order(step, error);
    INFO(n << " points");
    CHECK(fit.points == n);
    CHECK(fit.order == Approx(sxy / sxx).epsilon(1e-10));
    CHECK(fit.high - fit.order == Approx(t * std::sqrt(rest / (n - 2) / sxx)).epsilon(1e-9));
    CHECK(fit.order - fit.low == Approx(fit.high - fit.order).epsilon(1e-9));
  }
}

TEST_CASE("each extreme changes what it says and nothing else") {
  const SceneSource source = pair_of_rods();
  const Structure plain = build_structure(source.read());
  const auto built = [&](const char* name, double value) {
    const StressPlan plan = plan_stress(source, {name});
    REQUIRE(plan.extremes.size() == 1);
    SolverOptions options;
    const auto model = plan.extremes[0].build(value, options);
    CHECK(options.end_time == 2.1);
    return model->structure;
  };
  const Structure heavy = built("mass_ratio", 1e3);
  CHECK(heavy.rods[0].mass == Approx(1500));
  CHECK(heavy.rods[1].mass == 0.4);
  CHECK(heavy.nodes[2].mass == 0.3);
  const Structure forced = built("force", 4e4);
  CHECK((forced.gravity - 4e4 * plain.gravity).norm() <= 1e-9);
  REQUIRE(forced.loads.size() == plain.loads.size());
  for (std::size_t i = 0; i < plain.loads.size(); ++i)
    CHECK((forced.loads[i].force - 4e4 * plain.loads[i].force).norm() <= 1e-9);
  CHECK((forced.nodes[1].velocity - Vec3(0, 140, 0)).norm() <= 1e-12);  // times the root
  CHECK(forced.rods[0].mass == plain.rods[0].mass);
  const Structure stiff = built("stiffness", 7e5);
  REQUIRE(stiff.forces.size() == 1);
  CHECK(stiff.forces[0].stiffness == 7e5);
  CHECK(stiff.forces[0].damping == 0.25);
  CHECK_THROWS_WITH(plan_stress(source, {"units"}),
                    Catch::Contains("cannot be driven to the extreme 'units'"));
  CHECK_THROWS_WITH(plan_stress(source, {"forse"}),
                    Catch::Contains("no extreme 'forse'; did you mean 'force'?"));
  const SceneSource ring{find_scene("hoop6_sector"), {}};
  SolverOptions options;
  const StressPlan folded = plan_stress(ring, {"fold_angle"}), more = plan_stress(ring, {"units"});
  CHECK(folded.extremes.at(0).build(12.5, options)->structure.deployment.initial_fold_angle ==
        Approx(77.5 * radians_per_degree).epsilon(1e-12));
  const auto units = more.extremes.at(0).build(9, options);
  CHECK(units->structure.sectors == 9);
}

TEST_CASE("an atlas is planned about the scene's own number of steps") {
  // 2.1 s in steps of 0.01 s: 210, the nearest power of two is 256; to a 32nd and to four times as many.
  const StressPlan plan = plan_stress(pair_of_rods(), {});
  CHECK(plan.steps == std::vector<long>{8, 16, 32, 64, 128, 256, 512, 1024});
  CHECK(plan.long_steps == 1'000'000);  // nothing deploys
  CHECK(plan.extremes.size() == 3);     // masses, forces, the spring
  CHECK(plan_stress({find_scene("hoop6_sector"), {}}, {}).long_steps == 0);
  for (const Setting& s : plan.settings) CHECK(s.name.find("s=5") == std::string::npos);
}

TEST_CASE("the tables of an atlas count its verdicts") {
  StressPlan plan;
  plan.settings.resize(2);
  plan.settings[0].name = "one";
  plan.settings[1].name = "two";
  Stress stress;
  const auto add = [&](const char* setting, Verdict v, int times) {
    for (int i = 0; i < times; ++i) {
      StressCell cell{"force", 2.5, setting, 128, v, measured(128, 0.02, 3e-4, 0.5)};
      cell.run.kinetic_energy_max = 77;
      cell.run.message = "said";
      stress.cells.push_back(cell);
    }
  };
  add("one", Verdict::right, 4);
  add("one", Verdict::inaccurate, 3);
  add("one", Verdict::too_slow, 2);
  add("two", Verdict::wrong_branch, 5);
  add("two", Verdict::energy_growth, 1);
  add("two", Verdict::constraint_lost, 6);
  add("two", Verdict::solver_failed, 7);
  const Table summary = summary_table(plan, stress);
  auto one = cells(summary, 0), two = cells(summary, 1);
  const std::map<std::string, std::string> first = {
      {"setting", "one"},     {"cells", "9"},           {"right", "4"},
      {"inaccurate", "3"},    {"too slow", "2"},        {"wrong branch", "0"},
      {"energy growth", "0"}, {"constraint lost", "0"}, {"solver failed", "0"}};
  CHECK(one == first);
  const std::map<std::string, std::string> second = {
      {"setting", "two"},     {"cells", "19"},          {"right", "0"},
      {"inaccurate", "0"},    {"too slow", "0"},        {"wrong branch", "5"},
      {"energy growth", "1"}, {"constraint lost", "6"}, {"solver failed", "7"}};
  CHECK(two == second);
  auto cell = cells(cells_table(stress), 4);
  CHECK(cell["verdict"] == "inaccurate");
  CHECK(cell["extreme"] == "force");
  CHECK(cell["value"] == "2.5");
  CHECK(cell["steps"] == "128");
  CHECK(cell["step_s"] == "0.02");
  CHECK(number_of(cell["position_error_m"]) == 3e-4);
  CHECK(number_of(cell["kinetic_energy_max_J"]) == 77);
  CHECK(number_of(cell["cpu_s"]) == 0.5);
  CHECK(cell["message"] == "said");
  CHECK(criterion(Verdict::wrong_branch) == "a node is off by more than 10 % of the structure's size");
  CHECK(criterion(Verdict::inaccurate) == "a node is off by more than 1 % of the structure's size");
  CHECK(criterion(Verdict::constraint_lost) == "a constraint is off by more than 0.1 % of a rod's length");
  CHECK(criterion(Verdict::energy_growth) ==
        "the energy balance is off by more than 5 % of the energy turned over");
  CHECK(criterion(Verdict::too_slow) == "no end within 3 s of CPU time");
}

TEST_CASE("choices of a model are those that the scene did not make") {
  const auto choices = model_choices(pair_of_rods());
  std::vector<std::string> changes;
  for (const ModelChoice& c : choices)
    for (const std::string& change : c.changes) changes.push_back(change);
  CHECK(choices.front().changes.empty());
  for (const char* wanted : {"solver.eliminate_linear=false", "solver.sparse=false", "structure.mass=lumped",
                             "forces[0].damping=0"}) {
    INFO(wanted);
    CHECK(std::count(changes.begin(), changes.end(), wanted) == 1);
  }
  for (const char* made : {"solver.eliminate_linear=true", "solver.sparse=true", "structure.mass=consistent",
                           "structure.model=sector"})
    CHECK(std::count(changes.begin(), changes.end(), made) == 0);
}

TEST_CASE("the tables of modelling choices say what was measured") {
  MeasuredModel base;
  base.choice.name = "as the scene says";
  base.outcome = "completed";
  base.solved_coordinates = 24;
  base.constraints = 31;
  base.cpu_min = 0.011, base.cpu_median = 0.012, base.cpu_max = 0.017, base.memory = 52000;
  base.difference = 0, base.deployment_time = std::nan("");
  MeasuredModel other = base;
  other.choice.name = "sector";
  other.solved_coordinates = 4;
  other.cpu_median = 0.003;
  other.difference = 2.5e-11;
  other.deployment_time = 4.9235;
  base.peak_force = other.peak_force = 1250.5;
  other.peak_unique = false;
  other.cpu_forces = 0.0045;
  const std::vector<MeasuredModel> models = {base, other};
  auto exact = cells(models_table(models), 1);
  CHECK(exact["model"] == "sector");
  CHECK(exact["outcome"] == "completed");
  CHECK(exact["solved_coordinates"] == "4");
  CHECK(exact["constraints"] == "31");
  CHECK(exact["cpu_min_s"] == "0.011");
  CHECK(exact["cpu_median_s"] == "0.003");
  CHECK(exact["cpu_max_s"] == "0.017");
  CHECK(exact["memory_bytes"] == "52000");
  CHECK(exact["difference_m"] == "2.5e-11");
  CHECK(exact["deployment_time_s"] == "4.9235");
  CHECK(exact["peak_rod_force_N"] == "1250.5");
  CHECK(exact["peak_unique"] == "0");
  CHECK(exact["cpu_forces_s"] == "0.0045");
  auto words = cells(models_summary(models), 1);
  CHECK(words["coordinates"] == "4");
  CHECK(words["constraints"] == "31");
  CHECK(words["CPU (ms)"] == "3");
  CHECK(words["CPU (times)"] == "0.25");
  CHECK(words["memory (kB)"] == "52");
  CHECK(words["difference in the answer (m)"] == "2.5e-11");
  CHECK(words["deployed at (s)"] == "4.9235");
  CHECK(words["peak rod force (N)"] == "1250.5 (not unique)");
  CHECK(words["forces (ms)"] == "4.5");
  CHECK(cells(models_summary(models), 0)["deployed at (s)"].empty());
}

TEST_CASE("points of a grid count through its last axis first, and columns follow the axes") {
  SweepPlan plan{pair_of_rods(),
                 {parse_axis("solver.step=0.01,0.02"), parse_axis("gravity.acceleration[2]=-9:-3:3"),
                  parse_axis("forces[0].stiffness=10:1000:3:log")},
                 {find_measure("peak_speed"), find_measure("energy")},
                 {}};
  CHECK(plan.points() == 18);
  CHECK(plan.key(0) == std::vector<std::string>{"0.01", "-9", "10"});
  CHECK(plan.key(1) == std::vector<std::string>{"0.01", "-9", "100"});
  CHECK(plan.key(3) == std::vector<std::string>{"0.01", "-6", "10"});
  CHECK(plan.key(17) == std::vector<std::string>{"0.02", "-3", "1000"});
  check_plan(plan);
  CHECK(plan.columns() == std::vector<std::string>{"solver.step", "gravity.acceleration[2]",
                                                   "forces[0].stiffness", "outcome", "peak_speed_m_s",
                                                   "energy_J"});
  CHECK(plan.number_columns() == std::vector<std::size_t>{4, 5});
  // Another program's list may be empty.
  plan.axes[1].values.clear();
  plan.axes[1].numbers.clear();
  CHECK_THROWS_WITH(check_plan(plan), Catch::Contains("no value is given for 'gravity.acceleration[2]'"));
  // A grid of more than 1e7 points, whatever the product overflows to.
  plan.axes.clear();
  for (const char* key : {"a", "b", "c", "d"})
    plan.axes.push_back(parse_axis(std::string(key) + "=0:1:3000"));
  CHECK_THROWS_WITH(check_plan(plan), Catch::Contains("more than 1e7 points"));
}

TEST_CASE("tables are written as CSV and as Markdown") {
  const Table table{{"name | of", "n", "m"},
                    {{"a,b", "1.5", "x"}, {"<b> & c &d", "", "2"}, {"say \"q\"", "nan", "3"}}};
  CHECK(csv_text(table) == "name | of,n,m\n\"a,b\",1.5,x\n<b> & c &d,,2\n\"say \"\"q\"\"\",nan,3\n");
  CHECK(markdown_text(table) ==
        "| name \\| of | n | m |\n|---|---:|---|\n| a,b | 1.5 | x |\n| &lt;b> & c &amp;d |  | 2 |\n| say "
        "\"q\" | nan | 3 |\n");
  CHECK(table.column("m") == 2);
  CHECK_THROWS_AS(table.column("o"), std::out_of_range);
  CHECK(exact_number(0.1) == "0.1");
  CHECK(exact_number(-0.0) == "0");
  CHECK(exact_number(1e-300) == "1e-300");
  CHECK(number_of("-2.5e3") == -2500);
  for (const char* text : {"", "1.5 ", " 1", "1,5", "0x10", "one"}) CHECK(std::isnan(number_of(text)));
  CHECK(is_number("nan"));
  CHECK(is_number("0"));
  CHECK_FALSE(is_number("nano"));
  CHECK(short_number(1e5, 2) == "100000");
  CHECK(short_number(1e6, 2) == "1e6");
  CHECK(short_number(99.96, 2) == "100");  // as 100000 of two digits is
  CHECK(short_number(1e100) == "1e100");
  CHECK(short_number(1e10) == "1e10");
}

}  // namespace accounts_test
