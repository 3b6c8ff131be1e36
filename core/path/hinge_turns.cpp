// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/hinge_turns.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "core/forces/damping.hpp"

namespace unfurl {
namespace {

constexpr double in_line = 1e-7;  // sine of the angle below which its axis is not known

Vec3 node_of(const NodeCopy& node, const VectorXd& q) {
  return node.map * q.segment<3>(3 * static_cast<Index>(node.source)) + node.offset;
}

// Directions of both rods and how those change.
struct Arms {
  Vec3 a, b, da, db;
  Arms(const Hinge& hinge, const VectorXd& q, const VectorXd& dq) {
    direction(hinge.a_from, hinge.a_to, q, dq, a, da);
    direction(hinge.b_from, hinge.b_to, q, dq, b, db);
  }

 private:
  static void direction(const NodeCopy& from, const NodeCopy& to, const VectorXd& q, const VectorXd& dq,
                        Vec3& u, Vec3& du) {
    const Vec3 d = node_of(to, q) - node_of(from, q);
    const Vec3 rate = to.map * dq.segment<3>(3 * static_cast<Index>(to.source)) -
                      from.map * dq.segment<3>(3 * static_cast<Index>(from.source));
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

// Rods of the whole that end at the pin, then those that carry it between their ends.
std::vector<Hinge> hinges_of(const Structure& structure) {
  struct Line {
    std::string rod;
    NodeCopy from, to;
  };
  const std::vector<NodeCopy>& nodes = structure.node_copies;
  std::vector<std::vector<Line>> ends(nodes.size());
  for (const RodCopy& rod : structure.rod_copies)
    for (const auto& [from, to] : {std::pair{rod.a, rod.b}, std::pair{rod.b, rod.a}})
      ends[static_cast<std::size_t>(from)].push_back(
          {rod.name, nodes[static_cast<std::size_t>(from)], nodes[static_cast<std::size_t>(to)]});
  std::vector<char> seen(structure.nodes.size(), 0);
  std::vector<Hinge> out;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (std::exchange(seen[static_cast<std::size_t>(nodes[n].source)], 1)) continue;
    std::vector<Line> lines = ends[n];
    const auto beside = [&](int node) { return NodeCopy{"", node, nodes[n].map, nodes[n].offset}; };
    for (const RodAtJoint& rod : rods_at_joint(structure, nodes[n].source))
      if (rod.from != nodes[n].source)
        lines.push_back({structure.rods[rod.rod].name, beside(rod.from), beside(rod.to)});
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::size_t k = i + 1; k < lines.size(); ++k)
        out.push_back(
            {lines[i].rod + " / " + lines[k].rod, lines[i].from, lines[i].to, lines[k].from, lines[k].to});
  }
  return out;
}

double hinge_angle(const Hinge& hinge, const VectorXd& q) {
  const Vec3 a = node_of(hinge.a_to, q) - node_of(hinge.a_from, q),
             b = node_of(hinge.b_to, q) - node_of(hinge.b_from, q);
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
