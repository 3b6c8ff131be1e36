// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "core/diagnostics/accuracy.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/stress.hpp"

using namespace unfurl;

TEST_CASE("an atlas tells a right run from one that lost its constraints") {
  const SceneSource source{find_scene("hoop6_sector"), {}};
  StressPlan plan = plan_stress(source, {"force"});
  plan.extremes[0].values = {1, 1e6};
  plan.steps = {8, 512};
  Journal journal({}, stress_columns(), stress_key_columns);
  const Stress stress = run_stress(plan, journal, {});
  CHECK(stress.cells.size() == plan.settings.size() * 4);
  for (const StressCell& cell : stress.cells) {
    INFO(cell.setting << " " << cell.value << " " << cell.steps);
    // At 512 steps every method is closer than 1 cm; eight steps of an explicit method on 4.9 s cannot hold
    // lengths.
    if (cell.steps == 512) CHECK(cell.verdict == Verdict::right);
    if (cell.steps == 8 && cell.setting == "rk4") CHECK(cell.verdict == Verdict::constraint_lost);
  }
}

TEST_CASE("forces change the pace of a motion, not its path: verdicts are those of the scene itself") {
  const SceneSource source{find_scene("hoop6_sector"), {}};
  StressPlan plan = plan_stress(source, {"force"});
  plan.extremes[0].values = {1, 1e-6, 1e8};
  plan.settings.resize(1);
  plan.steps = {16, 32, 64};
  Journal journal({}, stress_columns(), stress_key_columns);
  const Stress stress = run_stress(plan, journal, {});
  REQUIRE(stress.cells.size() == 9);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(stress.cells[i].verdict == stress.cells[i + 3].verdict);
    CHECK(stress.cells[i].verdict == stress.cells[i + 6].verdict);
  }
}

// Its size is the way that it goes, 1.6 m here; 256 steps of the variational method of order 8 leave 1e-14 m.
TEST_CASE("one node alone is judged by the way that it goes") {
  const auto text = std::make_shared<const std::string>(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'B', position = [0, 0, 1], velocity = [3, 0, 0], mass "
      "= 2}]\n"
      "[[forces]]\nkind = 'drag'\nnodes = ['B']\ndamping = 9\n"
      "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 2\nstep = 0.05\n");
  StressPlan plan = plan_stress({"one.toml", {}, text, "."}, {"force"});
  plan.extremes[0].values = {1};
  plan.settings.resize(3);
  plan.steps = {256};
  plan.long_steps = 0;
  Journal journal({}, stress_columns(), stress_key_columns);
  const Stress stress = run_stress(plan, journal, {});
  REQUIRE(stress.cells.size() == 3);
  for (const StressCell& cell : stress.cells) {
    INFO(cell.setting << " " << cell.run.position_error);
    CHECK(cell.verdict == Verdict::right);
  }
}

TEST_CASE("a motion that is driven, damped or pushed keeps its books in studies too") {
  // The motor gives the ring up to 587 J and takes them again; 512 steps of 6 s are 12 ms, each closer than
  // 1e-4 J.
  StressPlan plan = plan_stress({find_scene("hoop6_motor"), {}}, {"mass_ratio"});
  plan.extremes[0].values = {1e2};
  plan.settings.resize(3);
  plan.steps = {16, 512};
  Journal journal({}, stress_columns(), stress_key_columns);
  const Stress stress = run_stress(plan, journal, {});
  REQUIRE(stress.cells.size() == 6);
  for (const StressCell& cell : stress.cells) {
    INFO(cell.setting << " " << cell.value << " " << cell.run.energy_error);
    if (cell.steps == 512) CHECK(cell.verdict == Verdict::right);
    if (cell.steps == 512) CHECK(cell.run.kinetic_energy_max > 500);
  }
}

TEST_CASE("a run's energy error in a study is that of its own balance") {
  for (const auto& [name, change] : {std::pair{"hoop6_motor", "solver.step=0.02"},
                                     {"pendulum", "forces=[{kind='drag', nodes=['bob'], damping=0.7}]"}}) {
    INFO(name);
    const Scene scene = read_scene_file(find_scene(name), {change});
    const Simulation run = simulate(build_model(scene), scene.solver);
    const Diagnostics diagnostics = diagnose(run);
    double off = 0;
    for (const double x : diagnostics.at("energy_balance_J").values) off = std::max(off, std::abs(x));
    MeasuredRun measured{.outcome = "ok"};
    measure_invariants(run, measured);
    CHECK(measured.energy_error == Approx(off).epsilon(1e-12));
    CHECK(measured.energy_error < 1e-3 * measured.energy_turned_over);
    CHECK(measured.ok());
  }
}

TEST_CASE("very many steps of a damped motion are not called growth of energy") {
  StressPlan plan = plan_stress(
      {find_scene("pendulum"), {"forces=[{kind='drag', nodes=['bob'], damping=0.7}]"}}, {"force"});
  plan.settings.resize(2);
  plan.long_steps = 2000;
  for (const LongRun& run : long_runs(plan, {})) {
    INFO(run.setting);
    CHECK(run.end == "done");
    // Half the energy and more is taken by drag; order 2 in steps of 0.01 s of a pendulum of 1 m: 1e-3.
    CHECK(run.energy_error.back() < 0.01);
  }
}

// It turns over no energy: what rounding alone leaves of a balance of 20 J m is no growth of it.
TEST_CASE("a pendulum that hangs at rest is right at any strength of its forces") {
  const auto text = std::make_shared<const std::string>(
      "[structure]\nkind = 'pendulum'\nangle = 0.0\n[gravity]\nacceleration = [0, 0, -9.81]\n"
      "[solver]\nend_time = 2\nstep = 0.05\n");
  StressPlan plan = plan_stress({"one.toml", {}, text, "."}, {"force"});
  plan.extremes[0].values = {1, 1e6};
  plan.steps = {64, 256};
  plan.long_steps = 0;
  Journal journal({}, stress_columns(), stress_key_columns);
  const Stress stress = run_stress(plan, journal, {});
  REQUIRE(stress.cells.size() == plan.settings.size() * 4);
  for (const StressCell& cell : stress.cells) {
    INFO(cell.setting << " " << cell.value << " " << cell.steps << ": " << cell.run.energy_error);
    CHECK(cell.verdict == Verdict::right);
  }
}

TEST_CASE("an extreme that is not there is named") {
  CHECK_THROWS_WITH(plan_stress({find_scene("hoop6"), {}}, {"forces"}),
                    Catch::Contains("did you mean 'force'"));
  CHECK_THROWS_WITH(plan_stress({find_scene("four_bar"), {}}, {"units"}),
                    Catch::Contains("cannot be driven"));
}

// A bob that falls on a floor is judged up to there; what rubs from the start has no reference, and says so.
TEST_CASE("an atlas is of the motion before anything that acts on one side only") {
  const std::string pendulum = R"(
[structure]
kind = "pendulum"
angle = 90.0
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 4
step = 0.01
end_time = 2.0
)";
  const auto atlas = [&](const std::string& more) {
    const auto text = std::make_shared<const std::string>(pendulum + more);
    StressPlan plan = plan_stress({"one.toml", {}, text, "."}, {"force"});
    CHECK(plan.long_steps == 0);
    plan.extremes[0].values = {1};
    std::erase_if(plan.settings, [](const Setting& s) { return s.name != "dvm s=4"; });
    plan.steps = {256};
    Journal journal({}, stress_columns(), stress_key_columns);
    return run_stress(plan, journal, {});
  };
  const Stress floor = atlas(
      "[[constraints]]\nkind = \"coordinate_stop\"\nname = \"floor\"\nnodes = [\"bob\"]\n"
      "direction = [0, 0, 1]\nmin = -0.5\nrestitution = 0.5\n");
  for (const std::string& note : floor.notes) FAIL_CHECK(note);
  REQUIRE(floor.cells.size() == 1);
  CHECK(floor.cells[0].verdict == Verdict::right);
  CHECK(floor.cells[0].run.position_error < 1e-9);
  const Stress rubs = atlas(
      "[[forces]]\nkind = \"friction\"\nname = \"pad\"\nnodes = [\"bob\"]\n"
      "direction = [0, 0, 1]\nkinetic = 0.1\n");
  CHECK(rubs.cells.empty());
  REQUIRE(rubs.notes.size() == 1);
  CHECK(rubs.notes[0].find("pad (slips)") != std::string::npos);
}
