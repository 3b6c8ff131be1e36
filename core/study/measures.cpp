#include "core/study/measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/diagnostics/force_uniqueness.hpp"
#include "core/model/nearest_name.hpp"
#include "core/study/measured_run.hpp"

namespace unfurl {
namespace {

double largest(const std::vector<double>& values) {
  double m = -std::numeric_limits<double>::infinity();
  for (const double x : values)
    if (!std::isnan(x)) m = std::max(m, x);
  return std::isfinite(m) ? m : nan;
}

double smallest(const std::vector<double>& values) {
  double m = std::numeric_limits<double>::infinity();
  for (const double x : values)
    if (!std::isnan(x)) m = std::min(m, x);
  return std::isfinite(m) ? m : nan;
}

double last(const std::vector<double>& values) {
  return values.empty() ? nan : values.back();
}

// Infinite where the run ends before: later than anything that was asked for.
double deploy_time(const Simulation& run, const Diagnostics&) {
  for (const Event& event : run.events)
    if (event.name == "deployed") return event.t;
  return run.status == RunStatus::failed || run.trajectory.structure().deployment.empty()
             ? nan
             : std::numeric_limits<double>::infinity();
}

double peak_force(const Simulation&, const Diagnostics& d) {
  return std::max(largest(d.at("axial_force_max_N").values), -smallest(d.at("axial_force_min_N").values));
}

template <Pull pull>
double peak_unique(const Simulation&, const Diagnostics& d) {
  return peak_rod_force(d, pull).unique ? 1.0 : 0.0;
}

double column(const Diagnostics& d, std::string_view name, double (*of)(const std::vector<double>&)) {
  const Series* series = d.find(name);
  return series ? of(series->values) : nan;
}

double largest_magnitude(const std::vector<double>& values) {
  return std::max(largest(values), -smallest(values));
}

double peak_speed(const Simulation& run, const Diagnostics&) {
  double fastest = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const VectorXd v = run.trajectory.node_velocities(i);
    for (Index k = 0; k + 2 < v.size(); k += 3) fastest = std::max(fastest, v.segment<3>(k).norm());
  }
  return fastest;
}

const std::array rows{
    NamedMeasure{"deploy_time", "deployment time", "s", "when the structure is fully deployed", deploy_time},
    NamedMeasure{"peak_rod_force", "peak rod force", "N",
                 "largest axial force of any rod, tension or compression; the mean over the rod's length",
                 peak_force},
    NamedMeasure{
        "peak_tension", "peak tension", "N", "largest tension of any rod",
        [](const Simulation&, const Diagnostics& d) { return column(d, "axial_force_max_N", largest); }},
    NamedMeasure{
        "peak_compression", "peak compression", "N", "largest compression of any rod",
        [](const Simulation&, const Diagnostics& d) { return -column(d, "axial_force_min_N", smallest); }},
    NamedMeasure{
        "peak_rod_force_unique", "peak rod force is unique", "",
        "1: the rigid model determines the peak rod force; 0: it is one choice of many (`unfurl check`)",
        peak_unique<Pull::either>},
    NamedMeasure{"peak_tension_unique", "peak tension is unique", "", "the same of the peak tension",
                 peak_unique<Pull::tension>},
    NamedMeasure{"peak_compression_unique", "peak compression is unique", "",
                 "the same of the peak compression", peak_unique<Pull::compression>},
    NamedMeasure{"energy", "kinetic energy at the end", "J", "kinetic energy at the end of the run",
                 [](const Simulation&, const Diagnostics& d) { return column(d, "kinetic_energy_J", last); }},
    NamedMeasure{
        "peak_energy", "peak kinetic energy", "J", "largest kinetic energy",
        [](const Simulation&, const Diagnostics& d) { return column(d, "kinetic_energy_J", largest); }},
    NamedMeasure{"peak_speed", "peak speed", "m/s", "largest speed of any node", peak_speed},
    NamedMeasure{"energy_error", "energy error", "J", "largest error of the energy balance",
                 [](const Simulation&, const Diagnostics& d) {
                   return column(d, "energy_balance_J", largest_magnitude);
                 }},
    NamedMeasure{
        "constraint_error", "constraint error", "m", "largest constraint error",
        [](const Simulation&, const Diagnostics& d) { return column(d, "constraint_max_m", largest); }},
    NamedMeasure{"end_time", "end of the run", "s", "when the run ended, by whatever reason",
                 [](const Simulation& run, const Diagnostics&) { return run.trajectory.end_time(); }},
    NamedMeasure{"cpu", "CPU time", "s", "CPU time of the stepping loop",
                 [](const Simulation& run, const Diagnostics&) { return run.cpu_s; }},
    NamedMeasure{
        "newton_iterations", "Newton iterations", "", "in sum",
        [](const Simulation& run, const Diagnostics&) { return static_cast<double>(run.newton_iterations); }},
};

struct Statistic {
  std::string_view name, label;
  double (*of)(const std::vector<double>&);
};
constexpr std::array statistics{Statistic{"max", "largest ", largest},
                                Statistic{"min", "smallest ", smallest}, Statistic{"final", "final ", last}};

std::string with_unit(std::string_view label, std::string_view unit) {
  return std::string(label) + (unit.empty() ? "" : " (" + std::string(unit) + ")");
}

std::string suffix(std::string_view unit) {
  std::string text;
  for (const char c : unit) text += c == '/' ? '_' : c;
  return text.empty() ? "" : "_" + text;
}

}  // namespace

std::span<const NamedMeasure> named_measures() {
  return rows;
}

std::string uniqueness_of(std::string_view measure) {
  const std::string name = std::string(measure) + "_unique";
  const bool known =
      std::any_of(rows.begin(), rows.end(), [&](const NamedMeasure& m) { return m.name == name; });
  return known ? name : "";
}

RunMeasure find_measure(const std::string& name) {
  std::vector<std::string_view> known;
  for (const NamedMeasure& row : rows) {
    if (row.name == name) return {name, name + suffix(row.unit), with_unit(row.label, row.unit), row.value};
    known.push_back(row.name);
  }
  const std::size_t colon = name.find(':');
  for (const Statistic& s : statistics) {
    if (colon == std::string::npos || name.substr(0, colon) != s.name) continue;
    const std::string of = name.substr(colon + 1);
    const auto columns = diagnostic_names();
    if (std::find(columns.begin(), columns.end(), of) == columns.end())
      throw std::invalid_argument("no column " + in_quotes(of) + " to measure" + did_you_mean(of, columns));
    return {name, std::string(s.name) + "_" + of, std::string(s.label) + of,
            [of, f = s.of](const Simulation&, const Diagnostics& d) { return column(d, of, f); }};
  }
  throw std::invalid_argument("no measure " + in_quotes(name) + did_you_mean(name, known) +
                              " (or max:, min:, final: and a column of series.csv)");
}

}  // namespace unfurl
