// SPDX-License-Identifier: BSD-3-Clause
// What figures say of a run in words and lines: its events.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "render/plot/figures.hpp"
#include "tests/support/scene_run.hpp"

namespace unfurl::figure_facts_test {

namespace {

Figure of_text(const std::string& figure, const std::string& scene) {
  const Simulation run = testing::run_scene(scene);
  return find_figure(figure)->make(run, diagnose(run));
}

}  // namespace

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

}  // namespace unfurl::figure_facts_test
