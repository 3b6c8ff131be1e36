// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/scene_template.hpp"

#include <cmath>
#include <stdexcept>

#include "core/scene/key_tables.hpp"
#include "core/scene/write.hpp"
#include "core/structures/family.hpp"
#include "core/text/nearest_name.hpp"
#include "core/text/wrapped.hpp"

namespace unfurl {

namespace {

constexpr std::size_t comment_width = 80;

std::string comment(std::string_view text) {
  return wrapped(text, comment_width, "# ", "# ");
}

const KeyTable& table_named(std::string_view name) {
  return *find_key_tables(name).front();
}

// Keys that a scene leaves out rather than give their default: it has no value that could be written.
bool writable(const ParamSpec& spec) {
  if (const auto* x = std::get_if<double>(&spec.fallback)) return !std::isnan(*x);
  if (const auto* text = std::get_if<std::string>(&spec.fallback)) return !text->empty();
  if (const auto* list = std::get_if<std::vector<double>>(&spec.fallback))
    return !list->empty() && !std::isnan(list->front());
  return !std::holds_alternative<std::vector<std::string>>(spec.fallback);
}

// What a comment shows behind the key where its default cannot be written.
std::string placeholder(const ParamSpec& spec) {
  switch (spec.kind) {
    case ParamKind::vector:
    case ParamKind::names:
      return "[]";
    case ParamKind::real:
    case ParamKind::integer:
      return "0";
    default:
      return "\"\"";
  }
}

// The key with its meaning above it; `value` in place of the default. What means nothing yet stands as a
// comment.
std::string key_lines(const ParamSpec& spec, bool active, const std::string& value) {
  const std::string help = spec.help.empty() ? "" : std::string(spec.help) + "; ";
  return comment(help + wanted_text(spec)) + (active ? "" : "# ") + std::string(spec.name) + " = " + value +
         "\n";
}

struct Given {
  std::string_view key;
  std::string value;
};

std::string table_lines(const KeyTable& table, const std::vector<Given>& given) {
  std::string text = "\n" + comment(table.help) + table.header + "\n";
  const ParamSet defaults(table.keys);
  for (const ParamSpec& spec : table.keys) {
    std::string value = writable(spec) ? toml_value(spec.fallback) : placeholder(spec);
    bool active = writable(spec) && means_something(spec, table.keys, defaults);
    for (const Given& own : given)
      if (own.key == spec.name) {
        active = !own.value.empty();
        value = active ? own.value : value;
      }
    text += spec.name == "kind" ? "kind = " + value + "\n" : key_lines(spec, active, value);
  }
  return text;
}

// The lines of a table as comments, for what a scene may have and this one has not.
std::string commented_out(const std::string& lines) {
  std::string text;
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t end = lines.find('\n', at);
    const std::string line = lines.substr(at, end - at);
    text += line.empty() || line.starts_with("#") ? line + "\n" : "# " + line + "\n";
    at = end + 1;
  }
  return text;
}

// A pendulum of two rods: the first entry of each list shows every key.
std::string custom_text() {
  std::string text = table_lines(table_named("structure.custom"), {});
  text += table_lines(table_named("structure.nodes"),
                      {{"name", "\"A\""}, {"position", "[0, 0, 2]"}, {"fixed", "true"}});
  text +=
      "\n[[structure.nodes]]\nname = \"B\"\nposition = [1, 0, 2]\n"
      "\n[[structure.nodes]]\nname = \"C\"\nposition = [1.5, 0, 2]\nmass = 0.5\n";
  text += table_lines(table_named("structure.rods"), {{"nodes", "[\"A\", \"B\"]"},
                                                      {"name", "\"upper\""},
                                                      {"mass", "1.0"},
                                                      {"density", ""},
                                                      {"area", ""},
                                                      {"length", ""},
                                                      {"youngs_modulus", ""},  // left out, these are those
                                                      {"strength", ""},        // of all rods
                                                      {"elastic", ""},
                                                      {"segments", ""}});
  text += "\n[[structure.rods]]\nname = \"lower\"\nnodes = [\"B\", \"C\"]\nmass = 0.5\n\n" +
          comment("What else holds; `unfurl list keys constraints` gives every kind.") +
          "[[constraints]]\nkind = \"plane\"\nnodes = [\"B\", \"C\"]\nnormal = [0, 1, 0]\n";
  return text;
}

std::string structure_lines(std::string_view kind) {
  if (kind == "custom") return custom_text();
  std::vector<std::string_view> kinds;
  for (const Family& family : families()) {
    if (family.kind == kind) return table_lines(table_named("structure." + std::string(kind)), {});
    kinds.push_back(family.kind);
  }
  kinds.emplace_back("custom");
  throw std::invalid_argument("no kind of structure " + in_quotes(kind) + did_you_mean(kind, kinds));
}

}  // namespace

std::string scene_template(std::string_view kind) {
  const bool custom = kind == "custom";
  const std::string structure = structure_lines(kind);
  std::string text = comment(
      "A scene of Unfurl. Every key may be left out unless it says otherwise: it then has the "
      "value that stands here. Units are SI, angles in degrees.");
  text += "title = \"My structure\"\n" + structure;
  text += table_lines(table_named("gravity"), {{"acceleration", custom ? "[0, 0, -9.81]" : "[0, 0, 0]"}});
  text += "\n" + comment("Forces and constraints: `unfurl list forces`, `unfurl list constraints`.");
  text += commented_out(table_lines(table_named("loads"), {{"nodes", "[]"}, {"force", "[0, 0, -1]"}}));
  text += table_lines(table_named("solver"), {{"end_time", custom ? "4.0" : ""}});
  return text + table_lines(table_named("render"), {{"mp4", ""}});  // left out, where there is ffmpeg
}

}  // namespace unfurl
