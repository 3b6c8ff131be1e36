// SPDX-License-Identifier: BSD-3-Clause
// The entries of [[forces]] and [[constraints]]: a kind, the members it acts on, its parameters.
#pragma once

#include <map>
#include <optional>
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
  std::vector<std::string> terms;  // of a combination
  bool fold_angle = false;         // acts on the structure's fold angle
  bool enabled = true;             // false: as if it were not there
  std::string table;               // CSV file that times and values came from; empty: none
  ParamSet values;
  std::string key;                                            // "forces[2]"
  SourceLocation where;                                       // of the entry
  std::map<std::string, SourceLocation, std::less<>> places;  // of the keys that it gives
};

struct ElementAdder;
class MemberFinder;

// A kind of entry: how it is read, and what it adds to a structure.
struct ElementKind {
  std::string_view kind;
  std::string_view help;
  Members members;
  const std::vector<ParamSpec>& (*params)();
  void (&add)(const SceneElement&, ElementAdder&);  // a reference: a row without one does not compile
  // What it measures, its branch that of t = 0; none: a problem was noted. nullptr: it measures nothing.
  std::optional<Measure> (*measure)(const SceneElement&, MemberFinder&) = nullptr;
  // Bounds the pose at t = 0 and does not say what it is: stops, play, cables.
  bool bounds = false;
};
const std::vector<ElementKind>& scene_forces();  // kinds of [[forces]]
const std::vector<ElementKind>&
scene_constraints();  // kinds of [[constraints]] and [[structure.constraints]]
const ElementKind* find_kind(const std::vector<ElementKind>& kinds, std::string_view kind);

// What a list of terms is, for TableReader::names.
inline constexpr const char* terms_wanted = "a list of terms such as \"2.5 length A B\"";

// Every entry of [[loads]], [[forces]] and [[constraints]] has it.
const ParamSpec& enabled_param();

// Is a table of this kind straight lines, in which a time may stand twice? All others are smooth curves.
bool may_jump(std::string_view kind);

// How a kind names its members, for `unfurl list`: "nodes = [A, B]".
std::string_view members_text(Members members);

// One entry; `folder` is where its CSV table may lie. Mistakes are noted.
SceneElement read_element(TableReader& entry, const std::string& key, const std::vector<ElementKind>& kinds,
                          const std::string& folder, SceneNotes& notes);

// Gives every element without a name one from its kind and members, numbered where that is taken: "angle of
// A-B-C", "angle of A-B-C (2)". Notes two enabled elements that were given the same.
void settle_names(std::vector<SceneElement>& elements, SceneNotes& notes);

// The measures of kinds that name two nodes or an angle.
std::optional<Measure> length_of(const SceneElement& element, MemberFinder& find);
std::optional<Measure> angle_of(const SceneElement& element, MemberFinder& find);

// What an element that measures something (a drive, a stop, a spring) measures at the start of a structure,
// in the scene's unit [m or deg]; NaN: nothing, or its members are not there.
double start_value(const SceneElement& element, const Structure& structure);

// Adds what the elements of one of the tables of kinds say to the structure; `end_time` is that of the run
// [s], `ends_deployed`: it may end before, where [deployment] says. Throws SceneError with all that cannot
// be.
void add_elements(const std::vector<SceneElement>& elements, const std::vector<ElementKind>& kinds,
                  double end_time, bool ends_deployed, Structure& structure);

}  // namespace unfurl
