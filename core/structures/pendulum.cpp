// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/pendulum.hpp"

#include <cmath>

#include "core/structure/structure_error.hpp"
#include "core/structures/assembly.hpp"

namespace unfurl {

const std::vector<ParamSpec>& pendulum_params() {
  static const std::vector<ParamSpec> params{
      positive_param("length", "m", 1.0, "length of the rod"),
      real_param("rod_mass", "kg", 1.0, 0.0, 1e12, "mass of the rod, spread along it"),
      real_param("bob_mass", "kg", 0.0, 0.0, 1e12, "mass at the tip"),
      real_param("angle", "deg", 90.0, -180.0, 180.0, "angle from the downward vertical at t = 0"),
      real_param("angle_rate", "deg/s", 0.0, -1e6, 1e6, "rate of the angle at t = 0"),
      real_param("azimuth_rate", "deg/s", 0.0, -1e6, 1e6,
                 "rate of the swing plane about the vertical at t = 0"),
  };
  return params;
}

Structure build_pendulum(const ParamSet& params) {
  const double l = params.real("length"), angle = params.real("angle") * radians_per_degree;
  const double rod_mass = params.real("rod_mass"), bob_mass = params.real("bob_mass");
  if (rod_mass + bob_mass <= 0)
    throw StructureError("rod_mass", "rod_mass and bob_mass are both 0: give one of them a mass");
  const Vec3 along(std::sin(angle), 0, -std::cos(angle)), across(std::cos(angle), 0, std::sin(angle));
  const Vec3 velocity =
      l * radians_per_degree *
      (params.real("angle_rate") * across + params.real("azimuth_rate") * std::sin(angle) * Vec3::UnitY());
  Assembly a;
  const int pivot = a.node("pivot", Vec3::Zero());
  const int bob = a.node("bob", l * along, bob_mass, velocity);
  a.rod(pivot, bob, l, rod_mass, "rod", 0.01 * l);  // slender, for the eye only
  a.fix(pivot);
  a.structure.kind = "pendulum";
  show_as_solved(a.structure);
  return a.structure;
}

}  // namespace unfurl
