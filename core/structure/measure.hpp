// SPDX-License-Identifier: BSD-3-Clause
// A scalar of the configuration that springs pull on, drives prescribe and stops bound.
#pragma once

#include <array>
#include <vector>

#include "core/math/types.hpp"
#include "core/structure/moment.hpp"
#include "core/structure/structure.hpp"

namespace unfurl {

//   coordinate  s = axis . x_0                             or, with two nodes, axis . (x_1 - x_0)   [m]
//   length      s = |x_1 - x_0|                                                                     [m]
//   angle       from d_1 = x_1 - x_0 to d_2 = x_3 - x_2; of six nodes of tangents (angle_sides.hpp)    [rad]
//                 axis = 0: unsigned, in [0, pi]; its gradient is undefined at 0 and pi (taken as 0 there)
//                 axis a: atan2(a . (d_1 x d_2), d_1 . d_2 - (a . d_1)(a . d_2)), of the projections across
//                 a, on the branch within pi of `near`: the value of a moment ago
//   fold        atan2(sine, cosine) of the structure's fold angle                                   [rad]
//   dihedral    about the edge from x_1 to x_2, from the half-plane of x_0 to that of x_3: 0 where both lie
//   on
//               one side, pi where the four lie flat; right-handed about the edge, counts turns      [rad]
//   combination sum_i c_i m_i of the above; each of its angles is on a branch of its own
class MeasureFunction {
 public:
  MeasureFunction(const Measure& measure, const Deployment& deployment);

  // Coordinates that s depends on; an index may appear twice, its entries add up.
  const std::vector<int>& stencil() const { return stencil_; }
  double value(const double* q, double near) const;
  double value(const double* q) const { return value(q, reference_); }
  // gradient: one entry per stencil entry
  double value_and_gradient(const double* q, double* gradient, double near) const;
  double value_and_gradient(const double* q, double* gradient) const {
    return value_and_gradient(q, gradient, reference_);
  }
  // The same near the angles of a moment; `followed`: the first of its own among them, -1: as at t = 0.
  double value(const double* q, const Moment& at, int followed) const;
  double value_and_gradient(const double* q, double* gradient, const Moment& at, int followed) const;
  // The same of a motion: where the sides of an angle without an axis lie in line, they turn about that axis
  // about which they have come there.
  double value_and_gradient(const double* q, const double* v, double* gradient, const Moment& at,
                            int followed) const;
  // Hess s, dense, column by column, size of stencil squared.
  void hessian(const double* q, double* hess) const;
  // entries += scale * Hess s, by coordinates; terms of a combination meet in no entry.
  void add_hessian(const double* q, double scale, std::vector<Eigen::Triplet<double>>& entries) const;
  // Of an angle without an axis whose sides lie in line, also with a factor, s has no Hessian but the square
  // of what s lacks of its value there has: entries += scale * half of that. False: it is no such angle.
  bool add_square_in_line(const double* q, double scale, std::vector<Eigen::Triplet<double>>& entries) const;
  // out += scale * Hess s v, by places in the stencil.
  void add_hessian_times(const double* q, const double* v, double scale, double* out) const;
  // v^T Hess s v: the second derivative of s along q + t v, without that matrix.
  double curvature_along(const double* q, const double* v) const;
  // By what s changes from q to q + u, angles to the nearest turn; round-off is relative to u.
  double change(const double* q, const double* u) const;
  double rate(const double* gradient, const double* v) const {  // gradient . v
    double sum = 0;
    for (std::size_t i = 0; i < stencil_.size(); ++i) sum += gradient[i] * v[stencil_[i]];
    return sum;
  }
  bool is_angle() const { return angle_; }  // [rad]: of a combination, where all of its terms are
  // A value and one that is a turn away are the same pose.
  bool wraps() const { return angle_ && terms_.empty(); }
  double reference() const { return reference_; }

 private:
  double near(const Moment& at, int followed) const { return at.near(followed, reference_); }
  void turn_in_line(const double* q, const double* v, double scale, double* gradient) const;
  struct Angle;
  Angle angle_terms(const double* q) const;
  void angle_hessian(const double* q, double* hess) const;
  void length_hessian(const double* q, double* hess) const;
  void fold_hessian(const double* q, double* hess) const;
  void combination_hessian(const double* q, double* hess) const;
  double angle_change(const double* q, const double* u) const;
  double angle_curvature(const double* q, const double* v) const;
  Vec3 edge(const double* q) const;  // of a length
  double linear(const VectorXd& coefficients, double offset, const double* q) const;
  template <class Each>
  void each_term(const Each& each) const;

  // Of a combination; the stencil is that of the terms one after the other.
  std::vector<MeasureFunction> terms_;
  std::vector<double> coefficients_;
  bool angle_ = false, turns_ = false;
  MeasureKind kind_;
  Vec3 axis_;
  double reference_;
  std::vector<int> stencil_;
  VectorXd sine_, cosine_;  // fold and coordinate: coefficients in the order of the stencil
  double sine_offset_ = 0, cosine_offset_ = 0;
};

// An angle with a sign, which may go round any number of times: about an axis, or the fold angle.
bool counts_turns(const Measure& measure);
// In radians: angles, and combinations of nothing else.
bool is_angle(const Measure& measure);

// Between which values a measure stays: a length above 0, an angle without an axis from 0 to pi, where they
// turn back; sums of those; endless where nothing ends it.
struct MeasureRange {
  double low, high;
};
MeasureRange range_of(const Measure& measure);

// The angles with a sign in a measure, in its order: its own, or those of its terms.
std::vector<Measure> turning_angles(const Measure& measure);

// The angles of a structure that count on from state to state: those with a sign that tell how far it is
// deployed, that springs and stops act on, and those in combinations that are held or driven. (A row of one
// angle is taken to the nearest turn.)
struct FollowedAngles {
  std::vector<Measure> measures;  // those of the deployment's measure come first
  // For each of Structure::forces, stops and constraints the index in `measures` of its first angle; -1: none
  std::vector<int> of_force, of_stop, of_constraint;
};
FollowedAngles followed_angles(const Structure& structure);

}  // namespace unfurl
