// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/books.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl {

namespace {

// Of each node coordinate [N].
VectorXd weight_of(const Model& model) {
  const SparseRows& mass = model.system.node_mass();
  VectorXd out = mass * model.structure.gravity.replicate(mass.rows() / 3, 1);
  for (std::size_t i = 0; i < model.structure.nodes.size(); ++i)
    if (model.structure.nodes[i].ghost) out.segment<3>(3 * static_cast<Index>(i)).setZero();
  return out;
}

}  // namespace

std::vector<double> energy_round_off(const Simulation& run) {
  constexpr double noise = 64 * std::numeric_limits<double>::epsilon();
  const Trajectory& trajectory = run.trajectory;
  std::vector<double> out;
  VectorXd force;
  double loads = 0;
  for (const Load& load : trajectory.structure().loads) loads += load.force.lpNorm<1>();
  double reach = 0, work = 0;  // so far; a state that is not finite leaves them as they are
  const auto grow = [](double& most, double x) { most = x > most && std::isfinite(x) ? x : most; };
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const System system = trajectory.model(i).system.at(trajectory.state(i));
    const VectorXd q = trajectory.node_positions(i), v = trajectory.node_velocities(i);
    force.setZero(q.size());
    system.add_applied_force(trajectory.time(i), q, v, 1.0, force);
    if (q.size()) grow(reach, q.lpNorm<Eigen::Infinity>());
    // What rests at the origin has coordinates of rounding alone: of the way that its forces make in a step.
    const VectorXd mass = system.node_mass().diagonal();
    for (Index k = 0; k < mass.size(); ++k)
      if (mass[k] > 0) grow(reach, std::abs(force[k]) / mass[k] * run.options.step * run.options.step);
    // Of gravity and loads by themselves, which other forces may balance: sums of them are rounded, too.
    const VectorXd weight = weight_of(trajectory.model(i));
    const double high = weight.dot(q);
    grow(work, std::max(force.lpNorm<1>(), weight.lpNorm<1>() + loads) * reach + std::abs(high) +
                   std::abs(system.potential_energy(q) + high) + std::abs(system.load_work(q)));
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

std::vector<double> energy_of_stopped_waves(const Simulation& run) {
  const Trajectory& trajectory = run.trajectory;
  std::vector<double> out;
  double most = 0;
  VectorXd start = VectorXd::Zero(std::ssize(trajectory.structure().rods));  // self-stress is no wave
  if (const Model& first = trajectory.model(0); !first.system.giving_rods().empty()) {
    const State& state = trajectory.state(0);
    VectorXd q(first.system.coordinates()), v = q, force(std::ssize(first.system.giving_rods()));
    first.system.expand(state.z, q);
    first.system.expand_rate(state.w, v);
    first.system.giving_rod_forces(state.t, q, v, force);
    start(first.system.giving_rods()) = force;
  }
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const VectorXd& tension = trajectory.state(i).tension;
    const Model& model = trajectory.model(i);
    double stored = 0;
    for (Index k = 0; k < tension.size(); ++k) {
      const int rod = model.system.giving_rods()[static_cast<std::size_t>(k)];
      stored += 0.5 * model.structure.rods[static_cast<std::size_t>(rod)].compliance() *
                std::pow(tension[k] - start[rod], 2);
    }
    most = stored > most && std::isfinite(stored) ? stored : most;
    out.push_back(4 * most * trajectory.structure().sectors);
  }
  return out;
}

}  // namespace unfurl
