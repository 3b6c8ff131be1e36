// SPDX-License-Identifier: BSD-3-Clause
// What cannot be assembled as given is refused wherever the origin lies.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace consistency_test {

TEST_CASE("nodes that are off their line are refused by the same measure, however far the origin is") {
  const auto refused = [](double at, double off, const std::string& motor) {
    const std::string x = testing::number(at), y = testing::number(at + off),
                      text = "[structure]\nkind = 'custom'\nnodes = [\n{name='A',position=[" + x + "," + x +
                             "," + x + "],fixed=true},\n{name='B',position=[" + testing::number(at + 0.6) +
                             "," + y + "," + x + "],mass=1},\n{name='C',position=[" +
                             testing::number(at + 1.3) + "," + x + "," + x +
                             "],mass=1}]\nrods=[{nodes=['A','B'],mass=1},{nodes=['B','C'],mass=1}]\n" +
                             "[[structure.constraints]]\nkind='collinear'\nnodes=['A','B','C']\n" + motor;
    return testing::error_of(text).find("cannot be assembled as given") != std::string::npos;
  };
  // Its rotor and drum are numbers, which lie nowhere.
  const std::string winch =
      "[[forces]]\nkind='winch'\nnodes=['A','C']\nstall_torque=1\nno_load_speed=300\ndrum_radius=0.1\n"
      "inertia=0.01\n";
  for (const double at : {0.0, 900.0, -900.0}) {
    INFO(at);
    for (const std::string& motor : {std::string(), winch}) {
      INFO(motor);
      CHECK_FALSE(refused(at, 0, motor));
      CHECK_FALSE(refused(at, 2e-8, motor));
      CHECK(refused(at, 2e-5, motor));
    }
  }
}

// Seven nodes on a plane through the first of all, each by a constraint of its own.
std::string table(const std::vector<double>& off) {
  std::string text =
      "[structure]\nkind = 'custom'\nnodes = "
      "[{name='O',position=[0.4,0.2,1.5],fixed=true},{name='R',position=[0.9,0.2,1.5],fixed=true}";
  for (std::size_t i = 0; i < off.size(); ++i)
    text += ",\n{name='N" + std::to_string(i) + "',position=[" + std::to_string(i + 1) + ",0.2," +
            testing::number(1.5 + off[i]) + "],mass=1}";
  text += "]\n";
  for (std::size_t i = 0; i < off.size(); ++i)
    text += "[[structure.constraints]]\nkind='collinear'\nname='p" + std::to_string(i) +
            "'\nnodes=['O','R','N" + std::to_string(i) + "']\n";
  return text;
}

TEST_CASE("what is violated at the start is listed with the worst, up to six by name") {
  const std::string head = "s.toml:1:1: structure: the structure cannot be assembled as given: ";
  CHECK(testing::error_of(table({0, 0, 0})) == "");
  // A row is the offset times the half metre of the line, over the longest edge of its own: 1.6 m to N1, 3.6
  // m to N3, and what the offset makes of that.
  CHECK(testing::error_of(table({0, 3e-3, 0})) == head + "p1 y is violated at t = 0, by up to 0.000937498 m");
  CHECK(testing::error_of(table({0, 3e-3, 0, -0.02})) ==
        head + "p1 y, p3 y are violated at t = 0, by up to 0.00277773 m");
  CHECK(testing::error_of(table({1e-3, 3e-3, 2e-3, -0.02, 1e-3, 1e-3})) ==
        head + "p0 y, p1 y, p2 y, p3 y, p4 y, p5 y are violated at t = 0, by up to 0.00277773 m");
  CHECK(testing::error_of(table({1e-3, 3e-3, 2e-3, -0.02, 1e-3, 1e-3, 4e-3, 1e-3})) ==
        head + "p0 y, p1 y, p2 y, p3 y, p4 y, p5 y and 2 more are violated at t = 0, by up to 0.00277773 m");
  // A ten-millionth of the longest side, here 7 - 0.4 = 6.6 m, of the offset times 0.5 m over N2's edge
  // of 2.6 m.
  CHECK(testing::error_of(table({0, 0, 34.2e-7, 0, 0, 0, 0})) == "");
  CHECK(testing::error_of(table({0, 0, -34.2e-7, 0, 0, 0, 0})) == "");
  CHECK(testing::error_of(table({0, 0, 34.4e-7, 0, 0, 0, 0})) != "");
  CHECK(testing::error_of(table({0, 0, -34.4e-7, 0, 0, 0, 0})) != "");
}

// O, R and N along the diagonal of their box: the line is longer than its sides, by sqrt(3). N is off it by d
// along (1, -1, 0) / sqrt(2), of which the row of z has 2 / sqrt(6), times |OR| / |ON|.
TEST_CASE("a line across the box of its nodes is held to a ten-millionth of its own length") {
  const double near = 0.9, far = 3.1, limit = 1e-7 * far * far / near * std::sqrt(6.0) / 2;
  for (const double share : {-1.03, -0.97, 0.97, 1.03}) {
    INFO(share);
    const auto at = [](double along, double off) {
      const double x = 0.2 + along / std::sqrt(3.0), d = off / std::sqrt(2.0);
      return "position = [" + testing::number(x + d) + ", " + testing::number(x - d) + ", " +
             testing::number(x) + "]";
    };
    const std::string error = testing::error_of(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', fixed = true, " + at(0, 0) +
        "}, {name = 'R', fixed = true, " + at(near, 0) + "}, {name = 'N', mass = 1, " +
        at(far, share * limit) + "}]\n[[constraints]]\nkind = 'collinear'\nnodes = ['O', 'R', 'N']\n");
    CHECK((error.find("cannot be assembled as given") != std::string::npos) == (std::abs(share) > 1));
  }
}

// Three equations keep a node on a line, of which two count, in the list as in what the check says of it.
TEST_CASE("rows that others of their constraint imply do not count among what holds a structure") {
  const std::string error = testing::error_of(R"([structure]
kind = 'custom'
nodes = [{name = 'A', position = [0.1, 0.2, 0.3], fixed = true}, {name = 'B', position = [1.3, 1, 0.7], fixed = true},
         {name = 'P', position = [0.7, 0.6, 0.5], mass = 1}]
rods = [{nodes = ['A', 'P'], mass = 0.1}]
[[constraints]]
kind = 'collinear'
nodes = ['A', 'B', 'P']
)");
  CHECK_THAT(error, Catch::Contains("nothing can move: 9 constraints hold all 9 coordinates"));
}

// Soon and late, once and back again; a table that says the same at all times moves nothing.
TEST_CASE("a structure that only warming rods move runs however fast or late they warm") {
  const std::string rod = R"([structure]
kind = 'custom'
nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [1, 0, 0]}]
rods = [{name = 'r', nodes = ['A', 'B'], mass = 1}]
constraints = [{kind = 'line', nodes = ['B'], direction = [1, 0, 0]}]
[[forces]]
kind = 'temperature'
rods = ['r']
expansion = 0.001
change = 10
)";
  const auto warmed = [&](const std::string& times, const std::string& values) {
    return rod + "times = [" + times + "]\nvalues = [" + values + "]\n";
  };
  for (const char* times : {"0, 1e-6, 2e-6", "0, 0.05, 0.1", "50, 55, 60", "1e6, 2e6, 3e6"})
    for (const char* values : {"0, 0.5, 1", "0, 1, 0"}) CHECK(testing::error_of(warmed(times, values)) == "");
  CHECK_THAT(testing::error_of(warmed("0, 1, 2", "0, 0, 0")), Catch::Contains("nothing can move"));
  const Simulation run =
      testing::run_scene(warmed("0, 0.05, 0.1", "0, 0.5, 1"), {"solver.step=0.001", "solver.end_time=0.12"});
  REQUIRE(run.status == RunStatus::completed);
  // 1 m (1 + 0.001 / K * 10 K), to round-off.
  CHECK(testing::end_positions(run)[3] == Approx(1.01).epsilon(1e-14));
}

// A tower of as many storeys, two nodes each, all of them braced: 906 coordinates from 150 on.
TEST_CASE("what cannot move is refused however large it is and moves with a brace less") {
  const auto tower = [](int storeys, bool braced) {
    const std::string many = std::to_string(storeys + 1), last = braced ? many : std::to_string(storeys);
    return "[structure]\nkind = 'custom'\nnodes = [{name = 'A0', position = [0, 0, 0], fixed = true}, "
           "{name = 'B0', position = [1, 0, 0], fixed = true}, {repeat = {i = '1:" +
           many + "'}, name = 'A{i}', position = [0, 0, '=i']}, {repeat = {i = '1:" + many +
           "'}, name = 'B{i}', position = [1, 0, '=i']}]\nrods = [{repeat = {i = '1:" + many +
           "'}, nodes = ['A{i-1}', 'A{i}'], mass = 1}, {repeat = {i = '1:" + many +
           "'}, nodes = ['B{i-1}', 'B{i}'], mass = 1}, {repeat = {i = '1:" + many +
           "'}, nodes = ['A{i}', 'B{i}'], mass = 1}, {repeat = {i = '1:" + last +
           "'}, nodes = ['A{i-1}', 'B{i}'], mass = 1}]\n[[constraints]]\nkind = 'plane'\nnodes = "
           "['*']\nnormal = [0, 1, 0]\n";
  };
  for (const int storeys : {3, 160}) {
    CAPTURE(storeys);
    const std::string error = testing::error_of(tower(storeys, true));
    CHECK(error.find("nothing can move: ") != std::string::npos);
    CHECK(error.find(" constraints hold all " + std::to_string(6 * (storeys + 1)) + " coordinates") !=
          std::string::npos);
    CHECK(testing::error_of(tower(storeys, false)).empty());
  }
}

// Each mechanism by itself: what others have says nothing, be they hundreds.
TEST_CASE("a drive against what holds it is named among hundreds of mechanisms") {
  const auto refused = [](int arms, const char* held) {
    return testing::error_of(R"toml([variables]
n = )toml" + std::to_string(arms) +
                             R"toml(
[structure]
kind = "custom"
nodes = [{repeat = {i = "0:n"}, name = "O{i}", position = [0, "=i", 0], fixed = true},
  {repeat = {i = "0:n"}, name = "P{i}", position = [1, "=i", 0]}, {name = "X", position = [2, 0, 0], fixed = true}]
rods = [{repeat = {i = "0:n"}, nodes = ["O{i}", "P{i}"], mass = 1}]
[[constraints]]
kind = "plane"
nodes = ["P*"]
normal = [0, 1, 0]
[[constraints]]
kind = "angle"
name = "motor"
nodes = ["X", "O0", "P0"]
axis = [0, -1, 0]
motion = "rate"
rate = 10
[[constraints]]
kind = "line"
name = "guide"
nodes = [")toml" + held + "\"]\ndirection = [1, 0, 0]\n");
  };
  for (const int arms : {2, 400}) {
    CAPTURE(arms);
    CHECK(refused(arms, "P1") == "");
    CHECK(refused(arms, "P0").find("the drive motor moves what other constraints hold") != std::string::npos);
  }
}

}  // namespace consistency_test
