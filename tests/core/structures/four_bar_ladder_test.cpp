// SPDX-License-Identifier: BSD-3-Clause
// The ladder of four-bar windows against its exact motion, through many poses with all rods collinear.
#include "core/structures/four_bar_ladder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/structures/family.hpp"
#include "tests/support/four_bar_exact.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace four_bar_ladder_test {

namespace {

struct Errors {
  double position = 0, phase = 0, constraint = 0;
};

// Largest errors of a run over 10 s: of positions [m], of every upright's turn [rad], of rod lengths [1].
Errors ladder_errors(int windows, double speed, int stages) {
  const Structure structure = ladder_structure(windows, speed);
  const Simulation run = simulate(make_model(structure), dvm_options(stages, 0.01, 10.0));
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const exact::FourBarLadder ladder{windows, speed};
  Errors e;
  std::vector<double> turn(static_cast<std::size_t>(windows) + 1, 0.0);
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const VectorXd q = run.trajectory.node_positions(i);
    const bool compare = i % 50 == 0 || i + 1 == run.trajectory.size();
    const double phi = compare ? ladder.angle(run.trajectory.time(i)) : 0.0;
    for (int k = 0; k <= windows; ++k) {
      double& angle = turn[static_cast<std::size_t>(k)];
      const Vec3 head = q.segment<3>(6 * k + 3), arm = head - Vec3(k, 0, 0);
      angle += std::remainder(std::atan2(arm.x(), arm.y()) - angle, 2 * M_PI);
      if (!compare) continue;
      e.phase = std::max(e.phase, std::abs(angle - phi));
      e.position = std::max(e.position, (arm - Vec3(std::sin(phi), std::cos(phi), 0)).norm());
    }
    for (const Rod& rod : structure.rods)
      e.constraint = std::max(
          e.constraint, std::abs((q.segment<3>(3 * rod.b) - q.segment<3>(3 * rod.a)).norm() - rod.length));
  }
  return e;
}

}  // namespace

TEST_CASE("the exact ladder conserves energy and repeats its turns") {
  // After k turns the speed is that of the start, so the times of the turns are equally spaced; to 1e-13 of
  // 30 rad/s.
  const exact::FourBarLadder ladder{1, 30.0};
  double lo = 0.2, hi = 0.22;
  for (int i = 0; i < 60; ++i) (ladder.angle(0.5 * (lo + hi)) < 2 * M_PI ? lo : hi) = 0.5 * (lo + hi);
  CHECK(ladder.angle(40 * lo) == Approx(80 * M_PI).epsilon(1e-14));
  // Small times, phi'' = k sin(phi): phi = v t + k v t^3 / 6 + (k^2 v - k v^3) t^5 / 120 + ..., with
  // k = (3/2)(4/5) 9.81; the next term is some k v^5 t^7 / 5040, 1e-16.
  const double t = 1e-3, v = 30, k = 1.2 * 9.81;
  CHECK(ladder.angle(t) ==
        Approx(v * t + k * v * std::pow(t, 3) / 6 + (k * k * v - k * v * v * v) * std::pow(t, 5) / 120)
            .epsilon(0)
            .margin(1e-15));
}

TEST_CASE("four_bar_ladder has 2 N + 1 rods and one degree of freedom that moves") {
  const Structure ladder = ladder_structure(3, 2.0);
  CHECK(ladder.nodes.size() == 8);
  CHECK(ladder.rods.size() == 7);
  for (const Rod& rod : ladder.rods)
    CHECK((ladder.nodes[static_cast<std::size_t>(rod.a)].position -
           ladder.nodes[static_cast<std::size_t>(rod.b)].position)
              .norm() == 1.0);
  const auto model = make_model(ladder);
  CHECK(model->system.solved_coordinates() - model->system.constraints() == 1);  // 2 (N + 1) - (2 N + 1)
  CHECK(find_family("four_bar_ladder") != nullptr);
}

TEST_CASE("a slow ladder follows its exact motion through collinear poses") {
  for (int windows : {1, 2, 40}) {
    const Errors e = ladder_errors(windows, 1.0, 4);
    INFO("N = " << windows << ": position " << e.position << " m, phase " << e.phase << " rad, constraint "
                << e.constraint);
    // h = 0.01, order 6, a turn of at most 0.08 rad a step: what shows is round-off, which upright poses (a
    // saddle) amplify by e^(4 s x 3.4/s) each time they are passed slowly.
    CHECK(e.position <= (windows == 2 ? 1e-10 : 1e-9));
    CHECK(e.constraint <= 1e-14);  // coordinates up to 41 m: their ulp is 7e-15
  }
}

TEST_CASE("a fast ladder keeps its branch through 97 collinear poses") {
  for (int windows : {1, 2, 40}) {
    const Errors e = ladder_errors(windows, 30.0, 6);
    INFO("N = " << windows << ": position " << e.position << " m, phase " << e.phase << " rad, constraint "
                << e.constraint);
    // h = 0.01, order 10, 0.3 rad a step: leaves 1e-12 a step, 1e-9 in a thousand. With two windows an inner
    // node of one step comes within 3e-4 rad of the collinear pose, where round-off of the rods' lengths
    // moves it by 1e-11 m, and its momentum by that over h.
    CHECK(e.phase <= (windows == 40 ? 1e-8 : windows == 1 ? 1e-9 : 1e-7));
    CHECK(e.constraint <= 1e-14);
  }
}

}  // namespace four_bar_ladder_test
