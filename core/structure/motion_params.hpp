// SPDX-License-Identifier: BSD-3-Clause
// How a number that a scene prescribes moves: parameters, and the function of time that they mean.
#pragma once

#include <string_view>
#include <vector>

#include "core/structure/time_function.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// motion = hold, rate, smooth, sine or table with what each needs; `unit` is that of the value: "m", "deg" or
// "", where it depends on what moves. `before`: further choices, the first of them the default.
std::vector<ParamSpec> motion_params(std::string_view unit, std::vector<std::string_view> before = {});

// From `initial` on, in SI units; `unit` is the scene's in those. Any other motion than those above is none.
TimeFunction motion_function(const ParamSet& values, double initial, double unit);

}  // namespace unfurl
