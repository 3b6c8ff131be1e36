// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/forces/elastic_rods.hpp"
#include "core/integrators/galerkin.hpp"
#include "core/integrators/stiff_modes.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// Rods that give, with their axial forces N as unknowns of a step, at the points tau_j of its quadrature:
//
//     R_j = e(tau_j) + damping_time e'(tau_j) - C N_j = 0
//
// (forces/elastic_rods.hpp). The motion is the one that N = (e + damping_time e') / C has; but Newton's
// matrix has C where that one has 1 / C, and what is left of R moves N by noise / (C + h^2 / m).
class ElasticStages {
 public:
  ElasticStages(const System& system, const GalerkinCoefficients& coefficients);
  bool any() const { return rods_ != nullptr; }

  void start_measuring() { level_ = 0; }
  // f += the forces of the rods at point j, where the nodes have this pose and velocity; finds R_j.
  void evaluate(Index j, double t, const VectorXd& q, const VectorXd& v, MutVec f);
  // The forces at point j that the lengths tell.
  void take_from_lengths(Index j, double t, const VectorXd& q, const VectorXd& v);
  double level() const { return level_; }  // the largest |R| in units of its noise
  double largest_force() const { return largest_magnitude(tension.data(), tension.size()); }
  // Impulses whose directions are known to what rounding the coordinates leaves, at their nodes [N s].
  void add_sizes(double h, VectorXd& f) const;
  // h sqrt(k / m) of rod i moving alone, from above.
  double h_omega(Index i, double h, const SparseRows& directions) const;
  // N' / omega of rod i moving alone: the amplitude of its wave where its velocity is the wave's [N].
  double rate_over_omega(Index i, double t, const VectorXd& w, const SparseRows& directions) const;
  // Modes far above h omega = `stiff` of rods of h omega > `fast`, from above, are held still: StiffModes.
  void still(double fast, double stiff, double t, double h, const VectorXd& q, const SparseRows& G,
             VectorXd& w, VectorXd& mu);
  // The motion x = M^-1 D^T nu in the modes that are held towards the lengths that go with these forces; adds
  // to nu [kg m, of all rods].
  VectorXd towards(double t, const VectorXd& q, const VectorXd& v, const VectorXd& force, VectorXd& nu);
  // d(D^T nu)/dz z', of the same in every direction: d|d|/dz turns with the rods.
  VectorXd turned(const VectorXd& q, const VectorXd& v, const VectorXd& nu) const;
  double compliance(Index i) const { return compliance_[i]; }

  MatrixXd tension, residual;  // N [N], R [m]: rods x points
  bool as_unknowns = false;    // false: forces are what lengths tell, as those of any spring
  StiffModes held;             // of the last call of still()
  StiffModes unresolved;       // of forces that the points do not tell

 private:
  const System& system_;
  const GalerkinCoefficients& c_;
  const ElasticRods* rods_;

  VectorXd compliance_, stretch_;
  double level_ = 0;
};

}  // namespace unfurl
