// SPDX-License-Identifier: BSD-3-Clause
// unfurl sweep SCENE --vary KEY=FROM:TO:COUNT --measure NAME,... -o DIR: measures over a grid of parameters.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string_view>
#include <utility>

#include "app/command.hpp"
#include "app/output/command_line.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/receipt.hpp"
#include "app/verbs/cluster.hpp"
#include "app/verbs/scene_run.hpp"
#include "app/verbs/study_session.hpp"
#include "app/verbs/team_work.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/write.hpp"
#include "core/study/sweep.hpp"
#include "render/plot/figures/sweep_figures.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

SweepPlan plan_of(const Arguments& arguments) {
  SweepPlan plan{scene_source(find_scene(arguments.names.front()), arguments.overrides), {}, {}, {}};
  for (const auto& text : arguments.study.vary) plan.axes.push_back(parse_axis(text));
  stand_on_a_point(plan);
  plan.measures = find_measures(arguments.study.measure, columns_of(build_model(plan.source.read())));
  if (!arguments.study.shard.empty()) plan.shard = parse_shard(shard_of(arguments.study.shard));
  check_plan(plan);
  return plan;
}

SolverOptions solver_of(const SweepPlan& plan, const Scene& scene) {
  std::vector<std::string> varied;
  for (const SweepAxis& axis : plan.axes) varied.push_back(axis.key);
  return study_solver(scene, varied, plan.measures);
}

// Which forces of the table the rigid model does not determine, for whoever reads only the last line.
std::string not_unique(const SweepPlan& plan, const Sweep& sweep) {
  std::string text;
  for (std::size_t m = 0; m < plan.measures.size(); ++m) {
    const std::string flag = uniqueness_of(plan.measures[m].name);
    for (std::size_t f = 0; f < plan.measures.size(); ++f) {
      if (flag.empty() || plan.measures[f].name != flag) continue;
      const auto open = std::count_if(sweep.table.rows.begin(), sweep.table.rows.end(),
                                      [&](const auto& row) { return row[plan.axes.size() + 1 + f] == "0"; });
      if (open > 0)
        text += "; " + plan.measures[m].name + " is not unique in " + std::to_string(open) + " of them";
    }
  }
  return text;
}

// Do they need a modulus that no rod of the scene has?
bool wants_modulus(const std::string& measure, const SweepPlan& plan) {
  constexpr std::string_view of_moduli[] = {"peak_stress", "stress_margin", "buckling_margin", "frequency"};
  if (std::find(std::begin(of_moduli), std::end(of_moduli), measure) == std::end(of_moduli)) return false;
  const auto model = build_model(plan.source.read());
  return std::none_of(model->structure.rods.begin(), model->structure.rods.end(),
                      [](const Rod& rod) { return std::isfinite(rod.youngs_modulus); });
}

// Which measures are no number in points that were run: the scene has no such thing.
std::string not_there(const SweepPlan& plan, const Sweep& sweep) {
  const std::size_t outcome = plan.axes.size();
  std::string text;
  for (std::size_t m = 0; m < plan.measures.size(); ++m) {
    const auto lacking = std::ranges::count_if(sweep.table.rows, [&](const auto& row) {
      return row[outcome] != "failed" && row[outcome] != "invalid" && row[outcome + 1 + m] == "nan";
    });
    if (lacking == 0) continue;
    text += "; " + plan.measures[m].name + " has no value in " + std::to_string(lacking) + " of them";
    if (plan.measures[m].name == "deploy_time") text += " (nothing deploys: [deployment] says what does)";
    if (wants_modulus(plan.measures[m].name, plan)) text += " (no rod has a structure.youngs_modulus)";
  }
  return text;
}

// On stderr, of either kind of point without an answer, why the first has none. One that an earlier run or
// another worker computed is named with the command that tells.
void warn_of_unanswered(const SweepPlan& plan, const Sweep& sweep, const std::string& model,
                        const Arguments& arguments) {
  const std::size_t outcome = plan.axes.size();
  for (const std::string kind : {"failed", "invalid"}) {
    const auto first =
        std::ranges::find_if(sweep.table.rows, [&](const auto& row) { return row[outcome] == kind; });
    if (first == sweep.table.rows.end()) continue;
    std::cerr << "unfurl: warning: " << kind << ": ";
    if (const auto known = sweep.why.find(kind); known != sweep.why.end()) {
      std::cerr << known->second << "\n";
      continue;
    }
    std::vector<std::string> words{"run", arguments.names.front(), "--json"};
    const auto set = [&](const std::string& change) { words.insert(words.end(), {"--set", change}); };
    for (const std::string& change : arguments.overrides) set(change);
    for (std::size_t a = 0; a < outcome; ++a) set(plan.axes[a].key + "=" + (*first)[a]);
    if (std::ranges::none_of(plan.axes, [](const auto& axis) { return axis.key == "solver.model"; }))
      set("solver.model=" + model);
    std::cerr << as_typed(words) << " tells why\n";
  }
}

// A whole sweep without a single answer is no success to a script.
int code_of_answers(const SweepPlan& plan, const Sweep& sweep) {
  if (sweep.table.rows.empty() || unanswered(plan, sweep) < sweep.table.rows.size()) return exit_ok;
  const bool failed = std::ranges::any_of(sweep.table.rows,
                                          [&](const auto& row) { return row[plan.axes.size()] == "failed"; });
  return failed ? exit_solver_failed : exit_scene_invalid;
}

// Keys that do nothing in any point, of those that are looked at.
void warn_of_idle_axes(const SweepPlan& plan, const Arguments& arguments) {
  constexpr std::size_t looked_at = 200, refused = 5;
  const std::size_t points = plan.points(), stride = points / looked_at + 1;
  for (std::size_t k = 0; k < plan.axes.size(); ++k) {
    const std::string& key = plan.axes[k].key;
    if (std::ranges::any_of(arguments.overrides, [&](const auto& set) { return set.starts_with(key + "="); }))
      std::cerr << "unfurl: warning: --set " << key << " does nothing: --vary changes the key\n";
    std::string why;
    std::size_t wrong = 0;
    for (std::size_t point = 0; point < points && wrong < refused; point += stride) {
      try {
        why = idle_key_text(plan.source.read(plan.changes(point)), key);
      } catch (const SceneError&) {
        ++wrong;
        continue;
      }
      if (why.empty()) break;
    }
    if (!why.empty()) std::cerr << "unfurl: warning: --vary " << why << "\n";
  }
}

constexpr const char* figure_wants =
    "it takes one or two --vary; words of up to 30 values, and beside what is no number up to 12";

std::string journal_name(const Shard& shard) {
  if (shard.count == 1) return "sweep.csv";
  return "sweep_" + std::to_string(shard.index) + "_of_" + std::to_string(shard.count) + ".csv";
}

bool by_variables(const SweepPlan& plan) {
  return std::any_of(plan.axes.begin(), plan.axes.end(),
                     [](const SweepAxis& axis) { return axis.key.starts_with("variables."); });
}

// The scene, and what was asked of it as comments: what the points in a directory belong to.
std::string identity(const Scene& scene, const SweepPlan& plan) {
  std::string text = "A sweep over";
  for (const auto& axis : plan.axes) text += " " + axis.key;
  return study_identity(text, scene) + "\n" + idle_text(scene) +
         (by_variables(plan) ? unexpanded_text(plan.source) : "") + files_of_points(plan);
}

// A scene that is written out has no variables any more: over those a sweep is made again from the text that
// was read, where that stands alone.
void receipt_of_sweep(const Scene& scene, const SweepPlan& plan) {
  const SceneSource& source = plan.source;
  if (by_variables(plan) && scene.files.empty())
    receipt_scene(scene.name, source.text ? *source.text : bytes_of(source.path), SceneOptions::in_command);
  else
    receipt_scene(scene.name, scene_text(scene, IdleValues::written));
}

// What a whole sweep is of: a title that names what is varied would speak of one point.
std::string title_of(const Scene& scene, const SweepPlan& plan) {
  const bool structure = std::any_of(plan.axes.begin(), plan.axes.end(), [](const SweepAxis& axis) {
    return axis.key.starts_with("structure.");
  });
  return structure ? scene.name : scene.title;
}

// The points of these directories, which must be of the same sweep.
std::vector<fs::path> journals_in(const std::vector<std::string>& directories, const std::string& identity) {
  std::vector<fs::path> found;
  for (const auto& directory : directories) {
    require_identity(directory, identity, "merge what one command computed, with its --set and --vary");
    const auto here = journals_like("sweep.csv", directory);
    if (here.empty()) throw FileError(directory, "holds no points of a sweep (sweep*.csv)");
    require_as_written(directory, here, out_of_the_way);
    found.insert(found.end(), here.begin(), here.end());
  }
  return found;
}

// Is it, or does it hold, one of them?
bool is_merged(const std::vector<std::string>& directories, const std::string& output) {
  std::error_code error;
  const fs::path into = fs::weakly_canonical(output, error);
  return std::ranges::any_of(directories, [&](const std::string& directory) {
    const fs::path whole = fs::weakly_canonical(directory, error);
    return std::mismatch(into.begin(), into.end(), whole.begin(), whole.end()).first == into.end();
  });
}

// Of how many shares these directories hold journals: the largest number in their names, 1 where none says.
int shares_in(const std::vector<std::string>& directories) {
  int count = 1;
  for (const auto& directory : directories)
    for (const auto& path : journals_like("sweep.csv", directory)) {
      const std::string name = path.stem().string();
      const std::size_t at = name.find("_of_");
      if (at != std::string::npos) count = std::max(count, std::atoi(name.c_str() + at + 4));
    }
  return count;
}

// The commands that compute what a merged sweep lacks.
std::string cure(const SweepPlan& plan, const Sweep& sweep, const Arguments& arguments) {
  const int count = shares_in(arguments.study.merge);
  SweepPlan part = plan;
  std::vector<int> lacking;
  for (int i = 1; i <= count; ++i) {
    part.shard = {i, count};
    const auto points = points_of_shard(part);
    if (std::any_of(sweep.missing.begin(), sweep.missing.end(),
                    [&](std::size_t m) { return std::binary_search(points.begin(), points.end(), m); }))
      lacking.push_back(i);
  }
  return "; these compute the others:" + missing_shards(arguments, lacking, count);
}

// None: a person interrupted the wait for others.
std::optional<Worked<Sweep>> compute(const SweepPlan& plan, StudySession& session, const StudyHooks& hooks,
                                     const Arguments& arguments, const std::string& identity, Team* team) {
  const auto finished = [&](const auto& row) { return plan.is_finished(row); };
  try {
    Journal earlier({}, plan.columns(), plan.axes.size(), plan.number_columns(), finished);
    session.require_asked(earlier, plan.asked());
    if (!arguments.study.merge.empty())
      return Worked<Sweep>{merge_sweep(plan, journals_in(arguments.study.merge, identity))};
    Journal journal(team ? team->journal() : session.journal(), plan.columns(), plan.axes.size(),
                    plan.number_columns(), finished, session.room_for_first());
    return alone_or_joined(
        team, arguments, journal, hooks,
        [&](Journal& all, const StudyHooks& own) { return run_sweep(plan, all, own); },
        [](const Sweep& sweep) { return sweep.missing.empty(); });
  } catch (const JournalMismatch& error) {
    const char* const cure =
        arguments.force ? ", or move it away; other " : ", or --force to begin anew; other ";
    throw FileError(session.directory(), std::string(error.what()) + cure + "--vary or --measure than now?");
  }
}

}  // namespace

int cmd_sweep(const Arguments& arguments) {
  if (arguments.join && (!arguments.study.shard.empty() || !arguments.study.merge.empty()))
    throw UsageError("--join shares the points by itself; leave out --shard and --merge");
  if (arguments.force && is_merged(arguments.study.merge, arguments.output))
    throw UsageError(
        "--force would remove the points that --merge puts together; leave it out, or use another -o");
  if (!arguments.study.script.empty() && !arguments.study.merge.empty())
    throw UsageError("--script prints a job that computes and then merges by itself; leave out --merge");
  if (!arguments.study.script.empty() && arguments.json)
    throw UsageError("--script prints a job, not a result; leave out --json");
  const SweepPlan plan = plan_of(arguments);
  if (!arguments.study.script.empty()) {
    std::cout << job_script(arguments);
    return exit_ok;
  }
  Scene scene = plan.source.read();
  scene.solver = solver_of(plan, scene);
  receipt_of_sweep(scene, plan);
  warn_of_idle_axes(plan, arguments);
  const InterruptGuard guard;
  const std::string name = identity(scene, plan);
  StudySession session(arguments, "sweeping", name, journal_name(plan.shard));
  const auto team = join_team(arguments, session);
  const auto computed = compute(plan, session, session.hooks(), arguments, name, team.get());
  if (!computed) return nothing_to_write(arguments);
  const Sweep& sweep = computed->result;
  if (!computed->writes) {
    print_rows(arguments, true, sweep.table);
    return code_of_answers(plan, sweep);
  }
  for (const std::string& conflict : sweep.conflicts) std::cerr << "unfurl: warning: " << conflict << "\n";
  if (!sweep.moved.empty()) std::cerr << "unfurl: warning: " << sweep.moved << "\n";
  for (const std::string& warning : sweep.warnings) {
    const bool told = std::ranges::any_of(plan.axes, [&](const SweepAxis& axis) {  // by warn_of_idle_axes()
      return warning.find("--set " + axis.key + ": does nothing") != std::string::npos;
    });
    if (!told) std::cerr << "unfurl: warning: " << warning << "\n";
  }
  warn_of_unanswered(plan, sweep, scene.solver.model, arguments);
  session.write(journal_name(plan.shard), csv_text(sweep.table));
  print_rows(arguments, sweep.missing.empty(), sweep.table);
  const std::size_t bad = unanswered(plan, sweep);
  const std::string count = std::to_string(sweep.table.rows.size()) + " points in " +
                            (session.directory() / journal_name(plan.shard)).string() +
                            (bad > 0 ? ", " + std::to_string(bad) + " of them without an answer" : "") +
                            not_unique(plan, sweep) + not_there(plan, sweep);
  if (plan.shard.count > 1) return finish(sweep.missing.empty(), arguments, count);
  std::vector<std::string> pictures;
  for (const Figure& figure : sweep_figures(plan, sweep, title_of(scene, plan)))
    pictures.push_back(session.write(figure));
  Report report{"Sweep: " + title_of(scene, plan)};
  report.paragraph(count + ".");
  if (pictures.empty() && !sweep.table.rows.empty()) {
    report.paragraph("No figure: " + std::string(figure_wants) + ".");
    if (!arguments.quiet) std::cerr << "no figure: " << figure_wants << "\n";
  }
  for (const auto& picture : pictures) report.picture(picture, picture);
  if (sweep.table.rows.size() <= 1000) {
    Table plain =
        sweep.table;  // names of the scene's entries and words among the values are not the report's
    for (std::string& column : plain.columns) column = as_plain(column);
    for (auto& row : plain.rows)
      for (std::string& cell : row) cell = as_plain(cell);
    report.add(std::move(plain));
  }
  session.write("sweep.md", report_markdown(report));
  if (!sweep.missing.empty() && !arguments.study.merge.empty())
    throw FileError(session.directory(),
                    std::to_string(sweep.missing.size()) + " of " + std::to_string(plan.points()) +
                        " points are missing; what there is was merged" + cure(plan, sweep, arguments));
  results_written(team.get());
  const int code = finish(sweep.missing.empty(), arguments, count);
  return code == exit_ok ? code_of_answers(plan, sweep) : code;
}

}  // namespace unfurl
