// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/force_round_off.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/structure/node_positions.hpp"

namespace unfurl {

double force_round_off(const Simulation& run) {
  // Of what the structure is; of how far off it stands, which only its coordinates have, and velocities not.
  constexpr double noise = 64 * std::numeric_limits<double>::epsilon(), of_place = noise / 8,
                   of_forces = 1e-12;
  const Trajectory& trajectory = run.trajectory;
  const Structure& structure = trajectory.structure();
  const auto grow = [](double& most, double x) { most = x > most ? x : most; };
  double acting = 0, reach = 0, size = 0, speed = 0, mass = 0, stiffness = 0;
  double shortest = std::numeric_limits<double>::infinity();
  for (const Load& load : structure.loads) grow(acting, load.force.lpNorm<Eigen::Infinity>());
  for (const Rod& rod : structure.rods) {
    if (rod.length > 0) shortest = std::min(shortest, rod.length);
    if (rod.gives && rod.compliance() > 0) grow(stiffness, 1 / (rod.compliance() * rod.multiplicity));
  }
  const Index in_space = space_coordinates(structure);
  VectorXd force;
  constexpr std::size_t looked_at = 200;  // tell the sizes of a run, the last one among them
  const std::size_t every = (trajectory.size() + looked_at - 1) / looked_at;
  for (std::size_t left = trajectory.size(); left > 0; left -= std::min(left, every)) {
    const std::size_t i = left - 1;
    const System system = trajectory.model(i).system.at(trajectory.state(i));
    const VectorXd q = trajectory.node_positions(i), v = trajectory.node_velocities(i);
    if (in_space == 0) continue;
    force.setZero(q.size());
    system.add_applied_force(trajectory.time(i), q, v, 1.0, force);
    grow(acting, force.lpNorm<Eigen::Infinity>());
    // Rotors and drums behind the nodes turn, and are at the origin, wherever the structure stands.
    const VectorXd masses = VectorXd(system.node_mass().diagonal()).head(in_space);
    const auto places = q.head(in_space).reshaped(3, in_space / 3);
    grow(acting, masses.lpNorm<Eigen::Infinity>() * structure.gravity.lpNorm<Eigen::Infinity>());
    grow(reach, places.lpNorm<Eigen::Infinity>());
    grow(size, (places.rowwise().maxCoeff() - places.rowwise().minCoeff()).maxCoeff());
    grow(speed, v.head(in_space).lpNorm<Eigen::Infinity>());
    grow(mass, masses.sum() / 3);
  }
  const double elapsed = trajectory.end_time() - trajectory.start_time();
  const double step =
      elapsed > 0 && run.steps > 0 ? elapsed / static_cast<double>(run.steps) : run.options.step;
  const double off = noise * std::min(size, reach) + of_place * reach;  // [m]
  const double turning = noise * speed + off / step;
  return of_forces * acting + mass * turning * turning / shortest + stiffness * off;
}

MatrixXd without_round_off(const Simulation& run, const Diagnostics& d, MatrixXd values) {
  if (values.size() == 0) return values;
  const double least = force_round_off(run);
  for (Index i = 0; i < values.rows(); ++i)
    for (Index r = 0; r < values.cols(); ++r)
      if (std::abs(d.axial_force(i, r)) <= least && !std::isnan(values(i, r))) values(i, r) = 0;
  return values;
}

bool only_round_off(const Simulation& run, const Diagnostics& d) {
  const double least = force_round_off(run);
  for (const double force : d.axial_force.reshaped())
    if (std::abs(force) > least) return false;
  return true;
}

bool is_force(const Series& column) {
  return column.unit == "N" || column.unit == "N m" || column.unit == "Pa" ||
         column.name.ends_with("_ratio_max");
}

double round_off_within_steps(const Series& force, const Diagnostics& diagnostics) {
  double largest = 0;
  const auto take = [&](double x) { largest = std::isfinite(x) ? std::max(largest, std::abs(x)) : largest; };
  std::ranges::for_each(force.values, take);
  if (force.unit == "N") std::ranges::for_each(diagnostics.axial_force.reshaped(), take);
  return 1e-4 * largest;
}

}  // namespace unfurl
