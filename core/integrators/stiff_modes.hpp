// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "core/forces/elastic_rods.hpp"
#include "core/math/saddle_solver.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// The modes of some of the rods that give, in one pose and for one step, that are stiffer than h omega =
// `stiff`: of what these rods are stretched by, P r, in the metric of the mass,
//
//     M x + G^T mu + D^T nu = 0,   G x = 0,   D x = P r,   D = d|d|/dz of these rods
//
// with P all but 10 (stiff / h omega)^6 of a mode far above and 10 (h omega / stiff)^6 of one far below. What
// stays is slow, as the bending of a truss, and the motion of a mechanism with more rods than it needs: these
// contradict each other by what they are stretched, and held to the last digit would hold that, too.
class StiffModes {
 public:
  explicit StiffModes(const System& system) : system_(system) {}

  // `D` has a row for every rod that gives. False, and no modes: it cannot be asked.
  bool take(std::vector<Index> rods, double h, double stiff, const SparseRows& G, const SparseRows& D);
  void clear() { rods_.clear(); }
  const std::vector<Index>& rods() const { return rods_; }

  // Rods whose waves turn many times in a step become constraints of index 3, whose velocities the Gauss
  // points alone do not hold: what is left of D w at a step's end would grow from step to step. This takes it
  // out of w and mu, which solve M w + G^T mu = p, G w = rate, but for the rods' warming.
  void still(double t, VectorXd& w, VectorXd& mu) const;
  // That of every rod that gives which stops them so [N s].
  VectorXd impulse(double t, const VectorXd& w) const;
  // The axial forces of these rods that go with that pose and velocity, told by the motion, for which they
  // are rigid in their stiff modes,
  //
  //     M a + G^T lambda + D^T N = F,   G a = -bias,   D a = l'' - |u_across|^2 / |d|
  //
  // but for C N''. What rigid rods leave open stays: `force`, which has all rods', changes by forces of least
  // complementary energy.
  void find_forces(double t, const VectorXd& q, const VectorXd& v, VectorXd& force);
  // x of these stretches of all rods that give; nu, of all of them, becomes less by that of these.
  VectorXd motion_of(const VectorXd& stretch, VectorXd& nu) const;

 private:
  struct Answer {
    VectorXd x, mu, nu;
  };
  Answer answer(VectorXd r) const;
  Answer stopping(double t, const VectorXd& w) const;
  VectorXd rates_of(const VectorXd& w) const;  // D w of these rods
  const Rod& rod_at(Index k) const;

  const System& system_;
  std::vector<Index> rods_;
  SparseRows G_, D_;
  std::unique_ptr<SaddleSolver> saddle_, rigid_;  // of G with D of these rods; of G
  SparseRows rows_;                               // that saddle_ was analysed for
};

}  // namespace unfurl
