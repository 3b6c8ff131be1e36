// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/sweep.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <numeric>

#include "core/diagnostics/accuracy.hpp"
#include "core/path/path.hpp"
#include "core/scene/build.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/study/measured_run.hpp"
#include "core/study/parallel_for.hpp"
#include "core/study/path_sweep.hpp"
#include "core/study/team.hpp"
#include "core/study/tolerance.hpp"
#include "core/system/fit_lengths.hpp"

namespace unfurl {
namespace {

// What the measures are taken from; a run along the path whose events alone are asked for is at round-off,
// and there is nothing to judge it by.
Diagnostics asked_of(const SweepPlan& plan, Simulation& run) {
  const bool states = std::any_of(plan.measures.begin(), plan.measures.end(),
                                  [](const RunMeasure& m) { return m.needs != MeasureNeeds::events; });
  if (std::ranges::any_of(plan.measures, [](const RunMeasure& m) { return may_have_no_bound(m.name); }))
    record_singular_poses(run);
  return states || run.solved_as.name != "path" ? judge(run) : Diagnostics{};
}

struct Said {
  std::string moved = {};  // as in Sweep, of one point
  std::string why = {};    // it has no answer
  std::vector<std::string> warnings = {};
  std::optional<std::vector<std::string>> idle = {};  // what does nothing; none: it has no run
};

// One point; nothing where it was cancelled.
std::optional<std::vector<std::string>> run_point(const SweepPlan& plan, const PathSweep& along_path,
                                                  std::size_t point, const StudyHooks& hooks, Said& said) {
  const std::vector<std::string> key = plan.key(point);
  std::vector<std::string> changes, row = key, varied;
  if (along_path.measure(point, row)) return row;
  for (std::size_t a = 0; a < key.size(); ++a) {
    changes.push_back(plan.axes[a].key + "=" + key[a]);
    varied.push_back(plan.axes[a].key);
  }
  try {
    const Scene scene = plan.source.read(changes);
    SimulationHooks own;
    own.cancelled = hooks.cancelled;
    const auto model = build_model(scene);
    said.moved = note_of_moved_nodes(model->structure);
    Simulation run = simulate_as_asked(model, study_solver(scene, varied, plan.measures), own);
    if (run.status == RunStatus::stopped) return std::nullopt;
    const Diagnostics diagnostics = asked_of(plan, run);
    row.emplace_back(to_string(run.status));
    if (run.status == RunStatus::failed)
      said.why = run.message;
    else
      said.warnings = warnings_of(run, diagnostics);
    // What does nothing in one point may do something in others.
    said.idle.emplace();
    std::erase_if(said.warnings, [&](const std::string& text) {
      const bool idle = text.find("does nothing") != std::string::npos;
      if (idle) said.idle->push_back(text);
      return idle || text == said.moved;
    });
    for (const RunMeasure& measure : plan.measures)
      row.push_back(exact_number(run.status == RunStatus::failed ? nan : measure.value(run, diagnostics)));
  } catch (const SceneError& error) {
    row.emplace_back("invalid");
    said.why = problem_text(plan.of_axes(error).problems().front());
  } catch (const PathRefused& error) {  // solver.model = "path": one point without an answer
    row.emplace_back("failed");
    said.why = error.what();
  }
  row.resize(key.size() + 1 + plan.measures.size(), "nan");
  return row;
}

Sweep collect(const SweepPlan& plan, const std::vector<std::size_t>& points,
              const std::function<const std::vector<std::string>*(std::size_t)>& row) {
  Sweep sweep{{plan.columns(), {}}};
  for (const std::size_t i : points) {
    if (const auto* found = row(i))
      sweep.table.rows.push_back(*found);
    else
      sweep.missing.push_back(i);
  }
  return sweep;
}

// What was measured of one point twice; times differ every time.
bool same_answer(const SweepPlan& plan, const std::vector<std::string>& a,
                 const std::vector<std::string>& b) {
  const std::size_t begin = plan.axes.size() + 1;
  if (a[begin - 1] != b[begin - 1]) return false;
  // A path that was traced from another point has other last digits.
  constexpr double rounding = 1e-9;
  for (std::size_t m = 0; m < plan.measures.size(); ++m) {
    const std::string &p = a[begin + m], &q = b[begin + m];
    const double x = number_of(p), y = number_of(q);
    if (plan.measures[m].name != "cpu" && p != q &&
        !(std::abs(x - y) <= rounding * std::max(std::abs(x), std::abs(y))))
      return false;
  }
  return true;
}

// Where a point made no structure as a file was missing that it names: does it make one now?
class MissingFiles {
 public:
  explicit MissingFiles(const SweepPlan& plan) : plan_(plan), named_(!files_of_points(plan).empty()) {}
  bool have_come(std::size_t point, const std::vector<std::string>& row) const {
    if (!named_ || row[plan_.axes.size()] != "invalid") return false;
    try {
      build_model(plan_.source.read(plan_.changes(point)));
      return true;
    } catch (const SceneError&) {
      return false;
    }
  }

 private:
  const SweepPlan& plan_;
  bool named_;
};

constexpr std::size_t most_pieces = 1024;  // of a sweep, for the workers of a team

std::string point_text(const SweepPlan& plan, std::size_t point) {
  std::string text;
  const auto key = plan.key(point);
  for (std::size_t a = 0; a < key.size(); ++a) text += (a ? ", " : "") + plan.axes[a].key + "=" + key[a];
  return text;
}

// A number that tells nothing of the point's place in the grid (splitmix64: Steele, Lea, Flood 2014).
std::uint64_t scattered(std::uint64_t point) {
  std::uint64_t x = (point + 1) * 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

std::vector<std::size_t> points_of_shard(const SweepPlan& plan) {
  std::vector<std::size_t> order(plan.points());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (plan.shard.count == 1) return order;
  std::sort(order.begin(), order.end(),
            [](std::size_t a, std::size_t b) { return scattered(a) < scattered(b); });
  std::vector<std::size_t> own;
  const auto count = static_cast<std::size_t>(plan.shard.count);
  for (std::size_t i = static_cast<std::size_t>(plan.shard.index - 1); i < order.size(); i += count)
    own.push_back(order[i]);
  std::sort(own.begin(), own.end());
  return own;
}

Sweep run_sweep(const SweepPlan& plan, Journal& journal, const StudyHooks& hooks) {
  const std::vector<std::size_t> own = points_of_shard(plan);
  std::vector<std::size_t> open;
  const MissingFiles missing(plan);
  for (const std::size_t i : own)
    if (const auto* row = journal.find(plan.key(i)); !row || (!hooks.team && missing.have_come(i, *row)))
      open.push_back(i);
  // What a worker of a team takes at once: points that do not lie together, since those cost alike.
  const std::size_t pieces = std::min<std::size_t>(plan.points(), most_pieces);
  if (hooks.team)
    std::sort(open.begin(), open.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(scattered(a) % pieces, a) < std::pair(scattered(b) % pieces, b);
    });
  const PathSweep along_path(plan);
  std::size_t done = 0, looked_at = 0;                // of these, what does nothing is known
  using Words = std::pair<std::size_t, std::string>;  // of the first of some points
  std::map<std::string, Words> moved, why;            // by the outcome
  std::map<std::size_t, std::vector<std::string>> warned;
  std::optional<std::vector<std::string>> idle;  // in every point so far
  const auto keep = [](std::map<std::string, Words>& of, const std::string& outcome, Words words) {
    if (const auto [at, first] = of.try_emplace(outcome, words); !first && words < at->second)
      at->second = words;
  };
  std::mutex mutex;
  const auto look_again = [&] {
    const std::lock_guard lock(mutex);
    journal.take_in(hooks.team->journals_of_others());
  };
  const auto known = [&](std::size_t point) {
    const std::lock_guard lock(mutex);
    return journal.find(plan.key(point)) != nullptr;
  };
  parallel_for(open.size(), hooks.threads, [&](std::size_t i) {
    const std::string piece = "points-" + std::to_string(scattered(open[i]) % pieces);
    if (hooks.stopped()) return;
    if (hooks.team && (!hooks.team->takes(piece, look_again) || known(open[i]))) return;
    Said of_point;
    auto row = run_point(plan, along_path, open[i], hooks, of_point);
    if (!row) return;
    const std::lock_guard lock(mutex);
    const std::string& outcome = (*row)[plan.axes.size()];
    if (!of_point.moved.empty()) keep(moved, "", {open[i], of_point.moved});
    if (!of_point.why.empty()) keep(why, outcome, {open[i], of_point.why});
    if (!of_point.warnings.empty()) warned.emplace(open[i], std::move(of_point.warnings));
    if (of_point.idle) ++looked_at;
    if (of_point.idle && idle)
      std::erase_if(*idle, [&](const std::string& text) {
        return std::ranges::find(*of_point.idle, text) == of_point.idle->end();
      });
    else if (of_point.idle)
      idle = std::move(of_point.idle);
    if (!hooks.team || hooks.team->holds(piece)) journal.append(std::move(*row));
    hooks.tell(static_cast<double>(++done) / static_cast<double>(open.size()));
  });
  Sweep sweep = collect(plan, own, [&](std::size_t i) { return journal.find(plan.key(i)); });
  const auto text = [&](const Words& words) { return point_text(plan, words.first) + ": " + words.second; };
  for (const auto& [outcome, words] : moved) sweep.moved = text(words);
  for (const auto& [outcome, words] : why) sweep.why[outcome] = text(words);
  const std::string computed =
      std::string(done < plan.points() ? " computed now" : "") + (looked_at < done ? " with a run" : "");
  const std::string where = looked_at == plan.points() ? "every point"
                            : looked_at == 1           ? "the one point" + computed
                                             : "all " + std::to_string(looked_at) + " points" + computed;
  for (const std::string& words : idle.value_or(std::vector<std::string>()))
    sweep.warnings.push_back("at " + where + ": " + words);
  if (!warned.empty())
    for (const std::string& words : warned.begin()->second)
      sweep.warnings.push_back(text({warned.begin()->first, words}));
  if (warned.size() > 1)
    sweep.warnings.push_back(
        std::to_string(warned.size()) + " of " + std::to_string(done) +
        " points are warned of, of which that is the first; a run of a point tells its own");
  return sweep;
}

std::size_t unanswered(const SweepPlan& plan, const Sweep& sweep) {
  return static_cast<std::size_t>(std::ranges::count_if(sweep.table.rows, [&](const auto& row) {
    const std::string& outcome = row[plan.axes.size()];
    return outcome == "failed" || outcome == "invalid";
  }));
}

Sweep merge_sweep(const SweepPlan& plan, const std::vector<std::filesystem::path>& journals) {
  std::vector<std::unique_ptr<Journal>> open;
  for (const auto& path : journals) {  // which others may still write
    open.push_back(std::make_unique<Journal>(std::filesystem::path(), plan.columns(), plan.axes.size(),
                                             plan.number_columns(),
                                             [&](const auto& row) { return plan.is_finished(row); }));
    open.back()->take_in(path);
  }
  SweepPlan whole = plan;
  whole.shard = {};
  std::vector<std::string> conflicts;
  const MissingFiles missing(plan);
  Sweep sweep = collect(plan, points_of_shard(whole), [&](std::size_t i) {
    const std::vector<std::string>* first = nullptr;
    std::size_t from = 0;
    for (std::size_t k = 0; k < open.size(); ++k) {
      const auto* row = open[k]->find(plan.key(i));
      if (!row || missing.have_come(i, *row)) continue;
      if (!first) {
        first = row;
        from = k;
      } else if (!same_answer(plan, *first, *row)) {
        conflicts.push_back(point_text(plan, i) + ": " + journals[from].string() + " and " +
                            journals[k].string() + " disagree; the first was taken");
      }
    }
    return first;
  });
  for (const auto& journal : open)
    for (const std::string& text : journal->damage()) conflicts.push_back(text + " and was left out");
  sweep.conflicts = std::move(conflicts);
  return sweep;
}

}  // namespace unfurl
