// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/ending.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <utility>

#include "tests/support/scene_run.hpp"

using namespace unfurl;
using testing::run_scene;

namespace ending_test {

TEST_CASE("a run that ends before the deployed pose says how far it got, rounded down") {
  const std::string ring = "[structure]\nkind = 'hoop'\nmodel = 'sector'\n[solver]\nstep = 0.01\n";
  for (const char* end : {"2.3", "4.1", "4.9"}) {
    const Simulation run = run_scene(ring, {std::string("solver.end_time=") + end});
    const Diagnostics d = diagnose(run);
    const double percent = 100 * d.at("deployed_fraction").values.back();
    REQUIRE((percent > 1 && percent < 100));
    const std::string note = ending_note(run, d);
    INFO(note << " of " << percent);
    const double said = std::strtod(note.c_str(), nullptr);
    CHECK(said <= percent);
    CHECK(said > percent - 0.1 - 1e-9);
    CHECK(note.find(std::string(" % deployed when end_time = ") + end + " s was reached") !=
          std::string::npos);
  }
  // What has not moved is deployed by nothing, whatever the sign of its rounding; what has moved back says
  // so.
  Simulation still = run_scene(ring, {"solver.end_time=0.1"});
  Diagnostics d = diagnose(still);
  for (const auto& [fraction, said] : std::vector<std::pair<double, std::string>>{{-1e-14, "0 %"},
                                                                                  {-9e-10, "0 %"},
                                                                                  {-1.1e-9, "-0.1 %"},
                                                                                  {-0.0, "0 %"},
                                                                                  {1e-14, "0 %"},
                                                                                  {-0.002, "-0.2 %"},
                                                                                  {-0.0021, "-0.3 %"}}) {
    for (Series& column : d.columns)
      if (column.name == "deployed_fraction") column.values.back() = fraction;
    CHECK(ending_note(still, d).starts_with(said + " deployed"));
  }
  // Whatever else happened; not where it went on behind its deployed pose, nor where nothing was looked at.
  Simulation passed = still;
  passed.events.push_back({.name = "rests on stop", .t = 0.05, .kind = "contact"});
  CHECK(ending_note(passed, d).starts_with("-0.3 %"));
  passed.events.push_back({.name = "deployed", .t = 0.07, .kind = "deployed"});
  CHECK(ending_note(passed, d).empty());
  for (Series& column : d.columns) column.values.clear();
  CHECK(ending_note(still, d).empty());
  // Nothing where it deployed, where there is nothing to deploy, or where it broke off.
  Simulation deployed = run_scene(ring, {"solver.end_time=6"});
  CHECK(ending_note(deployed, diagnose(deployed)).empty());
  Simulation stopped = run_scene(ring, {"solver.end_time=2.3"});
  stopped.status = RunStatus::stopped;
  CHECK(ending_note(stopped, diagnose(stopped)).empty());
  const Simulation pendulum = run_scene("[structure]\nkind = 'pendulum'\n", {"solver.end_time=0.1"});
  CHECK(ending_note(pendulum, diagnose(pendulum)).empty());
}

TEST_CASE("a run too large to look for singular poses says so") {
  for (const int windows : {149, 150}) {
    const Simulation run = run_scene(
        "[structure]\nkind = 'four_bar_ladder'\nwindows = " + std::to_string(windows) + "\nspeed = 1\n",
        {"solver.end_time=0.03"});
    const System& system = run.trajectory.last_model().system;
    const Index size = std::max(system.constraints(), system.solved_coordinates());
    CAPTURE(windows, size);
    CHECK((size > 300) == (windows == 150));
    const std::vector<std::string> notes = notes_of(run, diagnose(run));
    REQUIRE(notes.size() == (size > 300 ? 1 : 0));
    if (!notes.empty())
      CHECK(notes[0].find("the model has " + std::to_string(size) + ":") != std::string::npos);
  }
}

}  // namespace ending_test
