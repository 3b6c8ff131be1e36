// SPDX-License-Identifier: BSD-3-Clause
// A scalar of the configuration that springs pull on, drives prescribe and stops bound.
#pragma once

#include <array>
#include <vector>

#include "core/math/types.hpp"
#include "core/structure/structure.hpp"

namespace unfurl {

//   coordinate  s = axis . x_0                             or, with two nodes, axis . (x_1 - x_0)   [m]
//   length      s = |x_1 - x_0|                                                                     [m]
//   angle       from d_1 = x_1 - x_0 to d_2 = x_3 - x_2                                             [rad]
//                 axis = 0: unsigned, in [0, pi]; its gradient is undefined at 0 and pi (taken as 0 there)
//                 axis a: atan2(a . (d_1 x d_2), d_1 . d_2 - (a . d_1)(a . d_2)), of the projections across
//                 a, on the branch within pi of `near`: the value of a moment ago
//   fold        atan2(sine, cosine) of the structure's fold angle                                   [rad]
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
  // Hess s, dense, column by column, size of stencil squared.
  void hessian(const double* q, double* hess) const;
  // v^T Hess s v, without that matrix: a fold angle's is as large as the structure.
  double curvature_along(const double* q, const double* v) const;
  double rate(const double* gradient, const double* v) const {  // gradient . v
    double sum = 0;
    for (std::size_t i = 0; i < stencil_.size(); ++i) sum += gradient[i] * v[stencil_[i]];
    return sum;
  }
  bool is_angle() const { return kind_ == MeasureKind::angle || kind_ == MeasureKind::fold; }
  double reference() const { return reference_; }

 private:
  struct Angle;
  Angle angle_terms(const double* q) const;
  void angle_hessian(const double* q, double* hess) const;
  void length_hessian(const double* q, double* hess) const;
  void fold_hessian(const double* q, double* hess) const;
  double linear(const VectorXd& coefficients, double offset, const double* q) const;

  MeasureKind kind_;
  Vec3 axis_;
  double reference_;
  std::vector<int> stencil_;
  VectorXd sine_, cosine_;  // fold and coordinate: coefficients in the order of the stencil
  double sine_offset_ = 0, cosine_offset_ = 0;
};

// An angle with a sign, which may go round any number of times: about an axis, or the fold angle.
bool counts_turns(const Measure& measure);

// The angles of a structure that count on from state to state: those with a sign that springs and stops act
// on.
struct FollowedAngles {
  std::vector<Measure> measures;
  std::vector<int> of_force,
      of_stop;  // index in `measures` for each of Structure::forces and stops; -1: none
};
FollowedAngles followed_angles(const Structure& structure);

}  // namespace unfurl
