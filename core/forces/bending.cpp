// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/bending.hpp"

#include <Eigen/Geometry>
#include <array>
#include <limits>

namespace unfurl {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

// (1 - c) / (1 + c) and its derivatives by (d_1, d_2); 1 - c from |t_1 - t_2|^2 / 2, which keeps its digits
// where straight.
struct Bend {
  double value;
  Vec6 gradient;
  Vec3 t1, t2, g1, g2;
  double l1, l2, c, slope, curve;  // slope, curve: of the value by c

  Bend(const Vec3& d1, const Vec3& d2)
      : t1(d1.normalized()), t2(d2.normalized()), l1(d1.norm()), l2(d2.norm()) {
    c = t1.dot(t2);
    g1 = (t2 - c * t1) / l1;
    g2 = (t1 - c * t2) / l2;
    const double q = 1 + c;
    value = 0.5 * (t1 - t2).squaredNorm() / q;
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

class Bending final : public ForceBlock {
 public:
  explicit Bending(const Structure& structure) {
    for (const Force& f : structure.forces) {
      if (f.kind != "bending") continue;
      const auto at = [&](int k) {
        return structure.nodes[static_cast<std::size_t>(f.nodes[static_cast<std::size_t>(k)])].position;
      };
      const double mean = 0.5 * ((at(1) - at(0)).norm() + (at(2) - at(1)).norm());
      joints_.push_back({{f.nodes[0], f.nodes[1], f.nodes[2]}, 2 * f.stiffness / mean});
    }
  }
  bool empty() const { return joints_.empty(); }
  bool constant() const override { return false; }

  void add(const Moment&, const double* q, const double*, double scale, double* f) const override {
    for (const Joint& joint : joints_) {
      const Vec6 g = (scale * joint.factor) * joint.bend(q).gradient;
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

  // x -> (d_1, d_2) has the coefficients -1, 1, 0 and 0, -1, 1.
  void derivatives(const Moment&, const double* q, const double*, ForceDerivative& by_q,
                   ForceDerivative&) const override {
    Eigen::Matrix<double, 6, 9> D;
    const Mat3 one = Mat3::Identity(), none = Mat3::Zero();
    D << -one, one, none, none, -one, one;
    for (const Joint& joint : joints_) {
      const Eigen::Matrix<double, 9, 9> K = -joint.factor * D.transpose() * joint.bend(q).hessian() * D;
      for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) by_q.emplace_back(joint.coordinate(i), joint.coordinate(j), K(i, j));
    }
  }

 private:
  struct Joint {
    std::array<int, 3> nodes;
    double factor;  // 2 E I / L [N m]

    Bend bend(const double* q) const {
      const auto x = [&](std::size_t k) { return node_vector(q, nodes[k]); };
      return {x(1) - x(0), x(2) - x(1)};
    }
    Eigen::Map<Vec3> on(std::size_t k, double* f) const {
      return Eigen::Map<Vec3>(f + 3 * static_cast<Index>(nodes[k]));
    }
    int coordinate(int i) const { return 3 * nodes[static_cast<std::size_t>(i / 3)] + i % 3; }
  };
  std::vector<Joint> joints_;
};

}  // namespace

std::unique_ptr<ForceBlock> bending_block(const Structure& structure, const SparseRows&) {
  auto block = std::make_unique<Bending>(structure);
  if (block->empty()) return nullptr;
  return block;
}

const std::vector<ParamSpec>& bending_params() {
  static const std::vector<ParamSpec> params = {
      required(positive_param("stiffness", "N m^2", 1.0, "E I of the rod"))};
  return params;
}

void fill_bending(const ParamSet& values, Force& force) {
  force.stiffness = values.real("stiffness");
}

}  // namespace unfurl
