// SPDX-License-Identifier: BSD-3-Clause
// A row of constraints is told by its name and measured in metres: both are what people read.
#include <catch2/catch.hpp>
#include <map>

#include "core/structure/node_positions.hpp"
#include "core/system/system.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace row_names_test {

namespace {

// Values of all rows by name at node positions that are off by `change` at one coordinate.
std::map<std::string, double> rows_off(const std::string& scene, Index coordinate, double change) {
  const auto model = testing::model_of(scene);
  const Structure& structure = model->structure;
  VectorXd q = node_positions(structure);
  q[coordinate] += change;
  VectorXd phi(model->system.all_constraints());
  model->system.all_constraint_values(0, q, phi);
  const auto names = model->system.all_names();
  std::map<std::string, double> rows;
  for (std::size_t i = 0; i < names.size(); ++i) rows[names[i]] = phi[static_cast<Index>(i)];
  return rows;
}

const std::string three_points = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0.2, 0, 0], mass = 1},
  {name = "B", position = [1.9, 0, 0], mass = 1},
  {name = "C", position = [1.2, 0, 0], mass = 1},
  {name = "D", position = [0.2, 2.7, 0], mass = 1}]
rods = [{nodes = ["A", "D"], mass = 1}]
)";

}  // namespace

TEST_CASE("rows of collinear nodes are named by the axis of their moment") {
  const std::string scene = three_points + R"(
[[constraints]]
kind = "collinear"
name = "rail"
nodes = ["A", "B", "C"]
)";
  // (B - A) x (C - A) along x: C moved in y shows in z and in no other, C moved in z in -y.
  auto rows = rows_off(scene, 3 * 2 + 1, 0.01);
  REQUIRE(rows.count("rail x") + rows.count("rail y") + rows.count("rail z") == 3);
  CHECK(rows["rail z"] > 1e-4);
  CHECK(rows["rail x"] == 0);
  CHECK(rows["rail y"] == 0);
  rows = rows_off(scene, 3 * 2 + 2, 0.01);
  CHECK(rows["rail y"] < -1e-4);
  CHECK(rows["rail x"] == 0);
  CHECK(rows["rail z"] == 0);
}

TEST_CASE("the error of a held angle is an arc, of a held length the length, in metres") {
  const std::string scene = three_points + R"(
[[constraints]]
kind = "angle"
name = "corner"
nodes = ["B", "A", "D"]
[[constraints]]
kind = "length"
name = "side"
nodes = ["B", "D"]
)";
  // Of the edges A-B, of 1.7 m, is the shorter one: the arc is 1.7 m times the angle by which B has gone
  // round A, 0.001 / 1.7 rad; B goes towards D.
  const auto rows = rows_off(scene, 3 * 1 + 1, 0.001);
  CHECK(std::abs(rows.at("corner")) == Approx(1.7 * 0.001 / 1.7).epsilon(1e-5));
  CHECK(rows.at("side") == Approx(std::hypot(1.7, 2.699) - std::hypot(1.7, 2.7)).epsilon(1e-9));
}

}  // namespace row_names_test
