// SPDX-License-Identifier: BSD-3-Clause
// unfurl margin SCENE [--factor NAME=VALUE] [--stuck] [-o DIR]: drives against resistances along the path.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/output/interrupt.hpp"
#include "app/verbs/scene_run.hpp"
#include "app/verbs/study_session.hpp"
#include "core/path/margin.hpp"
#include "core/path/path.hpp"
#include "core/path/sector.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/table.hpp"
#include "core/text/nearest_name.hpp"
#include "render/plot/figures/margin_figure.hpp"

namespace unfurl {

namespace {

std::map<std::string, double> factors_of(const Arguments& arguments) {
  std::map<std::string, double> out;
  for (const std::string& text : arguments.study.factors) {
    const std::size_t at = text.rfind('=');
    const double value = at == std::string::npos ? -1 : number_of(text.substr(at + 1));
    if (at == 0 || !(value >= 0) || !std::isfinite(value))
      throw UsageError("--factor must be NAME=VALUE with a number >= 0; got " + in_quotes(text));
    if (!out.emplace(text.substr(0, at), value).second)
      throw UsageError("--factor gives " + in_quotes(text.substr(0, at)) + " twice");
  }
  return out;
}

bool folds(const Margin& margin) {
  return margin.unit == "N m";
}

// Degrees of the fold angle, or how far along the path.
double place(const Margin& margin, double fold_angle, double s) {
  return folds(margin) ? fold_angle / radians_per_degree : s;
}

std::string place_column(const Margin& margin) {
  return folds(margin) ? "fold_angle_deg" : "way_m_kg_1_2";
}

Table poses_table(const Margin& margin) {
  Table table{{place_column(margin), "static_margin"}, {}};
  for (const MarginSource& source : margin.sources)
    table.columns.push_back(source.name + (folds(margin) ? ".torque_N_m" : ".force_N_kg_1_2"));
  for (const MarginPoint& p : margin.points) {
    table.rows.push_back({exact_number(place(margin, p.fold_angle, p.s)), exact_number(p.margin)});
    for (const double force : p.forces) table.rows.back().push_back(exact_number(force));
  }
  return table;
}

Table motion_table(const Margin& margin) {
  Table table{{"t_s", place_column(margin), "dynamic_margin", "kinetic_energy_J", "driven_J", "resisted_J"},
              {}};
  for (const MarginReach& r : margin.motion)
    table.rows.push_back({exact_number(r.t), exact_number(place(margin, r.fold_angle, r.s)),
                          exact_number(r.margin()), exact_number(r.kinetic), exact_number(r.driven),
                          exact_number(r.resisted)});
  return table;
}

Table stuck_table(const Margin& margin, const std::vector<StuckHinge>& hinges) {
  Table table{
      {"hinge", "stall_torque_N_m", "stalls_at_" + place_column(margin), "static_torque_N_m", "turn_rad"},
      {}};
  for (const StuckHinge& h : hinges)
    table.rows.push_back({h.name, exact_number(h.stall_torque),
                          exact_number(place(margin, h.stall_fold, h.stall_at)),
                          exact_number(h.static_torque), exact_number(h.turn)});
  return table;
}

const char* load_unit(const MarginLoad& load) {
  return load.turns ? "N m" : "N";
}

const char* speed_unit(const MarginLoad& load) {
  return load.turns ? "rad/s" : "m/s";
}

Table loads_table(const Margin& margin) {
  Table table{{"name", "kind", place_column(margin), "load", "load_unit", "speed", "speed_unit", "energy_J"},
              {}};
  for (const MarginLoad& load : margin.loads)
    table.rows.push_back({load.name, load.kind, exact_number(place(margin, margin.end_fold, margin.end_s)),
                          exact_number(load.load), load_unit(load), exact_number(load.speed),
                          speed_unit(load), exact_number(load.energy)});
  return table;
}

using Json = nlohmann::ordered_json;

std::string end_in_words(const Margin& margin) {
  switch (margin.end) {
    case MarginEnd::arrives:
      return "arrives";
    case MarginEnd::stalls:
      return "stalls";
    case MarginEnd::stopped:
      return "end stop " + margin.stop;
    case MarginEnd::time:
      return "end time";
    case MarginEnd::other_way:
      return "sets out the other way";
  }
  return "";
}

Json sources_json(const Margin& margin) {
  Json sources = Json::array();
  for (std::size_t k = 0; k < margin.sources.size(); ++k)
    sources.push_back({{"name", margin.sources[k].name},
                       {"kind", margin.sources[k].kind},
                       {"factor", margin.sources[k].factor},
                       {"largest_drive", margin.sources[k].largest_drive},
                       {"largest_resistance", margin.sources[k].largest_resistance},
                       {"at_worst", margin.worst.forces[static_cast<Index>(k)]}});
  return sources;
}

Json loads_json(const Margin& margin) {
  Json loads = Json::array();
  for (const MarginLoad& load : margin.loads)
    loads.push_back({{"name", load.name},
                     {"kind", load.kind},
                     {"at", place(margin, margin.end_fold, margin.end_s)},
                     {"load", load.load},
                     {"load_unit", load_unit(load)},
                     {"speed", load.speed},
                     {"speed_unit", speed_unit(load)},
                     {"energy_J", load.energy}});
  return loads;
}

// A margin without bound is null.
Json margin_json(const Scene& scene, const Margin& margin, const std::vector<StuckHinge>& hinges,
                 bool stuck) {
  const MarginReach& last = margin.motion.back();
  Json json{
      {"scene", scene.name},
      {"static_margin_min", margin.worst.margin},
      {"static_margin_at", place(margin, margin.worst.fold_angle, margin.worst.s)},
      {"dynamic_margin_min", margin.dynamic_min},
      {"at_unit", folds(margin) ? "deg" : "m kg^1/2"},
      {"arrives", margin.arrives},
      {"ends", end_in_words(margin)},
      {"ends_at", place(margin, last.fold_angle, last.s)},
      {"stalls_at", margin.end == MarginEnd::stalls ? Json(place(margin, last.fold_angle, last.s)) : Json()},
      {"force_unit", margin.unit},
      {"sources", sources_json(margin)},
      {"loads", loads_json(margin)}};
  if (!stuck) return json;
  json["stuck"] = Json::array();
  for (const StuckHinge& h : hinges)
    json["stuck"].push_back({{"hinge", h.name},
                             {"stall_torque_N_m", h.stall_torque},
                             {"stalls_at", place(margin, h.stall_fold, h.stall_at)},
                             {"static_torque_N_m", h.static_torque},
                             {"turn_rad", h.turn}});
  return json;
}

std::string words(double margin) {
  if (std::isnan(margin)) return "none";
  return std::isfinite(margin) ? short_number(margin, 6) : "without bound";
}

// Names in a column, with two blanks behind the longest.
int name_column(const std::vector<std::string_view>& names) {
  std::size_t width = 28;
  for (const std::string_view name : names) width = std::max(width, name.size());
  return static_cast<int>(width) + 2;
}

void print_sources(const Margin& margin) {
  std::vector<std::string_view> names;
  for (const MarginSource& source : margin.sources) names.push_back(source.name);
  const int width = name_column(names);
  std::cout << std::left << std::setw(width) << "source"
            << "factor   at the worst pose (" << margin.unit << ")\n";
  for (std::size_t k = 0; k < names.size(); ++k)
    std::cout << std::setw(width) << names[k] << std::setw(9) << short_number(margin.sources[k].factor, 4)
              << short_number(margin.worst.forces[static_cast<Index>(k)], 6) << "\n";
}

void print_loads(const Margin& margin) {
  if (margin.loads.empty()) return;
  std::vector<std::string_view> names;
  for (const MarginLoad& load : margin.loads) names.push_back(load.name);
  const int width = name_column(names);
  std::cout << std::left << std::setw(width) << "stop or latch" << std::setw(20) << "load at rest"
            << std::setw(20) << "met at"
            << "with (J)\n";
  for (const MarginLoad& load : margin.loads) {
    std::cout << std::setw(width) << load.name << std::setw(20)
              << words(load.load) + (std::isfinite(load.load) ? std::string(" ") + load_unit(load) : "");
    if (std::isnan(load.speed))
      std::cout << "it is not reached\n";
    else
      std::cout << std::setw(20) << short_number(load.speed, 6) + " " + speed_unit(load)
                << short_number(load.energy, 6) << "\n";
  }
}

void print_hinges(const Margin& margin, const std::vector<StuckHinge>& hinges, const std::string& unit) {
  std::vector<std::string_view> names;
  for (const StuckHinge& hinge : hinges) names.push_back(hinge.name);
  const int width = name_column(names);
  std::cout << std::left << std::setw(width) << "hinge jammed"
            << "stalls by (N m)   at\n";
  for (const StuckHinge& h : hinges)
    std::cout << std::setw(width) << h.name << std::setw(18) << short_number(h.stall_torque, 6)
              << short_number(place(margin, h.stall_fold, h.stall_at), 5) << unit << "\n";
}

void print_margin(const Scene& scene, const Margin& margin, const std::vector<StuckHinge>& hinges,
                  bool stuck) {
  const std::string unit = folds(margin) ? " deg" : " m kg^1/2";
  const MarginReach& last = margin.motion.back();
  std::cout << scene.name << ": static margin " << words(margin.worst.margin) << " at "
            << short_number(place(margin, margin.worst.fold_angle, margin.worst.s), 6) << unit
            << ", dynamic margin " << words(margin.dynamic_min) << "; "
            << told_end(margin, short_number(place(margin, last.fold_angle, last.s), 6) + unit) << "\n";
  print_sources(margin);
  print_loads(margin);
  if (!hinges.empty())
    print_hinges(margin, hinges, unit);
  else if (stuck)
    std::cout << "no hinge jams: no two rods that meet at a node turn against each other on the way\n";
}

// Of rings of more than a dozen units rounding hides the path next to the flat pose; that of one of their
// equal sectors it does not. Hinges jam one by one, in the whole.
Margin margin_as_far_as_followed(const std::shared_ptr<const Model>& model, const Scene& scene,
                                 const std::map<std::string, double>& factors, bool by_sector) {
  try {
    return margin_of(model, scene.solver, factors);
  } catch (const PathRefused& refused) {
    try {
      if (by_sector && model->structure.deployment.folds())
        return margin_of(Sector(model).model(), scene.solver, factors);
    } catch (const PathRefused&) {  // no sector: of the whole, then
    }
    const bool own_sector = !by_sector && scene.kind == "hoop" && model->structure.sectors == 1;
    throw PathRefused(scene.name + ": no margin: " + refused.what() +
                      (own_sector
                           ? "; that of one sector, whose hinges stand for those of all, may go further: "
                             "--set structure.model=sector"
                           : ""));
  }
}

}  // namespace

int cmd_margin(const Arguments& arguments) {
  const Scene scene = scene_of(arguments);
  const auto factors = factors_of(arguments);
  warn_of_idle_sets(arguments, {"solver.model", "solver.tolerance"}, "margins are those of the path");
  const InterruptGuard guard;
  const auto model = model_of(scene, arguments);
  SolverOptions own_steps = scene.solver;
  own_steps.step = 0;  // a margin's are as long as its path allows: nothing to warn of
  for (const std::string& warning : start_warnings(*model, own_steps))
    std::cerr << "unfurl: warning: " << warning << "\n";
  const Margin margin = margin_as_far_as_followed(model, scene, factors, !arguments.study.stuck);
  constexpr std::size_t few = 12;  // hinges whose pairs are told too
  std::vector<StuckHinge> hinges;
  if (arguments.study.stuck) hinges = stuck_hinges(model, scene.solver, margin, few);
  if (arguments.json)
    std::cout << margin_json(scene, margin, hinges, arguments.study.stuck).dump(2) << "\n";
  else if (!arguments.quiet)
    print_margin(scene, margin, hinges, arguments.study.stuck);
  if (arguments.output.empty()) return exit_ok;
  std::string asked = "Margins";
  for (const std::string& factor : arguments.study.factors) asked += " " + factor;
  StudySession session(arguments, "margins", study_identity(asked, scene), "margin.csv");
  session.write("margin.csv", csv_text(poses_table(margin)));
  session.write("motion.csv", csv_text(motion_table(margin)));
  session.write("loads.csv", csv_text(loads_table(margin)));
  if (arguments.study.stuck) session.write("stuck.csv", csv_text(stuck_table(margin, hinges)));
  session.write("margin.json", margin_json(scene, margin, hinges, arguments.study.stuck).dump(2) + "\n");
  session.write(margin_figure(margin, scene.title));
  return exit_ok;
}

}  // namespace unfurl
