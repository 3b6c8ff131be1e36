// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/mobility.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/structure/node_positions.hpp"

using namespace unfurl;

namespace mobility_test {

namespace {

Mobility mobility_of(const std::string& scene, const std::vector<std::string>& overrides = {}) {
  const auto model = build_model(read_scene_file(find_scene(scene), overrides));
  VectorXd q(model->system.coordinates());
  for (std::size_t i = 0; i < model->structure.nodes.size(); ++i)
    q.segment<3>(static_cast<Index>(3 * i)) = model->structure.nodes[i].position;
  return analyse_mobility(model->system, q);
}

}  // namespace

TEST_CASE("the ring of n units has 13 n constraints of rank 12 n - 1 and one degree of freedom") {
  for (const int n : {3, 4, 6, 7, 12, 50}) {
    INFO(n);
    const Mobility m = mobility_of("hoop6", {"structure.units=" + std::to_string(n)});
    CHECK(m.coordinates == 12 * n);
    CHECK(m.constraints == 13 * n);
    CHECK(m.rank == 12 * n - 1);
    CHECK(m.redundant.size() == static_cast<std::size_t>(n + 1));
    CHECK(m.degrees_of_freedom == 1);
    CHECK(std::set<std::string>(m.redundant.begin(), m.redundant.end()).size() == m.redundant.size());
  }
}

TEST_CASE("the sparse analysis of large rings agrees with the count") {
  const Mobility m = mobility_of("hoop6", {"structure.units=200"});
  CHECK(m.coordinates == 2400);
  CHECK(m.rank == 12 * 200 - 1);
  CHECK(m.degrees_of_freedom == 1);
}

TEST_CASE("the rank falls to 10 n where the ring is fully deployed") {
  // A scene starts folded; the deployed pose is the one at 45 degrees with its radii stretched and its hinges
  // level with the posts' ends, 0.6 m above and below the middle.
  const auto model = build_model(read_scene_file(find_scene("hoop6"), {"structure.fold_angle=45"}));
  VectorXd q(model->system.coordinates());
  for (std::size_t i = 0; i < model->structure.nodes.size(); ++i) {
    const Vec3& x = model->structure.nodes[i].position;
    const bool top = model->structure.nodes[i].name.find_first_of("Tt") != std::string::npos;
    q.segment<3>(static_cast<Index>(3 * i)) =
        Vec3(x[0] * std::sqrt(2.0), x[1] * std::sqrt(2.0), top ? 0.6 : -0.6);
  }
  CHECK(analyse_mobility(model->system, q).rank == 60);
}

TEST_CASE("one sector has no redundant constraint and the same single freedom") {
  const Mobility m = mobility_of("hoop6_sector");
  CHECK(m.redundant.empty());
  CHECK(m.degrees_of_freedom == 1);
}

TEST_CASE("mechanisms that textbooks count") {
  CHECK(mobility_of("four_bar").degrees_of_freedom == 1);
  CHECK(mobility_of("double_pendulum").degrees_of_freedom == 4);
}

TEST_CASE("a constraint that is listed twice is redundant, the second time") {
  const Scene scene = read_scene_text(
      "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'A'\nposition = [1, 2, 3]\nmass = 1\n"
      "[[structure.constraints]]\nkind = 'plane'\nnodes = 'A'\nnormal = [0, 0, 1]\n"
      "[[structure.constraints]]\nkind = 'line'\nnodes = 'A'\ndirection = [1, 0, 0]\n",
      "x");
  const auto model = build_model(scene);
  const Mobility m = analyse_mobility(model->system, Vec3(1, 2, 3));
  CHECK(m.constraints == 3);
  CHECK(m.rank == 2);  // on a line
  REQUIRE(m.redundant.size() == 1);
  CHECK(m.redundant[0].find("line of A") == 0);
  CHECK(m.smallest_singular_value > 0.1);
}

}  // namespace mobility_test
