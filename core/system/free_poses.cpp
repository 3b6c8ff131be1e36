// SPDX-License-Identifier: BSD-3-Clause
// With z the solved coordinates, Phi(z) the constraints, G their Jacobian and x(z) = J z + x0 a node:
//
//   a step towards x + d      min  mu |dz|^2 + |J dz - d|^2 + W |G dz|^2
//   back onto Phi = 0         dz = -(G^T G + eps)^-1 G^T Phi, again and again (Gauss and Newton; redundant
//                             rows do no harm, and what is free stays where it is)
//
// mu grows while a step leads away from x + d, and falls again (Levenberg and Marquardt).
#include "core/system/free_poses.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/math/factors.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/node_positions.hpp"

namespace unfurl {

namespace {

constexpr double met = 1e-10;           // of a constraint, in units of the structure's size
constexpr double least_damping = 1e-4;  // mu: of moving at all, where nothing speaks for more
constexpr double kept = 1e4;            // W: of constraints
constexpr double longest_step = 0.04;   // of a node, in units of the size
constexpr int most_free_steps = 12, most_projections = 30;
constexpr double free_value = 1e-12;  // eigenvalue of G^T G, in units of the largest

// Gears, and whatever else holds a measure at a value, are no drives. The row between a rotor and its joint
// leads the rotor, which is nowhere.
bool drives(const Structure& structure, const Constraint& c) {
  const auto is_rotor = [&](const MeasureTerm& term) {
    const std::vector<int>& nodes = term.measure.nodes;
    return nodes.size() == 1 && structure.nodes[static_cast<std::size_t>(nodes[0])].ghost;
  };
  return c.kind == "measure" && (c.target.moves() || std::ranges::any_of(c.measure.terms, is_rotor));
}

Structure without_drives(Structure structure) {
  std::erase_if(structure.constraints, [&](const Constraint& c) { return drives(structure, c); });
  return structure;
}

// Of the angles that a structure follows, in its order, those that are followed without its drives.
VectorXd without_drives(const Structure& structure, const VectorXd& angles) {
  std::vector<char> leaves(followed_angles(structure).measures.size(), 0);
  const std::vector<int> first = followed_angles(structure).of_constraint;
  for (std::size_t c = 0; c < structure.constraints.size(); ++c) {
    const Constraint& constraint = structure.constraints[c];
    if (first[c] < 0 || !drives(structure, constraint)) continue;
    const auto own = std::ranges::count_if(constraint.measure.terms, counts_turns, &MeasureTerm::measure);
    std::fill_n(leaves.begin() + first[c], own, 1);
  }
  std::vector<double> stay;
  for (std::size_t i = 0; i < leaves.size() && static_cast<Index>(i) < angles.size(); ++i)
    if (!leaves[i]) stay.push_back(angles[static_cast<Index>(i)]);
  return Eigen::Map<const VectorXd>(stay.data(), static_cast<Index>(stay.size()));
}

double size_of_structure(const Structure& structure) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Node& node : structure.nodes) {
    if (node.ghost) break;  // they come last, and are nowhere
    low = low.cwiseMin(node.position);
    high = high.cwiseMax(node.position);
  }
  const double size = (high - low).norm();
  return size > 0 && std::isfinite(size) ? size : 1.0;
}

SparseColumns identity(Index n, double value) {
  SparseColumns I(n, n);
  I.setIdentity();
  return value * I;
}

// Velocities of a rigid body at the pose q: three translations, three rotations about the middle; behind them
// those of the numbers of drives, which are nowhere in space and follow as they must.
MatrixXd rigid_motions(const VectorXd& q, const std::vector<int>& ghosts) {
  MatrixXd R = MatrixXd::Zero(q.size(), 6 + 3 * std::ssize(ghosts));
  std::vector<Index> in_space;
  for (Index i = 0; i < q.size(); i += 3)
    if (std::ranges::find(ghosts, static_cast<int>(i / 3)) == ghosts.end()) in_space.push_back(i);
  Vec3 middle = Vec3::Zero();
  for (const Index i : in_space) middle += q.segment<3>(i) / static_cast<double>(in_space.size());
  for (const Index i : in_space)
    for (Index k = 0; k < 3; ++k) {
      R(i + k, k) = 1;
      R.block<3, 1>(i, 3 + k) = Vec3::Unit(k).cross(q.segment<3>(i) - middle);
    }
  for (std::size_t g = 0; g < ghosts.size(); ++g)
    R.block<3, 3>(3 * ghosts[g], 6 + static_cast<Index>(3 * g)).setIdentity();
  return R;
}

// An orthonormal basis of what the columns span: `least` of what is left of a column counts.
MatrixXd orthonormal(const MatrixXd& A, double least) {
  return A.cols() == 0 ? A : column_space(A, least);
}

}  // namespace

FreePoses::FreePoses(const Structure& structure) : FreePoses(structure, node_positions(structure), {}) {}

FreePoses::FreePoses(const Structure& structure, const VectorXd& q, const VectorXd& angles)
    : system_(without_drives(structure), true), size_(size_of_structure(structure)) {
  State there = at_rest(system_.reduce(q));
  there.angles = without_drives(structure, angles);
  system_.follow(there);
}

State FreePoses::at_rest(VectorXd z) const {
  State state;
  state.w = VectorXd::Zero(z.size());
  state.z = std::move(z);
  return state;
}

SparseRows FreePoses::jacobian(const VectorXd& z, VectorXd& phi) const {
  VectorXd q(system_.coordinates());
  system_.expand(z, q);
  phi.resize(system_.constraints());
  system_.constraint(0, q, phi);
  SparseRows G = system_.jacobian_pattern();
  std::vector<double> scratch;
  system_.jacobian(q, G, scratch);
  return G;
}

double FreePoses::error(const VectorXd& q) const {
  VectorXd phi(system_.constraints());
  system_.constraint(0, q, phi);
  return phi.size() > 0 ? phi.cwiseAbs().maxCoeff() : 0.0;
}

bool FreePoses::project(VectorXd& z) const {
  for (int i = 0; i < most_projections; ++i) {
    VectorXd phi;
    const SparseRows G = jacobian(z, phi);
    if (phi.size() == 0 || phi.cwiseAbs().maxCoeff() <= met * size_) return true;
    SparseColumns A = SparseColumns(G.transpose() * G) + identity(z.size(), 1e-10);
    const SparseCholesky solver(A);
    const VectorXd step = solver.solve(VectorXd(G.transpose() * phi));
    if (!solver.ok() || !step.allFinite() || step.cwiseAbs().maxCoeff() > size_) return false;
    z -= step;
  }
  return false;
}

VectorXd FreePoses::node_at(const VectorXd& z, int node) const {
  VectorXd q(system_.coordinates());
  system_.expand(z, q);
  return q.segment<3>(3 * node);
}

VectorXd FreePoses::step_towards(const VectorXd& z, int node, const Vec3& way, double damping) const {
  VectorXd phi;
  const SparseRows G = jacobian(z, phi);
  SparseColumns A = kept * SparseColumns(G.transpose() * G) + identity(z.size(), damping);
  VectorXd right = VectorXd::Zero(z.size());
  for (Index c = 0; c < 3; ++c) {  // a row of J each
    VectorXd unit = VectorXd::Zero(system_.coordinates()), row = VectorXd::Zero(z.size());
    unit[3 * node + c] = 1;
    system_.reduce_force(unit, row);
    const SparseColumns J = row.sparseView();
    A += SparseColumns(J * J.transpose());
    right += way[c] * row;
  }
  const SparseCholesky solver(A);
  return solver.solve(right);
}

VectorXd FreePoses::pulled(const VectorXd& q, int node, const Vec3& target) {
  VectorXd z = system_.reduce(q);
  double away = (target - node_at(z, node)).norm(), damping = least_damping;
  for (int i = 0; i < most_free_steps && away > 1e-9 * size_; ++i) {
    Vec3 way = target - node_at(z, node);
    if (way.norm() > longest_step * size_) way *= longest_step * size_ / way.norm();
    const VectorXd step = step_towards(z, node, way, damping);
    VectorXd next = z + step;
    const bool sound = step.allFinite() && project(next);
    const double left = sound ? (target - node_at(next, node)).norm() : away;
    if (left < away * (1 - 1e-6)) {
      z = std::move(next);
      away = left;
      State there = at_rest(z);  // each step is short: an angle goes to the nearest turn
      system_.count_on(there);
      system_.follow(there);
      damping = std::max(0.1 * damping, least_damping);
    } else {
      // Near the end of the way, all but stretched, a node goes nowhere for small dz and back for large ones.
      damping *= 10;
    }
  }
  VectorXd pose(system_.coordinates());
  system_.expand(z, pose);
  return error(pose) <= 2 * met * size_ ? pose : q;
}

MatrixXd FreePoses::motions(const VectorXd& q) const {
  const VectorXd z = system_.reduce(q);
  if (z.size() == 0 || z.size() > most_coordinates) return MatrixXd(q.size(), 0);
  VectorXd phi;
  const MatrixXd G = MatrixXd(jacobian(z, phi));
  MatrixXd N = MatrixXd::Identity(z.size(), z.size());
  if (G.rows() > 0) {
    const SymmetricEigen eigen = symmetric_eigen(G.transpose() * G);
    const double largest = std::max(eigen.values.maxCoeff(), 1e-300);
    Index count = 0;
    while (count < z.size() && eigen.values[count] < free_value * largest) ++count;
    N = eigen.vectors.leftCols(count).eval();
  }
  MatrixXd V(q.size(), N.cols());
  for (Index k = 0; k < N.cols(); ++k) {
    VectorXd v(q.size());
    system_.expand_rate(N.col(k), v);
    V.col(k) = v;
  }
  V = orthonormal(V, 1e-9);
  // Rigid motions that are free, and what is left without them.
  const MatrixXd R = orthonormal(rigid_motions(q, system_.ghosts()), 1e-9 * std::max(1.0, size_));
  const MatrixXd rest = R - V * (V.transpose() * R);
  // Squares of singular values, ascending.
  const SymmetricEigen left = symmetric_eigen(rest.transpose() * rest);
  const Index free = (left.values.array() < 1e-12).count();
  const MatrixXd rigid = R * left.vectors.leftCols(free);
  return orthonormal(V - rigid * (rigid.transpose() * V), 1e-6);
}

VectorXd FreePoses::moved(const VectorXd& q, const VectorXd& motion, double distance) const {
  double most = 0;
  for (Index i = 0; i < motion.size(); i += 3) most = std::max(most, motion.segment<3>(i).norm());
  VectorXd z = system_.reduce(q);
  if (most > 0) z += system_.reduce_rate(distance / most * motion);
  if (!project(z)) return q;
  VectorXd pose(system_.coordinates());
  system_.expand(z, pose);
  return pose;
}

}  // namespace unfurl
