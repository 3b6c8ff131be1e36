// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/export/checksum.hpp"
#include "core/scene/overrides.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/scene/variables.hpp"
#include "core/scene/write.hpp"
#include "core/study/sweep.hpp"
#include "core/text/nearest_name.hpp"
#include "core/text/typeset_number.hpp"

namespace unfurl {
namespace {

constexpr std::size_t max_points = 10'000'000;
constexpr long max_count = 1'000'000;

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw StudyError(in_quotes(text) + ": " + why);
}

std::vector<std::string> split(const std::string& text, char mark) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == mark)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

double to_digits(double x, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*e", digits - 1, x);
  return std::strtod(text, nullptr);
}

void fill_range(const std::string& text, const std::vector<std::string>& parts, SweepAxis& axis) {
  const double from = number_of(parts[0]), to = number_of(parts[1]), count = number_of(parts[2]);
  if (!std::isfinite(from) || !std::isfinite(to))
    refuse(text, "a range runs from one finite number to another");
  if (!(count >= 1) || count != std::floor(count) || count > static_cast<double>(max_count))
    refuse(text, "the count must be a whole number from 1 to 1000000; got " + in_quotes(parts[2]));
  if (parts.size() == 4 && parts[3] != "log") refuse(text, "only 'log' may follow the count");
  axis.log = parts.size() == 4;
  if (axis.log && (!(from > 0) || !(to > 0))) refuse(text, "a log range needs numbers > 0");
  if (count > 1 && from == to) refuse(text, "the range is empty; its ends are equal");
  if (!std::isfinite(to - from) || (axis.log && !(std::isfinite(to / from) && std::isfinite(from / to))))
    refuse(text, "the range is wider than numbers are");
  for (long i = 0; i < static_cast<long>(count); ++i) {
    const double u = count > 1 ? static_cast<double>(i) / (count - 1) : 0.0;
    double x = axis.log ? from * std::pow(to / from, u) : from + (to - from) * u;
    // Whole numbers are met exactly, where rounding alone is between.
    const double size = axis.log ? std::abs(x) : std::max(std::abs(from), std::abs(to));
    if (i > 0 && std::abs(x - std::round(x)) <= 4 * std::numeric_limits<double>::epsilon() * size)
      x = std::round(x);
    // Powers are some digits off, and tenths one: 0.01 and not 0.009999999999999998, 0.3 and not
    // 0.30000000000000004.
    if (axis.log && i > 0) x = to_digits(x, 15);
    const double plain = to_digits(x, 12);
    if (i > 0 && std::abs(x - plain) <= 32 * std::numeric_limits<double>::epsilon() * std::abs(x)) x = plain;
    if (i + 1 == static_cast<long>(count) && i > 0) x = to;
    axis.numbers.push_back(x);
    axis.values.push_back(exact_number(x));
  }
  if (std::ranges::adjacent_find(axis.numbers) != axis.numbers.end())
    refuse(text, "there are not so many numbers between its ends");
}

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
    text.replace(at, what.size(), with);
  return text;
}

// As figures write it: "kg/m³", "N m²".
std::string typeset(const std::string& unit) {
  std::string text = replaced(unit, "deg", "\u00B0");
  for (const int n : {2, 3, 4}) text = replaced(std::move(text), "^" + std::to_string(n), superscript(n));
  return text;
}

// "structure.fold_angle": "fold angle"; "solver.step": "solver step"; "forces[drag_1].damping": "drag_1
// damping".
std::string words(const std::string& key) {
  const auto plain = [](const std::string& text) { return replaced(replaced(text, "_", " "), ".", " "); };
  const std::size_t open = key.find('['), shut = key.rfind(']');
  if (open != std::string::npos && shut != std::string::npos && shut > open + 1 && shut + 1 < key.size()) {
    std::string name = key.substr(open + 1, shut - open - 1);
    if (name.size() > 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    if (name.find_first_not_of("0123456789") != std::string::npos) return name + plain(key.substr(shut + 1));
  }
  for (const std::string_view implied : {"structure.", "variables."})
    if (key.starts_with(implied)) return plain(key.substr(implied.size()));
  return plain(key);
}

// Of the key with the override. What it calls by name or index the scene knows by another key: the one that
// is overridden now and was not before.
std::string unit_of(const std::string& key, const std::map<std::string, std::string>& now,
                    const std::map<std::string, std::string>& before) {
  if (const auto found = now.find(key); found != now.end()) return found->second;
  for (const auto& [name, unit] : now)
    if (!before.contains(name) || key.starts_with(name + "[")) return unit;
  return "";
}

}  // namespace

std::string SweepAxis::title() const {
  return words(key) + (unit.empty() ? "" : " (" + typeset(unit) + ")");
}

std::string SweepAxis::title(std::size_t value) const {
  return words(key) + " = " + word(value);
}

std::string SweepAxis::word(std::size_t value) const {
  std::string text = values[value];
  // Thirds have sixteen digits: as few as keep the values apart.
  const auto with = [&](int digits, double x) {
    std::ostringstream few;
    few << std::setprecision(digits) << x;
    return few.str();
  };
  if (!numbers.empty() && text.size() > 8) {
    int digits = 6;
    const auto first =
        numbers.begin() + static_cast<std::ptrdiff_t>(value - std::min(value, std::size_t{20}));
    const auto last = numbers.begin() + static_cast<std::ptrdiff_t>(std::min(value + 21, numbers.size()));
    const auto met = [&] {  // among those around it
      return std::count_if(first, last,
                           [&](double x) { return with(digits, x) == with(digits, numbers[value]); });
    };
    while (digits < 17 && met() > 1) ++digits;
    text = with(digits, numbers[value]);
  }
  const std::string space = unit.empty() || unit == "deg" ? "" : " ";
  return text + space + typeset(unit);
}

SweepAxis parse_axis(const std::string& text) {
  const std::size_t equals = equals_of(text);
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    refuse(text, "must be KEY=FROM:TO:COUNT, KEY=FROM:TO:COUNT:log or KEY=A,B,C");
  SweepAxis axis;
  axis.key = text.substr(0, equals);
  const std::string values = text.substr(equals + 1);
  const auto parts = split(values, ':');
  if (parts.size() >= 3 && parts.size() <= 4) {
    fill_range(text, parts, axis);
    return axis;
  }
  if (parts.size() != 1) refuse(text, "a range is FROM:TO:COUNT");
  axis.values = split(values, ',');
  if (axis.values[0].starts_with('[') || axis.values[0].starts_with('{'))
    refuse(text, "lists and tables cannot be varied; vary one of their entries, " + axis.key + "[2]=A,B,C");
  for (const auto& value : axis.values) {
    if (value.empty()) refuse(text, "the list has an empty entry");
    if (std::count(axis.values.begin(), axis.values.end(), value) > 1)
      refuse(text, in_quotes(value) + " is there twice");
    axis.numbers.push_back(number_of(value));
  }
  for (std::size_t i = 0; i < axis.numbers.size(); ++i)
    if (const auto first = std::find(axis.numbers.begin(), axis.numbers.end(), axis.numbers[i]);
        first < axis.numbers.begin() + static_cast<std::ptrdiff_t>(i))  // nan is like no other
      refuse(text, in_quotes(axis.values[static_cast<std::size_t>(first - axis.numbers.begin())]) + " and " +
                       in_quotes(axis.values[i]) + " are the same number");
  for (const double x : axis.numbers)
    if (!std::isfinite(x)) {
      axis.numbers.clear();
      break;
    }
  return axis;
}

Shard parse_shard(const std::string& text) {
  const auto parts = split(text, '/');
  const double index = parts.size() == 2 ? number_of(parts[0]) : 0,
               count = parts.size() == 2 ? number_of(parts[1]) : 0;
  if (!(count >= 1 && count <= 1e6 && index >= 1 && index <= count) || index != std::floor(index) ||
      count != std::floor(count))
    throw StudyError("a shard is I/N with 1 <= I <= N; got " + in_quotes(text));
  return {static_cast<int>(index), static_cast<int>(count)};
}

std::size_t SweepPlan::points() const {
  std::size_t n = 1;
  for (const SweepAxis& axis : axes) n = std::min(n * axis.values.size(), max_points + 1);
  return n;
}

std::vector<std::string> SweepPlan::key(std::size_t point) const {
  std::vector<std::string> values(axes.size());
  for (std::size_t a = axes.size(); a-- > 0;) {
    values[a] = axes[a].values[point % axes[a].values.size()];
    point /= axes[a].values.size();
  }
  return values;
}

std::vector<std::string> SweepPlan::changes(std::size_t point) const {
  std::vector<std::string> out = key(point);
  for (std::size_t a = 0; a < axes.size(); ++a) out[a] = axes[a].key + "=" + out[a];
  return out;
}

std::vector<std::string> SweepPlan::columns() const {
  std::vector<std::string> names;
  for (const SweepAxis& axis : axes) names.push_back(axis.key);
  names.emplace_back("outcome");
  for (const RunMeasure& measure : measures) names.push_back(measure.column);
  return names;
}

std::vector<std::size_t> SweepPlan::number_columns() const {
  std::vector<std::size_t> numbers(measures.size());
  std::iota(numbers.begin(), numbers.end(), axes.size() + 1);
  return numbers;
}

std::function<bool(const std::vector<std::string>&)> SweepPlan::asked() const {
  std::vector<std::set<std::string>> values;
  for (const SweepAxis& axis : axes) values.emplace_back(axis.values.begin(), axis.values.end());
  return [values](const std::vector<std::string>& row) {
    for (std::size_t k = 0; k < values.size(); ++k)
      if (!values[k].contains(row[k])) return false;
    return true;
  };
}

SceneError SweepPlan::of_axes(const SceneError& error) const {
  auto problems = error.problems();
  for (SceneProblem& problem : problems)
    if (problem.where.file == override_source &&
        std::ranges::any_of(axes, [&](const SweepAxis& axis) { return axis.key.starts_with(problem.key); }))
      problem.where.file = varied_source;
  return SceneError(std::move(problems));
}

bool SweepPlan::is_finished(const std::vector<std::string>& row) const {
  const std::string& outcome = row[axes.size()];
  if (outcome == "failed" || outcome == "invalid") return true;
  const bool deployed = outcome == to_string(RunStatus::deployed);
  if (!deployed && outcome != to_string(RunStatus::completed)) return false;
  for (std::size_t m = 0; m < measures.size(); ++m)
    if (!may_be(measures[m], number_of(row[axes.size() + 1 + m]), deployed)) return false;
  return true;
}

namespace {

// Beside each force that may not be unique, unless it is asked for anyway, whether it is.
void add_uniqueness(std::vector<RunMeasure>& measures) {
  for (std::size_t m = 0; m < measures.size(); ++m) {
    const std::string name = uniqueness_of(measures[m].name);
    const bool there = std::any_of(measures.begin(), measures.end(),
                                   [&](const RunMeasure& have) { return have.name == name; });
    if (!name.empty() && !there) measures.push_back(find_measure(name));
  }
}

// From the first value that a scene takes; values that none takes are rows of their own. Throws what is wrong
// with the first where none of these is taken: then it is the key.
std::string unit_of_axis(const SweepPlan& plan, const SweepAxis& axis,
                         const std::map<std::string, std::string>& known) {
  constexpr std::size_t most = 24;  // of a long list those that lie alike far apart
  const std::size_t count = std::min(axis.values.size(), most);
  std::optional<SceneError> first;
  for (std::size_t i = 0; i < count; ++i) try {
      const std::size_t at = count > 1 ? i * (axis.values.size() - 1) / (count - 1) : 0;
      return unit_of(axis.key, plan.source.read({axis.key + "=" + axis.values[at]}).units, known);
    } catch (const SceneError& error) {
      if (!first) first = plan.of_axes(error);
    }
  throw *first;
}

// "structure.angle (1000000) x structure.length (300)".
[[noreturn]] void refuse_grid(const SweepPlan& plan) {
  double points = 1;
  std::string product;
  for (const SweepAxis& axis : plan.axes) {
    points *= static_cast<double>(axis.values.size());
    product += (product.empty() ? "" : " x ") + axis.key + " (" + std::to_string(axis.values.size()) + ")";
  }
  throw StudyError("the grid has more than 1e7 points, " + short_number(points, 4) + ": " + product);
}

constexpr const char* not_there = "not there";

// An identity without the lines of files_of_points(), and these: what is there by "# NAME: ".
std::pair<std::string, std::map<std::string, std::string>> files_apart(const std::string& identity) {
  std::string rest;
  std::map<std::string, std::string> files;
  std::istringstream lines(identity);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.rfind("\": ") + 3;
    const std::string sum = line.starts_with("# \"") && end > 3 ? line.substr(end) : "";
    if (sum == not_there || (sum.size() == Checksum().text().size() &&
                             sum.find_first_not_of("0123456789abcdef") == std::string::npos))
      files[line.substr(0, end)] = sum;
    else
      rest += line + "\n";
  }
  return {rest, files};
}

}  // namespace

std::string files_of_points(const SweepPlan& plan) {
  if (!plan.source.files || !plan.source.text) return "";
  const std::set<std::string> own = plan.source.read().files;  // written out with the scene
  const std::set<std::string> naming =
      variables_of_files(parse_toml(*plan.source.text, plan.source.path), plan.source.overrides);
  for (const SweepAxis& axis : plan.axes) {
    const bool in_names = axis.key.starts_with("variables.") && naming.contains(axis.key.substr(10));
    if (!axis.numbers.empty() && !in_names) continue;
    for (const std::string& value : axis.values) try {
        static_cast<void>(plan.source.read({axis.key + "=" + value}));
      } catch (const SceneError&) {  // what it names was read
      }
  }
  std::string text;
  plan.source.files->each([&](const std::string& path, const TextFile& file) {
    if (own.contains(path)) return;
    Checksum sum;
    sum.add(file.text);
    const auto name = std::filesystem::path(path).lexically_relative(plan.source.folder);
    text += "# " + toml_string(name.string()) + ": " + (file.error.empty() ? sum.text() : not_there) + "\n";
  });
  return text;
}

std::optional<std::string> identity_of_both(const std::string& there, const std::string& now,
                                            bool may_have_come) {
  const auto [scene, files] = files_apart(now);
  const auto [other, others] = files_apart(there);
  if (scene != other) return std::nullopt;
  std::string text = now;
  for (const auto& [name, sum] : others)
    if (const auto found = files.find(name); found == files.end())
      text += name + sum + "\n";
    else if (found->second != sum && !(sum == not_there && may_have_come))
      return std::nullopt;
  return text;
}

void stand_on_a_point(SweepPlan& plan) {
  constexpr std::size_t looked_at = 8;  // a mistake elsewhere in a large scene is to be told soon
  std::vector<std::vector<std::string>> some;
  for (std::size_t point = 0; point < plan.points(); point += plan.points() / looked_at + 1)
    some.push_back(plan.changes(point));
  plan.source = valid_source(plan.source, some);
}

void check_plan(SweepPlan& plan) {
  if (plan.axes.empty()) throw StudyError("nothing to vary; give --vary KEY=FROM:TO:COUNT");
  if (plan.measures.empty()) throw StudyError("nothing to measure; give --measure NAME,...");
  for (const SweepAxis& axis : plan.axes)
    if (axis.values.empty()) throw StudyError("no value is given for " + in_quotes(axis.key));
  for (std::size_t m = 0; m < plan.measures.size(); ++m)
    for (std::size_t k = 0; k < m; ++k)
      if (plan.measures[k].column == plan.measures[m].column)
        throw StudyError("the measure " + in_quotes(plan.measures[m].name) + " is asked for twice");
  add_uniqueness(plan.measures);
  if (plan.points() > max_points) refuse_grid(plan);
  const Scene scene = plan.source.read();
  for (std::size_t a = 0; a < plan.axes.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const std::string &key = plan.axes[a].key, &other = plan.axes[b].key;
      if (key == other) throw StudyError("the key " + in_quotes(key) + " is varied twice");
      if (keys_overlap(scene, key, other))
        throw StudyError(in_quotes(other) + " and " + in_quotes(key) +
                         " are names of the same thing, or one is part of the other: vary one of them");
    }
  const auto& known = scene.units;
  for (SweepAxis& axis : plan.axes) {
    axis.whole = is_whole_number(scene, axis.key);
    const auto broken =
        std::ranges::find_if(axis.numbers, [](double number) { return number != std::floor(number); });
    if (broken != axis.numbers.end() && axis.whole)
      throw StudyError(in_quotes(axis.key) + " takes whole numbers; " +
                       axis.values[static_cast<std::size_t>(broken - axis.numbers.begin())] +
                       " is none: give a COUNT that leads to some, or list them (" + axis.key + "=4,6,12)");
  }
  for (SweepAxis& axis : plan.axes) axis.unit = unit_of_axis(plan, axis, known);
}

}  // namespace unfurl
