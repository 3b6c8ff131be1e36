#include <catch2/catch.hpp>

#include "core/scene/library.hpp"
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

TEST_CASE("an extreme that is not there is named") {
  CHECK_THROWS_WITH(plan_stress({find_scene("hoop6"), {}}, {"forces"}),
                    Catch::Contains("did you mean 'force'"));
  CHECK_THROWS_WITH(plan_stress({find_scene("four_bar"), {}}, {"units"}),
                    Catch::Contains("cannot be driven"));
}
