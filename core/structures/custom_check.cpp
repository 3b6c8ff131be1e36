// SPDX-License-Identifier: BSD-3-Clause
// Everything that can be wrong with a list of nodes and rods.
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "core/structure/structure_error.hpp"
#include "core/structures/custom.hpp"
#include "core/text/name_index.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

class Checker {
 public:
  explicit Checker(const CustomSpec& spec) : spec_(spec) {}

  std::vector<CustomProblem> run() {
    check_nodes();
    check_rods();
    check_rod_model();
    return std::move(problems_);
  }

 private:
  bool full() const { return problems_.size() >= 100; }

  void add(std::string table, std::size_t index, std::string key, std::string message) {
    if (!full())
      problems_.push_back({std::move(table), static_cast<int>(index), std::move(key), std::move(message)});
  }

  std::string hint(std::string_view name) const {
    constexpr std::size_t most = 2000;  // more names than a person can have mistyped
    return names_.names().size() > most ? "" : did_you_mean(name, names_.names());
  }

  const Vec3& position_of(const std::string& node) const {
    return spec_.nodes[static_cast<std::size_t>(names_.find(node))].position;
  }

  // A CSV file may name what no scene file could: there such a text is an expression.
  void check_text(const char* table, std::size_t i, const char* key, const std::string& text) {
    if (text.starts_with('='))
      add(table, i, key, in_quotes(text) + " begins with =, as expressions do; give it another name");
  }

  void check_nodes() {
    if (spec_.nodes.empty())
      problems_.push_back({"nodes", -1, "", "a custom structure needs nodes: [[structure.nodes]]"});
    for (std::size_t i = 0; i < spec_.nodes.size() && !full(); ++i) {
      const auto& node = spec_.nodes[i];
      const int first = names_.add(node.name);
      if (node.name.empty()) {
        add("nodes", i, "name", "a node needs a name");
      } else if (first >= 0) {
        add("nodes", i, "name",
            "there is already a node " + in_quotes(node.name) + ", entry " + std::to_string(first));
      }
      check_text("nodes", i, "name", node.name);
      if (!node.position.allFinite()) add("nodes", i, "position", "must be finite");
      if (!node.velocity.allFinite()) add("nodes", i, "velocity", "must be finite");
      if (!(node.mass >= 0.0) || std::isinf(node.mass)) add("nodes", i, "mass", "must be >= 0 kg");
    }
  }

  void check_rods() {
    std::unordered_map<std::string, std::size_t> seen;
    for (std::size_t i = 0; i < spec_.rods.size() && !full(); ++i) {
      const auto& rod = spec_.rods[i];
      check_text("rods", i, "name", rod.name);
      check_text("rods", i, "group", rod.group);
      check_rod_mass(rod, i);
      check_rod_length(rod, i);
      check_rod_material(rod, i);
      if (!check_rod_nodes(rod, i)) continue;
      const std::string name = rod_name(rod);
      if (const auto [first, is_new] = seen.try_emplace(name, i); !is_new)
        add("rods", i, "name",
            "there is already a rod " + in_quotes(name) + ", entry " + std::to_string(first->second) +
                "; give this one a name of its own");
    }
  }

  // What is asked of elastic rods needs some.
  void check_rod_model() {
    const RodMaterial& all = spec_.material;
    const bool any = std::any_of(spec_.rods.begin(), spec_.rods.end(), [&](const CustomRod& rod) {
      return rod.area > 0.0 && std::isfinite(modulus_of(rod));
    });
    if (all.rod_model != "rigid" && !any)
      problems_.push_back(
          {"rod_model", -1, "",
           "\"" + all.rod_model + "\" needs rods with an area, in m^2, and a youngs_modulus, in Pa"});
  }

  double modulus_of(const CustomRod& rod) const {
    return std::isnan(rod.youngs_modulus) ? spec_.material.youngs_modulus : rod.youngs_modulus;
  }

  bool check_rod_nodes(const CustomRod& rod, std::size_t i) {
    if (rod.nodes.size() != 2) {
      add("rods", i, "nodes", "a rod joins 2 nodes; got " + std::to_string(rod.nodes.size()));
      return false;
    }
    bool known = true;
    for (const auto& name : rod.nodes) {
      if (names_.find(name) >= 0) continue;
      add("rods", i, "nodes", "there is no node " + in_quotes(name) + hint(name));
      known = false;
    }
    if (!known) return false;
    if (rod.nodes[0] == rod.nodes[1]) {
      add("rods", i, "nodes", "a rod from " + in_quotes(rod.nodes[0]) + " to itself");
      return false;
    }
    const Vec3 &a = position_of(rod.nodes[0]), &b = position_of(rod.nodes[1]);
    if (!a.allFinite() || !b.allFinite()) return true;  // the node is reported
    const double length = (a - b).stableNorm();
    if (length == 0.0)
      add("rods", i, "nodes",
          "zero length: " + in_quotes(rod.nodes[0]) + " and " + in_quotes(rod.nodes[1]) +
              " have the same position");
    else if (!(length * length > 0.0) || !std::isfinite(length * length))
      add("rods", i, "nodes", "the square of its length is outside the range of double precision");
    return true;
  }

  void check_rod_length(const CustomRod& rod, std::size_t i) {
    if (!(rod.length >= 0.0) || std::isinf(rod.length))
      add("rods", i, "length", "must be > 0 m; leave it out for the distance of its nodes");
  }

  // A modulus acts on an area; what has neither mass nor area is a distance that nothing stretches.
  void check_rod_material(const CustomRod& rod, std::size_t i) {
    if (rod.youngs_modulus <= 0.0) add("rods", i, "youngs_modulus", "must be > 0 Pa");
    if (rod.strength <= 0.0) add("rods", i, "strength", "must be > 0 Pa");
    if (!(rod.second_moment >= 0.0) || std::isinf(rod.second_moment))
      add("rods", i, "second_moment", "must be >= 0 m^4; 0: that of the section");
    if (!(rod.free_length >= 0.0) || std::isinf(rod.free_length))
      add("rods", i, "free_length", "must be > 0 m");
    check_rod_model_of(rod, i);
    if (rod.segments > 1 && !(rod.area > 0.0 && std::isfinite(modulus_of(rod))))
      add("rods", i, "segments", "a rod that bends needs its area, in m^2, and a youngs_modulus, in Pa");
    const bool meant =
        std::isfinite(rod.youngs_modulus) ||
        (std::isnan(rod.youngs_modulus) && spec_.material.elastic() && rod.mass.value_or(0.0) > 0.0);
    if (meant && !(rod.area > 0.0))
      add("rods", i, "area", "a rod with a youngs_modulus needs its area, in m^2");
    if (!(rod.area > 0.0) || std::isinf(rod.area)) return;
    try {
      section_shape(spec_.material, rod.area);
    } catch (const StructureError& error) {
      add("rods", i, "area", error.message);
    }
  }

  void check_rod_model_of(const CustomRod& rod, std::size_t i) {
    const bool known = rod.area > 0.0 && std::isfinite(modulus_of(rod));
    const bool gives = gives_in_motion(spec_.material, rod) && (rod.elastic.has_value() || known);
    if (gives && !known)
      return add("rods", i, rod.area > 0.0 ? "youngs_modulus" : "area",
                 "an elastic rod needs its area, in m^2, and a youngs_modulus, in Pa");
    if (rod.free_length > 0.0 && !gives)
      add("rods", i, "free_length", "is for elastic rods; a rigid one has its length");
    if (rod.free_length > 0.0 && rod.length > 0.0)
      add("rods", i, "free_length",
          "give length, where nodes are moved to fit, or free_length, where they stay, not both");
    if (gives && spec_.material.damping_ratio > 0.0 && rod.mass == 0.0)
      add("rods", i, "mass", "damping_ratio needs the mass of an elastic rod; damping_time does not");
  }

  void check_rod_mass(const CustomRod& rod, std::size_t i) {
    const bool section = rod.density > 0.0 && rod.area > 0.0;
    if (rod.mass && !std::isfinite(*rod.mass))
      add("rods", i, "mass", "must be finite");
    else if (rod.mass && *rod.mass < 0.0)
      add("rods", i, "mass", "must be >= 0 kg");
    else if (!rod.mass && !section)
      add("rods", i, "mass", "give mass (0: a pure distance constraint), or both density and area");
  }

  const CustomSpec& spec_;
  std::vector<CustomProblem> problems_;
  NameIndex names_;
};

}  // namespace

std::vector<CustomProblem> check_custom(const CustomSpec& spec) {
  return Checker(spec).run();
}

}  // namespace unfurl
