// SPDX-License-Identifier: BSD-3-Clause
// What an extreme makes of a scene, and by what limits its runs are judged.
#include "core/study/extremes.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "core/diagnostics/accuracy.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/study/stress.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace extremes_test {

namespace {

// Two rods that swing, with all that forces are: gravity, a load, a start in motion, springs.
const std::string swing = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [1.1, 0, 0.2], velocity = [0, 0.7, 0], mass = 0.4},
         {name = "B", position = [1.9, 0.3, 0], mass = 0.6},
         {name = "C", position = [2.3, 1.1, 0.1], mass = 0.2}]
rods = [{nodes = ["O", "A"], mass = 1.3}, {nodes = ["A", "B"], mass = 0.9}, {nodes = ["B", "C"], mass = 0.7}]
[[forces]]
kind = "drag"
nodes = ["B"]
damping = 0.1
[[forces]]
kind = "spring"
nodes = ["O", "B"]
stiffness = 35
[[forces]]
kind = "spring"
nodes = ["O", "C"]
stiffness = 15
[[loads]]
nodes = ["B"]
force = [1.5, -0.5, 0.25]
[gravity]
acceleration = [0, 1, -9.5]
[solver]
step = 0.01
end_time = 1.5
)";

SceneSource source_of(const std::string& text, std::vector<std::string> overrides = {}) {
  return {"s.toml", std::move(overrides), std::make_shared<const std::string>(text), ""};
}

std::map<std::string, Extreme> extremes_of(const SceneSource& source) {
  std::map<std::string, Extreme> out;
  for (const ExtremeKind& kind : extreme_kinds())
    if (auto extreme = kind.make(source)) {
      CHECK(extreme->name == kind.name);
      CHECK_FALSE(extreme->label.empty());
      CHECK(std::is_sorted(extreme->values.begin(), extreme->values.end()));
      CHECK(extreme->log);
      out.emplace(extreme->name, *extreme);
    }
  return out;
}

std::set<std::string> names_of(const std::map<std::string, Extreme>& all) {
  std::set<std::string> out;
  for (const auto& [name, extreme] : all) out.insert(name);
  return out;
}

Structure built(const Extreme& extreme, double value) {
  SolverOptions options;
  Structure out = extreme.build(value, options)->structure;
  CHECK(options.end_time > 0);
  return out;
}

using Names = std::set<std::string>;

}  // namespace

TEST_CASE("scenes are driven to the extremes that they have something for") {
  CHECK(names_of(extremes_of(source_of(swing))) == Names{"mass_ratio", "force", "stiffness"});
  CHECK(names_of(extremes_of({find_scene("hoop6"), {}})) ==
        Names{"mass_ratio", "force", "fold_angle", "units"});
  const std::string one = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1.1, 0, 0.2], mass = 0.4}]
rods = [{nodes = ["O", "A"], mass = 1.3}]
[solver]
step = 0.01
end_time = 1.5
)";
  CHECK(names_of(extremes_of(source_of(one))).empty());
  CHECK(names_of(extremes_of(source_of(one, {"gravity.acceleration=[0,0,-3]"}))) == Names{"force"});
  CHECK_THROWS_WITH(plan_stress(source_of(one), {}),
                    "the scene has nothing that can be driven to an extreme");
}

TEST_CASE("an extreme changes what it is called by, by its value, and nothing else") {
  const auto all = extremes_of(source_of(swing));
  const Structure plain = build_structure(source_of(swing).read());
  for (const double value : {1.0, 100.0, 1e-6}) {
    const Structure heavy = built(all.at("mass_ratio"), value), pushed = built(all.at("force"), value);
    for (std::size_t r = 0; r < plain.rods.size(); ++r) {
      CHECK(heavy.rods[r].mass == plain.rods[r].mass * (r == 1 ? 1 : value));
      CHECK(pushed.rods[r].mass == plain.rods[r].mass);
    }
    CHECK(heavy.gravity == plain.gravity);
    CHECK(pushed.gravity == plain.gravity * value);
    CHECK(pushed.loads.at(0).force == plain.loads.at(0).force * value);
    // The same path at another pace: speeds go with the square root of forces.
    CHECK(pushed.nodes[1].velocity == plain.nodes[1].velocity * std::sqrt(value));
    const Structure stiff = built(all.at("stiffness"), value);
    CHECK(stiff.forces.at(1).stiffness == value);
    CHECK(stiff.forces.at(2).stiffness == 15);
  }
  CHECK(all.at("mass_ratio").label == "mass of every second rod (times)");
  CHECK(all.at("stiffness").label == "forces[1].stiffness");
  const auto ring = extremes_of({find_scene("hoop6"), {}});
  const Structure hoop = build_structure(SceneSource{find_scene("hoop6"), {}}.read());
  const std::string first = hoop.rods.front().group;
  CHECK(ring.at("mass_ratio").label == "mass of the " + first + " rods (times)");
  const Structure heavy = built(ring.at("mass_ratio"), 1e4);
  std::size_t heavier = 0;
  for (std::size_t r = 0; r < hoop.rods.size(); ++r) {
    CHECK(heavy.rods[r].mass == hoop.rods[r].mass * (hoop.rods[r].group == first ? 1e4 : 1));
    heavier += heavy.rods[r].mass > hoop.rods[r].mass;
  }
  CHECK(heavier > 0);
  CHECK(heavier < hoop.rods.size());
  CHECK(built(ring.at("fold_angle"), 30).deployment.initial_fold_angle ==
        Approx(std::acos(0.5)).epsilon(1e-12));
  CHECK(built(ring.at("units"), 12).rods.size() == 2 * hoop.rods.size());
}

TEST_CASE("the stiffness that is driven is one that acts") {
  const std::string dashpot = "forces[1]={kind=\"spring\", nodes=[\"O\",\"B\"], damping=2}";
  for (const std::string& idle : {std::string("forces[1].enabled=false"), dashpot}) {
    INFO(idle);
    const auto all = extremes_of(source_of(swing, {idle}));
    REQUIRE(all.count("stiffness") == 1);
    CHECK(all.at("stiffness").label == "forces[2].stiffness");
    CHECK(built(all.at("stiffness"), 1e6).forces.back().stiffness == 1e6);
  }
  const SceneSource none = source_of(swing, {"forces[1].enabled=false", "forces[2].enabled=false"});
  CHECK(names_of(extremes_of(none)) == Names{"mass_ratio", "force"});
}

// A spring along a rigid rod loads it and moves nothing, however stiff it is.
TEST_CASE("the stiffness that is driven is one that moves something") {
  const std::string along_rod = "forces[1].nodes=[\"O\",\"A\"]";
  CHECK(extremes_of(source_of(swing, {along_rod})).at("stiffness").label == "forces[2].stiffness");
  CHECK(names_of(extremes_of(source_of(swing, {along_rod, "forces[2].nodes=[\"B\",\"C\"]"}))) ==
        Names{"mass_ratio", "force"});
}

// Slack until 0.8 s of 1 s.
TEST_CASE("a cable that is taut late in the run moves something") {
  const std::string late = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [1, 0, 0], mass = 0.7, velocity = [0.5, 0, 0]}]
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
tension_only = true
stiffness = 3
free_length = )";
  const std::string solver = "\n[solver]\nstep = 0.01\nend_time = 1\n";
  CHECK(extremes_of(source_of(late + "1.4" + solver)).at("stiffness").label == "forces[0].stiffness");
  CHECK(extremes_of(source_of(late + "1.6" + solver)).count("stiffness") == 0);  // never
}

TEST_CASE("a stiffness that means nothing in the scene is not the one that is driven") {
  const std::string latch =
      "[structure]\nkind = 'hoop'\n[[forces]]\nkind = 'latch'\nstiffness = 1000\n[[forces]]\nkind = "
      "'torsion_spring'\nfold_angle = true\nstiffness = 10\n[solver]\nend_time = 0.5\nstep = 0.02\n";
  CHECK(extremes_of(source_of(latch, {})).at("stiffness").label == "forces[1].stiffness");
  CHECK(extremes_of(source_of(latch, {"solver.at_deployed=latch"})).at("stiffness").label ==
        "forces[0].stiffness");
  const auto reflector = [](const char* nets) {
    const auto all = extremes_of({find_scene("mesh_reflector"), {std::string("structure.nets=") + nets}});
    const auto found = all.find("stiffness");
    return found == all.end() ? std::string() : found->second.label;
  };
  CHECK(reflector("true") == "structure.net_stiffness");
  CHECK(reflector("false") != "structure.net_stiffness");
}

TEST_CASE("an atlas has the scene's own steps in it, and long runs where nothing deploys") {
  const auto steps_of = [](const char* end_time, const char* step) {
    const StressPlan plan = plan_stress(
        source_of(swing, {std::string("solver.end_time=") + end_time, std::string("solver.step=") + step}),
        {"force"});
    CHECK(plan.extremes.size() == 1);
    CHECK(plan.long_steps == 1'000'000);
    return plan.steps;
  };
  // 600 steps: 512 is the nearest power of two, to a 32nd of it and to four times as many.
  CHECK(steps_of("6.0", "0.01") == std::vector<long>{16, 32, 64, 128, 256, 512, 1024, 2048});
  CHECK(steps_of("8.0", "0.01") == std::vector<long>{32, 64, 128, 256, 512, 1024, 2048, 4096});
  CHECK(steps_of("0.2", "0.01") == std::vector<long>{4, 8, 16, 32, 64, 128, 256, 512});
  CHECK(steps_of("90.0", "0.001") == std::vector<long>{128, 256, 512, 1024, 2048, 4096, 8192, 16384});
  const StressPlan ring = plan_stress({find_scene("hoop6"), {}}, {});
  CHECK(ring.long_steps == 0);
  CHECK(ring.extremes.size() == 4);
  std::set<std::string> settings;
  for (const Setting& setting : ring.settings) settings.insert(setting.name);
  CHECK(settings.size() == ring.settings.size());
  CHECK(settings.contains("dvm s=2"));
  CHECK(settings.contains("dvm s=4"));
  CHECK(settings.contains("dvm s=3 as printed"));
  CHECK(settings.contains("rk4"));
  for (const char* left_out : {"dvm s=3", "dvm s=5", "dvm s=6"}) CHECK_FALSE(settings.contains(left_out));
}

TEST_CASE("every verdict has a name of its own and a criterion with its limit") {
  const std::map<std::string_view, std::string> criteria = {
      {"right", "none of these"},
      {"inaccurate", "a node is off by more than 1 % of the structure's size"},
      {"wrong branch", "a node is off by more than 10 % of the structure's size"},
      {"energy growth", "the energy balance is off by more than 5 % of the energy turned over"},
      {"constraint lost", "a constraint is off by more than 0.1 % of a rod's length"},
      {"solver failed", "the solver stops and says so (Newton iteration or factorisation)"},
      {"too slow", "no end within 3 s of CPU time"}};
  std::map<std::string_view, std::string> found;
  for (const Verdict verdict : verdicts()) found[to_string(verdict)] = criterion(verdict);
  CHECK(found == criteria);
}

TEST_CASE("verdicts turn where their limits are, the first that applies counts") {
  StressPlan plan = plan_stress(source_of(swing), {"force"});
  plan.extremes[0].values = {1};
  std::erase_if(plan.settings, [](const Setting& s) { return s.name != "rk4"; });
  REQUIRE(plan.settings.size() == 1);
  plan.steps = {64};
  plan.long_steps = 0;
  const auto cell = [&] {
    Journal journal({}, stress_columns(), stress_key_columns);
    const Stress stress = run_stress(plan, journal, {});
    CHECK(stress.complete);
    CHECK(stress.notes.empty());
    CHECK(stress.long_runs.empty());
    REQUIRE(stress.cells.size() == 1);
    // The same from its row.
    CHECK(cells_table(stress).rows == cells_table(run_stress(plan, journal, {})).rows);
    const Table counts = summary_table(plan, stress);
    REQUIRE(counts.rows.size() == 1);
    CHECK(counts.rows[0][0] == "rk4");
    CHECK(counts.rows[0][1] == "1");
    for (std::size_t c = 2; c < counts.columns.size(); ++c)
      CHECK(counts.rows[0][c] == (counts.columns[c] == to_string(stress.cells[0].verdict) ? "1" : "0"));
    return stress.cells[0];
  };
  plan.limits = {30, 1, 1, 1, 1};
  const StressCell seen = cell();
  CHECK(seen.verdict == Verdict::right);
  CHECK(seen.extreme == "force");
  CHECK(seen.steps == 64);
  CHECK(seen.run.step == Approx(1.5 / 64));
  const double size = 2.3;  // from O to C along x
  Simulation run = testing::run_scene(swing, {"solver.method=rk4", "solver.step=0.0234375"});
  const Diagnostics d = diagnose(run);
  const double off = testing::largest(d, "energy_balance_J"), turned = energy_turned_over(d),
               drift = testing::largest(d, "constraint_relative_max"), error = seen.run.position_error;
  CHECK(seen.run.energy_error == Approx(off).epsilon(1e-6));
  REQUIRE((off > 1e-9 && drift > 1e-12 && error > 1e-9));
  for (const double near : {0.98, 1.02}) {
    const bool within = near > 1;
    plan.limits = {30, 1, 1, 1, near * error / size};
    CHECK(cell().verdict == (within ? Verdict::right : Verdict::inaccurate));
    plan.limits = {30, 1, 1, near * error / size, 0};
    CHECK(cell().verdict == (within ? Verdict::inaccurate : Verdict::wrong_branch));
    plan.limits = {30, 1, near * off / turned, 0, 0};
    CHECK(cell().verdict == (within ? Verdict::wrong_branch : Verdict::energy_growth));
    plan.limits = {30, near * drift, 0, 0, 0};
    CHECK(cell().verdict == (within ? Verdict::energy_growth : Verdict::constraint_lost));
  }
  plan.limits = {0, 0, 0, 0, 0};
  CHECK(cell().verdict == Verdict::too_slow);
}

TEST_CASE("extremes that a scene cannot be built at are noted, and the others shown") {
  StressPlan plan = plan_stress({find_scene("hoop6_sector"), {}}, {"units"});
  plan.extremes[0].values = {1, 6};  // a ring of one unit is none
  plan.settings.resize(1);
  plan.steps = {16};
  Journal journal({}, stress_columns(), stress_key_columns);
  std::vector<double> told;
  StudyHooks hooks;
  hooks.progress = [&](double fraction) { told.push_back(fraction); };
  const Stress stress = run_stress(plan, journal, hooks);
  CHECK(told == std::vector<double>{0.25, 0.5});  // two places, and what is left to do behind them
  REQUIRE(stress.notes.size() == 1);
  CHECK(stress.notes[0].starts_with("units = 1: "));
  CHECK(stress.notes[0].find("units") < stress.notes[0].rfind("must be"));
  REQUIRE(stress.cells.size() == 1);
  CHECK(stress.cells[0].value == 6);
}

TEST_CASE("a long run shows the largest errors so far, at counts that grow by a twentieth") {
  StressPlan plan = plan_stress(source_of(swing, {"forces=[]", "loads=[]"}), {"force"});
  std::erase_if(plan.settings, [](const Setting& s) { return s.name != "rk4" && s.name != "dvm s=2"; });
  REQUIRE(plan.settings.size() == 2);
  for (Setting& setting : plan.settings) setting.options.step = 0.02;
  plan.long_steps = 311;
  for (const LongRun& run : long_runs(plan, {})) {
    INFO(run.setting);
    CHECK(run.end == "done");
    CHECK(run.steps == 311);
    CHECK(run.step == 0.02);
    REQUIRE(run.step_count.size() == run.energy_error.size());
    REQUIRE(run.step_count.size() == run.constraint.size());
    CHECK(run.step_count.back() == 311);
    CHECK(std::is_sorted(run.constraint.begin(), run.constraint.end()));
    double next = 1;
    for (std::size_t i = 0; i + 1 < run.step_count.size(); ++i, next *= 1.05) {
      CHECK(run.step_count[i] >= next);
      CHECK(run.step_count[i] <= std::max(next + 1, i > 0 ? run.step_count[i - 1] + 1 : 1));
    }
    const Simulation whole = testing::run_scene(
        swing, {"forces=[]", "loads=[]", "solver.step=0.02", "solver.end_time=6.22", "solver.stages=2",
                "solver.method=" + run.setting.substr(0, run.setting.find(' '))});
    const Diagnostics d = diagnose(whole);
    REQUIRE(d.t.size() == 312);
    // The same steps: round-off of sums alone between the two.
    CHECK(
        run.energy_error.back() ==
        Approx(testing::largest(d, "energy_balance_J") / energy_turned_over(d)).epsilon(1e-6).margin(1e-12));
    CHECK(run.constraint.back() ==
          Approx(testing::largest(d, "constraint_relative_max")).epsilon(1e-6).margin(1e-14));
  }
  // Runge-Kutta drifts off: at a tenth of a rod's length there is nothing to follow any more.
  for (Setting& setting : plan.settings) setting.options.step = 0.15;
  plan.long_steps = 5000;
  for (const LongRun& run : long_runs(plan, {}))
    if (run.setting == "rk4") {
      CHECK(run.end == "constraints lost");
      CHECK(run.constraint.back() >= 0.1);
      CHECK(run.steps == static_cast<long>(run.step_count.back()));
      for (std::size_t i = 0; i + 1 < run.constraint.size(); ++i) CHECK(run.constraint[i] < 0.1);
    }
  for (Setting& setting : plan.settings) setting.options.step = 0.02;
  StudyHooks cancelled;
  cancelled.cancelled = [] { return true; };
  CHECK_THROWS_AS(long_runs(plan, cancelled), Cancelled);
  plan.long_steps = 0;
  CHECK(long_runs(plan, {}).empty());
}

}  // namespace extremes_test
