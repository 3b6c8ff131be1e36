// SPDX-License-Identifier: BSD-3-Clause
// What acts on one side, met before the deployed pose and left again where that is reached, all in one step.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace stop_before_deployed_test {

namespace {

constexpr double r = 0.3, l = 1.0, begin = -1.0;

// A crank pulled up through its dead centre to y = `deployed`; its slider would move as far as r + l, and is
// stopped `before` that, or held back by an elastic cable.
std::string crank(double before, double deployed, bool cable, const std::string& options) {
  const double x = r * std::cos(begin), y = r * std::sin(begin), slider = x + std::sqrt(l * l - y * y);
  using testing::number;
  return R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [)" +
         number(x) + ", " + number(y) + R"(, 0], mass = 1},
  {name = "B", position = [)" +
         number(slider) + R"(, 0, 0], mass = 0.5}]
rods = [{nodes = ["O", "A"], mass = 0}, {nodes = ["A", "B"], mass = 0}]
constraints = [{kind = "line", nodes = ["B"], direction = [1, 0, 0]},
  {kind = "plane", nodes = ["A"], normal = [0, 0, 1]}]
[[loads]]
nodes = ["A"]
force = [0, 2, 0]
[deployment]
measure = "coordinate A along 0 1 0"
deployed = )" +
         number(deployed) +
         (cable
              ? "\n[[forces]]\nkind = \"spring\"\nnodes = [\"O\", \"B\"]\ntension_only = true\nstiffness = "
                "20\nfree_length = "
              : "\n[[constraints]]\nkind = \"coordinate_stop\"\nname = \"stop\"\nnodes = [\"B\"]\ndirection "
                "= [1, 0, 0]\nmax = ") +
         number(r + l - before) + "\n[solver]\nend_time = 1.2\n" + options;
}

// The crank's angle where the slider is that far from its dead centre, before it.
double angle_at(double before) {
  double low = begin, high = 0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high), y = r * std::sin(middle);
    (r * std::cos(middle) + std::sqrt(l * l - y * y) < r + l - before ? low : high) = middle;
  }
  return low;
}

bool told(const Simulation& run, const std::string& kind) {
  return std::ranges::any_of(run.events, [&](const Event& e) { return e.kind == kind; });
}

const char* const options[] = {"stages = 6\n", "stages = 3\n", "method = \"rk4_projected\"\n",
                               "method = \"generalized_alpha\"\n", "model = \"path\"\n"};

}  // namespace

TEST_CASE("a stop before the deployed pose holds where it would be left again within the step") {
  for (const auto& [before, deployed, step] :
       {std::array{1e-3, 0.03, 0.3}, std::array{1e-5, 3e-3, 0.05}, std::array{1e-8, 1e-4, 0.01}})
    for (const char* option : options)
      for (const char* at : {"stop", "pass"}) {
        INFO(before << ", " << option << at);
        const Simulation run = testing::run_scene(crank(
            before, deployed, false,
            option + ("at_deployed = \"" + std::string(at) + "\"\nstep = ") + testing::number(step) + "\n"));
        CHECK(run.status == RunStatus::completed);
        CHECK_FALSE(told(run, "deployed"));
        REQUIRE(told(run, "contact"));
        // The angle goes as the root of the slider's way: rounding of 1e-16 in that is 1e-8 / 2 of it at
        // most.
        CHECK(testing::end_positions(run)[4] ==
              Approx(r * std::sin(angle_at(before))).epsilon(0).margin(1e-8));
      }
}

TEST_CASE("a cable that pulls and goes slack on the last step to the deployed pose is told") {
  for (const auto& [before, deployed, step] : {std::array{1e-3, 0.03, 0.3}, std::array{1e-5, 3e-3, 0.05}})
    for (const char* option : options)
      for (const char* at : {"stop", "pass"}) {
        INFO(before << ", " << option << at);
        const Simulation run = testing::run_scene(crank(
            before, deployed, true,
            option + ("at_deployed = \"" + std::string(at) + "\"\nstep = ") + testing::number(step) + "\n"));
        REQUIRE(run.events.size() >= 3);
        CHECK(run.events[0].kind == "taut");
        CHECK(run.events[1].kind == "slack");
        CHECK(run.events[2].kind == "deployed");
        CHECK(run.events[1].t > run.events[0].t);
        CHECK(run.events[2].t > run.events[1].t);
      }
}

}  // namespace stop_before_deployed_test
