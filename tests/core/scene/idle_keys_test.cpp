// SPDX-License-Identifier: BSD-3-Clause
// A key that does nothing with the other keys of its table says so, and does nothing.
#include <catch2/catch.hpp>

#include "core/scene/library.hpp"
#include "core/scene/write.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace idle_keys_test {

namespace {

using testing::end_positions, testing::run_scene;

// An arm O-A of 1.3 m in the plane of x and y, with a second one A-B, and a fixed point P.
const std::string arms = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "P", position = [0.3, -1, 0], fixed = true},
  {name = "A", position = [0.5, 1.2, 0], mass = 0.7},
  {name = "B", position = [1.4, 1.3, 0], velocity = [0.2, -0.3, 0], mass = 1.1}]
rods = [{nodes = ["O", "A"], mass = 2}, {nodes = ["A", "B"], mass = 0.5}]
[gravity]
acceleration = [0.4, -2.1, 0]
[solver]
step = 0.01
end_time = 0.2
)";

std::string warnings_of(const Scene& scene) {
  std::string all;
  for (const SceneProblem& warning : scene.warnings) all += problem_text(warning) + "\n";
  return all;
}

struct Idle {
  const char *entry, *key, *value, *reason;  // reason: what the warning says behind "does nothing "
  const char *other, *with;                  // a key with which it acts, and its value
};

const char* const motor = "kind = 'motor'\nnodes = ['O', 'A', 'B']\nstall_torque = 3\nno_load_speed = 200\n";
const char* const winch =
    "kind = 'winch'\nnodes = ['P', 'B']\nstall_torque = 3\nno_load_speed = 200\ndrum_radius = 0.1\n"
    "inertia = 0.02\naxial_stiffness = 900\n";
const char* const stop = "kind = 'coordinate_stop'\nnodes = ['B']\ndirection = [0, 1, 0]\nmin = 1.26\n";

const Idle idle_forces[] = {
    {motor, "motion", "'smooth'\nto = 150", "with control = 'voltage'", "control",
     "'position'\nproportional = 4"},
    {motor, "torque_constant", "0.1", "without current_limit", "current_limit", "2"},
    {winch, "torque_constant", "0.1", "without current_limit", "current_limit", "2"},
    {winch, "pulley_creep", "0.5", "with pulley_friction = 0", nullptr, nullptr},
    {"kind = 'torsion_spring'\nnodes = ['O', 'A', 'B']\ndamping = 2\n", "free_angle", "30",
     "with stiffness = 0", "stiffness", "3"},
    {"kind = 'spring'\nnodes = ['P', 'B']\ndamping = 2\n", "free_length", "2",
     "with stiffness = 0 and with tension_only = false", "stiffness", "3"},
    // A damper that only pulls is slack below its free length.
    {"kind = 'spring'\nnodes = ['P', 'B']\ndamping = 2\n", "free_length", "9",
     "with stiffness = 0 and with tension_only = false", "tension_only", "true"},
    {"kind = 'combination'\nterms = ['1 length P B', '2 length P A']\ndamping = 2\n", "free_value", "2",
     "with stiffness = 0", "stiffness", "3"},
    {"kind = 'friction'\nnodes = ['O', 'A', 'B']\nkinetic = 0.3\n", "pin_radius", "0.2",
     "with pin_friction = 0", "pin_friction", "0.1"},
    {"kind = 'friction'\nnodes = ['O', 'A', 'B']\nkinetic = 0.3\n", "direction", "[0, 1, 0]", "with an angle",
     nullptr, nullptr},
    {"kind = 'friction'\nnodes = ['P', 'B']\nkinetic = 0.3\n", "axis", "[0, 0, 1]",
     "without an angle: one or two nodes have no hinge", nullptr, nullptr},
    {"kind = 'friction'\nnodes = ['B']\ndirection = [0, 1, 0]\nkinetic = 0.3\n", "axis", "[0, 0, 1]",
     "without an angle: one or two nodes have no hinge", nullptr, nullptr},
};

const Idle idle_constraints[] = {
    {stop, "rest_speed", "3", "with restitution = 0", "restitution", "0.9"},
    {"kind = 'clearance'\nnodes = ['A', 'B']\nclearance = 2\n", "rest_speed", "3", "with restitution = 0",
     nullptr, nullptr},
    {"kind = 'cable'\nnodes = ['P', 'A', 'B']\naxial_stiffness = 900\n", "pulley_creep", "3",
     "with pulley_friction = 0", "pulley_friction", "0.2"},
};

void check(const std::string& table, const Idle& idle) {
  const std::string bare = arms + "[[" + table + "]]\n" + idle.entry, key(idle.key);
  const std::string line = key + " = " + idle.value + "\n", place = table + "[0]." + key;
  INFO(bare << line);
  CHECK(warnings_of(read_scene_text(bare, "s.toml")).empty());
  const std::string said = warnings_of(read_scene_text(bare + line, "s.toml"));
  CHECK(said.find(place + ": does nothing " + idle.reason + "\n") != std::string::npos);
  CHECK(said.starts_with("s.toml:"));
  // The same motion to the last bit: it does nothing.
  CHECK(end_positions(run_scene(bare)) == end_positions(run_scene(bare + line)));
  if (!idle.other) return;
  const std::string with = std::string(idle.other) + " = " + idle.with + "\n";
  CHECK(warnings_of(read_scene_text(bare + line + with, "s.toml")).find(place + ":") == std::string::npos);
}

}  // namespace

TEST_CASE("keys of forces and constraints that do nothing with the others are warned of, and do nothing") {
  for (const Idle& idle : idle_forces) check("forces", idle);
  for (const Idle& idle : idle_constraints) check("constraints", idle);
}

TEST_CASE("below its free length a damper that only pulls is slack") {
  const std::string damper =
      arms + "[[forces]]\nkind = 'spring'\nnodes = ['P', 'B']\ndamping = 2\ntension_only = true\n";
  const std::vector<std::string> away{"structure.nodes.B.velocity=[0.2,1.3,0]"};  // of P: it would pull
  const auto apart = [&](const std::string& length) {
    const std::string held = damper + "free_length = " + length + "\n";
    return (end_positions(run_scene(held, away)) - end_positions(run_scene(arms, away))).norm();
  };
  // Iterations end elsewhere within round-off where there is a force: 20 steps of some eps each, 1 m large.
  CHECK(apart("9") < 1e-12);
  CHECK(apart("0.1") > 1e-3);
}

TEST_CASE("keys of structures, surfaces and the solver that do nothing are warned of") {
  const auto said = [](const char* scene, std::vector<std::string> changes) {
    const Scene read = read_scene_file(find_scene(scene), changes);
    std::string all;
    for (const std::string& note : build_structure(read).notes) all += note + "\n";
    return all;
  };
  CHECK(said("chain", {"structure.shape=straight", "structure.span=0.5"}) ==
        "--set structure.span: does nothing with shape = 'straight'\n");
  CHECK(said("chain", {"structure.shape=catenary", "structure.angle=30"}) ==
        "--set structure.angle: does nothing with shape = 'catenary'\n");
  CHECK(said("cable_ring", {"structure.cable_rate=0", "structure.cable_ramp=3"}) ==
        "--set structure.cable_ramp: does nothing with cable_rate = 0\n");
  CHECK(said("mesh_reflector", {"structure.nets=false", "structure.net_mass=0.02"}) ==
        "--set structure.net_mass: does nothing with nets = false\n");
  for (const std::string at : {"pass", "latch"})
    CHECK(said("pendulum", {"solver.at_deployed=" + at}) ==
          "--set solver.at_deployed: does nothing: the structure has no deployed pose\n");
  CHECK(said("pendulum", {"solver.at_deployed=stop"}).empty());
  CHECK(said("hoop6", {"solver.at_deployed=pass"}).empty());
  const std::string hoop = "structure.kind = 'hoop'\n[[surfaces]]\nnodes = ['T*']\n";
  const auto surface = [&](const std::string& keys) {
    return warnings_of(read_scene_text(hoop + keys, "s.toml"));
  };
  CHECK(surface("focal_ratio = 0.7\n") ==
        "s.toml:4:15: surfaces[0].focal_ratio: does nothing with shape = 'flat' and with kind = 'mesh'\n");
  CHECK(surface("focal_ratio = 0.7\nshape = 'paraboloid'\n").empty());
  CHECK(surface("focal_ratio = 0.7\nkind = 'paraboloid'\n").empty());
  CHECK(surface("cells = 7\n").empty());
  CHECK(surface("cells = 7\nkind = 'membrane'\n") ==
        "s.toml:4:9: surfaces[0].cells: does nothing with kind = 'membrane'\n");
}

TEST_CASE("keys of pictures that do nothing with the others are warned of") {
  struct Case {
    const char *key, *value, *usual, *with, *without, *reason;
  };
  const std::string exported = ", whose colours the rods have; exported models have it",
                    by_stress = "in pictures with colour_by = 'stress'" + exported;
  const Case cases[] = {
      {"colour_range", "[1, 2]", "[0, 0]", "", "colour_by = 'speed'", "with colour_by = 'group'"},
      {"gif_width", "320", "640", "gif = false", "gif = true", "with gif = false"},
      {"depth_of_field", "0.02", "0", "projection = 'orthographic'", "", "with projection = 'orthographic'"},
      {"transparent", "true", "false", "look = 'print'", "look = 'dark'", "with look = 'print'"},
      {"dimensions", "true", "false", "look = 'blueprint'", "look = 'print'", "with look = 'blueprint'"},
      {"material", "'cfrp'", "'anodised'", "colour_by = 'stress'", "", by_stress.c_str()},
      {"materials", "[{group = '*', material = 'cfrp'}]", nullptr, "colour_by = 'stress'", "",
       by_stress.c_str()},
      {"camera", "'top'", "'auto'", "camera_keys = [{time = 0}]", "camera_keys = [{time = 0}]\nfit = true",
       "beside camera_keys, which say from where"}};
  const auto said = [](const std::string& keys, const std::vector<std::string>& set) {
    return warnings_of(read_scene_text(arms + "[render]\n" + keys, "s.toml", set));
  };
  for (const Case& c : cases) {
    const std::string key = std::string("render.") + c.key, line = std::string(c.key) + " = ",
                      with = std::string(c.with) + "\n";
    INFO(key);
    CHECK(said(line + c.value + "\n" + with, {}) ==
          "s.toml:16:" + std::to_string(line.size() + 1) + ": " + key + ": does nothing " + c.reason + "\n");
    CHECK(said(line + c.value + "\n" + c.without + "\n", {}).empty());
    if (!c.usual) continue;
    // A file may have the default, as every scene that is written out; a command line says what it wants.
    CHECK(said(line + c.usual + "\n" + with, {}).empty());
    CHECK(said(with, {key + "=" + c.usual}) == "--set " + key + ": does nothing " + c.reason + "\n");
  }
}

TEST_CASE("a material of a group that is not there is warned of") {
  const auto notes = [](const std::string& group) {
    std::string all;
    const Scene scene = read_scene_text(
        arms + "[[render.materials]]\ngroup = '" + group + "'\nmaterial = 'cfrp'\n", "x.toml");
    for (const std::string& note : build_structure(scene).notes) all += note + "\n";
    return all;
  };
  const std::string own = build_structure(read_scene_text(arms, "x.toml")).rods[0].group;
  CHECK(notes(own) == "");
  CHECK(notes("*") == "");
  CHECK_THAT(notes(own + "z"),
             Catch::StartsWith("x.toml:16:9: render.materials[0].group: no rods are of the group '" + own +
                               "z'; did you mean '" + own + "'?"));
}

TEST_CASE("what does nothing is not written, and what is written is not warned of") {
  const Scene scene =
      read_scene_text(arms + "[[forces]]\n" + motor + "motion = 'smooth'\nto = 150\n[[constraints]]\n" +
                          stop + "rest_speed = 3\n",
                      "s.toml");
  const std::string text = scene_text(scene);
  for (const char* key : {"motion = ", "to = ", "rest_speed = "}) CHECK(text.find(key) == std::string::npos);
  CHECK(warnings_of(read_scene_text(text, "again.toml")).empty());
  CHECK(end_positions(run_scene(text)) ==
        end_positions(run_scene(scene_text(read_scene_text(text, "again.toml")))));
}

TEST_CASE("what elastic rods are damped by is of use to one that is elastic by itself") {
  for (const char* key : {"damping_ratio = 0.3", "damping_time = 0.01"})
    for (const bool gives : {true, false}) {
      std::string text = arms;
      const std::string rod = "nodes = [\"O\", \"A\"], mass = 2";
      text.replace(text.find(rod), rod.size(),
                   rod + ", area = 1e-4, youngs_modulus = 1e6" + (gives ? ", elastic = true" : ""));
      text.insert(text.find("nodes = ["), key + std::string("\n"));
      CHECK(warnings_of(read_scene_text(text, "s.toml")).empty() == gives);
    }
}

}  // namespace idle_keys_test
