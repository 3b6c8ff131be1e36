// SPDX-License-Identifier: BSD-3-Clause
// Faces of imported files that are not quite flat.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/import_scene.hpp"
#include "core/structure/node_positions.hpp"
#include "core/system/mobility.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace flatten_plates_test {

namespace {

using testing::model_of, testing::number, testing::run_scene;

ImportedScene imported(const std::string& text) {
  return import_scene({{"t.obj", text, ""}});
}

// 3 x 3 nodes of four parallelograms that fold at the middle: a Miura vertex of unit sides.
std::vector<Vec3> miura_vertex() {
  std::vector<Vec3> x;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) x.emplace_back(0.8 * i, 0.9 * j + (i % 2 ? 0.6 : 0.0), j % 2 ? 0.43 : 0.0);
  return x;
}

// The largest volume of four nodes of a face [m^3].
double volume_of(const std::vector<Vec3>& x) {
  double most = 0.0;
  for (std::size_t k = 3; k < x.size(); ++k)
    most = std::max(most, std::abs((x[1] - x[0]).cross(x[2] - x[0]).dot(x[k] - x[0])) / 6);
  return most;
}

Vec3 rounded(const Vec3& x, double unit) {
  return unit * Vec3((x / unit).array().round());
}

std::string vertex(const Vec3& x) {
  return "v " + number(x[0]) + " " + number(x[1]) + " " + number(x[2]) + "\n";
}

}  // namespace

TEST_CASE("faces of a file with few digits are made flat by moves of the size of its last digit") {
  // A cube that is turned, and a Miura vertex. The exact shape is one with flat faces, each coordinate within
  // half a digit: the nearest is not further from the file's, in the sum of squares.
  const Mat3 turn = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized().toRotationMatrix();
  std::vector<Vec3> cube;
  for (int i = 0; i < 8; ++i) cube.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  const std::vector<std::vector<int>> sides = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                               {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}},
                                      quads = {{0, 3, 4, 1}, {1, 4, 5, 2}, {3, 6, 7, 4}, {4, 7, 8, 5}};
  for (const double unit : {1e-3, 1e-5, 3e-7})
    for (const bool box : {true, false}) {
      CAPTURE(unit, box);
      std::vector<Vec3> exact = box ? cube : miura_vertex();
      for (Vec3& x : exact) x = turn * x;
      const auto& faces = box ? sides : quads;
      std::string text;
      for (const Vec3& x : exact) text += vertex(rounded(x, unit));
      for (const auto& face : faces) {
        text += "f";
        for (const int node : face) text += " " + std::to_string(node + 1);
        text += "\n";
      }
      const ImportedScene scene = imported(text);
      REQUIRE(scene.notes.size() == (box ? 2 : 1));  // a cube floats
      CHECK(scene.notes[0].find("faces were not quite flat: vertices are moved") != std::string::npos);
      const auto model = model_of(scene.text);
      double squares = 0.0;
      for (std::size_t i = 0; i < exact.size(); ++i)
        squares += (model->structure.nodes[i].position - rounded(exact[i], unit)).squaredNorm();
      CHECK(squares > 0.0);
      CHECK(squares <= 3.0 * static_cast<double>(exact.size()) * std::pow(0.5 * unit, 2));
      for (const auto& face : faces) {
        std::vector<Vec3> x;
        for (const int node : face)
          x.push_back(model->structure.nodes[static_cast<std::size_t>(node)].position);
        CHECK(volume_of(x) < 1e-12);  // of sides of 1 m: heights to 1e-11
      }
      // A cube of plates is rigid with its 18 rods alone, so that its planes say nothing new.
      const Mobility m = analyse_mobility(model->system, node_positions(model->structure));
      CHECK(m.degrees_of_freedom == (box ? 6 : 1));
      CHECK(m.redundant.empty() == !box);
      CHECK(run_scene(scene.text).trajectory.size() > 1);
    }
}

TEST_CASE("a warped square is moved by a quarter of its height and one that is exact not at all") {
  const auto square = [&](double h, double far) {
    const Vec3 away(far, -far, 2 * far);
    return imported(vertex(away) + vertex(away + Vec3(1, 0, 0)) + vertex(away + Vec3(1, 1, h)) +
                    vertex(away + Vec3(0, 1, 0)) + "f 1 2 3 4\n");
  };
  for (const double h : {1e-6, 1e-4, 9e-3}) {
    const auto model = model_of(square(h, 0).text);
    // The plane of least squares is h / 4 from every node. It leans by h: the next order is h^2.
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 given(i == 1 || i == 2, i >= 2, i == 2 ? h : 0);
      const Vec3 x = model->structure.nodes[i].position;
      CHECK(std::abs((x - given).norm() - h / 4) < h * h);
      CHECK(std::abs(x.z() - given.z() - (i == 0 ? -1 : i == 2 ? -1 : 1) * h / 4) < h * h);
    }
  }
  for (const double far : {0.0, 1e3, 1e7}) CHECK(square(0, far).notes.size() == 1);  // that it floats
}

TEST_CASE("faces that are far from flat are refused with their place") {
  const auto square = [&](const std::string& h) {
    try {
      imported("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 " + h + "\nv 0 0 1\nf 1 2 5\nf 1 2 4 3\n");
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(square("0.0001").empty());
  CHECK(square("0.1").starts_with("t.obj:7:1: f: its vertices are"));
}

TEST_CASE("a saddle of flat faces is no flat sheet, whatever else is in its file") {
  // z = c (x - 3) (y - 3): each unit face is off its plane by less than 1 %, the nearest sheet of flat ones
  // is up to 7 c away, which a face of 1 m is not moved by and one of 100 m would be.
  constexpr double c = 0.0135;
  std::string saddle;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 7; ++j) saddle += vertex(Vec3(i, j, c * (i - 3) * (j - 3)));
  const std::string far = vertex(Vec3(200, 0, 0)) + vertex(Vec3(300, 0, 0)) + vertex(Vec3(300, 100, 0)) +
                          vertex(Vec3(200, 100, 0));
  std::string faces;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      faces += "f";
      for (const int k : {7 * i + j, 7 * i + j + 7, 7 * i + j + 8, 7 * i + j + 1})
        faces += " " + std::to_string(k + 1);
      faces += "\n";
    }
  for (const std::string& text : {saddle + faces, saddle + far + faces + "f 50 51 52 53\n"})
    CHECK_THROWS_WITH(imported(text), Catch::Contains("no small moves put those of all faces into planes"));
  CHECK_NOTHROW(imported(far + "f 1 2 3 4\n"));
}

}  // namespace flatten_plates_test
