// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/integrators/constraint_increment.hpp"
#include "core/integrators/elastic_stages.hpp"
#include "core/integrators/galerkin.hpp"
#include "core/integrators/part_sizes.hpp"
#include "core/integrators/row_noise.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// The level of the constraints (in units of their noise, see below) at which the iteration of a step ends.
inline constexpr double constraint_level_wanted = 2.0;

// What rounding the coordinates, as large as `reach`, leaves of a constraint of this length [m].
inline double constraint_noise(double length, double reach) {
  return 2 * std::numeric_limits<double>::epsilon() * std::max(length, reach);
}

// Unknowns and residuals of one variational step; allocated once per model.
// A row holds one coordinate or constraint at all nodes (interleaved.hpp).
//   dX [nz x s-1]: increments of the nodes 2..s from the step's start;  lambda [m x s-1]: multipliers of
//   nodes 1..s-1 momentum [nz x s-1]: D_k S (+ p_0 for k = 1), kg m/s;  phi [m x s-1]: Phi(Q_j), j = 2..s, m
// With constraints at the ends only, lambda has its first column and phi its last one in use; the rest stays
// zero.
class StageEquations {
 public:
  StageEquations(const System& system, const GalerkinCoefficients& coefficients, bool at_ends);

  void start(double t, const ConstVec& z0, const ConstVec& w0, double h);  // w0: p_0 = M w0
  void place_nodes();                                                      // Q of the present dX
  void evaluate();  // residuals of the present dX, lambda
  // true: phi is what the step changes, Phi(Q_j) - Phi(Q_1), whose round-off is relative to that change and
  // not to the coordinates; the start's own residual is left alone. Slower; for nearly singular poses.
  bool in_increments = false;
  // dF/dz, dF/dz' at point j of the quadrature, at given forces of the rods that give where these are
  // unknowns (allocates).
  void force_derivatives(Index j, SparseRows& by_z, SparseRows& by_w);
  // d|d|/dz of these rods there, and the derivatives of their rows by z and z' (allocates).
  void rod_derivatives(Index j, SparseRows& directions, SparseRows& by_z, SparseRows& by_w);
  SparseRows tension_derivatives(Index j);  // of other forces, by these rods' (allocates)
  // Whether the forces of rods that give are unknowns, which starts them as they were last.
  void take_rods_as_unknowns(bool unknowns);
  // Looks at the derivatives of the forces at the step's start: what they make of round-off, and how stiff
  // they are for the step (allocates).
  void look_at_forces() { look_at_forces(q_0_); }
  void look_at_forces(const VectorXd& q);  // the same in this pose, at the start's velocity
  // Counts what rounding makes of the forces at the present end, too: stiff ones turn with their rods. False:
  // that is known, or there is nothing to count.
  bool look_at_turned_forces();
  const SparseRows& force_by_z() const { return by_z_; }  // dF/dz where they were looked at last
  const SparseRows& force_by_w() const { return by_w_; }  // dF/dz'
  // Forgets the forces: they are looked at before the next step.
  void restart() {
    stiffness_ = -1;
    rods.tension.setZero();
  }
  double h_omega() const;  // h sqrt(k / m) of the stiffest spring, from above
  double h_rate() const;   // h c / m of the strongest damper, from above
  // Whether h omega, from above, of any force but those of rods that give is more (allocates).
  bool others_unresolved(double resolved);
  // Axial forces of the rods that give at the step's end, with velocity w_1: by their lengths; for rods of
  // h omega > `resolved`, whose waves are not resolved, so that the end's coordinates do not tell them, by
  // the polynomial through those at the points of the quadrature. By the motion, for which they are rigid,
  // those of the modes that are held still and, with fewer than four stages, of all modes of h omega >
  // `resolved`: there the points of the quadrature do not tell them; not so beside waves of other forces that
  // are not resolved, which the end's coordinates do not tell, either. `error`: what modes that are neither
  // resolved nor stopped may change of them, by what lengths say of them, by what the motion says without
  // them and by the rate at which they change over omega [N].
  void end_tension(const VectorXd& w_1, double resolved, VectorXd& tension, VectorXd& error);
  // The same of the rods that are held still, whose lengths need not be held yet.
  VectorXd held_tension(const VectorXd& w_1, double resolved);
  // At the points of the quadrature, as powers take them: with fewer than four stages by the motion for rods
  // of h omega > `beyond`.
  MatrixXd stage_tension(double beyond);
  // Puts below these rows the multipliers there, by the polynomial through those of the nodes; `last` are
  // those of the end.
  void add_multipliers(const VectorXd& last, MatrixXd& tension) const;
  // Whether the constraints leave no motion free (looked for once, at the present start, and not in
  // structures of many coordinates): lengths are what drives make them, and tell forces whatever the step.
  bool held();
  void end_momentum(MutVec p1);  // p_1 without the share of lambda_s

  // Residuals in units of what round-off leaves of them: 1 is as small as they get, give or take.
  double momentum_level() const { return momentum_level_; }
  double constraint_level() const { return constraint_level_; }
  double level() const { return std::max(momentum_level_, constraint_level_); }

  // What rounding the coordinates leaves of row r of Phi [m]. A residual below it carries no information; in
  // redundant rows it would be answered with multipliers of size (residual / regularisation).
  double constraint_noise(Index r) const {
    return unfurl::constraint_noise(system.constraint_lengths()[r], far_ ? row_reach_[r] : reach_);
  }

  double multiplier_weight(int k) const;                 // b_k, or 1/2 for the ends variant; k = 0..s-1
  const VectorXd& start_pose() const { return q_0_; }    // node coordinates at node 0
  void pose(int k, VectorXd& q) const { q = Q.col(k); }  // at node k; q must have its size

  const System& system;
  const GalerkinCoefficients& c;
  const bool at_ends;
  double t = 0, h = 0;
  VectorXd z0, p0;
  Interleaved dX, lambda, momentum, phi;
  Interleaved Q;  // [3 nodes x s]
  ElasticStages rods;
  PartSizes parts;

 private:
  static constexpr int fewest_that_tell = 4;  // stages whose points tell the forces of waves not resolved
  static constexpr double momentum_noise = 4 * std::numeric_limits<double>::epsilon();
  // What is at rest beside other nodes in motion counts as moving by this share of theirs: its forces come
  // from theirs, members of nets just going taut among them, whose stiffness is not yet known.
  static constexpr double beside_motion = 1e-3;
  template <LaneCount K>
  void spread_forces();
  void evaluate_momentum();
  template <LaneCount K>
  void add_inertia();
  template <LaneCount K>
  void measure_constraints();
  void use_step();
  void move_to(Index j);
  // Moves to the step's end: its forces by lengths, those of modes that are held by the motion; false: that
  // does not tell them.
  bool end_by_motion(const VectorXd& w_1, double resolved, VectorXd& tension);
  // The modes of h omega > `stiff` of these rods at the pose moved to.
  bool take_unresolved(std::vector<Index> rods, const SparseRows& directions, double stiff);
  void applied_forces();
  void constraint_changes();
  void measure();
  template <LaneCount K>
  void measure_rows();
  void find_reach();
  void start_rows();

  Interleaved Z_, MdX_;      // coordinates and M dX_j of nodes 2..s
  Interleaved applied_, f_;  // impulses of the applied forces and of all forces on nodes 1..s-1
  VectorXd q_0_;
  MatrixXd force_;    // node forces at the quadrature times or (constant) one column
  MatrixXd impulse_;  // [s x s-1], or (constant) [s x 1]: h w_j l_k(tau_j), row k
  MatrixXd C_by_h_;
  VectorXd time_, scale_;  // of nodes 2..s [s]; -h b_k of nodes 1..s-1
  double C_size_ = 0;      // largest entry of C
  double start_size_ = 0;  // of p0
  VectorXd f_end_, q_tau_, v_tau_, w_tau_, w_0_, rod_sizes_;
  System::StageScratch scratch_;
  std::unique_ptr<ConstraintIncrement> increment_;  // made when first needed
  VectorXd dX_j_, phi_j_;
  VectorXd step_sizes_;       // of row_noise.hpp: what the step's start and constant forces give
  VectorXd forces_, motion_;  // largest magnitudes over the nodes
  bool step_sizes_known_ = false, turned_known_ = false;
  double momentum_level_ = 0, constraint_level_ = 0;
  // Largest magnitudes: forces, coordinates, M dX, momentum; whether all residuals are finite.
  double force_scale_ = 0, reach_ = 0, inertia_size_ = 0, momentum_size_ = 0;
  bool finite_ = true;
  ForceDerivatives derivatives_;
  SparseRows by_z_, by_w_;       // dF/dz [N/m], dF/dz' [N s/m] where they were looked at last
  double stiffness_ = -1;        // largest entry of by_z_; negative: not looked at yet
  double damping_ = 0;           // and of by_w_
  double omega_ = 0, rate_ = 0;  // bounds of sqrt(k / m) and of c / m [1/s], rods that give included
  double looked_ = 0;            // when [s]
  std::optional<bool> held_;
  double least_mass_ = 0, steepest_ = 0;  // smallest M_ii; largest sum over k of |l_k'(tau_j)|
  RowNoise rows_;                         // the same row by row, where that makes a difference
  // Some nodes are so far from the origin that the noise of each row goes by its own reach.
  bool far_ = false;
  double shortest_ = 0;  // length of a constraint
  VectorXd row_reach_;
};

}  // namespace unfurl
