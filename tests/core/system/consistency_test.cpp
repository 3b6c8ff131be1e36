// SPDX-License-Identifier: BSD-3-Clause
// What cannot be assembled as given is refused wherever the origin lies.
#include <catch2/catch.hpp>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace consistency_test {

TEST_CASE("nodes that are off their line are refused by the same measure, however far the origin is") {
  const auto refused = [](double at, double off) {
    const std::string x = testing::number(at), y = testing::number(at + off),
                      text = "[structure]\nkind = 'custom'\nnodes = [\n{name='A',position=[" + x + "," + x +
                             "," + x + "],fixed=true},\n{name='B',position=[" + testing::number(at + 0.6) +
                             "," + y + "," + x + "],mass=1},\n{name='C',position=[" +
                             testing::number(at + 1.3) + "," + x + "," + x +
                             "],mass=1}]\nrods=[{nodes=['A','B'],mass=1},{nodes=['B','C'],mass=1}]\n" +
                             "[[structure.constraints]]\nkind='collinear'\nnodes=['A','B','C']\n";
    return testing::error_of(text).find("cannot be assembled as given") != std::string::npos;
  };
  for (const double at : {0.0, 900.0, -900.0}) {
    INFO(at);
    CHECK_FALSE(refused(at, 0));
    CHECK_FALSE(refused(at, 2e-8));
    CHECK(refused(at, 1e-4));
  }
}

}  // namespace consistency_test
