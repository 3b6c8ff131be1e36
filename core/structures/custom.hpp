// SPDX-License-Identifier: BSD-3-Clause
// A mechanism that a person lists node by node.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/structure/structure.hpp"
#include "core/structures/rod_material.hpp"

namespace unfurl {

struct CustomNode {
  std::string name;
  Vec3 position = Vec3::Zero();  // [m]
  Vec3 velocity = Vec3::Zero();  // [m/s]
  double mass = 0.0;             // [kg]
  bool fixed = false;
};

struct CustomRod {
  std::string name;                 // empty: "A-B" from its nodes
  std::vector<std::string> nodes;   // two names
  std::optional<double> mass = {};  // [kg]; none: density * area * length
  double density = 0.0;             // [kg/m^3]
  double area = 0.0;                // [m^2]
  std::string group = "rod";
  double length = 0.0;  // [m]; 0: the distance of its nodes
  // In place of those of all rods (RodMaterial); NaN: not given.
  double youngs_modulus = std::numeric_limits<double>::quiet_NaN();  // [Pa]
  double strength = std::numeric_limits<double>::quiet_NaN();        // [Pa]
  double second_moment = 0.0;                                        // [m^4]; 0: that of the section
  std::optional<bool> elastic = {};  // it gives in the motion; none: as rod_model says of all rods
  long segments = 0;                 // that it is cut into; 0: as all rods with a modulus
  double free_length = 0.0;          // of one that gives: without force, from t = 0; 0: length [m]
};

struct CustomSpec {
  std::vector<CustomNode> nodes;
  std::vector<CustomRod> rods;
  bool lumped_mass = false;
  RodMaterial material = {};  // of all rods that have an area
};

struct CustomProblem {
  std::string table;  // "nodes", "rods"
  int index = -1;     // entry of the table; -1: the table itself
  std::string key;    // "nodes", "position", ...
  std::string message;
};

// All that is wrong, each with its place in the spec and the cure; empty: `build_custom` works. Stops after
// 100.
std::vector<CustomProblem> check_custom(const CustomSpec& spec);

// Nodes in the spec's order; the rods' lengths are those given, else the distances of their nodes. Throws
// StructureError with the first problem where check_custom has any.
Structure build_custom(const CustomSpec& spec);

// Whether a rod that has an area and a modulus gives in the motion.
bool gives_in_motion(const RodMaterial& all, const CustomRod& rod);

// The name a rod goes by: its own, or "A-B" from its nodes.
std::string rod_name(const CustomRod& rod);

}  // namespace unfurl
