// SPDX-License-Identifier: BSD-3-Clause
// unfurl solve SCENE --find KEY --target NAME=VALUE: the parameter for which a measure takes a value.
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/command.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/output_directory.hpp"
#include "app/verbs/scene_run.hpp"
#include "app/verbs/study_session.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/write.hpp"
#include "core/study/scene_objective.hpp"
#include "core/study/scene_variation.hpp"
#include "core/study/solve_for.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

struct Target {
  RunMeasure measure;
  double value = 0;
};

Target target_of(const std::string& text, const Scene& scene) {
  const std::size_t equals = text.rfind('=');
  const double value =
      equals == std::string::npos ? NAN : number_of(std::string_view(text).substr(equals + 1));
  if (!std::isfinite(value)) throw UsageError("--target is NAME=VALUE with a number; got " + in_quotes(text));
  return {find_measure(text.substr(0, equals), columns_of(build_model(scene))), value};
}

SolveOptions options_of(const Arguments& arguments, const SceneSource& source, const Scene& scene) {
  const StudyArguments& study = arguments.study;
  if (is_whole_number(scene, study.find))
    throw UsageError(in_quotes(study.find) +
                     " takes whole numbers, which cannot be searched; unfurl sweep --vary " + study.find +
                     "=A,B,C shows the measure over some of them");
  if (const std::string other = other_than_number(scene, study.find); !other.empty()) try {
      source.read({study.find + "=1"});
    } catch (const SceneError&) {
      throw UsageError(in_quotes(study.find) + " takes no number: it is " + other +
                       " in this scene, and only numbers can be searched");
    }
  SolveOptions options;
  if (!study.between.empty()) {
    const std::size_t colon = study.between.find(':');
    if (colon != std::string::npos) {
      options.low = number_of(std::string_view(study.between).substr(0, colon));
      options.high = number_of(std::string_view(study.between).substr(colon + 1));
    }
    if (!(options.low < options.high))
      throw UsageError("--between is LOW:HIGH with LOW < HIGH; got " + in_quotes(study.between));
    return options;
  }
  const auto start = scene_number(scene, study.find);
  if (!start) source.read({study.find + "=1"});  // an unknown key has a better message
  if (!start)
    throw UsageError(in_quotes(study.find) +
                     " is no number of this scene; --between LOW:HIGH says where to look");
  if (!std::isfinite(*start))
    throw UsageError(in_quotes(study.find) +
                     " is not finite in this scene; --between LOW:HIGH says where to look");
  options.start = *start;
  return options;
}

// solved_force: of a force, whether it is unique at the solution. note: how far its run got.
std::string result_json(const StudyArguments& study, const Target& target, const Solved& solved,
                        const std::optional<bool>& solved_force, const std::string& note) {
  nlohmann::ordered_json json = {{"key", study.find},
                                 {"value", solved.x},
                                 {"measure", target.measure.name},
                                 {"target", target.value},
                                 {"reached", solved.value},
                                 {"bracket", {solved.low, solved.high}},
                                 {"runs", solved.evaluations.size()}};
  if (solved_force) json["unique"] = *solved_force;
  json["notes"] = nlohmann::ordered_json::array();
  if (!note.empty()) json["notes"].push_back(note);
  return json.dump(2) + "\n";
}

void write_results(const std::filesystem::path& directory, const std::string& key, const SceneSource& source,
                   const Target& target, const Solved& solved) {
  Table table{{key, target.measure.column}, {}};
  for (const Evaluation& e : solved.evaluations)
    table.rows.push_back({exact_number(e.x), exact_number(e.value)});
  Scene found = source.read({key + "=" + exact_number(solved.x)});
  found.solver = study_solver(found, {key}, {target.measure});
  write_file_atomically(directory / "scene.toml", scene_text(found));
  write_file_atomically(directory / "solve.csv", csv_text(table));
}

}  // namespace

int cmd_solve(const Arguments& arguments) {
  const StudyArguments& study = arguments.study;
  if (study.find.empty()) throw UsageError("--find KEY is missing");
  if (study.target.empty()) throw UsageError("--target NAME=VALUE is missing");
  SceneSource source = scene_source(find_scene(arguments.names.front()), arguments.overrides);
  if (!study.between.empty())
    source = valid_source(source, {{study.find + "=" + study.between.substr(0, study.between.find(':'))}});
  const Scene scene = source.read();
  const Target target = target_of(study.target, scene);
  SolveOptions options = options_of(arguments, source, scene);
  const bool between = options.low < options.high;
  const Scene first = source.read({study.find + "=" + exact_number(between ? options.low : options.start)});
  if (const std::string why = idle_key_text(first, study.find); !why.empty())
    std::cerr << "unfurl: warning: --find " << why << "\n";
  if (between) source.read({study.find + "=" + exact_number(options.high)});

  OwnDirectory output(arguments.output, arguments.force, "solve");
  output.require_scene("", arguments.force);  // what is found is not known yet: hours of work would end there

  const InterruptGuard guard;
  SimulationHooks hooks;
  hooks.cancelled = interrupted;
  SceneObjective objective(source, study.find, target.measure, hooks);
  options.why_none = [&](double x) { return objective.why_none(x); };
  StudyHooks asking;
  asking.cancelled = interrupted;
  try {
    const Solved solved = solve_for([&](double x) { return objective.at(x); }, target.value, options, asking);
    for (const std::string& text : objective.warnings(solved.x))
      std::cerr << "unfurl: warning: " << text << "\n";
    if (!output.path().empty()) write_results(output.path(), study.find, source, target, solved);
    const std::optional<bool> solved_force = objective.unique(solved.x);
    const std::string note = objective.note(solved.x);
    if (!note.empty()) std::cerr << "unfurl: warning: its motion ends early: " << note << "\n";
    if (arguments.json)
      std::cout << result_json(study, target, solved, solved_force, note);
    else
      std::cout << study.find << " = " << exact_number(solved.x) << "\n";
    return finish(
        true, arguments,
        target.measure.name + " is " + short_number(solved.value, 12) + " there, after " +
            std::to_string(solved.evaluations.size()) + " runs" +
            (solved_force == false
                 ? "; it is not unique: the model does not determine it, or the steps do not follow it"
                 : ""));
  } catch (const Cancelled&) {
    std::cerr << "unfurl: interrupted before the parameter was found\n";
    return exit_interrupted;
  } catch (const NotFound& error) {
    std::cerr << "unfurl: " << error.what() << "\n";
    return exit_solver_failed;
  }
}

}  // namespace unfurl
