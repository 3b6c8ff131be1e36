// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/overrides.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "core/scene/write.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

const SourceLocation from_command_line{override_source, 0, 0};

// Why an override cannot be applied.
struct Refusal {
  std::string message;
};

struct Step {
  std::string name;
  bool entry = false;                // [motor]: the entry of that name in a list
  std::optional<std::size_t> index;  // [3]; `name` is empty then
};

std::string quoted_step(std::string_view key, std::size_t& i) {
  const std::size_t end = key.find(key[i], i + 1);
  if (end == std::string_view::npos) throw Refusal{"a quote in the key stays open"};
  std::string name(key.substr(i + 1, end - i - 1));
  i = end + 1;
  return name;
}

Step index_step(std::string_view key, std::size_t& i) {
  // A name in quotes may hold brackets.
  std::size_t from = i + 1;
  if (from < key.size() && (key[from] == '"' || key[from] == '\''))
    from = std::min(key.find(key[from], from + 1), key.size());
  const std::size_t end = key.find(']', from);
  if (end == std::string_view::npos) throw Refusal{"a bracket in the key stays open"};
  std::string_view text = key.substr(i + 1, end - i - 1);
  i = end + 1;
  std::size_t index = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error == std::errc() && stop == text.data() + text.size()) return {"", false, index};
  const bool quoted = text.size() >= 2 && (text[0] == '"' || text[0] == '\'') && text.back() == text[0];
  if (quoted) text = text.substr(1, text.size() - 2);
  const bool number = !quoted && (text.starts_with('-') || text.starts_with('+')) &&
                      text.find_first_not_of("0123456789", 1) == text.npos;
  if (text.empty() || number)
    throw Refusal{"an index must be a whole number in brackets, [0] the first, or a name"};
  return {std::string(text), true, std::nullopt};
}

std::vector<Step> parse_key(std::string_view key) {
  std::vector<Step> steps;
  std::size_t i = 0;
  while (true) {
    if (i < key.size() && (key[i] == '"' || key[i] == '\'')) {
      steps.push_back({quoted_step(key, i), false, std::nullopt});
    } else {
      const std::size_t end = std::min(key.find_first_of(".[", i), key.size());
      if (end == i) throw Refusal{"the key has an empty part"};
      steps.push_back({std::string(key.substr(i, end - i)), false, std::nullopt});
      i = end;
    }
    while (i < key.size() && key[i] == '[') steps.push_back(index_step(key, i));
    if (i == key.size()) return steps;
    if (key[i++] != '.') throw Refusal{"parts of a key are separated by dots"};
  }
}

void locate_at_command_line(TomlTree& tree) {
  tree.where = tree.key_where = from_command_line;
  for (auto& item : tree.items) locate_at_command_line(item);
  for (auto& [name, value] : tree.entries) locate_at_command_line(value);
}

// Begins like a word rather than like a number, a list or a quoted string, and is one line of printable text.
bool is_bare_word(std::string_view text) {
  if (text.empty() || std::string_view("0123456789+-[]{}\"'=#").find(text[0]) != std::string_view::npos)
    return false;
  for (const char c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == '"') return false;
  return true;
}

// How TOML writes what is no TOML value as it stands, where that is known: a number with nothing before or
// behind its point, a list without brackets.
std::string in_toml(std::string_view text) {
  const std::string_view number = text.substr(text.starts_with('+') ? 1 : 0);
  double x = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), x);
  if (error == std::errc() && end == number.data() + number.size() && number.find('.') != number.npos)
    return toml_value(x);
  const bool list = text.find(',') != text.npos && text.find_first_not_of("0123456789+-.eE, ") == text.npos;
  return list ? "[" + std::string(text) + "]" : "";
}

TomlTree parse_value(std::string_view text) {
  TomlTree value;
  try {
    TomlTree parsed = parse_toml("value = " + std::string(text) + "\n", override_source);
    if (parsed.entries.size() != 1) throw Refusal{"the value must be one TOML value"};
    value = std::move(parsed.entries[0].value);
  } catch (const SceneError& error) {
    if (const std::string meant = in_toml(text); !meant.empty())
      throw Refusal{"not a TOML value: " + in_quotes(text) + "; write " + meant};
    if (!is_bare_word(text)) {
      const bool none = text.find_first_not_of(" \t") == std::string_view::npos;
      throw Refusal{none ? "has no value"
                         : "not a TOML value: " + in_quotes(text) +
                               "; text goes in quotes unless it is a bare word"};
    }
    value.kind = TomlTree::Kind::text;
    value.text = text;
    if (const auto obstacle = find_bad_encoding(text); !obstacle.message.empty())
      throw Refusal{obstacle.message};
  }
  locate_at_command_line(value);
  return value;
}

// What an entry of an array of tables goes by: its name; without one, "A-B" from its nodes.
struct EntryName {
  std::string text;
  bool own = false;  // the entry says it
};

EntryName entry_name(const TomlTree& entry) {
  const TomlTree* name = entry.find("name");
  if (name && name->kind == TomlTree::Kind::text) return {name->text, true};
  const TomlTree* nodes = entry.find("nodes");
  if (!nodes || nodes->items.size() != 2) return {};
  return {nodes->items[0].text + "-" + nodes->items[1].text};
}

// Lists of entries to which one more may be added.
bool grows(std::string_view key) {
  return key == "loads" || key == "forces" || key == "constraints" || key == "structure.nodes" ||
         key == "structure.rods" || key == "structure.constraints" || key == "surfaces" ||
         key == "render.camera_keys" || key == "render.materials";
}

TomlTree made_here(TomlTree::Kind kind) {
  TomlTree made;
  made.kind = kind;
  made.where = made.key_where = from_command_line;
  return made;
}

TomlTree& step_into_array(TomlTree& array, const Step& step, std::string_view so_far) {
  if (step.index) {
    const std::size_t count = array.items.size();
    if (*step.index == count && grows(so_far)) array.items.push_back(made_here(TomlTree::Kind::table));
    if (*step.index < array.items.size()) return array.items[*step.index];
    throw Refusal{std::string(so_far) + " has " + std::to_string(count) +
                  (count == 1 ? " entry" : " entries") +
                  (grows(so_far) ? "; a new one is [" + std::to_string(count) + "]" : "; the first is [0]")};
  }
  std::vector<std::string> names;
  std::vector<std::size_t> between;  // entries without a name that stand between two nodes of that name
  for (std::size_t i = 0; i < array.items.size(); ++i) {
    const EntryName name = entry_name(array.items[i]);
    if (name.own && name.text == step.name) return array.items[i];
    if (!name.own && name.text == step.name) between.push_back(i);
    if (!name.text.empty()) names.push_back(name.text);
  }
  if (between.size() == 1) return array.items[between[0]];
  if (between.size() > 1)
    throw Refusal{std::string(so_far) + " has " + std::to_string(between.size()) + " entries that go by " +
                  in_quotes(step.name) + "; the first is [" + std::to_string(between[0]) + "], the second [" +
                  std::to_string(between[1]) + "]"};
  const std::string first = "; " + std::string(array.items.empty() ? "a new one" : "the first") + " is [0]";
  throw Refusal{std::string(so_far) + " has no entry named " + in_quotes(step.name) +
                (names.empty() ? first : did_you_mean(step.name, {names.begin(), names.end()}))};
}

// Vectors of three: all that may be left out are zero by default.
bool names_vector(std::string_view key) {
  constexpr std::array<std::string_view, 9> keys = {
      "acceleration", "axis", "direction", "force", "normal", "point", "position", "second_axis", "velocity"};
  return std::ranges::find(keys, key) != keys.end();
}

// A vector that the scene leaves out, of which one component is given.
TomlTree zero_vector() {
  TomlTree made = made_here(TomlTree::Kind::array), zero = made_here(TomlTree::Kind::real);
  made.items.assign(3, zero);
  return made;
}

// `next`: the step behind this one; null: there is none.
TomlTree& step_into(TomlTree& tree, const Step& step, const std::string& so_far, const Step* next) {
  if (tree.kind == TomlTree::Kind::array) return step_into_array(tree, step, so_far);
  if (tree.kind != TomlTree::Kind::table) throw Refusal{so_far + " is " + tree.describe() + ", not a table"};
  if (step.index || step.entry) throw Refusal{so_far + " is not a list"};
  if (TomlTree* found = tree.find(step.name)) return *found;
  const bool in_list = next && (next->index || next->entry);
  const bool list = in_list && grows((so_far.empty() ? "" : so_far + ".") + step.name);
  const bool vector = in_list && !list && next->index && *next->index < 3 && names_vector(step.name);
  tree.entries.push_back(
      {step.name, vector ? zero_vector() : made_here(list ? TomlTree::Kind::array : TomlTree::Kind::table)});
  return tree.entries.back().value;
}

// What stands at a key, made where nothing does; `place`: where that is, part by part.
TomlTree& made_at(TomlTree& root, const std::vector<Step>& steps, std::vector<std::string>* place = nullptr) {
  TomlTree* target = &root;
  std::string so_far;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Step& step = steps[k];
    TomlTree& parent = *target;
    target = &step_into(parent, step, so_far, k + 1 < steps.size() ? &steps[k + 1] : nullptr);
    const bool entry = parent.kind == TomlTree::Kind::array;
    if (place) place->push_back(entry ? std::to_string(target - parent.items.data()) : step.name);
    so_far += step.index ? "[" + std::to_string(*step.index) + "]" : (so_far.empty() ? "" : ".") + step.name;
  }
  return *target;
}

void apply(TomlTree& root, std::string_view key, std::string_view text) {
  const auto steps = parse_key(key);
  TomlTree value = parse_value(text);
  made_at(root, steps) = std::move(value);
}

// Of keys into lists that may be in files beside the scene.
std::string in_a_file(const TomlTree& root, const std::string& key) {
  const TomlTree* structure = root.find("structure");
  for (const std::string name : {"nodes", "rods"})
    if (structure && key.starts_with("structure." + name))
      if (std::string said = entries_in_file(name, structure->find(name + "_file")); !said.empty())
        return "; " + said;
  return "";
}

}  // namespace

std::string entries_in_file(const std::string& name, const TomlTree* file) {
  if (!file || file->kind != TomlTree::Kind::text || file->text.empty()) return "";
  return "those of " + name + "_file = " + in_quotes(file->text) + " are changed in that file";
}

std::vector<std::string> place_of_key(TomlTree root, const std::string& key) {
  std::vector<std::string> place;
  try {
    made_at(root, parse_key(key), &place);
  } catch (const Refusal&) {
    return {key};
  }
  return place;
}

TomlTree value_at(TomlTree root, const std::string& key) {
  try {
    return std::move(made_at(root, parse_key(key)));
  } catch (const Refusal&) {
    return made_here(TomlTree::Kind::table);
  }
}

std::size_t equals_of(std::string_view text) {
  const auto is_quote = [&](std::size_t i) { return i < text.size() && (text[i] == '"' || text[i] == '\''); };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '=') return i;
    const bool bracket = text[i] == '[';
    if (const std::size_t from = i + bracket; is_quote(from) && (bracket || i == 0 || text[i - 1] == '.'))
      i = text.find(text[from], from + 1);
    if (bracket) i = text.find(']', i);
    if (i == text.npos) return text.find('=');  // what stays open is told of where the key is read
  }
  return text.npos;
}

void apply_overrides(TomlTree& root, const std::vector<std::string>& overrides,
                     std::vector<SceneProblem>& problems) {
  for (const auto& text : overrides) {
    const std::size_t equals = equals_of(text);
    const std::string key = text.substr(0, equals);
    try {
      if (equals == std::string::npos) throw Refusal{"must be key=value"};
      apply(root, key, std::string_view(text).substr(equals + 1));
    } catch (const Refusal& refusal) {
      problems.push_back({from_command_line, key, refusal.message + in_a_file(root, key)});
    }
  }
}

}  // namespace unfurl
