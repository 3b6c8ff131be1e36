// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/table_reader.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

using Kind = TomlTree::Kind;

std::optional<double> number(const TomlTree& tree) {
  if (tree.kind == Kind::real) return tree.real;
  if (tree.kind == Kind::integer) return static_cast<double>(tree.integer);
  return std::nullopt;
}

// A whole number, also when written 3.0.
std::optional<long> whole_number(const TomlTree& tree) {
  if (tree.kind == Kind::integer) return tree.integer;
  return tree.kind == Kind::real ? as_whole_number(tree.real) : std::nullopt;
}

std::optional<ParamValue> numbers(const TomlTree& tree) {
  if (tree.kind != Kind::array) return std::nullopt;
  std::vector<double> values;
  for (const auto& item : tree.items) {
    const auto x = number(item);
    if (!x) return std::nullopt;
    values.push_back(*x);
  }
  return values;
}

// The value in the shape that the parameter wants; nothing when its type cannot be that.
std::optional<ParamValue> shaped(const ParamSpec& spec, const TomlTree& tree) {
  switch (spec.kind) {
    case ParamKind::boolean:
      if (tree.kind == Kind::boolean) return tree.boolean;
      break;
    case ParamKind::integer:
      if (const auto i = whole_number(tree)) return *i;
      if (const auto x = number(tree)) return *x;
      break;
    case ParamKind::real:
      if (const auto x = number(tree)) return *x;
      break;
    case ParamKind::choice:
    case ParamKind::text:
      if (tree.kind == Kind::text) return tree.text;
      break;
    case ParamKind::vector:
      return numbers(tree);
    case ParamKind::names:  // names()
      break;
  }
  return std::nullopt;
}

// Given by an override, whole or in part.
bool overridden(const TomlTree& tree) {
  return tree.where.file == override_source || std::ranges::any_of(tree.items, overridden);
}

// A number that is not given is not a number, and equal to itself here.
bool same_value(const ParamValue& a, const ParamValue& b) {
  const auto *x = std::get_if<double>(&a), *y = std::get_if<double>(&b);
  return a == b || (x && y && std::isnan(*x) && std::isnan(*y));
}

std::string mistyped(const ParamSpec& spec, const TomlTree& tree) {
  std::string got = tree.describe();
  if (tree.kind == Kind::text) got = "the text " + in_quotes(tree.text);
  if (tree.kind == Kind::array && spec.kind == ParamKind::vector && tree.items.size() == spec.length)
    for (const auto& item : tree.items)
      if (!number(item)) got = "a list with " + item.describe();
  return "must be " + wanted_text(spec) + "; got " + got;
}

}  // namespace

std::optional<long> as_whole_number(double x) {
  constexpr double exact = 9007199254740992.0;  // 2^53: every whole number up to here is a double
  if (!(std::abs(x) <= exact) || x != std::floor(x)) return std::nullopt;
  return static_cast<long>(x);
}

void SceneNotes::add(const SourceLocation& where, std::string key, std::string message) {
  problems.push_back({where, std::move(key), std::move(message)});
}

TableReader::TableReader(const TomlTree* table, std::string path, const SourceLocation& where,
                         SceneNotes& notes)
    : table_(table), path_(std::move(path)), where_(where), notes_(notes) {}

std::string TableReader::key(std::string_view name) const {
  if (name.empty() || path_.empty()) return path_ + std::string(name);
  return path_ + "." + std::string(name);
}

void TableReader::problem(std::string_view name, std::string message) {
  const TomlTree* value = table_ ? table_->find(name) : nullptr;
  notes_.add(value ? value->where : where_, key(name), std::move(message));
}

const TomlTree* TableReader::member(std::string_view name) {
  known_.emplace_back(name);
  const TomlTree* value = table_ ? table_->find(name) : nullptr;
  if (value) notes_.locations[key(name)] = value->where;
  return value;
}

ParamSet TableReader::read(const std::vector<ParamSpec>& specs) {
  ParamSet values(specs);
  for (const auto& spec : specs) read_one(spec, values);
  return values;
}

void TableReader::read_one(const ParamSpec& spec, ParamSet& values) {
  const TomlTree* tree = member(spec.name);
  if (!spec.unit.empty()) units_.emplace(spec.name, spec.unit);
  if (!tree) {
    if (spec.required) problem(spec.name, "is missing; must be " + wanted_text(spec));
    return;
  }
  if (overridden(*tree)) notes_.units[key(spec.name)] = spec.unit;
  auto value = shaped(spec, *tree);
  if (!value) return problem(spec.name, mistyped(spec, *tree));
  std::string error = range_error(spec, *value);
  const auto* text = std::get_if<std::string>(&*value);
  if (!error.empty() && spec.kind == ParamKind::choice && text) {
    const auto near = nearest_name(*text, spec.choices);
    error = "must be " + wanted_text(spec) + "; got " + in_quotes(*text);
    if (!near.empty()) error += "; did you mean " + in_quotes(near) + "?";
  }
  if (!error.empty()) return problem(spec.name, error);
  values.set(spec.name, std::move(*value));
}

std::vector<std::string> TableReader::names(std::string_view name, const std::string& wanted) {
  const TomlTree* tree = member(name);
  std::vector<std::string> values;
  if (!tree) {
    problem(name, "is missing; must be " + wanted);
  } else if (tree->kind == Kind::text) {
    values.push_back(tree->text);
  } else if (tree->kind != Kind::array) {
    problem(name, "must be " + wanted + "; got " + tree->describe());
  } else {
    for (const auto& item : tree->items) {
      if (item.kind == Kind::text)
        values.push_back(item.text);
      else
        notes_.add(item.where, key(name), "must be " + wanted + "; got a list with " + item.describe());
    }
    if (tree->items.empty()) problem(name, "must be " + wanted + "; got an empty list");
  }
  return values;
}

const TomlTree* TableReader::table(std::string_view name) {
  const TomlTree* tree = member(name);
  if (!tree || tree->kind == Kind::table) return tree;
  problem(name, "must be a table, [" + key(name) + "]; got " + tree->describe());
  return nullptr;
}

std::vector<const TomlTree*> TableReader::tables(std::string_view name) {
  const TomlTree* tree = member(name);
  std::vector<const TomlTree*> found;
  if (!tree) return found;
  if (tree->kind != Kind::array) {
    problem(name, "must be an array of tables, [[" + key(name) + "]]; got " + tree->describe());
    return found;
  }
  for (const auto& item : tree->items) {
    if (item.kind == Kind::table)
      found.push_back(&item);
    else
      notes_.add(item.where, key(name),
                 "must be an array of tables, [[" + key(name) + "]]; got " + item.describe());
  }
  return found;
}

void TableReader::warn_idle(const std::vector<ParamSpec>& specs, const ParamSet& values, Idle which) {
  for (const ParamSpec& spec : specs) {
    if (!has(spec.name)) continue;
    const std::string reason = idle_reason(spec, specs, values);
    if (reason.empty()) continue;
    warn_idle(spec.name, reason,
              which == Idle::from_command_line || same_value(values.value(spec.name), spec.fallback));
  }
}

void TableReader::warn_idle(std::string_view name, const std::string& reason, bool may_stand) {
  if (!has(name) || (may_stand && !overridden(*table_->find(name)))) return;
  notes_.warnings.push_back({table_->find(name)->where, key(name), "does nothing " + reason});
}

std::vector<SceneProblem> TableReader::overridden_among(const std::vector<std::string_view>& keys,
                                                        std::string_view reason) const {
  std::vector<SceneProblem> found;
  for (const std::string_view name : keys)
    if (has(name) && overridden(*table_->find(name)) &&
        std::ranges::find(notes_.warnings, key(name), &SceneProblem::key) == notes_.warnings.end())
      found.push_back({table_->find(name)->where, key(name), "does nothing " + std::string(reason)});
  return found;
}

void TableReader::warn_overridden(const std::vector<std::string_view>& keys, std::string_view reason) {
  for (SceneProblem& found : overridden_among(keys, reason)) notes_.warnings.push_back(std::move(found));
}

std::map<std::string, SourceLocation, std::less<>> TableReader::places() const {
  std::map<std::string, SourceLocation, std::less<>> places;
  if (table_)
    for (const auto& [name, value] : table_->entries) places[name] = value.where;
  return places;
}

void TableReader::finish() {
  if (!table_) return;
  for (const auto& [name, value] : table_->entries) {
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    const auto& where =
        value.key_where.line > 0 || value.key_where.file == override_source ? value.key_where : value.where;
    const std::vector<std::string_view> known(known_.begin(), known_.end());
    const auto other_unit = units_.find(std::string(name_before_unit(name, known)));
    std::string message = "unknown key";
    if (other_unit == units_.end())
      message += did_you_mean(name, known);
    else  // a rename alone would change the value
      message += "; give " + in_quotes(other_unit->first) + ", converted to " + other_unit->second;
    if (message.ends_with("...")) message += "; all of them: unfurl list keys";
    notes_.add(where, key(name), std::move(message));
  }
}

}  // namespace unfurl
