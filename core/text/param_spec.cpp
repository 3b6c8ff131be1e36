// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/param_spec.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

std::string join(const std::vector<std::string_view>& names) {
  std::string text;
  for (const auto name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text;
}

std::string value_text(const ParamValue& value) {
  struct Writer {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(long i) const { return std::to_string(i); }
    std::string operator()(double x) const { return shortest_number(x); }
    std::string operator()(const std::string& s) const { return '"' + s + '"'; }
    std::string operator()(const std::vector<double>& v) const {
      std::string text = "[";
      for (const double x : v) text += (text.size() > 1 ? ", " : "") + shortest_number(x);
      return text + "]";
    }
    std::string operator()(const std::vector<std::string>& v) const {
      std::string text = "[";
      for (const auto& name : v) text += (text.size() > 1 ? ", \"" : "\"") + name + '"';
      return text + "]";
    }
  };
  return std::visit(Writer{}, value);
}

std::string with_unit(std::string text, std::string_view unit) {
  return unit.empty() ? text : text.append(" ").append(unit);
}

// Infinite is what has no end by default, nothing else.
bool endless(const ParamSpec& spec, double x) {
  const auto* fallback = std::get_if<double>(&spec.fallback);
  return fallback && std::isinf(x) && x == *fallback;
}

bool in_range(const ParamSpec& spec, double x) {
  if (endless(spec, x)) return true;
  return std::isfinite(x) && (spec.min_open ? x > spec.min : x >= spec.min) &&
         (spec.max_open ? x < spec.max : x <= spec.max);
}

bool acceptable(const ParamSpec& spec, const ParamValue& value) {
  const auto* integer = std::get_if<long>(&value);
  const auto* real = std::get_if<double>(&value);
  const auto* text = std::get_if<std::string>(&value);
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  const auto* names = std::get_if<std::vector<std::string>>(&value);
  switch (spec.kind) {
    case ParamKind::boolean:
      return std::holds_alternative<bool>(value);
    case ParamKind::integer:
      return integer && in_range(spec, static_cast<double>(*integer));
    case ParamKind::real:
      return (real && in_range(spec, *real)) || (integer && in_range(spec, static_cast<double>(*integer)));
    case ParamKind::choice:
      for (const auto choice : spec.choices)
        if (text && *text == choice) return true;
      return false;
    case ParamKind::text:
      return text != nullptr;
    case ParamKind::vector:
      if (!numbers || (spec.length > 0 && numbers->size() != spec.length)) return false;
      for (const double x : *numbers)
        if (!in_range(spec, x)) return false;
      return true;
    case ParamKind::names:
      return names && !names->empty() && (spec.length == 0 || names->size() == spec.length);
  }
  return false;
}

ParamSpec named(std::string_view name, std::string_view unit, ParamKind kind, ParamValue fallback,
                std::string_view help) {
  ParamSpec spec;
  spec.name = name;
  spec.unit = unit;
  spec.kind = kind;
  spec.fallback = std::move(fallback);
  spec.help = help;
  return spec;
}

// "> 0", "[0.1, 8]", "" without a bound.
std::string interval_text(const ParamSpec& spec) {
  const bool low = std::isfinite(spec.min), high = std::isfinite(spec.max);
  if (low && high) {
    return (spec.min_open ? "(" : "[") + shortest_number(spec.min) + ", " + shortest_number(spec.max) +
           (spec.max_open ? ")" : "]");
  }
  if (low) return (spec.min_open ? "> " : ">= ") + shortest_number(spec.min);
  if (high) return (spec.max_open ? "< " : "<= ") + shortest_number(spec.max);
  return "";
}

}  // namespace

std::string shortest_number(double x) {
  if (std::isnan(x)) return "nan";
  if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
  std::array<char, 32> buffer{};
  const bool countable = x == std::floor(x) && std::abs(x) < 1e7;  // 100000 rather than 1e+05
  const auto end = countable
                       ? std::to_chars(buffer.data(), buffer.data() + buffer.size(), static_cast<long>(x)).ptr
                       : std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr;
  return {buffer.data(), end};
}

ParamSpec real_param(std::string_view name, std::string_view unit, double fallback, double min, double max,
                     std::string_view help) {
  ParamSpec spec = named(name, unit, ParamKind::real, fallback, help);
  spec.min = min;
  spec.max = max;
  return spec;
}

ParamSpec positive_param(std::string_view name, std::string_view unit, double fallback,
                         std::string_view help) {
  ParamSpec spec = named(name, unit, ParamKind::real, fallback, help);
  spec.min = 0.0;
  spec.min_open = true;
  return spec;
}

ParamSpec integer_param(std::string_view name, long fallback, long min, long max, std::string_view help) {
  ParamSpec spec = named(name, "", ParamKind::integer, fallback, help);
  spec.min = static_cast<double>(min);
  spec.max = static_cast<double>(max);
  return spec;
}

ParamSpec choice_param(std::string_view name, std::string_view fallback,
                       std::vector<std::string_view> choices, std::string_view help) {
  ParamSpec spec = named(name, "", ParamKind::choice, 0.0, help);
  spec.fallback.emplace<std::string>(fallback);
  spec.choices = std::move(choices);
  return spec;
}

ParamSpec boolean_param(std::string_view name, bool fallback, std::string_view help) {
  return named(name, "", ParamKind::boolean, fallback, help);
}

ParamSpec vector_param(std::string_view name, std::string_view unit, std::vector<double> fallback,
                       std::string_view help) {
  const std::size_t length = fallback.size();
  ParamSpec spec = named(name, unit, ParamKind::vector, std::move(fallback), help);
  spec.length = length;
  return spec;
}

ParamSpec text_param(std::string_view name, std::string_view fallback, std::string_view help) {
  ParamSpec spec = named(name, "", ParamKind::text, 0.0, help);
  spec.fallback.emplace<std::string>(fallback);
  return spec;
}

ParamSpec only_with(std::string_view other, std::vector<std::string_view> values, ParamSpec spec) {
  spec.only.push_back({other, std::move(values)});
  return spec;
}

ParamSpec only_given(std::string_view other, ParamSpec spec) {
  return only_with(other, {}, std::move(spec));
}

ParamSpec required(ParamSpec spec) {
  spec.required = true;
  return spec;
}

ParamSpec names_param(std::string_view name, std::string_view help) {
  return required(named(name, "", ParamKind::names, std::vector<std::string>{}, help));
}

std::string range_text(const ParamSpec& spec) {
  const std::string interval = interval_text(spec);
  switch (spec.kind) {
    case ParamKind::boolean:
      return "true or false";
    case ParamKind::choice:
      return "one of " + join(spec.choices);
    case ParamKind::text:
      return "text";
    case ParamKind::vector: {
      std::string count = (spec.length > 0 ? std::to_string(spec.length) + " " : "") + "numbers";
      if (!spec.unit.empty()) count.append(" in ").append(spec.unit);
      return interval.empty() ? count : count + ", each " + interval;
    }
    case ParamKind::names:
      return (spec.length > 0 ? std::to_string(spec.length) + " " : "") + "names";
    case ParamKind::integer:
      return with_unit(interval.empty() ? "any whole number" : interval, spec.unit);
    case ParamKind::real:
      break;
  }
  return with_unit(interval.empty() ? "any number" : interval, spec.unit);
}

std::string wanted_text(const ParamSpec& spec) {
  const std::string range = range_text(spec);
  switch (spec.kind) {
    case ParamKind::integer:
    case ParamKind::real: {
      const std::string noun = spec.kind == ParamKind::integer ? "a whole number" : "a number";
      if (interval_text(spec).empty())
        return with_unit(spec.kind == ParamKind::integer ? "a whole number" : "a finite number", spec.unit);
      return noun + (range.front() == '[' || range.front() == '(' ? " in " : " ") + range;
    }
    case ParamKind::vector:
    case ParamKind::names:
      return "a list of " + range;
    default:
      return range;
  }
}

std::string range_error(const ParamSpec& spec, const ParamValue& value) {
  if (acceptable(spec, value)) return "";
  const bool number = std::holds_alternative<double>(value) || std::holds_alternative<long>(value);
  // A number out of its range needs no reminder that a number is wanted.
  if (spec.kind == ParamKind::real && number && !interval_text(spec).empty()) {
    const std::string range = range_text(spec);
    const auto* x = std::get_if<double>(&value);
    const std::string must = x && !std::isfinite(*x) ? "must be a finite number " : "must be ";
    return must + (range.front() == '[' || range.front() == '(' ? "in " : "") + range + "; got " +
           value_text(value);
  }
  return "must be " + wanted_text(spec) + "; got " + value_text(value);
}

ParamSet::ParamSet(const std::vector<ParamSpec>& specs) {
  for (const auto& spec : specs) values_[std::string(spec.name)] = spec.fallback;
}

void ParamSet::set(std::string_view name, ParamValue value) {
  values_[std::string(name)] = std::move(value);
}

bool ParamSet::has(std::string_view name) const {
  return values_.find(name) != values_.end();
}

const ParamValue& ParamSet::value(std::string_view name) const {
  const auto it = values_.find(name);
  if (it == values_.end()) throw std::logic_error("no parameter named " + std::string(name));
  return it->second;
}

namespace {

template <typename T>
const T& get(const ParamValue& value, std::string_view name) {
  if (const T* x = std::get_if<T>(&value)) return *x;
  throw std::logic_error("parameter " + std::string(name) + " is of another kind");
}

}  // namespace

double ParamSet::real(std::string_view name) const {
  const ParamValue& v = value(name);
  if (const long* i = std::get_if<long>(&v)) return static_cast<double>(*i);
  return get<double>(v, name);
}

long ParamSet::integer(std::string_view name) const {
  return get<long>(value(name), name);
}
bool ParamSet::boolean(std::string_view name) const {
  return get<bool>(value(name), name);
}
const std::string& ParamSet::text(std::string_view name) const {
  return get<std::string>(value(name), name);
}
const std::vector<double>& ParamSet::vector(std::string_view name) const {
  return get<std::vector<double>>(value(name), name);
}

bool is_met(const ParamCondition& condition, const ParamValue& other) {
  if (condition.values.empty()) {
    const auto* x = std::get_if<double>(&other);
    const auto* i = std::get_if<long>(&other);
    return x ? std::isfinite(*x) && *x != 0 : i && *i != 0;
  }
  const auto* on = std::get_if<bool>(&other);
  const std::string_view now = on ? (*on ? "true" : "false") : std::string_view(std::get<std::string>(other));
  return std::ranges::find(condition.values, now) != condition.values.end();
}

namespace {

// What is in the way of each of the conditions; nothing where one of them is met.
std::vector<std::string> reasons_against(const ParamSpec& spec, const std::vector<ParamSpec>& specs,
                                         const ParamSet& values) {
  std::vector<std::string> reasons;
  const auto add = [&](std::string reason) {
    if (std::ranges::find(reasons, reason) == reasons.end()) reasons.push_back(std::move(reason));
  };
  for (const ParamCondition& condition : spec.only) {
    if (!values.has(condition.other)) return {};
    const ParamValue& now = values.value(condition.other);
    const std::string other(condition.other);
    if (!is_met(condition, now)) {
      const auto* text = std::get_if<std::string>(&now);
      const auto* x = std::get_if<double>(&now);
      const bool missing = x && !std::isfinite(*x);
      add(missing ? "without " + other
                  : "with " + other + " = " + (text ? in_quotes(*text) : value_text(now)));
      continue;
    }
    const auto above = std::ranges::find(specs, condition.other, &ParamSpec::name);
    const auto further =
        above == specs.end() ? std::vector<std::string>() : reasons_against(*above, specs, values);
    if (further.empty()) return {};
    for (const std::string& reason : further) add(reason);
  }
  return reasons;
}

}  // namespace

bool means_something(const ParamSpec& spec, const std::vector<ParamSpec>& specs, const ParamSet& values) {
  return reasons_against(spec, specs, values).empty();
}

std::string idle_reason(const ParamSpec& spec, const std::vector<ParamSpec>& specs, const ParamSet& values) {
  std::string text;
  for (const std::string& reason : reasons_against(spec, specs, values))
    text += (text.empty() ? "" : " and ") + reason;
  return text;
}

}  // namespace unfurl
