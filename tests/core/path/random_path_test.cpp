// SPDX-License-Identifier: BSD-3-Clause
// A four-bar linkage under random forces, cables and stops: along its path and by the full model.
#include <catch2/catch.hpp>
#include <cmath>
#include <initializer_list>
#include <random>
#include <set>

#include "core/path/path_run.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "tests/support/number.hpp"
#include "tests/support/runs_apart.hpp"

using namespace unfurl;
using unfurl::testing::joined;
using unfurl::testing::number;
using unfurl::testing::runs_apart;

namespace random_path_test {

namespace {

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}

  // Changes to the scene four_bar.
  std::vector<std::string> changes() {
    // Friction beside stops and cables is not the path's.
    const bool friction = below(4) == 0;
    if (friction) {
      const double kinetic = in(0.05, 8);
      force("friction", {hinge(), ",kinetic=", number(kinetic), ",static=", number(kinetic * in(1, 1.6))});
    }
    const int entries = 1 + below(4);
    for (int i = 0; i < entries; ++i) add(below(friction ? 7 : 10));
    if (below(3) == 0) {
      // Its velocities are a multiple of those that agree with its rods.
      const double f = in(-1, 1.2);
      out_.push_back("structure.nodes[1].velocity=[" + number(3.4 * f) + ",0,0]");
      out_.push_back("structure.nodes[2].velocity=[" + number(3.12 * f) + ",0," + number(0.52 * f) + "]");
    }
    return out_;
  }

 private:
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  double in(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  double some(double most) { return below(2) ? in(0, most) : 0.0; }

  void force(const std::string& kind, std::initializer_list<std::string> words) {
    out_.push_back("forces[" + std::to_string(forces_++) + "]={kind=\"" + kind + "\"," + joined(words) + "}");
  }
  void stop(const std::string& nodes) {
    const bool upper = below(2);
    out_.push_back(joined({"constraints[", std::to_string(stops_++), "]={kind=\"length_stop\",", nodes,
                           upper ? ",max=" + number(in(3.6, 4.2)) : ",min=" + number(in(1.6, 2.6)),
                           ",restitution=", number(some(0.9)), "}"}));
  }

  std::string hinge() {
    return below(2) ? R"(rods=["crank","coupler"],axis=[0,1,0])"
                    : R"(rods=["rocker","coupler"],axis=[0,1,0])";
  }

  void add(int kind) {
    const std::string ends = below(2) ? R"(nodes=["B","D"])" : R"(nodes=["A","C"])";
    const std::string node = below(2) ? R"(nodes=["B"])" : R"(nodes=["C"])";
    switch (kind) {
      case 0:
        return force("spring", {ends, ",stiffness=", number(in(1, 100)), ",damping=", number(some(5)),
                                ",free_length=", number(in(1.5, 4.5))});
      case 7:
      case 8:
        return force("spring", {ends, ",tension_only=true,stiffness=", number(in(1, 300)),
                                ",damping=", number(some(9)), ",free_length=", number(in(2.2, 4))});
      case 1:
        return force("torsion_spring",
                     {hinge(), ",stiffness=", number(in(0.5, 20)), ",damping=", number(some(1))});
      case 2: {
        const double begin = in(0, 0.7);
        return force("load_over_time", {node, ",force=[", number(in(-5, 5)), ",0,", number(in(-5, 5)),
                                        "],times=[", number(begin), ",", number(begin + in(0.1, 0.6)),
                                        "],values=[", number(in(-2, 2)), ",", number(in(-2, 2)), "]"});
      }
      case 3:
        return force("follower", {"rod=\"coupler\",force=", number(in(-4, 4))});
      case 4:
        return force("joint_damping", {R"(nodes=["B","C"],damping=)", number(in(0.01, 1))});
      case 5:
        return force("drag", {node, ",damping=", number(in(0.01, 2))});
      case 6:
        return force("motor", {hinge(), ",stall_torque=", number(in(0.2, 2)),
                               ",no_load_speed=", number(in(30, 300)), ",gear_ratio=", number(in(2, 9))});
      default:
        return stop(ends);
    }
  }

  std::mt19937 random_;
  std::vector<std::string> out_;
  int forces_ = 0, stops_ = 0;
};

// Events but for a stop that is left within rounding of the time at which it was met, by forces of zero.
std::vector<const Event*> lasting(const Simulation& run) {
  std::vector<const Event*> out;
  for (const Event& event : run.events) {
    if (event.kind == "free" && !out.empty() && out.back()->element == event.element &&
        event.t - out.back()->t < 1e-9)
      continue;
    out.push_back(&event);
  }
  return out;
}

// What is said of an event, by its kind.
std::string said_of(const Event& event) {
  if (event.kind == "contact" && event.name.starts_with("rests")) return "rests on stop " + event.element;
  if (event.kind == "contact") return "stop " + event.element;
  if (event.kind == "free") return "leaves stop " + event.element;
  if (event.kind == "taut") return event.element + " pulls";
  if (event.kind == "slack") return event.element + " is slack";
  if (event.kind == "stick") return event.element + " sticks";
  if (event.kind == "slip") return event.element + " slips";
  if (event.kind == "reversal") return event.element + " slips the other way";
  return event.name;
}

}  // namespace

TEST_CASE("whatever acts on a linkage, it moves along its path as by the full model") {
  int compared = 0, with_events = 0;
  std::set<std::string> kinds;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    const std::vector<std::string> changes = Draw(seed).changes();
    std::string said;
    for (const std::string& change : changes) said += "\n  " + change;
    INFO("seed " << seed << said);
    Scene scene = read_scene_file(find_scene("four_bar"), changes);
    SolverOptions options = scene.solver;
    options.nodes = "lobatto", options.constraints_at = "nodes", options.stages = 7;
    options.end_time = 1.5;
    std::shared_ptr<const Model> model;
    try {
      model = build_model(scene);
    } catch (const Error&) {
      continue;  // a stop that is passed at the start
    }
    const Simulation path = simulate_on_path(model, options), full = simulate(model, options);
    SolverOptions finer = options;
    finer.step /= 2;
    // Order 12: half the step is right to a thousandth of the difference; 1e-11 for rounding, ten times at
    // impacts.
    const double own = runs_apart(full, simulate(model, finer));
    CHECK(own < 1e-7);
    CHECK(path.status == full.status);
    CHECK(path.trajectory.end_time() == Approx(full.trajectory.end_time()).epsilon(0).margin(1e-9));
    CHECK(runs_apart(path, full) <= 2e-11 + 1.1 * own);
    const auto a = lasting(path), b = lasting(full);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      CHECK(a[i]->name == b[i]->name);
      CHECK(b[i]->name == said_of(*b[i]));
      kinds.insert(b[i]->kind);
      CHECK(a[i]->element == b[i]->element);
      CHECK(a[i]->t == Approx(b[i]->t).epsilon(0).margin(1e-9 + 100 * own));  // at a slow rate
    }
    ++compared;
    with_events += !a.empty();
  }
  CHECK(compared > 120);
  CHECK(with_events > 40);
  for (const char* kind : {"contact", "taut", "slack", "stick", "reversal"}) {
    INFO(kind);
    CHECK(kinds.count(kind) == 1);
  }
}

}  // namespace random_path_test
