// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/variables.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/expression.hpp"
#include "core/scene/overrides.hpp"
#include "core/text/nearest_name.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

namespace {

constexpr std::size_t max_turns = 100'000;  // of all loops of repeated entries together
constexpr std::string_view of_variables = "variables.";
using Kind = TomlTree::Kind;

bool is_expression(const TomlTree& tree) {
  return tree.kind == Kind::text && tree.text.starts_with('=');
}

std::vector<std::string> words_of(const std::string& expression) {
  std::vector<std::string> words(1);
  for (const char c : expression) {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  return words;
}

void add_words(const TomlTree& tree, std::set<std::string>& words) {
  for (std::string& word : words_of(tree.text)) words.insert(std::move(word));
  for (const TomlTree& item : tree.items) add_words(item, words);
  for (const auto& [name, value] : tree.entries) add_words(value, words);
}

// Words of braces in names of files, and of how often an entry stands that names one; whether one is named.
bool add_words_of_names(const TomlTree& tree, std::set<std::string>& words) {
  bool named = false;
  for (const TomlTree& item : tree.items) named |= add_words_of_names(item, words);
  for (const auto& [key, value] : tree.entries) {
    const bool name =
        value.kind == Kind::text && (key == "nodes_file" || key == "rods_file" || key == "table");
    if (name && value.text.find('{') != std::string::npos) add_words(value, words);
    named |= add_words_of_names(value, words) || name;
  }
  if (const TomlTree* ranges = tree.find("repeat"); ranges && named) add_words(*ranges, words);
  return named;
}

// Works out one tree: its expressions, its braces, its repeated entries.
class Expansion {
 public:
  explicit Expansion(std::vector<SceneProblem>& problems) : problems_(problems) {}

  // Takes [variables] out of the root: each may use those above it.
  void read_variables(TomlTree& root) {
    TomlTree* table = root.find("variables");
    if (!table) return;
    braces_ = true;
    if (table->kind == Kind::table) {
      for (const auto& [name, value] : table->entries) below_.emplace(name, &value);
      for (const auto& [name, value] : table->entries) {
        below_.erase(name);
        reading_ = name;
        places_[name] = value.where;
        read_variable(name, value);
      }
      reading_.clear();
    } else {
      note(*table, "variables", "must be a table, [variables]; got " + table->describe());
      none_is_known_ = true;
    }
    std::erase_if(root.entries, [](const auto& entry) { return entry.key == "variables"; });
  }

  // What is filled in by overrides afterwards has expressions, but no braces.
  void leave_braces() { braces_ = false; }

  const Variables& variables() const { return variables_; }
  const std::set<std::string>& keys() const { return keys_; }

  // Variables that nothing but other such ones is worked out of, and where they stand.
  std::map<std::string, SourceLocation> idle() const {
    std::map<std::string, SourceLocation> out = places_;
    std::vector<std::string> open{""};  // the scene itself
    while (!open.empty()) {
      const auto used = uses_.find(open.back());
      open.pop_back();
      if (used == uses_.end()) continue;
      for (const std::string& name : used->second)
        if (out.erase(name) > 0) open.push_back(name);
    }
    return out;
  }

  void expand(TomlTree& tree, const std::string& key) {
    if (key == "title") return;  // its braces are parameters of the structure (title.hpp)
    if (is_expression(tree)) {
      keys_.insert(key);
      if (const auto value = value_of(tree, key)) become(tree, without_rounding(*value, Rounds::its_own));
    } else if (tree.kind == Kind::text && braces_) {
      fill_braces(tree, key);
    }
    if (tree.kind == Kind::array) expand_items(tree, key);
    for (auto& [name, entry] : tree.entries) expand(entry, key.empty() ? name : key + "." + name);
  }

 private:
  void note(const TomlTree& at, const std::string& key, std::string message) {
    problems_.push_back({at.where, key, std::move(message)});
  }

  void read_variable(const std::string& name, const TomlTree& tree) {
    const std::string key = std::string(of_variables) + name;
    if (!is_variable_name(name))
      return note(tree, key, "must be a letter, then letters, digits or _, and no constant or function");
    if (const auto value = value_of(tree, key))
      variables_[name] = is_expression(tree) ? without_rounding(*value, Rounds::its_own) : *value;
    else
      wrong_.insert(name);
  }

  // The number that a value is or works out to; nothing where that is noted.
  std::optional<double> value_of(const TomlTree& tree, const std::string& key) {
    if (tree.kind == Kind::integer) return static_cast<double>(tree.integer);
    if (tree.kind == Kind::real && std::isfinite(tree.real)) return tree.real;
    if (is_expression(tree)) return evaluated(tree, std::string_view(tree.text).substr(1), key);
    note(tree, key, "must be a finite number or an expression, \"=...\"; got " + tree.describe());
    return std::nullopt;
  }

  std::optional<double> evaluated(const TomlTree& at, std::string_view text, const std::string& key) {
    if (!reading_.empty() || texts_.insert(std::string(text)).second)
      for (std::string& word : words_of(std::string(text))) uses_[reading_].insert(std::move(word));
    try {
      return evaluate(text, variables_);
    } catch (const ExpressionError& error) {
      // What is wrong with a variable has been said where it stands.
      if (!error.unknown.empty() && (none_is_known_ || wrong_.contains(error.unknown))) return std::nullopt;
      const std::string why = below_.contains(error.unknown) ? why_not_below(error.unknown) : error.what();
      note(
          at, key,
          "in the expression " + in_quotes(text) + ", character " + std::to_string(error.place) + ": " + why);
      return std::nullopt;
    }
  }

  // The variable that is being read needs this one, which stands below it: no order helps where that one, or
  // what it needs, needs the first in its turn.
  std::string why_not_below(const std::string& name) const {
    std::set<std::string> seen;
    std::vector<std::string> open{name};
    while (!open.empty()) {
      const std::string at = std::move(open.back());
      open.pop_back();
      if (at == reading_)
        return in_quotes(name) + " is worked out of " + in_quotes(reading_) +
               " in its turn: give one of them a number";
      const auto below = below_.find(at);
      if (below == below_.end() || !seen.insert(at).second || !is_expression(*below->second)) continue;
      for (std::string& word : words_of(below->second->text)) open.push_back(std::move(word));
    }
    return in_quotes(name) + " stands below: a variable may use those above it; move one of them";
  }

  // 2.1 / 0.7 is 3 but for rounding, and means 3 where things are counted and named. What is counted from one
  // is 0 where it is rounding of one; of a quantity nothing is known but itself: 1e-17 m^4 is a tape's second
  // moment.
  enum class Rounds { its_own, of_one };
  static double without_rounding(double value, Rounds rounds) {
    constexpr double share = 8 * std::numeric_limits<double>::epsilon();
    const double whole = std::round(value);
    const double size = rounds == Rounds::of_one ? std::max(1.0, std::abs(value)) : std::abs(value);
    return std::abs(value - whole) <= share * size ? whole : value;
  }

  static void become(TomlTree& tree, double value) {
    constexpr double exact = 9007199254740992.0;  // 2^53: every whole number up to here is a double
    tree.text.clear();
    tree.kind = value == std::floor(value) && std::abs(value) <= exact ? Kind::integer : Kind::real;
    tree.integer = tree.kind == Kind::integer ? static_cast<long>(value) : 0;
    tree.real = value;
  }

  void fill_braces(TomlTree& tree, const std::string& key) {
    std::string filled;
    const std::string_view text = tree.text;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const bool doubled = i + 1 < text.size() && text[i + 1] == text[i];
      if ((text[i] != '{' && text[i] != '}') || doubled) {
        filled += text[i];
        if (doubled && (text[i] == '{' || text[i] == '}')) ++i;
        continue;
      }
      const std::size_t end = text.find('}', i);
      if (text[i] == '}' || end == text.npos)
        return note(tree, key, "a brace stands alone in " + in_quotes(text) + "; write it twice to mean it");
      const std::string_view inside = text.substr(i + 1, end - i - 1);
      const auto value = evaluated(tree, inside, key);
      if (!value) return;
      const bool quantity = is_variable_name(std::string(inside));
      filled += shortest_number(without_rounding(*value, quantity ? Rounds::its_own : Rounds::of_one));
      keys_.insert(key);
      i = end;
    }
    tree.text = std::move(filled);
  }

  void expand_items(TomlTree& array, const std::string& key) {
    std::vector<TomlTree> items;
    for (std::size_t i = 0; i < array.items.size(); ++i) {
      TomlTree& item = array.items[i];
      if (item.kind == Kind::table && item.find("repeat")) {
        repeat(std::move(item), key, items);
      } else {
        expand(item, key + "[" + std::to_string(items.size()) + "]");
        items.push_back(std::move(item));
      }
    }
    array.items = std::move(items);
  }

  // The entry once for each value of the variables of its `repeat`.
  void repeat(TomlTree entry, const std::string& key, std::vector<TomlTree>& items) {
    const std::string place = key + "[" + std::to_string(items.size()) + "].repeat";
    const TomlTree ranges = std::move(*entry.find("repeat"));
    std::erase_if(entry.entries, [](const auto& member) { return member.key == "repeat"; });
    if (ranges.kind != Kind::table || ranges.entries.empty())
      return note(ranges, place, "must be a table such as {i = \"0:n\"}; got " + ranges.describe());
    const bool braces = std::exchange(braces_, true);
    repeat_over(ranges, 0, entry, key, items);
    braces_ = braces;
  }

  void repeat_over(const TomlTree& ranges, std::size_t which, const TomlTree& entry, const std::string& key,
                   std::vector<TomlTree>& items) {
    const std::string here = key + "[" + std::to_string(items.size()) + "]";
    if (which == ranges.entries.size()) {
      items.push_back(entry);
      return expand(items.back(), here);
    }
    const auto& [name, range] = ranges.entries[which];
    const std::string place = here + ".repeat." + name;
    if (!is_variable_name(name))
      return note(range, place, "must be a letter, then letters, digits or _, and no constant or function");
    if (variables_.contains(name)) return note(range, place, "is the name of another variable");
    const std::size_t problems = problems_.size();
    for (const double value : values_of(range, place)) {
      if (++turns_ == max_turns + 1) note(range, place, too_many());
      if (turns_ > max_turns || problems_.size() > problems) break;  // the others have the same mistake
      variables_[name] = value;
      repeat_over(ranges, which + 1, entry, key, items);
    }
    variables_.erase(name);
  }

  static std::string too_many() { return "would make more than " + std::to_string(max_turns) + " entries"; }

  // "A:B": A, A + 1, ..., B - 1; or a list of numbers and expressions.
  std::vector<double> values_of(const TomlTree& range, const std::string& key) {
    std::vector<double> values;
    if (range.kind == Kind::array) {
      for (const TomlTree& item : range.items)
        if (const auto value = value_of(item, key)) values.push_back(*value);
      return values;
    }
    const std::size_t colon = range.text.find(':');
    if (range.kind != Kind::text || colon == std::string::npos) {
      note(range, key,
           "must be a range \"FROM:END\", END not included, or a list of numbers; got " + range.describe());
      return values;
    }
    auto from = evaluated(range, std::string_view(range.text).substr(0, colon), key);
    auto end = evaluated(range, std::string_view(range.text).substr(colon + 1), key);
    if (!from || !end) return values;
    from = without_rounding(*from, Rounds::of_one);
    end = without_rounding(*end, Rounds::of_one);
    if (*end < *from)
      note(range, key, "must not end before it begins; got " + in_quotes(range.text));
    else if (*end - *from > static_cast<double>(max_turns))
      note(range, key, too_many());
    else
      for (double x = *from; x < *end; x = *from + static_cast<double>(values.size())) values.push_back(x);
    return values;
  }

  std::vector<SceneProblem>& problems_;
  Variables variables_;
  std::set<std::string> keys_;
  std::map<std::string, SourceLocation> places_;               // of the variables
  std::map<std::string, std::set<std::string>> uses_;          // by each variable, and by the scene ("")
  std::set<std::string> texts_;                                // that were looked through
  std::map<std::string, const TomlTree*, std::less<>> below_;  // variables that are not worked out yet
  std::string reading_;                                        // the one that is
  std::set<std::string> wrong_;                                // variables that are there, but have no value
  bool none_is_known_ = false;                                 // because [variables] is no table
  bool braces_ = false;
  std::size_t turns_ = 0;
};

// A variable that an override names must be there: it would mean nothing.
void refuse_unknown_variable(const TomlTree& root, const std::string& override_text,
                             std::vector<SceneProblem>& problems) {
  const std::string key = override_text.substr(0, equals_of(override_text));
  const std::string name = key.substr(of_variables.size());
  const TomlTree* table = root.find("variables");
  std::vector<std::string_view> known;
  if (table)
    for (const auto& [variable, value] : table->entries) known.push_back(variable);
  for (const auto& variable : known)
    if (variable == name) return;
  SceneProblem problem;  // member by member: GCC 12 takes a temporary of three for uninitialised
  problem.where.file = override_source;
  problem.key = key;
  problem.message = "the scene has no such variable" + did_you_mean(name, known);
  problems.push_back(std::move(problem));
}

void refuse_all_variables(std::vector<SceneProblem>& problems) {
  SceneProblem problem;
  problem.where.file = override_source;
  problem.key = "variables";
  problem.message = "are changed one by one: variables.NAME=VALUE";
  problems.push_back(std::move(problem));
}

}  // namespace

bool apply_overrides_and_expand(TomlTree& root, const std::vector<std::string>& overrides,
                                std::vector<SceneProblem>& problems, WorkedOut* worked_out) {
  std::vector<std::string> first, then;
  for (const auto& text : overrides) (text.starts_with(of_variables) ? first : then).push_back(text);
  for (const auto& text : first) refuse_unknown_variable(root, text, problems);
  if (!problems.empty()) return false;
  apply_overrides(root, first, problems);
  Expansion expansion(problems);
  expansion.read_variables(root);
  if (worked_out) worked_out->variables.insert(expansion.variables().begin(), expansion.variables().end());
  expansion.expand(root, "");
  if (!problems.empty()) return false;
  apply_overrides(root, then, problems);
  const std::size_t before = problems.size();
  if (root.find("variables"))
    refuse_all_variables(problems);  // they are worked out by now, and out of the tree
  expansion.leave_braces();
  expansion.expand(root, "");
  if (worked_out) worked_out->keys = expansion.keys(), worked_out->idle = expansion.idle();
  return problems.size() == before;
}

std::set<std::string> variables_of_files(TomlTree root, const std::vector<std::string>& overrides) {
  std::vector<SceneProblem> told_elsewhere;
  std::set<std::string> words, found;
  std::vector<std::string> variables;
  for (const auto& text : overrides)
    if (text.starts_with(of_variables))
      variables.push_back(text);
    else if (text.find("repeat") != std::string::npos)  // its braces count, too: whatever it names
      for (std::string& word : words_of(text)) words.insert(std::move(word));
  apply_overrides(root, variables, told_elsewhere);
  add_words_of_names(root, words);
  const TomlTree* table = root.find("variables");
  if (!table) return found;
  for (auto entry = table->entries.rbegin(); entry != table->entries.rend(); ++entry)  // of those above it
    if (words.contains(entry->key)) {
      found.insert(entry->key);
      add_words(entry->value, words);
    }
  return found;
}

}  // namespace unfurl
