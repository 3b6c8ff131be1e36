// A run that went wrong says so.
#include <catch2/catch.hpp>

#include "core/diagnostics/accuracy.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace accuracy_test {

namespace {

std::vector<std::string> warnings_of(const std::string& method, int stages, double h) {
  SolverOptions options = dvm_options(stages, h, 6.0);
  options.method = method;
  return accuracy_warnings(diagnose(simulate(make_model(hoop_structure()), options)));
}

}  // namespace

TEST_CASE("accurate runs have nothing to say against themselves, coarse ones do") {
  CHECK(warnings_of("dvm", 4, 0.01).empty());
  // Second order at h = 0.1: the last rad of the ring's opening takes less than ten steps.
  const auto coarse = warnings_of("dvm", 2, 0.1);
  REQUIRE(coarse.size() == 1);
  CHECK(coarse[0].find("energy balance") != std::string::npos);
  // Runge-Kutta at h = 0.2 s: drift of the rods' lengths goes with h^4, 4e-7 m at h = 0.01.
  const auto drifting = warnings_of("rk4", 2, 0.2);
  REQUIRE_FALSE(drifting.empty());
  CHECK(drifting.back().find("constraints are violated") != std::string::npos);
}

}  // namespace accuracy_test
