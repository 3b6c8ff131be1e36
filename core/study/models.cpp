// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/models.hpp"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/force_uniqueness.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/integrators/integrator.hpp"
#include "core/path/path.hpp"
#include "core/scene/build.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/scene/write.hpp"
#include "core/simulate/simulation.hpp"
#include "core/simulate/singular_poses.hpp"
#include "core/study/measured_run.hpp"
#include "core/study/tolerance.hpp"

namespace unfurl {
namespace {

std::string text_at(const TomlTree& root, const char* table, const char* key) {
  const TomlTree* found = root.find(table);
  const TomlTree* value = found ? found->find(key) : nullptr;
  if (!value) return {};
  return value->kind == TomlTree::Kind::boolean ? (value->boolean ? "true" : "false") : value->text;
}

bool is_false(const TomlTree* value) {
  return value && value->kind == TomlTree::Kind::boolean && !value->boolean;
}

// Changes that take the damping out of a scene: every number whose name tells of it and is not zero is zero,
// entries of kinds that do nothing else, which take no zero, are disabled.
void undamp(const TomlTree& tree, const std::string& path, std::vector<std::string>& out) {
  if (is_false(tree.find("enabled"))) return;
  const TomlTree* kind = tree.find("kind");
  if (kind && (kind->text == "joint_damping" || kind->text == "drag")) {
    out.push_back(path + ".enabled=false");
    return;
  }
  for (const auto& [name, value] : tree.entries) {
    const std::string key = path.empty() ? name : path + "." + name;
    const double number =
        value.kind == TomlTree::Kind::real ? value.real : static_cast<double>(value.integer);
    if ((value.kind == TomlTree::Kind::real || value.kind == TomlTree::Kind::integer) && number != 0 &&
        name.find("damping") != std::string::npos)
      out.push_back(key + "=0");
    if (value.kind == TomlTree::Kind::table) undamp(value, key, out);
    for (std::size_t i = 0; i < value.items.size(); ++i)
      undamp(value.items[i], key + "[" + std::to_string(i) + "]", out);
  }
}

// Changes that take from rods what they say by themselves: their moduli, and whether they give and bend.
struct OwnOfRods {
  std::vector<std::string> moduli, models, cut;  // cut: names of keys
};

OwnOfRods own_of_rods(const TomlTree& root) {
  OwnOfRods out;
  const TomlTree* structure = root.find("structure");
  const TomlTree* rods = structure ? structure->find("rods") : nullptr;
  for (std::size_t i = 0; rods && i < rods->items.size(); ++i) {
    const std::string rod = "structure.rods[" + std::to_string(i) + "].";
    const TomlTree &of = rods->items[i], *modulus = of.find("youngs_modulus"), *elastic = of.find("elastic"),
                   *segments = of.find("segments");
    if (modulus && !(modulus->kind == TomlTree::Kind::real && std::isinf(modulus->real)))
      out.moduli.push_back(rod + "youngs_modulus=inf");
    if (elastic && elastic->boolean) out.models.push_back(rod + "elastic=false");
    if (segments && segments->integer > 1) {
      out.models.push_back(rod + "segments=1");
      out.cut.push_back(rod + "segments");
    }
  }
  return out;
}

// Rods with a modulus share forces that rigid ones leave open. How they share depends on ratios alone.
void add_modulus(const TomlTree& root, std::vector<ModelChoice>& out) {
  const TomlTree* structure = root.find("structure");
  const TomlTree* modulus = structure ? structure->find("youngs_modulus") : nullptr;
  if (!modulus) return;
  const OwnOfRods own = own_of_rods(root);
  const bool rigid = modulus->kind == TomlTree::Kind::real && std::isinf(modulus->real) && own.moduli.empty();
  if (rigid) {
    out.push_back({"forces shared by stiffness: E = 70 GPa", {"structure.youngs_modulus=7e10"}});
    return;
  }
  std::vector<std::string> changes{"structure.rod_model=rigid", "structure.segments=1",
                                   "structure.youngs_modulus=inf"};
  changes.insert(changes.end(), own.moduli.begin(), own.moduli.end());
  changes.insert(changes.end(), own.models.begin(), own.models.end());
  out.push_back({"rigid rods: forces of least norm", std::move(changes)});
}

// Rigid, quasi-static, elastic, bending: those that the scene does not have. Without a modulus, aluminium's.
void add_rod_models(const TomlTree& root, std::vector<ModelChoice>& out) {
  const std::string now = text_at(root, "structure", "rod_model");
  if (now.empty()) return;
  const TomlTree* modulus = root.find("structure")->find("youngs_modulus");
  const OwnOfRods own = own_of_rods(root);
  const bool endless = (!modulus || std::isinf(modulus->real)) && own.moduli.empty();
  const std::string known = endless ? ": E = 70 GPa" : "";
  const auto add = [&](const std::string& name, std::vector<std::string> changes) {
    if (endless) changes.emplace_back("structure.youngs_modulus=7e10");
    out.push_back({name + known, std::move(changes)});
  };
  const TomlTree* segments = root.find("structure")->find("segments");
  const auto without_waves = [&](const std::string& model) {
    std::vector<std::string> changes{"structure.rod_model=" + model};
    if (segments && segments->integer > 1) changes.emplace_back("structure.segments=1");
    changes.insert(changes.end(), own.models.begin(), own.models.end());
    return changes;
  };
  if (now != "rigid" || !own.models.empty()) out.push_back({"rigid rods", without_waves("rigid")});
  if (now != "quasi-static" || !own.models.empty())
    add("quasi-static rods: stretched by the rigid run's forces", without_waves("quasi-static"));
  const auto in_segments = [&](const char* count, std::vector<std::string> changes) {
    for (const std::string& key : own.cut) changes.push_back(key + count);
    return changes;
  };
  if (now != "elastic") add("elastic rods, with waves", in_segments("=1", {"structure.rod_model=elastic"}));
  if (segments && segments->integer <= 1)
    add("bending rods: elastic, in 4 segments",
        in_segments("=4", {"structure.rod_model=elastic", "structure.segments=4"}));
}

// Every force of a kind switched off, and what else goes with it.
void add_without(const Scene& scene, std::string_view kind, const char* name,
                 std::vector<std::string> changes, std::vector<ModelChoice>& out) {
  const std::size_t others = changes.size();
  for (const SceneElement& force : scene.forces)
    if (force.kind == kind && force.enabled) changes.push_back(force.key + ".enabled=false");
  if (changes.size() > others) out.push_back({name, std::move(changes)});
}

// Bytes that are in use on the heap now, mapped blocks included.
double heap_in_use() {
  const auto info = ::mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

// Nodes within rods that were cut, with the parts of their rod.
std::map<int, int> within_rods(const Structure& structure) {
  std::map<int, int> nodes;
  for (std::size_t r = 1; r < structure.rods.size(); ++r)
    if (const Rod& rod = structure.rods[r], &before = structure.rods[r - 1];
        rod.parts > 1 && rod.whole == before.whole && rod.a == before.b)
      nodes.emplace(rod.a, rod.parts);
  return nodes;
}

// Where the nodes that both runs show begin among their positions: segments add nodes, which are others of
// the same name where there are not as many, a model without nets has fewer.
std::vector<std::pair<Index, Index>> common_nodes(const Trajectory& a, const Trajectory& b) {
  const auto parts_at = [](const std::map<int, int>& within, const NodeCopy& node) {
    const auto found = within.find(node.source);
    return found == within.end() ? 0 : found->second;
  };
  const std::map<int, int> in_a = within_rods(a.structure()), in_b = within_rods(b.structure());
  std::map<std::pair<std::string_view, int>, Index> place;
  Index at = 0;
  for (const NodeCopy& node : b.structure().node_copies)
    place.emplace(std::pair(std::string_view(node.name), parts_at(in_b, node)), at), at += 3;
  std::vector<std::pair<Index, Index>> common;
  at = 0;
  for (const NodeCopy& node : a.structure().node_copies) {
    if (const auto found = place.find({node.name, parts_at(in_a, node)}); found != place.end())
      common.emplace_back(at, found->second);
    at += 3;
  }
  return common;
}

// Of those nodes, at every time of the first run that the other reaches: from its state where one is within
// round-off of that, else from within its step.
double difference(const Trajectory& a, const Trajectory& b, const SolverOptions& options) {
  const auto common = common_nodes(a, b);
  if (common.empty()) return nan;
  const double near = 1e-9 * std::min(options.step, options.end_time);
  double largest = 0;
  for (std::size_t i = 0, k = 0; i < a.size(); ++i) {
    while (k < b.size() && b.time(k) < a.time(i) - near) ++k;
    if (k == b.size()) break;
    const VectorXd x = a.positions(i),
                   y = b.time(k) < a.time(i) + near ? b.positions(k) : b.positions_at(a.time(i));
    for (const auto& [at, there] : common)
      largest = std::max(largest, (x.segment<3>(at) - y.segment<3>(there)).norm());
  }
  return largest;
}

// Of the one among them that moves furthest in the first run, at the last time that both have.
double tip_difference(const Trajectory& a, const Trajectory& b) {
  const auto common = common_nodes(a, b);
  if (common.empty()) return nan;
  const VectorXd moved = a.positions(a.size() - 1) - a.positions(0);
  const auto way = [&moved](const auto& node) { return moved.segment<3>(node.first).norm(); };
  const auto [tip, there] = *std::max_element(
      common.begin(), common.end(), [&way](const auto& x, const auto& y) { return way(x) < way(y); });
  const double t = std::min(a.end_time(), b.end_time());
  return (a.positions_at(t).segment<3>(tip) - b.positions_at(t).segment<3>(there)).norm();
}

constexpr const char* mesh_name = "single precision of the display's mesh";

// Of a choice that solves nothing no number is one.
void no_model(MeasuredModel& m) {
  m.solved_coordinates = m.constraints = 0;
  for (double* x : {&m.cpu_median, &m.cpu_min, &m.cpu_max, &m.memory, &m.difference, &m.tip_difference,
                    &m.deployment_time, &m.peak_force, &m.cpu_forces})
    *x = nan;
}

// What drawing sees of a run: node positions in single precision. It costs no step anything.
MeasuredModel display_mesh(const Trajectory& run) {
  MeasuredModel m;
  m.choice.name = mesh_name;
  no_model(m);
  m.difference = 0;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const VectorXd x = run.positions(i), drawn = x.cast<float>().cast<double>();
    m.difference = std::max(m.difference, node_distance(x, drawn));
  }
  return m;
}

// The first run of a choice, and its model's cost.
Simulation measure(const SceneSource& source, int repeats, const StudyHooks& hooks, MeasuredModel& out) {
  const Scene scene = source.read(out.choice.changes);
  const double before = heap_in_use();
  auto model = build_model(scene);
  const auto method = find_method(scene.solver.method)->make(model->system, scene.solver);
  out.memory = std::max(heap_in_use() - before, 0.0);  // what was freed meanwhile may be more
  out.solved_coordinates = model->system.solved_coordinates();
  out.constraints = model->system.constraints();
  SimulationHooks own;
  own.cancelled = hooks.cancelled;
  std::optional<Simulation> first;
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    Simulation run = scene.solver.model == "full" ? simulate(model, scene.solver, own)
                                                  : simulate_as_asked(model, scene.solver, own);
    if (run.status == RunStatus::stopped) throw Cancelled();
    times.push_back(run.cpu_s);
    if (!first) first = std::move(run);
  }
  std::sort(times.begin(), times.end());
  out.cpu_min = times.front();
  out.cpu_median = times[times.size() / 2];
  out.cpu_max = times.back();
  judge(*first);
  out.outcome = to_string(first->status);
  out.message = first->message;
  if (first->status == RunStatus::failed) return std::move(*first);
  out.deployment_time = deployment_time(*first);
  record_singular_poses(*first);  // beside them forces may have no bound
  const double begin = thread_cpu_seconds();
  const Diagnostics found = diagnose(*first, hooks.cancelled);
  const RememberedExtremes once;
  const PeakForce peak = peak_rod_force(*first, found);
  out.cpu_forces = thread_cpu_seconds() - begin;
  out.peak_force = peak.rod < 0 ? nan : find_measure("peak_rod_force").value(*first, found);
  out.peak_unique = peak.unique;
  return std::move(*first);
}

// Gears and nets, switched off one by one.
void add_switches(const Scene& scene, const TomlTree& root, std::vector<ModelChoice>& out) {
  for (const auto& [key, name] :
       {std::pair{"gears", "without synchronising gears"}, std::pair{"nets", "without nets"}})
    if (text_at(root, "structure", key) == "true")
      out.push_back({name, {std::string("structure.") + key + "=false"}});
  for (const auto* list : {&scene.constraints, &scene.forces})
    for (const SceneElement& element : *list) {
      const bool coupling = element.kind == "gear" || element.kind == "rack" || element.kind == "telescope";
      const bool net = element.kind == "cable" && element.values.real("smoothing") > 0;
      if (element.enabled && (coupling || net))
        out.push_back({"without " + element.name, {element.key + ".enabled=false"}});
    }
}

// With the rows of its files in its text, where changes reach them.
SceneSource without_files(const SceneSource& source) {
  const Scene scene = source.read();
  if (scene.files.empty()) return source;
  return {source.path, {}, std::make_shared<const std::string>(scene_text(scene)), source.folder};
}

}  // namespace

std::vector<ModelChoice> model_choices(const SceneSource& source) {
  const Scene scene = source.read();
  const TomlTree root = parse_toml(scene_text(scene), scene.name);
  std::vector<ModelChoice> out{{"as the scene says", {}}};
  const auto add = [&](const char* table, const char* key, const char* value, const char* name) {
    const std::string now = text_at(root, table, key);
    if (!now.empty() && now != value) out.push_back({name, {std::string(table) + "." + key + "=" + value}});
  };
  add("solver", "model", "path", "path: one number along the only way to move");
  add("structure", "model", "full", "full: every unit solved");
  add("structure", "model", "sector", "sector: one sector solved, all shown");
  add("solver", "eliminate_linear", "true", "linear constraints eliminated");
  add("solver", "eliminate_linear", "false", "linear constraints kept as equations");
  add("solver", "sparse", "true", "sparse matrices");
  add("solver", "sparse", "false", "dense matrices");
  add("structure", "mass", "consistent", "consistent mass: rigid uniform rods");
  add("structure", "mass", "lumped", "lumped mass: half of a rod at each node");
  add_modulus(root, out);
  add_rod_models(root, out);
  add_switches(scene, root, out);
  std::vector<std::string> undamped;
  undamp(root, "", undamped);
  if (!undamped.empty()) out.push_back({"without damping", std::move(undamped)});
  std::vector<std::string> rubbing;
  for (const auto* list : {&scene.constraints, &scene.forces})
    for (const SceneElement& e : *list)
      if (e.enabled && (e.kind == "cable" || e.kind == "winch") && e.values.real("pulley_friction") > 0)
        rubbing.push_back(e.key + ".pulley_friction=0");
  if (!rubbing.empty()) out.push_back({"without pulley friction", rubbing});
  add_without(scene, "friction", "without friction", {}, out);
  add_without(scene, "offload", "0 g flight: neither weight nor offload", {"gravity.acceleration=[0,0,0]"},
              out);
  return out;
}

namespace {

std::string outcome_with_reason(const MeasuredModel& m) {
  return m.outcome == "failed" && !m.message.empty() ? "failed: " + m.message : m.outcome;
}
std::vector<std::string> row_of_model(const MeasuredModel& m) {
  const auto of_model = [&m](Index count) {
    return m.solved_coordinates > 0 ? std::to_string(count) : std::string("nan");
  };
  std::vector<std::string> row{m.choice.name, outcome_with_reason(m), of_model(m.solved_coordinates),
                               of_model(m.constraints)};
  for (const double x : {m.cpu_median, m.cpu_min, m.cpu_max, m.memory, m.difference, m.deployment_time})
    row.push_back(exact_number(x));
  row.push_back(exact_number(m.peak_force));
  row.push_back(of_model(m.peak_unique ? 1 : 0));
  row.push_back(exact_number(m.cpu_forces));
  row.push_back(exact_number(m.tip_difference));
  return row;
}

MeasuredModel model_of(const std::vector<std::string>& row, const ModelChoice& choice) {
  const auto count = [](const std::string& cell) {
    return cell == "nan" ? Index{0} : static_cast<Index>(number_of(cell));
  };
  MeasuredModel m{choice, row[1], "", count(row[2]), count(row[3])};
  std::size_t cell = 4;
  for (double* x :
       {&m.cpu_median, &m.cpu_min, &m.cpu_max, &m.memory, &m.difference, &m.deployment_time, &m.peak_force})
    *x = number_of(row[cell++]);
  m.peak_unique = row[cell++] == "1";
  m.cpu_forces = number_of(row[cell++]);
  m.tip_difference = number_of(row[cell]);
  return m;
}

// Of two choices of one name none is known. One that failed is tried again.
std::optional<MeasuredModel> known_model(const Journal& journal, const std::vector<ModelChoice>& choices,
                                         const ModelChoice& choice) {
  const auto* row = journal.find({choice.name});
  if (!row || (*row)[1].starts_with("failed") ||
      std::ranges::count(choices, choice.name, &ModelChoice::name) > 1)
    return std::nullopt;
  return model_of(*row, choice);
}

}  // namespace

std::vector<MeasuredModel> compare_models(const SceneSource& source, int repeats, const StudyHooks& hooks) {
  Journal nowhere({}, models_columns(), 1);
  return compare_models(source, repeats, nowhere, hooks);
}

std::vector<MeasuredModel> compare_models(const SceneSource& asked, int repeats, Journal& journal,
                                          const StudyHooks& hooks) {
  const SceneSource source = without_files(asked);
  std::vector<MeasuredModel> out;
  std::optional<Simulation> base;
  auto choices = model_choices(source);
  const auto measured_already = [&](const ModelChoice& choice) {
    return known_model(journal, choices, choice).has_value();
  };
  const ModelChoice mesh{mesh_name, {}};
  const bool all = std::ranges::all_of(choices, measured_already) && measured_already(mesh);
  for (const ModelChoice& choice : choices) {
    hooks.tell(static_cast<double>(out.size()) / static_cast<double>(choices.size()));
    MeasuredModel m;
    m.choice = choice;
    m.difference = m.tip_difference = m.deployment_time = m.peak_force = m.cpu_forces = nan;
    if (auto known = known_model(journal, choices, choice)) {
      if (!all && !base) base = measure(source, 1, hooks, m);  // which others are compared with
      out.push_back(*std::move(known));
      continue;
    }
    try {
      Simulation run = measure(source, repeats, hooks, m);
      if (!base) {
        base = std::move(run);
        if (base->status != RunStatus::failed) m.difference = m.tip_difference = 0;
      } else if (base->status != RunStatus::failed && run.status != RunStatus::failed) {
        m.difference = difference(base->trajectory, run.trajectory, base->options);
        m.tip_difference = tip_difference(base->trajectory, run.trajectory);
      }
    } catch (const SceneError& error) {
      if (!base) throw;
      m.outcome = "not possible: " + error.problems().front().message;
      no_model(m);
    } catch (const PathRefused& refused) {
      if (!base) throw;
      m.outcome = std::string("not possible: ") + refused.what();
      no_model(m);
    }
    if (m.outcome != "failed") journal.append(row_of_model(m));
    out.push_back(std::move(m));
  }
  if (all) {
    out.push_back(*known_model(journal, choices, mesh));
  } else if (base && base->status != RunStatus::failed) {
    out.push_back(display_mesh(base->trajectory));
    journal.append(row_of_model(out.back()));
  }
  hooks.tell(1);
  return out;
}

std::vector<std::string> models_columns() {
  return {"model",        "outcome",           "solved_coordinates", "constraints",
          "cpu_median_s", "cpu_min_s",         "cpu_max_s",          "memory_bytes",
          "difference_m", "deployment_time_s", "peak_rod_force_N",   "peak_unique",
          "cpu_forces_s", "tip_difference_m"};
}

std::vector<std::size_t> models_number_columns() {
  std::vector<std::size_t> numbers;
  for (std::size_t c = 2; c < models_columns().size(); ++c) numbers.push_back(c);
  return numbers;
}

bool is_measured_model(const std::vector<std::string>& row) {
  const auto counts = [](const std::string& cell) {
    const double x = number_of(cell);
    return x >= 0 && x < 1e9 && x == std::floor(x);
  };
  const std::string& outcome = row[1];
  const bool none = row[2] == "nan";  // of what solves nothing
  const bool known = outcome.empty() || outcome.starts_with("not possible: ") ||
                     outcome == to_string(RunStatus::completed) || outcome == to_string(RunStatus::deployed);
  return known &&
         (none ? row[3] == "nan" && row[11] == "nan"
               : counts(row[2]) && counts(row[3]) && (row[11] == "0" || row[11] == "1")) &&
         std::ranges::none_of(row.begin() + 4, row.begin() + 8,
                              [](const std::string& cell) { return number_of(cell) < 0; });
}

Table models_table(const std::vector<MeasuredModel>& models) {
  Table table{models_columns(), {}};
  for (const MeasuredModel& m : models) table.rows.push_back(row_of_model(m));
  return table;
}

Table models_summary(const std::vector<MeasuredModel>& models) {
  Table table{{"model", "coordinates", "constraints", "CPU (ms)", "CPU (times)", "memory (kB)",
               "difference in the answer (m)", "of the tip at the end (m)", "deployed at (s)",
               "peak rod force (N)", "forces (ms)"},
              {}};
  const auto known = [](double value) { return std::isnan(value) ? std::string() : short_number(value); };
  for (const MeasuredModel& m : models) {
    if (m.solved_coordinates == 0) {
      table.rows.push_back({m.choice.name + (m.outcome.empty() ? "" : " (" + m.outcome + ")"), "", "", "", "",
                            "", known(m.difference), "", "", "", ""});
      continue;
    }
    table.rows.push_back(
        {m.choice.name + (m.outcome == "failed" ? " (" + outcome_with_reason(m) + ")" : ""),
         std::to_string(m.solved_coordinates), std::to_string(m.constraints),
         short_number(1e3 * m.cpu_median), short_number(m.cpu_median / models.front().cpu_median),
         short_number(m.memory / 1e3), known(m.difference), known(m.tip_difference),
         std::isnan(m.deployment_time) ? "" : short_number(m.deployment_time, 8),
         std::isnan(m.peak_force) ? ""
                                  : short_number(m.peak_force, 6) + (m.peak_unique ? "" : " (not unique)"),
         known(1e3 * m.cpu_forces)});
  }
  return table;
}

}  // namespace unfurl
