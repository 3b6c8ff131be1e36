// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/hoop.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/structures/assembly.hpp"
#include "core/structures/hoop_joints.hpp"
#include "core/structures/hoop_shape.hpp"
#include "core/structures/ring.hpp"

namespace unfurl {
namespace {

// Nodes of unit k are 4 k + these.

void add_nodes(Structure& out, const HoopShape& s, int k) {
  const std::string i = std::to_string(k);
  const Vec3 up = Vec3::UnitZ();
  const Vec3 corner = s.ring_radius() * radial(s.corner_angle(k));
  const Vec3 hinge = s.ring_radius() * std::cos(s.half_angle()) * radial(s.hinge_angle(k));
  const double height = s.l1 * s.sine - s.l2 / 2;
  out.nodes.push_back({"B" + i, corner - s.l2 / 2 * up});
  out.nodes.push_back({"T" + i, corner + s.l2 / 2 * up});
  out.nodes.push_back({"Mb" + i, hinge + height * up});
  out.nodes.push_back({"Mt" + i, hinge - height * up});
  out.loads.push_back({4 * k + bottom_hinge, -s.hinge_force * up});
  out.loads.push_back({4 * k + top_hinge, s.hinge_force * up});
}

// Everything but the hinges' place in the face, which involves the next unit.
void add_symmetry(Structure& out, const HoopShape& s, int k) {
  const int first = 4 * k;
  for (int j = 0; j < 4; ++j) {
    const double angle = j < 2 ? s.corner_angle(k) : s.hinge_angle(k);
    out.constraints.push_back({"plane",
                               "plane of " + out.nodes[static_cast<std::size_t>(first + j)].name,
                               {first + j},
                               {tangential(angle)},
                               0.0,
                               {},
                               {},
                               true});
  }
  const Vec3 r = radial(s.corner_angle(k));
  const int b = first + bottom_corner, t = first + top_corner;
  const std::string post = "B" + std::to_string(k) + "-T" + std::to_string(k);
  out.constraints.push_back({"relation", "vertical post " + post, {b, t}, {-r, r}, 0.0});
  out.constraints.push_back(
      {"relation", "mirror " + post, {b, t}, {Vec3::UnitZ(), Vec3::UnitZ()}, 0.0, {}, {}, true});
}

Rod rod(const Structure& out, int a, int b, double mass, double length, const char* group, double radius) {
  const auto& nodes = out.nodes;
  return {nodes[static_cast<std::size_t>(a)].name + "-" + nodes[static_cast<std::size_t>(b)].name,
          a,
          b,
          mass,
          length,
          group,
          radius,
          1.0};
}

void set_deployment(Structure& out, const HoopShape& s, int units) {
  Deployment& d = out.deployment;
  const double c = 1.0 / (2.0 * units * s.l1);
  for (int k = 0; k < units; ++k) {
    const double sign[4] = {-c, c, c, -c};
    for (int j = 0; j < 4; ++j) {
      d.fold_sine.nodes.push_back(4 * k + j);
      d.fold_sine.coefficients.push_back(sign[j] * Vec3::UnitZ());
    }
    for (int j = 0; j < 2; ++j) {
      d.fold_cosine.nodes.push_back(4 * k + j);
      d.fold_cosine.coefficients.push_back(c * std::sin(s.half_angle()) * radial(s.corner_angle(k)));
    }
  }
  d.initial_fold_angle = std::atan2(s.sine, s.cosine);
  // Each hinge level with the corners beside it (in a sector the next corner is this one's image).
  for (int k = 0; k < units; ++k)
    for (int j = 0; j < 2; ++j)
      d.latches.push_back({{4 * k + 2 + j, 4 * k + j, 4 * ((k + 1) % units) + j},
                           {Vec3::UnitZ(), -0.5 * Vec3::UnitZ(), -0.5 * Vec3::UnitZ()},
                           0.0});
}

Structure build_full(const HoopShape& s) {
  Structure out;
  for (int k = 0; k < s.n; ++k) add_nodes(out, s, k);
  for (int k = 0; k < s.n; ++k) {
    add_symmetry(out, s, k);
    const int first = 4 * k, next = 4 * ((k + 1) % s.n);
    const Vec3 e = radial(s.hinge_angle(k));
    for (int level : {0, 1}) {
      const int a = first + level, m = first + bottom_hinge + level, b = next + level;
      out.constraints.push_back({"relation",
                                 "face of " + out.nodes[static_cast<std::size_t>(m)].name,
                                 {m, a, b},
                                 {e, -0.5 * e, -0.5 * e},
                                 0.0});
      out.rods.push_back(rod(out, a, m, s.chord_mass, s.l1, "chord", s.radius));
      out.rods.push_back(rod(out, m, b, s.chord_mass, s.l1, "chord", s.radius));
    }
    out.rods.push_back(
        rod(out, first + bottom_corner, first + top_corner, s.post_mass, s.l2, "post", s.radius));
  }
  set_deployment(out, s, s.n);
  show_as_solved(out);
  return out;
}

// The whole ring from the solved sector: node copies by rotation, in the order of the full model.
void replicate(Structure& out, const HoopShape& s) {
  out.sectors = s.n;
  const char* names[4] = {"B", "T", "Mb", "Mt"};
  for (int k = 0; k < s.n; ++k) {
    const Mat3 turn = Eigen::AngleAxisd(s.corner_angle(k), Vec3::UnitZ()).toRotationMatrix();
    for (int j = 0; j < 4; ++j)
      out.node_copies.push_back({names[j] + std::to_string(k), j, turn, Vec3::Zero()});
    for (const Load& load : out.loads) out.load_copies.push_back({4 * k + load.node, turn * load.force});
  }
  const auto copy = [&](int a, int b, int source) {
    const auto& nodes = out.node_copies;
    out.rod_copies.push_back(
        {nodes[static_cast<std::size_t>(a)].name + "-" + nodes[static_cast<std::size_t>(b)].name, a, b,
         source});
  };
  for (int k = 0; k < s.n; ++k) {
    const int first = 4 * k, next = 4 * ((k + 1) % s.n);
    for (int level : {0, 1}) {
      copy(first + level, first + bottom_hinge + level, level);
      copy(first + bottom_hinge + level, next + level, level);
    }
    copy(first + bottom_corner, first + top_corner, 2);
  }
}

Structure build_sector(const HoopShape& s) {
  Structure out;
  add_nodes(out, s, 0);
  add_symmetry(out, s, 0);
  const Vec3 e = radial(s.hinge_angle(0));
  for (int level : {0, 1}) {
    const int m = bottom_hinge + level;
    // The next corner is the mirror image of this one in the hinge's plane: their mean along e is this one's.
    out.constraints.push_back(
        {"relation", "face of " + out.nodes[static_cast<std::size_t>(m)].name, {m, level}, {e, -e}, 0.0});
    out.rods.push_back(rod(out, level, m, s.chord_mass, s.l1, "chord", s.radius));
    out.rods.back().multiplicity = 2.0;
  }
  out.rods.push_back(rod(out, bottom_corner, top_corner, s.post_mass, s.l2, "post", s.radius));
  set_deployment(out, s, 1);
  replicate(out, s);
  return out;
}

}  // namespace

const std::vector<ParamSpec>& hoop_params() {
  static const std::vector<ParamSpec> params{
      integer_param("units", 6, 3, 100000, "number of units around the ring"),
      positive_param("chord_rod_length", "m", 3.0, "length of a chord rod, half a chord"),
      positive_param("post_length", "m", 1.2, "length of a post"),
      positive_param("density", "kg/m^3", 3000.0, "density of the rods"),
      positive_param("section_area", "m^2", 9e-4, "cross section of the rods"),
      inside(real_param("fold_angle", "deg", 89.34053637766085, 0.0, 90.0,
                        "fold angle at t = 0; 0 is fully deployed")),
      real_param("hinge_force", "N", 200.0, -1e12, 1e12,
                 "the paper's f: -f along z on each bottom hinge, +f on each top hinge"),
      choice_param(
          "model", "full", {"full", "sector", "joints"},
          "full: every unit is solved, with planes of symmetry; sector: one, replicated; joints: every "
          "unit, floating free, symmetric or not"),
      choice_param("mass", "consistent", {"consistent", "lumped"}, "mass matrix of a rod"),
      boolean_param("closed", true, "true: a ring; false: an open arc (model joints)"),
      only_with("closed", {"false"},
                inside(real_param("arc_angle", "deg", 180.0, 0.0, 360.0,
                                  "angle that the units of an open arc span"))),
      integer_param("perturbed_unit", -1, -1, 99999,
                    "the unit, from 0, whose hinges perturbed_force drives (model joints); -1: none"),
      real_param("perturbed_force", "N", 0.0, -1e12, 1e12, "force on the hinges of perturbed_unit"),
  };
  return params;
}

Structure build_hoop(const ParamSet& params) {
  const HoopShape s = hoop_shape(params);
  const std::string& model = params.text("model");
  Structure out = model == "sector"   ? build_sector(s)
                  : model == "joints" ? build_hoop_joints(s)
                                      : build_full(s);
  out.kind = "hoop";
  if (s.perturbed_force != 0 && s.perturbed_unit < 0)
    out.notes.emplace_back("perturbed_force does nothing: perturbed_unit says which unit has it");
  out.lumped_mass = params.text("mass") == "lumped";
  return out;
}

}  // namespace unfurl
