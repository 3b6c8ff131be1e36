// SPDX-License-Identifier: BSD-3-Clause
// Poses that keep all constraints, without forces and time: a node pulled by hand, a free motion followed.
#pragma once

#include "core/system/system.hpp"

namespace unfurl {

class FreePoses {
 public:
  // Drives let go: what moves with time is free, what is held (a gear, a latch) is kept. From the structure's
  // own pose on, or from the pose q [3 n] with the angles of its state (State::angles), which count turns.
  explicit FreePoses(const Structure& structure);
  FreePoses(const Structure& structure, const VectorXd& q, const VectorXd& angles);

  // From the pose q [3 n] of the solved nodes towards one in which a node is at `target` [m]: as near as the
  // constraints let it, by small steps that move everything else as little as they can. Every constraint
  // holds to 1e-10 of the structure's size; where no step keeps that, q itself.
  VectorXd pulled(const VectorXd& q, int node, const Vec3& target);

  // Orthonormal columns [3 n x k]: velocities of the nodes that keep all constraints at q, motions of the
  // whole as one rigid body aside. Empty where more than `most_coordinates` are solved for.
  MatrixXd motions(const VectorXd& q) const;
  static constexpr Index most_coordinates = 600;
  // Along such a motion: the node that moves most goes so far [m], and the constraints are met again.
  VectorXd moved(const VectorXd& q, const VectorXd& motion, double distance) const;

  double size() const { return size_; }   // largest distance of two nodes, about [m]
  double error(const VectorXd& q) const;  // largest constraint [m]

 private:
  State at_rest(VectorXd z) const;
  bool project(VectorXd& z) const;
  VectorXd node_at(const VectorXd& z, int node) const;
  VectorXd step_towards(const VectorXd& z, int node, const Vec3& way, double damping) const;
  SparseRows jacobian(const VectorXd& z, VectorXd& phi) const;

  System system_;
  double size_ = 1;
};

}  // namespace unfurl
