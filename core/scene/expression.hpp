// SPDX-License-Identifier: BSD-3-Clause
// Arithmetic in scene files: "2*pi*i/n".
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "core/text/error.hpp"

namespace unfurl {

using Variables = std::map<std::string, double, std::less<>>;

// What is wrong with an expression, at which of its characters (from 1), and the name that is no variable.
struct ExpressionError : Error {
  ExpressionError(const std::string& message, std::size_t character, std::string name = "")
      : Error(message), place(character), unknown(std::move(name)) {}
  std::size_t place;
  std::string unknown;
};

// The value of
//     sum     = product { ("+" | "-") product }
//     product = sign { ("*" | "/" | "%") sign }
//     sign    = { "+" | "-" } power
//     power   = operand [ "^" sign ]            (so -2^2 = -4 and 2^3^2 = 512)
//     operand = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
// where a name is a variable, pi, or deg (a degree in radians), and a function one of sin cos tan asin acos
// atan atan2 sqrt exp log abs floor ceil round min max hypot; angles are in radians. a % b has the sign of b:
// (i-1) % n is the neighbour before i in a ring. Throws ExpressionError, also for a value that is not finite.
double evaluate(std::string_view text, const Variables& variables);

// Whether a variable may be called so: a letter, then letters, digits and underscores, and not the name of a
// constant or function.
bool is_variable_name(std::string_view name);

}  // namespace unfurl
