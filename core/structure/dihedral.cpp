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
#include "core/structure/change.hpp"
#include "core/structure/course.hpp"

namespace unfurl {
namespace {

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;
using Mat9x12 = Eigen::Matrix<double, 9, 12>;

// A function of (b_1, b_2, b_3) with its gradient.
struct Slope {
  double value = 0;
  Vec9 gradient = Vec9::Zero();
};

Slope operator*(const Slope& a, const Slope& b) {
  return {a.value * b.value, a.value * b.gradient + b.value * a.gradient};
}

Slope operator-(const Slope& a, const Slope& b) {
  return {a.value - b.value, a.gradient - b.gradient};
}

Slope root(const Slope& a) {
  const double r = std::sqrt(a.value);
  return {r, a.gradient / (2 * r)};
}

// ... and with its Hessian.
struct Jet {
  Slope slope;
  Mat9 hess = Mat9::Zero();
};

Jet operator*(const Jet& a, const Jet& b) {
  const Mat9 mixed = a.slope.gradient * b.slope.gradient.transpose();
  return {a.slope * b.slope, a.slope.value * b.hess + b.slope.value * a.hess + mixed + mixed.transpose()};
}

Jet operator-(const Jet& a, const Jet& b) {
  return {a.slope - b.slope, a.hess - b.hess};
}

Jet root(const Jet& a) {
  const Slope r = root(a.slope);
  return {r, a.hess / (2 * r.value) - r.gradient * r.gradient.transpose() / r.value};
}

// p_ij and w of (b_1, b_2, b_3), each as one of the above.
struct Slopes {
  Vec9 b;
  auto vector(int i) const { return b.segment<3>(3 * i); }
  Slope product(int i, int j) const {
    Slope p;
    p.value = vector(i).dot(vector(j));
    p.gradient.segment<3>(3 * i) += vector(j);
    p.gradient.segment<3>(3 * j) += vector(i);
    return p;
  }
  // w = b_2 . (b_1 x b_3) = b_1 . (b_3 x b_2) = b_3 . (b_2 x b_1)
  Slope volume() const {
    const Vec3 b1 = vector(0), b2 = vector(1), b3 = vector(2);
    Slope w;
    w.value = b2.dot(b1.cross(b3));
    w.gradient << b3.cross(b2), b1.cross(b3), b2.cross(b1);
    return w;
  }
};

Mat3 across(const Vec3& a) {
  Mat3 m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

struct Jets {
  Slopes slopes;
  Jet product(int i, int j) const {
    Jet p{slopes.product(i, j)};
    p.hess.block<3, 3>(3 * i, 3 * j) += Mat3::Identity();
    p.hess.block<3, 3>(3 * j, 3 * i) += Mat3::Identity();
    return p;
  }
  Jet volume() const {
    Jet w{slopes.volume()};
    const Mat3 h12 = across(slopes.vector(2)), h13 = -across(slopes.vector(1)),
               h23 = across(slopes.vector(0));
    w.hess << Mat3::Zero(), h12, h13, h12.transpose(), Mat3::Zero(), h23, h13.transpose(), h23.transpose(),
        Mat3::Zero();
    return w;
  }
};

struct Courses {
  Slopes at, rate;
  Course product(int i, int j) const {
    return dot(at.vector(i), rate.vector(i), at.vector(j), rate.vector(j));
  }
  Course volume() const {
    const Slope w = at.volume();  // linear in each of the three
    return {w.value, w.gradient.dot(rate.b), 2 * rate.volume().gradient.dot(at.b)};
  }
};

struct Changes {
  Slopes at, by;
  Change product(int i, int j) const {
    return dot_change(at.vector(i), by.vector(i), at.vector(j), by.vector(j));
  }
  Change volume() const {
    const Slope w = at.volume(), all = by.volume();
    return {w.value, w.gradient.dot(by.b) + all.gradient.dot(at.b) + all.value};
  }
};

// s and c
template <class Point>
auto sine(const Point& at) {
  return root(at.product(1, 1)) * at.volume();
}
template <class Point>
auto cosine(const Point& at) {
  return at.product(0, 2) * at.product(1, 1) - at.product(0, 1) * at.product(1, 2);
}

// b_1 = x_0 - x_1, b_2 = x_2 - x_1, b_3 = x_3 - x_1
Slopes edges(const double* q, const std::vector<int>& stencil) {
  Vec3 x[4];
  for (std::size_t i = 0; i < 12; ++i) x[i / 3][static_cast<Index>(i % 3)] = q[stencil[i]];
  Slopes b;
  b.b << x[0] - x[1], x[2] - x[1], x[3] - x[1];
  return b;
}

Mat9x12 edges_by_nodes() {
  Mat9x12 by_x = Mat9x12::Zero();
  for (int i = 0; i < 3; ++i) {
    constexpr int end[] = {0, 2, 3};
    by_x.block<3, 3>(3 * i, 3 * end[i]) = Mat3::Identity();
    by_x.block<3, 3>(3 * i, 3) -= Mat3::Identity();
  }
  return by_x;
}

}  // namespace

// Where b_1 or b_3 is nearly along b_2, products p_ij and w cancel: of planes at 5 degrees they leave 1e-14
// of an angle that the coordinates tell to 1e-15. What is across b_2 is taken first then, a = b_2 x b_1, d =
// b_2 x b_3: c = a . d, s = (a x d) . b_2 / |b_2|.
double dihedral(const double* q, const std::vector<int>& stencil, double* gradient) {
  const Slopes b = edges(q, stencil);
  Slope s = sine(b), c = cosine(b);
  const Vec3 along = b.vector(1), a = along.cross(Vec3(b.vector(0))), d = along.cross(Vec3(b.vector(2)));
  s.value = along.isZero(0.0) ? 0.0 : a.cross(d).dot(along) / along.norm();
  c.value = a.dot(d);
  const double r2 = s.value * s.value + c.value * c.value;
  const Vec9 g = r2 > 0 ? Vec9((c.value * s.gradient - s.value * c.gradient) / r2) : Vec9(Vec9::Zero());
  Eigen::Map<Eigen::Matrix<double, 12, 1>> by_nodes(gradient);
  by_nodes << g.head<3>(), -g.head<3>() - g.segment<3>(3) - g.tail<3>(), g.segment<3>(3), g.tail<3>();
  return std::atan2(s.value, c.value);
}

void dihedral_hessian(const double* q, const std::vector<int>& stencil, double* hess) {
  const Jets b{edges(q, stencil)};
  const Jet sj = sine(b), cj = cosine(b);
  const Slope &s = sj.slope, &c = cj.slope;
  const double r2 = s.value * s.value + c.value * c.value;
  const Mat9 mixed = s.gradient * c.gradient.transpose();
  const Mat9 h =
      (c.value * sj.hess - s.value * cj.hess) / r2 +
      (2 * s.value * c.value * (c.gradient * c.gradient.transpose() - s.gradient * s.gradient.transpose()) +
       (s.value * s.value - c.value * c.value) * (mixed + mixed.transpose())) /
          (r2 * r2);
  static const Mat9x12 by_x = edges_by_nodes();
  Eigen::Map<Eigen::Matrix<double, 12, 12>> by_nodes(hess);
  const Eigen::Matrix<double, 12, 9> rows = by_x.transpose() * h;
  by_nodes = rows * by_x;
}

double dihedral_curvature(const double* q, const double* v, const std::vector<int>& stencil) {
  const Courses b{edges(q, stencil), edges(v, stencil)};
  return second_of_angle(sine(b), cosine(b));
}

double dihedral_change(const double* q, const double* u, const std::vector<int>& stencil) {
  const Changes b{edges(q, stencil), edges(u, stencil)};
  return change_of_angle(sine(b), cosine(b));
}

}  // namespace unfurl
