// SPDX-License-Identifier: BSD-3-Clause
// Small motions of a structure about a pose, of rods that have a modulus.
#pragma once

#include <vector>

#include "core/simulate/trajectory.hpp"

namespace unfurl {

struct VibrationMode {
  double frequency = 0.0;  // [Hz]; 0 where nothing pulls back
  double growth = 0.0;     // > 0: the pose is unstable, x ~ exp(growth t) [1/s]; with a frequency: flutter
  bool mechanism = false;  // of the mechanism: rods keep lengths and, cut into parts, shapes to first order
  VectorXd shape;          // velocities of the whole structure's nodes, the largest 1 [3 N]
};

// Mechanism motions first, then the others, each by rising stiffness.
struct Vibration {
  std::vector<VibrationMode> modes;
  Index mechanism_motions = 0;  // the degrees of freedom of the rigid structure
  double t = 0.0;               // of the pose [s]
  bool unique = true;           // every rod's force is, and with it the prestress
  // The first frequency of the elastic structure; NaN: no rod is elastic.
  double lowest_elastic() const;
};

// About the pose of a state of the model, held at rest: the equations M x'' + K x = 0 on the null space of
// the rigid rows G_r,
//
//     G_r x = 0,    K = G_e^T C^-1 G_e + sum_k lambda_k Hess Phi_k - dF/dz
//
// with C the compliances of the elastic rods' rows G_e and lambda the forces at that pose at rest under its
// loads, accelerations included, and with the self-stress of rods that give. An elastic rod has the energy of
// its length, 1/2 (|d| - l_0)^2 / C with tension lambda at |d| = l, while Phi = (|d|^2 - l^2) / 2 l: Hess |d|
// = Hess Phi - g g^T / l there. Drives, latches and stops that hold are rows, and so locked, as are the sums
// of controllers' errors. Velocities and dampers are left out. Where dF/dz has a part without a potential, as
// that of a follower, K is not symmetric and is solved for as it is: w^2 may be complex, in pairs, and the
// pose flutters.
//
// Rods are much stiffer than what pulls a mechanism back, and a symmetric eigenvalue solver is right to
// round-off of the largest eigenvalue only. So the null space of all rows, N_0, is solved for by itself, with
// what it draws along in its complement N_1 in the mass metric, x = (N_0 - N_1 K_11^-1 K_10) y, where that is
// small. Dense: for up to max_vibration_coordinates solved coordinates.
Vibration vibration(const Model& model, const State& pose);
inline constexpr Index max_vibration_coordinates = 1500;

}  // namespace unfurl
