// SPDX-License-Identifier: BSD-3-Clause
// Masses, angles, energies, momenta and impulses of a mechanism, by formulas of their own.
#pragma once

#include "tests/random/mechanism.hpp"

namespace unfurl::random {

using Matrix = Eigen::MatrixXd;

inline Vec3 point(const Vector& x, int i) {
  return x.segment<3>(3 * i);
}

Matrix mass_matrix(const Mechanism& m);  // of all coordinates [kg]

struct TwistTerms {
  double angle;
  Vec3 by_a, by_b;  // of the angle by the two outer nodes; the hinge takes minus their sum
};
// `near`: with an axis, the angle is the one within pi of it.
TwistTerms terms_of(const Twist& twist, const Vector& q, double near);

double kinetic_energy(const Mechanism& m, const Vector& v);
double potential_energy(const Mechanism& m, const Vector& q);  // gravity, springs, constant loads
Vec3 momentum(const Mechanism& m, const Vector& v);
Vec3 angular_momentum(const Mechanism& m, const Vector& q, const Vector& v);
double load_factor(const Load& load, double t);
// Integral of the factor from 0 to t [s]: its pieces are trapezia.
double load_impulse(const Load& load, double t);

}  // namespace unfurl::random
