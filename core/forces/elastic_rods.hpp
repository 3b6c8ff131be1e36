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
// This is the mixed form with e = C N eliminated: N is no unknown of its own. It is taken where forces that
// vary are, at the s - 1 Gauss points of a step, where the scheme is A-stable (integrators/galerkin.hpp).
class ElasticRods final : public ForceBlock {
 public:
  explicit ElasticRods(const Structure& structure);  // of the rods that give

  bool constant() const override { return false; }
  void add(const Moment& at, const double* q, const double* v, double scale, double* f) const override;
  double potential(const Moment& at, const double* q) const override;
  bool has_power() const override { return warmed_; }
  double power(const Moment& at, const double* q, const double* v) const override;
  void derivatives(const Moment& at, const double* q, const double* v, ForceDerivative& by_q,
                   ForceDerivative& by_v) const override;

  // Axial forces, dampers included, tension positive, in the order of the rods that give [N].
  void forces(double t, const double* q, const double* v, double* force) const;
  // f += scale * what rods with these axial forces pull their nodes with.
  void add_forces(const double* q, const double* force, double scale, double* f) const;

 private:
  std::vector<Rod> rods_;
  bool warmed_ = false;
};

// Their dampers, c = damping_time / C: N = c d|d|/dt. A material of relaxation time T damps a mode of
// frequency w by the ratio w T / 2.
std::unique_ptr<ForceBlock> elastic_rods_block(const Structure& structure, const SparseRows& node_mass);
std::unique_ptr<ForceBlock> rod_dampers_block(const Structure& structure, const SparseRows& node_mass);

}  // namespace unfurl
