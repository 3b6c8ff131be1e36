// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/document/param_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "app/panel/document/scene_document.hpp"
#include "core/scene/build.hpp"
#include "core/scene/custom_reader.hpp"
#include "core/structures/family.hpp"

namespace unfurl {

namespace {

std::string spaced(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

ParamRow row_of(const std::string& prefix, const ParamSpec& spec, ParamValue value) {
  return {prefix + std::string(spec.name), spaced(spec.name), spec, std::move(value)};
}

std::vector<ParamRow> rows_of(const std::string& prefix, const std::vector<ParamSpec>& specs,
                              const ParamSet& values) {
  std::vector<ParamRow> rows;
  for (const ParamSpec& spec : specs)
    if (values.has(spec.name)) rows.push_back(row_of(prefix, spec, values.value(spec.name)));
  return rows;
}

std::vector<ParamRow> structure_rows(const Scene& base) {
  if (const Family* family = find_family(base.kind))
    return rows_of("structure.", family->params(), base.structure);
  ParamSet values = rod_material_values(base.custom.material);
  values.set("mass", std::string(base.custom.lumped_mass ? "lumped" : "consistent"));
  return rows_of("structure.", custom_params(), values);
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

// An entry's heading, and its first row.
void begin_entry(ParamSection& section, ParamEntry entry, bool enabled) {
  ParamRow row = row_of(entry.key + ".", enabled_param(), enabled);
  row.entry = entry.key;
  section.rows.push_back(std::move(row));
  section.entries.push_back(std::move(entry));
}

void add_row(ParamSection& section, const ParamSpec& spec, ParamValue value,
             double typical = std::numeric_limits<double>::quiet_NaN()) {
  const std::string& entry = section.entries.back().key;
  ParamRow row = row_of(entry + ".", spec, std::move(value));
  row.entry = entry;
  row.typical = typical;
  section.rows.push_back(std::move(row));
}

ParamSection load_section(const Scene& base) {
  ParamSection section{"Gravity and loads", {}};
  section.grows = "loads";
  section.rows.push_back(row_of("gravity.",
                                vector_param("acceleration", "m/s^2", {0, 0, 0}, "acceleration of free fall"),
                                numbers(base.gravity)));
  section.rows.back().label = "gravity";
  for (std::size_t i = 0; i < base.loads.size(); ++i) {
    const SceneLoad& load = base.loads[i];
    begin_entry(section,
                {"loads[" + std::to_string(i) + "]", "load on " + joined(load.nodes),
                 "a constant force on each node"},
                load.enabled);
    add_row(section, names_param("nodes", "names or globs, separated by commas"), load.nodes);
    add_row(section, vector_param("force", "N", {0, 0, 0}, "constant force on each node"),
            numbers(load.force));
  }
  return section;
}

// A structure that was built with the elements, to see where they begin; an empty one where it cannot be.
Structure started_structure(const Scene& base) {
  try {
    if (!base.forces.empty() || !base.constraints.empty()) return build_structure(base);
  } catch (const SceneError&) {  // the simulation will say so
  }
  return {};
}

void add_member_rows(ParamSection& section, const SceneElement& element, Members members) {
  ParamSpec nodes = names_param("nodes", "separated by commas");
  if (members == Members::each_node) nodes.help = "names or globs, separated by commas";
  if (members == Members::two_nodes) nodes.length = 2;
  if (members == Members::angle || members == Members::three_nodes) nodes.length = 3;
  if (!element.nodes.empty()) add_row(section, nodes, element.nodes);
  if (!element.terms.empty())
    add_row(section, names_param("terms", "summed up, separated by commas"), element.terms);
  ParamSpec rods = names_param(members == Members::rod ? "rod" : "rods", "separated by commas");
  rods.length = members == Members::rods ? 0 : members == Members::rod ? 1 : 2;
  if (!element.rods.empty()) add_row(section, rods, element.rods);
}

// Of a number that is not given, where what an entry measures begins at `start`: a sine swings about that.
double typical_value(const ParamSpec& spec, double start) {
  if (spec.name == "frequency") return 1;
  return spec.name == "amplitude" ? 0.1 * start : start;
}

// "torsion spring of fold angle": of an entry without a name.
std::string element_title(const SceneElement& element) {
  return spaced(element.kind) + element.name.substr(element.kind.size());
}

ParamSection element_section(std::string title, std::string_view table,
                             const std::vector<SceneElement>& elements, const std::vector<ElementKind>& kinds,
                             const Structure& started) {
  ParamSection section{std::move(title), {}};
  section.grows = table;
  for (const SceneElement& element : elements) {
    const ElementKind* kind = find_kind(kinds, element.kind);
    if (!kind) continue;
    const bool named = !element.name.starts_with(element.kind + " of ");
    begin_entry(section,
                {element.key, named ? element.name + ": " + spaced(element.kind) : element_title(element),
                 std::string(kind->help)},
                element.enabled);
    add_member_rows(section, element, kind->members);
    const double start = start_value(element, started);
    for (const ParamSpec& spec : kind->params()) {
      // Times and values are those of the file where there is one.
      if (element.table.empty() ? spec.name == "table" : spec.name == "times" || spec.name == "values")
        continue;
      if (element.fold_angle && spec.name == "axis") continue;  // its sign is its own
      const bool file = spec.name == "table";
      add_row(section, spec, file ? ParamValue(element.table) : element.values.value(spec.name),
              typical_value(spec, start));
    }
  }
  return section;
}

double size_of(const ParamValue& value) {
  if (const auto* x = std::get_if<double>(&value)) return *x;
  if (const auto* i = std::get_if<long>(&value)) return static_cast<double>(*i);
  if (const auto* v = std::get_if<std::vector<double>>(&value)) {
    double largest = 0;
    for (const double x : *v) largest = std::max(largest, std::abs(x));
    return largest;
  }
  return 0;
}

// The smallest of 1, 2, 5, 10, ... (any power of ten) that is not below x > 0.
double rounded_up(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x) + 1e-12));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= x * (1 - 1e-9)) return step * power;
  return 10 * power;
}

// Of an optional number; 0: none is usual. Aluminium, as a modulus and as what it bears.
double usual_value(const ParamSpec& spec) {
  if (spec.unit != "Pa") return 0.0;
  return spec.name == "strength" ? 3e8 : 7e10;
}

std::string number_caption(double x) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.6g", x);
  return text.data();
}

}  // namespace

std::vector<ParamSection> param_sections(const Scene& base, const Selection& selected) {
  std::vector<ParamSection> sections{selected_section(base, selected)};
  sections.push_back({"Structure", structure_rows(base)});
  sections.push_back(load_section(base));
  const Structure started = started_structure(base);
  sections.push_back(element_section("Forces", "forces", base.forces, scene_forces(), started));
  sections.push_back(element_section("Drives and constraints", "constraints", base.constraints,
                                     scene_constraints(), started));
  sections.push_back({"Solver", rows_of("solver.", solver_params(), solver_values(base.solver))});
  sections.push_back({"Picture", rows_of("render.", render_params(), render_values(base.render)), false});
  std::erase_if(sections, [](const ParamSection& s) { return s.rows.empty() && s.grows.empty(); });
  return sections;
}

SliderRange slider_range(const ParamSpec& spec, const ParamValue& base) {
  const bool bounded = std::isfinite(spec.min) && std::isfinite(spec.max);
  const double value = size_of(base), fallback = size_of(spec.fallback);
  const double known = std::isfinite(fallback) ? std::abs(fallback) : 0.0;
  const double typical = std::abs(value) > 0 ? std::abs(value) : known;
  const double room = typical > 0 ? typical : 1.0;
  if (bounded && spec.max - spec.min <= 1000 * std::max(room, 1.0)) {
    double low = spec.min, high = spec.max;
    const double margin = 1e-3 * (high - low);  // an open end cannot be reached
    if (spec.min_open) low += margin;
    if (spec.max_open) high = std::max(value, high - 1e-4 * (high - low));
    return {low, high, false};
  }
  if (spec.kind == ParamKind::integer)
    return {std::max(spec.min, value < 0 ? 4 * value : std::min(1.0, value)),
            std::min(spec.max, std::max(12.0, rounded_up(4 * room))), false};
  if (spec.min >= 0) {  // sizes and masses: factors rather than differences
    const double high = std::min(spec.max, rounded_up(10 * room));
    const double low = std::max(spec.min, high / 1000);
    return {value < high / 1000 && !spec.min_open ? spec.min : low, high, true};
  }
  const double reach = spec.unit == "deg" ? std::max(180.0, rounded_up(2 * room)) : rounded_up(4 * room);
  return {std::max(spec.min, -reach), std::min(spec.max, reach), false};
}

SliderRange slider_range(const ParamRow& row) {
  if (!not_given(row.value)) return slider_range(row.spec, row.value);
  return slider_range(row.spec, std::isfinite(row.typical) ? row.typical : usual_value(row.spec));
}

double first_value(const ParamRow& row) {
  const double typical = std::isfinite(row.typical) ? row.typical : usual_value(row.spec);
  const SliderRange range = slider_range(row);
  for (const double x : {std::round(1e6 * typical) / 1e6, typical, range.high / 10, range.low})
    if (range_error(row.spec, x).empty()) return x;
  return range.high;
}

bool not_given(const ParamValue& value) {
  const auto* x = std::get_if<double>(&value);
  return x != nullptr && !std::isfinite(*x);
}

std::string unit_caption(std::string_view unit) {
  if (unit == "deg") return "°";
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit[i] == '^' && i + 1 < unit.size() && (unit[i + 1] == '2' || unit[i + 1] == '3')) {
      text += unit[++i] == '2' ? "²" : "³";
    } else {
      text += unit[i];
    }
  }
  return text;
}

std::string value_caption(const ParamValue& value, std::string_view unit) {
  std::string text;
  if (const auto* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
  if (const auto* s = std::get_if<std::string>(&value)) return *s;
  if (not_given(value)) return "not given";
  if (const auto* names = std::get_if<std::vector<std::string>>(&value)) return joined(*names);
  if (const auto* v = std::get_if<std::vector<double>>(&value)) {
    for (const double x : *v) text += (text.empty() ? "" : ", ") + number_caption(x);
  } else {
    text = number_caption(size_of(value));
  }
  return unit.empty() ? text : text + (unit == "deg" ? "" : " ") + unit_caption(unit);
}

std::string param_tooltip(const ParamRow& row) {
  std::string text(row.spec.help);
  if (row.spec.kind != ParamKind::boolean) text += "\nallowed: " + range_text(row.spec);
  if (!row.spec.required) text += "\ndefault: " + value_caption(row.spec.fallback, row.spec.unit);
  text += "\nin the scene: " + value_caption(row.value, row.spec.unit);
  return text + "\n" + row.key;
}

}  // namespace unfurl
