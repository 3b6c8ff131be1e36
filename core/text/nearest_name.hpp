// SPDX-License-Identifier: BSD-3-Clause
// "Did you mean": the known name that a mistyped one most likely stands for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace unfurl {

// The nearest of `known` by edit distance (one insertion, deletion, replacement or swap of neighbours each
// count one, case is free), or one that begins with `given`. Empty when none is near enough to be worth
// naming.
std::string_view nearest_name(std::string_view given, const std::vector<std::string_view>& known);

// "; did you mean 'post_length'?", or without a near name "; known: a, b, c" (shortened after a dozen, and
// then with the command that lists all, if there is one).
std::string did_you_mean(std::string_view given, const std::vector<std::string_view>& known,
                         std::string_view all = "");

// The known name that `given` is with another unit behind it, as in "mass_g" or "x (mm)": a rename alone
// would change the value. Empty: there is none, or another name is nearer.
std::string_view name_before_unit(std::string_view given, const std::vector<std::string_view>& known);

// The name in quotes, fit for one line of an error message: control bytes as \xNN, long ones shortened.
std::string in_quotes(std::string_view name);

}  // namespace unfurl
