// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/document/scene_entries.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "app/panel/document/entry_members.hpp"
#include "core/scene/build.hpp"
#include "core/scene/write.hpp"
#include "core/structure/node_positions.hpp"
#include "core/system/consistency.hpp"

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

// What must be there, and what makes the entry do something; without what `text` says already.
void add_values(std::string& text, const ElementKind& kind) {
  bool stiff = false;
  for (const ParamSpec& spec : kind.params()) {
    const bool axial = spec.name == "axial_stiffness";
    stiff = stiff || axial || spec.name == "stiffness";
    if (text.find(std::string(spec.name) + " = ") != std::string::npos || spec.name == "clearance") continue;
    if (axial || spec.name == "stiffness")
      add_member(text, spec.name, axial ? 1000.0 : 10.0);
    else if (spec.name == "expansion")
      add_member(text, spec.name, 1e-5);
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

bool acts_on_hinge(const ElementKind& kind) {
  return kind.members == Members::angle || kind.members == Members::three_nodes ||
         kind.kind == "joint_damping";
}

// How many entries a table of the scene has.
std::size_t entries_of(const Scene& scene, std::string_view table) {
  if (table == "loads") return scene.loads.size();
  const auto& all = table == "forces" ? scene.forces : scene.constraints;
  return static_cast<std::size_t>(std::count_if(
      all.begin(), all.end(), [&](const SceneElement& element) { return element.key.starts_with(table); }));
}

// To two digits of `change`, towards `sense` (0: the nearest).
double to_digits(double value, double change, int sense) {
  if (change == 0) return value;
  const double grid = std::pow(10.0, std::floor(std::log10(std::abs(change))) - 1);
  const double steps = value / grid;
  const double whole = sense < 0 ? std::floor(steps) : sense > 0 ? std::ceil(steps) : std::round(steps);
  return grid < 1 ? whole / std::round(1 / grid) : whole * grid;  // 2.7, not 2.7000000000000002
}

// A scene to which an entry comes: with its edits, where it can be built with them.
struct SceneBefore {
  explicit SceneBefore(const SceneDocument& given) : document(given) {
    for (const bool edited : {true, false}) {
      if (!edited) document.edits.clear();
      try {
        scene = read_document(document);
        structure = build_model(scene)->structure;
        sound = true;
        return;
      } catch (const SceneError&) {  // is said where it is
      }
    }
    scene = read_document(document);
    Scene bare = scene;
    bare.loads.clear();
    bare.forces.clear();
    bare.constraints.clear();
    structure = build_structure(bare);
  }

  SceneDocument document;
  Scene scene;
  Structure structure;
  bool sound = false;
};

// One entry of a kind on members of the structure, tried in the scene.
class FirstEntry {
 public:
  FirstEntry(const SceneBefore& ground, const FreeReach& reach, const ElementKind* kind, std::string key,
             std::string_view extra)
      : ground_(ground), reach_(reach), kind_(kind), key_(std::move(key)), extra_(extra) {}

  // Empty: what it drives does not move.
  std::string with(const std::string& members) const {
    std::string text;
    if (kind_) {
      add_member(text, "kind", std::string(kind_->kind));
      if (!members.empty()) text.append(", ").append(members);
      add_values(text, *kind_);
      if (!add_start(text)) return "";
    } else {
      text = members;
      add_member(text, "force", std::vector<double>{0.0, 0.0, -1.0});
    }
    if (!extra_.empty()) text.append(", ").append(extra_);
    return key_ + "={" + text + "}";
  }

  // Throws SceneError where the scene cannot be run with it. False: it can, and warns of something new.
  bool is_sound(const std::string& entry) const {
    const Scene scene = read_document(with_entry(ground_.document, entry));
    if (!ground_.sound) return true;
    const auto model = build_model(scene);
    const Structure& structure = model->structure;
    if (drives() || (kind_ && kind_->members == Members::rods)) check_midway(*model, scene.solver.end_time);
    // A line through the bob along its velocity lets it move by nothing but a rate.
    if (holds() && reach_.known() && !FreeReach(structure).known())
      throw SceneError({{{"", 0, 0}, key_, "holds the only motion that the structure has"}});
    return structure.notes.size() <= ground_.structure.notes.size();
  }

 private:
  // What begins at rest asks for nothing at t = 0.
  void check_midway(const Model& model, double end_time) const {
    const std::string against = driven_against(model.system, 0.5 * end_time, node_positions(model.structure));
    if (!against.empty())
      throw SceneError({{{"", 0, 0}, key_, "no motion follows it: the structure holds " + against}});
  }
  bool drives() const { return kind_ && has_param(*kind_, "motion") && key_.starts_with("constraints"); }
  bool holds() const { return kind_ && key_.starts_with("constraints") && !drives() && !kind_->bounds; }

  // What the entry measures: of no element nothing.
  FreeReach::Range range_of(const std::string& text) const {
    try {
      const Scene scene = read_document(with_entry(ground_.document, key_ + "={" + text + "}"));
      for (const auto* list : {&scene.forces, &scene.constraints})
        for (const SceneElement& element : *list)
          if (element.key == key_) return reach_.of(element);
    } catch (const SceneError&) {  // will be said of the entry itself
    }
    return {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  }

  // From cold to warm in the time of the run: rigid rods have no place to go at t = 0.
  void add_warming(std::string& text) const {
    add_member(text, "change", 50.0);
    add_member(text, "times", std::vector<double>{0.0, ground_.scene.solver.end_time});
    add_member(text, "values", std::vector<double>{0.0, 1.0});
  }

  double change(double now) const {
    if (kind_->members == Members::angle) return 15;
    return kind_->members == Members::two_nodes ? 0.1 * now : 0.1;
  }

  // A drive that moves to where it can, a stop that is there.
  bool add_start(std::string& text) const {
    const bool stop = has_param(*kind_, "min"), play = kind_->kind == "clearance";
    if (kind_->kind == "temperature") return add_warming(text), true;
    if (!stop && !play && !drives()) return true;
    const bool fold = text.find("fold_angle = true") != std::string::npos;
    const Deployment& deployment = ground_.structure.deployment;
    const double deployed = deployment.deployed_fold_angle / radians_per_degree;
    if (play) return add_play(text);
    if (fold && stop) return add_member(text, "min", to_digits(deployed, 1, -1)), true;
    const FreeReach::Range range = range_of(text);
    const double now = std::isfinite(range.now) ? range.now : 0.0;
    if (stop) {  // near enough to be met
      const double least = kind_->members == Members::angle ? std::min(change(now), 0.5 * now) : change(now);
      return add_member(text, "min", to_digits(now - least, least, -1)), true;
    }
    add_member(text, "motion", std::string("smooth"));
    // The deployed pose itself may be singular.
    constexpr double short_of_deployed = 0.05;
    if (fold)
      add_member(text, "to", std::round(1e3 * (deployed + short_of_deployed * (now - deployed))) / 1e3);
    else if (const double way = way_of(range, now); way != 0)
      add_member(text, "to", to_digits(now + way, way, 0));
    else
      return false;
    add_member(text, "duration", ground_.scene.solver.end_time);
    return true;
  }

  // Where a new drive goes: somewhere that is seen, and can be reached. 0: nowhere.
  double way_of(const FreeReach::Range& range, double now) const {
    constexpr double sure = 0.8;  // of the way that is known
    const bool shorter = kind_->members == Members::angle ? now > 90 : kind_->members == Members::two_nodes;
    const double wanted = change(now);
    if (!reach_.known()) return shorter ? -wanted : wanted;
    const bool down = shorter ? sure * range.down >= wanted || range.down >= range.up
                              : sure * range.up < wanted && range.down > range.up;
    const double way = std::min(wanted, sure * (down ? range.down : range.up));
    if (way < 1e-3 * wanted) return 0;
    return down ? -way : way;
  }

  // A hole that the pin is in at t = 0, and has some way to go in.
  bool add_play(std::string& text) const {
    constexpr double least = 1e-3;  // [m]
    std::string spring = text;      // which measures the distance that such a pin bounds
    spring.replace(spring.find("clearance"), std::string_view("clearance").size(), "length");
    const FreeReach::Range range = range_of(spring);
    const double apart = std::isfinite(range.now) ? range.now : 0.0;
    const double clearance = std::max(least, apart + std::max(0.1 * apart, range.up));
    add_member(text, "clearance", to_digits(clearance, clearance, 1));
    return true;
  }

  const SceneBefore& ground_;
  const FreeReach& reach_;
  const ElementKind* kind_;
  std::string key_;
  std::string_view extra_;
};

}  // namespace

std::string new_entry(const SceneDocument& document, std::string_view table, std::string_view kind_name,
                      const Selection& selected, std::string_view extra) {
  constexpr int most_tries = 24;
  const SceneBefore ground(document);
  const std::string key = entry_key_of(table, entries_of(ground.scene, table));
  const auto refuse = [&](const char* why) { throw SceneError({{{"", 0, 0}, key, why}}); };
  const ElementKind* kind =
      table == "loads" ? nullptr
                       : find_kind(table == "forces" ? scene_forces() : scene_constraints(), kind_name);
  if (kind_name == "latch" && ground.structure.deployment.empty())
    refuse("the structure has no deployed pose to latch in");
  const FreeReach reach(ground.structure);
  const std::vector<std::string> members = entry_members(kind, ground.structure, selected, reach);
  if (members.empty())
    refuse(kind && acts_on_hinge(*kind) ? "the structure has no two rods that share a node"
                                        : "the structure has nothing that it could act on");
  const FirstEntry first(ground, reach, kind, key, extra);
  std::string warned;  // one that does, where no other is found
  std::vector<SceneProblem> problems;
  int tries = 0;
  for (const std::string& on : members) {
    const std::string entry = first.with(on);
    if (entry.empty()) continue;
    try {
      if (first.is_sound(entry)) return entry;
      if (warned.empty()) warned = entry;
    } catch (const SceneError& error) {
      if (problems.empty()) problems = error.problems();
    }
    if (++tries == most_tries) break;
  }
  if (!warned.empty()) return warned;
  if (problems.empty()) refuse("nothing of that kind moves here: the other constraints hold it");
  throw SceneError(problems);
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
