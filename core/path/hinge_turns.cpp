// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/hinge_turns.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/forces/damping.hpp"

namespace unfurl {
namespace {

constexpr double in_line = 1e-7;  // sine of the angle below which its axis is not known

// Directions of both rods and how those change.
struct Arms {
  Vec3 a, b, da, db;
  Arms(const Hinge& hinge, const VectorXd& q, const VectorXd& dq) {
    direction(hinge.a_from, hinge.a_to, q, dq, a, da);
    direction(hinge.b_from, hinge.b_to, q, dq, b, db);
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
  for (int node = 0; node < static_cast<int>(structure.nodes.size()); ++node) {
    const std::vector<RodAtJoint> rods = rods_at_joint(structure, node);
    for (std::size_t i = 0; i < rods.size(); ++i)
      for (std::size_t k = i + 1; k < rods.size(); ++k)
        out.push_back({structure.rods[rods[i].rod].name + " / " + structure.rods[rods[k].rod].name,
                       rods[i].from, rods[i].to, rods[k].from, rods[k].to});
  }
  return out;
}

double hinge_angle(const Hinge& hinge, const VectorXd& q) {
  const auto at = [&](int node) { return Vec3(q.segment<3>(3 * static_cast<Index>(node))); };
  const Vec3 a = at(hinge.a_to) - at(hinge.a_from), b = at(hinge.b_to) - at(hinge.b_from);
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
