// SPDX-License-Identifier: BSD-3-Clause
// How rods that rigid ones leave open share what they bear, and what that tends to in a pose without an
// answer.
#include "core/simulate/elastic_sharing.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace elastic_sharing_test {

namespace {

// A node in a plane on three rods of their own stiffnesses.
const std::string tripod = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [-1, 2, 0], fixed = true}, {name = "B", position = [0.2, 2.5, 0], fixed = true},
         {name = "D", position = [1.4, 1.7, 0], fixed = true}, {name = "C", position = [0, 0, 0], mass = 3}]
rods = [{nodes = ["A", "C"], mass = 0, area = 1e-4, youngs_modulus = 7e9},
        {nodes = ["B", "C"], mass = 0, area = 3e-4, youngs_modulus = 2e10},
        {nodes = ["D", "C"], mass = 0, area = 2e-4, youngs_modulus = 9e9}]
constraints = [{kind = "plane", nodes = ["C"], normal = [0, 0, 1]}]
)";

// lambda less as much of the self-stress n as leaves the least energy: n . C (lambda - x n) = 0.
VectorXd shared(const VectorXd& lambda) {
  Eigen::Matrix<double, 2, 3> along;
  along << -1, 0.2, 1.4, 2, 2.5, 1.7;
  const Eigen::RowVector3d length = along.colwise().norm();
  for (Index r = 0; r < 3; ++r) along.col(r) /= length[r];
  const Vec3 n = Vec3(along.row(0)).cross(Vec3(along.row(1)));
  const Vec3 compliance(length[0] / 7e5, length[1] / 6e6, length[2] / 1.8e6);
  return lambda - n * (n.dot(compliance.cwiseProduct(lambda)) / n.dot(compliance.cwiseProduct(n)));
}

Vec3 given(double t) {  // of degree 4
  return Vec3(700, -300, 90) + t * Vec3(50, 20, -800) + t * t * Vec3(-300, 10, 40) +
         t * t * t * Vec3(7, -600, 30) + t * t * t * t * Vec3(90, 80, -500);
}

}  // namespace

// The polynomial of degree 4 through the last five changes is the changes.
TEST_CASE("rods share by their least energy and at a limit as the motion before it tends to") {
  const auto model = testing::model_of(tripod);
  REQUIRE(model->system.constraints() == 3);
  VectorXd q(model->system.coordinates());
  q << -1, 2, 0, 0.2, 2.5, 0, 1.4, 1.7, 0, 0, 0, 0;
  ElasticSharing sharing(*model, false);
  const auto share = [&](double t, bool limit) {
    VectorXd lambda = given(t);
    sharing.share(t, q, limit, lambda);
    return lambda;
  };
  CHECK((share(0.9, true) - given(0.9)).norm() <= 1e-9);  // nothing is known of a motion before it
  for (const double t : {0.1, 0.17, 0.3, 0.35, 0.5, 0.62, 0.7}) {
    INFO(t);
    CHECK((share(t, false) - shared(given(t))).norm() <= 1e-9 * 700);
  }
  for (const double t : {0.7, 0.8, 1.1}) CHECK((share(t, true) - shared(given(t))).norm() <= 1e-7 * 700);
  // An impulse: what comes before it tells nothing of what comes behind.
  VectorXd behind = given(2.0);
  sharing.share(0.7, q, false, behind);
  CHECK((behind - shared(given(2.0))).norm() <= 1e-9 * behind.norm());
  CHECK((share(0.8, true) - given(0.8) - (behind - given(2.0))).norm() <= 1e-9 * behind.norm());
  ElasticSharing none(*model, true);  // all is determined
  VectorXd lambda = given(0.3);
  none.share(0.3, q, false, lambda);
  CHECK(lambda == VectorXd(given(0.3)));
}

}  // namespace elastic_sharing_test
