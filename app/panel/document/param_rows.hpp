// SPDX-License-Identifier: BSD-3-Clause
// What the panel can change of a scene: a row for every declared parameter, in sections as in the scene file.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "app/panel/document/selection.hpp"
#include "core/scene/scene.hpp"

namespace unfurl {

struct ParamRow {
  std::string key;    // dotted, as in `--set`
  std::string label;  // "chord rod length"
  ParamSpec spec;
  ParamValue value;        // of the scene without edits
  std::string entry = {};  // of a list, to which it belongs: "forces[2]"; empty: none
  double typical = std::numeric_limits<double>::quiet_NaN();  // for a slider where the value is not given
};

// An entry of [[loads]], [[forces]] or [[constraints]]. Its first row switches it on and off.
struct ParamEntry {
  std::string key;    // "forces[2]"
  std::string title;  // "motor: angle"
  std::string help;
};

struct ParamSection {
  std::string title;
  std::vector<ParamRow> rows;
  bool open = true;  // at first
  std::vector<ParamEntry> entries = {};
  std::string grows = {};  // the list to which entries may be added: "forces"; empty: none
};

// `base`: the scene without the panel's edits. A node or rod of a custom structure that is selected comes
// first.
std::vector<ParamSection> param_sections(const Scene& base, const Selection& selected = {});
// Of that; without rows where the selected part has no parameters of its own.
ParamSection selected_section(const Scene& base, const Selection& selected);

// What a slider spans. Where the declared range is wide or endless, around the scene's own value.
struct SliderRange {
  double low = 0, high = 1;
  bool logarithmic = false;
};
SliderRange slider_range(const ParamSpec& spec, const ParamValue& base);
SliderRange slider_range(const ParamRow& row);

// What a number that is not given begins with: one that the parameter allows, round to a millionth.
double first_value(const ParamRow& row);

bool not_given(const ParamValue& value);  // a number without which the scene has one of its own

// "help text. [0.1, 8] m; default 3": what a tooltip says of a parameter.
std::string param_tooltip(const ParamRow& row);
// A value as people read it, with the unit: "0.01 s", "true", "0, 0, -9.81 m/s²".
std::string value_caption(const ParamValue& value, std::string_view unit);
std::string unit_caption(std::string_view unit);  // "kg/m^3" -> "kg/m³", "deg" -> "°"

}  // namespace unfurl
