// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "core/forces/force.hpp"

namespace unfurl {

// Rods that give: with the stretch e = |d| - l(t), l(t) the length without force, which follows the rod's
// temperature, and C = l / (E A) of all that the rod stands for,
//
//     N = e / C,     F = -N d|d|/dq,     V = e^2 / 2 C,     power put in by a change of temperature -N l'(t)
//
// and with its damper, c = damping_time / C, N = (e + damping_time e') / C, e' = d|d|/dt - l'(t). Forces that
// vary are taken at the s - 1 Gauss points of a step, where the scheme is A-stable
// (integrators/galerkin.hpp). A step that resolves a rod's waves may take N from its length. For one that
// does not, the same equation is a row
//
//     R = e + damping_time e' - C N = 0,     dR/dq = n + damping_time P u / |d|,   dR/dv = damping_time n
//
// with N an unknown (n = d/|d| the row d|d|/dq, P = 1 - n n^T, u the relative velocity): as C -> 0 the row of
// a rigid rod, and round-off of the length moves N by no more than it does there, not by 1 / C.
class ElasticRods final : public ForceBlock {
 public:
  explicit ElasticRods(const Structure& structure);  // of the rods that give

  bool constant() const override { return false; }
  bool of_giving_rods() const override { return true; }
  void add(const Moment& at, const double* q, const double* v, double scale, double* f) const override;
  double potential(const Moment& at, const double* q) const override;
  bool has_power() const override { return warmed_; }
  double power(const Moment& at, const double* q, const double* v) const override;
  void derivatives(const Moment& at, const double* q, const double* v, ForceDerivative& by_q,
                   ForceDerivative& by_v) const override;

  const std::vector<Rod>& rods() const { return rods_; }
  // e + damping_time e' [m].
  void stretches(double t, const double* q, const double* v, double* e) const;
  // d|d|/dq, and of the rows R, by q and by v.
  void directions(const double* q, ForceDerivative& by_q) const;
  void row_derivatives(const double* q, const double* v, ForceDerivative& by_q, ForceDerivative& by_v) const;
  // dF/dq at these axial forces: what the turning of the rods makes.
  void turning(const double* q, const double* force, ForceDerivative& by_q) const;

  // Axial forces, dampers included, tension positive, in the order of the rods that give [N].
  void forces(double t, const double* q, const double* v, double* force) const;
  // f += scale * what rods with these axial forces pull their nodes with.
  void add_forces(const double* q, const double* force, double scale, double* f) const;

 private:
  std::vector<Rod> rods_;
  bool warmed_;
};

// Their dampers, c = damping_time / C: N = c e'. A material of relaxation time T damps a mode of
// frequency w by the ratio w T / 2.
std::unique_ptr<ForceBlock> elastic_rods_block(const Structure& structure, const SparseRows& node_mass);
std::unique_ptr<ForceBlock> rod_dampers_block(const Structure& structure, const SparseRows& node_mass);

}  // namespace unfurl
