// SPDX-License-Identifier: BSD-3-Clause
// Every number of every exported file against the run that it is of: a sector, shown as the whole ring, so
// that nodes and rods are copies of others.
#include <unistd.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/export/csv.hpp"
#include "core/export/formats.hpp"
#include "core/export/summary.hpp"
#include "core/export/unit_shapes.hpp"
#include "tests/support/glb.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using testing::Glb, testing::values_of;
namespace fs = std::filesystem;

namespace contents_test {

namespace {

struct Exported {
  Simulation run = testing::run_scene(
      "[structure]\nkind = 'hoop'\nmodel = 'sector'\nunits = 5\n[solver]\nstep = 0.02\nend_time = 0.14\n");
  Diagnostics d = diagnose(run);
  const Structure& structure = run.trajectory.structure();
  std::size_t nodes = structure.node_copies.size(), rods = structure.rod_copies.size(),
              states = run.trajectory.size();
  fs::path folder = fs::temp_directory_path() / ("unfurl_contents_" + std::to_string(::getpid()));

  explicit Exported(const char* format = nullptr) {
    fs::create_directories(folder);
    if (format) find_export_format(format)->write({run, d, folder, "ring", 0.04, 2.5});
    REQUIRE(states == 8);
    REQUIRE(rods == 25);
  }
  ~Exported() { fs::remove_all(folder); }
  std::string text(const std::string& file) const {
    std::ostringstream out;
    out << std::ifstream(folder / file, std::ios::binary).rdbuf();
    return out.str();
  }
  double force(std::size_t i, std::size_t rod) const {
    return d.axial_force(static_cast<Index>(i), structure.rod_copies[rod].source);
  }
  bool unique(std::size_t i, std::size_t rod) const {
    return d.force_unique(static_cast<Index>(i), structure.rod_copies[rod].source);
  }
  const std::string& group(std::size_t rod) const {
    return structure.rods[static_cast<std::size_t>(structure.rod_copies[rod].source)].group;
  }
};

std::string from_base64(std::string_view text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0, count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<unsigned>(digits.find(c));
    if ((count += 6) >= 8) out += static_cast<char>(bits >> (count -= 8) & 255U);
  }
  return out;
}

// The values of a DataArray, behind the 64 bits of their size.
template <class T>
std::vector<T> vtk_array(const std::string& file, const std::string& name) {
  const std::size_t begin = file.find(" Name=\"" + name + "\""), open = file.find('>', begin) + 1;
  REQUIRE(begin != std::string::npos);
  const std::string bytes = from_base64(std::string_view(file).substr(open, file.find('<', open) - open));
  REQUIRE(values_of<std::uint64_t>(bytes.substr(0, 8))[0] == bytes.size() - 8);
  return values_of<T>(std::string_view(bytes).substr(8));
}

template <class T>
std::vector<T> npy_array(const std::string& file, const std::string& type, const std::string& shape) {
  const std::size_t header = values_of<std::uint16_t>(file.substr(8, 2))[0];
  CHECK((10 + header) % 64 == 0);
  CHECK(file[9 + header] == '\n');
  CHECK(file.substr(10, header)
            .starts_with("{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + "), }"));
  return values_of<T>(std::string_view(file).substr(10 + header));
}

using Rows = std::vector<std::vector<std::string>>;
Rows table(const std::string& text) {
  Rows rows;
  std::istringstream file(text);
  for (std::string line; std::getline(file, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

double number(const std::string& cell) {
  return std::strtod(cell.c_str(), nullptr);
}

bool equal(const VectorXd& x, const std::vector<double>& y, std::size_t from = 0) {
  if (y.size() < from + static_cast<std::size_t>(x.size())) return false;
  return x == Eigen::Map<const VectorXd>(y.data() + from, x.size());
}

}  // namespace

TEST_CASE("a VTU holds the whole structure, bit for bit") {
  const Exported e("vtk");
  const Trajectory& t = e.run.trajectory;
  for (std::size_t i = 0; i < e.states; ++i) {
    const std::string file = e.text("vtk/ring_00000" + std::to_string(i) + ".vtu");
    CHECK(equal(t.positions(i), vtk_array<double>(file, "Points")));
    CHECK(equal(t.velocities(i), vtk_array<double>(file, "velocity_m_s")));
    const auto time = file.find("\"TimeValue\""), open = file.find('>', time) + 1;
    CHECK(number(file.substr(open, 30)) == t.time(i));
    const auto ends = vtk_array<std::int64_t>(file, "connectivity"),
               stops = vtk_array<std::int64_t>(file, "offsets"),
               groups = vtk_array<std::int64_t>(file, "group");
    const auto force = vtk_array<double>(file, "axial_force_N");
    const auto unique = vtk_array<std::uint8_t>(file, "axial_force_unique"),
               types = vtk_array<std::uint8_t>(file, "types");
    REQUIRE(force.size() == e.rods);
    REQUIRE(ends.size() == 2 * e.rods);
    const auto radius = vtk_array<double>(file, "radius_m");
    REQUIRE(radius.size() == e.rods);
    for (std::size_t r = 0; r < e.rods; ++r)
      CHECK(radius[r] == e.structure.rods[static_cast<std::size_t>(e.structure.rod_copies[r].source)].radius);
    const std::size_t nodes = e.structure.node_copies.size();
    const auto node_names = vtk_array<std::uint8_t>(file, "name"),
               rod_names = vtk_array<std::uint8_t>(file.substr(file.find("<CellData")), "name"),
               group_names = vtk_array<std::uint8_t>(file, "group_name");
    const auto row = [](const std::vector<std::uint8_t>& all, std::size_t rows, std::size_t r) {
      const auto width = static_cast<std::ptrdiff_t>(all.size() / rows);
      const auto from = all.begin() + static_cast<std::ptrdiff_t>(r) * width;
      const std::string name(from, from + width);
      return name.substr(0, name.find('\0'));
    };
    for (std::size_t n = 0; n < nodes; ++n)
      CHECK(row(node_names, nodes, n) == e.structure.node_copies[n].name);
    std::map<std::string, std::int64_t> numbers;  // in the order in which they appear
    for (std::size_t r = 0; r < e.rods; ++r) {
      const RodCopy& rod = e.structure.rod_copies[r];
      CHECK(force[r] == e.force(i, r));
      CHECK(unique[r] == (e.unique(i, r) ? 1 : 0));
      CHECK(ends[2 * r] == rod.a);
      CHECK(ends[2 * r + 1] == rod.b);
      CHECK(stops[r] == static_cast<std::int64_t>(2 * r + 2));
      CHECK(types[r] == 3);  // VTK_LINE
      CHECK(row(rod_names, e.rods, r) == e.structure.rod_copies[r].name);
      CHECK(row(group_names, e.rods, r) == e.group(r));
      CHECK(groups[r] == numbers.emplace(e.group(r), std::ssize(numbers)).first->second);
    }
  }
  const std::string pvd = e.text("vtk/ring.pvd");
  std::size_t at = 0;
  for (std::size_t i = 0; i < e.states; ++i) {
    at = pvd.find("timestep=\"", at);
    REQUIRE(at != std::string::npos);
    at += 10;
    CHECK(number(pvd.substr(at, 30)) == t.time(i));
    CHECK(pvd.find("ring_00000" + std::to_string(i) + ".vtu", at) - at < 60);
  }
  CHECK(pvd.find("timestep=\"", at) == std::string::npos);
}

TEST_CASE("NumPy arrays hold the whole structure, bit for bit") {
  const Exported e("npy");
  const Trajectory& t = e.run.trajectory;
  const std::string n = std::to_string(e.nodes) + ", ", m = std::to_string(e.rods) + ", ";
  const auto time = npy_array<double>(e.text("npy/t_s.npy"), "<f8", "8, "),
             x = npy_array<double>(e.text("npy/positions_m.npy"), "<f8", "8, " + n + "3, "),
             v = npy_array<double>(e.text("npy/velocities_m_s.npy"), "<f8", "8, " + n + "3, "),
             force = npy_array<double>(e.text("npy/axial_forces_N.npy"), "<f8", "8, " + m);
  const auto unique = npy_array<std::uint8_t>(e.text("npy/axial_forces_unique.npy"), "|b1", "8, " + m);
  const auto ends = npy_array<std::int64_t>(e.text("npy/rod_nodes.npy"), "<i8", m + "2, ");
  REQUIRE(x.size() == 8 * 3 * e.nodes);
  REQUIRE(v.size() == x.size());
  REQUIRE(force.size() == 8 * e.rods);
  REQUIRE(unique.size() == force.size());
  REQUIRE(ends.size() == 2 * e.rods);
  for (std::size_t i = 0; i < e.states; ++i) {
    CHECK(time[i] == t.time(i));
    CHECK(equal(t.positions(i), x, 3 * e.nodes * i));
    CHECK(equal(t.velocities(i), v, 3 * e.nodes * i));
    for (std::size_t r = 0; r < e.rods; ++r) {
      CHECK(force[e.rods * i + r] == e.force(i, r));
      CHECK(unique[e.rods * i + r] == (e.unique(i, r) ? 1 : 0));
    }
  }
  for (std::size_t r = 0; r < e.rods; ++r) {
    CHECK(ends[2 * r] == e.structure.rod_copies[r].a);
    CHECK(ends[2 * r + 1] == e.structure.rod_copies[r].b);
  }
}

TEST_CASE("tables hold the whole structure, bit for bit, long and wide") {
  const Exported e("csv");
  const Trajectory& t = e.run.trajectory;
  const Rows nodes = table(e.text("csv/nodes.csv")), rods = table(e.text("csv/rods.csv"));
  REQUIRE(nodes.size() == 1 + e.states * e.nodes);
  REQUIRE(rods.size() == 1 + e.states * e.rods);
  write_trajectory_csv(e.folder / "wide.csv", t);
  write_rod_forces_csv(e.folder / "forces.csv", t, e.d);
  const Rows wide = table(e.text("wide.csv")), forces = table(e.text("forces.csv"));
  REQUIRE(wide.size() == 1 + e.states);
  REQUIRE(forces.size() == 1 + e.states);
  const std::vector<std::string> suffixes = {".x_m", ".y_m", ".z_m", ".vx_m_s", ".vy_m_s", ".vz_m_s"};
  for (std::size_t i = 0; i < e.states; ++i) {
    const VectorXd x = t.positions(i), v = t.velocities(i);
    CHECK(number(wide[1 + i][0]) == t.time(i));
    CHECK(number(forces[1 + i][0]) == t.time(i));
    REQUIRE(wide[1 + i].size() == 1 + 6 * e.nodes);
    REQUIRE(forces[1 + i].size() == 1 + 2 * e.rods);
    for (std::size_t n = 0; n < e.nodes; ++n) {
      const auto& row = nodes[1 + e.nodes * i + n];
      REQUIRE(row.size() == 8);
      CHECK(number(row[0]) == t.time(i));
      CHECK(row[1] == e.structure.node_copies[n].name);
      for (std::size_t k = 0; k < 6; ++k) {
        const double value = k < 3 ? x[static_cast<Index>(3 * n + k)] : v[static_cast<Index>(3 * n + k - 3)];
        CHECK(number(row[2 + k]) == value);
        CHECK(number(wide[1 + i][1 + 6 * n + k]) == value);
        CHECK(wide[0][1 + 6 * n + k] == row[1] + suffixes[k]);
      }
    }
    for (std::size_t r = 0; r < e.rods; ++r) {
      const RodCopy& rod = e.structure.rod_copies[r];
      const auto& row = rods[1 + e.rods * i + r];
      REQUIRE(row.size() == 8);
      CHECK(number(row[0]) == t.time(i));
      CHECK(row[1] == rod.name);
      CHECK(row[2] == e.structure.node_copies[static_cast<std::size_t>(rod.a)].name);
      CHECK(row[3] == e.structure.node_copies[static_cast<std::size_t>(rod.b)].name);
      CHECK(row[4] == e.group(r));
      CHECK(number(row[5]) == (x.segment<3>(3 * rod.b) - x.segment<3>(3 * rod.a)).norm());
      for (const std::string& cell : {row[6], forces[1 + i][1 + r]}) CHECK(number(cell) == e.force(i, r));
      for (const std::string& cell : {row[7], forces[1 + i][1 + e.rods + r]})
        CHECK(cell == (e.unique(i, r) ? "1" : "0"));
    }
  }
}

TEST_CASE("glTF: every rod and joint of the whole is where it was") {
  const Exported e("gltf");
  const Glb glb(e.text("animation.glb"));
  const auto& nodes = glb.json["nodes"];
  // Two fittings each, arrows of a shaft and a head in a node, and a camera.
  const std::size_t loads = e.structure.load_copies.size();
  REQUIRE(nodes.size() == 1 + e.rods + e.nodes + 2 * e.rods + 3 * loads + 1);
  REQUIRE(nodes[0]["children"].size() == e.rods + e.nodes + loads + 1);
  // z up becomes y up, x stays.
  const auto root = nodes[0]["rotation"].get<std::vector<double>>();
  const Eigen::Quaterniond up(root[3], root[0], root[1], root[2]);
  CHECK((up * Vec3::UnitZ() - Vec3::UnitY()).norm() <= 1e-15);
  CHECK((up * Vec3::UnitX() - Vec3::UnitX()).norm() <= 1e-15);
  // Every 0.04 s of the motion from 0 to 0.14 s and where it turns fast, the end included, 2.5 times as fast.
  const auto times = glb.times(1, "rotation");
  std::vector<double> shown;
  for (const float time : times) shown.push_back(2.5 * static_cast<double>(time));
  REQUIRE(shown.size() >= 5);
  CHECK(shown.front() == 0);
  CHECK(shown.back() == Approx(0.14));
  for (std::size_t k = 1; k < shown.size(); ++k) CHECK(shown[k] - shown[k - 1] <= 0.04 + 1e-6);
  const auto point = [](const std::vector<float>& x, std::size_t k) {
    return Vec3(x[3 * k], x[3 * k + 1], x[3 * k + 2]);
  };
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const VectorXd x = e.run.trajectory.positions_at(shown[k]);
    for (std::size_t r = 0; r < e.rods; ++r) {
      const RodCopy& rod = e.structure.rod_copies[r];
      const Vec3 a = x.segment<3>(3 * rod.a), b = x.segment<3>(3 * rod.b);
      const auto turns = glb.keys(1 + r, "rotation");
      const Eigen::Quaterniond turn(turns[4 * k + 3], turns[4 * k], turns[4 * k + 1], turns[4 * k + 2]);
      // Single precision of some metres.
      CHECK((point(glb.keys(1 + r, "translation"), k) - 0.5 * (a + b)).norm() <= 1e-6);
      CHECK((turn * Vec3::UnitY() - (b - a).normalized()).norm() <= 1e-6);
    }
    for (std::size_t n = 0; n < e.nodes; ++n)
      CHECK((point(glb.keys(1 + e.rods + n, "translation"), k) - x.segment<3>(3 * static_cast<Index>(n)))
                .norm() <= 1e-6);
  }
}

TEST_CASE("glTF: rods and joints have names, places, sizes and the colours of their groups") {
  const Exported e("gltf");
  const Glb glb(e.text("animation.glb"));
  const auto& json = glb.json;
  std::map<std::string, std::size_t> mesh_of;
  for (std::size_t r = 0; r < e.rods; ++r) {
    const auto& node = json["nodes"][1 + r];
    const Rod& source = e.structure.rods[static_cast<std::size_t>(e.structure.rod_copies[r].source)];
    CHECK(node["name"] == e.structure.rod_copies[r].name);
    CHECK(mesh_of.emplace(source.group, node["mesh"].get<std::size_t>()).first->second == node["mesh"]);
    for (const char* path : {"translation", "rotation"}) {  // at rest it is as in the last frame
      const auto last = node[path].get<std::vector<float>>(), keys = glb.keys(1 + r, path);
      CHECK(std::equal(last.rbegin(), last.rend(), keys.rbegin()));
    }
    CHECK(node["scale"][0].get<double>() == Approx(source.radius).epsilon(1e-6));
    CHECK(node["scale"][1].get<double>() == Approx(source.length).epsilon(1e-6));
    CHECK(node["scale"][2] == node["scale"][0]);
    CHECK(glb.keys(1 + r, "scale").empty());  // rigid rods stretch nowhere
  }
  for (std::size_t n = 0; n < e.nodes; ++n) {
    const auto& node = json["nodes"][1 + e.rods + n];
    CHECK(node["name"] == e.structure.node_copies[n].name);
    CHECK(node["mesh"] == mesh_of.size() + 1);
    double thickest = 0;  // joints stand out by half of the thickest rod's radius
    for (const RodCopy& rod : e.structure.rod_copies)
      if (rod.a == static_cast<int>(n) || rod.b == static_cast<int>(n))
        thickest = std::max(thickest, e.structure.rods[static_cast<std::size_t>(rod.source)].radius);
    CHECK(node["scale"][1].get<double>() == Approx(1.5 * thickest).epsilon(1e-6));
  }
  // A mesh with a colour of its own for each group, one for fittings, one for joints, two for arrows.
  REQUIRE(mesh_of.size() >= 2);
  CHECK(json["meshes"].size() == mesh_of.size() + 4);
  std::set<std::vector<double>> colours;
  for (const auto& [group, mesh] : mesh_of) {
    CHECK(json["meshes"][mesh]["name"] == group);
    const auto at = json["meshes"][mesh]["primitives"][0]["material"].get<std::size_t>();
    const auto colour = json["materials"][at]["pbrMetallicRoughness"]["baseColorFactor"];
    CHECK(json["materials"][at]["name"] == group);
    CHECK(colours.insert(colour.get<std::vector<double>>()).second);
  }
}

TEST_CASE("exported shapes have the normals of their faces and the size of their names") {
  for (const int sides : {6, 16, 25}) {
    int shape = 0;
    for (const ShapeMesh& mesh : {unit_cylinder(sides), unit_sphere(sides)}) {
      INFO(sides << " sides, shape " << shape);
      const auto vertex = [&](const std::vector<float>& of, std::size_t i) {
        return Vec3(of[3 * i], of[3 * i + 1], of[3 * i + 2]);
      };
      REQUIRE(mesh.positions.size() == mesh.normals.size());
      double high = 0;
      for (std::size_t i = 0; 3 * i < mesh.positions.size(); ++i) {
        const Vec3 p = vertex(mesh.positions, i), n = vertex(mesh.normals, i);
        CHECK(n.norm() == Approx(1).epsilon(1e-6));
        high = std::max(high, p.y());
        if (shape == 1) {
          CHECK(p.norm() == Approx(1).epsilon(1e-6));
          CHECK((p - n).norm() <= 1e-6);
        } else if (std::hypot(p.x(), p.z()) > 1e-6) {  // but for the middles of the caps
          CHECK(std::hypot(p.x(), p.z()) == Approx(1).epsilon(1e-6));
          CHECK(std::abs(p.y()) == Approx(0.5));
        }
      }
      CHECK(high == Approx(shape == 1 ? 1.0 : 0.5));
      REQUIRE(mesh.triangles.size() % 3 == 0);
      std::map<std::pair<int, int>, int> edges;  // by place, as a mesh may list a vertex for each normal
      std::map<std::vector<long>, int> places;
      const auto place = [&](std::size_t i) {
        const Vec3 p = vertex(mesh.positions, i);
        return places
            .emplace(
                std::vector{std::lround(1e5 * p.x()), std::lround(1e5 * p.y()), std::lround(1e5 * p.z())},
                static_cast<int>(places.size()))
            .first->second;
      };
      for (std::size_t k = 0; k < mesh.triangles.size(); k += 3) {
        const std::size_t i[3] = {mesh.triangles[k], mesh.triangles[k + 1], mesh.triangles[k + 2]};
        for (const std::size_t corner : i) REQUIRE(3 * corner < mesh.positions.size());
        const Vec3 a = vertex(mesh.positions, i[0]);
        const Vec3 face =
            (vertex(mesh.positions, i[1]) - a).cross(vertex(mesh.positions, i[2]) - a).normalized();
        // No vertex normal is further from its face than a band of the coarsest mesh is wide.
        for (const std::size_t corner : i)
          CHECK(face.dot(vertex(mesh.normals, corner)) >= std::cos(2 * pi / sides));
        for (int c = 0; c < 3; ++c) ++edges[{place(i[c]), place(i[(c + 1) % 3])}];
      }
      for (const auto& [edge, count] : edges) {  // closed: each edge once either way
        CHECK(count == 1);
        CHECK(edges.count({edge.second, edge.first}) == 1);
      }
      ++shape;
    }
  }
}

TEST_CASE("what a summary says of a run is the run's") {
  // Thrown up at 3 m/s beside a drive that lifts another ball; a floor takes 3/4 of the first one's energy.
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0.1, 0.2, 0.7], velocity = [0.4, 0, 3], mass = 1.7},
  {name = "B", position = [2, 0, 0], mass = 0.9}]
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["A"]
direction = [0, 0, 1]
min = 0.2
restitution = 0.5
[[constraints]]
kind = "coordinate"
name = "lift"
nodes = ["B"]
direction = [0, 0, 1]
motion = "rate"
rate = 0.6
[gravity]
acceleration = [0, 0, -10]
[solver]
step = 0.03
stages = 4
end_time = 0.9
)");
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  const Model& model = run.trajectory.model();
  const auto json = nlohmann::json::parse(
      summary_json("throw", run, d, analyse_mobility(model.system, run.trajectory.node_positions(0))));
  CHECK(json["solver"]["method"] == "dvm");
  CHECK(json["solver"]["stages"] == 4);
  CHECK(json["solver"]["step_s"] == 0.03);
  CHECK(json["solver"]["steps"] == run.steps);
  CHECK(json["solver"]["newton_iterations"] == run.newton_iterations);
  CHECK(json["solver"]["cpu_s"] == run.cpu_s);
  // 0.5 = 3 t - 5 t^2 downwards again: t = (3 + sqrt 19) / 10, with sqrt 19 m/s.
  REQUIRE(json["events"].size() == 1);
  CHECK(json["events"][0]["name"] == "stop floor");
  CHECK(json["events"][0]["t_s"].get<double>() == Approx((3 + std::sqrt(19.0)) / 10).epsilon(1e-11));
  CHECK(json["events"][0]["energy_lost_J"].get<double>() == Approx(0.75 * 0.5 * 1.7 * 19).epsilon(1e-10));
  CHECK_FALSE(json["events"][0].contains("singular_value"));
  CHECK(json["drives"]["lift"]["peak_force_N"].get<double>() == Approx(9).epsilon(1e-9));
  CHECK(json["drives"]["lift"]["peak_power_W"].get<double>() == Approx(5.4).epsilon(1e-9));
  CHECK(json["drives"]["lift"]["peak_energy_J"].get<double>() == Approx(5.4 * 0.9).epsilon(1e-9));
  const std::size_t last = run.trajectory.size() - 1;
  for (int n = 0; n < 2; ++n)
    for (int k = 0; k < 3; ++k) {
      CHECK(json["final"]["positions_m"][n == 0 ? "A" : "B"][static_cast<std::size_t>(k)] ==
            run.trajectory.positions(last)[3 * n + k]);
      CHECK(json["final"]["velocities_m_s"][n == 0 ? "A" : "B"][static_cast<std::size_t>(k)] ==
            run.trajectory.velocities(last)[3 * n + k]);
    }
  CHECK(json["final"]["t_s"] == 0.9);
  // Fastest right before the floor: 0.4 m/s along, sqrt 19 m/s down; B's energy is 0.162 J throughout.
  CHECK(json["measures"]["peak_speed_m_s"].get<double>() == Approx(std::sqrt(19 + 0.16)).epsilon(1e-9));
  CHECK(json["measures"]["peak_energy_J"].get<double>() == Approx(0.5 * 1.7 * 19.16 + 0.162).epsilon(1e-9));
  CHECK(json["measures"]["deploy_time_s"].is_null());
  CHECK(json["forces"]["rods"] == 0);
}

}  // namespace contents_test
