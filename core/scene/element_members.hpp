// SPDX-License-Identifier: BSD-3-Clause
// From the names in an entry of [[forces]] or [[constraints]] to the nodes and rods of a structure.
#pragma once

#include <string>
#include <vector>

#include "core/scene/elements.hpp"
#include "core/text/name_index.hpp"

namespace unfurl {

// Nodes within rods that were cut to bend, "ROD.1" and so on.
std::vector<bool> nodes_within_rods(const Structure& structure);
// Takes out of what a pattern matches those nodes, unless it has a point itself.
void leave_nodes_within_rods(const std::string& pattern, const std::vector<bool>& within,
                             std::vector<int>& found);
// The same of copies, whose names these are.
std::vector<int> matching_copies(const Structure& structure, const NameIndex& names,
                                 const std::string& pattern);
// What to say of a pattern for which nothing is left then.
std::string only_within_rods(const std::string& pattern);

// A vector parameter of three numbers.
inline Vec3 vec3(const ParamSet& values, std::string_view name) {
  const auto& v = values.vector(name);
  return {v[0], v[1], v[2]};
}

struct Scene;

class MemberFinder {
 public:
  explicit MemberFinder(const Structure& structure);

  // Each collects what is wrong instead of throwing; an empty result says that something was.
  std::vector<int> nodes(const SceneElement& element, bool globs);  // in the entry's order, none twice
  // Without those within rods that were cut to bend, which only a pattern with a point means: what acts on
  // each node that is named acts on nodes of the scene.
  std::vector<int> nodes_outside_rods(const SceneElement& element);
  // The same with nodes that come again: those of a path, or of several angles.
  std::vector<int> path(const SceneElement& element);
  int node(const SceneElement& element, const std::string& key, const std::string& name);  // -1: a problem
  // No node is called so, but one has it between the spaces of its name.
  bool is_part_of_name(const std::string& word) const;
  // First and last part of one rod, the same where it was not cut; null: a problem was noted.
  struct RodParts {
    const Rod *first = nullptr, *last = nullptr;
  };
  RodParts rod(const SceneElement& element, std::size_t index);
  // By their names, or the names of their groups; the name of one that was cut is that of all its parts.
  std::vector<int> rods(const SceneElement& element);
  // The angle that an entry names, with a sign where `axis` is not zero. False: a problem was noted.
  bool angle(const SceneElement& element, const Vec3& axis, Measure& measure);

  // False, a problem noted for `key`: the two nodes are at one place, so that no direction leads from the one
  // to the other.
  bool apart(const SceneElement& element, const std::string& key, int a, int b);
  // False, a problem noted: a line of the angle has no direction, or is along its axis. `key`: the entry's
  // that gives both; none: those of its members and "axis".
  bool angle_is_defined(const SceneElement& element, const Measure& measure, const std::string& key = "");
  // Lines of an angle that leave its hinge along a rod that was cut to bend are its tangent there.
  void follow_bends(Measure& angle) const;
  // False, a problem noted for `key`: a sum that nothing changes that moves.
  bool varies(const SceneElement& element, const std::string& key, const Measure& sum);
  double initial(const Measure& measure) const;  // at the structure's start
  // Values of the measure that are no further apart are one [m] or [rad]: what is typed or worked out
  // elsewhere has some nine digits, of a length beside the structure's size.
  double same(const Measure& measure, double value) const;
  void problem(const SceneElement& element, const std::string& key, std::string message);
  void throw_problems();  // SceneError, where there are any

 private:
  struct CutRod {
    std::string whole;
    int first, last;  // parts
  };
  bool stays(const Measure& term, bool acts) const;
  bool cancels(const Measure& sum) const;
  std::vector<int> rods_matching(const std::string& pattern) const;
  Vec3 start_of(int node) const { return start_.segment<3>(3 * node); }
  const std::string& name_of(int node) const { return structure_.nodes[static_cast<std::size_t>(node)].name; }
  std::string similar_rod(const std::string& name) const;

  const Structure& structure_;
  NameIndex node_names_, rod_names_;
  std::vector<CutRod> parts_;
  VectorXd start_;
  std::vector<SceneProblem> problems_;
};

// Where the `add` of an ElementKind puts what an entry means.
struct ElementAdder {
  Structure& structure;
  double end_time;  // of the run: drives are looked at until then [s]
  MemberFinder find;
  bool may_end_before;  // where the structure is deployed

  const Node& node(int index) const { return structure.nodes[static_cast<std::size_t>(index)]; }
  // A direction of length 1; zero after a problem was noted.
  Vec3 direction(const SceneElement& element, const std::string& key);
};

// The measures of kinds that name a path or terms.
std::optional<Measure> path_of(const SceneElement& element, MemberFinder& find);
std::optional<Measure> terms_of(const SceneElement& element, MemberFinder& find);
std::optional<Measure> sum_of_terms(const SceneElement& element, MemberFinder& find, const std::string& key);
// A number or a kind of measure is its first word.
bool begins_as_term(const std::string& text);
// Notes that a single dihedral is to go from `initial` to `target`, which `key` gives, by more than half a
// turn [rad, times its coefficient]: its sign may be another than was thought.
void note_long_way(const SceneElement& element, const std::string& key, const Measure& measure,
                   double initial, double target, Structure& structure);
// An elastic cable, or one that is only paid out and drawn in.
void add_cable(const SceneElement& element, ElementAdder& to);

// What [deployment] says, into a structure. Throws SceneError.
void give_deployment(const Scene& scene, Structure& structure);

// "a distance stays > 0", or what else ends the values of a measure.
std::string values_within(const Measure& measure);
// How the entry's value moves from `initial` on [m] or [rad]; what it cannot reach is noted.
TimeFunction motion_of(const SceneElement& element, ElementAdder& to, const Measure& measure, double initial);

// A required direction, of any length but 0.
ParamSpec direction_param(std::string_view name, std::string_view help);

// A coordinate of a node, or the difference of two, along `direction`; any measure that the members say.
std::optional<Measure> coordinate_of(const SceneElement& element, MemberFinder& find);
std::optional<Measure> measure_of(const SceneElement& element, MemberFinder& find);
// An angle that may grow: without an axis not one of rods in line.
std::optional<Measure> driven_angle(const SceneElement& element, MemberFinder& find);

// Throws SceneError: rigid rods stand between their nodes as they are given, and what warms them at t = 0
// already has no place to go.
void refuse_warm_start(const Scene& scene, const Structure& structure);

// Kinds of [[constraints]] that combine measures in one row, and those that hold, drive or bound a measure.
const std::vector<ElementKind>& combined_kinds();
const std::vector<ElementKind>& measured_kinds();

}  // namespace unfurl
