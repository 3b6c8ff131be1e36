// SPDX-License-Identifier: BSD-3-Clause
// How far nodes are from a paraboloid.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/structure/structure.hpp"

using namespace unfurl;

namespace reported_surface_test {

// Of errors 1, -2, 3, -2 mm along the axis: the root of their mean square, their mean being zero; wherever
// the vertex lies on the axis.
TEST_CASE("the surface error is that along the axis, less its mean") {
  const double focal = 1.7, errors[] = {1e-3, -2e-3, 3e-3, -2e-3};
  for (const double vertex : {0.0, -0.8, 12.0}) {
    ReportedSurface surface;
    surface.focal_length = focal;
    VectorXd q(15);
    q.head<3>().setConstant(5);  // a node that is not of it
    for (int k = 0; k < 4; ++k) {
      const double r = 0.3 + 0.4 * k, angle = 1.1 * k;
      surface.nodes.push_back(k + 1);
      q.segment<3>(3 * k + 3) << r * std::cos(angle), r * std::sin(angle),
          vertex + r * r / (4 * focal) + errors[k];
    }
    CHECK(surface.rms(q) == Approx(std::sqrt(18.0 / 4) * 1e-3).epsilon(1e-11));
  }
}

}  // namespace reported_surface_test
