// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/extremes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/scene/write.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/table.hpp"

namespace unfurl {
namespace {

using Change = std::function<void(Structure&, double value)>;

std::shared_ptr<const Model> changed_model(const Scene& scene, const Change& change, double value) {
  Structure structure = build_structure(scene);
  change(structure, value);
  System system(structure, scene.solver.eliminate_linear);
  return std::make_shared<const Model>(Model{std::move(structure), std::move(system)});
}

Extreme by_structure(const SceneSource& source, std::string name, std::string label,
                     std::vector<double> values, Change change) {
  return {std::move(name), std::move(label), std::move(values), true,
          [scene = source.read(), change = std::move(change)](double value, SolverOptions& options) {
            options = scene.solver;
            return changed_model(scene, change, value);
          }};
}

// The scene with `key` at what `text` makes of the value.
Extreme by_key(const SceneSource& source, std::string name, std::string label, std::vector<double> values,
               std::string key, double (*text)(double)) {
  return {std::move(name), std::move(label), std::move(values), true,
          [source, key = std::move(key), text](double value, SolverOptions& options) {
            const Scene scene = source.read({key + "=" + exact_number(text(value))});
            options = scene.solver;
            return build_model(scene);
          }};
}

// Rods of the first group, or every second rod where there is one group only.
bool is_heavier(const Structure& s, std::size_t rod, bool groups) {
  return groups ? s.rods[rod].group == s.rods.front().group : rod % 2 == 0;
}

std::optional<Extreme> mass_ratio(const SceneSource& source) {
  const Structure s = build_structure(source.read());
  if (s.rods.size() < 2) return std::nullopt;
  const bool groups = std::any_of(s.rods.begin(), s.rods.end(),
                                  [&](const Rod& rod) { return rod.group != s.rods.front().group; });
  const std::string label =
      groups ? "mass of the " + s.rods.front().group + " rods (times)" : "mass of every second rod (times)";
  return by_structure(source, "mass_ratio", label, {1e-8, 1e-6, 1e-4, 1e-2, 1, 1e2, 1e4, 1e6, 1e8},
                      [groups](Structure& structure, double value) {
                        for (std::size_t r = 0; r < structure.rods.size(); ++r)
                          if (is_heavier(structure, r, groups)) structure.rods[r].mass *= value;
                      });
}

std::optional<Extreme> force(const SceneSource& source) {
  const Structure s = build_structure(source.read());
  if (s.loads.empty() && s.gravity.isZero(0.0)) return std::nullopt;
  return by_structure(source, "force", "forces (times)", {1e-6, 1e-4, 1e-2, 1, 1e2, 1e4, 1e6, 1e8},
                      [](Structure& structure, double value) {
                        for (Load& load : structure.loads) load.force *= value;
                        structure.gravity *= value;
                        for (Node& node : structure.nodes) node.velocity *= std::sqrt(value);
                      });
}

std::optional<Extreme> fold_angle(const SceneSource& source) {
  if (!scene_number(source.read(), "structure.fold_angle")) return std::nullopt;
  return by_key(source, "fold_angle", "90\u00B0 \u2212 fold angle (\u00B0)",
                {1e-7, 1e-5, 1e-3, 1e-2, 1e-1, 1, 10, 30, 60}, "structure.fold_angle",
                [](double value) { return 90.0 - value; });
}

std::optional<Extreme> units(const SceneSource& source) {
  if (!scene_number(source.read(), "structure.units")) return std::nullopt;
  return by_key(source, "units", "units", {4, 6, 12, 24, 48}, "structure.units",
                [](double value) { return value; });
}

// A stiffness that acts: neither that of a damper, 0, nor that of what does not give, inf.
bool is_stiffness(const std::string& name, const TomlTree& value) {
  if (name.find("stiffness") == std::string::npos) return false;
  if (value.kind == TomlTree::Kind::integer) return value.integer > 0;
  return value.kind == TomlTree::Kind::real && value.real > 0 && std::isfinite(value.real);
}

// Whether the scene, with another number there, says that the key or its entry does nothing.
bool does_nothing(const SceneSource& source, const std::string& key) {
  const std::string entry = key.substr(0, key.rfind('.'));
  try {
    const Scene scene = source.read({key + "=2"});
    const auto of_it = [&](const std::string& at) { return at == key || at == entry; };
    for (const SceneProblem& warning : scene.warnings)
      if (of_it(warning.key) && warning.message.starts_with("does nothing")) return true;
    for (const std::string& note : build_structure(scene).notes)
      if (note.starts_with(entry + ": does nothing") || note.starts_with(key + ": does nothing")) return true;
  } catch (const SceneError&) {
  }
  return false;
}

// Whether the motion is the same at a hundred times the stiffness, to round-off: that of a spring along a
// rigid rod, say, which loads the rod and moves nothing. Of what deploys it is not asked: an atlas follows
// that until it has.
bool moves_nothing(const SceneSource& source, const std::string& key) {
  constexpr double rounding = 1e-9;
  const auto run_at = [&](const char* value) {
    const Scene scene = source.read({key + "=" + value});
    return simulate(build_model(scene), scene.solver);
  };
  try {
    if (!build_structure(source.read()).deployment.empty()) return false;
    const Simulation soft = run_at("1"), stiff = run_at("100");
    const Trajectory &a = soft.trajectory, &b = stiff.trajectory;
    if (soft.status == RunStatus::failed || stiff.status != soft.status || a.size() != b.size()) return false;
    const auto same_at = [&](std::size_t i) {
      const VectorXd at = a.node_positions(i);
      return (b.node_positions(i) - at).norm() <= rounding * at.norm() &&
             std::abs(a.time(i) - b.time(i)) <= rounding * a.time(i);
    };
    return same_at(a.size() / 2) && same_at(a.size() - 1);
  } catch (const SceneError&) {
    return false;
  }
}

// The first of the scene that does something, in an entry that is enabled; its dotted key.
std::string stiffness_key(const SceneSource& source, const TomlTree& tree, const std::string& path) {
  const TomlTree* enabled = tree.find("enabled");
  if (enabled && enabled->kind == TomlTree::Kind::boolean && !enabled->boolean) return {};
  for (const auto& [name, value] : tree.entries) {
    const std::string key = path.empty() ? name : path + "." + name;
    if (is_stiffness(name, value) && !does_nothing(source, key) && !moves_nothing(source, key)) return key;
    if (value.kind == TomlTree::Kind::table)
      if (std::string found = stiffness_key(source, value, key); !found.empty()) return found;
    for (std::size_t i = 0; i < value.items.size(); ++i)
      if (std::string found = stiffness_key(source, value.items[i], key + "[" + std::to_string(i) + "]");
          !found.empty())
        return found;
  }
  return {};
}

std::optional<Extreme> stiffness(const SceneSource& source) {
  const Scene scene = source.read();
  const std::string key = stiffness_key(source, parse_toml(scene_text(scene), scene.name), "");
  if (key.empty()) return std::nullopt;
  return by_key(source, "stiffness", key, {1, 1e2, 1e4, 1e6, 1e8, 1e10}, key,
                [](double value) { return value; });
}

constexpr std::array kinds{
    ExtremeKind{"mass_ratio", "some rods lighter or heavier than the others, to 1e8", mass_ratio},
    ExtremeKind{"force", "loads and gravity, to 1e8 times", force},
    ExtremeKind{"fold_angle", "folded towards dead centre, to 90 deg - 1e-7", fold_angle},
    ExtremeKind{"units", "more units", units},
    ExtremeKind{"stiffness", "the first spring that acts stiffer, to 1e10", stiffness},
};

}  // namespace

std::span<const ExtremeKind> extreme_kinds() {
  return kinds;
}

}  // namespace unfurl
