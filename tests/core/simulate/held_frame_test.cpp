// SPDX-License-Identifier: BSD-3-Clause
// Which supports keep a structure from turning in space as a whole.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/scene/library.hpp"
#include "core/simulate/turned_frame.hpp"
#include "core/structure/node_positions.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace held_frame_test {

namespace {

using Lines = std::vector<std::string>;

std::string fixed(const char* node) {
  return std::string("{kind=\"fixed\", nodes=[\"") + node + "\"]}";
}
std::string vector_of(const Vec3& v) {
  return "[" + std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " + std::to_string(v[2]) + "]";
}
std::string plane(const std::string& nodes, const Vec3& normal) {
  return "{kind=\"plane\", nodes=[" + nodes + "], normal=" + vector_of(normal) + "}";
}
std::string line(const char* node, const Vec3& direction) {
  return std::string("{kind=\"line\", nodes=[\"") + node + "\"], direction=" + vector_of(direction) + "}";
}

// Whether anything is said of the ring, turned by ten degrees about a slanted axis, with these supports.
bool may_turn(const Lines& supports) {
  const auto model_with = [](const Lines& more) {
    Lines changes{"structure.model=joints"};
    for (std::size_t i = 0; i < more.size(); ++i)
      changes.push_back("constraints[" + std::to_string(i) + "]=" + more[i]);
    return build_model(read_scene_file(find_scene("hoop6"), changes));
  };
  const auto free = model_with({});
  VectorXd q = node_positions(free->structure);
  const Eigen::AngleAxisd turn(0.17, Vec3(0.6, 0.0, 0.8));
  for (Index k = 0; k < q.size(); k += 3) q.segment<3>(k) = turn * Vec3(q.segment<3>(k));
  State state;
  state.z = free->system.reduce(q);
  return !TurnedFrame(model_with(supports)->structure).at(free->system, state).empty();
}

Vec3 at(const std::string& name) {
  const Structure structure =
      build_structure(read_scene_file(find_scene("hoop6"), {"structure.model=joints"}));
  for (const Node& node : structure.nodes)
    if (node.name == name) return node.position;
  throw std::out_of_range(name);
}

}  // namespace

// Posts at the corners of a hexagon, B0 to B5 at their feet.
TEST_CASE(
    "supports that leave a rotation about any axis let a structure turn, those that leave none do not") {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  CHECK(may_turn({}));
  CHECK(may_turn({fixed("B0")}));
  CHECK(may_turn({fixed("B0"), fixed("B2")}));  // about the line through both
  CHECK_FALSE(may_turn({fixed("B0"), fixed("B2"), fixed("B3")}));
  // A point on a line is held in two directions, in a plane in one.
  const Vec3 chord = (at("B2") - at("B0")).normalized();
  CHECK(may_turn({fixed("B0"), line("B2", chord)}));
  CHECK_FALSE(may_turn({fixed("B0"), line("B2", chord), plane("\"B4\"", z)}));
  CHECK(may_turn({fixed("B0"), line("B2", chord), plane("\"B4\"", chord.cross(z))}));
  CHECK(may_turn({fixed("B0"), plane("\"B2\"", z), plane("\"B4\"", z)}));
  CHECK_FALSE(
      may_turn({fixed("B0"), plane("\"B2\"", z), plane("\"B4\"", z), plane("\"B2\"", chord.cross(z))}));
  // On a table it turns about the normal; pinned across at two opposite corners it only slides.
  const Lines table{plane("\"B0\"", z), plane("\"B2\"", z), plane("\"B4\"", z)};
  CHECK(may_turn(table));
  Lines one = table, two = table;
  const Vec3 way = (at("B3") - at("B0")).cross(z).normalized();
  one.push_back(plane("\"B0\"", way));
  CHECK(may_turn(one));
  two.push_back(plane("\"B0\"", way)), two.push_back(plane("\"B3\"", way));
  CHECK_FALSE(may_turn(two));
  // Normals need not be of length 1; lines along the axis hold what tables do not.
  CHECK_FALSE(may_turn({line("B0", z), line("B2", 3 * z), line("B4", z), plane("\"B0\"", 7 * z),
                        plane("\"B2\"", 0.2 * z), plane("\"B4\"", z)}));
  // Six directions, of which that along x of B4 follows: about y, and as far about x as B4 stays, it tilts.
  const Lines six{line("B0", z), line("B3", x), line("B4", y)};
  REQUIRE(std::abs(at("B0")[1]) < 1e-9);
  CHECK(may_turn(six));
  Lines seven = six;
  seven.push_back(plane("\"B0\"", z));
  CHECK_FALSE(may_turn(seven));
}

}  // namespace held_frame_test
