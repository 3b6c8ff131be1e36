// SPDX-License-Identifier: BSD-3-Clause
// A scene over a grid of parameters: measures of every run.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics/measures.hpp"
#include "core/scene/scene_error.hpp"
#include "core/study/journal.hpp"
#include "core/study/reference.hpp"
#include "core/study/scene_variation.hpp"

namespace unfurl {

struct SweepAxis {
  std::string key;                  // "structure.fold_angle"
  std::vector<std::string> values;  // as TOML
  std::vector<double> numbers;      // the same; empty where one is no number
  bool log = false;
  bool whole = false;  // it takes whole numbers, and
  std::string unit;    // has this unit; check_plan finds both

  std::string title() const;                   // "fold angle (°)", for figures
  std::string word(std::size_t value) const;   // "30°", "dvm"
  std::string title(std::size_t value) const;  // "fold angle = 30°", "solver method = dvm"
};

// "key=from:to:count", evenly spaced; "key=from:to:count:log", by equal factors; "key=a,b,c". Throws
// StudyError.
SweepAxis parse_axis(const std::string& text);

struct Shard {
  int index = 1, count = 1;  // 1 <= index <= count: every count-th of the points in a scattered order
};
Shard parse_shard(const std::string& text);  // "2/8"; throws StudyError

struct SweepPlan {
  SceneSource source;
  std::vector<SweepAxis> axes;
  std::vector<RunMeasure> measures;
  Shard shard;

  std::size_t points() const;                                 // of the whole grid
  std::vector<std::string> key(std::size_t point) const;      // its values; the last axis runs fastest
  std::vector<std::string> changes(std::size_t point) const;  // "key=value"
  std::vector<std::string> columns() const;                   // keys, outcome, measures
  std::vector<std::size_t> number_columns() const;            // those of the measures
  // A row that a run of this sweep can leave: an outcome that there is, measures that can be.
  bool is_finished(const std::vector<std::string>& row) const;
  // Is a row one of the whole grid's?
  std::function<bool(const std::vector<std::string>&)> asked() const;
  // What the scene says of a point's values, as said of the axes.
  SceneError of_axes(const SceneError& error) const;
};

// Comments of TOML: the contents, told by a checksum, of files that the values of an axis name and the scene
// as it stands does not. Points of others are of another sweep.
std::string files_of_points(const SweepPlan& plan);
// What the points of a directory belong to, which says `there`, once those of a sweep are beside them that
// says `now`: one may name files that the other does not, and where they `may_have_come`, `there` files that
// were missing. None where they are of different sweeps.
std::optional<std::string> identity_of_both(const std::string& there, const std::string& now,
                                            bool may_have_come = true);

// What is varied may be wrong as the scene has it: its source, then, has the values of a point that is right.
void stand_on_a_point(SweepPlan& plan);
// Throws StudyError (no axis, no measure, a key twice, too many points), SceneError where a value
// is refused by the scene. Gives the axes their units, and forces a column that says whether they are unique.
void check_plan(SweepPlan& plan);

// Points in the grid's order; those that are not there are missing. Outcome: the run's status, or "invalid"
// where the parameters, each fine, make no structure.
struct Sweep {
  Table table;
  std::vector<std::size_t> missing = {};    // of the grid, ascending
  std::vector<std::string> conflicts = {};  // points that merged journals do not agree on, in words
  // What the first of the points that were computed now says of nodes moved to fit given lengths of rods;
  // empty: none says anything.
  std::string moved = {};
  // What does nothing at all points that were computed now and have a run; what the first of those is warned
  // of, and how many are. Empty: none is.
  std::vector<std::string> warnings = {};
  // By the outcome ("failed", "invalid"): the first of the points that were computed now, and why it has no
  // answer.
  std::map<std::string, std::string> why = {};
};
// Points whose run failed or whose parameters made no structure.
std::size_t unanswered(const SweepPlan& plan, const Sweep& sweep);

// The shard's points, ascending: equally many for each, scattered over the grid, since points that lie
// together cost alike and would keep one shard at work when the others have finished. The same on every
// machine.
std::vector<std::size_t> points_of_shard(const SweepPlan& plan);

// What the journal lacks of the shard's points is computed on hooks.threads cores, each kept as it finishes.
Sweep run_sweep(const SweepPlan& plan, Journal& journal, const StudyHooks& hooks);
// All points that these journals hold.
Sweep merge_sweep(const SweepPlan& plan, const std::vector<std::filesystem::path>& journals);

}  // namespace unfurl
