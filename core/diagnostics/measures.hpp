// SPDX-License-Identifier: BSD-3-Clause
// One number of a run, by name: what sweeps tabulate and what a parameter is solved for.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// What a measure is taken from: a run's events alone, its states, or what its method makes of it.
enum class MeasureNeeds { events, states, method };

// A force or a stress: next to singular poses on the way, which a run must have been searched for, it may
// have no bound.
bool may_have_no_bound(std::string_view measure);

struct RunMeasure {
  std::string name;    // "deploy_time", or "max:kinetic_energy_J"
  std::string column;  // with the unit as suffix: "deploy_time_s"
  std::string label;   // for axes: "deployment time (s)"
  std::function<double(const Simulation&, const Diagnostics&)> value;
  MeasureNeeds needs = MeasureNeeds::states;
};

struct NamedMeasure {
  std::string_view name, label, unit, help;
  double (*value)(const Simulation&, const Diagnostics&);
  MeasureNeeds needs = MeasureNeeds::states;
};
// To add one: a function and a row.
std::span<const NamedMeasure> named_measures();
// Whether a run that has an answer, and is deployed or not, may have this value: not a negative time, nor
// none of what every run has.
bool may_be(const RunMeasure& measure, double value, bool deployed);

// The measure that says whether this one is unique (1) or one choice of many (0): "peak_rod_force_unique" of
// "peak_rod_force". Empty where there is none.
std::string uniqueness_of(std::string_view measure);

// All columns that a series.csv of this model has, its drives' and lengths' too.
std::vector<std::string> columns_of(const std::shared_ptr<const Model>& model);

// A row of the table, or max:, min:, final: with the name of one of `columns` (none given: of those that do
// not depend on the scene). Largest and smallest values are those of the motion, not only at the ends of
// steps. Throws StudyError with the nearest name.
RunMeasure find_measure(const std::string& name, const std::vector<std::string>& columns = {});
// Of a list with commas between them; columns, too, may have commas in their names. Throws as that.
std::vector<RunMeasure> find_measures(std::string_view list, const std::vector<std::string>& columns);

}  // namespace unfurl
