// SPDX-License-Identifier: BSD-3-Clause
// A scene that is written and read back is the same scene.
#include "core/scene/write.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/structures/family.hpp"

using namespace unfurl;

namespace write_test {

namespace {

void check_equal(const CustomSpec& a, const CustomSpec& b) {
  REQUIRE(a.nodes.size() == b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    CHECK(a.nodes[i].name == b.nodes[i].name);
    CHECK(a.nodes[i].position == b.nodes[i].position);
    CHECK(a.nodes[i].velocity == b.nodes[i].velocity);
    CHECK(a.nodes[i].mass == b.nodes[i].mass);
    CHECK(a.nodes[i].fixed == b.nodes[i].fixed);
  }
  REQUIRE(a.rods.size() == b.rods.size());
  for (std::size_t i = 0; i < a.rods.size(); ++i) {
    CHECK(a.rods[i].name == b.rods[i].name);
    CHECK(a.rods[i].nodes == b.rods[i].nodes);
    CHECK(a.rods[i].mass == b.rods[i].mass);
    CHECK(a.rods[i].density == b.rods[i].density);
    CHECK(a.rods[i].area == b.rods[i].area);
    CHECK(a.rods[i].group == b.rods[i].group);
  }
  CHECK(a.lumped_mass == b.lumped_mass);
}

void check_equal(const Scene& a, const Scene& b) {
  CHECK(a.title == b.title);
  CHECK(a.kind == b.kind);
  if (const Family* family = find_family(a.kind))
    for (const auto& spec : family->params())
      CHECK(a.structure.value(spec.name) == b.structure.value(spec.name));
  check_equal(a.custom, b.custom);
  CHECK(a.gravity == b.gravity);
  REQUIRE(a.loads.size() == b.loads.size());
  for (std::size_t i = 0; i < a.loads.size(); ++i) {
    CHECK(a.loads[i].nodes == b.loads[i].nodes);
    CHECK(a.loads[i].force == b.loads[i].force);
  }
  CHECK(a.solver.method == b.solver.method);
  CHECK(a.solver.stages == b.solver.stages);
  CHECK(a.solver.nodes == b.solver.nodes);
  CHECK(a.solver.constraints_at == b.solver.constraints_at);
  CHECK(a.solver.step == b.solver.step);
  CHECK(a.solver.end_time == b.solver.end_time);
  CHECK(a.solver.at_deployed == b.solver.at_deployed);
  CHECK(a.solver.eliminate_linear == b.solver.eliminate_linear);
  CHECK((a.render == b.render));
}

// Doubles of every size, whole numbers among them, none that a TOML file cannot hold.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  double any() {
    const double mantissa = std::uniform_real_distribution<double>(-1, 1)(engine_);
    return pick(4) == 0 ? std::floor(1000 * mantissa)
                        : std::ldexp(mantissa, static_cast<int>(pick(200)) - 100);
  }
  double positive() { return std::abs(any()) + 1e-30; }
  Vec3 vec() { return {any(), any(), any()}; }
  unsigned pick(unsigned n) { return std::uniform_int_distribution<unsigned>(0, n - 1)(engine_); }

 private:
  std::mt19937 engine_;
};

Scene random_custom_scene(unsigned seed) {
  Numbers random(seed);
  static const std::vector<std::string> odd = {"plain",  "with space",  "quo\"te",   "back\\slash",
                                               "tab\t",  "h\xC3\xB6he", "new\nline", "\x7f",
                                               "a.b[0]", "#no comment"};
  Scene scene;
  scene.title = odd[random.pick(10)];
  scene.kind = "custom";
  scene.custom.lumped_mass = random.pick(2) == 0;
  for (unsigned i = 0; i < 4; ++i)
    scene.custom.nodes.push_back({odd[random.pick(10)] + std::to_string(i), random.vec(),
                                  random.pick(2) ? random.vec() : Vec3::Zero(), random.positive(),
                                  random.pick(2) == 0});
  for (unsigned i = 0; i < 3; ++i) {
    CustomRod rod;
    rod.name = random.pick(2) ? "r" + std::to_string(i) : "";
    rod.nodes = {scene.custom.nodes[i].name, scene.custom.nodes[i + 1].name};
    if (random.pick(2)) rod.mass = random.positive();
    rod.density = rod.mass ? 0.0 : random.positive();
    rod.area = random.positive();
    rod.group = odd[random.pick(10)];
    scene.custom.rods.push_back(rod);
  }
  scene.gravity = random.vec();
  scene.loads.push_back({{"*"}, random.vec(), {}});
  scene.solver.step = 0.01 * (1 + std::abs(std::fmod(random.any(), 1.0)));
  scene.solver.end_time = 1.0 / 3.0;
  scene.solver.eliminate_linear = random.pick(2) == 0;
  scene.render.width = 16 + static_cast<int>(random.pick(1000));
  scene.render.fps = 29.97;
  scene.render.speed = 1.0 / 7.0;
  scene.render.look = "print";
  scene.render.gif = false;
  scene.render.colour_range = {-2.5, 1.0 / 3.0};
  scene.render.trails = "B*";
  scene.render.camera_keys = {{0.0, -60.0, 20.0, 1.0}, {1.0 / 3.0, 10.0, 45.0, 2.5}};
  scene.render.supersample = 2;
  return scene;
}

}  // namespace

TEST_CASE("every built-in scene survives writing and reading") {
  const auto scenes = library_scenes();
  REQUIRE(scenes.size() >= 6);
  for (const auto& row : scenes) {
    INFO(row.name);
    const Scene scene = read_scene_file(row.path);
    check_equal(scene, read_scene_text(scene_text(scene), "again"));
  }
}

TEST_CASE("scenes with odd names and numbers of every size survive writing and reading") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Scene scene = random_custom_scene(seed);
    INFO(scene_text(scene));
    check_equal(scene, read_scene_text(scene_text(scene), "again"));
  }
}

TEST_CASE("overrides are in the written scene") {
  const Scene scene =
      read_scene_text("[structure]\nkind = 'hoop'\n", "x", {"structure.units=9", "solver.step=0.125"});
  const std::string text = scene_text(scene);
  CHECK(text.find("units = 9\n") != std::string::npos);
  CHECK(text.find("step = 0.125  # s\n") != std::string::npos);
}

TEST_CASE("forces, constraints and drives survive writing and reading") {
  const Scene scene = read_scene_text(R"(
[structure]
kind = "hoop"
[[forces]]
kind = "torsion_spring"
rods = ["B0-Mb0", "Mb0-B1"]
stiffness = 40
[[forces]]
kind = "follower"
rod = "B0-T0"
force = 3
times = [0, 1]
values = [1, 0.5]
[[constraints]]
kind = "angle"
name = "motor"
fold_angle = true
motion = "smooth"
to = 5
[[constraints]]
kind = "length_stop"
nodes = ["B0", "B3"]
max = 11
)",
                                      "x");
  const std::string text = scene_text(scene);
  CHECK(scene_text(read_scene_text(text, "x")) == text);
  CHECK(text.find("rods = [\"B0-Mb0\", \"Mb0-B1\"]\nstiffness = 40.0  # N m/rad\n") != std::string::npos);
  CHECK(text.find("free_angle") == std::string::npos);  // as built
  CHECK(build_structure(scene).forces.size() == 2);
}

TEST_CASE("entries that name what is not there say so where they stand") {
  const auto message = [](const std::string& entry) -> std::string {
    try {
      build_structure(read_scene_text("[structure]\nkind = 'hoop'\n" + entry, "x.toml"));
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message("[[forces]]\nkind = 'sprnig'\n") ==
        "x.toml:4:8: forces[0].kind: must be one of load_over_time, follower, spring, bending, temperature, "
        "torsion_spring, cable, combination, motor, joint_damping, drag, friction, offload, latch, winch; "
        "got 'sprnig'; did you mean 'spring'?");
  CHECK(message("[[forces]]\nkind = 'follower'\nrod = 'B0-T9'\nforce = 1\n")
            .starts_with("x.toml:5:7: forces[0].rod: there is no rod 'B0-T9'; did you mean 'B"));
  CHECK(message("[[forces]]\nkind = 'torsion_spring'\n")
            .find("must name one angle: rods = [R, S], or nodes = [A, HINGE, B], or fold_angle = true") !=
        std::string::npos);
  CHECK(message("[[constraints]]\nkind = 'angle'\nfold_angle = true\nmotion = 'rate'\n")
            .find("constraints[0].rate: is missing; motion = \"rate\" needs it") != std::string::npos);
  CHECK(message("[[constraints]]\nkind = 'length_stop'\nnodes = ['B0', 'T0']\nmax = 1\n")
            .find("constraints[0].max: is passed already at t = 0, where the value is 1.2") !=
        std::string::npos);
}

}  // namespace write_test
