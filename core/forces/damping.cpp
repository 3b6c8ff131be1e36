#include "core/forces/damping.hpp"

#include <Eigen/Geometry>
#include <limits>

namespace unfurl {
namespace {

Eigen::Map<const Vec3> at(const double* x, int node) {
  return Eigen::Map<const Vec3>(x + 3 * static_cast<Index>(node));
}

class Drag final : public ForceBlock {
 public:
  explicit Drag(const Structure& structure) {
    for (const Force& f : structure.forces)
      if (f.kind == "drag") points_.push_back({f.nodes[0], f.damping});
  }
  bool empty() const { return points_.empty(); }
  bool constant() const override { return false; }
  bool has_power() const override { return true; }
  bool dissipative() const override { return true; }
  void add(double, const double*, const double* v, double scale, double* f) const override {
    for (const auto& [node, c] : points_)
      Eigen::Map<Vec3>(f + 3 * static_cast<Index>(node)) -= scale * c * at(v, node);
  }
  double power(double, const double*, const double* v) const override {
    double sum = 0;
    for (const auto& [node, c] : points_) sum -= c * at(v, node).squaredNorm();
    return sum;
  }
  void derivatives(double, const double*, const double*, ForceDerivative&,
                   ForceDerivative& by_v) const override {
    for (const auto& [node, c] : points_)
      for (int k = 0; k < 3; ++k) by_v.emplace_back(3 * node + k, 3 * node + k, -c);
  }

 private:
  std::vector<std::pair<int, double>> points_;
};

// One pair of rods at a joint. F = -c B^T (w_1 - w_2), B the matrix of w_1 - w_2 = B v; a rod's part of B is
// [d]_x / |d|^2 on its second node, the opposite on its first.
struct Pair {
  int nodes[4];  // first and second node of either rod
  double c;
};

class JointDamping final : public ForceBlock {
 public:
  explicit JointDamping(const Structure& structure) {
    for (const Force& f : structure.forces) {
      if (f.kind != "joint_damping") continue;
      std::vector<const Rod*> rods;
      for (const Rod& rod : structure.rods)
        if (rod.a == f.nodes[0] || rod.b == f.nodes[0]) rods.push_back(&rod);
      for (std::size_t i = 0; i < rods.size(); ++i)
        for (std::size_t j = i + 1; j < rods.size(); ++j)
          pairs_.push_back({{rods[i]->a, rods[i]->b, rods[j]->a, rods[j]->b}, f.damping});
    }
  }
  bool empty() const { return pairs_.empty(); }
  bool constant() const override { return false; }
  bool has_power() const override { return true; }
  bool dissipative() const override { return true; }

  void add(double, const double* q, const double* v, double scale, double* f) const override {
    for (const Pair& p : pairs_) {
      const Vec3 torque = scale * p.c * relative(p, q, v);
      // B^T w of one rod: ([d]_x)^T w / |d|^2 = w x d / |d|^2
      const auto turn = [&](int a, int b, const Vec3& w) {
        const Vec3 d = at(q, b) - at(q, a), force = w.cross(d) / d.squaredNorm();
        Eigen::Map<Vec3>(f + 3 * static_cast<Index>(b)) += force;
        Eigen::Map<Vec3>(f + 3 * static_cast<Index>(a)) -= force;
      };
      turn(p.nodes[0], p.nodes[1], -torque);
      turn(p.nodes[2], p.nodes[3], torque);
    }
  }

  double power(double, const double* q, const double* v) const override {
    double sum = 0;
    for (const Pair& p : pairs_) sum -= p.c * relative(p, q, v).squaredNorm();
    return sum;
  }

  // dF/dv = -c B^T B; dF/dq is of the order of the small velocities' forces and is left out.
  void derivatives(double, const double* q, const double*, ForceDerivative&,
                   ForceDerivative& by_v) const override {
    for (const Pair& p : pairs_) {
      Eigen::Matrix<double, 3, 12> B;
      for (int rod = 0; rod < 2; ++rod) {
        const Vec3 d = at(q, p.nodes[2 * rod + 1]) - at(q, p.nodes[2 * rod]);
        Mat3 cross;
        cross << 0, -d[2], d[1], d[2], 0, -d[0], -d[1], d[0], 0;
        cross *= (rod == 0 ? 1.0 : -1.0) / d.squaredNorm();
        B.middleCols<3>(6 * rod) = -cross;
        B.middleCols<3>(6 * rod + 3) = cross;
      }
      const Eigen::Matrix<double, 12, 12> D = -p.c * B.transpose() * B;
      for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j)
          by_v.emplace_back(3 * p.nodes[i / 3] + i % 3, 3 * p.nodes[j / 3] + j % 3, D(i, j));
    }
  }

 private:
  static Vec3 spin(int a, int b, const double* q, const double* v) {
    const Vec3 d = at(q, b) - at(q, a);
    return d.cross(at(v, b) - at(v, a)) / d.squaredNorm();
  }
  static Vec3 relative(const Pair& p, const double* q, const double* v) {
    return spin(p.nodes[0], p.nodes[1], q, v) - spin(p.nodes[2], p.nodes[3], q, v);
  }
  std::vector<Pair> pairs_;
};

template <class Block>
std::unique_ptr<ForceBlock> block_of(const Structure& structure) {
  auto block = std::make_unique<Block>(structure);
  if (block->empty()) return nullptr;
  return block;
}

std::vector<ParamSpec> one_damping(const char* unit, const char* help) {
  ParamSpec damping = positive_param("damping", unit, 1.0, help);
  damping.required = true;
  return {damping};
}

}  // namespace

std::unique_ptr<ForceBlock> drag_block(const Structure& structure, const SparseRows&) {
  return block_of<Drag>(structure);
}

std::unique_ptr<ForceBlock> joint_damping_block(const Structure& structure, const SparseRows&) {
  return block_of<JointDamping>(structure);
}

const std::vector<ParamSpec>& joint_damping_params() {
  static const auto params = one_damping("N m s/rad", "torque per rad/s between any two rods at the node");
  return params;
}

const std::vector<ParamSpec>& drag_params() {
  static const auto params = one_damping("N s/m", "force against the velocity of the node");
  return params;
}

}  // namespace unfurl
