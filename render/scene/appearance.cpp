// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/appearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/structure/shown_lines.hpp"
#include "render/scene/look.hpp"

namespace unfurl {
namespace {

constexpr double visible_radius = 0.0065;  // of the motion's radius: some six pixels of a 1280 x 720 picture
constexpr double slender = 1.0 / 20.0;     // a rod is never drawn thicker than this part of its length
constexpr double unknown_radius = 1.0 / 60.0;  // of the median length, for rods that have none

// The rods that there are before some are cut to bend: of those the first part.
std::vector<const Rod*> whole_rods(const Structure& s) {
  std::vector<const Rod*> out;
  for (std::size_t i = 0; i < s.rods.size(); ++i)
    if (s.rods[i].whole.empty() || i == 0 || s.rods[i - 1].whole != s.rods[i].whole)
      out.push_back(&s.rods[i]);
  return out;
}

double median_length(const Structure& s) {
  std::vector<double> lengths;
  for (const Rod* rod : whole_rods(s)) lengths.push_back(rod->pinned_length());
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

double drawn_radius(const Rod& rod, double median, double size, double rod_scale) {
  const double wanted = rod.radius > 0 ? rod.radius : unknown_radius * median;
  if (rod_scale > 0) return rod_scale * wanted;
  return std::max(wanted, std::min(visible_radius * size, slender * rod.pinned_length()));
}

void note_scale(const Structure& s, Appearance& looks) {
  double least = std::numeric_limits<double>::infinity(), largest = 0;
  for (const RodCopy& copy : s.rod_copies) {
    const auto i = static_cast<std::size_t>(copy.source);
    if (!(s.rods[i].radius > 0)) continue;
    least = std::min(least, looks.rod_radius[i] / s.rods[i].radius);
    largest = std::max(largest, looks.rod_radius[i] / s.rods[i].radius);
  }
  if (largest > 0) looks.least_scale = least, looks.largest_scale = largest;
}

int group_index(std::vector<std::string>& groups, const std::string& group) {
  const auto index = std::find(groups.begin(), groups.end(), group) - groups.begin();
  if (index == std::ssize(groups)) groups.push_back(group);
  return static_cast<int>(index);
}

// Nodes at which no rod ends but that lie on rods, the pins of scissors: a little smaller than a joint.
void add_pins(const Structure& s, Appearance& looks) {
  std::vector<double> on_rods(s.nodes.size(), 0.0);
  for (const Constraint& c : s.constraints) {
    if (c.kind != "relation" || c.nodes.empty()) continue;
    for (const int node : c.nodes) on_rods[static_cast<std::size_t>(node)] = 1.0;
  }
  const double thickest = looks.rod_radius.empty() ? 0.0 : *std::ranges::max_element(looks.rod_radius);
  for (std::size_t i = 0; i < s.node_copies.size(); ++i)
    if (looks.joint_radius[i] <= 0)
      looks.joint_radius[i] = 1.5 * thickest * on_rods[static_cast<std::size_t>(s.node_copies[i].source)];
}

// Nodes at which no rod ends but that are something: held, a mass, what cables and springs hang on or pull
// at. As large as the middle one of all joints, or as can be seen.
void add_bare_nodes(const Structure& s, Appearance& looks) {
  std::vector<double> known;
  for (const double r : looks.joint_radius)
    if (r > 0) known.push_back(r);
  double usual = 1.75 * looks.bare_radius;
  if (!known.empty()) {
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), middle, known.end());
    usual = *middle;
  }
  looks.bare.assign(s.node_copies.size(), false);
  const auto mark = [&](std::size_t i) { looks.bare[i] = looks.joint_radius[i] <= 0; };
  for (const ShownLine& line : lines_between_nodes(s))
    for (const int end : {line.a, line.b}) mark(static_cast<std::size_t>(end));
  for (std::size_t i = 0; i < s.node_copies.size(); ++i)
    if (looks.fixed[i] || s.nodes[static_cast<std::size_t>(s.node_copies[i].source)].mass > 0) mark(i);
  for (std::size_t i = 0; i < s.node_copies.size(); ++i)
    if (looks.bare[i]) looks.joint_radius[i] = usual;
}

// Nodes with a mass of their own, bobs and payloads, have larger balls: by the cube root of it, up to two and
// a half times.
void enlarge_masses(const Structure& s, Appearance& looks) {
  double rods = 0;
  const std::vector<const Rod*> wholes = whole_rods(s);
  for (const Rod* rod : wholes) rods += rod->parts * rod->mass / static_cast<double>(wholes.size());
  for (std::size_t i = 0; i < s.node_copies.size(); ++i) {
    const double mass = s.nodes[static_cast<std::size_t>(s.node_copies[i].source)].mass;
    if (mass > 0) looks.joint_radius[i] *= 1.0 + std::min(1.5, std::cbrt(mass / std::max(rods, 1e-3 * mass)));
  }
}

}  // namespace

Color group_color(std::size_t index) {
  return looks().front().group(index);
}

Color trail_color(const Look& look, const Appearance& looks) {
  return look.group(std::max<std::size_t>(looks.groups.size(), 3));
}

Appearance appearance_of(const Structure& s, double size, double rod_scale) {
  Appearance out;
  const double median = median_length(s);
  out.bare_radius = visible_radius * size;
  std::vector<bool> shown(s.rods.size(), false);
  for (const RodCopy& copy : s.rod_copies) shown[static_cast<std::size_t>(copy.source)] = true;
  for (std::size_t i = 0; i < s.rods.size(); ++i) {
    const Rod& rod = s.rods[i];
    out.rod_group.push_back(shown[i] ? group_index(out.groups, rod.group)
                                     : 0);  // hidden: no colour of its own
    out.rod_radius.push_back(drawn_radius(rod, median, size, rod_scale));
  }
  note_scale(s, out);
  out.joint_radius.assign(s.node_copies.size(), 0.0);
  for (const RodCopy& rod : s.rod_copies) {
    for (const int end : {rod.a, rod.b}) {
      double& joint = out.joint_radius[static_cast<std::size_t>(end)];
      joint = std::max(joint, 1.75 * out.rod_radius[static_cast<std::size_t>(rod.source)]);
    }
  }
  add_pins(s, out);
  std::vector<bool> held(s.nodes.size(), false);
  for (const Constraint& c : s.constraints) {
    if (c.kind != "fixed") continue;
    for (const int node : c.nodes) held[static_cast<std::size_t>(node)] = true;
  }
  for (const NodeCopy& copy : s.node_copies) out.fixed.push_back(held[static_cast<std::size_t>(copy.source)]);
  add_bare_nodes(s, out);
  enlarge_masses(s, out);
  for (const LoadCopy& load : s.load_copies)
    out.largest_force = std::max(out.largest_force, load.force.norm());
  out.arrow_length = median > 0 ? std::min(0.16 * size, 0.3 * median) : 0.16 * size;
  out.arrow_radius = 0.05 * out.arrow_length;
  return out;
}

}  // namespace unfurl
