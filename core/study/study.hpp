// SPDX-License-Identifier: BSD-3-Clause
// Speed against accuracy: every method over a ladder of steps.
#pragma once

#include <string>
#include <vector>

#include "core/study/journal.hpp"
#include "core/study/measured_run.hpp"
#include "core/study/order_fit.hpp"

namespace unfurl {

// A method with its options, whatever the step.
struct Setting {
  std::string name;  // "dvm s=4"
  SolverOptions options;
  int claimed_order = 0;
};

// Every row of methods(), with 2 to 6 stages where the order depends on them, and as printed in the paper
// (equidistant nodes, constraints at step ends) where that makes a difference.
std::vector<Setting> study_settings(const SolverOptions& base);

// Numbers of steps over the whole motion, rising; each a multiple of `grid`, so that all runs meet at the
// same times.
struct StepLadder {
  long grid = 1;
  std::vector<long> steps;
};

// The largest step of a study [s], after which the times are spaced at which it compares: `given` (> 0), or
// eight times the scene's.
double largest_step(double scene_step, double given);
// From the largest step to the smallest [s], each halved; 0: eight times the scene's step, to a sixteenth of
// it. Throws StudyError where there is none.
StepLadder make_ladder(double end, double scene_step, double largest, double smallest);

struct StudyPlan {
  std::shared_ptr<const Model> model;
  std::vector<Setting> settings;
  StepLadder ladder;
  double end = 0;           // [s]
  std::string before = {};  // what it ends right before: "the deployed pose"; empty: nothing
  TimingOptions timing;
};

// The motion of a scene up to its end or, where it deploys, meets an end stop or changes in another way that
// is one-sided before, to 99.5 % of that time (judged_span): the deployed pose is singular, and no method's
// error there says anything about the method. Throws StudyError, and ReferenceError where something one-sided
// acts from the start.
StudyPlan plan_study(std::shared_ptr<const Model> model, const SolverOptions& scene, double largest_step,
                     double smallest_step, const StudyHooks& hooks);

// Is it a row of this study's points?
bool asks_for(const StudyPlan& plan, const std::vector<std::string>& row);
// Leaves only settings of these methods; none named: all stay. Throws StudyError with the nearest
// name of an unknown one.
void keep_methods(StudyPlan& plan, const std::vector<std::string>& methods);

struct StudyCurve {
  Setting setting;
  std::vector<MeasuredRun> runs;  // by falling step
  ObservedOrder order;
};

struct Study {
  std::vector<StudyCurve> curves;
  double end = 0;
  std::string before = {};
  double reference_uncertainty = 0;  // [m]
  bool reference_confirmed = false;  // by a second method
  std::string reference;             // how it was solved
  double size = 0;                   // of the structure [m]
  bool complete = true;              // false: cancelled
};

// Points that the journal holds are taken from there. Throws ReferenceError.
Study run_study(const StudyPlan& plan, Journal& journal, const StudyHooks& hooks);

std::vector<std::string> study_columns();
inline constexpr std::size_t study_key_columns = 2;        // setting, steps
std::vector<std::size_t> study_number_columns();           // whose cells are numbers
bool is_study_point(const std::vector<std::string>& row);  // such as run_study() leaves

// "two methods agree to 1e-12 m", "agrees with itself to ...": what is known of the reference.
std::string reference_words(const Study& study);

Table points_table(const Study& study);  // every run, exact numbers
Table orders_table(
    const Study& study);  // every setting: claimed and observed order, best error, for a person

// The cheapest run that is at least so accurate; nullptr: none.
struct Cheapest {
  const StudyCurve* curve = nullptr;
  const MeasuredRun* run = nullptr;
};
Cheapest cheapest(const Study& study, double error);
// "The cheapest setting for 1e-3 m is ..., for 1e-6 m ..., for 1e-9 m ...".
std::string cheapest_sentence(const Study& study);

}  // namespace unfurl
