// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/assembly.hpp"

#include <cmath>
#include <utility>

#include "core/structure/structure_error.hpp"

namespace unfurl {

RodSection rod_section(const ParamSet& params) {
  const double area = params.real("section_area");
  return {params.real("density") * area, std::sqrt(area / pi)};
}

ParamSpec below_max(ParamSpec spec) {
  spec.max_open = true;
  return spec;
}

ParamSpec inside(ParamSpec spec) {
  spec.min_open = true;
  return below_max(std::move(spec));
}

ParamSpec density_param() {
  return positive_param("density", "kg/m^3", 2700.0, "density of the rods");
}

ParamSpec section_area_param(double fallback) {
  return positive_param("section_area", "m^2", fallback, "cross section of the rods");
}

bool unfolds(double fold_angle, double deployed_angle) {
  return (fold_angle - deployed_angle) * radians_per_degree > 1e-9;
}

void require_unfolding(double fold_angle, double deployed_angle) {
  if (unfolds(fold_angle, deployed_angle)) return;
  if (deployed_angle == 0.0)  // of families without that key, too
    throw StructureError("fold_angle",
                         "fold_angle must be larger than 0 degrees, at which the structure is deployed");
  throw StructureError("deployed_angle",
                       "deployed_angle must be smaller than fold_angle, at which the motion starts");
}

void hide_braces(Structure& structure) {
  std::erase_if(structure.rod_copies, [&](const RodCopy& copy) {
    return structure.rods[static_cast<std::size_t>(copy.source)].group == "brace";
  });
}

int Assembly::node(std::string name, const Vec3& position, double mass, const Vec3& velocity) {
  structure.nodes.push_back({std::move(name), position, velocity, mass});
  return static_cast<int>(structure.nodes.size()) - 1;
}

void Assembly::rod(int a, int b, double length, double mass, std::string_view group, double radius) {
  structure.rods.push_back({name(a) + "-" + name(b), a, b, mass, length, std::string(group), radius, 1.0});
}

void Assembly::brace(int a, int b, double length) {
  rod(a, b, length, 0.0, "brace", 0.0);
  structure.rods.back().name.insert(0, "brace ");
}

void Assembly::constrain(const char* kind, int node, const Vec3& direction) {
  Constraint constraint{kind, std::string(kind) + " of " + name(node), {node}, {}, 0.0};
  if (!direction.isZero(0.0)) {
    constraint.vectors = {direction};
    constraint.value = direction.dot(position(node));
  }
  structure.constraints.push_back(std::move(constraint));
}

void Assembly::fix(int node) {
  constrain("fixed", node, Vec3::Zero());
}

void Assembly::plane(int node, const Vec3& normal) {
  constrain("plane", node, normal);
  structure.constraints.back().symmetry = true;
}

void Assembly::line(int node, const Vec3& direction) {
  constrain("line", node, direction);
}

void Assembly::relation(std::string name, std::vector<int> nodes, std::vector<Vec3> vectors) {
  double value = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) value += vectors[i].dot(position(nodes[i]));
  structure.constraints.push_back({"relation", std::move(name), std::move(nodes), std::move(vectors), value});
}

void Assembly::point_of_rod(int point, int a, int b, double share) {
  constexpr const char* axes[] = {" x", " y", " z"};
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = Vec3::Unit(k);
    structure.constraints.push_back({"relation",
                                     name(point) + " on rod " + name(a) + "-" + name(b) + axes[k],
                                     {point, a, b},
                                     {e, -(1.0 - share) * e, -share * e},
                                     0.0});
  }
}

void Assembly::pin_middles(int pin, int a, int b, int c, int d) {
  constexpr const char* axes[] = {" x", " y", " z"};
  point_of_rod(pin, a, b);
  for (int k = 0; k < 3; ++k) {
    const Vec3 half = 0.5 * Vec3::Unit(k);
    structure.constraints.push_back({"relation",
                                     name(pin) + " on rod " + name(c) + "-" + name(d) + axes[k],
                                     {a, b, c, d},
                                     {half, half, -half, -half},
                                     0.0});
  }
}

void Assembly::coplanar(std::vector<int> nodes, std::string name) {
  structure.constraints.push_back({"coplanar", std::move(name), std::move(nodes), {}, 0.0});
}

void Assembly::load(int node, const Vec3& force) {
  if (!force.isZero(0.0)) structure.loads.push_back({node, force, true});
}

const Vec3& Assembly::position(int node) const {
  return structure.nodes[static_cast<std::size_t>(node)].position;
}

const std::string& Assembly::name(int node) const {
  return structure.nodes[static_cast<std::size_t>(node)].name;
}

namespace {

bool warm_alike(const Rod& a, const Rod& b) {
  const TimeFunction &f = a.warming, &g = b.warming;
  return a.expansion == b.expansion && f.kind == g.kind && f.offset == g.offset && f.times == g.times &&
         f.values == g.values;
}

// Of a brace a-b, by its third corner: what joins it to a and to b.
struct Triangle {
  const Rod* to_a;
  const Rod* to_b;
};

std::vector<Triangle> triangles_of(const Structure& structure, const std::vector<std::vector<int>>& rods_at,
                                   const Rod& brace) {
  std::vector<Triangle> found;
  const auto rod = [&](int r) { return &structure.rods[static_cast<std::size_t>(r)]; };
  const auto other_end = [](const Rod& r, int node) { return r.a == node ? r.b : r.a; };
  for (const int first : rods_at[static_cast<std::size_t>(brace.a)])
    for (const int second : rods_at[static_cast<std::size_t>(brace.b)])
      if (const int c = other_end(*rod(first), brace.a);
          c != brace.b && c == other_end(*rod(second), brace.b))
        found.push_back({rod(first), rod(second)});
  return found;
}

}  // namespace

void warm_braces(Structure& structure) {
  if (std::ranges::none_of(structure.rods, [](const Rod& rod) { return rod.expansion != 0; })) return;
  const std::vector<char> shown = shown_rods(structure);
  std::vector<std::vector<int>> rods_at(structure.nodes.size());
  std::vector<Rod*> cold;
  for (std::size_t r = 0; r < structure.rods.size(); ++r) {
    Rod& rod = structure.rods[r];
    for (const int end : {rod.a, rod.b})
      rods_at[static_cast<std::size_t>(end)].push_back(static_cast<int>(r));
    if (!shown[r] && rod.mass == 0 && rod.expansion == 0) cold.push_back(&rod);
  }
  // One that is warmed may close the triangle of the next.
  for (bool again = true; again;) {
    again = false;
    std::erase_if(cold, [&](Rod* brace) {
      for (const auto& [to_a, to_b] : triangles_of(structure, rods_at, *brace)) {
        if (to_a->expansion == 0 || !warm_alike(*to_a, *to_b)) continue;
        brace->expansion = to_a->expansion;
        brace->warming = to_a->warming;
        return again = true;
      }
      return false;
    });
  }
  const auto warm_at = [&](int node) {
    return std::ranges::any_of(rods_at[static_cast<std::size_t>(node)], [&](int r) {
      return structure.rods[static_cast<std::size_t>(r)].expansion != 0;
    });
  };
  std::erase_if(cold, [&](const Rod* brace) {
    const std::vector<Triangle> triangles = triangles_of(structure, rods_at, *brace);
    if (triangles.empty()) return !warm_at(brace->a) && !warm_at(brace->b);  // of rods that are cut to bend
    return std::ranges::none_of(
        triangles, [](const Triangle& t) { return t.to_a->expansion != 0 || t.to_b->expansion != 0; });
  });
  if (cold.empty()) return;
  structure.notes.push_back(
      std::to_string(cold.size()) +
      " braces that hold the shape of links, which are not shown, stay cold beside rods "
      "that are warmed, and bend their links: " +
      cold.front()->name + (cold.size() > 1 ? " and others" : "") +
      "; a temperature of rods = [\"brace\"] warms them");
}

}  // namespace unfurl
