// SPDX-License-Identifier: BSD-3-Clause
// A scene run many times, for Python: called with the interpreter's lock, which the work leaves.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "core/study/scene_variation.hpp"

namespace unfurl {

// Columns by name: strings for the outcome, numbers else; NaN where a point has no answer.
pybind11::dict sweep_scene(const SceneSource& source,
                           const std::vector<std::pair<std::string, std::vector<double>>>& vary,
                           const std::vector<std::string>& measures, int threads);

// The value of the key for which the measure is `target`. low < high: it is looked for between them.
double solve_scene(const SceneSource& source, const std::string& key, const std::string& measure_name,
                   double target, double low, double high);

}  // namespace unfurl
