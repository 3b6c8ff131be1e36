// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/bending.hpp"

#include <Eigen/Geometry>
#include <array>
#include <limits>

namespace unfurl {
namespace {

using Mat36 = Eigen::Matrix<double, 3, 6>;

// (1 - c) / (1 + c) and its derivatives by (d_1, d_2). From s = t_2 - t_1, which keeps its digits where
// straight: 1 - c = |s|^2 / 2, t_2 - c t_1 = s - t_1 (t_1 . s), of which rounding leaves nothing along t_1.
struct Bend {
  double value;
  Vec6 gradient;
  Vec3 t1, t2, g1, g2;
  double l1, l2, c, slope, curve;  // slope, curve: of the value by c

  Bend(const Vec3& d1, const Vec3& d2)
      : t1(d1.normalized()), t2(d2.normalized()), l1(d1.norm()), l2(d2.norm()) {
    c = t1.dot(t2);
    const Vec3 s = t2 - t1;
    g1 = (s - t1.dot(s) * t1) / l1;
    g2 = (t2.dot(s) * t2 - s) / l2;
    const double q = 1 + c;
    value = 0.5 * s.squaredNorm() / q;
    slope = -2 / (q * q);
    curve = 4 / (q * q * q);
    gradient << slope * g1, slope * g2;
  }

  Mat6 hessian() const {
    const Mat3 P1 = Mat3::Identity() - t1 * t1.transpose(), P2 = Mat3::Identity() - t2 * t2.transpose();
    Vec6 g;
    g << g1, g2;
    Mat6 H;  // of c
    H.topLeftCorner<3, 3>() = -(t1 * g1.transpose() + g1 * t1.transpose() + c / l1 * P1) / l1;
    H.bottomRightCorner<3, 3>() = -(t2 * g2.transpose() + g2 * t2.transpose() + c / l2 * P2) / l2;
    H.topRightCorner<3, 3>() = (P2 / l2 - t1 * g2.transpose()) / l1;
    H.bottomLeftCorner<3, 3>() = H.topRightCorner<3, 3>().transpose();
    return curve * g * g.transpose() + slope * H;
  }
};

// R and its derivatives (bending.hpp) at the rates u of (d_1, d_2). With s = t_2 - t_1, s' = B u and
//     W = g (s s^T + e^2 1) / (|s|^2 + e^2),   m = W s',   R = c/2 s' . m,   dR/du = B^T m
class BendRate {
 public:
  BendRate(const Bend& bend, const Vec6& rate)
      : bend_(bend), u1_(rate.head<3>()), u2_(rate.tail<3>()), s_(bend.t2 - bend.t1) {
    B << -(one - bend.t1 * bend.t1.transpose()) / bend.l1, (one - bend.t2 * bend.t2.transpose()) / bend.l2;
    rate_ = B * rate;
    const double cosine = 0.5 * (1 + bend.c);  // squared, of half the angle
    const double size = s_.squaredNorm() + smooth * smooth;
    g_ = 1 / (cosine * cosine * cosine * size);
    // d(log g_)/d|s|^2 and |s|^2 = 4 (1 - cosine)
    by_size_ = 0.75 / cosine - 1 / size;
    W = g_ * (s_ * s_.transpose() + smooth * smooth * one);
    m = W * rate_;
  }
  Vec6 gradient() const { return B.transpose() * m; }
  double twice() const { return rate_.dot(m); }

  // Of the gradient, by (d_1, d_2). The second derivatives of a unit vector d / l are alike in all three:
  //     T(x) = -(x t^T + t x^T + (t . x) (1 - 3 t t^T)) / l^2
  Mat6 by_place() const {
    const auto T = [](const Vec3& x, const Vec3& t, double l) -> Mat3 {
      return (t.dot(x) * (3 * t * t.transpose() - one) - x * t.transpose() - t * x.transpose()) / (l * l);
    };
    Mat36 of_rate;
    of_rate << -T(u1_, bend_.t1, bend_.l1), T(u2_, bend_.t2, bend_.l2);
    const Mat3 by_s = g_ * (s_.dot(rate_) * one + s_ * rate_.transpose()) + 2 * by_size_ * m * s_.transpose();
    Mat6 K = B.transpose() * (W * of_rate + by_s * B);
    K.topLeftCorner<3, 3>() -= T(m, bend_.t1, bend_.l1);
    K.bottomRightCorner<3, 3>() += T(m, bend_.t2, bend_.l2);
    return K;
  }

  Mat36 B;
  Mat3 W;
  Vec3 m;

 private:
  inline static const Mat3 one = Mat3::Identity();
  static constexpr double smooth = 1e-6;  // e
  const Bend& bend_;
  Vec3 u1_, u2_, s_, rate_;
  double g_, by_size_;
};

class Bending final : public ForceBlock {
 public:
  explicit Bending(const Structure& structure) {
    for (const Force& f : structure.forces) {
      if (f.kind != "bending") continue;
      const auto at = [&](int k) {
        return structure.nodes[static_cast<std::size_t>(f.nodes[static_cast<std::size_t>(k)])].position;
      };
      const double mean = 0.5 * ((at(1) - at(0)).norm() + (at(2) - at(1)).norm());
      joints_.push_back({{f.nodes[0], f.nodes[1], f.nodes[2]}, 2 * f.stiffness / mean, f.damping / mean});
      damped_ = damped_ || f.damping > 0;
    }
  }
  bool empty() const { return joints_.empty(); }
  bool constant() const override { return false; }
  bool has_power() const override { return damped_; }
  bool dissipative() const override { return true; }

  void add(const Moment&, const double* q, const double* v, double scale, double* f) const override {
    for (const Joint& joint : joints_) {
      const Bend bend = joint.bend(q);
      Vec6 g = (scale * joint.factor) * bend.gradient;
      if (joint.damping > 0) g += (scale * joint.damping) * BendRate(bend, joint.sides(v)).gradient();
      joint.on(0, f) += g.head<3>();
      joint.on(1, f) += g.tail<3>() - g.head<3>();
      joint.on(2, f) -= g.tail<3>();
    }
  }

  double potential(const Moment&, const double* q) const override {
    double sum = 0;
    for (const Joint& joint : joints_) sum += joint.factor * joint.bend(q).value;
    return sum;
  }

  double power(const Moment&, const double* q, const double* v) const override {
    double sum = 0;
    for (const Joint& joint : joints_)
      if (joint.damping > 0) sum -= joint.damping * BendRate(joint.bend(q), joint.sides(v)).twice();
    return sum;
  }

  // x -> (d_1, d_2) has the coefficients -1, 1, 0 and 0, -1, 1.
  void derivatives(const Moment&, const double* q, const double* v, ForceDerivative& by_q,
                   ForceDerivative& by_v) const override {
    Eigen::Matrix<double, 6, 9> D;
    const Mat3 one = Mat3::Identity(), none = Mat3::Zero();
    D << -one, one, none, none, -one, one;
    for (const Joint& joint : joints_) {
      const auto enter = [&](const Mat6& by_sides, ForceDerivative& by) {
        const Eigen::Matrix<double, 6, 9> rows = -by_sides.lazyProduct(D);
        const Eigen::Matrix<double, 9, 9> K = D.transpose().lazyProduct(rows);
        for (int i = 0; i < 9; ++i)
          for (int j = 0; j < 9; ++j) by.emplace_back(joint.coordinate(i), joint.coordinate(j), K(i, j));
      };
      const Bend bend = joint.bend(q);
      enter(joint.factor * bend.hessian(), by_q);
      if (!(joint.damping > 0)) continue;
      const BendRate rate(bend, joint.sides(v));
      enter(joint.damping * rate.by_place(), by_q);
      const Mat36 WB = joint.damping * rate.W * rate.B;
      enter(rate.B.transpose() * WB, by_v);
    }
  }

 private:
  struct Joint {
    std::array<int, 3> nodes;
    double factor;   // 2 E I / L [N m]
    double damping;  // c [N m s]

    Vec6 sides(const double* x) const {
      Vec6 d;
      d << node_vector(x, nodes[1]) - node_vector(x, nodes[0]),
          node_vector(x, nodes[2]) - node_vector(x, nodes[1]);
      return d;
    }
    Bend bend(const double* q) const {
      const Vec6 d = sides(q);
      return {d.head<3>(), d.tail<3>()};
    }
    Eigen::Map<Vec3> on(std::size_t k, double* f) const {
      return Eigen::Map<Vec3>(f + 3 * static_cast<Index>(nodes[k]));
    }
    int coordinate(int i) const { return 3 * nodes[static_cast<std::size_t>(i / 3)] + i % 3; }
  };
  std::vector<Joint> joints_;
  bool damped_ = false;
};

}  // namespace

std::unique_ptr<ForceBlock> bending_block(const Structure& structure, const SparseRows&) {
  auto block = std::make_unique<Bending>(structure);
  if (block->empty()) return nullptr;
  return block;
}

const std::vector<ParamSpec>& bending_params() {
  static const std::vector<ParamSpec> params = {
      required(positive_param("stiffness", "N m^2", 1.0, "E I of the rod")),
      real_param("damping", "N m^2 s", 0.0, 0.0, std::numeric_limits<double>::infinity(),
                 "E I of the rod times the damping time of its material")};
  return params;
}

void fill_bending(const ParamSet& values, Force& force) {
  force.stiffness = values.real("stiffness");
  force.damping = values.real("damping");
}

}  // namespace unfurl
