// SPDX-License-Identifier: BSD-3-Clause
// Rings of general entries about any axis: the turns that take them onto each other, and what is odd by name.
#include "core/path/symmetry.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "core/path/sector.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/study/reference.hpp"
#include "core/study/table.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace symmetry_test {

namespace {

using Texts = std::vector<std::string>;

std::string triple(const Vec3& v) {
  return "[" + exact_number(v.x()) + ", " + exact_number(v.y()) + ", " + exact_number(v.z()) + "]";
}

// n units about an axis through a centre; two nodes of a unit lie in one place.
struct Ring {
  int n;
  int axis;  // x, y, z
  Vec3 centre;
  bool backwards = false;  // units listed the other way round
  std::function<void(Ring&)> change = {};
  bool elastic = false;
  Texts nodes = {}, rods = {}, loads = {}, forces = {}, constraints = {};

  Vec3 vector(int unit, double out, double along, double up) const {
    const double angle = 0.37 + 2 * pi * unit / n;
    Vec3 v = up * Vec3::Unit(axis);
    v += (out * std::cos(angle) - along * std::sin(angle)) * Vec3::Unit((axis + 1) % 3);
    v += (out * std::sin(angle) + along * std::cos(angle)) * Vec3::Unit((axis + 2) % 3);
    return v;
  }
  void add_unit(int k) {
    const std::string i = std::to_string(k), j = std::to_string((k + 1) % n);
    const auto node = [&](const std::string& name, const Vec3& from_centre, double mass, const Vec3& v) {
      nodes.push_back("{name = '" + name + i + "', position = " + triple(centre + from_centre) +
                      ", mass = " + exact_number(mass) + ", velocity = " + triple(v) + "}");
    };
    node("P", vector(k, 1, 0, 0.1), 0.8, vector(k, 0, 0.3, 0.1));
    node("Q", vector(k, 1.3, 0.4, 0.42), 0.5, Vec3::Zero());
    node("R", vector(k, 0.7, -0.3, -0.2), 0.3, Vec3::Zero());
    node("S", vector(k, 0.7, -0.3, -0.2), 0.9, Vec3::Zero());
    for (const auto& [a, b] :
         {std::pair{"P" + i, "Q" + i}, std::pair{"R" + i, "P" + i}, std::pair{"S" + i, "Q" + i}})
      rods.push_back("{name = '" + a + "-" + b + "', nodes = ['" + a + "', '" + b + "'], mass = 0.25}");
    for (const Vec3& f : {vector(k, 0.7, 0.2, -0.4), vector(k, -0.1, 0.5, 0.3)})
      loads.push_back("{nodes = ['R" + i + "'], force = " + triple(f) + "}");
    forces.push_back("{name = 'cord " + i + "', kind = 'spring', nodes = ['Q" + i + "', 'Q" + j +
                     "'], stiffness = 31, damping = 0.7, free_length = 1.1}");
    forces.push_back("{name = 'blow " + i + "', kind = 'load_over_time', nodes = ['S" + i + "'], force = " +
                     triple(vector(k, 0.6, -0.5, 0.9)) + ", times = [0, 0.04, 0.3], values = [0, 1, 0.2]}");
    constraints.push_back("{name = 'wall " + i + "', kind = 'plane', nodes = ['P" + i +
                          "'], normal = " + triple(vector(k, 0.8, 0.36, 0.48)) + "}");
    constraints.push_back("{name = 'strut " + i + "', kind = 'length', nodes = ['S" + i + "', 'P" + j +
                          "']}");
  }
  static std::string list(const std::string& name, const Texts& entries) {
    std::string all;
    for (const std::string& entry : entries) all += (all.empty() ? "" : ",\n  ") + entry;
    return entries.empty() ? "" : name + " = [" + all + "]\n";
  }
  std::shared_ptr<const Model> model() {
    for (int k = 0; k < n; ++k) add_unit(backwards ? n - 1 - k : k);
    if (change) change(*this);
    const std::string text =
        list("loads", loads) + list("forces", forces) + list("constraints", constraints) +
        "[gravity]\nacceleration = " + triple(1.3 * Vec3::Unit(axis)) + "\n[structure]\nkind = 'custom'\n" +
        (elastic ? "rod_model = 'elastic'\ndamping_ratio = 0.02\n" : "") + list("nodes", nodes) +
        list("rods", rods);
    return build_model(read_scene_text(text, "ring.toml", {}));
  }
};

// Of the n units of four nodes each, what the entry named so with another number is.
std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}
// The one of these that has this name.
std::string& named(Texts& all, const std::string& name) {
  for (std::string& entry : all)
    if (entry.find("name = '" + name + "'") != std::string::npos) return entry;
  FAIL(name);
  return all.front();
}

std::string refusal(const Model& model) {
  try {
    find_symmetry(model.structure, model.system);
  } catch (const SectorRefused& refused) {
    return refused.what();
  }
  return "";
}

const Vec3 far(3.1, -1.7, 2.3);

}  // namespace

TEST_CASE("a ring about any axis has its turns and each entry its images") {
  for (const auto& [n, axis, centre, backwards] : std::initializer_list<std::tuple<int, int, Vec3, bool>>{
           {5, 0, far, false}, {3, 1, Vec3::Zero(), true}, {4, 2, far, false}, {7, 1, far, true}}) {
    CAPTURE(n, axis, backwards);
    const auto model = Ring{n, axis, centre, backwards}.model();
    const Structure& s = model->structure;
    const Symmetry found = find_symmetry(s, model->system);
    CHECK(found.order == n);
    CHECK((found.axis - Vec3::Unit(axis)).norm() == 0);
    REQUIRE(found.nodes.size() == s.nodes.size());
    // Positions are rounded to 1e-15 of some 5 m.
    std::vector<std::vector<int>> to(static_cast<std::size_t>(n), std::vector<int>(s.nodes.size(), -1));
    for (std::size_t i = 0; i < s.nodes.size(); ++i) {
      const auto& [source, turns] = found.nodes[i];
      REQUIRE((turns >= 0 && turns < n));
      const Node& from = s.nodes[static_cast<std::size_t>(source)];
      CHECK(from.name[0] == s.nodes[i].name[0]);
      CHECK((found.turned(from.position, turns) - s.nodes[i].position).norm() < 1e-13);
      CHECK((found.turn(turns) * from.velocity - s.nodes[i].velocity).norm() < 1e-14);
      to[static_cast<std::size_t>(turns)][static_cast<std::size_t>(source)] = static_cast<int>(i);
    }
    const auto image = [&](int node, int turns) {
      return to[static_cast<std::size_t>(turns)]
               [static_cast<std::size_t>(found.nodes[static_cast<std::size_t>(node)].source)];
    };
    int sources = 0;
    const auto check = [&, sectors = n](const std::vector<TurnedImage>& images, const auto& nodes_of) {
      for (std::size_t i = 0; i < images.size(); ++i) {
        std::vector<int> turned = nodes_of(static_cast<std::size_t>(images[i].source));
        bool of_source = true;  // its own nodes may be images
        for (int& node : turned) {
          of_source = of_source && found.nodes[static_cast<std::size_t>(node)].turns == 0;
          const int turns = (found.nodes[static_cast<std::size_t>(node)].turns + images[i].turns) % sectors;
          node = image(node, turns);
        }
        CHECK(turned == nodes_of(i));
        sources += images[i].turns == 0 ? 1 : 0;
      }
    };
    check(found.rods, [&](std::size_t i) { return std::vector<int>{s.rods[i].a, s.rods[i].b}; });
    check(found.forces, [&](std::size_t i) {
      return s.forces[i].nodes.empty() ? s.forces[i].measure.nodes : s.forces[i].nodes;
    });
    CHECK(sources == 3 + 2);
    for (std::size_t i = 0; i < s.constraints.size(); ++i) {
      const Constraint& c = s.constraints[i];
      if (is_linear(c)) continue;
      CHECK(found.whole_constraint[i] == 0);
      CHECK(
          c.measure.nodes[1] ==
          image(
              s.constraints[static_cast<std::size_t>(found.constraints[i].source)].measure.nodes[1],
              (found.constraints[i].turns +
               found
                   .nodes[static_cast<std::size_t>(
                       s.constraints[static_cast<std::size_t>(found.constraints[i].source)].measure.nodes[1])]
                   .turns) %
                  n));
    }
  }
}

// Whichever of the units it is in, and in whichever order these are listed.
TEST_CASE("the one entry of a ring that is another is named") {
  const struct {
    const char *list, *name, *what, *by, *told;
  } cases[] = {
      {"nodes", "Q", "mass = 0.5", "mass = 0.51", "the mass of node Q"},
      {"nodes", "R", "velocity = [0, 0, 0]", "velocity = [0.001, 0.02, 0.003]", "the velocity of node R"},
      {"rods", "P", "mass = 0.25", "mass = 0.26", "rod P"},
      {"forces", "cord ", "damping = 0.7", "damping = 0.71", "cord "},
      {"forces", "blow ", "values = [0, 1", "values = [0, 1.1", "blow "},
      {"constraints", "strut ", "kind = 'length'", "kind = 'length', motion = 'rate', rate = 0.1", "strut "},
  };
  for (const auto& [list, name, what, by, told] : cases)
    for (int odd = 0; odd < 5; ++odd)
      for (const bool backwards : {false, true}) {
        CAPTURE(name, odd, backwards);
        const std::string k = std::to_string(odd),
                          full = name == std::string("P") ? "P" + k + "-Q" + k : name + k;
        Ring ring{5, 2, far, backwards};
        ring.change = [&, what = what, by = by, list = std::string(list)](Ring& r) {
          std::string& entry = named(list == "nodes"    ? r.nodes
                                     : list == "rods"   ? r.rods
                                     : list == "forces" ? r.forces
                                                        : r.constraints,
                                     full);
          entry = replaced(entry, what, by);
        };
        const std::string said = refusal(*ring.model());
        // Of what differs at a node the next one may be told.
        if (std::string(told).starts_with("the mass"))
          CHECK(said.starts_with(told));
        else
          CHECK(said ==
                told + (name == std::string("P") ? full.substr(1) : k) + " has no equal a 5th of a turn on");
      }
}

TEST_CASE("of a ring what is missing or tilted or across or on the axis or only nearly alike is told") {
  const auto told = [](int n, const std::function<void(Ring&)>& change) {
    return refusal(*Ring{n, 0, far, false, change}.model());
  };
  // Without the cord from Q2 to Q3 that before it has no image.
  CHECK(told(5, [](Ring& r) { r.forces.erase(r.forces.begin() + 4); }) ==
        "cord 1 has no equal a 5th of a turn on");
  CHECK(told(5, [](Ring& r) { r.loads.pop_back(); }).starts_with("the load on R4 "));
  for (int odd = 0; odd < 5; ++odd)
    CHECK(told(5, [&](Ring& r) {
            std::string& wall = named(r.constraints, "wall " + std::to_string(odd));
            wall = wall.substr(0, wall.find("normal")) +
                   "normal = " + triple(r.vector(odd, 0.8, 0.48, 0.36)) + "}";
          }).starts_with("plane of P"));
  // However many nodes there are, loads and velocities are compared to rounding.
  for (const double off : {1e-9, 1e-5}) {
    CHECK(told(11, [&](Ring& r) {
            r.loads.push_back("{nodes = ['R3'], force = " + triple(off * Vec3(0.3, 0.1, 0.7)) + "}");
          }).starts_with("the load on R3 "));
    CHECK(told(11, [&](Ring& r) {
            std::string& node = named(r.nodes, "Q7");
            node = node.substr(0, node.find("velocity")) + "velocity = " + triple(off * Vec3(0.3, 0.1, 0.7)) +
                   "}";
          }).starts_with("the velocity of node "));
  }
  CHECK(refusal(*testing::make_model(testing::hoop_structure({{"model", std::string("sector")}}))) ==
        "it is a sector already");
  // Two braces of a ring of four, across: half a turn has them in their places.
  CHECK(told(4, [](Ring& r) {
          for (const std::string k : {"0", "1"})
            r.forces.insert(r.forces.begin() + 2, "{name = 'brace " + k + "', kind = 'spring', nodes = ['Q" +
                                                      k + "', 'Q" + std::to_string(k[0] - '0' + 2) +
                                                      "'], stiffness = 5, free_length = 2}");
        }) == "brace 1 has no equal a 4th of a turn on");
  CHECK(told(5, [](Ring& r) {
          r.nodes.insert(r.nodes.begin(), "{name = 'hub', position = " +
                                              triple(r.centre + 0.3 * Vec3::UnitX()) + ", mass = 1}");
        }) == "node hub lies on the axis");
  CHECK(told(2, {}) == "no turn by a third of one or less takes its nodes onto each other");
  // Free masses, which no rod's length tells apart.
  const auto masses = [](double off) {
    Ring r{5, 0, far, false, [&](Ring& ring) {
             ring.rods = {"{nodes = ['P0', 'P1']}"}, ring.loads = ring.forces = ring.constraints = {};
             ring.nodes.clear();
             for (int k = 0; k < 5; ++k)
               ring.nodes.push_back("{name = 'P" + std::to_string(k) + "', mass = 2, position = " +
                                    triple(far + ring.vector(k, 1, 0, k == 3 ? off : 0)) + "}");
             ring.rods.clear();
           }};
    return refusal(*r.model());
  };
  CHECK(masses(0).empty());
  CHECK(masses(1e-4) == "its nodes are not quite where a turn takes others");
  CHECK(told(5, [](Ring& r) { r.rods.push_back("{name = 'tie', nodes = ['Q1', 'Q2'], mass = 0.1}"); }) ==
        "rod tie has no equal a 5th of a turn on");
  // One node moved: its rods are of other lengths.
  CHECK(told(5, [](Ring& r) {
          std::string& node = named(r.nodes, "Q2");
          node = "{name = 'Q2', mass = 0.5, position = " + triple(far + r.vector(2, 1.3, 0.402, 0.42)) + "}";
        }).starts_with("rod P2-Q2 has no equal "));
  // Two nodes that lie close together are no ring of a thousand.
  CHECK(told(5, [](Ring& r) {
          r.loads = r.forces = r.constraints = {}, r.nodes.clear();
          for (const Vec3& x :
               {Vec3(0.1, 0.2, 0.3), Vec3(0.1, 0.206, 0.3), Vec3(1, -0.4, 0.8), Vec3(2, 0.3, 0.1)})
            r.nodes.push_back("{name = 'N" + std::to_string(r.nodes.size()) +
                              "', mass = 1, position = " + triple(x) + "}");
          r.rods = {"{nodes = ['N0', 'N2'], mass = 0.3}", "{nodes = ['N2', 'N3'], mass = 0.3}"};
        }) == "no turn by a third of one or less takes its nodes onto each other");
}

TEST_CASE("of a ring what little is unlike and what joins other nodes than elsewhere is told") {
  const auto told = [](int n, const std::function<void(Ring&)>& change) {
    return refusal(*Ring{n, 0, far, false, change}.model());
  };
  // To rounding of what there is, however little that is.
  const auto slow = [&](double load, double velocity) {
    return told(7, [&](Ring& r) {
      r.loads.clear();
      for (int k = 0; k < 7; ++k) {
        const std::string i = std::to_string(k);
        const Vec3 odd = k == 3 ? Vec3(0.3, 0.1, 0.7) : Vec3::Zero();
        r.loads.push_back("{nodes = ['R" + i +
                          "'], force = " + triple(1e-6 * r.vector(k, 0.7, 0.2, -0.4) + load * odd) + "}");
        std::string& node = named(r.nodes, "P" + i);
        node = node.substr(0, node.find("velocity")) +
               "velocity = " + triple(1e-6 * r.vector(k, 0, 0.3, 0.1) + velocity * odd) + "}";
      }
    });
  };
  CHECK(slow(0, 0).empty());
  CHECK(slow(1e-14, 0).starts_with("the load on R"));
  CHECK(slow(0, 1e-14).starts_with("the velocity of node P"));
  // A rod from a node to another one than in all other units, as long.
  CHECK(told(5, [](Ring& r) {
          std::string& rod = named(r.rods, "R2-P2");
          rod = replaced(rod, "['R2'", "['S2'");
        }) == "rod R2-P2 has no equal a 5th of a turn on");
  // Bars of a ring of four, across: half a turn has them in their places.
  for (const bool rods : {true, false})
    CHECK(
        told(4, [&](Ring& r) {
          for (const std::string k : {"0", "1"}) {
            const std::string nodes = "nodes = ['Q" + k + "', 'Q" + std::to_string(k[0] - '0' + 2) + "']";
            if (rods)
              r.rods.insert(r.rods.begin() + 2, "{name = 'bar " + k + "', mass = 0.3, " + nodes + "}");
            else
              r.constraints.insert(r.constraints.begin() + 2,
                                   "{name = 'bar " + k + "', kind = 'length', " + nodes + "}");
          }
        }) == (rods ? "rod bar 1 has no equal a 4th of a turn on" : "bar 1 has no equal a 4th of a turn on"));
}

// The angle of one sector is that of all of them; what pulls at it would pull at one alone.
TEST_CASE("a fold angle of one sector may be followed and not acted on") {
  const auto hoop = [](const char* kind, bool of_one) {
    Structure s =
        testing::hoop_structure({{"model", std::string("joints")}, {"units", 5L}, {"fold_angle", 63.0}});
    for (LinearForm* form : {&s.deployment.fold_sine, &s.deployment.fold_cosine}) {
      if (!of_one) continue;
      // A direction that the turns move, of the same two nodes.
      form->nodes = {0, 1};
      form->coefficients = {Vec3(0.3, 0.1, 0.2), Vec3(-0.3, -0.1, -0.2)};
    }
    Measure fold;
    fold.kind = MeasureKind::fold;
    if (kind == std::string("force")) {
      Force f;
      f.kind = "torsion_spring", f.name = "coil", f.measure = fold, f.stiffness = 12, f.rest = 0.3;
      s.forces.push_back(f);
    } else if (kind == std::string("sum")) {
      Force f;
      f.kind = "combination", f.name = "coil", f.stiffness = 12, f.rest = 0.3;
      f.measure.kind = MeasureKind::combination, f.measure.terms = {{2.0, fold}};
      s.forces.push_back(f);
    } else if (kind == std::string("constraint")) {
      Constraint c{"measure", "crank", {}, {}, 0.0, fold, {}};
      c.target.offset = s.deployment.initial_fold_angle;
      s.constraints.push_back(c);
    }
    try {
      const Sector sector(testing::make_model(s));
    } catch (const SectorRefused& refused) {
      return std::string(refused.what());
    }
    return std::string();
  };
  CHECK(hoop("sum", false) == "coil acts on the whole ring, by something else than its fold angle");
  CHECK(hoop("", false).empty());
  CHECK(hoop("", true).empty());
  CHECK(hoop("force", false).empty());
  CHECK(hoop("constraint", false).empty());
  for (const char* kind : {"force", "constraint"})
    CHECK(hoop(kind, true) == "the fold angle is that of one sector, and something acts on it");
}

// Loads, blows, cords, struts and walls of every direction, and what all units have together: the mean height
// of their Q, held by the first of the constraints. Of elastic rods their forces are part of a state.
TEST_CASE("a ring of general entries moves as one of its sectors does") {
  for (const auto& [n, axis, elastic] :
       {std::tuple{5, 0, false}, std::tuple{3, 1, false}, std::tuple{4, 2, true}}) {
    CAPTURE(n, axis);
    Structure s = Ring{n, axis, far, axis == 1,
                       [elastic = elastic](Ring& r) {
                         for (std::string& rod : r.rods)
                           if (elastic)
                             rod = replaced(rod, "mass", "area = 1e-4, youngs_modulus = 7e10, mass");
                         r.elastic = elastic;
                       }}
                      .model()
                      ->structure;
    Constraint mean{"relation", "mean", {}, {}, 0.0, {}, {}};
    for (std::size_t i = 0; i < s.nodes.size(); ++i)
      if (s.nodes[i].name[0] == 'Q') {
        mean.nodes.push_back(static_cast<int>(i));
        mean.vectors.emplace_back(Vec3::Unit(axis) / n);
        mean.value += s.nodes[i].position[axis] / n;
      }
    if (!elastic) s.constraints.insert(s.constraints.begin(), mean);
    const auto model = testing::make_model(s);
    // Of a unit, and the next one's Q and P, which its cord and its strut end at.
    const Sector sector(model);
    const Structure& of_unit = sector.model()->structure;
    CHECK(of_unit.nodes.size() == 4 + 2);
    CHECK(of_unit.rods.size() == 3);
    CHECK(of_unit.forces.size() == 2);
    CHECK(std::ranges::count(of_unit.constraints, "measure", &Constraint::kind) == 1);
    SolverOptions options = testing::dvm_options(4, elastic ? 0.005 : 0.02, elastic ? 0.06 : 0.3);
    options.model = "sector";
    const Simulation one = simulate_as_asked(model, options);
    options.model = "full";
    const Simulation full = simulate_as_asked(model, options);
    CHECK(one.solved_as.why == "one of " + std::to_string(n) + " equal sectors");
    REQUIRE(one.trajectory.size() == full.trajectory.size());
    const auto alike = [](const MatrixXd& a, const MatrixXd& b) {
      REQUIRE(a.rows() == b.rows());
      REQUIRE(a.cols() == b.cols());
      return (a - b).norm() <= 1e-6 * b.norm();
    };
    for (std::size_t i = 0; i < full.trajectory.size(); ++i) {
      // Rounding of some 5 m and of 15 steps.
      CHECK(node_distance(one.trajectory.positions(i), full.trajectory.positions(i)) < 1e-12);
      CHECK(node_distance(one.trajectory.node_velocities(i), full.trajectory.node_velocities(i)) < 1e-10);
      // Rods of 7e6 N per metre of stretch, of which rounding leaves 1e-15, in forces of some newtons.
      CHECK(alike(one.trajectory.state(i).tension, full.trajectory.state(i).tension));
      CHECK(alike(one.trajectory.state(i).stage_tension, full.trajectory.state(i).stage_tension));
    }
    const std::size_t last = full.trajectory.size() - 1;
    CHECK(node_distance(full.trajectory.positions(last), full.trajectory.positions(0)) > 0.005);
    CHECK((full.trajectory.state(last).tension.size() == (elastic ? 3 * n : 0)));
    const VectorXd a = one.trajectory.state(last).tension_error,
                   b = full.trajectory.state(last).tension_error;
    REQUIRE(a.size() == b.size());
    if (a.size() > 0) CHECK((a - b).cwiseAbs().maxCoeff() <= 0.01 * b.cwiseAbs().maxCoeff() + 1e-12);
  }
}

// Velocities in turn up and down: it is a ring of four, as which it would be solved but for one thing.
TEST_CASE("of the turns that a ring might have the one that gets furthest tells what it lacks") {
  const auto told = [](const std::string& change) {
    return refusal(
        *testing::model_of("[variables]\nn = 8\n[structure]\nkind = 'custom'\n"
                           "[[structure.nodes]]\nrepeat = {i = '0:n'}\nname = 'P{i}'\nmass = 1\n"
                           "position = ['=cos(2*pi*i/n)', '=sin(2*pi*i/n)', 0]\n"
                           "velocity = [0, 0, '=1-2*(i%2)']\n"
                           "[[structure.rods]]\nrepeat = {i = '0:n'}\nmass = 0.25\n"
                           "nodes = ['P{i}', 'P{(i+1) % n}']\n[[forces]]\nkind = 'spring'\n"
                           "repeat = {i = '0:n'}\nnodes = ['P{i}', 'P{(i+2) % n}']\n"
                           "stiffness = 50\n",
                           {change}));
  };
  CHECK(told("solver.step=0.01").empty());
  CHECK(told("structure.nodes.P4.mass=0.6") == "the mass of node P2 has no equal a 4th of a turn on");
  CHECK(told("forces[3].stiffness=50.1").ends_with(" has no equal a 4th of a turn on"));
  CHECK(told("gravity.acceleration=[1,0,-9.81]") == "gravity does not act along the ring's axis");
  CHECK(told("structure.nodes.P3.velocity=[0,0,3]").ends_with(" has no equal a 4th of a turn on"));
  CHECK(told("structure.nodes.P5.position=[-0.705,-0.709,0]").ends_with(" has no equal an 8th of a turn on"));
}

}  // namespace symmetry_test
