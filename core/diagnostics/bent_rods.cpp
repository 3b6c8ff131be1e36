// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/bent_rods.hpp"

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <set>

#include "core/forces/force.hpp"
#include "core/math/factors.hpp"

namespace unfurl {
namespace {

constexpr double straight = 1e-12;   // |t_1 - t_2|
constexpr double on_a_line = 1e-10;  // of a rod's length: it has no turn about itself

using Joint = std::array<int, 3>;

// The nodes of every rod that was cut, from end to end.
std::vector<std::vector<int>> chains_of(const Structure& structure) {
  std::vector<std::vector<int>> chains;
  for (std::size_t r = 0; r < structure.rods.size();) {
    const Rod& first = structure.rods[r];
    const auto parts = static_cast<std::size_t>(first.whole.empty() ? 1 : first.parts);
    if (parts > 1) {
      chains.push_back({first.a});
      for (std::size_t k = 0; k < parts; ++k) chains.back().push_back(structure.rods[r + k].b);
    }
    r += parts;
  }
  return chains;
}

// Rows that vanish where the nodes move as one rigid body: the complement of its translations and turns.
MatrixXd rows_of_rigid(const std::vector<int>& nodes, const VectorXd& q) {
  const Index n = std::ssize(nodes);
  Eigen::Matrix3Xd x(3, n);
  for (Index i = 0; i < n; ++i) x.col(i) = node_vector(q.data(), nodes[static_cast<std::size_t>(i)]);
  x.colwise() -= Vec3(x.rowwise().mean());
  x /= x.norm();
  MatrixXd motions(3 * n, 6);
  for (Index i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) {
      motions.block<3, 1>(3 * i, k) = Vec3::Unit(k) / std::sqrt(static_cast<double>(n));
      motions.block<3, 1>(3 * i, 3 + k) = Vec3::Unit(k).cross(x.col(i));
    }
  const MatrixXd rest = column_complement(motions, on_a_line);
  MatrixXd rows = MatrixXd::Zero(rest.cols(), q.size());
  for (Index i = 0; i < n; ++i)
    rows.middleCols<3>(3 * nodes[static_cast<std::size_t>(i)]) = rest.middleRows<3>(3 * i).transpose();
  return rows;
}

// g_1 and g_2 of a joint; true: it is bent.
bool joint_rows(const Joint& nodes, const VectorXd& q, Eigen::Ref<MatrixXd> rows) {
  const auto x = [&](std::size_t k) { return node_vector(q.data(), nodes[k]); };
  const Vec3 d1 = x(1) - x(0), d2 = x(2) - x(1), t1 = d1.normalized(), t2 = d2.normalized(),
             along = (t1 + t2).normalized();
  const bool bent = (t2 - t1).norm() > straight;
  const Vec3 e1 = bent ? Vec3((t2 - t1).normalized()) : Vec3(along.unitOrthogonal()), e2 = along.cross(e1);
  for (int k = 0; k < 2; ++k) {
    const Vec3& e = k == 0 ? e1 : e2;
    const Vec3 by_1 = (e - t1.dot(e) * t1) / d1.norm(), by_2 = (e - t2.dot(e) * t2) / d2.norm();
    rows.block<1, 3>(k, 3 * nodes[0]) = by_1.transpose();
    rows.block<1, 3>(k, 3 * nodes[1]) = -(by_1 + by_2).transpose();
    rows.block<1, 3>(k, 3 * nodes[2]) = by_2.transpose();
  }
  return bent;
}

}  // namespace

BentRods::BentRods(const Structure& structure, const VectorXd& q) {
  const std::vector<std::vector<int>> chains = chains_of(structure);
  if (chains.empty()) return;
  std::map<Joint, std::size_t> force_at;
  for (std::size_t f = 0; f < structure.forces.size(); ++f)
    if (const auto& n = structure.forces[f].nodes; structure.forces[f].kind == "bending")
      force_at[{n[0], n[1], n[2]}] = f;
  std::vector<MatrixXd> of_rods, of_joints;
  std::vector<double> values;
  std::set<std::size_t> idle;
  for (const std::vector<int>& nodes : chains) {
    of_rods.push_back(rows_of_rigid(nodes, q));
    for (std::size_t k = 1; k + 1 < nodes.size(); ++k) {
      const Joint joint{nodes[k - 1], nodes[k], nodes[k + 1]};
      const auto force = force_at.find(joint);
      if (force == force_at.end()) continue;
      const auto at = [&](std::size_t i) {
        return structure.nodes[static_cast<std::size_t>(joint[i])].position;
      };
      const double mean = 0.5 * ((at(1) - at(0)).norm() + (at(2) - at(1)).norm());
      of_joints.push_back(MatrixXd::Zero(2, q.size()));
      const bool is_bent = joint_rows(joint, q, of_joints.back());
      if (!is_bent) idle.insert(force->second);
      bent.insert(bent.end(), 2, static_cast<char>(is_bent));
      values.insert(values.end(), 2, structure.forces[force->second].stiffness / mean);
    }
  }
  const auto stacked = [&](const std::vector<MatrixXd>& blocks) {
    Index count = 0, next = 0;
    for (const MatrixXd& block : blocks) count += block.rows();
    MatrixXd out(count, q.size());
    for (const MatrixXd& block : blocks) {
      out.middleRows(next, block.rows()) = block;
      next += block.rows();
    }
    return out;
  };
  rows = stacked(of_joints);
  rigid = stacked(of_rods);
  stiffness = Eigen::Map<const VectorXd>(values.data(), std::ssize(values));
  unbent = structure;
  unbent.forces.clear();
  for (std::size_t f = 0; f < structure.forces.size(); ++f)
    if (!idle.contains(f)) unbent.forces.push_back(structure.forces[f]);
}

}  // namespace unfurl
