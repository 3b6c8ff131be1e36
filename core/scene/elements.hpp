// The entries of [[forces]] and [[constraints]]: a kind, the members it acts on, its parameters.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/forces/force.hpp"
#include "core/scene/table_reader.hpp"

namespace unfurl {

struct SceneElement {
  std::string kind;
  std::string name;                // for messages and columns: one of its own (settle_names)
  std::vector<std::string> nodes;  // names or globs
  std::vector<std::string> rods;
  bool fold_angle = false;  // acts on the structure's fold angle
  bool enabled = true;      // false: as if it were not there
  std::string table;        // CSV file that times and values came from; empty: none
  ParamSet values;
  std::string key;       // "forces[2]"
  SourceLocation where;  // of the entry
};

// What the reader needs to know about a kind, whichever table it is from.
struct ElementKind {
  std::string_view kind;
  std::string_view help;
  Members members;
  const std::vector<ParamSpec>& (*params)();
};
const std::vector<ElementKind>& scene_forces();  // kinds of [[forces]]
const std::vector<ElementKind>&
scene_constraints();  // kinds of [[constraints]] and [[structure.constraints]]
const ElementKind* find_kind(const std::vector<ElementKind>& kinds, std::string_view kind);

// Every entry of [[loads]], [[forces]] and [[constraints]] has it.
const ParamSpec& enabled_param();

// How a kind names its members, for `unfurl list`: "nodes = [A, B]".
std::string_view members_text(Members members);

// One entry; `folder` is where its CSV table may lie. Mistakes are noted.
SceneElement read_element(TableReader& entry, const std::string& key, const std::vector<ElementKind>& kinds,
                          const std::string& folder, SceneNotes& notes);

// Gives every element without a name one from its kind and members, numbered where that is taken: "angle of
// A-B-C", "angle of A-B-C (2)". Notes two enabled elements that were given the same.
void settle_names(std::vector<SceneElement>& elements, SceneNotes& notes);

// What an element that measures something (a drive, a stop, a spring) measures at the start of the structure
// that was built with it, in the scene's unit [m or deg]; NaN: nothing, or it was not built.
double start_value(const SceneElement& element, const Structure& structure);

// Adds what the elements say to the structure. Throws SceneError with every member that is not there.
void add_forces(const std::vector<SceneElement>& elements, Structure& structure);
void add_constraints(const std::vector<SceneElement>& elements, Structure& structure);

}  // namespace unfurl
