// SPDX-License-Identifier: BSD-3-Clause
// How exported animations stand: upright by gravity, and as exact far from the origin, as on a map.
#include <unistd.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/export/formats.hpp"
#include "core/math/drawing_origin.hpp"
#include "tests/support/glb.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;
namespace fs = std::filesystem;

namespace far_test {

namespace {

struct Swing {
  Simulation run;
  Diagnostics d = diagnose(run);
  fs::path folder = fs::temp_directory_path() / ("unfurl_far_" + std::to_string(::getpid()));

  explicit Swing(const Vec3& at, const Vec3& gravity = {0, 0, -9.81})
      : run(simulate(make_model(moved(at, gravity)), dvm_options(3, 0.05, 1.0))) {}
  ~Swing() { fs::remove_all(folder); }
  std::string exported(const char* format, const char* file) const {
    fs::create_directories(folder);
    find_export_format(format)->write({run, d, folder, "swing", 0.1, 1.0});
    std::ostringstream out;
    out << std::ifstream(folder / file, std::ios::binary).rdbuf();
    return out.str();
  }
  static Structure moved(const Vec3& at, const Vec3& gravity) {
    CustomSpec spec;  // two rods that hang and fall
    spec.nodes = {{"O", at, {0, 0, 0}, 0.0, true},
                  {"A", at + Vec3(1.44, 0, 0), {0, 0, 0}, 0.0, false},
                  {"B", at + Vec3(1.44, 0.3, -0.849), {0, 0, 0}, 0.0, false}};
    spec.rods = {{"OA", {"O", "A"}, 2.0}, {"AB", {"A", "B"}, 1.0}};
    Structure structure = build_custom(spec);
    structure.gravity = gravity;
    return structure;
  }
};

const Vec3 on_a_map(431'234.5, 5'412'345.7, 312.3);

}  // namespace

TEST_CASE("a drawing counts from where the scene does, unless all of it is far away") {
  CHECK(drawing_origin({70, 0, -70}, 1).isZero());
  CHECK(drawing_origin({5, 7, 1}, 0).isZero());  // a point
  const Vec3 given(1000, 0, 0);
  CHECK(drawing_origin({1003, 4, 0}, 1, given) == given);
  for (const double size : {0.02, 1.0, 7.3, 450.0}) {
    const Vec3 center = 1e4 * size * Vec3(1.234567, -0.1, 3.21), origin = drawing_origin(center, size);
    CHECK((center - origin).norm() < 100 * size);  // and the next drawing keeps it
    CHECK(drawing_origin(center, size, origin) == origin);
  }
}

TEST_CASE(
    "glTF: far from the origin keys are as exact as beside it, and the parent node says where they are") {
  const Swing swing(on_a_map);
  const Glb glb(swing.exported("gltf", "animation.glb"));
  const auto parent = glb.json["nodes"][0]["translation"].get<std::vector<double>>();
  // glTF's y is the scene's z, its z the scene's -y.
  const Vec3 origin(parent[0], -parent[2], parent[1]);
  CHECK((origin - on_a_map).norm() < 100);
  int checked = 0;
  for (std::size_t n = 0; n < glb.json["nodes"].size(); ++n) {
    const auto& node = glb.json["nodes"][n];
    const auto& names = swing.run.trajectory.structure().node_copies;
    const auto name = std::ranges::find(names, node["name"].get<std::string>(), &NodeCopy::name);
    if (name == names.end()) continue;
    const auto times = glb.times(n, "translation"), keys = glb.keys(n, "translation");
    REQUIRE(times.size() > 20);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const Vec3 is = origin + Vec3(keys[3 * k], keys[3 * k + 1], keys[3 * k + 2]);
      const Vec3 right = swing.run.trajectory.positions_at(static_cast<double>(times[k]))
                             .segment<3>(3 * (name - names.begin()));
      // 2^-24 of 100 m is 6e-6 m; times in single precision are 6e-8 s off, at up to 10 m/s.
      CHECK((is - right).norm() < 1e-5);
    }
    ++checked;
  }
  CHECK(checked == 3);
  // The camera is beside it, too.
  for (const auto& node : glb.json["nodes"])
    if (node.contains("camera")) CHECK(std::abs(node["translation"][1].get<double>()) < 100);
  CHECK_FALSE(
      Glb(Swing({3, 4, 5}).exported("gltf", "animation.glb")).json["nodes"][0].contains("translation"));
}

TEST_CASE("the page: far from the origin positions are as exact as beside it") {
  const auto data_of = [](const std::string& page) {
    const std::string mark = "type=\"application/json\">";
    const std::size_t at = page.find(mark) + mark.size();
    return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
  };
  const auto far = data_of(Swing(on_a_map).exported("html", "viewer.html"));
  const auto near = data_of(Swing(Vec3::Zero()).exported("html", "viewer.html"));
  const auto origin = far["origin"].get<std::vector<double>>();
  CHECK((Vec3(origin[0], origin[1], origin[2]) - on_a_map).norm() < 100);
  CHECK(near["origin"] == nlohmann::json({0.0, 0.0, 0.0}));
}

TEST_CASE("exported animations stand upright: gravity points down, along any axis") {
  const auto data_of = [](const std::string& page) {
    const std::string mark = "type=\"application/json\">";
    const std::size_t at = page.find(mark) + mark.size();
    return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
  };
  for (const Vec3& gravity : {Vec3(0, 0, -9.81), Vec3(0, -9.81, 0), Vec3(-1, 5, 2)}) {
    const Swing swing(Vec3::Zero(), gravity);
    const Glb glb(swing.exported("gltf", "animation.glb"));
    const auto q = glb.json["nodes"][0]["rotation"].get<std::vector<double>>();
    const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
    // glTF's down is -y.
    CHECK((turn * gravity.normalized() - Vec3(0, -1, 0)).norm() < 1e-12);
    for (const auto& node : glb.json["nodes"]) {
      if (!node.contains("camera")) continue;  // looks down a little, and its own up is above
      const auto r = node["rotation"].get<std::vector<double>>();
      const Eigen::Quaterniond eye = turn * Eigen::Quaterniond(r[3], r[0], r[1], r[2]);
      CHECK((eye * Vec3(0, 0, -1)).y() < -0.3);
      CHECK((eye * Vec3(0, 1, 0)).y() > 0.9);
      CHECK(std::abs((eye * Vec3(1, 0, 0)).y()) < 1e-12);
    }
    const auto page = data_of(swing.exported("html", "viewer.html"));
    const auto numbers = page["upright"].get<std::vector<double>>();
    REQUIRE(numbers.size() == 9);
    const Mat3 upright = Eigen::Map<const Mat3>(numbers.data());
    CHECK((upright * gravity.normalized() - Vec3(0, 0, -1)).norm() < 1e-12);
    CHECK((upright * upright.transpose() - Mat3::Identity()).norm() < 1e-12);
  }
}

}  // namespace far_test
