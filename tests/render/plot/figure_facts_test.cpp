// SPDX-License-Identifier: BSD-3-Clause
// What figures say of a run in words and lines: how it was solved, its events, whose force is unique.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "core/scene/library.hpp"
#include "core/study/tolerance.hpp"
#include "render/plot/figures.hpp"
#include "tests/support/scene_run.hpp"

namespace unfurl::figure_facts_test {

namespace {

using Catch::Contains;

Figure of_library(const std::string& figure, const char* name, const std::vector<std::string>& changes) {
  const Scene scene = read_scene_file(find_scene(name), changes);
  const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
  return find_figure(figure)->make(run, diagnose(run));
}

Figure of_text(const std::string& figure, const std::string& scene) {
  const Simulation run = testing::run_scene(scene);
  return find_figure(figure)->make(run, diagnose(run));
}

}  // namespace

TEST_CASE("captions of a run along its path name neither a method nor its steps", "[figures]") {
  for (const char* method : {"dvm", "rk4"}) {
    const Figure f =
        of_library("constraint_error", "four_bar",
                   {"solver.model=path", std::string("solver.method=") + method, "solver.end_time=0.5"});
    CHECK_THAT(f.caption, Contains("Solved along its path, states 0.01 s apart at most."));
    CHECK_THAT(f.caption, !Contains("Method") && !Contains("Newton"));
    for (const ReferenceLine& line : f.panels[0].lines) CHECK_THAT(line.label, !Contains("Newton"));
  }
}

TEST_CASE("captions of adaptive runs name the step as what none is longer than", "[figures]") {
  const Figure f = of_library("steps", "pendulum", {"solver.adaptive=true", "solver.end_time=0.5"});
  CHECK_THAT(f.caption, Contains(", adaptive steps, at most 0.01 s."));
}

TEST_CASE("steps without Newton iterations have none at most", "[figures]") {
  const Figure f = of_library("steps", "pendulum", {"solver.method=rk4", "solver.end_time=0.5"});
  CHECK_THAT(f.caption, Contains(", 0 Newton iterations a step on average, 0 at most; "));
}

// A ball that falls 0.9 m and keeps 0.9 of its speed: impacts come ever faster.
TEST_CASE("many events of one name are pale lines, a few are as dark as curves", "[figures]") {
  const auto lines = [](const std::string& end) {
    return of_text("energy",
                   "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
                   "{name = 'B', position = [0, 0, 1], mass = 1}]\n"
                   "[[constraints]]\nkind = 'length_stop'\nname = 'floor'\nnodes = ['A', 'B']\nmin = 0.1\n"
                   "restitution = 0.9\n[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = " +
                       end)
        .panels.at(0)
        .lines;
  };
  const auto upright = [](const ReferenceLine& line) { return !line.horizontal; };
  for (const char* end : {"2", "7"}) {  // 2 impacts and more than ten
    const std::vector<ReferenceLine> all = lines(end);
    const auto count = std::ranges::count_if(all, upright);
    CHECK((count > 10) == (std::string(end) == "7"));
    CHECK(std::ranges::all_of(
        all, [&](const ReferenceLine& line) { return !upright(line) || line.pale == (count > 5); }));
  }
}

TEST_CASE("however many groups there are, only forces that are not unique are dashed or dotted",
          "[figures]") {
  constexpr int links = 20;
  std::string nodes = "{name = 'N0', position = [0, 0, 0], fixed = true}", rods;
  for (int k = 1; k <= links; ++k) {
    const std::string i = std::to_string(k);
    nodes += ", {name = 'N" + i + "', position = [" + i + ", 0, " + (k % 2 ? "0.2" : "0") + "], mass = 1}";
    rods +=
        "{nodes = ['N" + std::to_string(k - 1) + "', 'N" + i + "'], mass = 1, group = 'link " + i + "'}, ";
  }
  for (const char* pair : {"'N0', 'N1'", "'N10', 'N11'"})  // beside the first and the eleventh
    rods += "{name = 'again " + std::string(1, pair[2]) + pair[8] + "', nodes = [" + pair +
            "], mass = 1, group = 'again " + pair[2] + pair[8] + "'}, ";
  const Figure f = of_text("rod_forces", "[structure]\nkind = 'custom'\nnodes = [" + nodes + "]\nrods = [" +
                                             rods + "]\n[gravity]\nacceleration = [0, 0, -9.81]\n" +
                                             "[solver]\nend_time = 0.05\n");
  int open = 0, unique = 0;
  for (const Curve& c : f.panels.at(0).curves) {
    const bool told = c.label.find("not unique") != std::string::npos;
    CAPTURE(c.label);
    CHECK((c.dash == Dash::dashed || c.dash == Dash::dotted) == told);
    if (!told) CHECK((c.dash == Dash::solid || c.dash == Dash::dash_dot));
    ++(told ? open : unique);
  }
  CHECK(open == 4);  // two rods side by side share what nothing divides, twice
  CHECK(unique == links - 2);
}

}  // namespace unfurl::figure_facts_test
