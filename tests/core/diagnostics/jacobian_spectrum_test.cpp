// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/jacobian_spectrum.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/system/mobility.hpp"
#include "tests/support/family_structure.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

TEST_CASE("the spectrum of a ring falls to zero where it is deployed, in proportion to the fold angle") {
  const Simulation run = simulate(make_model(hoop_structure()), dvm_options(3, 0.01, 6.0));
  REQUIRE(spectrum_applies(run));
  const JacobianSpectrum s = jacobian_spectrum(run);
  CHECK(s.constraints == 78);
  CHECK(s.coordinates == 72);
  CHECK(s.rank == 71);  // 12 n - 1 at n = 6
  REQUIRE(s.smallest.size() == 3);
  CHECK(s.t.back() == run.trajectory.end_time());
  CHECK(s.smallest[0].back() == 0.0);  // the deployed pose is singular
  for (std::size_t i = 0; i < s.t.size(); ++i) {
    CHECK(s.smallest[0][i] <= s.smallest[1][i]);
    CHECK(s.smallest[2][i] <= s.largest[i]);
    CHECK(s.largest[i] >= 1.0);  // rows of length 1
    CHECK(s.largest[i] <= std::sqrt(78.0));
  }
  const double smallest =
      smallest_singular_value(run.trajectory.model().system, run.trajectory.node_positions(0), s.rank);
  // Two decompositions of one matrix: round-off of its largest singular value relative to the smallest.
  CHECK(s.smallest[0].front() == Approx(smallest).epsilon(1e-10));
}

TEST_CASE("a structure without singular poses keeps its spectrum away from zero") {
  const Simulation run = simulate(make_model(double_pendulum()), dvm_options(3, 0.02, 1.0));
  const JacobianSpectrum s = jacobian_spectrum(run, 10);
  CHECK(static_cast<Index>(s.smallest.size()) == s.rank);
  for (const double sigma : s.smallest[0]) CHECK(sigma > 0.1);
}

// Unit rows: three that fix O, [-u1, u1, 0] / sqrt 2 and [0, -u2, u2] / sqrt 2. G G^T has the eigenvalues
// 1, three times, and 1 -+ sqrt(1/2 + c^2 / 4) with c = u1 . u2.
TEST_CASE("the spectrum of a double pendulum follows the angle between its rods") {
  const Simulation run = simulate(make_model(double_pendulum()), dvm_options(3, 0.02, 1.0));
  const JacobianSpectrum s = jacobian_spectrum(run);
  REQUIRE(s.rank == 5);
  REQUIRE(s.smallest.size() == 3);
  REQUIRE(s.t.size() == run.trajectory.size());
  double least = 1, most = 0;
  for (std::size_t i = 0; i < s.t.size(); ++i) {
    CHECK(s.t[i] == run.trajectory.time(i));
    const VectorXd x = run.trajectory.node_positions(i);
    const Vec3 u = (x.segment<3>(3) - x.segment<3>(0)).normalized(),
               v = (x.segment<3>(6) - x.segment<3>(3)).normalized();
    const double c = u.dot(v), apart = std::sqrt(0.5 + c * c / 4);
    // Round-off of a decomposition of five rows, its least value 0.37.
    CHECK(s.largest[i] == Approx(std::sqrt(1 + apart)).epsilon(1e-13));
    CHECK(s.smallest[0][i] == Approx(std::sqrt(1 - apart)).epsilon(1e-13));
    CHECK(s.smallest[1][i] == Approx(1).epsilon(1e-13));
    CHECK(s.smallest[2][i] == Approx(1).epsilon(1e-13));
    least = std::min(least, std::abs(c)), most = std::max(most, std::abs(c));
  }
  CHECK(most - least > 0.3);  // it does turn
}

TEST_CASE("a spectrum takes as many states as its work allows, evenly from the first to the last") {
  // 2e8 of rows x columns x the smaller of the two: 400 states of a chain of 40, fewer of a
  // chain of 60.
  for (const long links : {40L, 60L}) {
    const Structure chain = family_structure("chain", {{"links", links}, {"held", std::string("both")}});
    const Simulation run = simulate(make_model(chain), dvm_options(2, 0.002, 0.8));
    const JacobianSpectrum s = jacobian_spectrum(run);
    const double rows = static_cast<double>(s.constraints), columns = static_cast<double>(s.coordinates),
                 work = rows * columns * std::min(rows, columns);
    const std::size_t states = std::min<std::size_t>(400, static_cast<std::size_t>(2e8 / work));
    INFO(links << ": " << rows << " x " << columns << ", " << states);
    REQUIRE(run.trajectory.size() == 401);
    CHECK(s.t.size() == states);
    CHECK(s.t.front() == 0);
    CHECK(s.t.back() == run.trajectory.end_time());
    for (std::size_t k = 1; k < s.t.size(); ++k)
      CHECK(s.t[k] - s.t[k - 1] == Approx(0.8 / static_cast<double>(states - 1)).epsilon(0).margin(0.0021));
  }
}
