// SPDX-License-Identifier: BSD-3-Clause
// glTF as pictures show it: loads as arrows, materials of groups, surfaces that morph.
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/export/formats.hpp"
#include "core/export/unit_shapes.hpp"
#include "core/simulate/stepper.hpp"
#include "tests/support/glb.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace gltf_looks_test {

namespace fs = std::filesystem;

namespace {

// Five bays of a ring with the hinges' forces, and another of half the size on one node.
std::string ring(const std::string& hinge_force) {
  return "[structure]\nkind = 'hoop'\nmodel = 'sector'\nunits = 5\nhinge_force = " + hinge_force +
         "\n[solver]\nstep = 0.02\nend_time = 0.14\n";
}

struct Shown {
  explicit Shown(const std::string& scene = ring("37")) : run(testing::run_scene(scene)) {}
  Simulation run;
  const Structure& structure = run.trajectory.structure();
  ExportedLooks looks;
  fs::path folder = fs::temp_directory_path() / ("unfurl_looks_" + std::to_string(::getpid()));

  testing::Glb glb(double interval = 0.04) const {
    fs::create_directories(folder);
    const Diagnostics d = diagnose(run);
    find_export_format("gltf")->write({run, d, folder, "ring", interval, 2.5, {}, {}, {}, &looks});
    std::ostringstream text;
    text << std::ifstream(folder / "animation.glb", std::ios::binary).rdbuf();
    fs::remove_all(folder);
    return testing::Glb(text.str());
  }
};

Vec3 point(const VectorXd& pose, int node) {
  return pose.segment<3>(3 * node);
}

void check_arrows(const Shown& shown) {
  const testing::Glb glb = shown.glb();
  const auto& nodes = glb.json["nodes"];
  const VectorXd last = shown.run.trajectory.positions_at(0.14);
  Vec3 low = point(last, 0), high = low;
  for (std::size_t i = 0; i < shown.run.trajectory.size(); ++i) {
    const VectorXd pose = shown.run.trajectory.positions(i);
    for (int n = 0; n < static_cast<int>(shown.structure.node_copies.size()); ++n)
      low = low.cwiseMin(point(pose, n)), high = high.cwiseMax(point(pose, n));
  }
  double largest = 0;
  for (const LoadCopy& load : shown.structure.load_copies) largest = std::max(largest, load.force.norm());
  std::size_t arrows = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string name = nodes[i]["name"];
    if (!name.starts_with("load at ") || !nodes[i].contains("children")) continue;
    ++arrows;
    const auto load = std::find_if(
        shown.structure.load_copies.begin(), shown.structure.load_copies.end(), [&](const LoadCopy& l) {
          return "load at " + shown.structure.node_copies[static_cast<std::size_t>(l.node)].name == name;
        });
    REQUIRE(load != shown.structure.load_copies.end());
    const auto place = nodes[i]["translation"].get<std::vector<double>>();
    CHECK((Vec3(place[0], place[1], place[2]) - point(last, load->node)).norm() < 1e-6);
    CHECK(glb.keys(i, "translation").size() >= 3 * 8);  // of as many states
    const auto q = nodes[i]["rotation"].get<std::vector<double>>();
    const Vec3 along = Eigen::Quaterniond(q[3], q[0], q[1], q[2]) * Vec3::UnitY();
    CHECK((along - load->force.normalized()).norm() < 1e-6);
    // The shaft begins at the node, the head goes on where it ends: single numbers, exact but for rounding.
    const auto part = [&](int k, const char* key) {
      return nodes[nodes[i]["children"][static_cast<std::size_t>(k)].get<std::size_t>()][key][1]
          .get<double>();
    };
    CHECK(part(0, "translation") - 0.5 * part(0, "scale") == Approx(0).epsilon(0).margin(1e-12));
    CHECK(part(1, "translation") - 0.5 * part(1, "scale") == Approx(part(0, "scale")));
    // Of the largest force a thirteenth of the way between the corners of the box of the whole motion.
    CHECK(part(0, "scale") + part(1, "scale") ==
          Approx((high - low).norm() / 13 * load->force.norm() / largest).epsilon(1e-5));
  }
  CHECK(arrows == shown.structure.load_copies.size());
  CHECK(arrows > 0);
}

}  // namespace

TEST_CASE("glTF: every load is an arrow that goes with its node and points along its force") {
  check_arrows(Shown());
  check_arrows(Shown(ring("0.0037")));
}

TEST_CASE("glTF: a group has the material that pictures give it") {
  Shown shown;
  const std::string group = shown.structure.rods.front().group;
  shown.looks.materials = {{group, 0.61, 0.62, 0.63, 0.85, 0.3}};
  const testing::Glb glb = shown.glb();
  for (const auto& material : glb.json["materials"]) {
    const auto& pbr = material["pbrMetallicRoughness"];
    if (material["name"] == group) {
      CHECK(pbr["baseColorFactor"].get<std::vector<double>>() == std::vector<double>{0.61, 0.62, 0.63, 1});
      CHECK(pbr["metallicFactor"] == 0.85);
      CHECK(pbr["roughnessFactor"] == 0.3);
    } else {
      CHECK(pbr["baseColorFactor"][0] != 0.61);
    }
  }
}

TEST_CASE("glTF: groups beyond the sixth have the first six colours again darker and paler") {
  std::string nodes = "{name = 'N0', position = [0, 0, 0], fixed = true}", rods;
  for (int k = 0; k < 18; ++k) {
    const std::string i = std::to_string(k), j = std::to_string(k + 1);
    nodes += ", {name = 'N" + j + "', position = [" + j + ", 0, 0.3]}";
    rods += "{nodes = ['N" + i + "', 'N" + j + "'], mass = 1, group = 'g" + i + "'}, ";
  }
  const Shown shown("[structure]\nkind = 'custom'\nnodes = [" + nodes + "]\nrods = [" + rods +
                    "]\n[solver]\nstep = 0.02\nend_time = 0.04\n");
  const testing::Glb glb = shown.glb();
  std::map<std::string, std::vector<double>> colour;
  for (const auto& material : glb.json["materials"])
    colour[material["name"]] = material["pbrMetallicRoughness"]["baseColorFactor"].get<std::vector<double>>();
  for (int k = 0; k < 6; ++k) {
    const auto group = [&](int n) {
      return Eigen::Map<const Vec3>(colour.at("g" + std::to_string(n)).data());
    };
    for (int other = 0; other < k; ++other) CHECK((group(k) - group(other)).norm() > 0.1);
    CHECK((group(k + 6).array() <= group(k).array()).all());
    CHECK(group(k + 6).sum() < 0.5 * group(k).sum());
    CHECK(group(k + 12).sum() > 1.2 * group(k).sum());
  }
}

TEST_CASE("glTF: a surface is where its nodes are at every key") {
  Shown shown;
  shown.looks.surfaces = [](const VectorXd& pose) {
    ExportedSurface s;
    s.name = "sail";
    s.triangles = {0, 1, 2};
    s.opacity = 0.4;
    for (const int node : {1, 4, 7}) {
      const Vec3 p = point(pose, node);
      for (int k = 0; k < 3; ++k)
        s.positions.push_back(static_cast<float>(p[k])), s.normals.push_back(k == 2 ? 1.0f : 0.0f);
    }
    return std::vector<ExportedSurface>{s};
  };
  const testing::Glb glb = shown.glb();
  const auto& json = glb.json;
  std::size_t at = 0;
  while (at < json["nodes"].size() && json["nodes"][at]["name"] != "sail") ++at;
  REQUIRE(at < json["nodes"].size());
  const auto& mesh = json["meshes"][json["nodes"][at]["mesh"].get<std::size_t>()];
  const auto& shape = mesh["primitives"][0];
  const auto& coat = json["materials"][shape["material"].get<std::size_t>()];
  CHECK(coat["doubleSided"] == true);
  CHECK(coat["alphaMode"] == "BLEND");
  CHECK(coat["pbrMetallicRoughness"]["baseColorFactor"][3] == 0.4);
  const auto base = glb.floats(shape["attributes"]["POSITION"].get<std::size_t>());
  const std::size_t targets = shape["targets"].size();
  REQUIRE(targets >= 4);
  const auto weights = glb.keys(at, "weights");
  std::vector<double> times;  // one of these is the rest
  for (const float t : glb.times(at, "weights"))
    times.push_back(std::min(0.14, 2.5 * static_cast<double>(t)));
  REQUIRE(times.size() == targets + 1);
  REQUIRE(weights.size() == times.size() * targets);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const VectorXd pose = shown.run.trajectory.positions_at(times[k]);
    const std::vector<int> nodes = {1, 4, 7};
    for (std::size_t v = 0; v < nodes.size(); ++v)
      for (std::size_t c = 0; c < 3; ++c) {
        double x = base[3 * v + c];
        for (std::size_t j = 0; j < targets; ++j)
          x += weights[k * targets + j] *
               glb.floats(shape["targets"][j]["POSITION"].get<std::size_t>())[3 * v + c];
        CHECK(x == Approx(point(pose, nodes[v])[static_cast<Index>(c)])
                       .epsilon(0)
                       .margin(2e-6));  // single precision
      }
  }
}

TEST_CASE(
    "glTF: keys are no farther than an interval apart from the run's start to its end, which is the last") {
  const auto times = [](const Shown& shown, double interval) {
    const testing::Glb glb = shown.glb(interval);
    return glb.floats(glb.json["animations"][0]["samplers"][0]["input"].get<std::size_t>());
  };
  const auto check = [](const std::vector<float>& t, double interval, double span) {
    CHECK(t.front() == 0);
    CHECK(t.back() == Approx(span / 2.5).epsilon(0).margin(1e-8));
    for (std::size_t k = 1; k < t.size(); ++k) {
      CHECK(t[k] > t[k - 1]);
      CHECK(t[k] - t[k - 1] < (interval + 1e-6) / 2.5);
    }
  };
  Shown shown;
  // 0.14 / 0.02 is 7 and a rounding error; a slow motion of as many states needs no more.
  CHECK(times(shown, 0.02).size() == 8);
  for (const double interval : {0.02, 0.04, 0.2}) check(times(shown, interval), interval, 0.14);
  // From 0.06 s on.
  Stepper later(std::make_shared<const Model>(shown.run.trajectory.model()), shown.run.options,
                shown.run.trajectory.state(3));
  while (later.step()) {
  }
  shown.run = later.run();
  REQUIRE(shown.run.trajectory.start_time() == Approx(0.06));
  CHECK(times(shown, 0.02).size() == 5);
  check(times(shown, 0.02), 0.02, 0.08);
}

TEST_CASE("glTF: the camera sees the last pose whole, and it fills the picture") {
  const Shown shown;
  const testing::Glb glb = shown.glb();
  const auto& node = glb.json["nodes"].back();
  const auto& lens = glb.json["cameras"][0]["perspective"];
  const auto place = node["translation"].get<std::vector<double>>(),
             q = node["rotation"].get<std::vector<double>>();
  const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
  const double high = std::tan(0.5 * lens["yfov"].get<double>()),
               wide = high * lens["aspectRatio"].get<double>();
  const VectorXd last = shown.run.trajectory.positions_at(0.14);
  double most = 0;
  for (int n = 0; n < static_cast<int>(shown.structure.node_copies.size()); ++n) {
    const Vec3 at = turn.conjugate() * (point(last, n) - Vec3(place[0], place[1], place[2]));
    REQUIRE(at.z() < -lens["znear"].get<double>());  // it looks along its -z
    most = std::max({most, std::abs(at.x() / at.z()) / wide, std::abs(at.y() / at.z()) / high});
  }
  CHECK(most == Approx(0.85).epsilon(1e-6));
  Vec3 least = point(last, 0), greatest = least;
  for (int n = 0; n < static_cast<int>(shown.structure.node_copies.size()); ++n)
    least = least.cwiseMin(point(last, n)), greatest = greatest.cwiseMax(point(last, n));
  const Vec3 middle = turn.conjugate() * (0.5 * (least + greatest) - Vec3(place[0], place[1], place[2]));
  CHECK(middle.head<2>().norm() < 1e-9 * (greatest - least).norm());  // in the middle of the picture
}

// As soft as rubber: 2 kg on 1.5 m of E A = 700 N swing by 4 cm.
TEST_CASE("glTF: rods that stretch are as long as they are at each key and others have one length") {
  Shown shown;
  shown.run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0.2, 0, 0], fixed = true}, {name = "B", position = [0.2, 0, -1.5], mass = 2},
  {name = "C", position = [0.9, 0, -1.5], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 0.1, area = 1e-3, youngs_modulus = 7e5, elastic = true},
  {nodes = ["B", "C"], mass = 0.1}]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 4
step = 0.01
end_time = 0.3
)");
  const testing::Glb glb = shown.glb();
  for (std::size_t i = 0; i < glb.json["nodes"].size(); ++i) {
    const std::string name = glb.json["nodes"][i].value("name", "");
    if (name == "B-C") CHECK(glb.keys(i, "scale").empty());
    if (name != "A-B") continue;
    const std::vector<float> places = glb.keys(i, "translation"), scale = glb.keys(i, "scale");
    REQUIRE(scale.size() == places.size());
    double least = 9, most = 0;
    for (std::size_t k = 0; k < scale.size(); k += 3) {  // its middle is half of it below A
      const Vec3 half(places[k] - 0.2, places[k + 1], places[k + 2]);
      CHECK(2 * half.norm() == Approx(scale[k + 1]).epsilon(1e-5));
      least = std::min<double>(least, scale[k + 1]), most = std::max<double>(most, scale[k + 1]);
    }
    CHECK(most - least > 0.03);
  }
}

TEST_CASE("an exported cone has its normals across its side") {
  const ShapeMesh cone = unit_cone(16);
  for (std::size_t i = 0; i < 2 * 16; i += 2) {  // base and tip of each side
    const Vec3 base(cone.positions[3 * i], cone.positions[3 * i + 1], cone.positions[3 * i + 2]);
    const Vec3 normal(cone.normals[3 * i], cone.normals[3 * i + 1], cone.normals[3 * i + 2]);
    CHECK(normal.norm() == Approx(1).epsilon(1e-6));
    CHECK(normal.dot(Vec3(0, 0.5, 0) - base) == Approx(0).epsilon(0).margin(1e-6));
    CHECK(normal.dot(Vec3(base.x(), 0, base.z())) > 0);
    // At the tip that of the middle of its side: as far from those of both of its corners.
    const auto of = [&](std::size_t v) {
      return Vec3(cone.normals[v], cone.normals[v + 1], cone.normals[v + 2]);
    };
    const Vec3 tip = of(3 * (i + 1)), next = of(3 * ((i + 2) % 32));
    CHECK(tip.dot(normal) == Approx(tip.dot(next)).epsilon(1e-5));
  }
}

TEST_CASE("glTF: a node at which no rod ends is as large as the middle one of the joints") {
  // Without a radius of its own a rod of 1, 2 or 3 m has a sixtieth of its length, a joint 1.5 of the
  // largest.
  Shown shown;
  shown.run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [3, 0, 0]},
  {name = "C", position = [3, 0, -2]}, {name = "D", position = [4, 0, -2]},
  {name = "P", position = [0, 0, 1], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 1}, {nodes = ["C", "D"], mass = 1}]
[solver]
step = 0.02
end_time = 0.14
)");
  const testing::Glb glb = shown.glb();
  std::map<std::string, double> size;
  for (const auto& node : glb.json["nodes"])
    if (node.contains("scale") && node.contains("name")) size[node["name"]] = node["scale"][0];
  CHECK(size.at("A") == Approx(4.5 / 60));
  CHECK(size.at("B") == Approx(4.5 / 60));
  CHECK(size.at("C") == Approx(3.0 / 60));
  CHECK(size.at("D") == Approx(1.5 / 60));
  CHECK(size.at("P") == Approx(4.5 / 60));
}

}  // namespace gltf_looks_test
