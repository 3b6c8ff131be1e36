// SPDX-License-Identifier: BSD-3-Clause
#include "app/python/studies.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include "app/python/asker.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/build.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write.hpp"
#include "core/study/scene_objective.hpp"
#include "core/study/scene_variation.hpp"
#include "core/study/solve_for.hpp"
#include "core/study/study.hpp"
#include "core/study/sweep.hpp"
#include "core/text/nearest_name.hpp"
#include "core/text/version.hpp"

namespace py = pybind11;

namespace unfurl {

namespace {

namespace fs = std::filesystem;

// Cells of the columns `words` as strings, of all others as numbers.
py::dict columns_of_table(const Table& table, const std::set<std::size_t>& words) {
  py::dict out;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const py::str name(table.columns[c]);
    py::list texts;
    std::vector<double> numbers;
    for (const auto& row : table.rows) {
      texts.append(row[c]);
      numbers.push_back(number_of(row[c]));
    }
    if (words.contains(c))
      out[name] = texts;
    else
      out[name] = py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
  }
  return out;
}

// What a scene says and a study does not do, as the program tells it.
std::vector<std::string> idle_in_studies(const SolverOptions& solver) {
  const std::string ladder = " does nothing here: steps are equal, as the ladder has them";
  std::vector<std::string> said;
  if (solver.adaptive) said.push_back("solver.adaptive" + ladder);
  if (solver.tolerance > 0) said.push_back("solver.tolerance" + ladder);
  if (solver.model == "path" || solver.model == "sector")
    said.emplace_back("solver.model does nothing here: every method steps the whole model");
  return said;
}

// The scene under a line that says what was asked and by which version: what the points in a folder belong
// to.
std::string identity_of(const SweepPlan& plan) {
  std::string text = "# A sweep over";
  std::vector<std::string> varied;
  for (const SweepAxis& axis : plan.axes) {
    text += " " + axis.key;
    varied.push_back(axis.key);
  }
  Scene scene = plan.source.read();
  scene.solver = study_solver(scene, varied, plan.measures);
  return text + ", by unfurl " + version() + " in Python\n" + scene_text(scene) + "\n" +
         unexpanded_text(plan.source) + files_of_points(plan);
}

// Empty: nothing is kept. Throws FileError where the folder holds anything else.
fs::path journal_in(const fs::path& folder, const SweepPlan& plan) {
  if (folder.empty()) return {};
  const std::string identity = identity_of(plan);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(folder, error.value());
  const fs::path journal = folder / "sweep.csv";
  const TextFile known = read_text_file((folder / "scene.toml").string());
  const std::optional<std::string> both =
      known.error.empty() ? identity_of_both(known.text, identity) : identity;
  if (!both || (!known.error.empty() && fs::exists(journal, error)))
    throw FileError(folder,
                    "holds results of another scene, other settings or another version of unfurl; "
                    "remove them, or use another folder");
  if (*both != known.text) write_file_atomically(folder / "scene.toml", *both);
  return journal;
}

Sweep swept(const SweepPlan& plan, const fs::path& folder, const StudyHooks& hooks) {
  const fs::path path = journal_in(folder, plan);
  Sweep sweep;
  try {
    Journal journal(path, plan.columns(), plan.axes.size(), plan.number_columns(),
                    [&](const auto& row) { return plan.is_finished(row); });
    journal.require_asked(plan.asked(), folder, "ask for them, too, or use another folder");
    sweep = run_sweep(plan, journal, hooks);
    for (std::string& text : journal.damage())
      sweep.conflicts.push_back(std::move(text) + " and is computed anew");
  } catch (const JournalMismatch& error) {
    throw FileError(folder, std::string(error.what()) + "; other keys or measures than now?");
  }
  if (!path.empty() && sweep.missing.empty()) write_file_atomically(path, csv_text(sweep.table));
  return sweep;
}

}  // namespace

namespace {

// For all runs of one study: a file that is edited while it runs is another scene.
SceneSource as_now(const SceneSource& given) {
  if (!given.text) return scene_source(given.path, given.overrides);
  SceneSource source = given;
  source.files = std::make_shared<FilesBeside>();
  return source;
}

}  // namespace

py::dict sweep_scene(const SceneSource& given, const std::vector<std::pair<std::string, AxisValues>>& vary,
                     const std::vector<std::string>& measures, int threads, const std::string& folder) {
  if (threads < 1 || threads > 1024)  // as the program's --threads
    throw StudyError("threads: must be a whole number from 1 to 1024; got " + std::to_string(threads));
  SweepPlan plan{as_now(given), {}, {}, {}};
  for (const auto& [key, values] : vary) {
    SweepAxis axis;
    axis.key = key;
    if (const auto* texts = std::get_if<std::vector<std::string>>(&values)) {
      axis.values = *texts;
    } else {
      axis.numbers = std::get<std::vector<double>>(values);
      for (const double x : axis.numbers) axis.values.push_back(exact_number(x));
    }
    plan.axes.push_back(std::move(axis));
  }
  stand_on_a_point(plan);
  const auto columns = columns_of(build_model(plan.source.read()));
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
    sweep = swept(plan, folder, hooks);
  }
  asker.raise();
  if (!sweep.moved.empty()) sweep.conflicts.push_back(sweep.moved);
  for (const auto& texts : {sweep.conflicts, sweep.warnings}) warn(texts);
  for (const auto& [outcome, text] : sweep.why) warn({outcome + ": " + text});
  std::set<std::size_t> words{plan.axes.size()};
  for (std::size_t a = 0; a < plan.axes.size(); ++a)
    if (plan.axes[a].numbers.empty()) words.insert(a);
  return columns_of_table(sweep.table, words);
}

double solve_scene(const SceneSource& given, const std::string& key, const std::string& measure_name,
                   double target, const std::optional<std::pair<double, double>>& between) {
  SceneSource source = as_now(given);
  if (between) source = valid_source(source, {{key + "=" + exact_number(between->first)}});
  const Scene scene = source.read();
  const RunMeasure measure = find_measure(measure_name, columns_of(build_model(scene)));
  if (is_whole_number(scene, key))
    throw StudyError(in_quotes(key) + " takes whole numbers, which cannot be searched");
  if (!std::isfinite(target)) throw StudyError("a target is a finite number; got " + exact_number(target));
  SolveOptions options;
  if (between) {
    options.low = between->first;
    options.high = between->second;
    if (!(options.low < options.high))
      throw StudyError("between is (low, high) with low < high; got (" + exact_number(options.low) + ", " +
                       exact_number(options.high) + ")");
    for (const double end : {options.low, options.high}) source.read({key + "=" + exact_number(end)});
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
  SceneObjective objective(source, key, measure, hooks);
  options.why_none = [&](double x) { return objective.why_none(x); };
  double found = 0;
  try {
    const py::gil_scoped_release release;
    found = solve_for([&](double x) { return objective.at(x); }, target, options, asking).x;
  } catch (const Cancelled&) {
    asker.raise();
    throw;
  }
  warn(objective.warnings(found));
  if (objective.unique(found) == false)
    warn({measure.name +
          " is not unique there: the model does not determine it, or the steps do not follow it"});
  return found;
}

py::tuple study_scene(const SceneSource& source, const std::optional<std::pair<double, double>>& steps,
                      const std::vector<std::string>& methods, int repeats) {
  const auto [largest, smallest] = steps.value_or(std::pair(0.0, 0.0));
  if (steps && !(largest > 0 && smallest > 0))
    throw StudyError("steps are (largest, smallest), two numbers of seconds");
  if (repeats < 1) throw StudyError("repeats: at least 1 run is timed");
  const Scene scene = source.read();
  Asker asker;
  StudyHooks hooks;
  hooks.cancelled = [&asker] { return asker(); };
  Study study;
  try {
    const py::gil_scoped_release release;
    StudyPlan plan = plan_study(build_model(scene), scene.solver, largest, smallest, hooks);
    keep_methods(plan, methods);
    plan.timing.repeats = repeats;
    Journal nowhere("", study_columns(), study_key_columns, study_number_columns());
    study = run_study(plan, nowhere, hooks);
  } catch (const Cancelled&) {
    asker.raise();
    throw;
  }
  asker.raise();
  const Table table = points_table(study);
  const auto numbers = study_number_columns();
  std::set<std::size_t> words;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (std::find(numbers.begin(), numbers.end(), c) == numbers.end()) words.insert(c);
  words.erase(table.column("steps"));
  return py::make_tuple(columns_of_table(table, words), cheapest_sentence(study),
                        study.reference + "; " + reference_words(study), idle_in_studies(scene.solver));
}

}  // namespace unfurl
