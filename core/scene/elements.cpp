// SPDX-License-Identifier: BSD-3-Clause
// The kinds of [[forces]] and [[constraints]] and how an entry is read.
#include "core/scene/elements.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "core/scene/csv_table.hpp"
#include "core/scene/text_file.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

// Times and values of a CSV table, into the entry's parameters, and where they stand. An entry that is
// switched off does without its file.
void read_table(TableReader& entry, ParamSet& values, const std::string& folder, bool enabled,
                std::vector<SourceLocation>& places, SceneNotes& notes) {
  static const std::vector<CsvColumn> columns = {{"t", "s", true, true}, {"value", "", true, true}};
  const std::string name = values.text("table");
  if (name.empty()) return;
  if (!values.vector("times").empty() || !values.vector("values").empty())
    return entry.problem("table", "give either table, or times and values");
  const TextFile file = read_file_beside(folder, name);
  if (!file.error.empty() && !enabled) return;
  notes.files.insert(file.path);
  if (!file.error.empty()) return entry.problem("table", file.error);
  std::vector<double> times, sizes;
  const std::size_t before = notes.problems.size();
  const auto rows = read_csv(file.text, file.path, columns, notes);
  for (const auto& row : rows) {
    if (row.numbers.size() < 2) continue;  // noted
    places.push_back(row.where);
    times.push_back(row.numbers.at("t"));
    sizes.push_back(row.numbers.at("value"));
  }
  if (rows.size() < 2 && notes.problems.size() == before)  // else it may have, of other columns
    entry.problem("table", "must have at least two rows");
  values.set("times", std::move(times));
  values.set("values", std::move(sizes));
  values.set("table", std::string());
}

// `jumps`: a time may stand twice; `rows`: where the times stand, if not in the scene.
void check_table(TableReader& entry, const ParamSet& values, bool jumps,
                 const std::vector<SourceLocation>& rows, SceneNotes& notes) {
  const auto &times = values.vector("times"), &sizes = values.vector("values");
  if (times.size() != sizes.size())
    entry.problem("values", "must be as many as times: " + std::to_string(times.size()) + "; got " +
                                std::to_string(sizes.size()));
  if (times.size() == 1 && rows.empty()) entry.problem("times", "must be at least two");
  const char* const what =
      jumps ? "must ascend; a time may stand twice, the load jumps there" : "must ascend";
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1]) &&
        !(jumps && times[i] == times[i - 1] && !(i > 1 && times[i - 2] == times[i])))
      return rows.empty() ? entry.problem("times", what) : notes.add(rows[i], "t", what);
}

void check_motion(TableReader& entry, const ParamSet& values, bool has_table) {
  const std::string& motion = values.text("motion");
  const auto needs = [&](const char* key, bool given) {
    if (!given) entry.problem(key, "is missing; motion = \"" + motion + "\" needs it");
  };
  if (motion == "rate") needs("rate", entry.has("rate"));
  if (motion == "smooth") needs("to", entry.has("to"));
  if (motion == "sine")
    for (const char* key : {"amplitude", "frequency"}) needs(key, entry.has(key));
  if (motion == "table") needs("times", has_table || !values.vector("times").empty());
}

void read_members(TableReader& entry, Members members, SceneElement& element) {
  const auto wants = [&](const char* key, const std::vector<std::string>& names, std::size_t count) {
    if (!names.empty() && names.size() != count)
      entry.problem(key, "must be " + std::to_string(count) + (count == 1 ? " name" : " names") + "; got " +
                             std::to_string(names.size()));
  };
  switch (members) {
    case Members::none:
      return;
    case Members::each_node:
    case Members::node_list:
    case Members::path:
      element.nodes = entry.names("nodes");
      return;
    case Members::terms:
      element.terms = entry.names("terms", terms_wanted);
      return;
    case Members::two_nodes:
      element.nodes = entry.names("nodes");
      return wants("nodes", element.nodes, 2);
    case Members::three_nodes:
      element.nodes = entry.names("nodes");
      return wants("nodes", element.nodes, 3);
    case Members::rods:
      element.rods = entry.names("rods", "a list of names or globs of rods or groups");
      return;
    case Members::rod:
      element.rods = entry.names("rod", "the name of one rod");
      return wants("rod", element.rods, 1);
    case Members::angle:
    case Members::measure:
      break;
  }
  element.fold_angle = entry.read({boolean_param("fold_angle", false, "")}).boolean("fold_angle");
  if (entry.has("rods")) element.rods = entry.names("rods", "a list of rod names");
  if (entry.has("nodes")) element.nodes = entry.names("nodes");
  wants("rods", element.rods, 2);
  if (members == Members::angle) wants("nodes", element.nodes, 3);
  if (members == Members::measure && element.nodes.size() > 3)
    entry.problem("nodes", "must be 1, 2 or 3 names; got " + std::to_string(element.nodes.size()));
  if (entry.has("rods") + entry.has("nodes") + static_cast<int>(element.fold_angle) != 1)
    entry.problem("",
                  members == Members::angle
                      ? "must name one angle: rods = [R, S], or nodes = [A, HINGE, B], or fold_angle = true"
                      : "must name one measure: " + std::string(members_text(members)));
}

// Which of axis and direction says something follows from what is measured.
void warn_idle_directions(TableReader& entry, Members members, const SceneElement& element,
                          SceneNotes& notes) {
  if (members != Members::angle && members != Members::measure) return;
  const auto given = [&](const char* key) {
    return entry.has(key) &&
           std::ranges::any_of(element.values.vector(key), [](double x) { return x != 0.0; });
  };
  const auto warn = [&](const char* key, const char* reason) {
    notes.warnings.push_back({entry.places().at(key), entry.key(key), std::string("does nothing ") + reason});
  };
  const bool angle = element.fold_angle || !element.rods.empty() || element.nodes.size() == 3;
  if (given("axis") && element.fold_angle) warn("axis", "with fold_angle = true");
  if (given("axis") && !angle) warn("axis", "without an angle: one or two nodes have no hinge");
  if (members == Members::measure && angle && given("direction")) warn("direction", "with an angle");
}

std::string made_name(const SceneElement& element) {
  std::string text = element.fold_angle ? "fold angle" : "";
  for (const auto* list : {&element.nodes, &element.rods})
    for (const auto& name : *list) text += (text.empty() ? "" : "-") + name;
  for (const std::string& term : element.terms)
    text += text.empty() ? term : term.starts_with('-') ? " - " + term.substr(1) : " + " + term;
  return element.kind + " of " + text;
}

}  // namespace

bool may_jump(std::string_view kind) {
  return kind == "load_over_time" || kind == "follower";
}

const ElementKind* find_kind(const std::vector<ElementKind>& kinds, std::string_view kind) {
  for (const ElementKind& row : kinds)
    if (row.kind == kind) return &row;
  return nullptr;
}

const ParamSpec& enabled_param() {
  static const ParamSpec param = boolean_param("enabled", true, "false: as if the entry were not there");
  return param;
}

std::string_view members_text(Members members) {
  switch (members) {
    case Members::none:
      return "";
    case Members::each_node:
      return "nodes = names or globs, one for each";
    case Members::node_list:
      return "nodes = [A, B, ...]";
    case Members::path:
      return "nodes = [A, B, ...], in order";
    case Members::terms:
      return "terms = [\"2.5 length A B\", ...]";
    case Members::two_nodes:
      return "nodes = [A, B]";
    case Members::three_nodes:
      return "nodes = [A, B, C]";
    case Members::rods:
      return "rods = names or globs of rods or groups";
    case Members::rod:
      return "rod = its name";
    case Members::angle:
      return "rods = [R, S], nodes = [A, HINGE, B] or fold_angle = true";
    case Members::measure:
      return "rods = [R, S], nodes = [A, HINGE, B] or [A, B] or [A] with a direction, or fold_angle = true";
  }
  return "";
}

SceneElement read_element(TableReader& entry, const std::string& key, const std::vector<ElementKind>& kinds,
                          const std::string& folder, SceneNotes& notes) {
  SceneElement element;
  element.key = key;
  element.where = entry.where();
  std::vector<std::string_view> names;
  for (const ElementKind& row : kinds) names.push_back(row.kind);
  const ParamSet head = entry.read({required(choice_param("kind", "", std::move(names), "")),
                                    text_param("name", "", ""), enabled_param()});
  element.kind = head.text("kind");
  element.enabled = head.boolean("enabled");
  const ElementKind* kind = find_kind(kinds, element.kind);
  if (!kind) return element;  // noted; its other keys mean nothing
  read_members(entry, kind->members, element);
  element.values = entry.read(kind->params());
  if (element.values.has("table")) {
    element.table = element.values.text("table");
    std::vector<SourceLocation> rows;
    read_table(entry, element.values, folder, element.enabled, rows, notes);
    check_table(entry, element.values, may_jump(element.kind), rows, notes);
  }
  const bool tabulated =
      !element.table.empty() || (element.values.has("times") && !element.values.vector("times").empty());
  if (tabulated && !element.values.has("motion") && entry.has("frequency"))
    entry.problem("frequency", "stands in place of times, values and table; leave out one of them");
  const bool left_out =
      !element.enabled && element.values.has("table") && !element.values.text("table").empty();
  if (element.values.has("motion") && !left_out) check_motion(entry, element.values, !element.table.empty());
  entry.warn_idle(kind->params(), element.values);
  if (element.values.has("stiffness") && !entry.has("stiffness") && !entry.has("damping"))
    entry.problem("stiffness", "is missing, and so is damping: it would do nothing");
  warn_idle_directions(entry, kind->members, element, notes);
  entry.finish();
  element.name = head.text("name");
  element.places = entry.places();
  return element;
}

void settle_names(std::vector<SceneElement>& elements, SceneNotes& notes) {
  std::map<std::string, const SceneElement*> taken;
  for (const SceneElement& element : elements) {
    if (element.name.empty() || !element.enabled) continue;
    const auto [first, is_new] = taken.try_emplace(element.name, &element);
    if (is_new) continue;
    const std::string key = element.key + ".name";
    const auto place = notes.locations.find(key);
    notes.add(place == notes.locations.end() ? element.where : place->second, key,
              first->second->key + " is called " + in_quotes(element.name) +
                  " already; give this one a name of its own");
  }
  for (SceneElement& element : elements) {
    if (!element.name.empty() || element.kind.empty()) continue;
    const std::string made = made_name(element);
    element.name = made;
    for (int number = 2; !taken.try_emplace(element.name, &element).second; ++number)
      element.name = made + " (" + std::to_string(number) + ")";
  }
}

}  // namespace unfurl
