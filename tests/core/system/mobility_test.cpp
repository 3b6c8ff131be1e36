// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/mobility.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "core/math/singular_values.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/structure/node_positions.hpp"
#include "core/structures/custom.hpp"
#include "tests/support/scene_run.hpp"

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

TEST_CASE("a rotor, a drum and a controller are no bodies: where a scene lies, it moves as rigidly") {
  for (const double x : {0.0, 5.0, -300.0})
    for (const char* force :
         {"",
          "kind = 'motor'\nnodes = ['A', 'B', 'C']\nstall_torque = 0.1\nno_load_speed = 3000\ninertia = "
          "1e-4\n",
          "kind = 'motor'\nnodes = ['A', 'B', 'C']\nstall_torque = 0.1\nno_load_speed = 3000\ninertia = "
          "1e-4\n"
          "control = 'position'\nproportional = 1\nintegral = 1\n",
          "kind = 'winch'\nnodes = ['A', 'C']\ndrum_radius = 0.1\nstall_torque = 1\nno_load_speed = 9\n"
          "inertia = 1e-4\n"})
      for (const char* fixed : {"", ", fixed = true"}) {
        INFO(x << fixed << "\n" << force);
        const auto model = testing::model_of(
            std::string("[variables]\nx = ") + std::to_string(x) +
            "\n[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = ['=x', 0, 0]" + fixed +
            "}, {name = 'B', position = ['=x+1', 0, 0]}, {name = 'C', position = ['=x+1', 1, 0]}]\n"
            "rods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['B', 'C'], mass = 1}]\n" +
            (*force ? "[[forces]]\n" : "") + force);
        const Mobility m = analyse_mobility(model->system, node_positions(model->structure));
        CHECK(m.rigid_motions == (*fixed ? 3 : 6));
        // Two directions for each rod and, free, a place; the drum turns by itself while its cable is slack.
        const bool drum = std::string(force).find("winch") != std::string::npos;
        CHECK(m.degrees_of_freedom == (*fixed ? 4 : 7) + (drum ? 1 : 0));
        CHECK(m.count == m.degrees_of_freedom);  // nothing is redundant
      }
}

TEST_CASE("the sparse analysis of large rings agrees with the count") {
  const Mobility m = mobility_of("hoop6", {"structure.units=200"});
  CHECK(m.coordinates == 2400);
  CHECK(m.rank == 12 * 200 - 1);
  CHECK(m.degrees_of_freedom == 1);
}

// A millionth of a degree before its deployed pose a large ring counts as anywhere; of chains that hang no
// row depends on others, however long they are.
TEST_CASE("the sparse analysis counts next to the flat pose, and chains of thousands of links") {
  const Mobility ring = mobility_of("hoop6", {"structure.units=80", "structure.fold_angle=1e-6"});
  CHECK(ring.rank == 12 * 80 - 1);
  CHECK(ring.redundant.size() == 81);
  const Mobility chain = mobility_of("chain", {"structure.links=3000", "structure.span=15"});
  CHECK(chain.redundant.empty());
  CHECK(chain.degrees_of_freedom == chain.coordinates - chain.constraints);
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
  const Vec3 q(1, 2, 3);
  const Mobility m = analyse_mobility(model->system, q);
  CHECK(m.constraints == 3);
  CHECK(m.rank == 2);  // on a line
  REQUIRE(m.redundant.size() == 1);
  CHECK(m.redundant[0].find("line of A") == 0);
  CHECK(smallest_singular_value(model->system, q, 2) > 0.1);
}

// Three coordinates a node; two equations keep a node on a line through two others, whichever way it points.
TEST_CASE("a node on a line is counted as two constraints, and shares no force with itself") {
  const auto on_line = [](const Vec3& along) {
    std::string text = "[structure]\nkind = 'custom'\n";
    for (int i = 0; i < 3; ++i) {
      const Vec3 x = Vec3(0.3, -0.2, 0.7) + (1.3 + 0.4 * i) * along;
      text += "[[structure.nodes]]\nname = 'N" + std::to_string(i) + "'\nmass = 1\nposition = [" +
              std::to_string(x[0]) + ", " + std::to_string(x[1]) + ", " + std::to_string(x[2]) + "]\n";
    }
    text += "[[structure.constraints]]\nkind = 'collinear'\nnodes = ['N0', 'N1', 'N2']\n";
    return build_model(read_scene_text(text, "x"));
  };
  for (const Vec3& along : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(1, 2, 0), Vec3(-1, 0.5, 2)}) {
    INFO(along.transpose());
    const auto model = on_line(along);
    const VectorXd q = node_positions(model->structure);
    const Mobility m = analyse_mobility(model->system, q);
    CHECK(m.constraints == 2);
    CHECK(m.rank == 2);
    CHECK(m.redundant.empty());
    CHECK(m.degrees_of_freedom == 7);
    CHECK(m.count == 7);
    CHECK(smallest_singular_value(model->system, q, 2) > 0.1);
  }
}

TEST_CASE("an umbrella of any number of ribs has one freedom and nothing redundant, as its nodes count") {
  // n ribs from the crown to T_i, on each a slider P_i at 0.3 m, stretchers to the runner on the axis. Of
  // 3 (2 + 2 n) coordinates 3 are the crown's, 2 the runner's line, and a rib takes three lengths, a plane
  // and the two of P_i on its line: 6 + 6 n - 5 - 6 n = 1.
  for (const int n : {3, 8, 160}) {
    INFO(n);
    const std::string ribs = std::to_string(n);
    const Mobility m = [&] {
      const auto model = build_model(read_scene_text(
          "[variables]\nn = " + ribs +
              "\nth = '=15*deg'\n[structure]\nkind = 'custom'\nnodes = [\n"
              "{name = 'crown', position = [0, 0, 1], fixed = true},\n"
              "{name = 'runner', position = [0, 0, '=1-0.3*cos(th)-sqrt(0.1225-(0.3*sin(th))^2)'], mass = "
              "0.2},\n"
              "{repeat = {i = '0:n'}, name = 'P{i}', position = ['=0.3*sin(th)*cos(2*pi*i/n)', "
              "'=0.3*sin(th)*sin(2*pi*i/n)', '=1-0.3*cos(th)']},\n"
              "{repeat = {i = '0:n'}, name = 'T{i}', position = ['=0.8*sin(th)*cos(2*pi*i/n)', "
              "'=0.8*sin(th)*sin(2*pi*i/n)', '=1-0.8*cos(th)']}]\n"
              "rods = [{repeat = {i = '0:n'}, nodes = ['crown', 'T{i}'], mass = 0.1},\n"
              "{repeat = {i = '0:n'}, nodes = ['crown', 'P{i}'], mass = 0},\n"
              "{repeat = {i = '0:n'}, nodes = ['runner', 'P{i}'], mass = 0.05}]\n"
              "[[constraints]]\nrepeat = {i = '0:n'}\nkind = 'collinear'\nnodes = ['crown', 'T{i}', 'P{i}']\n"
              "[[constraints]]\nrepeat = {i = '0:n'}\nkind = 'plane'\nnodes = ['T{i}']\n"
              "normal = ['=-sin(2*pi*i/n)', '=cos(2*pi*i/n)', 0]\n"
              "[[constraints]]\nkind = 'line'\nnodes = ['runner']\ndirection = [0, 0, 1]\n",
          "x"));
      return analyse_mobility(model->system, node_positions(model->structure));
    }();
    CHECK(m.constraints == 5 + 6 * n);
    CHECK(m.degrees_of_freedom == 1);
    CHECK(m.count == 1);
    CHECK(m.redundant.empty());
  }
}

// Nets of k x k uneven meshes with a triangle on either side of every diagonal are rigid in their plane: 2 n
// - 3 of the rods are independent, and three motions are left. With the diagonals first, the rows before a
// row nearly depend on each other.
TEST_CASE("the analysis of redundant nets finds the three motions that they have") {
  constexpr int k = 18;
  for (const auto& [seed, uneven] : {std::pair(7u, 0.05), std::pair(8u, 0.25), std::pair(8u, 0.05)}) {
    INFO(seed << " " << uneven);
    unsigned state = seed;
    const auto dice = [&state] {
      state = state * 1664525u + 1013904223u;
      return static_cast<double>(state >> 8) / (1 << 24) - 0.5;
    };
    CustomSpec spec;
    std::array<std::vector<CustomRod>, 4> rods;
    const auto name = [](int i, int j) { return std::to_string(i) + "_" + std::to_string(j); };
    for (int i = 0; i < k; ++i)
      for (int j = 0; j < k; ++j) {
        const double x = 0.5 * i + uneven * dice(), y = 0.5 * j + uneven * dice();
        spec.nodes.push_back({name(i, j), {x, y, 0}, Vec3::Zero(), 0.1, false});
        if (i > 0) rods[3].push_back({"", {name(i - 1, j), name(i, j)}, 0.1});
        if (j > 0) rods[2].push_back({"", {name(i, j - 1), name(i, j)}, 0.1});
        if (i > 0 && j > 0) rods[1].push_back({"", {name(i - 1, j - 1), name(i, j)}, 0.1});
        if (i > 0 && j > 0 && dice() > 0.3) rods[0].push_back({"", {name(i - 1, j), name(i, j - 1)}, 0.1});
      }
    for (const auto& group : rods) spec.rods.insert(spec.rods.end(), group.begin(), group.end());
    Structure net = build_custom(spec);
    for (int i = 0; i < k * k; ++i)
      net.constraints.push_back({"plane", "plane", {i}, {Vec3::UnitZ()}, 0.0, {}, {}});
    const Mobility m = analyse_mobility(System(net, true), node_positions(net));
    CHECK(m.coordinates == 3 * k * k);
    CHECK(m.rigid_motions == 3);
    CHECK(m.degrees_of_freedom == 3);
    CHECK(m.redundant.size() == spec.rods.size() - (2 * k * k - 3));
  }
}

// 18 frameworks that nothing joins, of 3 x 3 x 2 nodes each, have as many motions and as many redundant rods
// as each of them alone, whose 54 coordinates are counted by singular values. Nodes a little off a regular
// lattice leave rows of which the rows before them nearly, but not quite, are sums.
TEST_CASE("frameworks beside each other have the motions and the redundant rods of each alone") {
  for (const double off : {1e-9, 1e-7, 1e-4, 1e-3, 0.02}) {
    unsigned state = 5u;
    const auto dice = [&state] {
      state = state * 1664525u + 1013904223u;
      return static_cast<double>(state >> 8) / (1 << 24);
    };
    CustomSpec all;
    Index freedoms = 0;
    Index redundant = 0;
    for (int copy = 0; copy < 18; ++copy) {
      CustomSpec one;
      const auto name = [copy](int node) { return std::to_string(copy) + "_" + std::to_string(node); };
      for (int n = 0; n < 18; ++n)
        one.nodes.push_back({name(n),
                             Vec3(n % 3, n / 3 % 3, n / 9) +
                                 off * Vec3(dice() - 0.5, dice() - 0.5, dice() - 0.5) +
                                 Vec3(10.0 * copy, 0, 0),
                             Vec3::Zero(), 0.1, n == copy});
      for (int a = 0; a < 18; ++a)
        for (int b = 0; b < a; ++b) {
          const Vec3 way = one.nodes[static_cast<std::size_t>(a)].position -
                           one.nodes[static_cast<std::size_t>(b)].position;
          if (way.lpNorm<Eigen::Infinity>() < 1.5 && dice() < 0.7)
            one.rods.push_back({"", {name(b), name(a)}, 0.1});
        }
      const Structure alone = build_custom(one);
      const MatrixXd G = unit_rows(System(alone, true), node_positions(alone));
      const Index rank = (singular_values(G).array() > 1e-11).count();
      freedoms += G.cols() - rank;
      redundant += G.rows() - rank;
      all.nodes.insert(all.nodes.end(), one.nodes.begin(), one.nodes.end());
      all.rods.insert(all.rods.end(), one.rods.begin(), one.rods.end());
    }
    INFO(off);
    const Structure together = build_custom(all);
    const Mobility m = analyse_mobility(System(together, true), node_positions(together));
    CHECK(m.coordinates == 18 * 54);
    CHECK(m.degrees_of_freedom == freedoms);
    CHECK(std::ssize(m.redundant) == redundant);
  }
}

// Two planes that enclose the angle 2 s have the singular values sqrt(1 - cos 2 s) = sqrt(2) sin s and
// sqrt(1 + cos 2 s): however near to each other, they are two equations.
TEST_CASE("planes that are nearly one are two equations") {
  for (const double s : {0.02, 3e-6, 7e-9}) {
    INFO(s);
    CustomSpec spec;
    spec.nodes = {{"P", {0.3, -0.7, 1.9}, Vec3::Zero(), 0.4, false}};
    Structure structure = build_custom(spec);
    for (const Vec3& normal : {Vec3(std::cos(s), std::sin(s), 0), Vec3(std::cos(s), -std::sin(s), 0)})
      structure.constraints.push_back({"plane", "plane", {0}, {normal}, 0.0, {}, {}});
    const System system(structure, true);
    const VectorXd q = node_positions(structure);
    const Mobility m = analyse_mobility(system, q);
    CHECK(m.rank == 2);
    CHECK(m.redundant.empty());
    CHECK(m.degrees_of_freedom == 1);
    CHECK(smallest_singular_value(system, q, 2) ==
          Approx(std::sqrt(2.0) * std::sin(s)).epsilon(1e-6));  // rounding of normals
  }
}

}  // namespace mobility_test
