// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/key_list.hpp"

#include <nlohmann/json.hpp>

#include "core/text/wrapped.hpp"

namespace unfurl {

namespace {

constexpr std::size_t list_width = 80;

// "[structure] with kind = "hoop": help", what stands above the keys of a table.
std::string table_title(const KeyTable& table) {
  std::string title = table.header;
  if (!table.keys.empty() && table.keys.front().name == "kind")
    title += " with kind = \"" + std::get<std::string>(table.keys.front().fallback) + "\"";
  return title;
}

// While what it means something: "only with motion = rate or smooth", "only with stiffness given, or
// tension_only = true"; "" where always.
std::string condition_text(const ParamSpec& spec) {
  std::string text;
  for (const ParamCondition& condition : spec.only) {
    text += (text.empty() ? "only with " : ", or ") + std::string(condition.other);
    text += condition.values.empty() ? " given" : " = ";
    for (std::size_t i = 0; i < condition.values.size(); ++i)
      text += (i ? " or " : "") + std::string(condition.values[i]);
  }
  return text;
}

std::string given_text(const ParamSpec& spec) {
  return spec.required ? "required" : "default " + default_text(spec);
}

std::string key_text(const ParamSpec& spec) {
  std::string facts = wanted_text(spec) + "; " + given_text(spec);
  if (const std::string condition = condition_text(spec); !condition.empty()) facts += "; " + condition;
  const std::string indent(24, ' ');
  std::string first = "  " + std::string(spec.name) + " ";
  first.resize(std::max(first.size(), indent.size()), ' ');
  std::string text = wrapped(facts, list_width, first, indent);
  if (!spec.help.empty()) text += wrapped(spec.help, list_width, indent, indent);
  return text;
}

// A cell of a Markdown table: bars would end it.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string key_row(const ParamSpec& spec) {
  std::string meaning(spec.help);
  if (const std::string condition = condition_text(spec); !condition.empty())
    meaning += (meaning.empty() ? "" : "; ") + condition;
  return "| `" + std::string(spec.name) + "` | " + std::string(type_text(spec)) + " | " +
         cell(spec.unit.empty() ? "" : spec.unit) + " | " + cell(range_text(spec)) + " | " +
         cell(spec.required ? "required" : default_text(spec)) + " | " + cell(meaning) + " |\n";
}

}  // namespace

std::string keys_text(const std::vector<const KeyTable*>& tables) {
  std::string text;
  for (const KeyTable* table : tables) {
    const std::string title = table_title(*table);
    text += (text.empty() ? "" : "\n") +
            wrapped((title.empty() ? "" : title + ": ") + table->help, list_width, "", "  ");
    for (const ParamSpec& spec : table->keys)
      if (spec.name != "kind") text += key_text(spec);  // it stands in the title
  }
  return text;
}

std::string keys_json(const std::vector<const KeyTable*>& tables) {
  auto json = nlohmann::ordered_json::array();
  for (const KeyTable* table : tables) {
    nlohmann::ordered_json entry = {{"table", table->name}, {"header", table->header}, {"help", table->help}};
    for (const ParamSpec& spec : table->keys)
      entry["keys"].push_back({{"name", spec.name},
                               {"type", type_text(spec)},
                               {"unit", spec.unit},
                               {"range", range_text(spec)},
                               {"default", spec.required ? "" : default_text(spec)},
                               {"required", spec.required},
                               {"only", condition_text(spec)},
                               {"help", spec.help}});
    json.push_back(std::move(entry));
  }
  return json.dump(2) + "\n";
}

std::string keys_markdown(const std::vector<const KeyTable*>& tables) {
  std::string text;
  for (const KeyTable* table : tables) {
    const std::string title = table_title(*table);
    text += "\n## " + table->name + "\n\n" + (title.empty() ? "" : "`" + title + "`: ") + table->help +
            "\n\n| key | type | unit | range | default | meaning |\n|---|---|---|---|---|---|\n";
    for (const ParamSpec& spec : table->keys)
      if (spec.name != "kind") text += key_row(spec);
  }
  return text;
}

}  // namespace unfurl
