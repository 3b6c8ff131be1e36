// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/diagnostics/columns.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/diagnostics/vibration.hpp"
#include "core/math/largest.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/structure/node_positions.hpp"
#include "core/text/error.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

double last(const std::vector<double>& values) {
  return values.empty() ? no_value : values.back();
}

// Infinite where the run ends before: later than anything that was asked for.
double deploy_time(const Simulation& run, const Diagnostics&) {
  for (const Event& event : run.events)
    if (event.name == "deployed") return event.t;
  return run.status == RunStatus::failed || run.trajectory.structure().deployment.empty()
             ? no_value
             : std::numeric_limits<double>::infinity();
}

double last_of(const Simulation&, const Diagnostics& d, std::string_view column) {
  const Series* series = d.find(column);
  return series ? last(series->values) : no_value;
}

// Nothing is pulled where the largest tension is negative, nothing pressed where the largest compression is.
double at_least_none(double force) {
  return force <= 0 ? 0.0 : force;
}

double peak_force(const Simulation& run, const Diagnostics& d) {
  return larger(largest_of_column(run, d, "axial_force_max_N"),
                -smallest_of_column(run, d, "axial_force_min_N"));
}

template <Pull pull>
double peak_unique(const Simulation& run, const Diagnostics& d) {
  if (!d.whole() || run.trajectory.structure().rods.empty()) return no_value;
  return peak_rod_force(run, d, pull).unique ? 1.0 : 0.0;
}

double peak_stress(const Simulation& run, const Diagnostics& d) {
  return larger(largest_of_column(run, d, "axial_stress_max_Pa"),
                -smallest_of_column(run, d, "axial_stress_min_Pa"));
}

template <double (*quantity)(const Rod&, double)>
double worst_unique(const Simulation& run, const Diagnostics& d) {
  if (!d.whole()) return no_value;
  const WorstRod worst = worst_rod(run, d, quantity);
  return worst.rod < 0 ? no_value : worst.unique ? 1.0 : 0.0;
}

double last_frequency(const Simulation& run, const Diagnostics&) {
  const std::size_t last = run.trajectory.size() - 1;
  const Model& model = run.trajectory.model(last);
  const bool small = model.system.solved_coordinates() <= max_vibration_coordinates;
  return small && any_elastic(model.structure) ? vibration(model, run.trajectory.state(last)).lowest_elastic()
                                               : no_value;
}

double largest_magnitude_of(const Diagnostics& d, std::string_view column) {
  const Series* series = d.find(column);
  return series ? largest_magnitude(series->values) : no_value;
}

// Of every state.
std::vector<double> speeds(const Simulation& run) {
  std::vector<double> fastest;
  const Index in_space = space_coordinates(run.trajectory.structure());
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const VectorXd v = run.trajectory.node_velocities(i);
    fastest.push_back(0);
    for (Index k = 0; k + 2 < in_space; k += 3)
      fastest.back() = larger(fastest.back(), v.segment<3>(k).norm());
  }
  return fastest;
}

double peak_speed(const Simulation& run, const Diagnostics& d) {
  if (d.left_open > 0) return no_value;
  return beyond(d, "peak_speed", true, top_of_motion(run, speeds(run), speeds)).value;
}

const std::array measure_table{
    NamedMeasure{"deploy_time", "deployment time", "s", "when the structure is fully deployed", deploy_time,
                 MeasureNeeds::events},
    NamedMeasure{"peak_rod_force", "peak rod force", "N",
                 "largest axial force of any rod, tension or compression; the mean over the rod's length",
                 peak_force},
    NamedMeasure{"peak_tension", "peak tension", "N", "largest tension of any rod; 0: none is pulled",
                 [](const Simulation& run, const Diagnostics& d) {
                   return at_least_none(largest_of_column(run, d, "axial_force_max_N"));
                 }},
    NamedMeasure{"peak_compression", "peak compression", "N",
                 "largest compression of any rod; 0: none is pressed",
                 [](const Simulation& run, const Diagnostics& d) {
                   return at_least_none(-smallest_of_column(run, d, "axial_force_min_N"));
                 }},
    NamedMeasure{"peak_rod_force_unique", "peak rod force is unique", "",
                 "1: the model determines the peak rod force; 0: it is one choice of many (`unfurl check`)",
                 peak_unique<Pull::either>},
    NamedMeasure{"peak_tension_unique", "peak tension is unique", "", "the same of the peak tension",
                 peak_unique<Pull::tension>},
    NamedMeasure{"peak_compression_unique", "peak compression is unique", "",
                 "the same of the peak compression", peak_unique<Pull::compression>},
    NamedMeasure{"peak_stress", "peak axial stress", "Pa",
                 "largest axial stress of any rod with a modulus, tension or compression", peak_stress},
    NamedMeasure{"stress_margin", "margin of stress", "",
                 "strength over the largest axial stress, less 1; of the rod where that is least",
                 [](const Simulation& run, const Diagnostics& d) {
                   return margin_of(largest_of_column(run, d, "stress_ratio_max"));
                 }},
    NamedMeasure{"buckling_margin", "margin of buckling", "",
                 "Euler's load over the largest compression, less 1; of the rod where that is least",
                 [](const Simulation& run, const Diagnostics& d) {
                   return margin_of(largest_of_column(run, d, "buckling_ratio_max"));
                 }},
    NamedMeasure{"peak_stress_unique", "peak axial stress is unique", "", "as of the peak rod force",
                 worst_unique<axial_stress>},
    NamedMeasure{"stress_margin_unique", "margin of stress is unique", "", "the same of the margin of stress",
                 worst_unique<stress_ratio>},
    NamedMeasure{"buckling_margin_unique", "margin of buckling is unique", "",
                 "the same of the margin of buckling", worst_unique<buckling_ratio>},
    NamedMeasure{"frequency", "lowest natural frequency", "Hz",
                 "of the elastic rods in the last pose of the run, held at rest (`unfurl modes`)",
                 last_frequency},
    NamedMeasure{
        "energy", "kinetic energy at the end", "J", "kinetic energy at the end of the run",
        [](const Simulation& run, const Diagnostics& d) { return last_of(run, d, "kinetic_energy_J"); }},
    NamedMeasure{"peak_energy", "peak kinetic energy", "J", "largest kinetic energy",
                 [](const Simulation& run, const Diagnostics& d) {
                   return largest_of_column(run, d, "kinetic_energy_J");
                 }},
    NamedMeasure{
        "deployed_fraction", "deployed fraction", "", "share of the deployment at the end of the run",
        [](const Simulation& run, const Diagnostics& d) { return last_of(run, d, "deployed_fraction"); }},
    NamedMeasure{"peak_speed", "peak speed", "m/s", "largest speed of any node", peak_speed},
    NamedMeasure{
        "energy_error", "energy error", "J", "largest error of the energy balance",
        [](const Simulation&, const Diagnostics& d) { return largest_magnitude_of(d, "energy_balance_J"); },
        MeasureNeeds::method},
    NamedMeasure{
        "constraint_error", "constraint error", "m", "largest constraint error",
        [](const Simulation&, const Diagnostics& d) { return largest_magnitude_of(d, "constraint_max_m"); },
        MeasureNeeds::method},
    NamedMeasure{"end_time", "end of the run", "s", "when the run ended, by whatever reason",
                 [](const Simulation& run, const Diagnostics&) { return run.trajectory.end_time(); },
                 MeasureNeeds::events},
    NamedMeasure{"cpu", "CPU time", "s", "CPU time of the stepping loop",
                 [](const Simulation& run, const Diagnostics&) { return run.cpu_s; }, MeasureNeeds::method},
    NamedMeasure{
        "newton_iterations", "Newton iterations", "", "in sum",
        [](const Simulation& run, const Diagnostics&) { return static_cast<double>(run.newton_iterations); },
        MeasureNeeds::method},
};

struct Statistic {
  std::string_view name, label;
  double (*of)(const Simulation&, const Diagnostics&, std::string_view column);
};
constexpr std::array statistics{Statistic{"max", "largest ", largest_of_column},
                                Statistic{"min", "smallest ", smallest_of_column},
                                Statistic{"final", "final ", last_of}};

// Columns that tell of the method rather than of the motion.
bool of_method(std::string_view column) {
  return column.starts_with("constraint_") || column == "energy_balance_J" || column == "step_s" ||
         column == "newton_iterations";
}

// What every run has: a finite number, and none below 0.
bool every_run_has(std::string_view measure) {
  constexpr std::array names{"peak_rod_force", "peak_tension", "peak_compression", "energy",
                             "peak_energy",    "peak_speed",   "energy_error",     "constraint_error",
                             "end_time",       "cpu",          "newton_iterations"};
  return std::find(names.begin(), names.end(), measure) != names.end();
}

// Columns that are finite in every state of every run.
bool every_state_has(std::string_view column) {
  constexpr std::array names{"kinetic_energy_J", "potential_energy_J", "work_J"};
  return of_method(column) || column.starts_with("axial_force_") ||
         std::find(names.begin(), names.end(), column) != names.end();
}

// The column that says whether this one is unique, state by state; empty where none does.
std::string flag_column(std::string_view column) {
  if (column == "axial_force_max_N" || column == "axial_force_min_N")
    return std::string(column.substr(0, column.size() - 2)) + "_unique";
  for (const std::string_view end :
       {".torque_N_m", ".force_N", ".reaction_N", ".reaction_x_N", ".reaction_y_N", ".reaction_z_N"})
    if (column.ends_with(end)) {
      const std::size_t dot = column.size() - end.size();
      return std::string(column.substr(0, column.find('_', dot))) + "_unique";
    }
  return {};
}

bool of_stress(std::string_view column) {
  return column == "axial_stress_max_Pa" || column == "axial_stress_min_Pa";
}

// The same of every state; of a stress whether the force of the rod is that has it.
std::vector<double> flags_of(const Structure& structure, const Diagnostics& d, std::string_view column) {
  if (!of_stress(column)) {
    const Series* flags = d.find(flag_column(column));
    return flags ? flags->values : std::vector<double>();
  }
  const double sign = column == "axial_stress_max_Pa" ? 1.0 : -1.0;
  std::vector<double> flags(d.t.size(), 1.0);
  for (Index i = 0; i < d.axial_force.rows(); ++i) {
    double most = -std::numeric_limits<double>::infinity();
    for (Index r = 0; r < d.axial_force.cols(); ++r) {
      const double stress = axial_stress(structure.rods[static_cast<std::size_t>(r)], d.axial_force(i, r));
      if (!d.shows(r) || !(sign * stress > most)) continue;
      most = sign * stress;
      flags[static_cast<std::size_t>(i)] = d.force_unique(i, r) ? 1.0 : 0.0;
    }
  }
  return flags;
}

// Of an extreme of a column over the motion: it has a bound, and is unique at the states around it.
double extreme_unique(const Simulation& run, const Diagnostics& d, std::string_view column, bool largest) {
  const std::vector<double> flags = flags_of(run.trajectory.structure(), d, column);
  if (!d.whole() || flags.empty() || !d.find(column)) return no_value;
  const PeakInMotion top = extreme_of_column(run, d, column, largest);
  if (std::isnan(top.value)) return no_value;
  auto first = std::lower_bound(d.t.begin(), d.t.end(), top.t), last = first;
  if (first != d.t.begin() && (first == d.t.end() || *first > top.t)) --first;
  while (last != d.t.end() && (last == first || *last <= top.t)) ++last;
  if (last != d.t.end() && *first < top.t) ++last;
  const auto flag = [&](auto at) { return flags.begin() + (at - d.t.begin()); };
  return top.bounded && std::all_of(flag(first), flag(last), [](double x) { return x != 0.0; }) ? 1.0 : 0.0;
}

std::string with_unit(std::string_view label, std::string_view unit) {
  return std::string(label) + (unit.empty() ? "" : " (" + std::string(unit) + ")");
}

// In N, N m or Pa, or a share of what a rod bears: of those that peaks.hpp looks for beside singular poses.
bool force_column(std::string_view column) {
  return column.ends_with("_N") || column.ends_with("_N_m") || column.ends_with("_Pa") ||
         column.ends_with("_ratio_max");
}

// What columns that every structure may have are called; works have names shorter than what is in them.
std::string_view known_label(std::string_view column) {
  static const std::vector<DiagnosticColumn> known = diagnostic_columns();
  const auto of = std::ranges::find(known, column, &DiagnosticColumn::name);
  return of == known.end() || column.ends_with("work_J") ? std::string_view() : of->label;
}

// "dissipated_J": "energy taken by dampers and friction (J)"; what stands before a dot is somebody's name.
std::string column_label(std::string_view column) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 12> units{{{"_N_m", "N m"},
                                                                                 {"_rad_s", "rad/s"},
                                                                                 {"_deg_s", "deg/s"},
                                                                                 {"_m_s", "m/s"},
                                                                                 {"_rad", "rad"},
                                                                                 {"_deg", "deg"},
                                                                                 {"_Pa", "Pa"},
                                                                                 {"_N", "N"},
                                                                                 {"_J", "J"},
                                                                                 {"_W", "W"},
                                                                                 {"_m", "m"},
                                                                                 {"_s", "s"}}};
  const auto* found = std::find_if(units.begin(), units.end(),
                                   [&](const auto& unit) { return column.ends_with(unit.first); });
  const bool has = found != units.end();
  std::string label(column.substr(0, column.size() - (has ? found->first.size() : 0)));
  const std::size_t dot = label.rfind('.');
  std::replace(label.begin() + static_cast<std::ptrdiff_t>(dot == std::string::npos ? 0 : dot), label.end(),
               '_', ' ');
  if (const std::string_view words = known_label(column); !words.empty()) label = words;
  return with_unit(label, has ? found->second : "");
}

// "largest energy lost in impacts (J)"; the largest of what is the largest is said once.
std::string label_of(const Statistic& s, std::string_view column) {
  const std::string label = column_label(column);
  return label.starts_with(s.label) ? label : std::string(s.label) + label;
}

std::string suffix(std::string_view unit) {
  std::string text;
  for (const char c : unit) text += c == '/' ? '_' : c;
  return text.empty() ? "" : "_" + text;
}

}  // namespace

std::span<const NamedMeasure> named_measures() {
  return measure_table;
}

bool may_be(const RunMeasure& measure, double value, bool deployed) {
  if (measure.name == "deploy_time") return !(value < 0) && (!deployed || std::isfinite(value));
  const std::size_t colon = measure.name.find(':');
  if (measure.name.ends_with("_unique")) return std::isnan(value) || value == 0 || value == 1;
  if (colon != std::string::npos)
    return std::isfinite(value) || !every_state_has(std::string_view(measure.name).substr(colon + 1));
  return !every_run_has(measure.name) || (std::isfinite(value) && value >= 0);
}

std::string uniqueness_of(std::string_view measure) {
  const std::string name = std::string(measure) + "_unique";
  if (const std::size_t colon = measure.find(':'); colon != std::string_view::npos) {
    const std::string_view of = measure.substr(colon + 1);
    if (measure.starts_with("max:") && of == "stress_ratio_max") return "stress_margin_unique";
    if (measure.starts_with("max:") && of == "buckling_ratio_max") return "buckling_margin_unique";
    if (of_stress(of) && !measure.starts_with("final:")) return name;
    const std::string flag = flag_column(of);
    return flag.empty() ? "" : measure.starts_with("final:") ? "final:" + flag : name;
  }
  const bool known = std::any_of(measure_table.begin(), measure_table.end(),
                                 [&](const NamedMeasure& m) { return m.name == name; });
  return known ? name : "";
}

bool may_have_no_bound(std::string_view measure) {
  const std::size_t colon = measure.find(':');
  if (colon == std::string_view::npos) return !uniqueness_of(measure).empty();
  return !measure.starts_with("final:") && force_column(measure.substr(colon + 1));
}

std::vector<std::string> columns_of(const std::shared_ptr<const Model>& model) {
  Simulation start{.trajectory = Trajectory(model)};
  start.trajectory.append(initial_state(model->structure, model->system).state, StepReport{});
  std::vector<std::string> names;
  for (const std::string_view name : diagnostic_names()) names.emplace_back(name);
  for (const Series& column : diagnose(start).columns)
    if (std::find(names.begin(), names.end(), column.name) == names.end()) names.push_back(column.name);
  return names;
}

RunMeasure find_measure(const std::string& name, const std::vector<std::string>& columns) {
  std::vector<std::string_view> known;
  for (const NamedMeasure& row : measure_table) {
    if (row.name == name)
      return {name, name + suffix(row.unit), with_unit(row.label, row.unit), row.value, row.needs};
    known.push_back(row.name);
  }
  const std::size_t colon = name.find(':');
  for (const Statistic& s : statistics) {
    if (colon == std::string::npos || name.substr(0, colon) != s.name) continue;
    const std::string of = name.substr(colon + 1);
    std::vector<std::string_view> there(columns.begin(), columns.end());
    if (there.empty()) there = diagnostic_names();
    // Flags of what was found already are known without columns.
    const std::string_view base =
        std::string_view(name).substr(0, name.size() - std::min<std::size_t>(name.size(), 7));
    const bool flag = uniqueness_of(base) == name;
    const std::string_view flagged = flag ? base.substr(colon + 1) : std::string_view();
    if (flag && (columns.empty() || std::find(there.begin(), there.end(), flagged) != there.end()))
      return {
          name, std::string(s.name) + "_" + of, label_of(s, flagged) + " is unique",
          [of = std::string(flagged), largest = s.name == "max"](
              const Simulation& run, const Diagnostics& d) { return extreme_unique(run, d, of, largest); }};
    if (columns.empty() && of.ends_with("_unique")) there.push_back(of);
    if (std::find(there.begin(), there.end(), of) == there.end())
      throw StudyError("no column " + in_quotes(of) + " to measure" + did_you_mean(of, there));
    return {name, std::string(s.name) + "_" + of, label_of(s, of),
            [of, f = s.of](const Simulation& run, const Diagnostics& d) { return f(run, d, of); },
            of_method(of) ? MeasureNeeds::method : MeasureNeeds::states};
  }
  // A column, with or without its unit.
  for (const std::string& column : columns)
    if (column == name || column.starts_with(name + "_"))
      throw StudyError("no measure " + in_quotes(name) + "; it is a column of series.csv, over time: max:" +
                       column + ", min:" + column + " or final:" + column);
  throw StudyError("no measure " + in_quotes(name) + did_you_mean(name, known) +
                   " (or max:, min:, final: and a column of series.csv)");
}

std::vector<RunMeasure> find_measures(std::string_view list, const std::vector<std::string>& columns) {
  const bool commas = std::any_of(columns.begin(), columns.end(), [](const std::string& column) {
    return column.find(',') != std::string::npos;
  });
  std::vector<RunMeasure> found;
  const auto take = [&](std::string_view name, bool last) {
    try {
      found.push_back(find_measure(std::string(name), columns));
      return true;
    } catch (const StudyError&) {
      if (last) throw;
      return false;
    }
  };
  while (!list.empty()) {
    const std::size_t next = std::min(list.find(','), list.size());
    std::size_t end = commas ? list.size() : next;  // the longest name that is one
    while (next > 0 && !take(list.substr(0, end), end == next)) end = list.rfind(',', end - 1);
    list.remove_prefix(std::min((next > 0 ? end : next) + 1, list.size()));
  }
  return found;
}

}  // namespace unfurl
