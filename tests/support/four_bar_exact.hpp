// SPDX-License-Identifier: BSD-3-Clause
// The exact motion of a ladder of four-bar windows that stay parallelograms.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/simulate/trajectory.hpp"

namespace unfurl::exact {

// N windows of 2 N + 1 uniform rods of length l and mass m. With phi the turn of the uprights from the
// vertical towards +x, an upright turns about its foot and a bar moves along without turning, at the speed l
// phi':
//
//     T = (1/2) m l^2 phi'^2 [(N + 1)/3 + N],   V = m g l cos(phi) [(N + 1)/2 + N]
//     phi'' = k sin(phi),   k = (3/2) (3 N + 1)/(4 N + 1) g/l,   phi(0) = 0,   phi'(0) = v/l
struct FourBarLadder {
  int windows = 1;
  double speed = 1.0, gravity = 9.81, length = 1.0;

  // phi(t) [rad], not reduced to a turn. Taylor series of order 24 in long double, 200 panels a second at
  // least, so that a panel turns by 0.2 rad at 40 rad/s: the remainder is below 0.2^25 < 1e-17 and round-off
  // of 10^4 panels below 1e-17 rad of each.
  double angle(double t) const {
    long double phi = 0, rate = speed / length;
    const int panels = 1 + static_cast<int>(200 * t);
    const long double h = static_cast<long double>(t) / panels;
    for (int i = 0; i < panels; ++i) advance(phi, rate, h);
    return static_cast<double>(phi);
  }

 private:
  static constexpr int order = 24;

  // phi = sum a_n h^n, sin(phi) = sum s_n h^n, cos(phi) = sum c_n h^n, from s' = c phi', c' = -s phi':
  //     n s_n = sum_j j a_j c_{n-j},   n c_n = -sum_j j a_j s_{n-j},   (n + 2)(n + 1) a_{n+2} = k s_n
  void advance(long double& phi, long double& rate, long double h) const {
    const long double k = 1.5L * (3 * windows + 1) / (4 * windows + 1) * gravity / length;
    long double a[order + 3] = {phi, rate}, s[order + 1] = {std::sin(phi)}, c[order + 1] = {std::cos(phi)};
    for (int n = 0; n <= order; ++n) {
      for (int j = 1; j <= n; ++j) {
        s[n] += j * a[j] * c[n - j] / n;
        c[n] -= j * a[j] * s[n - j] / n;
      }
      a[n + 2] = k * s[n] / ((n + 2.0L) * (n + 1.0L));
    }
    phi = rate = 0;
    for (int n = order + 2; n >= 0; --n) phi = phi * h + a[n];
    for (int n = order + 2; n >= 1; --n) rate = rate * h + n * a[n];
  }
};

// Largest distance of an upper node of such a run from where it should be [m]: all of them move alike, but
// past a collinear pose round-off grows, in Runge-Kutta steps to more than 1e-11 m, and differently at each.
inline double largest_head_error(const FourBarLadder& exact, const Trajectory& trajectory) {
  const auto& nodes = trajectory.structure().nodes;
  const VectorXd start = trajectory.node_positions(0);
  double largest = 0;
  int heads = 0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const double phi = exact.angle(trajectory.time(i));
    const Vec3 moved = exact.length * Vec3(std::sin(phi), std::cos(phi) - 1, 0);
    const VectorXd q = trajectory.node_positions(i);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (!nodes[k].name.starts_with("B")) continue;
      const auto at = 3 * static_cast<Index>(k);
      largest = std::max(largest, (q.segment<3>(at) - start.segment<3>(at) - moved).norm());
      ++heads;
    }
  }
  return heads > 0 ? largest : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace unfurl::exact
