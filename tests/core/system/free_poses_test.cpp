// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/free_poses.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/node_positions.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"

using namespace unfurl;

namespace free_poses_test {

namespace {

Structure structure_of(const std::string& text) {
  return build_structure(read_scene_text(text, "test", {}, "."));
}

// The angles that a structure counts, at its start.
VectorXd followed_of(const Structure& structure) {
  const FollowedAngles followed = followed_angles(structure);
  VectorXd angles(static_cast<Index>(followed.measures.size()));
  for (std::size_t i = 0; i < followed.measures.size(); ++i)
    angles[static_cast<Index>(i)] = followed.measures[i].reference;
  return angles;
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
  FreePoses poses(structure);
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
  FreePoses poses(structure);
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

TEST_CASE(
    "a rotor is no body: what a motor turns is a free motion, what the whole does as one body is none") {
  for (const double x : {0.0, 7.0})
    for (const char* inertia : {"0", "0.1"}) {
      const Structure structure = structure_of(
          "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [" + std::to_string(x) +
          ", 0, 0]}, {name = 'B', position = [" + std::to_string(x + 1) +
          ", 0.2, 0]}, {name = 'C', position = [" + std::to_string(x + 1.3) +
          ", 1, 0]}]\nrods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['B', 'C'], mass = 1}]\n"
          "[[forces]]\nkind = 'motor'\nnodes = ['A', 'B', 'C']\naxis = [0, 0, 1]\nstall_torque = 1\n"
          "no_load_speed = 60\ninertia = " +
          inertia + "\n");
      // Two rods in a row have seven degrees of freedom; six are those of a body.
      CHECK(FreePoses(structure).motions(node_positions(structure)).cols() == 1);
      CHECK(FreePoses(structure).size() == Approx(std::hypot(1.3, 1.0)));  // of the box of A, B, C, wherever
    }
}

TEST_CASE("a drive lets go of what is led by hand") {
  const Structure structure = build_structure(read_scene_file(find_scene("hoop6_motor")));
  const FreePoses poses(structure);
  CHECK(poses.motions(node_positions(structure)).cols() >= 1);
}

// Two links of 1 m in a plane; the second turns against the first by twice the angle of the first against the
// ground: with the first at u, the second points along 3 u. A drive turns the first.
const char* const geared =
    "[structure]\nkind = 'custom'\nnodes = [{name = 'W', position = [-1, 0, 0], fixed = true},\n"
    "{name = 'O', position = [0, 0, 0], fixed = true}, {name = 'A', position = [1, 0, 0]},\n"
    "{name = 'B', position = [2, 0, 0]}]\n"
    "rods = [{nodes = ['O', 'A'], mass = 1}, {nodes = ['A', 'B'], mass = 1}]\n"
    "constraints = [{kind = 'plane', nodes = ['A', 'B'], normal = [0, 0, 1]},\n"
    "{kind = 'gear', nodes = ['W', 'O', 'A', 'O', 'A', 'B'], radii = [2, -1], axis = [0, 0, 1]}]\n";

TEST_CASE("a gear is kept by what is led by hand, also after turns") {
  const Structure structure = structure_of(geared);
  const auto pose = [&](double u) {
    VectorXd q = node_positions(structure);
    q.segment<3>(6) = Vec3(std::cos(u), std::sin(u), 0);
    q.segment<3>(9) = q.segment<3>(6) + Vec3(std::cos(3 * u), std::sin(3 * u), 0);
    return q;
  };
  const double tip_error = 1e-6;  // rows are met to 1e-10 of the size, squares of small steps of a hand aside
  FreePoses poses(structure);
  REQUIRE(poses.error(pose(0.4)) < 1e-12);
  CHECK(poses.motions(pose(0.4)).cols() == 1);
  // The tip of the first link is led around by small steps, one and a half turns: the second link, by 4.5.
  VectorXd q = pose(0);
  for (double u = 0.05; u < 3 * pi; u += 0.05) {
    q = poses.pulled(q, 2, pose(u).segment<3>(6));
    CHECK((q - pose(u)).norm() < tip_error);
  }
  // From there on, by the angles that a run has counted up to there: the first of the ground and the first
  // link, at rest half a turn.
  const double there = 7.1;
  VectorXd angles = followed_of(structure);
  REQUIRE(angles.size() == 2);
  for (Index k = 0; k < 2; ++k) angles[k] += (k == 0 ? 1 : 2) * there;
  const FreePoses late(structure, pose(there), angles);
  CHECK(late.error(pose(there)) < 1e-12);
  const MatrixXd motions = late.motions(pose(there));
  REQUIRE(motions.cols() == 1);
  const VectorXd on = late.moved(pose(there), motions.col(0), 0.1);
  const double u = there + std::remainder(std::atan2(on[7], on[6]) - there, 2 * pi);
  CHECK((on - pose(u)).norm() < tip_error);
  CHECK(std::abs(u - there) > 0.01);
}

TEST_CASE("an array of panels with geared hinges has one free motion, with or without its drive") {
  // Six panels in a plane: each has a degree of freedom, every hinge but the root is geared to it.
  std::string text =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'W', position = [0, -1, 0], fixed = true},\n"
      "{name = 'H0', position = [0, 0, 0], fixed = true},\n"
      "{repeat = {i = '1:7'}, name = 'H{i}', position = ['=i*cos(1)', '=sin(1)*(i%2)', 0]}]\n"
      "rods = [{repeat = {i = '0:6'}, nodes = ['H{i}', 'H{i+1}'], mass = 1}]\n"
      "[[constraints]]\nkind = 'plane'\nnodes = ['H*']\nnormal = [0, 0, 1]\n"
      "[[constraints]]\nrepeat = {i = '1:6'}\nkind = 'combination'\n"
      "terms = ['2 angle W H0 H1 about 0 0 1', '{2*(i%2)-1} angle H{i-1} H{i} H{i+1} about 0 0 1']\n";
  const auto motions = [](const Structure& structure) {
    return FreePoses(structure).motions(node_positions(structure)).cols();
  };
  CHECK(motions(structure_of(text)) == 1);
  text += "[[constraints]]\nkind = 'angle'\nnodes = ['W', 'H0', 'H1']\naxis = [0, 0, 1]\n";
  CHECK(motions(structure_of(text)) == 0);  // held
  CHECK(motions(structure_of(text + "motion = 'rate'\nrate = 10\n")) == 1);
}

// The rotor's turn is a number of its own, which the row to its joint has go along: rad beside m.
TEST_CASE("the rotor of a motor follows what is led by hand") {
  const std::string tower =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'W', position = [0, -1, 0], fixed = true},\n"
      "{name = 'O', position = [0, 0, 0], fixed = true}, {name = 'A', position = [0.05, 0, 0]},\n"
      "{name = 'B', position = [0.05, 0.05, 0]}]\nrods = [{nodes = ['O', 'A'], mass = 1}, {nodes = ['A', "
      "'B'], "
      "mass = 1}]\n[[constraints]]\nkind = 'plane'\nnodes = ['A', 'B']\nnormal = [0, 0, 1]\n";
  const std::string motor =
      "[[forces]]\nkind = 'motor'\nnodes = ['W', 'O', 'A']\naxis = [0, 0, 1]\nstall_torque = 1\n"
      "no_load_speed = 90\ngear_ratio = 30\n";
  const Structure with = structure_of(tower + motor + "inertia = 1e-4\n"),
                  without = structure_of(tower + motor);
  REQUIRE(with.nodes.size() == without.nodes.size() + 1);
  const VectorXd rest = node_positions(without), q = node_positions(with);
  FreePoses light(without, rest, followed_of(without)), heavy(with, q, followed_of(with));
  const MatrixXd motions = heavy.motions(q), expected = light.motions(rest);
  REQUIRE(motions.cols() == 2);
  const Index in_space = rest.size();
  const MatrixXd seen = motions.topRows(in_space);
  CHECK((expected - seen * (seen.transpose() * expected)).norm() < 1e-9);  // both are orthonormal
  for (Index k = 0; k < 2; ++k) {
    // Back onto rods of 0.05 m takes what is of second order: a thousandth of the way, about.
    const double way = 5e-5;
    const VectorXd pose = heavy.moved(q, motions.col(k), way);
    CHECK(light.error(pose.head(in_space)) < 1e-10);
    double most = 0;
    for (Index i = 0; i < in_space; i += 3) most = std::max(most, (pose - q).segment<3>(i).norm());
    CHECK(most == Approx(way).epsilon(2e-3));
  }
  const Vec3 target(0.03, 0.03, 0);
  CHECK((heavy.pulled(q, 2, target) - q).head(in_space).isApprox(light.pulled(rest, 2, target) - rest, 1e-6));
}

// The drive counts the same two angles as the gear, in the other order.
TEST_CASE("a driven combination that lets go takes its angles out of those that are counted") {
  const Structure structure =
      structure_of(std::string(geared) +
                   "[[constraints]]\nkind = 'combination'\nmotion = 'rate'\nrate = 10\n"
                   "terms = ['angle O A B about 0 0 1', 'angle W O A about 0 0 1']\n");
  // The drive stands first, so that its angles come before those of the gear.
  Structure first = structure;
  std::rotate(first.constraints.begin(), first.constraints.end() - 1, first.constraints.end());
  const double u = 4.0;
  VectorXd q = node_positions(structure);
  q.segment<3>(6) = Vec3(std::cos(u), std::sin(u), 0);
  q.segment<3>(9) = q.segment<3>(6) + Vec3(std::cos(3 * u), std::sin(3 * u), 0);
  for (const Structure& each : {structure, first}) {
    VectorXd angles = followed_of(each);
    REQUIRE(angles.size() == 4);
    const bool drive_first = each.constraints.front().target.moves();
    const double turned[2][4] = {{u, 2 * u, 2 * u, u}, {2 * u, u, u, 2 * u}};
    for (Index k = 0; k < 4; ++k) angles[k] += turned[drive_first ? 1 : 0][k];
    const FreePoses poses(each, q, angles);
    CHECK(poses.error(q) < 1e-12);
    CHECK(poses.motions(q).cols() == 1);
  }
}

// Without any constraint a node goes where it is led, and there is nothing to violate.
TEST_CASE("what nothing holds goes where it is led by hand") {
  const Structure structure = structure_of(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0.3, -0.2, 0.7], mass = 1},\n"
      "{name = 'Q', position = [1.1, 0.4, 0.2], mass = 2}]\n");
  FreePoses poses(structure);
  const Vec3 target(0.8, 0.9, -0.1);
  VectorXd q = node_positions(structure);
  for (int i = 0; i < 30; ++i) q = poses.pulled(q, 1, target);
  CHECK((q.tail<3>() - target).norm() < 1e-6);
  CHECK((q.head<3>() - Vec3(0.3, -0.2, 0.7)).norm() < 1e-12);
  CHECK(poses.error(q) == 0);
}

}  // namespace free_poses_test
