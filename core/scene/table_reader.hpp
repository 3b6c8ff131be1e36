// SPDX-License-Identifier: BSD-3-Clause
// One table of a scene against its declared parameters.
#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/toml_tree.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// What a reading collects: all mistakes, and where each key was given.
struct SceneNotes {
  std::vector<SceneProblem> problems;
  std::vector<SceneProblem> warnings;               // what is given and does nothing
  std::vector<SceneProblem> on_path;                // and what does nothing where the path is solved
  std::map<std::string, SourceLocation> locations;  // dotted key -> place of its value
  std::map<std::string, std::string> units;         // of what overrides change: dotted key -> unit
  std::set<std::string> files;                      // that were read beside the scene's own

  void add(const SourceLocation& where, std::string key, std::string message);
};

// That number where it is a whole one (3.0).
std::optional<long> as_whole_number(double x);

// Keys that do nothing: all, or those alone that --set gives. A table of a whole scene may keep what another
// method or model would need.
enum class Idle { all, from_command_line };

// Reads keys of one table; finish() reports the keys that nobody asked for. `path` is the dotted name of the
// table,
// "" for the root. The table may be absent (nullptr): every parameter takes its default then.
class TableReader {
 public:
  TableReader(const TomlTree* table, std::string path, const SourceLocation& where, SceneNotes& notes);

  // The parameters at their defaults, overwritten by what the table says. A value that is not allowed is
  // noted and left at its default. A whole number is taken where a number is wanted, and 3.0 where a whole
  // number is.
  ParamSet read(const std::vector<ParamSpec>& specs);
  // A list of texts; a single text counts as a list of one. Noted when it is missing or something else than
  // what is wanted.
  std::vector<std::string> names(std::string_view key, const std::string& wanted = "a list of node names");
  // A member that is read elsewhere; marks it as known.
  const TomlTree* member(std::string_view key);
  // A member that must be a table, or an array of tables; nullptr or empty when absent or wrong (which is
  // noted).
  const TomlTree* table(std::string_view key);
  std::vector<const TomlTree*> tables(std::string_view key);
  void finish();
  // Warns of every key that is given although it means nothing with the values that the others have; not of
  // one that a file gives its default, as every scene does that is written with all of its keys.
  void warn_idle(const std::vector<ParamSpec>& specs, const ParamSet& values, Idle which = Idle::all);
  // The same of one key and for this reason; what a file may keep (`may_stand`) is told where it is set
  // alone.
  void warn_idle(std::string_view name, const std::string& reason, bool may_stand);
  // That those of these keys that were set on a command line do nothing `reason`, if that was not said.
  std::vector<SceneProblem> overridden_among(const std::vector<std::string_view>& keys,
                                             std::string_view reason) const;
  void warn_overridden(const std::vector<std::string_view>& keys, std::string_view reason);  // of that

  std::string key(std::string_view name) const;  // dotted
  bool has(std::string_view name) const { return table_ && table_->find(name); }
  const SourceLocation& where() const { return where_; }
  std::map<std::string, SourceLocation, std::less<>> places() const;  // of the values that are given
  void problem(std::string_view name,
               std::string message);  // located at the member, or at the table without it

 private:
  void read_one(const ParamSpec& spec, ParamSet& values);

  const TomlTree* table_;
  std::string path_;
  SourceLocation where_;
  SceneNotes& notes_;
  std::vector<std::string> known_;            // own copies: a name may be a temporary
  std::map<std::string, std::string> units_;  // of known numbers that have one
};

}  // namespace unfurl
