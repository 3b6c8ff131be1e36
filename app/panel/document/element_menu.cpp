// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/document/element_menu.hpp"

#include <algorithm>

#include "core/scene/elements.hpp"

namespace unfurl {

namespace {

const std::vector<ElementOffer>& known_offers() {
  static const std::vector<ElementOffer> rows = {
      {"loads", "", "Load", "a constant force on nodes"},
      {"constraints", "angle", "Motor", "turns a hinge, or the fold, smoothly to an angle in a given time"},
      {"constraints", "length", "Actuator", "brings two nodes to a distance in a given time"},
      {"constraints", "coordinate", "Linear drive", "moves a node along a direction in a given time"},
      {"constraints", "angle_stop", "Hinge stop",
       "an angle cannot leave its limits; what hits them rebounds"},
      {"constraints", "length_stop", "Distance stop", "two nodes come no nearer, or no farther, than this"},
      {"constraints", "coordinate_stop", "Floor or wall",
       "a node cannot pass a plane; what hits it rebounds"},
      {"constraints", "fixed", "Support", "holds nodes where they are"},
      {"constraints", "line", "Rail", "guides nodes along a line"},
      {"constraints", "plane", "Slide plane", "keeps nodes in a plane"},
      {"forces", "spring", "Spring", "pulls or pushes two nodes to its rest length, with damping"},
      {"forces", "spring", "Cable", "a spring that only pulls", "tension_only = true"},
      {"forces", "cable", "Cable over pulleys",
       "runs over nodes in order, elastic, or paid out and drawn in"},
      {"forces", "motor", "Geared motor", "turns a hinge, or the fold, with a torque and speed of its own"},
      {"forces", "friction", "Dry friction", "a hinge, a distance or a coordinate sticks or slips"},
      {"forces", "offload", "Gravity offload", "nodes hang with their weight on ropes, as in a laboratory"},
      {"constraints", "clearance", "Pin with play", "two nodes stay within a distance of each other"},
      {"forces", "torsion_spring", "Hinge spring", "turns a hinge, or the fold, to its rest angle"},
      {"forces", "joint_damping", "Hinge damper", "a viscous torque between the rods that meet at a node"},
      {"forces", "follower", "Thruster", "a force along a rod that turns with it"},
      {"forces", "drag", "Drag", "a viscous force on nodes"},
      {"forces", "load_over_time", "Load over time", "a force on nodes that changes with time"},
      {"forces", "latch", "Elastic latch", "holds the deployed pose with a stiffness, and tells its load"}};
  return rows;
}

}  // namespace

std::vector<ElementOffer> element_offers(std::string_view table) {
  std::vector<ElementOffer> offers;
  if (table == "loads") return {known_offers().front()};
  const auto& kinds = table == "forces" ? scene_forces() : scene_constraints();
  for (const ElementOffer& offer : known_offers())
    if (offer.table == table) offers.push_back(offer);
  for (const ElementKind& kind : kinds) {
    if (std::any_of(offers.begin(), offers.end(), [&](const auto& o) { return o.kind == kind.kind; }))
      continue;
    std::string name(kind.kind);
    std::replace(name.begin(), name.end(), '_', ' ');
    name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    offers.push_back({table, kind.kind, std::move(name), std::string(kind.help)});
  }
  return offers;
}

}  // namespace unfurl
