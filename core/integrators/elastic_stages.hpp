// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "core/forces/elastic_rods.hpp"
#include "core/integrators/galerkin.hpp"
#include "core/math/saddle_solver.hpp"
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
  // These rods, whose rows D = d|d|/dz are those of `rods`, are stiff in find_still_forces(): modes of
  // h omega > `stiff` of them. False: it cannot be asked.
  bool take_as_stiff(std::vector<Index> rods, double h, double stiff, const SparseRows& G,
                     const SparseRows& D);
  // Rods whose waves turn many times in a step, h omega > `fast`, become constraints of index 3, whose
  // velocities the Gauss points alone do not hold: what is left of D w at a step's end would grow from step
  // to step. Here it is taken out of w and mu, which solve M w + G^T mu = p, G w = rate, in the metric of the
  // mass, M w + G^T mu + D^T nu = p, D w = the rods' warming: in modes of h omega far above `stiff`. Slower
  // ones stay, as the bending of a truss, and the motion of a mechanism with more rods than it needs: these
  // contradict each other by what they are stretched, and held to the last digit would hold that, too.
  void still(double fast, double stiff, double t, double h, const VectorXd& q, const SparseRows& G,
             VectorXd& w, VectorXd& mu);
  // The axial forces of these rods that go with that pose and velocity: with two or three stages their
  // polynomial does not tell them, the motion does, for which they are rigid in their stiff modes,
  //
  //     M a + G^T lambda + D^T N = F,   G a = -bias,   D a = l'' - |u_across|^2 / |d|
  //
  // but for C N''. What rigid rods leave open stays as their lengths at the Gauss points have it: `force`,
  // which has all rods', changes by forces of least complementary energy. Only after still() or
  // take_as_stiff().
  void find_still_forces(double t, const VectorXd& q, const VectorXd& v, VectorXd& force);
  double compliance(Index i) const { return compliance_[i]; }
  // The rods that the last call of still() has held, or those taken as stiff since.
  const std::vector<Index>& held() const { return held_; }

  MatrixXd tension, residual;  // N [N], R [m]: rods x points
  bool as_unknowns = false;    // false: forces are what lengths tell, as those of any spring

 private:
  const System& system_;
  const GalerkinCoefficients& c_;
  const ElasticRods* rods_;
  // What answers rates r of the held rods by a motion of their stiff modes: M x + G^T mu + D^T nu = 0,
  // G x = 0, D x = P r.
  struct Answer {
    VectorXd x, mu, nu;
  };
  Answer answer(VectorXd r) const;
  VectorXd rates_of(const VectorXd& w) const;  // D w of the held rods

  VectorXd compliance_, stretch_;
  double level_ = 0;
  std::vector<Index> held_;
  SparseRows G_, D_;                              // of the last call
  std::unique_ptr<SaddleSolver> saddle_, rigid_;  // of G with D of the held rods; of G
  SparseRows rows_;                               // that saddle_ was analysed for
};

}  // namespace unfurl
