// A mechanism that a person lists node by node.
#pragma once

#include <string>
#include <vector>

#include "core/model/structure.hpp"

namespace unfurl {

struct CustomNode {
  std::string name;
  Vec3 position = Vec3::Zero();  // [m]
  Vec3 velocity = Vec3::Zero();  // [m/s]
  double mass = 0.0;             // [kg]
  bool fixed = false;
};

struct CustomRod {
  std::string name;                  // empty: "A-B" from its nodes
  std::vector<std::string> nodes;    // two names
  double mass = -1.0;                // [kg]; negative: density * area * length
  double density = 0.0;              // [kg/m^3]
  double area = 0.0;                 // [m^2]
  std::string group = "rod";
};

struct CustomConstraint {
  std::string kind;
  std::vector<std::string> nodes;  // names or globs
  Vec3 normal = Vec3::Zero();      // plane: its normal; line: its direction
};

struct CustomSpec {
  std::vector<CustomNode> nodes;
  std::vector<CustomRod> rods;
  std::vector<CustomConstraint> constraints;
  bool lumped_mass = false;
};

// All that is wrong, each entry with the place in the spec ("rods[3].nodes") and the cure; empty: `build_custom` works.
struct CustomProblem {
  std::string table;  // "nodes", "rods", "constraints"
  int index = -1;     // entry of the table; -1: the table itself
  std::string key;    // "nodes", "position", ...
  std::string message;
};
std::vector<CustomProblem> check_custom(const CustomSpec& spec);
Structure build_custom(const CustomSpec& spec);

// Does `name` match `pattern` with * and ?
bool glob_match(std::string_view pattern, std::string_view name);

}  // namespace unfurl
