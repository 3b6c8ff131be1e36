// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/document/scene_entries.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/scene/build.hpp"
#include "core/scene/write.hpp"

namespace unfurl {

namespace {

std::string entry_key_of(std::string_view table, std::size_t index) {
  return std::string(table) + "[" + std::to_string(index) + "]";
}

// "forces[2].damping=1" -> "forces" and 2; index -1 where it is none of an entry.
struct EntryIndex {
  std::string table;
  long index = -1;
};
EntryIndex entry_index(const std::string& text) {
  const std::size_t open = text.find('[');
  if (open == std::string::npos || text.find_first_of(".=") < open) return {};
  return {text.substr(0, open), std::strtol(text.c_str() + open + 1, nullptr, 10)};
}

// Nodes and rods by which an entry can begin.
class FirstMembers {
 public:
  FirstMembers(const Structure& structure, const Selection& selected) : structure_(structure) {
    for (std::size_t i = 0; i < structure.nodes.size(); ++i)
      if (selected.kind == Selection::Kind::node && structure.nodes[i].name == selected.name)
        node_ = static_cast<int>(i), chosen_ = true;
    for (std::size_t i = 0; i < structure.rods.size(); ++i)
      if (selected.kind == Selection::Kind::rod && structure.rods[i].name == selected.name) {
        rod_ = i;
        node_ = structure.rods[i].a;
      }
  }

  const std::string& rod() const { return structure_.rods.at(rod_).name; }
  std::vector<std::string> nodes(std::size_t count) const {
    std::vector<int> found{node_};
    for (int i = 0; found.size() < count && i < static_cast<int>(structure_.nodes.size()); ++i)
      if (i != node_ && !(found.size() == 1 && joined(node_, i))) found.push_back(i);
    for (int i = 0; found.size() < count && i < static_cast<int>(structure_.nodes.size()); ++i)
      if (std::find(found.begin(), found.end(), i) == found.end()) found.push_back(i);
    return names(found);
  }
  // Two rods that meet: the hinge in the middle; empty: none do.
  std::vector<std::string> hinge() const {
    for (std::size_t k = 0; k < structure_.nodes.size(); ++k) {
      const int middle = (node_ + static_cast<int>(k)) % static_cast<int>(structure_.nodes.size());
      std::vector<int> ends;
      for (const Rod& rod : structure_.rods)
        if (rod.a == middle || rod.b == middle) ends.push_back(rod.a == middle ? rod.b : rod.a);
      if (ends.size() >= 2) return names({ends[0], middle, ends[1]});
    }
    return {};
  }
  bool by_fold_angle() const { return !chosen_ && structure_.deployment.folds(); }

 private:
  bool joined(int a, int b) const {
    return std::any_of(structure_.rods.begin(), structure_.rods.end(), [&](const Rod& rod) {
      return (rod.a == a && rod.b == b) || (rod.a == b && rod.b == a);
    });
  }
  std::vector<std::string> names(const std::vector<int>& nodes) const {
    std::vector<std::string> all;
    for (const int node : nodes) all.push_back(structure_.nodes[static_cast<std::size_t>(node)].name);
    return all;
  }

  const Structure& structure_;
  int node_ = 0;
  std::size_t rod_ = 0;
  bool chosen_ = false;  // a node was
};

std::size_t least_nodes(std::string_view kind) {
  if (kind == "coplanar") return 4;
  if (kind == "collinear") return 3;
  if (kind == "gear") return 6;
  if (kind == "rack") return 4;
  return kind == "equal" || kind == "cable" || kind == "telescope" ? 2 : 1;
}

void add_member(std::string& text, std::string_view key, const ParamValue& value) {
  text.append(text.empty() ? "" : ", ").append(key).append(" = ").append(toml_value(value));
}

void add_members(std::string& text, const ElementKind& kind, const FirstMembers& members) {
  switch (kind.members) {
    case Members::none:
      return;
    case Members::rod:
      return add_member(text, "rod", members.rod());
    case Members::terms: {
      const std::vector<std::string> pair = members.nodes(2);
      return add_member(text, "terms", std::vector<std::string>{"1 length " + pair[0] + " " + pair[1]});
    }
    case Members::angle:
    case Members::measure:
      if (members.by_fold_angle()) return add_member(text, "fold_angle", true);
      if (kind.members == Members::measure && members.hinge().empty())
        return add_member(text, "nodes", members.nodes(2));
      return add_member(text, "nodes", members.hinge());
    case Members::two_nodes:
      return add_member(text, "nodes", members.nodes(2));
    case Members::three_nodes:
      return add_member(text, "nodes", members.hinge());
    case Members::rods:
      return add_member(text, "rods", members.rod());
    case Members::path:
      return add_member(text, "nodes", members.nodes(std::max<std::size_t>(2, least_nodes(kind.kind))));
    case Members::each_node:
    case Members::node_list:
      return add_member(text, "nodes", members.nodes(least_nodes(kind.kind)));
  }
}

// What must be there, and what makes the entry do something.
void add_values(std::string& text, const ElementKind& kind) {
  bool stiff = false;
  for (const ParamSpec& spec : kind.params()) {
    const bool axial = spec.name == "axial_stiffness";
    stiff = stiff || axial || spec.name == "stiffness";
    if (axial || spec.name == "stiffness")
      add_member(text, spec.name, axial ? 1000.0 : 10.0);
    else if (spec.kind == ParamKind::real && (spec.required || (spec.name == "damping" && !stiff)))
      add_member(text, spec.name, 1.0);
    else if (spec.name == "radii")
      add_member(text, spec.name, std::vector<double>{1.0, 1.0});
    else if (spec.kind == ParamKind::vector && spec.required)
      add_member(text, spec.name, std::vector<double>{0.0, 0.0, spec.name == "force" ? -1.0 : 1.0});
  }
}

bool has_param(const ElementKind& kind, std::string_view name) {
  return std::any_of(kind.params().begin(), kind.params().end(),
                     [&](const ParamSpec& spec) { return spec.name == name; });
}

// What an entry measures at t = 0, to six digits behind the point; 0 where that cannot be told.
double value_at_start(const SceneDocument& document, const std::string& key, const std::string& members) {
  try {
    const Structure structure = build_structure(base_scene(document));
    const Scene scene = base_scene(with_entry(document, key + "={" + members + "}"));
    for (const SceneElement& element : scene.constraints)
      if (const double x = start_value(element, structure); element.key == key && std::isfinite(x))
        return std::round(1e6 * x) / 1e6;
  } catch (const SceneError&) {  // will be said of the entry itself
  }
  return 0.0;
}

// How many entries a table of the scene has.
std::size_t entries_of(const Scene& scene, std::string_view table) {
  if (table == "loads") return scene.loads.size();
  const auto& all = table == "forces" ? scene.forces : scene.constraints;
  return static_cast<std::size_t>(std::count_if(
      all.begin(), all.end(), [&](const SceneElement& element) { return element.key.starts_with(table); }));
}

// Where a new drive goes: somewhere that is seen. The deployed pose itself may be singular.
double drive_target(const ElementKind& kind, const Structure& structure, double now, bool fold) {
  constexpr double short_of_deployed = 0.05;
  if (fold) {
    const double deployed = structure.deployment.deployed_fold_angle / radians_per_degree;
    return deployed + short_of_deployed * (now - deployed);
  }
  if (kind.members == Members::angle) return now + (now > 90 ? -15 : 15);
  return kind.members == Members::two_nodes ? 0.9 * now : now + 0.1;
}

// A drive that moves, a stop that is there.
void add_start(std::string& text, const ElementKind& kind, const SceneDocument& document,
               const Structure& structure, const std::string& key, double end_time) {
  const bool stop = has_param(kind, "restitution");
  if (!stop && (!has_param(kind, "motion") || key.starts_with("forces"))) return;
  if (stop && !has_param(kind, "min")) return;
  const double now = value_at_start(document, key, text);
  if (stop) return add_member(text, "min", now);
  const bool fold = text.find("fold_angle = true") != std::string::npos;
  add_member(text, "motion", std::string("smooth"));
  add_member(text, "to", std::round(1e3 * drive_target(kind, structure, now, fold)) / 1e3);
  add_member(text, "duration", end_time);
}

}  // namespace

std::string new_entry(const SceneDocument& document, std::string_view table, std::string_view kind_name,
                      const Selection& selected, std::string_view extra) {
  const Scene base = base_scene(document);
  Scene bare = base;
  bare.loads.clear();
  bare.forces.clear();
  bare.constraints.clear();
  const Structure structure = build_structure(bare);
  const FirstMembers members(structure, selected);
  const std::string key = entry_key_of(table, entries_of(base, table));
  std::string text;
  if (table == "loads") {
    add_member(text, "nodes", members.nodes(1));
    add_member(text, "force", std::vector<double>{0.0, 0.0, -1.0});
  } else {
    const ElementKind& kind = *find_kind(table == "forces" ? scene_forces() : scene_constraints(), kind_name);
    if (kind_name == "latch" && structure.deployment.empty())
      throw SceneError({{{"", 0, 0}, key, "the structure has no deployed pose to latch in"}});
    const bool hinged = kind.members == Members::three_nodes || kind_name == "motor";
    if (hinged && members.hinge().empty())
      throw SceneError({{{"", 0, 0}, key, "the structure has no two rods that share a node"}});
    add_member(text, "kind", std::string(kind_name));
    add_members(text, kind, members);
    add_values(text, kind);
    add_start(text, kind, document, structure, key, base.solver.end_time);
  }
  if (!extra.empty()) text.append(", ").append(extra);
  const std::string entry = key + "={" + text + "}";
  base_scene(with_entry(document, entry));  // can be read
  return entry;
}

SceneDocument with_entry(SceneDocument document, std::string entry) {
  document.added.push_back(std::move(entry));
  return document;
}

bool is_added(const SceneDocument& document, const std::string& key) {
  return std::any_of(document.added.begin(), document.added.end(),
                     [&](const std::string& text) { return text.starts_with(key + "="); });
}

SceneDocument without_entry(SceneDocument document, const std::string& key) {
  const EntryIndex gone = entry_index(key);
  // Nothing: of the one that goes.
  const auto moved = [&](const std::string& text) -> std::string {
    const EntryIndex at = entry_index(text);
    if (at.table != gone.table || at.index < gone.index) return text;
    if (at.index == gone.index) return "";
    return entry_key_of(at.table, static_cast<std::size_t>(at.index - 1)) + text.substr(text.find(']') + 1);
  };
  std::vector<std::string> added;
  for (const std::string& text : document.added)
    if (std::string kept = moved(text); !kept.empty()) added.push_back(std::move(kept));
  std::map<std::string, ParamValue> edits;
  for (auto& [name, value] : document.edits)
    if (const std::string kept = moved(name); !kept.empty()) edits.emplace(kept, std::move(value));
  document.added = std::move(added);
  document.edits = std::move(edits);
  return document;
}

}  // namespace unfurl
