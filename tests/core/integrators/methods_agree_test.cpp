// SPDX-License-Identifier: BSD-3-Clause
// Every method on every kind of constraint and force: a small mechanism for each kind, on which all methods
// must give one motion. What a kind does wrong shows in no other way: constraints, balance and order of one
// method may all be right on a motion that is not that of the mechanism.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "core/integrators/integrator.hpp"
#include "core/scene/elements.hpp"
#include "tests/support/other_units.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace methods_agree_test {

namespace {

// Two rods from O by way of A to B, in space, and a third from A to C: odd masses, no symmetry, moving.
const std::string arms = R"(
[structure]
kind = "custom"
[[structure.nodes]]
name = "O"
position = [0.1, -0.2, 0.3]
fixed = true
[[structure.nodes]]
name = "A"
position = [0.73, 0.31, -0.17]
velocity = [0.4, 1.1, -0.6]
[[structure.nodes]]
name = "B"
position = [1.21, -0.14, -0.62]
velocity = [-0.3, 0.9, 1.3]
mass = 0.37
[[structure.nodes]]
name = "C"
position = [0.45, 0.93, 0.26]
velocity = [0.8, 0.2, -1.2]
mass = 0.23
[[structure.rods]]
nodes = ["O", "A"]
mass = 1.3
[[structure.rods]]
nodes = ["A", "B"]
mass = 0.7
[[structure.rods]]
nodes = ["A", "C"]
mass = 0.45
[gravity]
acceleration = [0.7, -1.9, -9.1]
[solver]
end_time = 0.3
)";

// A node D in the plane of O, A and B; a node E on the line O-A; a node M, the image of C in the plane of
// normal (0.48, 0.6, 0.64) through (0.2, 0.1, 0).
const std::string in_plane = R"([[structure.nodes]]
name = "D"
position = [0.835, 0.1015, -0.2805]
velocity = [0.5, 0.1, 0.9]
mass = 0.29
[[structure.rods]]
nodes = ["O", "D"]
mass = 0.31
)";
const std::string on_line = R"([[structure.nodes]]
name = "E"
position = [0.289, -0.047, 0.159]
velocity = [0.9, 0.3, -0.4]
mass = 0.41
)";
const std::string image = R"([[structure.nodes]]
name = "M"
position = [-0.303024, -0.01128, -0.744032]
mass = 0.53
)";

struct Case {
  std::string kind, what, text;
};

std::string constraint(const std::string& keys) {
  return "[[constraints]]\n" + keys + "\n";
}
std::string force(const std::string& keys) {
  return "[[forces]]\n" + keys + "\n";
}
const std::string smooth = "\nmotion = 'smooth'\nduration = 0.41\nto = ";

std::vector<Case> constraint_cases() {
  const std::string axis = "\naxis = [-0.5, 0.2, -0.6]";
  const auto c = [](const std::string& kind, const std::string& what, const std::string& keys,
                    const std::string& more = "") {
    return Case{kind, what, arms + more + constraint("kind = '" + kind + "'\n" + keys)};
  };
  return {
      c("plane", "a node in a slanting plane", "nodes = ['B']\nnormal = [0.2, -0.5, 0.8]"),
      c("line", "a node on a slanting line", "nodes = ['B']\ndirection = [0.6, 0.3, -0.9]"),
      c("fixed", "the end of a chain", "nodes = ['B']"),
      c("equal", "two nodes level along a direction",
        "nodes = ['B', 'C']\ndirection = [1.07, 1.376, -0.749]"),
      c("mirror", "a node and its image",
        "nodes = ['C', 'M']\nnormal = [0.48, 0.6, 0.64]\npoint = [0.2, 0.1, 0]", image),
      c("relation", "three nodes",
        "nodes = ['A', 'B', 'C']\ncoefficients = [0.3, 0.1, -0.7, 0.9, 0.2, 0.4, -0.5, 0.6, 0.8]"),
      c("collinear", "a bead on a rod that turns in space", "nodes = ['O', 'A', 'E']", on_line),
      c("coplanar", "an arm in the plane of two others", "nodes = ['O', 'A', 'B', 'D']", in_plane),
      c("length", "held", "nodes = ['B', 'C']"),
      c("length", "driven", "nodes = ['O', 'B']" + smooth + "1.37"),
      c("coordinate", "held, a difference", "nodes = ['B', 'C']\ndirection = [0.5, -0.4, 0.6]"),
      c("coordinate", "driven", "nodes = ['C']\ndirection = [0.1, 0.7, 0.4]" + smooth + "0.93"),
      c("angle", "held, without an axis", "nodes = ['O', 'A', 'B']"),
      c("angle", "held, about an axis", "nodes = ['O', 'A', 'C']" + axis),
      c("angle", "driven, without an axis", "nodes = ['B', 'A', 'C']" + smooth + "115"),
      c("angle", "driven, about an axis", "nodes = ['O', 'A', 'B']" + axis + smooth + "-100"),
      c("cable", "elastic, over a node, taut", "nodes = ['B', 'A', 'C']\naxial_stiffness = 60\nlength = 0.3"),
      c("gear", "two arms on a third", "nodes = ['O', 'A', 'B', 'O', 'A', 'C']\nradii = [0.3, 0.5]"),
      c("rack", "an arm drives a node",
        "nodes = ['O', 'A', 'B', 'C']\nradius = 0.3\ndirection = [0.4, 0.2, -0.7]"),
      c("telescope", "two spans that stretch alike",
        "nodes = ['O', 'C', 'B']\nshares = [1, 2]\nstraight = false"),
      c("combination", "driven",
        "terms = ['0.7 length O B', '0.4 coordinate C along 0.2 0.9 0.3', '0.3 angle O A B']\nmotion = "
        "'rate'\n"
        "rate = 0.2\nramp = 0.4"),
  };
}

// A massless rod from O to B that gives, E A = 110 N.
std::string elastic_rod() {
  std::string text = arms;
  text.replace(text.find("kind = \"custom\""), 15, "kind = \"custom\"\ndamping_time = 7e-3");
  return text +
         "[[structure.rods]]\nname = 'giving'\nnodes = ['O', 'B']\nmass = 0\narea = 1e-4\n"
         "youngs_modulus = 1.1e6\nelastic = true\n";
}

std::vector<Case> force_cases() {
  const auto f = [](const std::string& kind, const std::string& what, const std::string& keys) {
    return Case{kind, what, arms + force("kind = '" + kind + "'\n" + keys)};
  };
  return {
      f("load_over_time", "a triangle, its corners on steps",
        "nodes = ['B']\nforce = [9, -4, 7]\ntimes = [0, 0.1, 0.3]\nvalues = [0.2, 1, -0.3]"),
      f("follower", "along a rod", "rod = 'A-B'\nforce = 11"),
      f("spring", "with a damper", "nodes = ['O', 'B']\nstiffness = 130\ndamping = 1.7\nfree_length = 1.1"),
      f("spring", "a cable that stays taut",
        "nodes = ['B', 'C']\nstiffness = 90\nfree_length = 0.3\ntension_only = true"),
      f("torsion_spring", "without an axis",
        "nodes = ['O', 'A', 'B']\nstiffness = 23\nfree_angle = 70\ndamping = 0.3"),
      f("torsion_spring", "about an axis",
        "nodes = ['B', 'A', 'C']\nstiffness = 7\nfree_angle = 40\naxis = [0.2, 0.9, 0.3]"),
      f("cable", "elastic, taut, paid out",
        "nodes = ['B', 'A', 'C']\naxial_stiffness = 60\nlength = 0.3\nmotion = "
        "'rate'\nrate = 0.1\ndamping = 0.4"),
      f("cable", "which rubs on the node that it runs over",
        "nodes = ['B', 'A', 'C']\naxial_stiffness = 60\nlength = 0.3\npulley_friction = 0.3\n"
        "pulley_creep = 50"),
      f("combination", "a length and an angle",
        "terms = ['1 length O C', '0.5 angle B A C']\nstiffness = 12\ndamping = 0.4\nfree_value = 0.9"),
      f("motor", "a torque-speed line and a rotor",
        "nodes = ['O', 'A', 'B']\nstall_torque = 2\nno_load_speed = 4000\ngear_ratio = 3\ninertia = 0.01"),
      f("motor", "a controller with an integral",
        "nodes = ['O', 'A', 'B']\nstall_torque = 500\nno_load_speed = 40000\ncontrol = "
        "'position'\nproportional = "
        "5\nderivative = 0.5\nintegral = 2"),
      f("winch", "an elastic cable that stays taut",
        "nodes = ['O', 'B']\nstall_torque = 1\nno_load_speed = 900\ndrum_radius = 0.1\ninertia = 0.02\n"
        "axial_stiffness = 40\nlength = 0.5"),
      f("joint_damping", "at a joint of three rods", "nodes = ['A']\ndamping = 0.9"),
      f("bending", "of a rod in two segments", "nodes = ['O', 'A', 'B']\nstiffness = 5"),
      f("temperature", "rigid rods that warm and cool",
        "rods = ['A-B', 'O-A']\nexpansion = 2e-4\nchange = 80\ntimes = [0, 0.1, 0.3]\nvalues = [0, 1, 0.4]"),
      {"temperature", "an elastic rod that warms",
       elastic_rod() + force("kind = 'temperature'\nrods = ['giv*']\nexpansion = 2e-3\nchange = 40\n"
                             "times = [0, 0.1, 0.3]\nvalues = [0, 1, 0.4]")},
      {"elastic_rod", "with damping, beside rigid ones", elastic_rod()},
      f("drag", "of two nodes", "nodes = ['B', 'C']\ndamping = 1.3"),
      f("friction", "of a joint, which goes on turning",
        "nodes = ['O', 'A', 'B']\nkinetic = 0.4\nstatic = 0.5"),
      f("friction", "of a pin by its load, which goes on turning",
        "nodes = ['O', 'A', 'B']\nkinetic = 0\npin_friction = 0.2\npin_radius = 0.05"),
      f("offload", "from trolleys that stay", "nodes = ['A', 'B', 'C']\nlength = 0.9"),
  };
}

VectorXd end_of(const std::string& text, SolverOptions options, double step) {
  const Scene scene = read_scene_text(text, "test.toml");
  options.step = step;
  options.end_time = scene.solver.end_time;
  const Simulation run = simulate(build_model(scene), options);
  INFO(options.method << ", h = " << step << ": " << run.message);
  REQUIRE(run.status == RunStatus::completed);
  return run.trajectory.node_positions(run.trajectory.size() - 1);
}

// The motion to compare with: order 8 at h = 0.005 s. Nothing of the mechanisms turns faster than 20 rad/s:
// an error of (0.005 * 20)^8 = 1e-8 times a constant of 1 / 8! at the most, halving the step says less.
VectorXd reference_of(const Case& c) {
  INFO(c.kind << ", " << c.what);
  SolverOptions options;
  options.stages = 5;
  const VectorXd reference = end_of(c.text, options, 0.005);
  CHECK((end_of(c.text, options, 0.0025) - reference).norm() <= 1e-10);
  options.eliminate_linear = false;
  CHECK((end_of(c.text, options, 0.005) - reference).norm() <= 1e-10);
  return reference;
}

// Order p at a step h in which nothing turns by more than h omega = 0.04 rad (20 rad/s): (h omega)^p times
// the angle of 6 rad that is turned over all, times constants of order one. A method that solves another
// mechanism is off by centimetres; one that does not converge to the motion does not gain when its step is
// halved: by 2^p, less what higher terms and round-off (1e-10 m) take.
void check_agreement(const Case& c) {
  constexpr double h = 0.002, turned = 20 * h, round_off = 1e-10;
  const VectorXd reference = reference_of(c);
  for (const Method& method : methods()) {
    SolverOptions options;
    options.method = method.name;
    const int order = method.claims(options).order;
    const double coarse = (end_of(c.text, options, h) - reference).norm(),
                 fine = (end_of(c.text, options, h / 2) - reference).norm();
    INFO(c.kind << ", " << c.what << ": " << method.name << " is off by " << coarse << " m, " << fine
                << " m with half the step");
    CHECK(coarse <= 6 * std::pow(turned, order) + round_off);
    CHECK(fine <= coarse / std::pow(2, order - 0.7) + round_off);
  }
}

bool has_case(const std::vector<Case>& cases, std::string_view kind) {
  return std::any_of(cases.begin(), cases.end(), [&](const Case& c) { return c.kind == kind; });
}

}  // namespace

TEST_CASE("all methods give one motion on every kind of constraint") {
  const auto cases = constraint_cases();
  for (const ElementKind& kind : scene_constraints()) {
    INFO("constraint kind " << kind.kind << " needs a mechanism here");
    if (!kind.kind.ends_with("_stop") && kind.kind != "clearance")
      CHECK(has_case(cases, kind.kind));  // stops have events: one_sided_test
  }
  std::map<std::string, bool, std::less<>> met{{"rod", false}};
  for (const Case& c : cases) {
    check_agreement(c);
    const auto model = build_model(read_scene_text(c.text, "test.toml"));
    for (const Constraint& constraint : model->structure.constraints) met[constraint.kind] = true;
    met["rod"] = met["rod"] || !model->structure.rods.empty();
  }
  for (const ConstraintKind& kind : constraint_kinds()) {
    INFO("no mechanism has the rows of " << kind.kind);
    CHECK(met[std::string(kind.kind)]);
  }
}

TEST_CASE("all methods give one motion under every kind of force") {
  const auto cases = force_cases();
  for (const ElementKind& kind : scene_forces()) {
    INFO("force kind " << kind.kind << " needs a mechanism here");
    if (kind.kind != "latch") CHECK(has_case(cases, kind.kind));  // waits for an event: latch_test
  }
  for (const Case& c : cases) check_agreement(c);
}

TEST_CASE("every kind of constraint and force moves alike in other units, to the last bit") {
  // Keys without a unit of their own, in the cases above.
  const testing::UnitsOfKeys more{{"kinetic", "N m"}, {"static", "N m"}, {"integral", "N m/rad/s"}};
  std::vector<Case> cases = constraint_cases();
  for (Case& c : force_cases()) cases.push_back(std::move(c));
  for (const Case& c : cases) {
    INFO(c.kind << ", " << c.what);
    if (c.kind == "combination") continue;  // of metres and degrees: its coefficients do not say their units
    // A rotor turns by an angle, whatever a metre is: among the coordinates it weighs another share.
    const bool turns = c.kind == "motor" || c.kind == "winch";
    for (const testing::OtherUnits& units :
         {testing::OtherUnits{-10, 0, 0}, {0, -20, 0}, {0, 0, -7}, {7, 20, 5}})
      testing::check_other_units(read_scene_text(c.text, "test.toml"), units, turns ? 1e-9 : 0, more);
  }
}

}  // namespace methods_agree_test
