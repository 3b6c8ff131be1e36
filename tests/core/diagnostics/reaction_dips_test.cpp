// SPDX-License-Identifier: BSD-3-Clause
// The size of a reaction that passes nothing within a step, and its peaks.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/motion_samples.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/diagnostics/reactions.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace reaction_dips_test {

// A mass of 1 kg in its guide under a weight of 1 N, held by a drive: it bears 1 N, and 0.2 N as long as a
// load takes 0.8 N of it. From `start` on it is driven the other way, at up to -0.15 / ramp m/s^2 within
// `ramp`: its reaction goes from 1 N through nothing and back, within two steps of which no state tells. The
// corner is found to 4^-6 of the eighth of a step over which it changes by 8 N: some 1e-3 N at most.
TEST_CASE("a reaction that passes nothing behind the start of a drive has nothing as its least") {
  for (const double start : {0.2, 1.234, 3.0})
    for (const double ramp : {0.02, 0.013}) {
      CAPTURE(start, ramp);
      const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "B", position = [0, 0, 0], mass = 1}]
rods = []
constraints = [{kind = "line", nodes = ["B"], direction = [1, 0, 0]}]
[gravity]
acceleration = [-1, 0, 0]
[[forces]]
kind = "load_over_time"
nodes = ["B"]
force = [0.8, 0, 0]
times = [0, 0.1, 0.1, 9]
values = [1, 1, 0, 0]
[[constraints]]
kind = "coordinate"
nodes = ["B"]
direction = [1, 0, 0]
motion = "rate"
rate = -0.1
ramp = )" + testing::number(ramp) +
                                                "\nstart = " + testing::number(start) + R"(
[solver]
stages = 4
step = 0.01
end_time = 4
)");
      REQUIRE(run.status == RunStatus::completed);
      const Diagnostics d = diagnose(run);
      CHECK(largest_of_column(run, d, "B.reaction_x_N") == Approx(1).epsilon(1e-9));
      CHECK(smallest_of_column(run, d, "B.reaction_x_N") < -5);
      CHECK(smallest_of_column(run, d, "B.reaction_N") < 1e-3);
      CHECK(smallest_of_column(run, d, "B.reaction_N") >= 0);
    }
}

// Between states a reaction goes straight on, as far as they tell: its least size there by 2001 points.
TEST_CASE("a reaction dips between states where a straight line does and in the three lowest such steps") {
  for (const double phase : {0.4, 1.3, 2.9, 4.6}) {
    Diagnostics d;
    for (const char* name : {"S.reaction_N", "S.reaction_x_N", "S.reaction_y_N", "S.reaction_z_N"})
      d.columns.push_back({name, "", "N", {}});
    constexpr int states = 30;
    std::vector<Vec3> force;
    for (int k = 0; k < states; ++k) {
      force.emplace_back(3 * std::sin(2.3 * k + phase), 5 * std::sin(1.1 * k * k), 0.2 + std::cos(0.6 * k));
      d.t.push_back(0.1 * k);
      d.columns[0].values.push_back(force.back().norm());
      for (Index x = 0; x < 3; ++x)
        d.columns[static_cast<std::size_t>(x) + 1].values.push_back(force.back()[x]);
    }
    std::vector<std::pair<double, std::size_t>> dips;
    for (std::size_t i = 0; i + 1 < states; ++i) {
      std::pair<double, int> least{1e9, 0};
      for (int k = 0; k <= 2000; ++k)
        least = std::min(least, {(force[i] + k / 2000.0 * (force[i + 1] - force[i])).norm(), k});
      if (least.second > 0 && least.second < 2000) dips.emplace_back(least.first, i);
    }
    std::ranges::sort(dips);
    REQUIRE(dips.size() > 3);
    CHECK(reaction_dips(d, "S.reaction_N") == std::vector{dips[0].second, dips[1].second, dips[2].second});
    CHECK(reaction_dips(d, "S.reaction_x_N").empty());
    CHECK(reaction_dips(d, "T.reaction_N").empty());
  }
}

TEST_CASE("the peak of a reaction is the first of its largest that are known") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [2, 0, 0], fixed = true},
         {name = "C", position = [1, 0.5, 0]}]
rods = [{nodes = ["A", "C"], mass = 1}, {nodes = ["B", "C"], mass = 1}]
[solver]
step = 0.02
end_time = 0.1
)");
  Diagnostics d = diagnose(run);
  REQUIRE(d.t.size() == 6);
  const auto set = [&d](const char* name, const std::vector<double>& values) {
    std::ranges::find(d.columns, name, &Series::name)->values = values;
  };
  const double nan = std::nan("");
  set("A.reaction_N", {nan, 3, 7, 7, nan, 2}), set("A.reaction_unique", {1, 1, 0, 1, 1, 1});
  set("B.reaction_N", {nan, nan, nan, nan, nan, nan});
  std::vector<PeakReaction> peaks = peak_reactions(run.trajectory.structure(), d);
  REQUIRE(peaks.size() == 2);
  CHECK(peaks[0].force_N == 7);
  CHECK(peaks[0].t == d.t[2]);
  CHECK(!peaks[0].unique);
  CHECK(std::isnan(peaks[1].force_N));
  CHECK(peaks[0].node != peaks[1].node);
  set("A.reaction_N", {9, 3, 7, 7, nan, 2}), set("B.reaction_N", {1, 2, 3, 4, 5, 6});
  peaks = peak_reactions(run.trajectory.structure(), d);
  CHECK(peaks[0].force_N == 9);
  CHECK(peaks[0].t == 0);
  CHECK(peaks[0].unique);
  CHECK(peaks[1].force_N == 6);
  CHECK(peaks[1].t == d.t[5]);
}

// Reactions ask for a solution of their own, and of a structure on many supports for most of the columns.
TEST_CASE("within steps reactions are found where they are asked for, and all else is the same to the bit") {
  const Simulation run = testing::run_scene(
      "[structure]\nkind = 'custom'\n"
      "nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [1, 0, 0]},\n"
      "         {name = 'C', position = [1, 1, 0], mass = 0.3}]\n"
      "rods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['B', 'C'], mass = 1}]\n"
      "[[constraints]]\nkind = 'plane'\nnodes = ['B', 'C']\nnormal = [0, 0, 1]\n"
      "[gravity]\nacceleration = [0, -9.81, 0]\n[solver]\nstep = 0.02\nend_time = 0.2\n");
  using Of = MotionSamples::Of;
  Diagnostics made, more;
  judged_piece(run, Of::motion, made), judged_piece(run, Of::reactions, more);
  std::size_t reactions = 0;
  for (const Series& column : more.columns) {
    const bool reaction = table_of(column) == Of::reactions;
    CHECK(reaction == (column.name.find("reaction") != std::string::npos));
    CHECK(reaction == (made.find(column.name) == nullptr));
    reactions += reaction ? 1 : 0;
    if (reaction) continue;
    const std::vector<double>& x = made.at(column.name).values;
    for (std::size_t i = 0; i < x.size(); ++i)
      CHECK((x[i] == column.values[i] || (std::isnan(x[i]) && std::isnan(column.values[i]))));
  }
  CHECK(reactions == 5);  // of A; that planes keep it flat holds no node
  CHECK(made.axial_force == more.axial_force);
}

}  // namespace reaction_dips_test
