// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/jacobian_spectrum.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/system/mobility.hpp"
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
  const auto mobility = analyse_mobility(run.trajectory.model().system, run.trajectory.node_positions(0));
  // Two decompositions of one matrix: round-off of its largest singular value relative to the smallest.
  CHECK(s.smallest[0].front() == Approx(mobility.smallest_singular_value).epsilon(1e-10));
}

TEST_CASE("a structure without singular poses keeps its spectrum away from zero") {
  const Simulation run = simulate(make_model(double_pendulum()), dvm_options(3, 0.02, 1.0));
  const JacobianSpectrum s = jacobian_spectrum(run, 10);
  CHECK(static_cast<Index>(s.smallest.size()) == s.rank);
  for (const double sigma : s.smallest[0]) CHECK(sigma > 0.1);
}
