// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/hoop_joints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/structures/assembly.hpp"
#include "core/structures/ring.hpp"

namespace unfurl {

namespace {

// Nodes of unit k are 4 k + these; the last post of an arc follows behind all units.

int posts(const HoopShape& s) {
  return s.closed() ? s.n : s.n + 1;
}
int next_post(const HoopShape& s, int k) {
  return 4 * (s.closed() ? (k + 1) % s.n : k + 1);
}

void add_post(Assembly& a, const HoopShape& s, int k) {
  const std::string i = std::to_string(k);
  const Vec3 at = s.ring_radius() * radial(s.corner_angle(k)), half = 0.5 * s.l2 * Vec3::UnitZ();
  a.node("B" + i, at - half);
  a.node("T" + i, at + half);
}

void add_hinges(Assembly& a, const HoopShape& s, int k) {
  const std::string i = std::to_string(k);
  const Vec3 at = s.ring_radius() * std::cos(s.half_angle()) * radial(s.hinge_angle(k));
  const Vec3 height = (s.l1 * s.sine - 0.5 * s.l2) * Vec3::UnitZ();
  const double force = k == s.perturbed_unit ? s.perturbed_force : s.hinge_force;
  a.load(a.node("Mb" + i, at + height), -force * Vec3::UnitZ());
  a.load(a.node("Mt" + i, at - height), force * Vec3::UnitZ());
}

void add_face(Assembly& a, const HoopShape& s, int k) {
  const int first = 4 * k, next = next_post(s, k);
  for (const int level : {bottom_corner, top_corner}) {
    const int corner = first + level, hinge = first + bottom_hinge + level, other = next + level;
    a.rod(corner, hinge, s.l1, s.chord_mass, "chord", s.radius);
    a.rod(hinge, other, s.l1, s.chord_mass, "chord", s.radius);
    a.coplanar({corner, other, first + (1 - level), hinge}, "face of " + a.name(hinge));
  }
}

void make_parallel(Assembly& a, int post) {
  constexpr const char* axes[] = {" x", " y", " z"};
  const std::string name = a.name(post) + "-" + a.name(post + 1);
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = Vec3::Unit(k);
    a.relation("post " + name + " parallel to B0-T0" + axes[k], {post, post + 1, 0, 1}, {-e, e, e, -e});
  }
}

// Means over the units: of the heights of the hinges in their chords, and of the chords along their
// directions at the start. Where units deploy unlike each other it is their mean fold angle.
void set_deployment(Structure& out, const HoopShape& s) {
  Deployment& d = out.deployment;
  const Vec3 up = Vec3::UnitZ() / (2.0 * s.n * s.l1);
  for (int k = 0; k < s.n; ++k) {
    const int first = 4 * k, next = next_post(s, k);
    const Vec3 along = tangential(s.hinge_angle(k)) / (4.0 * s.n * s.l1);
    for (const int level : {0, 1}) {
      const Vec3 sign = level == 0 ? up : Vec3(-up);
      for (const int node : {first + level, next + level}) {
        d.fold_sine.nodes.push_back(node);
        d.fold_sine.coefficients.push_back(-0.5 * sign);
        d.fold_cosine.nodes.push_back(node);
        d.fold_cosine.coefficients.push_back(node == first + level ? Vec3(-along) : along);
      }
      d.fold_sine.nodes.push_back(first + bottom_hinge + level);
      d.fold_sine.coefficients.push_back(sign);
      const Vec3 half = 0.5 * Vec3::UnitZ();
      d.parts.push_back(
          {{first + bottom_hinge + level, first + level, next + level}, {2 * half, -half, -half}, 0.0});
    }
  }
  d.initial_fold_angle = std::atan2(s.sine, s.cosine);
}

// Do the loads of all units agree, along the axis?
bool loaded_alike(const Structure& s) {
  std::vector<double> force(s.nodes.size(), 0.0);
  for (const Load& load : s.loads) {
    if (load.force.x() != 0 || load.force.y() != 0) return false;
    force[static_cast<std::size_t>(load.node)] += load.force.z();
  }
  for (std::size_t i = 4; i < force.size(); ++i)
    if (force[i] != force[i - 4]) return false;
  return true;
}

// Rods of one group have one length at any time.
bool made_alike(const Structure& s) {
  constexpr double round_off = 1e-12;
  return std::ranges::all_of(s.rods, [&](const Rod& rod) {
    const auto first = std::ranges::find(s.rods, rod.group, &Rod::group);
    const auto same = [](double a, double b) { return std::abs(a - b) <= round_off * b; };
    return same(rod.length, first->length) && same(rod.natural_length(), first->natural_length()) &&
           rod.expansion == first->expansion && (rod.expansion == 0 || rod.warming == first->warming);
  });
}

// Constraints that the ring has by itself, or that drive all its units as one.
bool constrained_alike(const Structure& s) {
  const auto alike = [](const Constraint& c) {
    return c.kind == "coplanar" || (c.kind == "relation" && c.name.starts_with("post ")) ||
           (c.kind == "measure" && c.measure.kind == MeasureKind::fold);
  };
  return !s.constraints.empty() && s.constraints.front().kind == "coplanar" &&
         std::all_of(s.constraints.begin(), s.constraints.end(), alike);
}

}  // namespace

bool driven_evenly(const Structure& s) {
  const std::size_t n = s.nodes.size() / 4;
  const bool ring = s.kind == "hoop" && s.nodes.size() == 4 * n && s.rods.size() == 5 * n;  // no arc
  return ring && made_alike(s) && s.forces.empty() && s.stops.empty() && s.gravity.x() == 0 &&
         s.gravity.y() == 0 && constrained_alike(s) && loaded_alike(s);
}

double unevenness(const Structure& s, const ConstVec& q) {
  const std::size_t n = s.nodes.size() / 4;
  const auto corner = [&](std::size_t k) { return q.segment<3>(static_cast<Index>(12 * (k % n))); };
  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), most = -least;
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector2d height_and_side(corner(k).z(), (corner(k + 1) - corner(k)).norm());
    least = least.cwiseMin(height_and_side);
    most = most.cwiseMax(height_and_side);
  }
  return (most - least).maxCoeff() / s.rods.front().length;
}

Structure build_hoop_joints(const HoopShape& s) {
  Assembly a;
  for (int k = 0; k < s.n; ++k) {
    add_post(a, s, k);
    add_hinges(a, s, k);
  }
  if (!s.closed()) add_post(a, s, s.n);
  for (int k = 0; k < s.n; ++k) add_face(a, s, k);
  for (int k = 0; k < posts(s); ++k) {
    a.rod(4 * k, 4 * k + 1, s.l2, s.post_mass, "post", s.radius);
    if (k > 0) make_parallel(a, 4 * k);
  }
  set_deployment(a.structure, s);
  show_as_solved(a.structure);
  return a.structure;
}

}  // namespace unfurl
