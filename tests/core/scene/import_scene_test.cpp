// SPDX-License-Identifier: BSD-3-Clause
// Scenes of FOLD, OBJ and CSV files: what they can do, against closed forms, and what is refused.
#include "core/scene/import_scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/structure/node_positions.hpp"
#include "core/system/mobility.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace import_scene_test {

namespace {

using testing::model_of, testing::number, testing::run_scene;

ImportedScene imported(const std::string& text, const std::string& name, const std::string& rods = "") {
  if (rods.empty()) return import_scene({{name, text, ""}});
  return import_scene({{name, text, ""}, {"rods.csv", rods, ""}});
}

std::string refusal(const std::string& text, const std::string& name, const std::string& rods = "") {
  try {
    imported(text, name, rods);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

Mobility mobility_of(const std::string& scene) {
  const auto model = model_of(scene);
  return analyse_mobility(model->system, node_positions(model->structure));
}

std::string list_of(const std::vector<std::string>& items) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : ", ") + item;
  return "[" + text + "]";
}

// A Miura vertex (M. Schenk and S. D. Guest, PNAS 110, 2013): 3 x 3 nodes of parallelograms with sides a, b
// and the sector angle gamma, whose planes stand at theta above the ground. Node (i, j) has the number 3 i +
// j.
struct MiuraVertex {
  double a = 1.1, b = 0.9, gamma = 1.08, theta = 0.6;

  std::vector<Vec3> nodes() const {
    const double t = std::cos(theta) * std::tan(gamma), root = std::sqrt(1 + t * t),
                 height = a * std::sin(theta) * std::sin(gamma);
    std::vector<Vec3> x;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        x.emplace_back(i * b * t / root, j * std::sqrt(a * a - height * height) + (i % 2 ? b / root : 0.0),
                       j % 2 ? height : 0.0);
    return x;
  }
};

// The turn of the plate on the right of the crease from node 4 to node w against the plate on its left: 0 is
// flat, positive a valley [rad]. l and r: nodes of the plates beside w.
double fold_at(const VectorXd& q, int w, int l, int r) {
  const auto at = [&](int node) -> Vec3 { return q.segment<3>(3 * node); };
  const Vec3 along = (at(w) - at(4)).normalized();
  const auto off = [&](int node) -> Vec3 { return along.cross(at(node) - at(4)); };
  // Normals of both plates, counterclockwise seen from above.
  const Vec3 left = off(l).normalized(), right = -off(r).normalized();
  return -std::atan2(along.dot(left.cross(right)), left.dot(right));
}

struct Fold {
  int w, l, r;
};
constexpr Fold vertex_folds[] = {{1, 0, 2}, {7, 8, 6}, {3, 6, 0}, {5, 2, 8}};

std::string miura_fold(const MiuraVertex& shape, bool triangles = false) {
  const auto x = shape.nodes();
  VectorXd q(27);
  std::vector<std::string> coordinates, edges, names, faces;
  for (int i = 0; i < 9; ++i) {
    const Vec3& p = x[static_cast<std::size_t>(i)];
    q.segment<3>(3 * i) = p;
    coordinates.push_back(list_of({number(p[0]), number(p[1]), number(p[2])}));
  }
  for (const Fold& f : vertex_folds) {
    edges.push_back("[4, " + std::to_string(f.w) + "]");
    names.emplace_back(fold_at(q, f.w, f.l, f.r) > 0 ? "\"V\"" : "\"M\"");
  }
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const std::string p = std::to_string(3 * i + j), u = std::to_string(3 * i + 3 + j),
                        v = std::to_string(3 * i + 4 + j), w = std::to_string(3 * i + 1 + j);
      if (triangles) {
        faces.insert(faces.end(), {list_of({p, u, v}), list_of({p, v, w})});
        edges.push_back(list_of({p, v}));
        names.emplace_back("\"F\"");
      } else {
        faces.push_back(list_of({p, u, v, w}));
      }
    }
  return "{\"file_spec\": 1.1, \"vertices_coords\": " + list_of(coordinates) +
         ",\n\"edges_vertices\": " + list_of(edges) + ", \"edges_assignment\": " + list_of(names) +
         ",\n\"faces_vertices\": " + list_of(faces) + "}";
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

// The third node is in line with the first two: the fourth holds the plane, wherever the shape stands.
TEST_CASE("an OBJ file of lines is held at three nodes out of line along them and across") {
  const std::vector<Vec3> shape = {{0.1, 0.2, 0.3}, {1.3, 0.8, 0.9}, {2.5, 1.4, 1.5}, {0.7, 2.1, -0.4}};
  for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(5, -3, 2)}) {
    std::string text;
    for (const Vec3& x : shape)
      text += "v " + number(x[0] + shift[0]) + " " + number(x[1] + shift[1]) + " " + number(x[2] + shift[2]) +
              "\n";
    const ImportedScene scene = imported(text + "l 1 2\nl 2 3\nl 3 4\nl 1 4\nl 2 4\n", "lines.obj");
    CAPTURE(scene.text);
    const Structure s = build_structure(read_scene_text(scene.text, "lines.toml"));
    const auto held = [&](const char* kind) -> const Constraint& {
      const auto it = std::ranges::find(s.constraints, kind, &Constraint::kind);
      REQUIRE(it != s.constraints.end());
      return *it;
    };
    const Vec3 along = (shape[1] - shape[0]).normalized(), n = along.cross(shape[3] - shape[0]).normalized();
    CHECK(held("fixed").nodes == std::vector{0});
    CHECK(held("line").nodes == std::vector{1});
    CHECK(held("plane").nodes == std::vector{3});
    // Of a difference of coordinates up to 8 m.
    CHECK(held("line").vectors[0].cross(along).norm() < 1e-14);
    CHECK(held("plane").vectors[0].cross(n).norm() < 1e-14);
  }
}

TEST_CASE("a Miura vertex of a FOLD file can move in one way and no row of it is redundant") {
  for (const bool triangles : {false, true}) {
    const ImportedScene scene = imported(miura_fold({}, triangles), "miura.fold");
    CAPTURE(triangles, scene.text);
    CHECK(scene.notes.empty());
    const Mobility m = mobility_of(scene.text);
    // 9 nodes; 12 edges and 4 diagonals; 4 planes, or 4 edges that do not fold; 6 that hold it.
    CHECK(m.coordinates == 27);
    CHECK(m.constraints == 26);
    CHECK(m.rank == 26);
    CHECK(m.degrees_of_freedom == 1);
    CHECK(m.redundant.empty());
  }
}

TEST_CASE("the folds of a Miura vertex from a FOLD file keep to the closed form while it moves") {
  const MiuraVertex shape;
  const Simulation run = run_scene(imported(miura_fold(shape), "miura.fold").text);
  REQUIRE(run.trajectory.size() > 20);
  const VectorXd first = run.trajectory.node_positions(0),
                 last = run.trajectory.node_positions(run.trajectory.size() - 1);
  // Springs fold every crease on, each its own way; the first plate stays.
  for (const Fold& f : vertex_folds) {
    const double before = fold_at(first, f.w, f.l, f.r), after = fold_at(last, f.w, f.l, f.r);
    CHECK(std::abs(after) > std::abs(before) + 0.2);
    CHECK(after * before > 0);
  }
  for (const int node : {0, 3, 4, 1}) CHECK((last - first).segment<3>(3 * node).norm() < 1e-12);
  for (std::size_t k = 0; k < run.trajectory.size(); ++k) {
    const VectorXd q = run.trajectory.node_positions(k);
    double half[4];
    for (std::size_t c = 0; c < 4; ++c)
      half[c] = std::tan(0.5 * fold_at(q, vertex_folds[c].w, vertex_folds[c].l, vertex_folds[c].r));
    // A flat-foldable vertex with sector angles gamma, pi - gamma, pi - gamma, gamma: opposite folds are
    // equal, up to the sign in one pair, and tan of half angles of the pairs are as 1 to cos gamma.
    // Constraints are kept to 1e-15; an angle is as exact as that over the sine between plates (> 0.1).
    const bool first_pair = std::abs(half[0]) < std::abs(half[2]);
    const double small = std::abs(first_pair ? half[0] : half[2]),
                 large = std::abs(first_pair ? half[2] : half[0]);
    CHECK(std::abs(small / large - std::cos(shape.gamma)) < 1e-12);
    CHECK(std::abs(std::abs(half[0]) - std::abs(half[1])) < 1e-12 * large);
    CHECK(std::abs(std::abs(half[2]) - std::abs(half[3])) < 1e-12 * large);
    CHECK(half[0] * half[1] * half[2] * half[3] < 0);  // three mountains and a valley, or the other way round
  }
}

TEST_CASE("folds that cannot begin and folds against their letters are told") {
  MiuraVertex flat;
  flat.theta = 0.0;
  const auto notes = imported(miura_fold(flat), "miura.fold").notes;
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].starts_with("all mountains and valleys are flat"));
  std::string text = miura_fold({});
  for (char& c : text) c = c == 'M' ? 'V' : c == 'V' ? 'M' : c;
  const ImportedScene scene = imported(text, "miura.fold");
  REQUIRE(scene.notes.size() == 1);
  CHECK(scene.notes[0].starts_with("4 mountains or valleys are folded the other way already"));
  // It folds on as it is, all the same.
  const Simulation run = run_scene(scene.text);
  const Fold f = vertex_folds[0];
  CHECK(std::abs(fold_at(run.trajectory.node_positions(run.trajectory.size() - 1), f.w, f.l, f.r)) >
        std::abs(fold_at(run.trajectory.node_positions(0), f.w, f.l, f.r)) + 0.2);
}

TEST_CASE("a flap in the notch of a concave plate folds as its letter says") {
  // A U with a flap at the bottom of its notch, from V5 to V4 along y = 1; its tip is at the height z.
  const std::string prongs =
      "[[0, 0, 0], [3, 0, 0], [3, 3, 0], [2, 3, 0], [2, 1, 0], [1, 1, 0], [1, 3, 0], [0, 3, 0]";
  const auto fold = [&](const char* letter, double z, int first) {
    std::string face;
    for (int k = 0; k < 8; ++k) face += (k ? ", " : "") + std::to_string((first + k) % 8);
    return imported("{\"vertices_coords\": " + prongs + ", [1.5, 1.7, " + number(z) +
                        "]], \"edges_vertices\": [[4, 5]], \"edges_assignment\": [\"" + letter +
                        "\"], \"faces_vertices\": [[" + face + "], [5, 4, 8]]}",
                    "u.fold");
  };
  struct Case {
    const char* letter;
    double z;
    const char* note;  // how it begins
    double turn;       // the way that the flap goes
  };
  // Seen from above, where faces go counterclockwise, a valley folds up and a mountain down. Folded the other
  // way already it goes on as it is.
  const Case cases[] = {
      {"V", 0.1, "", 1},     {"M", -0.1, "", -1}, {"M", 0.1, "1 mountains or valleys are f", 1},
      {"V", -0.1, "1 ", -1}, {"V", 0, "all ", 1}, {"M", 0, "all mountains", -1}};
  for (const Case& c : cases) {
    const ImportedScene scene = fold(c.letter, c.z, c.z > 0 ? 0 : 3);
    CAPTURE(c.letter, c.z);
    CHECK(scene.notes.size() == (c.note[0] ? 1 : 0));
    for (const std::string& note : scene.notes) CHECK(note.starts_with(c.note));
    const Simulation run = run_scene(scene.text);
    const VectorXd last = run.trajectory.node_positions(run.trajectory.size() - 1);
    const double angle = std::atan2(last[3 * 8 + 2], last[3 * 8 + 1] - 1), before = std::atan2(c.z, 0.7);
    CHECK(c.turn * (angle - before) > 0.2);
    CHECK(last.head(24).isApprox(run.trajectory.node_positions(0).head(24), 1e-12));  // the U is held
  }
}

TEST_CASE("of three plates at an edge that does not fold all are held and at a fold that is told") {
  const auto book = [&](const char* letter) {
    return imported(
        std::string("{\"vertices_coords\": [[0, 0, 0], [0.3, 1.2, 0.1], [1.1, 0.4, 0], [-0.8, 0.7, "
                    "0.3], [0.2, 0.5, 0.9]],\n"
                    "\"edges_vertices\": [[0, 1]], \"edges_assignment\": [\"") +
            letter + "\"], \"faces_vertices\": [[0, 2, 1], [1, 3, 0], [0, 4, 1]]}",
        "book.fold");
  };
  // 15 coordinates, 7 rods; held at one leaf the two others turn, or as one body it floats.
  for (const char* letter : {"F", "J", "U", "V"}) {
    CAPTURE(letter);
    const bool held = letter[0] == 'F' || letter[0] == 'J';
    const ImportedScene scene = book(letter);
    const Mobility m = mobility_of(scene.text);
    CHECK(m.degrees_of_freedom == (held ? 6 : 2));
    CHECK(m.redundant.empty());
    CHECK(scene.notes.size() == (letter[0] == 'U' ? 0 : 1));
  }
  CHECK(book("V").notes[0].starts_with("1 times a plate is the third"));
}

TEST_CASE("a face of any shape is one rigid plate without a redundant row") {
  std::mt19937 dice(8203);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int n = 3; n < 12; ++n)
    for (int trial = 0; trial < 5; ++trial) {
      // A star, dents and all, in a plane somewhere; every second one with a node in the middle of a side.
      const Mat3 turn = Eigen::Quaterniond(Eigen::Vector4d(any(dice), any(dice), any(dice), any(dice)))
                            .normalized()
                            .toRotationMatrix();
      std::vector<Vec3> x;
      for (int i = 0; i < n; ++i) {
        const double angle = 2 * pi * (i + 0.6 * any(dice)) / n, r = 0.5 + any(dice);
        x.emplace_back(turn * Vec3(r * std::cos(angle), r * std::sin(angle), 0.3));
      }
      if (trial % 2) x.push_back(0.4 * x.front() + 0.6 * x.back());
      std::string text, face = "f";
      for (std::size_t i = 0; i < x.size(); ++i) {
        text += "v " + number(x[i][0]) + " " + number(x[i][1]) + " " + number(x[i][2]) + "\n";
        face += " " + std::to_string(i + 1) + "/1";
      }
      const ImportedScene scene = imported(text + face + "\n", "plate.obj");
      CAPTURE(scene.text);
      const Mobility m = mobility_of(scene.text);
      CHECK(m.degrees_of_freedom == 6);  // as a rigid body: it floats
      CHECK(m.redundant.empty());
    }
}

TEST_CASE("lines and faces of an OBJ file are rods and plates") {
  const std::string four = "# a tetrahedron\nv 0 0 0\nv 1.3 0 0\nv 0.2 1.1 0\nv 0.3 0.4 0.9\n";
  const ImportedScene faces =
      imported(four + "o x\nvn 0 0 1\nf 1 3 2\nf 1//1 2//1 4//1\nf -3 -2 -1\nf 3 1 4\n", "t.OBJ");
  CHECK(mobility_of(faces.text).degrees_of_freedom == 6);
  CHECK(model_of(faces.text)->structure.rods.size() == 6);
  // A triangle with a rod that swings about its corner: two angles. A vertex that nothing joins is left out.
  const ImportedScene lines = imported(four + "v 5 5 5\nl 1 2 \\\n 3 1\nl 3 4\n", "t.obj");
  CHECK(mobility_of(lines.text).degrees_of_freedom == 2);
  CHECK(lines.notes == std::vector<std::string>{"1 vertices at which no rod ends are left out"});
  CHECK(run_scene(lines.text).trajectory.size() > 1);
  // A comment ends with its line: that of a folder goes on nowhere.
  const ImportedScene named =
      imported("# C:\\models\\\n" + four.substr(four.find('v')) + "f 1 2 3 # C:\\\nl 3 4\n", "t.obj");
  CHECK(model_of(named.text)->structure.rods.size() == 4);
  CHECK(model_of(named.text)->structure.nodes.size() == 4);
}

TEST_CASE(
    "nodes and rods of CSV files with names or numbers and with or without a first line are one scene") {
  const std::string plain = "0,0,0\n1,0,0\n0.4,0.9,0\n0.3,0.4,0.8\n", rods = "0,1\n1,2\n2,0\n0,3\n";
  const std::string expected = imported(plain, "n.csv", rods).text;
  CHECK(mobility_of(expected).degrees_of_freedom == 2);
  CHECK(imported("x,y,z\n" + plain, "n.csv", "a,b\n" + rods).text == expected);
  CHECK(imported(plain, "n.csv", "1,2\n2,3\n3,1\n1,4\n").text == expected);
  CHECK(imported("V0,0,0,0\nV1,1,0,0\nV2,0.4,0.9,0\nV3,0.3,0.4,0.8\n", "n.csv",
                 "a,b\nV0,V1\nV1,V2\nV2,V0\nV0,V3\n")
            .text == expected);
  CHECK(imported("+0.0,+0.0,+0.0\n+1,+0,+0\n0.4,+9e-1,0\n0.3,0.4,0.8\n", "n.csv", "+0,+1\n1,2\n2,0\n0,3\n")
            .text == expected);
  // What the columns say is kept: nothing is assumed, nothing else held; braces are not expressions.
  const ImportedScene own = imported("name,x,y,z,mass,fixed\nA{},0,0,0,0,true\nB,0,0,2,1.5,false\n", "n.csv",
                                     "a,b,mass,group\nA{},B,0.5,leg\n");
  const auto model = model_of(own.text);
  CHECK(own.text.find("[variables]") == std::string::npos);
  CHECK(model->structure.nodes[0].name == "A{}");
  CHECK(model->structure.rods[0].mass == 0.5);
  CHECK(model->structure.rods[0].group == "leg");
  CHECK(mobility_of(own.text).degrees_of_freedom == 2);  // it swings about A
  const ImportedScene braced = imported("name,x,y,z\nA{},0,0,0\n}B{{,0,0,2\n", "n{.csv", "a,b\nA{},}B{{\n");
  CHECK(model_of(braced.text)->structure.nodes[1].name == "}B{{");
}

TEST_CASE("a byte-order mark is no part of an imported file") {
  const std::string mark = "\xEF\xBB\xBF", csv = "0,0,0\n1,0,0\n0.4,0.9,0\n0.3,0.4,0.8\n",
                    rods = "0,1\n1,2\n2,0\n0,3\n";
  for (const std::string& text : {std::string("v 0 0 0\nv 1 0 0\nv 0.1 1 0\nv 0 0.2 1\nl 1 2\nl 2 3\n"),
                                  std::string("v 0 0 0\nv 1 0 0\nv 0.1 1 0\nv 0 0.2 1\nf 2 3 4\nf 1 2 3\n"),
                                  std::string("# by hand\nv 0 0 0\nv 1 0 0\nl 1 2\n")})
    CHECK(imported(mark + text, "t.obj").text == imported(text, "t.obj").text);
  CHECK(imported(mark + miura_fold({}), "m.fold").text == imported(miura_fold({}), "m.fold").text);
  for (const std::string head : {"", "# by hand\n"}) {
    const std::string expected = imported(csv, "n.csv", rods).text;
    CHECK(imported(mark + head + csv, "n.csv", mark + head + rods).text == expected);
    CHECK(imported(mark + head + "x,y,z\n" + csv, "n.csv", mark + head + "a,b\n" + rods).text == expected);
  }
  // Columns count from the first character behind it.
  CHECK(refusal(mark + "v 0 0 nan\n", "t.obj").starts_with("t.obj:1:1: v: a coordinate"));
  CHECK(refusal(mark + "[NaN]", "m.fold").starts_with("m.fold:1:2: not JSON"));
  CHECK(refusal(mark, "t.obj") == "t.obj: v: there are no vertices, lines v X Y Z");
}

TEST_CASE("a FOLD file that is nested past reason is refused where it is") {
  for (const std::size_t depth : {65U, 2000000U}) {
    const std::string open(depth, '['), close(depth, ']');
    CHECK(refusal("{\"vertices_coords\":\n" + open + close + "}", "m.fold") ==
          "m.fold:2:64: brackets nested too deeply");
    CHECK(refusal(open + close, "m.fold") == "m.fold:1:65: brackets nested too deeply");
    CHECK(refusal(open, "m.fold") == "m.fold:1:65: brackets nested too deeply");
  }
  // Brackets side by side or in text are none, and keys that are not read may be nested as others write them.
  const std::string text = "\"note\": \"" + std::string(100, '[') + "\\\"" + std::string(100, '{') +
                           "\", \"own:tree\": " + std::string(60, '[') + std::string(60, ']');
  CHECK(imported(with(miura_fold({}), "\"file_spec\": 1.1", text), "m.fold").text ==
        imported(miura_fold({}), "m.fold").text);
}

TEST_CASE("units of a FOLD file are taken to metres") {
  const std::string text = with(miura_fold({}), "\"file_spec\": 1.1", "\"frame_unit\": \"mm\"");
  const Vec3 x = model_of(imported(text, "m.fold").text)->structure.nodes[8].position;
  CHECK((x - 1e-3 * MiuraVertex().nodes()[8]).norm() < 1e-17);
  CHECK(refusal(with(miura_fold({}), "\"file_spec\": 1.1", "\"frame_unit\": \"ell\""), "m.fold") ==
        "m.fold: frame_unit: must be one of unit, m, cm, mm, um, nm, in, pt; got \"ell\"");
}

TEST_CASE("FOLD files of which nothing can be built are refused with the key") {
  const auto refused = [](const std::string& text) { return refusal(text, "m.fold"); };
  const auto triangle = [&](const std::string& more) {
    return refused("{\"vertices_coords\": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], " + more + "}");
  };
  CHECK(refused("{\"vertices_coords\": [[0, 0, 0], [1, 0\n") ==
        "m.fold:2:1: not JSON: unexpected end of input; expected ']'");
  CHECK(refused("{\"vertices_coords\":\n [[0, 0, NaN]]}") ==
        "m.fold:2:10: not JSON: invalid literal; last read: '0, N'");
  CHECK(refused("{\"vertices_coords\": [[0, 0, 1e999]]}") ==
        "m.fold: not JSON that can be read: a number is beyond 1e308");
  CHECK(refused("[]") == "m.fold: a FOLD file is a JSON object, {...}; got []");
  CHECK(refused("{}") == "m.fold: vertices_coords: is missing");
  CHECK(refused("{\"vertices_coords\": []}") ==
        "m.fold: vertices_coords: must be a list with entries; got []");
  CHECK(refused("{\"vertices_coords\": [[0, 0, 1], [0, 1]]}") ==
        "m.fold: vertices_coords[1]: must be three numbers, [x, y, z]; got [0,1]: a flat pattern can begin "
        "to fold in "
        "several ways; give it a little folded");
  CHECK(refused("{\"vertices_coords\": [[0, 0, \"a\"]]}") ==
        "m.fold: vertices_coords[0]: must be three numbers, [x, y, z]; got [0,0,\"a\"]");
  CHECK(refused("{\"vertices_coords\": [[0, 0, 1], [0, 0, 1]]}") ==
        "m.fold: vertices_coords[1]: lies where 'V0' lies already; join the two vertices to one, or move one "
        "of them");
  CHECK(triangle("\"x\": 1") == "m.fold: edges_vertices: is missing, and so is faces_vertices");
  CHECK(triangle("\"edges_vertices\": [[0, 1], [1, 3]]") ==
        "m.fold: edges_vertices[1]: a vertex is a whole number from 0 to 2; got 3");
  CHECK(triangle("\"edges_vertices\": [[0, -1]]") ==
        "m.fold: edges_vertices[0]: a vertex is a whole number from 0 to 2; got -1");
  CHECK(triangle("\"edges_vertices\": [[0, 1, 2]]") ==
        "m.fold: edges_vertices[0]: an edge has 2 vertices; got 3");
  CHECK(triangle("\"edges_vertices\": [[2, 2]]") == "m.fold: edges_vertices[0]: goes from 'V2' to itself");
  CHECK(triangle("\"edges_vertices\": [[0, 1]], \"edges_assignment\": [\"X\"]") ==
        "m.fold: edges_assignment[0]: must be one of B, M, V, F, U, C, J; got \"X\"");
  CHECK(triangle("\"edges_vertices\": [[0, 1]], \"edges_assignment\": [\"B\", \"B\"]") ==
        "m.fold: edges_assignment: must have an entry for each of the 1 edges; got 2");
  CHECK(triangle("\"faces_vertices\": [[0, 1]]") ==
        "m.fold: faces_vertices[0]: a face has 3 to 100 vertices; got 2");
  CHECK(triangle("\"faces_vertices\": [[0, 1, 2, 1]]") == "m.fold: faces_vertices[0]: names a vertex twice");
  CHECK(refused("{\"vertices_coords\": [[0, 0, 0], [1, 0, 0], [2, 0, 0]], \"faces_vertices\": [[0, 1, 2]]}")
            .starts_with("m.fold: faces_vertices[0]: has too many vertices in one line"));
  CHECK(refused("{\"vertices_coords\": [[0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0]], \"faces_vertices\": "
                "[[0, 1, 2, 3]]}")
            .starts_with("m.fold: faces_vertices[0]: its vertices are"));
  for (const char* order : {"0, 2, 1, 3", "0, 1, 3, 2", "3, 1, 2, 0"})
    CHECK(
        refused("{\"vertices_coords\": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], \"faces_vertices\": [[" +
                std::string(order) + "]]}") ==
        "m.fold: faces_vertices[0]: its sides cross each other; name its vertices in the order that goes "
        "around it");
  CHECK(refused("{\"vertices_coords\": [[0, 0, 0], [1e200, 0, 0]], \"edges_vertices\": [[0, 1]]}")
            .starts_with("m.fold: vertices_coords[1]: a coordinate must be less than 1e+100 m in size"));
  CHECK(refused("{\"vertices_coords\": [[0, 0, 0], [1e-200, 0, 0]], \"edges_vertices\": [[0, 1]]}") ==
        "m.fold: edges_vertices[0]: is shorter than 1e-100 m");
}

TEST_CASE("OBJ and CSV files of which nothing can be built are refused with the line") {
  const auto refused = [](const std::string& text) { return refusal(text, "t.obj"); };
  CHECK(refused("# nothing\n") == "t.obj: v: there are no vertices, lines v X Y Z");
  CHECK(refused("v 0 0 0\n") == "t.obj: l: nothing joins its vertices: lines l A B or faces f A B C ...");
  CHECK(refused("v 0 0 0\nv 1 2\n") == "t.obj:2:1: v: a vertex has three coordinates, v X Y Z; got 2");
  CHECK(refused("v 0 0 nan\n") == "t.obj:1:1: v: a coordinate is a finite number; got 'nan'");
  CHECK(refused("v 0 0 0\nv 1 0 0\nl 1 3\n") ==
        "t.obj:3:1: l: names a vertex by 1 to 2, as many as stand above, or by -1 for the last; got '3'");
  CHECK(refused("v 0 0 0\n\nv -0 0 0\n").starts_with("t.obj:3:1: v: lies where 'V1' lies already"));
  std::string many;
  for (int i = 0; i < 1000000; ++i) many += "v " + std::to_string(i) + " 0 0\n";
  CHECK(refused(many) == "t.obj:400001:1: v: there are more than 400000 vertices, the most that is built");
  const std::string plain = "0,0,0\n1,0,0\n0.4,0.9,0\n";
  CHECK(refusal(plain, "n.csv", "1,2\n").starts_with("rods.csv: a, b: go from 1 to 2 and there are 3 nodes"));
  CHECK(refusal(plain, "n.csv", "0,1\n1,3\n") ==
        "rods.csv: rods[1]: an end is a node's name, or its number from 0 to 2; got '3'");
  CHECK(refusal(plain, "n.csv", "0,1\n0,2\n1,0\n") ==
        "rods.csv:3:1: there is already a rod from 'V1' to 'V0'");
  CHECK(refusal("0,0\n", "n.csv", "0,1\n").starts_with("n.csv:1:1: has 2 cells; the header has 3"));
  CHECK(refusal("name,x,y,z\nA,0,0,0\nA,1,0,0\n", "n.csv", "a,b\nA,B\n") ==
        "n.csv:3:1: name: there is already a node 'A'");
  const std::string three = "x,y,z\n0,0,0\n\n1,0,0\n0.4,0.9,0\n";
  CHECK(refusal(three, "n.csv", "a,b,area\n0,1,1e-4\n\n1,2,1e-4\n").find("n.csv") == std::string::npos);
  CHECK(refusal(three, "n.csv", "a,b,area\n0,1,1e-4\n\n1,2,1e-4\n").find("rods.csv:4:1: structure.rods[1]") !=
        std::string::npos);
  CHECK(refusal("name,x,y,z\nA,0,0,0\n=z,1,0,0\n", "n.csv", "a,b\nA,=z\n") ==
        "n.csv:3:1: name: '=z' begins with =, as expressions do; give it another name");
  CHECK(refusal(three, "n.csv", "a,b,group\n0,1,=g\n") ==
        "rods.csv:2:1: group: '=g' begins with =, as expressions do; give it another name");
  CHECK(refusal("name,x,y,z\nA,0,0,0\nB,1,0,0\n", "n.csv", "a,b\nA,C\n")
            .starts_with("rods.csv:2:1: there is no node 'C'"));
}

}  // namespace import_scene_test
