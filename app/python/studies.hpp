// SPDX-License-Identifier: BSD-3-Clause
// A scene run many times, for Python: called with the interpreter's lock, which the work leaves.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "core/study/scene_variation.hpp"

namespace unfurl {

// Columns by name: strings for the outcome, numbers else; NaN where a point has no answer. Finished points
// are kept in FOLDER/sweep.csv, where one is given, and are not computed again.
pybind11::dict sweep_scene(const SceneSource& source,
                           const std::vector<std::pair<std::string, std::vector<double>>>& vary,
                           const std::vector<std::string>& measures, int threads, const std::string& folder);

// The value of the key for which the measure is `target`. low < high: it is looked for between them.
double solve_scene(const SceneSource& source, const std::string& key, const std::string& measure_name,
                   double target, double low, double high);

// Errors and costs of all methods, or of those named, over a ladder of steps from `largest` to `smallest`
// [s]; 0: as `unfurl study` has it. The columns of study.csv, and in words the cheapest settings and the
// reference.
pybind11::tuple study_scene(const SceneSource& source, double largest, double smallest,
                            const std::vector<std::string>& methods, int repeats);

}  // namespace unfurl
