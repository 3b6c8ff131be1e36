// SPDX-License-Identifier: BSD-3-Clause
// The two lines that an angle is between.
#pragma once

#include <array>
#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

// d / |d|; of no length it is 0, whatever d does.
struct UnitVector {
  explicit UnitVector(const Vec3& d);
  Mat3 second(const Vec3& x) const;  // of x . t, by d; times x: of t, along d + s x

  Vec3 t;
  double length;
  Mat3 first;  // of t, by d
};

// Of four nodes d_1 = x_1 - x_0 and d_2 = x_3 - x_2. Of six, where x_1 and x_4 are the first ones within a
// rod that bends (structures/segments.hpp), its tangent at x_0:
//     d_1 = 3/2 t(x_1 - x_0) - 1/2 t(x_4 - x_1),     d_2 = 3/2 t(x_3 - x_2) - 1/2 t(x_5 - x_3)
// with t(d) = d / |d|, so that a torque acts across each part and adds nothing to the force along it. Of a
// line that is straight x_4 is x_1, or x_5 is x_3.
class AngleSides {
 public:
  AngleSides(const double* q, const std::vector<int>& stencil);
  const Vec3& d1() const { return sides_[0].d; }
  const Vec3& d2() const { return sides_[1].d; }
  // From derivatives by (d_1, d_2) to those by the nodes
  void gradient(const Vec6& g, Eigen::Ref<VectorXd> out) const;
  void hessian(const Vec6& g, const Mat6& h, Eigen::Ref<MatrixXd> out) const;
  // Of (d_1, d_2), along q + t v
  Vec6 rate(const double* v) const;
  Vec6 second_rate(const double* v) const;
  // Of (d_1, d_2), from q to q + u: nothing cancels
  Vec6 change(const double* u) const;

 private:
  struct Side {
    Vec3 d;
    std::array<Mat3, 3> by;  // its nodes
  };
  static constexpr std::array share{1.5, -0.5};
  bool bends() const { return nodes_ == 3; }
  Index node(int side, int k) const { return k < 2 ? 2 * side + k : 4 + side; }
  Vec3 part(const double* x, int side, int k) const;  // from its node k to the next

  const double* q_;
  const std::vector<int>& stencil_;
  int nodes_;  // of a side
  std::array<Side, 2> sides_;
};

}  // namespace unfurl
