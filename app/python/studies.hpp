// SPDX-License-Identifier: BSD-3-Clause
// A scene run many times, for Python: called with the interpreter's lock, which the work leaves.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/study/scene_variation.hpp"

namespace unfurl {

// The values of a key: numbers, or as TOML what is no number.
using AxisValues = std::variant<std::vector<double>, std::vector<std::string>>;

// Columns by name: strings for the outcome and for values that are none, numbers else; NaN where a point has
// no answer. Finished points are kept in FOLDER/sweep.csv, where one is given, and are not computed again.
pybind11::dict sweep_scene(const SceneSource& source,
                           const std::vector<std::pair<std::string, AxisValues>>& vary,
                           const std::vector<std::string>& measures, int threads, const std::string& folder);

// The value of the key for which the measure is `target`: between two numbers, the lower one first, or else
// around the scene's own.
double solve_scene(const SceneSource& source, const std::string& key, const std::string& measure_name,
                   double target, const std::optional<std::pair<double, double>>& between);

// Errors and costs of all methods, or of those named, over a ladder of steps from the largest to the smallest
// [s], or else as `unfurl study` has it. The columns of study.csv, and in words the cheapest settings and the
// reference.
pybind11::tuple study_scene(const SceneSource& source, const std::optional<std::pair<double, double>>& steps,
                            const std::vector<std::string>& methods, int repeats);

}  // namespace unfurl
