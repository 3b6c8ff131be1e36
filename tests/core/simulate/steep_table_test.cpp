// SPDX-License-Identifier: BSD-3-Clause
// Tables as instruments record them: a row each 0.1 ms.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using testing::number, testing::run_scene;

namespace steep_table_test {

// A mass of 2 kg is led along a line to 1 + 0.2 sin(3 t) and held from 2 s on. It sets out at 0.6 m/s at once
// and is stopped at once: near both ends the accelerations of the curve through the rows swing from row to
// row. Steps end at these rows until the swing is 1e-6 of the speed; behind, a step of 10 ms goes over a
// hundred of them: 1e-4 of 0.36 J, the largest energy.
TEST_CASE("a table of many rows that begins and ends at speed is followed and its work is in the books") {
  for (const int rows : {201, 2001, 20001}) {
    CAPTURE(rows);
    std::string times, values;
    for (int i = 0; i < rows; ++i) {
      const double t = 2.0 * i / (rows - 1);
      times += (i ? ", " : "") + number(t);
      values += (i ? ", " : "") + number(1 + 0.2 * std::sin(3 * t));
    }
    const Simulation run = run_scene(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [1, 0, 0], mass = 2}, {name = 'O', "
        "position = [0, 0, 0], fixed = true}]\nconstraints = [{kind = 'line', nodes = ['A'], direction = [1, "
        "0, "
        "0]}]\n[[constraints]]\nkind = 'length'\nnodes = ['O', 'A']\nmotion = 'table'\ntimes = [" +
            times + "]\nvalues = [" + values + "]\n[solver]\nstep = 0.01\nend_time = 2.5\n",
        {});
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    const Trajectory& states = run.trajectory;
    const double swing = 20 * 2.0 / (rows - 1);  // 0.27^20 is 4e-12
    for (std::size_t i = 0; i < states.size(); ++i) {
      CHECK(std::abs(d.at("energy_balance_J").values[i]) <= 1e-4 * 0.36);
      const double t = states.time(i), v = states.velocities(i)[0];
      if (t > swing && t < 2 - swing) CHECK(v == Approx(0.6 * std::cos(3 * t)).epsilon(0).margin(1e-6));
      if (t > 2) CHECK(std::abs(v) <= 1e-12);
    }
  }
}

}  // namespace steep_table_test
