// SPDX-License-Identifier: BSD-3-Clause
// Blocks on a line that rub, and meet: what friction and a stop hold together, against the limits of statics.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace blocks_test {

namespace {

using testing::end_positions, testing::number, testing::run_scene;

constexpr double mass[] = {0.7, 1.1}, holding[] = {4, 4.3}, kinetic[] = {3.2, 3.6}, met = 0.25, ramp = 0.5;

// A and B, 1 m apart where they meet, with a stop between them that throws nothing back, each with friction
// of its own and a load [N] that is F up to `ramp` and grows by G [N/s] from there on. They come with
// momenta that are opposite as they meet, at `met`, and rest. sense = -1: the other way round along the line.
std::string blocks(const std::array<double, 2>& F, const std::array<double, 2>& G, int sense) {
  const double a[] = {(F[0] - kinetic[0]) / mass[0], (F[1] + kinetic[1]) / mass[1]};
  const double rate[] = {0.9 - a[0] * met, -0.9 * mass[0] / mass[1] - a[1] * met};
  std::string text = "[structure]\nkind = 'custom'\nrods = []\n", forces;
  for (const std::size_t i : {0U, 1U}) {
    const std::string name = i == 0 ? "'A'" : "'B'";
    text += "[[structure.nodes]]\nname = " + name + "\nposition = [" +
            number(sense * (static_cast<double>(i) - rate[i] * met - a[i] * met * met / 2)) +
            ", 0, 0]\nvelocity = [" + number(sense * rate[i]) + ", 0, 0]\nmass = " + number(mass[i]) + "\n";
    forces += "[[forces]]\nkind = 'friction'\nname = " + name + "\nnodes = [" + name +
              "]\ndirection = [1, 0, 0]\nkinetic = " + number(kinetic[i]) +
              "\nstatic = " + number(holding[i]) + "\n[[forces]]\nkind = 'load_over_time'\nnodes = [" + name +
              "]\nforce = [" + number(sense) + ", 0, 0]\ntimes = [0, " + number(ramp) + ", 9]\nvalues = [" +
              number(F[i]) + ", " + number(F[i]) + ", " + number(F[i] + G[i] * (9 - ramp)) + "]\n";
  }
  return text +
         "[[constraints]]\nkind = 'line'\nnodes = ['A', 'B']\ndirection = [1, 0, 0]\n"
         "[[constraints]]\nkind = 'length_stop'\nname = 'stop'\nnodes = ['A', 'B']\nmin = 1\n" +
         forces;
}

}  // namespace

// They hold as long as there is a push N >= 0 between them with |F_A - N| and |F_B + N| within what friction
// holds, whatever of that the stop bears.
TEST_CASE("blocks that have met rest by friction and stop until statics knows no way") {
  struct Case {
    std::array<double, 2> F, G;
    double slips;              // when
    std::array<bool, 2> goes;  // which
  };
  const double both = holding[0] + holding[1];
  for (const Case& c : {Case{{3, 2}, {2, 0}, ramp + (both - 5) / 2, {true, true}},
                        Case{{3.7, 1.2}, {1, 2}, ramp + (both - 4.9) / 3, {true, true}},
                        Case{{3, -2}, {0, 2.3}, ramp + (holding[1] + 2) / 2.3, {false, true}},
                        Case{{2.1, -3.4}, {-2.7, 0}, ramp + (holding[0] + 2.1) / 2.7, {true, false}},
                        Case{{3.1, -2.7}, {0, -3.5}, ramp + (both + 0.4) / 3.5, {true, true}}})
    for (const int sense : {1, -1}) {
      const double end = c.slips + 0.4;
      const std::string text = blocks(c.F, c.G, sense) + "[solver]\nend_time = " + number(end) + "\n";
      for (const char* method : {"dvm", "rk4"}) {
        const Simulation run = run_scene(text, {std::string("solver.method=") + method, "solver.step=0.05"});
        CAPTURE(c.F, sense, method, run.message);
        REQUIRE(run.status == RunStatus::completed);
        CHECK(run.warnings == std::vector<std::string>{});
        CHECK(run.events.front().kind == "contact");
        CHECK(run.events.front().t == Approx(met).epsilon(1e-10));
        for (const Event& event : run.events) UNSCOPED_INFO(event.name << " at " << event.t);
        bool told = false;
        for (const Event& event : run.events) {
          if (event.kind != "slip") continue;
          CHECK(event.t == Approx(c.slips).epsilon(1e-8));
          told = true;
        }
        CHECK(told);
        // From then on kinetic friction leaves a force that grows by G: x = f t^2 / 2 m + G t^3 / 6 m.
        double f = 0, g = 0, m = 0, way = 0;
        for (const std::size_t i : {0U, 1U})
          if (c.goes[i]) f += c.F[i] + c.G[i] * (c.slips - ramp), g += c.G[i], m += mass[i];
        for (const std::size_t i : {0U, 1U})
          if (c.goes[i]) f -= (g > 0 ? 1 : -1) * kinetic[i];
        way = (f / 2 + g * 0.4 / 6) * 0.16 / m;
        for (const std::size_t i : {0U, 1U})
          CHECK(sense * end_positions(run)[3 * static_cast<Index>(i)] ==
                Approx(static_cast<double>(i) + (c.goes[i] ? way : 0.0)).epsilon(0).margin(1e-8));
      }
    }
}

// The stop is touched without a force until the friction of A bears all that it can, and takes the rest then;
// B could not bear all that A's friction does besides its own load.
TEST_CASE("friction that bears all it can leaves what grows to a stop that was touched before") {
  const double alone = 2.1, other = 3.3, load = 1.4, growth = 4.2, slips = (alone + other - load) / growth;
  REQUIRE(load + alone > other);
  for (const int sense : {1, -1}) {
    const Simulation run = run_scene(
        "[structure]\nkind = 'custom'\nrods = []\nnodes = [{name = 'A', position = [0, 0, 0], mass = 0.7}, "
        "{name = "
        "'B', position = [" +
        number(sense) +
        ", 0, 0], mass = 1.1}]\n[[constraints]]\nkind = 'line'\nnodes = ['A', 'B']\ndirection = "
        "[1, 0, 0]\n[[constraints]]\nkind = 'length_stop'\nname = 'stop'\nnodes = ['A', 'B']\nmin = 1\n"
        "[[forces]]\nkind = 'friction'\nname = 'a'\nnodes = ['A']\ndirection = [1, 0, 0]\nkinetic = " +
        number(alone) +
        "\n[[forces]]\nkind = 'friction'\nname = 'b'\nnodes = ['B']\ndirection = [1, 0, 0]\nkinetic = " +
        number(other) + "\n[[loads]]\nnodes = ['B']\nforce = [" + number(sense * load) +
        ", 0, 0]\n[[forces]]\nkind = 'load_over_time'\nnodes = ['A']\nforce = [" + number(sense) +
        ", 0, 0]\ntimes = [0, 9]\nvalues = [0, " + number(9 * growth) +
        "]\n[solver]\nend_time = " + number(slips + 0.3) + "\n");
    CAPTURE(sense, run.message);
    REQUIRE(run.status == RunStatus::completed);
    CHECK(run.warnings == std::vector<std::string>{});
    CHECK(run.events.size() < 9);  // a's limit, the stop, both that slip
    for (const Index x : {0, 3})
      CHECK(sense * end_positions(run)[x] ==
            Approx(static_cast<double>(x) / 3 + growth * 0.027 / (6 * 1.8)).epsilon(0).margin(1e-8));
  }
}

// Both stops are touched, friction bears exactly all that it can: it has no stop to leave its place to.
TEST_CASE("stops between blocks bear nothing of what one of them rubs with on the ground") {
  const double most = 2, push = 1.5, from = -0.5, to = 1.3;
  const Simulation run = run_scene(
      "[structure]\nkind = 'custom'\nrods = []\nnodes = [{name = 'A', position = [0, 0, 0], mass = 1.6}, "
      "{name = 'B', "
      "position = [1, 0, 0], mass = 0.7}]\n[[constraints]]\nkind = 'line'\nnodes = ['A', 'B']\ndirection = "
      "[1, 0, "
      "0]\n[[constraints]]\nkind = 'length_stop'\nname = 'low'\nnodes = ['A', 'B']\nmin = "
      "1\n[[constraints]]\nkind "
      "= 'length_stop'\nname = 'high'\nnodes = ['A', 'B']\nmax = 1\n[[forces]]\nkind = 'friction'\nnodes = "
      "['A']\ndirection = [1, 0, 0]\nkinetic = " +
      number(most) + "\n[[loads]]\nnodes = ['A']\nforce = [" + number(-push) +
      ", 0, 0]\n[[forces]]\nkind = 'load_over_time'\nnodes = ['B']\nforce = [1, 0, 0]\ntimes = [0, "
      "1]\nvalues = [" +
      number(from) + ", " + number(to) + "]\n[solver]\nend_time = 1\n");
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.warnings == std::vector<std::string>{});
  REQUIRE(run.events.size() ==
          3);  // on the low one, and from it to the high one as the load changes its sign
  CHECK(run.events[1].t == Approx(-from / (to - from)).epsilon(1e-8));
  CHECK(std::abs(end_positions(run)[0]) < 1e-15);  // round-off of what holds
  CHECK(std::abs(end_positions(run)[3] - 1) < 1e-15);
}

}  // namespace blocks_test
