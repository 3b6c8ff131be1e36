// The kinds of [[forces]] and [[constraints]] and how an entry is read.
#include "core/scene/elements.hpp"

#include <limits>
#include <map>

#include "core/model/nearest_name.hpp"
#include "core/scene/csv_table.hpp"
#include "core/scene/text_file.hpp"

namespace unfurl {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double as_built = std::numeric_limits<double>::quiet_NaN();

ParamSpec required(ParamSpec spec) {
  spec.required = true;
  return spec;
}

ParamSpec direction_param(std::string_view name, std::string_view help) {
  return required(vector_param(name, "", {0, 0, 0}, help));
}

// How a held or driven value moves; the unit is that of the measure.
std::vector<ParamSpec> motion_params(std::string_view unit) {
  return {
      choice_param("motion", "hold", {"hold", "rate", "smooth", "table"},
                   "hold the value at t = 0, or drive it: at a constant rate, smoothly to a value, along a "
                   "table"),
      only_with(
          "motion", {"rate"},
          real_param("rate", unit == "m" ? "m/s" : "deg/s", 0.0, -infinity, infinity, "rate: per second")),
      only_with("motion", {"rate"},
                real_param("ramp", "s", 0.0, 0.0, infinity, "rate: how long it takes to reach the rate")),
      only_with("motion", {"smooth"},
                real_param("to", unit, as_built, -infinity, infinity, "smooth: the value in the end")),
      only_with("motion", {"rate", "smooth"},
                real_param("start", "s", 0.0, 0.0, infinity, "rate, smooth: when the motion begins")),
      only_with("motion", {"smooth"},
                positive_param("duration", "s", 1.0, "smooth: how long the motion takes")),
      only_with("motion", {"table"}, vector_param("times", "s", {}, "table: ascending, with values")),
      only_with("motion", {"table"},
                vector_param("values", unit, {}, "table: at the times; a natural cubic spline between them, held before and after")),
      only_with("motion", {"table"},
                text_param("table", "",
                           "table: CSV file beside the scene, in place of times and values: t,value"))};
}

std::vector<ParamSpec> operator+(std::vector<ParamSpec> a, const std::vector<ParamSpec>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

template <class Make>
const std::vector<ParamSpec>& once(Make make) {
  static const std::vector<ParamSpec> params = make();
  return params;
}

const std::vector<ParamSpec>& no_params() {
  return once([] { return std::vector<ParamSpec>{}; });
}
const std::vector<ParamSpec>& plane_params() {
  return once([] { return std::vector{direction_param("normal", "of the plane")}; });
}
const std::vector<ParamSpec>& line_params() {
  return once([] { return std::vector{direction_param("direction", "of the line")}; });
}
const std::vector<ParamSpec>& equal_params() {
  return once(
      [] { return std::vector{direction_param("direction", "along which the coordinates are equal")}; });
}
const std::vector<ParamSpec>& mirror_params() {
  return once([] {
    return std::vector{direction_param("normal", "of the mirror plane"),
                       vector_param("point", "m", {0, 0, 0}, "in the mirror plane")};
  });
}
const std::vector<ParamSpec>& relation_params() {
  return once([] {
    return std::vector{
        required(vector_param("coefficients", "", {}, "three for each node: sum of c . x = value")),
        real_param("value", "m", as_built, -infinity, infinity, "by default that at t = 0")};
  });
}
const std::vector<ParamSpec>& length_params() {
  return once([] { return motion_params("m"); });
}
const std::vector<ParamSpec>& coordinate_params() {
  return once(
      [] { return std::vector{direction_param("direction", "of the coordinate")} + motion_params("m"); });
}
const std::vector<ParamSpec>& angle_params() {
  return once([] {
    return std::vector{
               vector_param("axis", "", {0, 0, 0},
                            "of the hinge: the angle then has a sign and may go round; none: in [0, 180]")} +
           motion_params("deg");
  });
}

std::vector<ParamSpec> stop_params(std::string_view unit) {
  ParamSpec restitution =
      real_param("restitution", "", 0.0, 0.0, 1.0, "rebound speed over approach speed; 0: no rebound");
  return {real_param("min", unit, as_built, -infinity, infinity, "lower limit; none by default"),
          real_param("max", unit, as_built, -infinity, infinity, "upper limit; none by default"), restitution,
          real_param("rest_speed", unit == "m" ? "m/s" : "deg/s", 1e-3, 0.0, infinity,
                     "rebounds slower than this rest on the stop")};
}
const std::vector<ParamSpec>& length_stop_params() {
  return once([] { return stop_params("m"); });
}
const std::vector<ParamSpec>& coordinate_stop_params() {
  return once(
      [] { return std::vector{direction_param("direction", "of the coordinate")} + stop_params("m"); });
}
const std::vector<ParamSpec>& angle_stop_params() {
  return once([] {
    return std::vector{vector_param("axis", "", {0, 0, 0}, "of the hinge, as for angle")} +
           stop_params("deg");
  });
}

// Times and values of a CSV table, into the entry's parameters.
void read_table(TableReader& entry, ParamSet& values, const std::string& folder, SceneNotes& notes) {
  static const std::vector<CsvColumn> columns = {{"t", "s", true, true}, {"value", "", true, true}};
  const std::string name = values.text("table");
  if (name.empty()) return;
  if (!values.vector("times").empty())
    return entry.problem("table", "give either table, or times and values");
  const TextFile file = read_file_beside(folder, name);
  if (!file.error.empty()) return entry.problem("table", file.error);
  std::vector<double> times, sizes;
  for (const auto& row : read_csv(file.text, file.path, columns, notes)) {
    if (row.numbers.size() < 2) continue;  // noted
    times.push_back(row.numbers.at("t"));
    sizes.push_back(row.numbers.at("value"));
  }
  if (times.size() < 2) entry.problem("table", "must have at least two rows");
  values.set("times", std::move(times));
  values.set("values", std::move(sizes));
  values.set("table", std::string());
}

void check_table(TableReader& entry, const ParamSet& values) {
  const auto &times = values.vector("times"), &sizes = values.vector("values");
  if (times.size() != sizes.size())
    entry.problem("values", "must be as many as times: " + std::to_string(times.size()) + "; got " +
                                std::to_string(sizes.size()));
  if (times.size() == 1) entry.problem("times", "must be at least two");
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1])) return entry.problem("times", "must ascend");
}

void check_motion(TableReader& entry, const ParamSet& values) {
  const std::string& motion = values.text("motion");
  const auto needs = [&](const char* key, bool given) {
    if (!given) entry.problem(key, "is missing; motion = \"" + motion + "\" needs it");
  };
  if (motion == "rate") needs("rate", entry.has("rate"));
  if (motion == "smooth") needs("to", entry.has("to"));
  if (motion == "table") needs("times", !values.vector("times").empty());
}

void read_members(TableReader& entry, Members members, SceneElement& element) {
  const auto wants = [&](const char* key, const std::vector<std::string>& names, std::size_t count) {
    if (!names.empty() && names.size() != count)
      entry.problem(key, "must be " + std::to_string(count) + " names; got " + std::to_string(names.size()));
  };
  switch (members) {
    case Members::none:
      return;
    case Members::each_node:
    case Members::node_list:
      element.nodes = entry.names("nodes");
      return;
    case Members::two_nodes:
      element.nodes = entry.names("nodes");
      return wants("nodes", element.nodes, 2);
    case Members::rod:
      element.rods = entry.names("rod");
      return wants("rod", element.rods, 1);
    case Members::angle:
      break;
  }
  element.fold_angle = entry.read({boolean_param("fold_angle", false, "")}).boolean("fold_angle");
  if (entry.has("rods")) element.rods = entry.names("rods");
  if (entry.has("nodes")) element.nodes = entry.names("nodes");
  wants("rods", element.rods, 2);
  wants("nodes", element.nodes, 3);
  if (entry.has("rods") + entry.has("nodes") + static_cast<int>(element.fold_angle) != 1)
    entry.problem("", "must name one angle: rods = [R, S], or nodes = [A, HINGE, B], or fold_angle = true");
}

std::string made_name(const SceneElement& element) {
  std::string text = element.fold_angle ? "fold angle" : "";
  for (const auto* list : {&element.nodes, &element.rods})
    for (const auto& name : *list) text += (text.empty() ? "" : "-") + name;
  return element.kind + " of " + text;
}

}  // namespace

const std::vector<ElementKind>& scene_forces() {
  static const std::vector<ElementKind> kinds = [] {
    std::vector<ElementKind> found;
    for (const ForceKind& row : force_kinds())
      if (row.params) found.push_back({row.kind, row.help, row.members, row.params});
    return found;
  }();
  return kinds;
}

const std::vector<ElementKind>& scene_constraints() {
  static const std::vector<ElementKind> kinds = {
      {"plane", "keeps nodes in the planes through their positions at t = 0", Members::each_node,
       plane_params},
      {"line", "keeps nodes on the lines through their positions at t = 0", Members::each_node, line_params},
      {"fixed", "keeps nodes where they are at t = 0", Members::each_node, no_params},
      {"equal", "nodes share one coordinate", Members::node_list, equal_params},
      {"mirror", "the second node is the mirror image of the first", Members::two_nodes, mirror_params},
      {"relation", "a linear relation between nodes", Members::node_list, relation_params},
      {"collinear", "the third and further nodes stay on the line through the first two", Members::node_list,
       no_params},
      {"coplanar", "the fourth and further nodes stay in the plane through the first three",
       Members::node_list, no_params},
      {"length", "the distance of two nodes is held, or driven by an actuator", Members::two_nodes,
       length_params},
      {"coordinate", "a node's coordinate along a direction, or the difference of two, is held or driven",
       Members::node_list, coordinate_params},
      {"angle", "the angle between two rods, or the fold angle, is held or driven by a motor", Members::angle,
       angle_params},
      {"length_stop", "end stop: the distance of two nodes stays within limits", Members::two_nodes,
       length_stop_params},
      {"coordinate_stop", "end stop: a node's coordinate, or the difference of two, stays within limits",
       Members::node_list, coordinate_stop_params},
      {"angle_stop", "end stop: the angle between two rods, or the fold angle, stays within limits",
       Members::angle, angle_stop_params},
  };
  return kinds;
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
    case Members::two_nodes:
      return "nodes = [A, B]";
    case Members::rod:
      return "rod = its name";
    case Members::angle:
      return "rods = [R, S], nodes = [A, HINGE, B] or fold_angle = true";
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
    read_table(entry, element.values, folder, notes);
    check_table(entry, element.values);
  }
  if (element.values.has("motion")) check_motion(entry, element.values);
  entry.finish();
  element.name = head.text("name");
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
