// One number of a run, by name: what sweeps tabulate and what a parameter is solved for.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

struct Measure {
  std::string name;    // "deploy_time", or "max:kinetic_energy_J"
  std::string column;  // with the unit as suffix: "deploy_time_s"
  std::string label;   // for axes: "deployment time (s)"
  std::function<double(const Simulation&, const Diagnostics&)> value;
};

struct NamedMeasure {
  std::string_view name, label, unit, help;
  double (*value)(const Simulation&, const Diagnostics&);
};
// To add one: a function and a row.
std::span<const NamedMeasure> named_measures();

// A row of the table, or max:, min:, final: with the name of a column of series.csv. Throws
// std::invalid_argument with the nearest name.
Measure find_measure(const std::string& name);

}  // namespace unfurl
