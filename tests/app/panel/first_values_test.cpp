// SPDX-License-Identifier: BSD-3-Clause
// What the menus of the left pane add is accepted as it stands, acts on what moves, and runs.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "app/panel/document/element_menu.hpp"
#include "app/panel/document/scene_entries.hpp"
#include "core/scene/build.hpp"
#include "core/simulate/simulation.hpp"

using namespace unfurl;

namespace first_values_test {

namespace {

const std::vector<std::string> scenes = {"pendulum", "four_bar", "hoop6", "hoberman", "scissor_mast"};

bool has_rods_that_meet(const Structure& structure) {
  std::multiset<int> ends;
  for (const Rod& rod : structure.rods) ends.insert(rod.a), ends.insert(rod.b);
  return std::ranges::any_of(ends, [&](int node) { return ends.count(node) > 1; });
}

// These may have no place, by the structure alone: a motion of one degree of freedom is left none by most of
// what holds, and what relates nodes to each other must be so at t = 0 already.
bool may_be_refused(const ElementOffer& offer, const Structure& structure) {
  static const std::set<std::string_view> holding = {"fixed", "line", "plane",     "equal",    "mirror",
                                                     "gear",  "rack", "collinear", "coplanar", "relation"};
  static const std::set<std::string_view> hinged = {"angle",   "angle_stop",     "motor",
                                                    "bending", "torsion_spring", "joint_damping"};
  static const std::set<std::string_view> along_a_rod = {"length", "telescope", "combination", "cable"};
  const bool constraint = offer.table == "constraints";
  if (constraint && holding.contains(offer.kind)) return true;
  if (hinged.contains(offer.kind)) return !has_rods_that_meet(structure);
  if (constraint && along_a_rod.contains(offer.kind)) return structure.nodes.size() == 2;  // one rod's ends
  return offer.kind == "latch" && structure.deployment.empty();
}

std::vector<ElementOffer> all_offers() {
  std::vector<ElementOffer> all;
  for (const char* table : {"loads", "forces", "constraints"})
    for (const ElementOffer& offer : element_offers(table)) all.push_back(offer);
  return all;
}

// What is new among the warnings of a scene.
std::vector<std::string> new_notes(const Structure& with, const Structure& without) {
  std::vector<std::string> fresh;
  for (const std::string& note : with.notes)
    if (std::ranges::find(without.notes, note) == without.notes.end()) fresh.push_back(note);
  return fresh;
}

// Empty: it was refused, with words.
std::string entry_or_why(const SceneDocument& document, const ElementOffer& offer,
                         const Selection& selected = {}) {
  try {
    return new_entry(document, offer.table, offer.kind, selected, offer.extra);
  } catch (const SceneError& error) {
    CHECK(std::string(error.what()).size() > 20);
    return "";
  }
}

Simulation run_of(const Scene& scene, double end_time, double step) {
  SolverOptions options = scene.solver;
  options.end_time = end_time;
  options.step = step;
  return simulate(build_model(scene), options);
}

double largest_way(const Simulation& run) {  // of a node from its start
  const VectorXd first = run.trajectory.node_positions(0),
                 last = run.trajectory.node_positions(run.trajectory.size() - 1);
  return (last - first).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("every entry that the menus offer is accepted as it stands and runs") {
  for (const std::string& name : scenes) {
    const SceneDocument document = open_document(name, {});
    const Structure without = build_structure(base_scene(document));
    for (const ElementOffer& offer : all_offers()) {
      const std::string entry = entry_or_why(document, offer);
      INFO(name << ": " << offer.table << " " << offer.kind << ": " << entry);
      if (entry.empty()) {
        CHECK(may_be_refused(offer, without));
        continue;
      }
      const Scene scene = base_scene(with_entry(document, entry));
      const Simulation run = run_of(scene, 0.05, scene.solver.step);
      INFO(run.message);
      CHECK((run.status == RunStatus::completed || run.status == RunStatus::deployed));
      // What does nothing anywhere in this scene says so: without a weight, or without at_deployed = "latch".
      if (offer.kind != "offload" && offer.kind != "latch")
        CHECK(new_notes(run.trajectory.structure(), without).empty());
    }
  }
}

TEST_CASE("what is added to a node alone acts on one that moves") {
  const std::map<std::string, std::set<std::string>> still = {{"pendulum", {"pivot"}},
                                                              {"four_bar", {"A", "D"}}};
  for (const auto& [name, held] : still) {
    const SceneDocument document = open_document(name, {});
    for (const ElementOffer& offer : all_offers()) {
      const bool load = offer.table == "loads" || offer.kind == "drag" || offer.kind == "load_over_time" ||
                        offer.kind == "offload" || offer.kind == "coordinate" ||
                        offer.kind == "coordinate_stop" || offer.kind == "joint_damping";
      const std::string entry = load ? entry_or_why(document, offer) : "";
      if (entry.empty()) continue;
      const Scene scene = base_scene(with_entry(document, entry));
      INFO(name << ": " << entry);
      const auto& nodes = offer.table == "loads"    ? scene.loads.back().nodes
                          : offer.table == "forces" ? scene.forces.back().nodes
                                                    : scene.constraints.back().nodes;
      CHECK_FALSE(held.contains(nodes.at(0)));
    }
  }
}

TEST_CASE("a new drive goes all its way and a new stop or pin does not hold everything") {
  for (const std::string& name : scenes) {
    const SceneDocument document = open_document(name, {});
    for (const ElementOffer& offer : all_offers()) {
      static const std::set<std::string_view> moving = {"angle",       "length",          "coordinate",
                                                        "telescope",   "combination",     "angle_stop",
                                                        "length_stop", "coordinate_stop", "clearance"};
      if (offer.table != "constraints" || !moving.contains(offer.kind)) continue;
      const std::string entry = entry_or_why(document, offer);
      if (entry.empty()) continue;
      INFO(name << ": " << entry);
      const Scene scene = base_scene(with_entry(document, entry));
      // 200 steps: of where it goes, not of how exactly.
      const Simulation run = run_of(scene, scene.solver.end_time, scene.solver.end_time / 200);
      INFO(run.message);
      CHECK((run.status == RunStatus::completed || run.status == RunStatus::deployed));
      CHECK(largest_way(run) > 0.01);  // [m], of structures of some metres
    }
    // The end stop of the hinge that deploys is met in the deployed pose, not before.
    const Scene alone = base_scene(document);
    if (!build_structure(alone).deployment.folds()) continue;
    const Scene stopped =
        base_scene(with_entry(document, new_entry(document, "constraints", "angle_stop", {})));
    const double step = alone.solver.end_time / 200;
    const Simulation free = run_of(alone, alone.solver.end_time, step),
                     held = run_of(stopped, alone.solver.end_time, step);
    CHECK(free.status == RunStatus::deployed);
    CHECK(held.status == RunStatus::deployed);
    CHECK(held.trajectory.time(held.trajectory.size() - 1) ==
          Approx(free.trajectory.time(free.trajectory.size() - 1)).margin(step));
  }
}

TEST_CASE("an entry on what is selected is accepted too or says why not") {
  for (const std::string name : {"pendulum", "four_bar"}) {
    const SceneDocument document = open_document(name, {});
    for (const Node& node : build_structure(base_scene(document)).nodes)
      for (const ElementOffer& offer : all_offers()) {
        const std::string entry = entry_or_why(document, offer, {Selection::Kind::node, node.name});
        INFO(name << " " << node.name << ": " << entry);
        if (!entry.empty()) CHECK_NOTHROW(build_model(base_scene(with_entry(document, entry))));
      }
  }
}

TEST_CASE("a new stop is that of the scene as it was edited") {
  SceneDocument document = open_document("pendulum", {});
  document.edits["structure.length"] = 3.0;
  document =
      with_entry(document, new_entry(document, "constraints", "length_stop", {Selection::Kind::node, "bob"}));
  const Scene scene = read_document(document);
  // The rod's 3 m less a tenth.
  CHECK(scene.constraints.at(0).values.real("min") == Approx(2.7));
  CHECK_NOTHROW(build_model(scene));
}

}  // namespace first_values_test
