// SPDX-License-Identifier: BSD-3-Clause
#include "app/python/studies.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <mutex>

#include "app/python/asker.hpp"
#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/scene/build.hpp"
#include "core/study/solve_for.hpp"
#include "core/study/sweep.hpp"
#include "core/study/tolerance.hpp"
#include "core/text/nearest_name.hpp"

namespace py = pybind11;

namespace unfurl {

py::dict sweep_scene(const SceneSource& source,
                     const std::vector<std::pair<std::string, std::vector<double>>>& vary,
                     const std::vector<std::string>& measures, int threads) {
  SweepPlan plan{source, {}, {}, {}};
  for (const auto& [key, values] : vary) {
    SweepAxis axis;
    axis.key = key;
    for (const double x : values) {
      axis.values.push_back(exact_number(x));
      axis.numbers.push_back(x);
    }
    plan.axes.push_back(std::move(axis));
  }
  const auto columns = columns_of(build_model(source.read()));
  for (const std::string& name : measures) plan.measures.push_back(find_measure(name, columns));
  Asker asker;
  std::mutex mutex;
  StudyHooks hooks;
  hooks.threads = threads;
  hooks.cancelled = [&] {
    const std::lock_guard lock(mutex);
    return asker();
  };
  Sweep sweep;
  {
    const py::gil_scoped_release release;
    check_plan(plan);
    Journal nowhere("", plan.columns(), plan.axes.size(), plan.number_columns());
    sweep = run_sweep(plan, nowhere, hooks);
  }
  asker.raise();
  py::dict table;
  for (std::size_t c = 0; c < sweep.table.columns.size(); ++c) {
    py::list words;
    std::vector<double> numbers;
    for (const auto& row : sweep.table.rows) {
      words.append(row[c]);
      numbers.push_back(number_of(row[c]));
    }
    const bool text = c == plan.axes.size();
    const py::str name(sweep.table.columns[c]);
    if (text)
      table[name] = words;
    else
      table[name] = py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
  }
  return table;
}

double solve_scene(const SceneSource& source, const std::string& key, const std::string& measure_name,
                   double target, double low, double high) {
  const Scene scene = source.read();
  const RunMeasure measure = find_measure(measure_name, columns_of(build_model(scene)));
  if (is_whole_number(scene, key))
    throw StudyError(in_quotes(key) + " takes whole numbers, which cannot be searched");
  SolveOptions options;
  options.low = low;
  options.high = high;
  if (low < high) {
    for (const double end : {low, high}) source.read({key + "=" + exact_number(end)});
  } else {
    const auto start = scene_number(scene, key);
    if (!start) source.read({key + "=1"});  // an unknown key has a better message
    if (!start || !std::isfinite(*start))
      throw StudyError(in_quotes(key) + " has no number to begin from: say between=(low, high)");
    options.start = *start;
  }
  Asker asker;
  SimulationHooks hooks;
  hooks.cancelled = [&asker] { return asker(); };
  StudyHooks asking;
  asking.cancelled = hooks.cancelled;
  const Objective objective = [&](double x) {
    try {
      const Scene changed = source.read({key + "=" + exact_number(x)});
      Simulation run =
          simulate_as_asked(build_model(changed), study_solver(changed, {key}, {measure}), hooks);
      const Diagnostics diagnostics = judge(run);
      return run.status == RunStatus::failed ? NAN : measure.value(run, diagnostics);
    } catch (const SceneError&) {
      return static_cast<double>(NAN);
    }
  };
  double found = 0;
  try {
    const py::gil_scoped_release release;
    found = solve_for(objective, target, options, asking).x;
  } catch (const Cancelled&) {
    asker.raise();
    throw;
  }
  return found;
}

}  // namespace unfurl
