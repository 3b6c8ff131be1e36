// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "core/math/types.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// Nodes of a unit, in this order.
enum HoopNode : int { bottom_corner = 0, top_corner = 1, bottom_hinge = 2, top_hinge = 3 };

// The numbers behind every model of a hoop (hoop.hpp has the geometry).
struct HoopShape {
  int n = 0;              // units
  double arc = 2.0 * pi;  // what they span; less than a full turn: open, with a post at either end [rad]
  double l1 = 0, l2 = 0;  // chord rod, post [m]
  double sine = 0, cosine = 0;                       // of the fold angle
  double chord_mass = 0, post_mass = 0, radius = 0;  // [kg], [kg], drawn [m]
  double hinge_force = 0;                            // [N]
  int perturbed_unit = -1;                           // driven by perturbed_force instead; -1: none
  double perturbed_force = 0;                        // [N]

  bool closed() const { return arc >= 2.0 * pi; }
  double half_angle() const { return 0.5 * arc / n; }
  double ring_radius() const { return l1 * cosine / std::sin(half_angle()); }
  double corner_angle(int k) const { return arc * k / n; }
  double hinge_angle(int k) const { return arc * (k + 0.5) / n; }
};

// Throws StructureError where the parameters contradict each other.
HoopShape hoop_shape(const ParamSet& params);

}  // namespace unfurl
