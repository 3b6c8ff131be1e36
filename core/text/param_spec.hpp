// SPDX-License-Identifier: BSD-3-Clause
// Parameters are declared once (ParamSpec) and drive scene keys, help, error messages, sliders and docs.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace unfurl {

using ParamValue =
    std::variant<bool, long, double, std::string, std::vector<double>, std::vector<std::string>>;

enum class ParamKind { boolean, integer, real, choice, text, vector, names };

// That another parameter of the same table has one of these values ("true" of a switch); without values: that
// it says something, a number but 0 that is given and has an end.
struct ParamCondition {
  std::string_view other;
  std::vector<std::string_view> values;
};

struct ParamSpec {
  std::string_view name;
  std::string_view unit;  // "m", "deg", "N", ... ; empty: a pure number
  ParamKind kind;
  ParamValue fallback;  // the default; its alternative matches `kind`
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;                  // true: the value must be greater than min, not equal to it
  bool max_open = false;                  // true: the value must be smaller than max
  std::vector<std::string_view> choices;  // for ParamKind::choice
  std::size_t length = 0;                 // for ParamKind::vector: how many numbers; 0: any number of them
  std::string_view help;                  // one line
  bool required = false;                  // true: there is no default, a scene must give it
  std::vector<ParamCondition> only;       // it means something while one of these is met; empty: always
};

// Shorthand for the common shapes, so that a table of parameters reads like a table.
ParamSpec real_param(std::string_view name, std::string_view unit, double fallback, double min, double max,
                     std::string_view help);
ParamSpec positive_param(std::string_view name, std::string_view unit, double fallback,
                         std::string_view help);
ParamSpec integer_param(std::string_view name, long fallback, long min, long max, std::string_view help);
ParamSpec choice_param(std::string_view name, std::string_view fallback,
                       std::vector<std::string_view> choices, std::string_view help);
ParamSpec boolean_param(std::string_view name, bool fallback, std::string_view help);
ParamSpec vector_param(std::string_view name, std::string_view unit, std::vector<double> fallback,
                       std::string_view help);

ParamSpec text_param(std::string_view name, std::string_view fallback, std::string_view help);
// That parameter, but only while another has one of the values, or is given. Of a parameter of which that is
// said twice either is enough.
ParamSpec only_with(std::string_view other, std::vector<std::string_view> values, ParamSpec spec);
ParamSpec only_given(std::string_view other, ParamSpec spec);
ParamSpec required(ParamSpec spec);  // that parameter, without a default: a scene must give it
ParamSpec names_param(std::string_view name, std::string_view help);  // of nodes or rods; required

// The shortest text that reads back as the same number; a whole one below 1e7 without an exponent.
std::string shortest_number(double x);

// "[0.1, 8]", "> 0", "one of a, b": the allowed range in words, for help and error messages.
std::string range_text(const ParamSpec& spec);

// What a value must be, in words that follow "must be": "a number > 0 m", "a whole number in [2, 8]", "a list
// of 3 numbers".
std::string wanted_text(const ParamSpec& spec);

bool is_met(const ParamCondition& condition, const ParamValue& other);

// False where `spec` means nothing with the values that the other parameters of its table have, all of which
// are `specs`: one that means nothing itself lets nothing mean something.
class ParamSet;
bool means_something(const ParamSpec& spec, const std::vector<ParamSpec>& specs, const ParamSet& values);
// Why not: "with law = 'pulse'", "with stiffness = 0", "without current_limit"; "" where it does.
std::string idle_reason(const ParamSpec& spec, const std::vector<ParamSpec>& specs, const ParamSet& values);

// Empty when `value` is of the spec's kind and inside its range; else the reason ("must be > 0 m; got -3").
std::string range_error(const ParamSpec& spec, const ParamValue& value);

// Checked values by name. Asking for a name that was never set is a programming error and throws
// std::logic_error.
class ParamSet {
 public:
  ParamSet() = default;
  explicit ParamSet(const std::vector<ParamSpec>& specs);  // every parameter at its default

  void set(std::string_view name, ParamValue value);
  bool has(std::string_view name) const;
  const ParamValue& value(std::string_view name) const;
  double real(std::string_view name) const;  // also reads an integer
  long integer(std::string_view name) const;
  bool boolean(std::string_view name) const;
  const std::string& text(std::string_view name) const;
  const std::vector<double>& vector(std::string_view name) const;

 private:
  std::map<std::string, ParamValue, std::less<>> values_;
};

}  // namespace unfurl
