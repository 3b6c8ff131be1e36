// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/energy_flow.hpp"

#include <memory>

#include "core/diagnostics/quintic.hpp"
#include "core/integrators/index1.hpp"
#include "core/math/quadrature.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {
EnergyMeter::EnergyMeter(const System& system)
    : system_(system),
      loads_(system.has_power(false)),
      dampers_(system.has_power(true)),
      drives_(!system.drives().empty()) {
  if (idle()) return;
  index1_ = std::make_unique<Index1>(system_);
  q_.resize(system.coordinates());
  v_.resize(system.coordinates());
  unused_.resize(system.solved_coordinates());
  lambda_.resize(system.constraints());
}

VectorXd EnergyMeter::acceleration(const State& state) {
  VectorXd a(state.z.size());
  system_.follow(state);
  if (!index1_->evaluate(state.t, state.z, state.w, a, lambda_)) a.setZero();
  return a;
}

void EnergyMeter::add(const State& a, const State& b) {
  if (idle()) return;
  static const Quadrature gauss = gauss_legendre(3);
  before_ = after_.size() && last_ == a.t ? after_ : acceleration(a);
  after_ = acceleration(b);
  last_ = b.t;
  const Quintic ends{a, b, before_, after_, b.t - a.t};
  system_.follow(a);
  for (Index i = 0; i < gauss.nodes.size(); ++i) {
    const double u = gauss.nodes[i], t = a.t + u * ends.h, weight = ends.h * gauss.weights[i];
    const VectorXd z = ends.value(u), w = ends.rate(u);
    system_.expand(z, q_);
    system_.expand_rate(w, v_);
    if (loads_) load_work += weight * system_.power(false, t, q_, v_);
    if (dampers_) dissipated -= weight * system_.power(true, t, q_, v_);
    if (!drives_ || !index1_->evaluate(t, z, w, unused_, lambda_)) continue;
    for (const Drive& d : system_.drives())
      drive_work -= weight * d.scale * lambda_[d.row] * d.target.derivative(1, t);
  }
}

EnergyFlow energy_flow(const Simulation& run) {
  const Trajectory& trajectory = run.trajectory;
  EnergyFlow flow{{0.0}, {0.0}, {0.0}, {0.0}};
  std::unique_ptr<EnergyMeter> meter;
  const Model* model = nullptr;
  for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
    for (auto* list : {&flow.load_work, &flow.dissipated, &flow.drive_work, &flow.impact_loss})
      list->push_back(list->back());
    const State &a = trajectory.state(i), &b = trajectory.state(i + 1);
    if (same_instant(a.t, b.t)) {  // an impulse; where time goes on a little, of a drive
      const double gain =
          trajectory.model(i + 1).system.kinetic_energy(b.w) - trajectory.model(i).system.kinetic_energy(a.w);
      (b.t > a.t ? flow.drive_work : flow.impact_loss).back() += b.t > a.t ? gain : -gain;
      if (meter) meter->jump();
      continue;
    }
    if (model != &trajectory.model(i + 1)) {
      model = &trajectory.model(i + 1);
      meter = std::make_unique<EnergyMeter>(model->system);
    }
    const double load_work = meter->load_work, dissipated = meter->dissipated, drive_work = meter->drive_work;
    meter->add(a, b);
    flow.load_work.back() += meter->load_work - load_work;
    flow.dissipated.back() += meter->dissipated - dissipated;
    flow.drive_work.back() += meter->drive_work - drive_work;
  }
  return flow;
}

}  // namespace unfurl
