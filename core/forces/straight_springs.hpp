// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/forces/force.hpp"

namespace unfurl {

// The law of a spring or a cable (spring.hpp) at the stretch e: N_e = k elastic, the share of the spring that
// pulls, N_e' / k, with its slope, V = k energy. It begins over `smoothing` on both sides where it pulls
// only.
struct PullByLength {
  double elastic, share, bend, energy;
};
template <class Law>  // has one_sided, smoothing
PullByLength pull_of(const Law& law, double e) {
  const double w = law.one_sided ? law.smoothing : 0.0;
  if (!law.one_sided || (e >= w && e > 0)) return {e, 1.0, 0.0, 0.5 * e * e + w * w / 6};
  if (e <= -w) return {0, 0, 0, 0};
  const double u = e + w;
  return {u * u / (4 * w), u / (2 * w), 1 / (2 * w), u * u * u / (12 * w)};
}

// Springs and cables that run straight from one node to another and whose unstressed length stays as it is:
// nets have them by thousands. With d = x_b - x_a, s = |d|, u = d / s, s' = u . (v_b - v_a):
//
//     f_b = -N u = -f_a,     Hess s = (1 - u u^T) / s   by d
class StraightSprings {
 public:
  static bool fits(const Force& force);
  void push_back(const Force& force);

  void add(const double* q, const double* v, double scale, double* f) const;
  double potential(const double* q) const;
  double dissipation(const double* q, const double* v) const;  // but for what is slack
  double taken(const double* q) const;                         // of what is slack
  void derivatives(const double* q, const double* v, ForceDerivative& by_q, ForceDerivative& by_v) const;

 private:
  struct Member {
    int a, b;  // nodes
    double rest, stiffness, damping, smoothing;
    bool one_sided, slack;
  };
  struct Tension;
  static double potential_of(const Member& m, const double* q);
  static bool pulls(const Member& m, const double* q, const double* v, Tension& at);

  std::vector<Member> members_;
};

}  // namespace unfurl
