// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/hinge_turns.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace unfurl {
namespace {

constexpr double in_line = 1e-7;  // sine of the angle below which its axis is not known

// Directions of both rods and how those change.
struct Arms {
  Vec3 a, b, da, db;
  Arms(const Hinge& hinge, const VectorXd& q, const VectorXd& dq) {
    direction(hinge.pin, hinge.first, q, dq, a, da);
    direction(hinge.pin, hinge.second, q, dq, b, db);
  }

 private:
  static void direction(int from, int to, const VectorXd& q, const VectorXd& dq, Vec3& u, Vec3& du) {
    const auto between = [&](const VectorXd& x) {
      return Vec3(x.segment<3>(3 * static_cast<Index>(to)) - x.segment<3>(3 * static_cast<Index>(from)));
    };
    const Vec3 d = between(q), rate = between(dq);
    u = d.normalized();
    du = (rate - rate.dot(u) * u) / d.norm();
  }
};

double rate_of(const Arms& arms) {
  const Vec3 n = arms.a.cross(arms.b);
  const double sine = n.norm();
  if (sine < in_line) return arms.a.dot(arms.b) < 0 ? (arms.da + arms.db).norm() : (arms.da - arms.db).norm();
  return (arms.db.dot(n.cross(arms.b)) - arms.da.dot(n.cross(arms.a))) / sine;
}

}  // namespace

std::vector<Hinge> hinges_of(const Structure& structure) {
  std::vector<Hinge> out;
  const auto other = [&](const Rod& rod, int node) { return rod.a == node ? rod.b : rod.a; };
  for (int node = 0; node < static_cast<int>(structure.nodes.size()); ++node)
    for (std::size_t i = 0; i < structure.rods.size(); ++i)
      for (std::size_t k = i + 1; k < structure.rods.size(); ++k) {
        const Rod &a = structure.rods[i], &b = structure.rods[k];
        if ((a.a != node && a.b != node) || (b.a != node && b.b != node)) continue;
        out.push_back({a.name + " / " + b.name, node, other(a, node), other(b, node)});
      }
  return out;
}

double hinge_angle(const Hinge& hinge, const VectorXd& q) {
  const auto at = [&](int node) { return Vec3(q.segment<3>(3 * static_cast<Index>(node))); };
  const Vec3 a = at(hinge.first) - at(hinge.pin), b = at(hinge.second) - at(hinge.pin);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double hinge_rate(const Hinge& hinge, const VectorXd& q, const VectorXd& dq) {
  return rate_of(Arms(hinge, q, dq));
}

void HingeRates::evaluate(const VectorXd& q, const VectorXd& dq, VectorXd&, VectorXd& value,
                          VectorXd& scale) const {
  for (std::size_t i = 0; i < hinges_.size(); ++i) {
    const Arms arms(hinges_[i], q, dq);
    const double rate = rate_of(arms);
    value[static_cast<Index>(i)] = rate * rate;
    scale[static_cast<Index>(i)] =
        std::max(arms.da.squaredNorm() + arms.db.squaredNorm(), std::numeric_limits<double>::min());
  }
}

}  // namespace unfurl
