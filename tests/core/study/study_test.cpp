// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/integrators/integrator.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/study/study.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace study_test {

namespace {

StudyPlan small_plan() {
  SolverOptions scene = dvm_options(3, 0.01, 0.6);
  StudyPlan plan = plan_study(make_model(double_pendulum()), scene, 0.05, 0.005, {});
  plan.timing.repeats = 1;
  return plan;
}

}  // namespace

TEST_CASE("every method has its place in a study, with stages where they change its order") {
  const auto settings = study_settings({});
  for (const Method& method : methods()) {
    const auto count = std::count_if(settings.begin(), settings.end(),
                                     [&](const Setting& s) { return s.options.method == method.name; });
    INFO(method.name);
    CHECK(count == (method.name == "dvm" ? 6 : 1));
  }
}

TEST_CASE("a study observes the orders that methods claim") {
  Journal nowhere({}, study_columns(), study_key_columns);
  const StudyPlan plan = small_plan();
  const Study study = run_study(plan, nowhere, {});
  CHECK(study.complete);
  int judged = 0, drifting = 0;
  for (const StudyCurve& curve : study.curves) {
    if (curve.runs.empty()) continue;
    // What a run is said to have kept is what it kept.
    const MeasuredRun& measured = curve.runs.front();
    SolverOptions options = curve.setting.options;
    options.step = measured.step, options.end_time = plan.end;
    const Diagnostics d = diagnose(simulate(plan.model, options));
    const auto same = [&](double found, const char* column) {
      const double kept = largest(d, column);
      INFO(curve.setting.name << " " << column);
      CHECK(found == Approx(kept).epsilon(1e-6).margin(1e-13));
      drifting += kept > 1e-9;
    };
    same(measured.constraint_max, "constraint_max_m");
    same(measured.constraint_relative_max, "constraint_relative_max");
    same(measured.constraint_velocity_max, "constraint_velocity_max_m_s");
    if (curve.setting.claimed_order > 4 || !(curve.order.points >= 4)) continue;  // round-off comes too soon
    INFO(curve.setting.name << " " << curve.order.order);
    CHECK(std::abs(curve.order.order - curve.setting.claimed_order) < 0.4);
    ++judged;
  }
  CHECK(judged >= 4);
  CHECK(drifting >= 3);
}

TEST_CASE("a study observes the orders of one node alone, too") {
  const auto model = build_model(read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'B', position = [0, 0, 1], velocity = [3, 0, 0], mass "
      "= 2}]\n"
      "[[forces]]\nkind = 'drag'\nnodes = ['B']\ndamping = 9\n[gravity]\nacceleration = [0, 0, -9.81]\n",
      "one.toml"));
  StudyPlan plan = plan_study(model, dvm_options(3, 0.01, 1.2), 0.1, 0.01, {});
  plan.timing.repeats = 1;
  Journal nowhere({}, study_columns(), study_key_columns);
  const Study study = run_study(plan, nowhere, {});
  // Linear drag: v -> m g / c with the rate c / m, and x -> v0 m / c.
  const double rate = 4.5, end = 1.2, grown = 1 - std::exp(-rate * end), last = 9.81 / rate;
  CHECK(study.size == Approx(std::hypot(3 / rate * grown, last * end - last / rate * grown)).epsilon(1e-9));
  int judged = 0;
  for (const StudyCurve& curve : study.curves) {
    if (curve.setting.claimed_order > 4 || curve.runs.empty()) continue;
    INFO(curve.setting.name << " " << curve.order.order);
    CHECK(curve.order.points >= 4);
    CHECK(curve.order.order > curve.setting.claimed_order - 0.4);  // what constraints cost some is not lost
    ++judged;
  }
  CHECK(judged >= 4);
}

TEST_CASE("a second study takes its points from the journal") {
  StudyPlan plan = small_plan();
  plan.settings.resize(2);
  Journal journal({}, study_columns(), study_key_columns);
  const Study first = run_study(plan, journal, {});
  const Study second = run_study(plan, journal, {});
  // CPU times never repeat to the last digit: equal ones were not measured again.
  CHECK(points_table(first).rows == points_table(second).rows);
}

TEST_CASE("rows of a study that no run leaves are no points of it") {
  StudyPlan plan = small_plan();
  plan.settings.resize(1);
  Journal journal({}, study_columns(), study_key_columns);
  const Table points = points_table(run_study(plan, journal, {}));
  REQUIRE_FALSE(points.rows.empty());
  for (const auto& row : points.rows) CHECK(is_study_point(row));
  const auto with = [&](const char* column, const char* cell) {
    auto row = points.rows.front();
    row[points.column(column)] = cell;
    return row;
  };
  REQUIRE(points.rows.front()[points.column("outcome")] == "ok");
  CHECK(is_study_point(with("outcome", "too slow")));
  for (const auto& [column, cell] : {std::pair("outcome", "banana"),
                                     {"outcome", ""},
                                     {"position_error_m", "nan"},
                                     {"position_error_m", "-1"},
                                     {"position_error_m", "inf"},
                                     {"energy_error_max_J", "nan"},
                                     {"cpu_median_s", "-5"},
                                     {"cpu_median_s", "nan"},
                                     {"cpu_min_s", "inf"},
                                     {"step_s", "-0.1"},
                                     {"repeats", "-1"},
                                     {"repeats", "0"},
                                     {"factorisations", "-3"}}) {
    INFO(column << " = " << cell);
    CHECK_FALSE(is_study_point(with(column, cell)));
  }
}

TEST_CASE("a study tells how far it is, and at its end that it is done") {
  StudyPlan plan = small_plan();
  plan.settings.resize(2);
  Journal nowhere({}, study_columns(), study_key_columns);
  std::vector<double> told;
  StudyHooks hooks;
  hooks.progress = [&](double fraction) { told.push_back(fraction); };
  run_study(plan, nowhere, hooks);
  REQUIRE(told.size() > 2);
  CHECK(std::is_sorted(told.begin(), told.end()));
  CHECK(told.front() < 0.5);
  CHECK(told.back() == 1);
}

TEST_CASE("a cancelled study keeps its points") {
  StudyPlan plan = small_plan();
  Journal journal({}, study_columns(), study_key_columns);
  StudyHooks hooks;
  hooks.cancelled = [&] { return journal.size() >= 3; };
  const Study study = run_study(plan, journal, hooks);
  CHECK_FALSE(study.complete);
  CHECK(points_table(study).rows.size() == 3);
}

TEST_CASE("the cheapest of the runs that are accurate enough is named") {
  Study study;
  study.curves.resize(2);
  const auto run = [](double error, double cpu) {
    MeasuredRun r;
    r.outcome = "ok";
    r.position_error = error;
    r.cpu_median = cpu;
    r.step = 0.5;
    return r;
  };
  study.curves[0].setting.name = "slow";
  study.curves[0].runs = {run(1e-4, 2), run(1e-7, 4)};
  study.curves[1].setting.name = "fast";
  study.curves[1].runs = {run(1e-2, 0.1), run(1e-4, 1)};
  CHECK(cheapest(study, 1e-3).curve == &study.curves[1]);
  CHECK(cheapest(study, 1e-6).curve == &study.curves[0]);
  CHECK(cheapest(study, 1e-9).run == nullptr);
  CHECK(cheapest_sentence(study) ==
        "The cheapest setting for 0.001 m is fast with a step of 0.5 s (1000 ms), for 1e-6 m slow with a "
        "step of 0.5 s (4000 ms); no setting was found that keeps 1e-9 m.");
  // Of a structure of some micrometres or kilometres as large a share.
  study.size = 3e-6;
  CHECK(cheapest_sentence(study) == "No setting was found that keeps 1e-9 m, 1e-12 m, 1e-15 m.");
  study.size = 2e3;
  CHECK(cheapest_sentence(study).starts_with("The cheapest setting for 1 m is fast with"));
  study.size = 12;
  study.curves.clear();
  CHECK(cheapest_sentence(study) == "No setting was found that keeps 0.001 m, 1e-6 m, 1e-9 m.");
}

TEST_CASE("a ladder falls by halves and two thirds, and all its runs meet") {
  const StepLadder ladder = make_ladder(8, 0.01, 0.08, 0.005);
  CHECK(ladder.grid == 50);
  CHECK(ladder.steps == std::vector<long>{100, 150, 200, 300, 400, 600, 800, 1600});
  for (const long steps : ladder.steps) CHECK(steps % ladder.grid == 0);
  CHECK_THROWS_WITH(make_ladder(8, 0.01, 0.01, 0.02),
                    Catch::Contains("falls from a larger to a smaller step"));
  CHECK_THROWS_WITH(make_ladder(8, 0.01, 5, 0.02), Catch::Contains("must fit four times"));
  CHECK_THROWS_WITH(make_ladder(8, 0.01, 2.001, 0.02), Catch::Contains("it is at most 2 s"));
  CHECK_THROWS_WITH(make_ladder(0.5, 0.01, 0.1, 0.07), Catch::Contains("halved at least once"));
  CHECK_THROWS_WITH(make_ladder(8, 0.01, 1, 1e-9), Catch::Contains("at most a factor"));
}

TEST_CASE("ladders of more steps than a run may have are refused") {
  for (const auto& [largest, smallest] :
       {std::pair{1e-9, 1e-10}, {2e-9, 1e-9}, {1e-300, 1e-302}, {1e-6, 5e-7}}) {
    INFO(largest);
    CHECK_THROWS_AS(make_ladder(4.9, 0.01, largest, smallest), StudyError);
  }
  CHECK_THROWS_WITH(make_ladder(4.9, 0.01, 1e-4, 1e-8), Catch::Contains("more than 1e7 steps"));
  CHECK(make_ladder(4.9, 0.01, 1e-3, 1e-5).steps.back() > 400000);
  CHECK_THROWS_AS(make_ladder(1e9, 1e-3, 0, 0), StudyError);  // of the scene's own step
}

TEST_CASE("a step that is too large to trust is what a study is for") {
  // Runge-Kutta in steps of 0.3 s on a pendulum of 1 m: h omega = 0.9, and it swings through.
  SolverOptions scene = dvm_options(3, 0.3, 1.2);
  scene.method = "rk4";
  const StudyPlan plan = plan_study(make_model(double_pendulum()), scene, 0.1, 0.01, {});
  CHECK(plan.end == Approx(1.2));
}

TEST_CASE("a scene with adaptive steps is studied like one without") {
  SolverOptions scene = dvm_options(3, 0.01, 0.6);
  const auto names = [](const std::vector<Setting>& settings) {
    std::vector<std::string> out;
    for (const Setting& s : settings) {
      CHECK_FALSE(s.options.adaptive);
      CHECK(s.options.tolerance == 0);
      out.push_back(s.name);
    }
    return out;
  };
  const auto fixed = names(study_settings(scene));
  scene.adaptive = true;
  scene.tolerance = 1e-6;
  CHECK(names(study_settings(scene)) == fixed);
}

// Reference solutions know no modes: a motion is judged as long as nothing in it changes its mode.
TEST_CASE("a study ends before what acts on one side only, or is refused where that is from the start") {
  const std::string pendulum = R"(
[structure]
kind = "pendulum"
angle = 90.0
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 4
step = 0.01
end_time = 1.0
)";
  const auto plan_of = [&](const std::string& more) {
    const Scene scene = read_scene_text(pendulum + more, "s.toml");
    return plan_study(build_model(scene), scene.solver, 0, 0, {});
  };
  CHECK(plan_of("").before.empty());
  // Friction slips from the start, or holds; a cable is taut and takes the bob along.
  const std::string friction =
      "[[forces]]\nkind = \"friction\"\nname = \"pad\"\nnodes = [\"bob\"]\ndirection = [0, 0, 1]\n";
  CHECK_THROWS_WITH(plan_of(friction + "kinetic = 0.1\n"), Catch::Contains("from the start: pad (slips)"));
  CHECK_THROWS_AS(plan_of(friction + "kinetic = 0.1\n"), ReferenceError);
  CHECK_THROWS_WITH(plan_of(friction + "kinetic = 1e4\n"), Catch::Contains("from the start: pad (sticks)"));
  // From the bob down to a point above which it hangs: slack until it has fallen, taut all the way.
  const auto rope = [&](const char* end, const std::string& more) {
    std::string text = pendulum;
    const std::string custom =
        "[structure]\nkind = \"custom\"\nnodes = [{name = \"O\", position = [0, 0, 0], fixed = true}, "
        "{name = \"bob\", position = [1, 0, 0], mass = 1}, {name = \"E\", position = " +
        std::string(end) +
        ", fixed = true}]\nrods = [{nodes = [\"O\", \"bob\"], mass = 0}]\n"
        "constraints = [{kind = \"plane\", nodes = [\"bob\"], normal = [0, 1, 0]}]\n";
    const auto from = text.find("[structure]");
    text.replace(from, text.find("[gravity]") - from, custom);
    const Scene scene = read_scene_text(text + more, "s.toml");
    return plan_study(build_model(scene), scene.solver, 0, 0, {});
  };
  std::string stiff = "[[constraints]]\nkind = \"cable\"\nname = \"rope\"\nnodes = [\"E\", \"bob\"]\n",
              soft =
                  "[[forces]]\nkind = \"cable\"\nname = \"rope\"\nnodes = [\"E\", \"bob\"]\n"
                  "axial_stiffness = 50\n";
  CHECK_THROWS_WITH(rope("[1, 0, 1]", stiff + "length = 1\n"), Catch::Contains("from the start: rope"));
  for (const std::string& kind : {stiff, soft}) {
    const StudyPlan plan = rope("[1, 0, 1]", kind + "length = 1.2\n");
    CHECK(plan.before == "the first time that rope pulls");
    // At length 1.2 from (1, 1): (1 - cos a)^2 + (1 + sin a)^2 = 1.44, by a'' = 9.81 cos a from rest.
    double angle = 0, rate = 0, t = 0;
    const double h = 1e-6;
    while (std::hypot(1 - std::cos(angle), 1 + std::sin(angle)) < 1.2)
      rate += h * 9.81 * std::cos(angle), angle += h * rate, t += h;
    CHECK(plan.end == Approx(0.995 * t).epsilon(0).margin(1e-5));
  }
  // A weak elastic one pulls all the time: a spring, smooth from the start.
  soft.replace(soft.find("= 50"), 4, "= 1");
  CHECK(rope("[1, 0, 1]", soft + "length = 0.5\n").before.empty());
}

}  // namespace study_test
