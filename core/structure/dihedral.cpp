// SPDX-License-Identifier: BSD-3-Clause
//   b_1 = x_0 - x_1,  b_2 = x_2 - x_1,  b_3 = x_3 - x_1:   theta = atan2(s, c) with
//
//     s = |b_2| w,     w = b_2 . (b_1 x b_3)
//     c = p_13 p_22 - p_12 p_23,     p_ij = b_i . b_j       (= (b_2 x b_1) . (b_2 x b_3))
//
// Derivatives by (b_1, b_2, b_3), products of those of w, |b_2| and p_ij; and for an angle theta = atan2(s,
// c)
//
//     r^2 theta' = c s' - s c',     Hess theta = (c Hs - s Hc) / r^2
//                                   + [2 s c (c' c'^T - s' s'^T) + (s^2 - c^2)(s' c'^T + c' s'^T)] / r^4
#include "core/structure/dihedral.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/math/types.hpp"

namespace unfurl {
namespace {

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;

// A function of (b_1, b_2, b_3) with its derivatives.
struct Jet {
  double value = 0;
  Vec9 gradient = Vec9::Zero();
  Mat9 hess = Mat9::Zero();
};

Jet operator*(const Jet& a, const Jet& b) {
  const Mat9 mixed = a.gradient * b.gradient.transpose();
  return {a.value * b.value, a.value * b.gradient + b.value * a.gradient,
          a.value * b.hess + b.value * a.hess + mixed + mixed.transpose()};
}

Jet operator-(const Jet& a, const Jet& b) {
  return {a.value - b.value, a.gradient - b.gradient, a.hess - b.hess};
}

// b_i . b_j
Jet product(const Vec9& b, int i, int j) {
  Jet p;
  p.value = b.segment<3>(3 * i).dot(b.segment<3>(3 * j));
  p.gradient.segment<3>(3 * i) += b.segment<3>(3 * j);
  p.gradient.segment<3>(3 * j) += b.segment<3>(3 * i);
  p.hess.block<3, 3>(3 * i, 3 * j) += Mat3::Identity();
  p.hess.block<3, 3>(3 * j, 3 * i) += Mat3::Identity();
  return p;
}

Jet root(const Jet& a) {
  const double r = std::sqrt(a.value);
  const Vec9 g = a.gradient / (2 * r);
  return {r, g, a.hess / (2 * r) - g * g.transpose() / r};
}

Mat3 across(const Vec3& a) {
  Mat3 m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

// w = b_2 . (b_1 x b_3) = b_1 . (b_3 x b_2) = b_3 . (b_2 x b_1)
Jet volume(const Vec9& b) {
  const Vec3 b1 = b.segment<3>(0), b2 = b.segment<3>(3), b3 = b.segment<3>(6);
  Jet w;
  w.value = b2.dot(b1.cross(b3));
  w.gradient << b3.cross(b2), b1.cross(b3), b2.cross(b1);
  const Mat3 h12 = across(b3), h13 = -across(b2), h23 = across(b1);
  w.hess << Mat3::Zero(), h12, h13, h12.transpose(), Mat3::Zero(), h23, h13.transpose(), h23.transpose(),
      Mat3::Zero();
  return w;
}

}  // namespace

double dihedral(const double* q, const std::vector<int>& stencil, double* gradient, double* hess) {
  Vec3 x[4];
  for (std::size_t i = 0; i < 12; ++i) x[i / 3][static_cast<Index>(i % 3)] = q[stencil[i]];
  Vec9 b;
  b << x[0] - x[1], x[2] - x[1], x[3] - x[1];
  const Jet s = root(product(b, 1, 1)) * volume(b);
  const Jet c = product(b, 0, 2) * product(b, 1, 1) - product(b, 0, 1) * product(b, 1, 2);
  const double r2 = s.value * s.value + c.value * c.value;
  const Vec9 g = r2 > 0 ? Vec9((c.value * s.gradient - s.value * c.gradient) / r2) : Vec9(Vec9::Zero());
  // b_1 = x_0 - x_1, b_2 = x_2 - x_1, b_3 = x_3 - x_1
  Eigen::Matrix<double, 9, 12> by_x = Eigen::Matrix<double, 9, 12>::Zero();
  for (int i = 0; i < 3; ++i) {
    constexpr int end[] = {0, 2, 3};
    by_x.block<3, 3>(3 * i, 3 * end[i]) = Mat3::Identity();
    by_x.block<3, 3>(3 * i, 3) -= Mat3::Identity();
  }
  Eigen::Map<Eigen::Matrix<double, 12, 1>> by_nodes(gradient);
  by_nodes = by_x.transpose() * g;
  if (hess) {
    const Mat9 mixed = s.gradient * c.gradient.transpose();
    const Mat9 h =
        (c.value * s.hess - s.value * c.hess) / r2 +
        (2 * s.value * c.value * (c.gradient * c.gradient.transpose() - s.gradient * s.gradient.transpose()) +
         (s.value * s.value - c.value * c.value) * (mixed + mixed.transpose())) /
            (r2 * r2);
    Eigen::Map<Eigen::Matrix<double, 12, 12>> out(hess);
    out = by_x.transpose() * h * by_x;
  }
  return std::atan2(s.value, c.value);
}

}  // namespace unfurl
