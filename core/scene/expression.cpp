// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/expression.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

constexpr int max_depth = 100;  // of brackets and signs: no input may exhaust the stack

struct MathFunction {
  std::string_view name;
  std::size_t arguments;
  double (*value)(const double* x);
  bool more = false;  // f(a, b, c) = f(f(a, b), c)
};

constexpr std::array functions{
    MathFunction{"sin", 1, [](const double* x) { return std::sin(x[0]); }},
    MathFunction{"cos", 1, [](const double* x) { return std::cos(x[0]); }},
    MathFunction{"tan", 1, [](const double* x) { return std::tan(x[0]); }},
    MathFunction{"asin", 1, [](const double* x) { return std::asin(x[0]); }},
    MathFunction{"acos", 1, [](const double* x) { return std::acos(x[0]); }},
    MathFunction{"atan", 1, [](const double* x) { return std::atan(x[0]); }},
    MathFunction{"atan2", 2, [](const double* x) { return std::atan2(x[0], x[1]); }},
    MathFunction{"sqrt", 1, [](const double* x) { return std::sqrt(x[0]); }},
    MathFunction{"exp", 1, [](const double* x) { return std::exp(x[0]); }},
    MathFunction{"log", 1, [](const double* x) { return std::log(x[0]); }},
    MathFunction{"abs", 1, [](const double* x) { return std::abs(x[0]); }},
    MathFunction{"floor", 1, [](const double* x) { return std::floor(x[0]); }},
    MathFunction{"ceil", 1, [](const double* x) { return std::ceil(x[0]); }},
    MathFunction{"round", 1, [](const double* x) { return std::round(x[0]); }},
    MathFunction{"min", 2, [](const double* x) { return std::fmin(x[0], x[1]); }, true},
    MathFunction{"max", 2, [](const double* x) { return std::fmax(x[0], x[1]); }, true},
    MathFunction{"hypot", 2, [](const double* x) { return std::hypot(x[0], x[1]); }},
};

struct Constant {
  std::string_view name;
  double value;
};
constexpr std::array constants{Constant{"pi", std::numbers::pi}, Constant{"deg", std::numbers::pi / 180}};

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

class Parser {
 public:
  Parser(std::string_view text, const Variables& variables) : text_(text), variables_(variables) {}

  double whole() {
    const double value = sum();
    if (!at_end()) fail("an operator is missing before this");
    return finite(value, 0);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw ExpressionError(message, at_ + 1); }

  // At once, where it comes up: min, max and a power would make a number of it again.
  static double finite(double value, std::size_t begin) {
    if (!std::isfinite(value)) throw ExpressionError("the value is not a finite number", begin + 1);
    return value;
  }

  // Where the next word begins.
  std::size_t here() {
    at_end();
    return at_;
  }
  bool at_end() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    return at_ >= text_.size();
  }
  bool take(char c) {
    if (at_end() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void require(char c) {
    if (!take(c)) fail(std::string("a '") + c + "' is missing here");
  }

  double sum() {
    if (++depth_ > max_depth) fail("nested too deep");
    const std::size_t begin = here();
    double value = product();
    while (true) {
      if (take('+'))
        value = finite(value + product(), begin);
      else if (take('-'))
        value = finite(value - product(), begin);
      else
        break;
    }
    --depth_;
    return value;
  }

  double product() {
    const std::size_t begin = here();
    double value = sign();
    while (true) {
      if (take('*'))
        value *= sign();
      else if (take('/'))
        value /= sign();
      else if (take('%'))
        value = modulo(value, sign());
      else
        return value;
      finite(value, begin);
    }
  }

  static double modulo(double a, double b) {
    const double r = std::fmod(a, b);
    return r != 0.0 && (r < 0.0) != (b < 0.0) ? r + b : r;
  }

  double sign() {
    double factor = 1.0;
    while (true) {
      if (take('-'))
        factor = -factor;
      else if (!take('+'))
        return factor * power();
    }
  }

  double power() {
    const std::size_t begin = here();
    const double base = operand();
    if (!take('^')) return base;
    if (++depth_ > max_depth) fail("nested too deep");
    const double value = std::pow(base, sign());
    --depth_;
    return finite(value, begin);
  }

  double operand() {
    if (at_end()) fail("a number or a name is missing here");
    const char c = text_[at_];
    if (take('(')) {
      const double value = sum();
      require(')');
      return value;
    }
    if (is_digit(c) || c == '.') return number();
    if (is_letter(c)) return named();
    fail("a number or a name is missing here");
  }

  double number() {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) fail("not a number");
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }

  double named() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string_view name = text_.substr(begin, at_ - begin);
    for (const auto& f : functions)
      if (f.name == name) return finite(call(f), begin);
    for (const auto& constant : constants)
      if (constant.name == name) return constant.value;
    if (const auto it = variables_.find(name); it != variables_.end()) return it->second;
    std::vector<std::string_view> known;
    for (const auto& [variable, value] : variables_) known.push_back(variable);
    for (const auto& f : functions) known.push_back(f.name);
    at_ = begin;
    throw ExpressionError("no variable " + in_quotes(name) + did_you_mean(name, known), at_ + 1,
                          std::string(name));
  }

  double call(const MathFunction& f) {
    std::array<double, 2> x{};
    require('(');
    for (std::size_t i = 0; i < f.arguments; ++i) {
      if (i > 0) require(',');
      x.at(i) = sum();
    }
    double value = f.value(x.data());
    while (f.more && take(',')) {
      x = {value, sum()};
      value = f.value(x.data());
    }
    require(')');
    return value;
  }

  std::string_view text_;
  const Variables& variables_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

double evaluate(std::string_view text, const Variables& variables) {
  return Parser(text, variables).whole();
}

bool is_variable_name(std::string_view name) {
  if (name.empty() || !is_letter(name.front())) return false;
  for (const char c : name)
    if (!is_letter(c) && !is_digit(c)) return false;
  for (const auto& f : functions)
    if (f.name == name) return false;
  for (const auto& constant : constants)
    if (constant.name == name) return false;
  return true;
}

}  // namespace unfurl
