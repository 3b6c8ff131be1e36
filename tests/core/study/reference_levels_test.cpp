// SPDX-License-Identifier: BSD-3-Clause
// Which of its solutions a reference is, and what it says of itself.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/simulate/initial_state.hpp"
#include "core/study/extrapolation.hpp"
#include "core/study/reference.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace reference_levels_test {

namespace {

// Node coordinates at the times of so many intervals, by steps of the extrapolation of 1/parts of one.
std::vector<VectorXd> solution(const Model& model, double end, int intervals, int parts) {
  State state = initial_state(model.structure, model.system).state;
  Extrapolation method(model.system);
  std::vector<VectorXd> out;
  VectorXd q(model.system.coordinates());
  for (int i = 0; i <= intervals * parts; ++i) {
    if (i % parts == 0) {
      model.system.expand(state.z, q);
      out.push_back(q);
    }
    if (i < intervals * parts) REQUIRE(method.step(state, end / (intervals * parts)));
  }
  return out;
}

double apart(const std::vector<VectorXd>& a, const std::vector<VectorXd>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (Index n = 0; n < a[i].size(); n += 3)
      most = std::max(most, (a[i].segment<3>(n) - b[i].segment<3>(n)).norm());
  return most;
}

}  // namespace

// Twice as many steps at each level, until two of them agree as well as is asked for; the other method, dvm,
// is brought as near as that.
TEST_CASE("a reference is the first of its solutions that agrees with the one before as well as is enough") {
  const auto model = make_model(double_pendulum());
  constexpr double end = 1.3;
  int found = 0;
  for (const int intervals : {2, 3, 6}) {
    std::vector<std::vector<VectorXd>> all{solution(*model, end, intervals, 1)};
    for (int level = 1; level < 5; ++level) {
      all.push_back(solution(*model, end, intervals, 1 << level));
      const double d = apart(all[all.size() - 1], all[all.size() - 2]);
      if (!(d < 5e-7) || d < 1e-12) continue;  // as near as a reference has to be, and above round-off
      INFO(intervals << " intervals, level " << level << ": " << d << " m");
      const Reference r = solve_reference(model, end, intervals, {}, 1.5 * d / structure_size(*model));
      CHECK(r.how == "Bulirsch-Stoer extrapolation of order 16 on the index-1 equations with " +
                         std::to_string(intervals << level) + " basic steps");
      // Round-off of some 40 steps, larger than that of single ones by the growth in a swing.
      CHECK(apart(r.q, all.back()) < 1e-12);
      CHECK(r.uncertainty >= 0.999 * d);
      CHECK(r.uncertainty <= 1.5 * d);
      CHECK(r.confirmed);
      REQUIRE(r.t.size() == static_cast<std::size_t>(intervals) + 1);
      for (int i = 0; i <= intervals; ++i)
        CHECK(r.t[static_cast<std::size_t>(i)] == Approx(end * i / intervals).epsilon(1e-15));
      CHECK(r.size == structure_size(*model));
      ++found;
    }
  }
  CHECK(found >= 3);
}

}  // namespace reference_levels_test
