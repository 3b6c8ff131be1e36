// SPDX-License-Identifier: BSD-3-Clause
// Exports, read back with nothing but their specifications (tests/support/check_exports.py uses other
// people's readers).
#include <unistd.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/export/formats.hpp"
#include "core/export/unit_shapes.hpp"
#include "core/text/base64.hpp"
#include "tests/support/glb.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;
namespace fs = std::filesystem;

namespace formats_test {

namespace {

struct Exported {
  Simulation run = simulate(make_model(double_pendulum()), dvm_options(3, 0.05, 1.0));
  Diagnostics diagnostics = diagnose(run);
  fs::path directory = fs::temp_directory_path() / ("unfurl_export_" + std::to_string(::getpid()));

  explicit Exported(const char* format) {
    fs::create_directories(directory);
    find_export_format(format)->write({run, diagnostics, directory, "swing", 0.1, 2.0});
  }
  ~Exported() { fs::remove_all(directory); }
  std::string text(const char* file) const {
    std::ostringstream out;
    out << std::ifstream(directory / file, std::ios::binary).rdbuf();
    return out.str();
  }
};

std::string plain(const std::string& text) {
  return base64(std::as_bytes(std::span(text.data(), text.size())));
}

double volume(const ShapeMesh& mesh) {
  const auto at = [&](std::size_t i) {
    const float* p = &mesh.positions[3 * mesh.triangles[i]];
    return Vec3(p[0], p[1], p[2]);
  };
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) sum += at(i).dot(at(i + 1).cross(at(i + 2))) / 6;
  return sum;
}

}  // namespace

TEST_CASE("base64: the vectors of RFC 4648") {
  CHECK(plain("") == "");
  CHECK(plain("f") == "Zg==");
  CHECK(plain("fo") == "Zm8=");
  CHECK(plain("foo") == "Zm9v");
  CHECK(plain("foobar") == "Zm9vYmFy");
}

TEST_CASE("exported shapes are closed and look outward: the divergence theorem gives their volume") {
  // A regular 16-gon fills sin(2 pi / 16) / (2 pi / 16) = 0.9745 of its circle; a faceted sphere fills less.
  CHECK(volume(unit_cylinder(16)) == Approx(8 * std::sin(pi / 8)).epsilon(1e-6));  // floats
  CHECK(volume(unit_sphere(16)) > 0.92 * 4 * pi / 3);
  CHECK(volume(unit_sphere(16)) < 4 * pi / 3);
  // A cone on a 16-gon; and no vertex of any of them stands apart.
  CHECK(volume(unit_cone(16)) == Approx(8 * std::sin(pi / 8) / 3).epsilon(1e-6));
  for (const ShapeMesh& mesh : {unit_cylinder(11), unit_cone(11), unit_sphere(12)}) {
    std::set<std::uint16_t> used(mesh.triangles.begin(), mesh.triangles.end());
    CHECK(mesh.positions.size() == 3 * used.size());
    CHECK(mesh.normals.size() == mesh.positions.size());
    CHECK(*used.rbegin() + 1U == used.size());
  }
}

TEST_CASE("a VTU of each state and their times in the PVD") {
  const Exported e("vtk");
  const std::string pvd = e.text("vtk/swing.pvd");
  CHECK(pvd.find("<DataSet timestep=\"0.05\" part=\"0\" file=\"swing_000001.vtu\"/>") != std::string::npos);
  const std::string vtu = e.text("vtk/swing_000020.vtu");
  CHECK(vtu.find("NumberOfPoints=\"3\" NumberOfCells=\"2\"") != std::string::npos);
  const VectorXd x = e.run.trajectory.positions(20);
  const std::uint64_t size = 72;
  std::string body(reinterpret_cast<const char*>(&size), 8);
  body.append(reinterpret_cast<const char*>(x.data()), 72);
  CHECK(vtu.find("Name=\"Points\" NumberOfComponents=\"3\" format=\"binary\">" + plain(body)) !=
        std::string::npos);
  CHECK(vtu.find("Name=\"axial_force_N\"") != std::string::npos);
  CHECK(vtu.find("<DataArray type=\"UInt8\" Name=\"axial_force_unique\"") != std::string::npos);
}

TEST_CASE("a VTK export leaves no states of a longer run that was there before") {
  const Exported e("vtk");
  const Simulation shorter = simulate(make_model(double_pendulum()), dvm_options(3, 0.05, 0.5));
  const Diagnostics diagnostics = diagnose(shorter);
  for (const char* kept : {"swinging_000012.vtu", "swing_12.vtu", "notes.txt"})
    std::ofstream(e.directory / "vtk" / kept) << "mine";
  find_export_format("vtk")->write({shorter, diagnostics, e.directory, "swing", 0.1, 2.0});
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(e.directory / "vtk")) names.insert(entry.path().filename());
  CHECK(names.contains("swing_000010.vtu"));
  CHECK_FALSE(names.contains("swing_000011.vtu"));
  CHECK_FALSE(names.contains("swing_000020.vtu"));
  CHECK(names.size() == 11 + 1 + 3);  // states, their list, and what is nobody's of ours
}

TEST_CASE("NPY arrays hold the trajectory in C order") {
  const Exported e("npy");
  const std::string file = e.text("npy/positions_m.npy");
  REQUIRE(file.size() > 10);
  CHECK(file.substr(0, 8) == std::string("\x93NUMPY\x01\x00", 8));
  const auto header = values_of<std::uint16_t>(file.substr(8, 2))[0];
  CHECK((10 + header) % 64 == 0);
  CHECK(file.substr(10, header)
            .starts_with("{'descr': '<f8', 'fortran_order': False, 'shape': (21, 3, 3, ), }"));
  const auto values = values_of<double>(std::string_view(file).substr(10U + header));
  REQUIRE(values.size() == 21 * 9);
  const VectorXd x = e.run.trajectory.positions(7);
  for (std::size_t k = 0; k < 9; ++k) CHECK(values[7 * 9 + k] == x[static_cast<Index>(k)]);
}

namespace {

// The JSON between the two tags of a page, and an array of it as numbers.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script id=\"data\" type=\"application/json\">";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

template <class T = float>
std::vector<T> unpacked(const nlohmann::json& text) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text.get<std::string>()) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> static_cast<unsigned>(count -= 8) & 255U);
  }
  return values_of<T>(bytes);
}

}  // namespace

TEST_CASE(
    "a page holds the motion at its frames, the forces, the curves and the words, and nothing from "
    "elsewhere") {
  const Exported e("html");
  const std::string page = e.text("viewer.html");
  const auto data = data_of(page);
  // 1 s of motion with steps of 0.05 s: every state is a key, and there are some in between.
  const auto moments = unpacked<double>(data["moments"]);
  const auto positions = unpacked(data["positions"]), forces = unpacked(data["forces"]);
  REQUIRE(data["frames"] == moments.size());
  REQUIRE(positions.size() == moments.size() * 9);
  REQUIRE(forces.size() == moments.size() * 2);
  std::size_t states = 0;
  for (std::size_t k = 0; k < moments.size(); ++k) {
    const VectorXd x = e.run.trajectory.positions_at(moments[k]);
    // 2^-24 of single precision, of coordinates up to 2 m.
    for (std::size_t i = 0; i < 9; ++i)
      CHECK(std::abs(positions[9 * k + i] - x[static_cast<Index>(i)]) < 2.4e-7);
    const auto state = static_cast<Index>(std::lround(moments[k] / 0.05));
    if (std::abs(moments[k] - 0.05 * static_cast<double>(state)) > 1e-9) continue;
    ++states;
    for (std::size_t r = 0; r < 2; ++r) {
      const double force = e.diagnostics.axial_force(state, static_cast<Index>(r));
      CHECK(std::abs(forces[2 * k + r] - force) < 2e-7 * std::abs(force) + 1e-30);
    }
  }
  CHECK(states == 21);
  CHECK(data["rods"][1][4] == "AB");
  CHECK(data["columns"].size() == e.diagnostics.columns.size());
  const auto times = unpacked<double>(data["times"]);
  REQUIRE(times.size() == e.diagnostics.t.size());  // few states: all of them
  for (std::size_t c = 0; c < e.diagnostics.columns.size(); ++c) {
    const Series& column = e.diagnostics.columns[c];
    CHECK(data["columns"][c]["name"] == column.name);
    const auto values = unpacked<double>(data["columns"][c]["values"]);
    REQUIRE(values.size() == times.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
      CHECK(times[i] == e.diagnostics.t[i]);
      CHECK((values[i] == column.values[i] || (std::isnan(values[i]) && std::isnan(column.values[i]))));
    }
  }
  CHECK(page.find("http") == std::string::npos);
  CHECK(page.find("@DATA@") == std::string::npos);
}

TEST_CASE("a page says why its peak is not unique") {
  Exported e("html");
  const auto fact = [&] {
    find_export_format("html")->write({e.run, e.diagnostics, e.directory, "swing", 0.1, 2.0});
    const std::string page = e.text("viewer.html");
    return std::pair(page.find("one choice of many)") != std::string::npos,
                     page.find("waves of elastic rods") != std::string::npos);
  };
  CHECK(fact() == std::pair(false, false));
  e.diagnostics.force_unique.setConstant(false);  // as waves do: the model determines both rods
  CHECK(fact() == std::pair(false, true));
  e.diagnostics.rod_unique.assign(2, 0);
  CHECK(fact() == std::pair(true, false));
}

TEST_CASE("a page keeps a peak of one state among many, and no warning that names a file") {
  Exported e("html");
  Diagnostics d = e.diagnostics;
  const std::size_t states = 30'001;
  d.t.resize(states);
  for (std::size_t i = 0; i < states; ++i) d.t[i] = static_cast<double>(i) / 30'000;
  for (Series& column : d.columns) column.values.assign(states, 0.0);
  d.columns.front().values[12'345] = 7;
  d.columns.back().values[23'456] = -3;
  e.run.warnings = {"/tmp/x/s.toml:3:4: structure.rod_model: does nothing", "the run's own"};
  const std::vector<std::string> about_text = {e.run.warnings.front()};
  find_export_format("html")->write(
      {e.run, d, e.directory, "swing", 0.1, 2.0, {}, {}, {}, nullptr, about_text});
  const std::string page = e.text("viewer.html");
  const auto data = data_of(page);
  const auto times = unpacked<double>(data["times"]);
  CHECK(times.size() < 1500);
  for (const auto& [column, at, value] :
       {std::tuple{std::size_t{0}, 12'345, 7.0}, {d.columns.size() - 1, 23'456, -3.0}}) {
    const auto values = unpacked<double>(data["columns"][column]["values"]);
    const auto found = std::ranges::find(values, value);
    REQUIRE(found != values.end());
    CHECK(times[static_cast<std::size_t>(found - values.begin())] == d.t[static_cast<std::size_t>(at)]);
  }
  CHECK(page.find("/tmp/x") == std::string::npos);
  CHECK(data["warnings"][0] == "the run's own");
}

TEST_CASE("forces in a page are those of the run however briefly they last") {
  // A kilonewton for 5 ms along a rod that hangs at rest, 3 kg at its end: the rod bears m g and the pulse.
  const Simulation run = run_scene(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', "
      "position = [0, 0, -1], mass = 3}]\nrods = [{nodes = ['A', 'B'], mass = 0}]\n[[forces]]\n"
      "kind = 'load_over_time'\nnodes = ['B']\nforce = [0, 0, -1000]\ntimes = [1.51, 1.51, 1.515, 1.515]\n"
      "values = [0, 1, 1, 0]\n[gravity]\nacceleration = [0, 0, -10]\n[solver]\nstep = 0.001\nend_time = "
      "4\n");
  const Diagnostics d = diagnose(run);
  const fs::path directory = fs::temp_directory_path() / ("unfurl_pulse_" + std::to_string(::getpid()));
  fs::create_directories(directory);
  find_export_format("html")->write({run, d, directory, "pulse", 1.0 / 30, 1.0});
  std::ostringstream page;
  page << std::ifstream(directory / "viewer.html", std::ios::binary).rdbuf();
  fs::remove_all(directory);
  const auto data = data_of(page.str());
  const auto moments = unpacked<double>(data["moments"]);
  const auto forces = unpacked(data["forces"]);
  CHECK(data["largest_force"] == Approx(1030));
  CHECK(data["full_force"] == Approx(30));  // the pulse is 5 states of 4001
  // At every state within a fiftieth of what has full colours; few keys more than the motion, which rests,
  // has.
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const double t = run.trajectory.time(i);
    const auto after = std::ranges::upper_bound(moments, t);
    const auto k = static_cast<std::size_t>(after - moments.begin()) - 1;
    const double u = after == moments.end() ? 0 : (t - moments[k]) / (*after - moments[k]);
    const double shown = u > 0 ? (1 - u) * forces[k] + u * forces[k + 1] : forces[k];
    CHECK(std::abs(shown - d.axial_force(static_cast<Index>(i), 0)) < 0.02 * 30);
  }
  CHECK(moments.size() < 260);
  CHECK(data["warnings"].empty());
}

TEST_CASE("words in a page cannot leave their place") {
  const Exported e("html");
  const std::string evil = "</script><script>alert(1)</script> & \xff";
  find_export_format("html")->write({e.run, e.diagnostics, e.directory, "swing", 0.1, 2.0, evil, evil, evil});
  const std::string page = e.text("viewer.html");
  CHECK(page.find("alert(1)</script>") == std::string::npos);
  CHECK(page.find("<title>&lt;/script&gt;") != std::string::npos);
  CHECK(data_of(page)["scene"].get<std::string>().starts_with("</script><script>alert(1)</script> & "));
}

TEST_CASE("a title that looks like the page's own marks is a title") {
  const Exported e("html");
  const std::string title = "@DATA@ and @TITLE@";
  find_export_format("html")->write({e.run, e.diagnostics, e.directory, "swing", 0.1, 2.0, title});
  const std::string page = e.text("viewer.html");
  CHECK(page.find("<title>" + title + "</title>") != std::string::npos);
  CHECK(data_of(page)["title"] == title);
}

TEST_CASE("long tables have a row per state and member") {
  const Exported e("csv");
  const std::string nodes = e.text("csv/nodes.csv"), rods = e.text("csv/rods.csv");
  CHECK(nodes.starts_with("t_s,node,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s\n0,O,0,0,0,0,0,0\n"));
  CHECK(std::count(nodes.begin(), nodes.end(), '\n') == 1 + 21 * 3);
  CHECK(rods.starts_with(
      "t_s,rod,node_a,node_b,group,length_m,axial_force_N,axial_force_unique\n0,OA,O,A,rod,1,"));
  CHECK(std::count(rods.begin(), rods.end(), '\n') == 1 + 21 * 2);
}

TEST_CASE("glTF: keys put the ends of every rod on its nodes") {
  const Exported e("gltf");
  const std::string file = e.text("animation.glb");
  const auto head = values_of<std::uint32_t>(file.substr(0, 20));
  REQUIRE(file.starts_with("glTF"));
  CHECK(head[1] == 2);
  CHECK(head[2] == file.size());
  const Glb glb(file);
  const auto times = glb.times(1, "rotation");
  REQUIRE(times.size() >= 21);                     // 1 s of motion with a state every 0.05 s
  CHECK(times.back() == Approx(0.5));              // at double speed
  for (std::size_t node = 1; node <= 2; ++node) {  // the rods follow the root
    const auto& rod = e.run.trajectory.structure().rod_copies[node - 1];
    CHECK(glb.json["nodes"][node]["name"] == rod.name);
    const float length = glb.json["nodes"][node]["scale"][1];
    const auto p = glb.keys(node, "translation"), r = glb.keys(node, "rotation");
    REQUIRE(r.size() == 4 * times.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
      const VectorXd x = e.run.trajectory.positions_at(2 * static_cast<double>(times[i]));
      const Eigen::Quaternionf turn(r[4 * i + 3], r[4 * i], r[4 * i + 1], r[4 * i + 2]);
      const Eigen::Vector3f end =
          Eigen::Vector3f(p[3 * i], p[3 * i + 1], p[3 * i + 2]) + turn * Eigen::Vector3f(0, 0.5f * length, 0);
      // The length is that at t = 0, between states the dense output stretches rods by 1e-4 at this step.
      CHECK((end.cast<double>() - x.segment<3>(3 * rod.b)).norm() <= 1e-3);
    }
  }
}

TEST_CASE("every rotation in a glTF file has length 1") {
  const Exported out("gltf");
  const Glb glb(out.text("animation.glb"));
  int nodes = 0, keys = 0;
  const auto is_unit = [](const auto& x) {
    return std::abs(
               std::hypot(std::hypot(double(x[0]), double(x[1])), std::hypot(double(x[2]), double(x[3]))) -
               1) < 1e-6;  // single precision
  };
  for (const auto& node : glb.json["nodes"]) {
    if (!node.contains("rotation")) continue;
    CHECK(is_unit(node["rotation"].get<std::vector<double>>()));
    ++nodes;
  }
  for (std::size_t a = 0; a < glb.json["accessors"].size(); ++a) {
    if (glb.json["accessors"][a]["type"] != "VEC4") continue;
    const auto floats = glb.floats(a);
    for (std::size_t i = 0; i < floats.size(); i += 4) CHECK(is_unit(&floats[i]));
    ++keys;
  }
  CHECK(nodes >= 1);
  CHECK(keys >= 2);  // both rods turn
}

TEST_CASE("glTF: nodes at which no rod ends are there too") {
  CustomSpec spec;  // a stone that falls beside a rod, and one alone
  spec.nodes = {{"O", {0, 0, 0}, {0, 0, 0}, 0.0, true},
                {"A", {1, 0, 0}, {0, 0, 0}, 0.0, false},
                {"stone", {2, 0, 3}, {0, 0, 0}, 1.5, false}};
  spec.rods = {{"OA", {"O", "A"}, 2.0}};
  CustomSpec lonely;
  lonely.nodes = {{"stone", {2, 0, 3}, {0, 0, 0}, 1.5, false}};
  for (const CustomSpec& given : {spec, lonely}) {
    Structure structure = build_custom(given);
    structure.gravity = {0, 0, -9.81};
    const Simulation run = simulate(make_model(structure), dvm_options(3, 0.05, 0.5));
    const Diagnostics diagnostics = diagnose(run);
    const fs::path directory = fs::temp_directory_path() / ("unfurl_stone_" + std::to_string(::getpid()));
    fs::create_directories(directory);
    find_export_format("gltf")->write({run, diagnostics, directory, "fall", 0.1, 1.0});
    std::ostringstream file;
    file << std::ifstream(directory / "animation.glb", std::ios::binary).rdbuf();
    fs::remove_all(directory);
    const nlohmann::json json = Glb(file.str()).json;
    std::size_t found = 0;
    for (const auto& node : json["nodes"]) {
      if (node["name"] != "stone") continue;
      ++found;
      CHECK(node["translation"][0] == 2.0);  // at rest as at the end, 0.5 s later
      CHECK(node["translation"][2].get<double>() == Approx(3.0 - 0.5 * 9.81 * 0.25).epsilon(1e-6));
      CHECK(node["scale"][0].get<double>() > 0);
    }
    CHECK(found == 1);
    CHECK(json["nodes"][0]["children"].size() == given.rods.size() + given.nodes.size() + 1);  // and a camera
  }
}

TEST_CASE("glTF: what accessors say of the buffer is so") {
  const Exported out("gltf");
  const std::string file = out.text("animation.glb");
  const Glb glb(file);
  // Whole words throughout, as GLB wants them.
  const std::size_t text = values_of<std::uint32_t>(file.substr(12, 4))[0];
  CHECK(values_of<std::uint32_t>(file.substr(8, 4))[0] == file.size());
  CHECK(text % 4 == 0);
  CHECK(values_of<std::uint32_t>(file.substr(20 + text, 4))[0] == glb.data.size());
  CHECK(glb.data.size() % 4 == 0);
  CHECK(glb.json["buffers"][0]["byteLength"] == glb.data.size());
  const std::map<std::string, std::size_t> widths = {{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}};
  constexpr int floats = 5126;
  int bounded = 0;
  for (std::size_t a = 0; a < glb.json["accessors"].size(); ++a) {
    const auto& accessor = glb.json["accessors"][a];
    const auto& view = glb.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t begin = view["byteOffset"], bytes = view["byteLength"],
                      width = widths.at(accessor["type"]), count = accessor["count"];
    CHECK(begin % 4 == 0);
    CHECK(begin + bytes <= glb.data.size());
    CHECK((accessor.contains("min") && accessor.contains("max")) == accessor.contains("min"));
    if (accessor["componentType"] != floats) continue;
    REQUIRE(bytes == 4 * width * count);
    if (!accessor.contains("min")) continue;
    ++bounded;
    const auto values = glb.floats(a);
    for (std::size_t k = 0; k < width; ++k) {
      float low = values[k], high = values[k];
      for (std::size_t i = k; i < values.size(); i += width)
        low = std::min(low, values[i]), high = std::max(high, values[i]);
      CHECK(accessor["min"][k].get<float>() == low);
      CHECK(accessor["max"][k].get<float>() == high);
    }
  }
  CHECK(bounded >= 2);  // positions of shapes, times of keys
}

TEST_CASE(
    "a rod that is cut to bend has fittings at its ends alone, and nothing thicker than it in between") {
  const std::string cantilever =
      "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\nsegments = 5\n[[structure.nodes]]\nname = 'A'\n"
      "position = [0, 0, 0]\nfixed = true\n[[structure.nodes]]\nname = 'B'\nposition = [3, 0, 0]\n"
      "velocity = [0, 0.1, 0]\n[[structure.rods]]\nnodes = ['A', 'B']\nmass = 1\narea = 1e-4\n[solver]\n"
      "step = 1e-3\nend_time = 5e-3\n";
  const Simulation run = run_scene(cantilever, {"structure.rod_model=elastic"});
  const Diagnostics diagnostics = diagnose(run);
  const fs::path directory = fs::temp_directory_path() / ("unfurl_cut_" + std::to_string(::getpid()));
  fs::create_directories(directory);
  for (const char* format : {"gltf", "html"})
    find_export_format(format)->write({run, diagnostics, directory, "cut", 0.1, 1.0});
  const auto text = [&](const char* name) {
    std::ostringstream file;
    file << std::ifstream(directory / name, std::ios::binary).rdbuf();
    return file.str();
  };
  const nlohmann::json json = Glb(text("animation.glb")).json;
  const auto page = data_of(text("viewer.html"));
  fs::remove_all(directory);
  const double radius = run.trajectory.structure().rods[0].radius;
  REQUIRE(radius > 0);
  int fittings = 0, between = 0;
  for (const auto& node : json["nodes"]) {
    const auto name = node["name"].get<std::string>();
    if (name.ends_with(" fitting")) ++fittings;
    if (!name.starts_with("A-B.") || node.contains("rotation") || name.ends_with("fitting")) continue;
    ++between;
    CHECK(node["scale"][0].get<double>() < radius);
  }
  CHECK(fittings == 2);
  CHECK(between == 4);
  CHECK(page["seams"] == nlohmann::json({2, 3, 4, 5}));
}

TEST_CASE("a page says when a short run ended, and its clock shows a thousandth of it") {
  const Simulation run = run_scene(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0, 0, 0], velocity = [1, 0, 0], mass "
      "= "
      "1}]\nrods = []\n[solver]\nstep = 2e-8\nend_time = 1.25e-7\n");
  const fs::path directory = fs::temp_directory_path() / ("unfurl_short_" + std::to_string(::getpid()));
  fs::create_directories(directory);
  find_export_format("html")->write({run, diagnose(run), directory, "short", 0.1, 1.0});
  std::ostringstream page;
  page << std::ifstream(directory / "viewer.html", std::ios::binary).rdbuf();
  fs::remove_all(directory);
  CHECK(data_of(page.str())["facts"][0] ==
        nlohmann::json({"ended", "completed at 1.25\u00D710\u207B\u2077 s"}));
  CHECK(page.str().find("t.toFixed(clock_digits)") != std::string::npos);
}

}  // namespace formats_test
