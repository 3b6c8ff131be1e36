// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// The round rods of a family: `density` and `section_area` of its parameters.
struct RodSection {
  double mass_per_length = 0.0;  // [kg/m]
  double radius = 0.0;           // [m]
};
RodSection rod_section(const ParamSet& params);
ParamSpec density_param();
// The same parameter without its largest value, and without both ends of its range.
ParamSpec below_max(ParamSpec spec);
ParamSpec inside(ParamSpec spec);
ParamSpec section_area_param(double fallback);  // fallback [m^2]

// Whether a motion from fold_angle to deployed_angle [deg] is one: by more than 1e-9 rad.
bool unfolds(double fold_angle, double deployed_angle);
// Throws StructureError unless it is.
void require_unfolding(double fold_angle, double deployed_angle);

// Puts a structure together from its nodes at t = 0. Node arguments are indices; constraints hold what the
// positions fulfil.
class Assembly {
 public:
  int node(std::string name, const Vec3& position, double mass = 0.0, const Vec3& velocity = Vec3::Zero());
  // A rod "A-B" with the given length, the distance of its nodes up to round-off.
  void rod(int a, int b, double length, double mass, std::string_view group, double radius);

  // A massless rod "brace A-B" of the group "brace", which makes its neighbours one rigid body.
  void brace(int a, int b, double length);

  void fix(int node);
  void plane(int node, const Vec3& normal);    // a unit normal
  void line(int node, const Vec3& direction);  // any length but 0
  // sum_i vectors[i] . x_{nodes[i]} keeps its value.
  void relation(std::string name, std::vector<int> nodes, std::vector<Vec3> vectors);
  // x_point = (1 - share) x_a + share x_b: three relations, which make `point` a point of the rod ab.
  void point_of_rod(int point, int a, int b, double share = 0.5);
  // Rods ab and cd cross at their middles, where the massless node `pin` holds them together: it is the
  // middle of ab (eliminated in any case), and x_a + x_b = x_c + x_d, which concerns the rods' ends only.
  void pin_middles(int pin, int a, int b, int c, int d);
  // Four nodes stay in one plane, which moves with them.
  void coplanar(std::vector<int> nodes, std::string name);
  void load(int node, const Vec3& force);

  const Vec3& position(int node) const;
  const std::string& name(int node) const;

  Structure structure;

 private:
  void constrain(const char* kind, int node, const Vec3& direction);
};

// Takes the braces out of what is shown, after show_as_solved.
void hide_braces(Structure& structure);
// Braces that only hold the shape of a link are not shown, and who names the rods that are to be warmed does
// not know of them. One that closes a triangle with two rods that warm alike warms with these: the link grows
// and keeps its angles. A note where others of a link that warms stay cold, which bends it.
void warm_braces(Structure& structure);

}  // namespace unfurl
