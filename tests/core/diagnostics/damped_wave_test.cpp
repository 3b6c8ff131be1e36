// SPDX-License-Identifier: BSD-3-Clause
// What damped elastic rods take where steps do not resolve their waves.
#include <catch2/catch.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/damped_rods.hpp"
#include "core/diagnostics/diagnostics.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace damped_wave_test {

// 1 kg and half a rod of 0.27 kg, let go unstretched on k = E A / l = 7e6 N/m: what the weight W gives until
// it rests, W^2 / k, is half stored then, and a damper has taken the other half: no more at any time. The
// system is linear and the method a collocation at its Gauss points, which loses what dampers take at these:
// the balance is round-off, 1e-16 m of a stretch of 1.6e-6 m.
TEST_CASE("a damped rod whose waves are not resolved takes what there is") {
  const double weight = 1.135 * 9.81, most = weight * weight / (2 * 7e6);
  for (const double ratio : {1e-3, 0.01, 0.05, 0.2})
    for (const char* more : {"stages = 2", "stages = 3", "stages = 4", "stages = 5", "step = 0.002"}) {
      CAPTURE(ratio, more);
      const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
youngs_modulus = 7e10
rod_model = "elastic"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [0, 0, -1], mass = 1}]
rods = [{nodes = ["O", "A"], density = 2700, area = 1e-4}]
constraints = [{kind = "line", nodes = ["A"], direction = [0, 0, 1]}]
damping_ratio = )" + testing::number(ratio) + R"(
[gravity]
acceleration = [0, 0, -9.81]
[solver]
end_time = 0.5
)" + more);
      const Diagnostics d = diagnose(run);
      CHECK(mistrust(run, d).empty());
      CHECK(testing::largest(d, "energy_balance_J") < 1e-6 * most);
      const std::vector<double>& taken = d.at("dissipated_J").values;
      for (std::size_t i = 1; i < taken.size(); ++i) CHECK(taken[i] >= taken[i - 1] - 1e-6 * most);
      CHECK(taken.back() <= (1 + 1e-6) * most);
    }
}

// Two rods that move as they like, far from the origin: c (rate of length)^2 each, c = damping_time E A / l.
TEST_CASE("dampers of rods take what their lengths change by wherever they are and however they turn") {
  const auto model = testing::model_of(R"(
[structure]
kind = "custom"
rod_model = "elastic"
damping_time = 0.003
nodes = [{name = "A", position = [7, -3, 2], mass = 1}, {name = "B", position = [8.2, -2.1, 2.5], mass = 1},
         {name = "C", position = [8, -2, 4], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 0.1, area = 1e-4, youngs_modulus = 7e9},
        {nodes = ["C", "B"], mass = 0.1, area = 3e-4, youngs_modulus = 2e9}]
)");
  VectorXd q(9), v(9);
  q << 7, -3, 2, 8.2, -2.1, 2.5, 8, -2, 4;
  v << 0.3, -0.2, 0.7, 0.1, 1.4, -0.3, -0.9, 0.2, 0.5;
  double power = 0;
  for (const auto& [a, b, stiff] : {std::tuple{0, 1, 7e5}, {2, 1, 6e5}}) {
    const Vec3 along = q.segment<3>(3 * b) - q.segment<3>(3 * a);
    const double rate = along.normalized().dot(v.segment<3>(3 * b) - v.segment<3>(3 * a));
    power += 0.003 * stiff / along.norm() * rate * rate;
  }
  CHECK(DampedRods(model->system).power(0.4, q, v) == Approx(power).epsilon(1e-12));
}

}  // namespace damped_wave_test
