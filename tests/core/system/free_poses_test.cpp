// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/free_poses.hpp"
#include "core/structure/node_positions.hpp"

#include <catch2/catch.hpp>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"

using namespace unfurl;

namespace free_poses_test {

namespace {

Structure structure_of(const std::string& text) {
  return build_structure(read_scene_text(text, "test", {}, "."));
}

// A bob on a rod of 1.3 m about a fixed point, and a second one on it of 0.8 m.
const char* const double_pendulum =
    "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
    "[[structure.nodes]]\nname = 'P'\nposition = [1.3, 0, 0]\n[[structure.nodes]]\nname = 'Q'\n"
    "position = [1.3, 0.8, 0]\n[[structure.rods]]\nnodes = ['O', 'P']\nmass = 1\n[[structure.rods]]\n"
    "nodes = ['P', 'Q']\nmass = 1\n";

}  // namespace

TEST_CASE("a bob that is pulled goes to the nearest point of its sphere") {
  const Structure structure = structure_of(
      "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'P'\nposition = [1.3, 0, 0]\n[[structure.rods]]\nnodes = ['O', 'P']\nmass "
      "= 1\n");
  const FreePoses poses(structure);
  VectorXd q = node_positions(structure);
  const Vec3 target(0.4, 1.1, -0.9);
  // A call goes a part of the way, as a frame of a drag does.
  for (int i = 0; i < 30; ++i) q = poses.pulled(q, 1, target);
  CHECK((q.segment<3>(3) - 1.3 * target.normalized()).norm() < 1e-3);
  CHECK(q.head<3>().norm() < 1e-15);  // the fixed point stays
  CHECK(poses.error(q) < 1e-9);
}

TEST_CASE("what can be reached is reached, what cannot as near as the rods let it") {
  const Structure structure = structure_of(double_pendulum);
  const FreePoses poses(structure);
  VectorXd q = node_positions(structure);
  const Vec3 near(0.7, 0.9, 0.6);  // 1.29 m from O, within 0.5 and 2.1 m
  for (int i = 0; i < 30; ++i) q = poses.pulled(q, 2, near);
  CHECK((q.segment<3>(6) - near).norm() < 1e-6);
  CHECK(poses.error(q) < 1e-9);
  const Vec3 far(0, 0, 5);
  for (int i = 0; i < 60; ++i) q = poses.pulled(q, 2, far);
  CHECK((q.segment<3>(6) - Vec3(0, 0, 2.1)).norm() < 0.02);  // stretched: 1.3 m and 0.8 m
  CHECK(poses.error(q) < 1e-9);
}

TEST_CASE("free motions are as many as the degrees of freedom, keep the constraints and lead to poses") {
  // Two directions for each bob of a double pendulum in space; none of them moves it as a rigid body but the
  // three turns about O, which are no shapes: one is left.
  const Structure two = structure_of(double_pendulum);
  const FreePoses poses(two);
  const VectorXd q = node_positions(two);
  const MatrixXd V = poses.motions(q);
  CHECK(V.cols() == 1);
  CHECK((V.transpose() * V - MatrixXd::Identity(V.cols(), V.cols())).norm() < 1e-9);
  for (const char* name : {"four_bar", "bricard"}) {  // one-parameter linkages
    INFO(name);
    const Structure structure = build_structure(read_scene_file(find_scene(name)));
    const FreePoses linkage(structure);
    const VectorXd start = node_positions(structure);
    const MatrixXd motions = linkage.motions(start);
    REQUIRE(motions.cols() == 1);
    const double way = 0.03 * linkage.size();
    const VectorXd there = linkage.moved(start, motions.col(0), way);
    CHECK(linkage.error(there) < 1e-9 * linkage.size());
    double most = 0;
    for (Index i = 0; i < there.size(); i += 3) most = std::max(most, (there - start).segment<3>(i).norm());
    CHECK(most == Approx(way).epsilon(0.1));  // but for the bend of its path
  }
}

TEST_CASE("a drive lets go of what is led by hand") {
  const Structure structure = build_structure(read_scene_file(find_scene("hoop6_motor")));
  const FreePoses poses(structure);
  CHECK(poses.motions(node_positions(structure)).cols() >= 1);
}

}  // namespace free_poses_test
