// SPDX-License-Identifier: BSD-3-Clause
// The exact opening of a threefold-symmetric Bricard loop that is released at rest (geometry in bricard.hpp).
#pragma once

#include <array>
#include <cmath>
#include <complex>

#include "tests/support/one_freedom.hpp"

namespace unfurl::exact {

// One free coordinate, x = half of theta_1 less its start. Positions follow from S_1, C_1, S_2, C_2 in closed
// form; the rate of theta_2 from the closure F = S_1 S_2 - 1/2 - cos(alpha) C_1 C_2 = 0,
//
//     d(theta_2)/d(theta_1) = -(C_1 S_2 + cos(alpha) S_1 C_2) / (S_1 C_2 + cos(alpha) C_1 S_2)
//
// and velocities by complex step. By symmetry one odd and one even hinge stand for three each. The loop
// floats: the vertical velocity of its centre of mass, which the loads leave at rest, is taken out.
struct Bricard {
  double L, pin, mass_per_length, twist_deg, opening_deg, force;

  using C = std::complex<double>;
  using V = std::array<C, 3>;

  double cosine() const { return std::cos(twist_deg * M_PI / 180); }
  double half1(double x) const { return opening_deg * M_PI / 360 + x; }
  double half2(double x) const {  // by Newton on the closure, from the flat triangle back
    double b = M_PI / 6;
    const int steps = 60;
    for (int i = 0; i <= steps; ++i) {
      const double a = M_PI / 2 + (half1(x) - M_PI / 2) * i / steps;
      for (int it = 0; it < 8; ++it) {
        const double F = std::sin(a) * std::sin(b) - 0.5 - cosine() * std::cos(a) * std::cos(b);
        b -= F / (std::sin(a) * std::cos(b) + cosine() * std::cos(a) * std::sin(b));
      }
    }
    return b;
  }

  // X1, Y1 at polar angle 0 and X2, Y2 at 60 degrees.
  std::array<V, 4> points(C a, C b) const {
    const C S1 = std::sin(a), S2 = std::sin(b), C1 = std::cos(a), C2 = std::cos(b);
    const double k = 2 / std::sqrt(3.0);
    const C r1 = k * L * S2, r2 = k * L * S1,
            z = L * std::sqrt(1.0 - 4.0 / 3 * (S1 * S1 - S1 * S2 + S2 * S2));
    const C p1 = 0.5 * r2 - r1, p2 = 0.5 * r1 - r2;
    const double c = 0.5, s = std::sqrt(0.75);
    const C q1 = r1 + pin * z / (L * C1), q2 = r2 + pin * z / (L * C2);
    return {V{r1, 0, -0.5 * z}, V{q1, 0, -0.5 * z - pin * p1 / (L * C1)}, V{c * r2, s * r2, 0.5 * z},
            V{c * q2, s * q2, 0.5 * z + pin * p2 / (L * C2)}};
  }

  double inertia(double x) const {
    const double a = half1(x), b = half2(x), e = 1e-30;
    const double slope = -(std::cos(a) * std::sin(b) + cosine() * std::sin(a) * std::cos(b)) /
                         (std::sin(a) * std::cos(b) + cosine() * std::cos(a) * std::sin(b));
    std::array<std::array<double, 3>, 4> v{};
    const std::array<V, 4> P = points(C(a, e), C(b, e * slope));
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 3; ++k) v[i][k] = P[i][k].imag() / e;
    // Six bars between an odd and an even hinge, three pins at each kind: twice the energy, and the mean
    // velocity.
    const double bar = mass_per_length * L, hinge = mass_per_length * pin;
    double sum = 0, mass = 6 * bar + 6 * hinge, momentum = 0;
    const auto rod = [&](double count, double m, int i, int j) {
      const auto &p = v[static_cast<std::size_t>(i)], &q = v[static_cast<std::size_t>(j)];
      for (std::size_t k = 0; k < 3; ++k) sum += count * m / 3 * (p[k] * p[k] + p[k] * q[k] + q[k] * q[k]);
      momentum += count * m * 0.5 * (p[2] + q[2]);
    };
    rod(6, bar, 0, 2);
    rod(3, hinge, 0, 1);
    rod(3, hinge, 2, 3);
    return sum - momentum * momentum / mass;
  }
  double fold(double x) const {
    const double S1 = std::sin(half1(x)), S2 = std::sin(half2(x));
    return std::atan2(std::sqrt(1 - 4.0 / 3 * (S1 * S1 - S1 * S2 + S2 * S2)), S1);
  }

  OneFreedom motion() const {
    const Bricard s = *this;
    return {[=](double x) { return s.inertia(x); },
            [=](double x) {  // 3 f (r_2 - r_2(0)), sin a - sin b = 2 cos((a+b)/2) sin((a-b)/2)
              return 3 * s.force * 2 / std::sqrt(3.0) * s.L * 2 * std::cos(s.half1(0.5 * x)) *
                     std::sin(0.5 * x);
            }};
  }
};

}  // namespace unfurl::exact
