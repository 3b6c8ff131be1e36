// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/rigid_twin.hpp"

#include <catch2/catch.hpp>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace rigid_twin_test {

TEST_CASE("the rigid twin stands in the pose, with rods as long as they are and as yielding as before") {
  Structure s = testing::model_of(R"(
[structure]
kind = "custom"
youngs_modulus = 7e10
rod_model = "elastic"
nodes = [{name = "O", position = [0.5, 0, 0], fixed = true},
         {name = "A", position = [1.7, 0, 0.9], velocity = [0, 0.6, 0], mass = 0.4},
         {name = "B", position = [1.7, 2, 0.9], mass = 0.6}]
rods = [{nodes = ["O", "A"], mass = 1.2, area = 3e-5}, {nodes = ["A", "B"], mass = 0.9, area = 2e-5}]
)")
                    ->structure;
  s.rods[0].free_length = 1.4;
  s.rods[1].expansion = 1e-5;
  REQUIRE(s.rods[0].gives);
  VectorXd q(9);
  q << 0.5, 0, 0, 1.9, 0.2, 1.1, 1.5, 2.4, 0.6;
  const Structure twin = rigid_twin(s, q);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(twin.nodes[i].position == q.segment<3>(3 * static_cast<Index>(i)));
    CHECK(twin.nodes[i].velocity == s.nodes[i].velocity);
    CHECK(twin.nodes[i].mass == s.nodes[i].mass);
  }
  const double lengths[] = {Vec3(1.4, 0.2, 1.1).norm(), Vec3(-0.4, 2.2, -0.5).norm()};
  for (std::size_t r = 0; r < 2; ++r) {
    CHECK(twin.rods[r].length == Approx(lengths[r]).epsilon(1e-15));
    CHECK(twin.rods[r].natural_length() == twin.rods[r].length);
    CHECK(twin.rods[r].compliance() == Approx(s.rods[r].compliance()).epsilon(1e-14));
    CHECK_FALSE(twin.rods[r].gives);
    CHECK(twin.rods[r].expansion == 0);
    CHECK(twin.rods[r].mass == s.rods[r].mass);
  }
}

// An offload's trolley stands above the node at t = 0, and a bent rod's stiffness is that of its own length.
TEST_CASE("forces do in the rigid twin what they do in the structure") {
  const auto model = testing::model_of(R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0.5, 0, 0], fixed = true}, {name = "A", position = [1.7, 0.1, 0.9], mass = 0.4},
         {name = "B", position = [2.9, 0.4, 1.1], mass = 0.6}]
rods = [{nodes = ["O", "A"], mass = 1.2}, {nodes = ["A", "B"], mass = 0.9}]
[gravity]
acceleration = [0.7, -1.1, -9.5]
[[forces]]
kind = "offload"
nodes = ["B"]
length = 1.9
[[forces]]
kind = "bending"
nodes = ["O", "A", "B"]
stiffness = 23
damping = 1.7
)");
  VectorXd q(9), v(9);
  q << 0.5, 0, 0, 1.9, 0.2, 1.1, 3.4, 0.9, 0.6;
  v << 0, 0, 0, 0.4, -0.3, 0.2, 0.9, 0.1, -0.7;
  VectorXd own = VectorXd::Zero(9), of_twin = own;
  model->system.add_applied_force(0, q, v, 1.0, own);
  System(rigid_twin(model->structure, q), false).add_applied_force(0, q, v, 1.0, of_twin);
  CHECK((own - of_twin).norm() < 1e-13 * own.norm());  // round-off of some ten sums
}

}  // namespace rigid_twin_test
