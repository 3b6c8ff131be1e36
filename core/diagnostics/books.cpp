// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/books.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl {

std::vector<double> energy_round_off(const Simulation& run) {
  constexpr double noise = 64 * std::numeric_limits<double>::epsilon();
  const Trajectory& trajectory = run.trajectory;
  std::vector<double> out;
  VectorXd force;
  double reach = 0, work = 0;  // so far; a state that is not finite leaves them as they are
  const auto grow = [](double& most, double x) { most = x > most ? x : most; };
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const System system = trajectory.model(i).system.at(trajectory.state(i));
    const VectorXd q = trajectory.node_positions(i), v = trajectory.node_velocities(i);
    force.setZero(q.size());
    system.add_applied_force(trajectory.time(i), q, v, 1.0, force);
    if (q.size()) grow(reach, q.lpNorm<Eigen::Infinity>());
    // What rests at the origin has coordinates of rounding alone: of the way that its forces make in a step.
    const VectorXd mass = system.node_mass().diagonal();
    for (Index k = 0; k < std::min(mass.size(), force.size()); ++k)
      if (mass[k] > 0) grow(reach, std::abs(force[k]) / mass[k] * run.options.step * run.options.step);
    grow(work,
         force.lpNorm<1>() * reach + std::abs(system.potential_energy(q)) + std::abs(system.load_work(q)));
    // So far: a run that is not kept whole has made more than it has states.
    const auto behind = static_cast<long>(trajectory.size() - 1 - i);
    const auto steps = static_cast<double>(std::max(static_cast<long>(i), run.steps - behind));
    const double elapsed = trajectory.time(i) - trajectory.start_time();
    const double speed = elapsed > 0 ? noise * reach * steps / elapsed : 0.0;
    const double energy =
        std::sqrt(steps + 1) * noise * work + system.node_mass().diagonal().sum() * speed * speed;
    out.push_back(energy * trajectory.structure().sectors);
  }
  return out;
}

}  // namespace unfurl
