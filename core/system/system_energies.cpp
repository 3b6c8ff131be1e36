// SPDX-License-Identifier: BSD-3-Clause
// Energies and powers of a System.
#include <algorithm>
#include <limits>

#include "core/system/system_data.hpp"

namespace unfurl {

void System::Data::find_integrators(const Structure& structure) {
  for (const Force& force : structure.forces) {
    if (force.motor.integrator < 0) continue;
    const auto at = std::ranges::find(free_coordinates, 3 * force.motor.integrator);
    if (at != free_coordinates.end()) integrators.push_back(at - free_coordinates.begin());
  }
}

double System::kinetic_energy(const ConstVec& w) const {
  if (data_->integrators.empty()) return 0.5 * w.dot(data_->mass * w);
  VectorXd moving = w;  // beside what moves slowly a sum may change by anything
  moving(data_->integrators).setZero();
  return 0.5 * moving.dot(data_->mass * moving);
}

VectorXd System::moving_mass() const {
  VectorXd m = data_->mass.diagonal();
  m(data_->integrators).setConstant(std::numeric_limits<double>::infinity());
  return m;
}

double System::potential_energy(const ConstVec& q) const {
  double sum = -data_->gravity_force.dot(q);
  for (const auto& block : data_->forces) sum += block->potential(moment(since_), q.data());
  return sum;
}
System System::loaded(const Structure& structure) const {
  System out = *this;
  out.set_loads(structure);
  return out;
}
bool System::take_loads_of(const System& other) {
  if (data_ != other.data_) return false;
  constant_ = other.constant_;
  return true;
}
void System::set_loads(const Structure& structure) {
  VectorXd loads = VectorXd::Zero(data_->coordinates);
  for (const Load& load : structure.loads) loads.segment<3>(3 * load.node) += load.force;
  VectorXd force = data_->unloaded_force + loads;
  constant_ = std::make_shared<const Constant>(Constant{std::move(loads), std::move(force)});
}

double System::load_work(const ConstVec& q) const {
  return constant_->loads.dot(q - data_->start);
}

bool System::has_power(bool dissipative) const {
  return std::any_of(data_->forces.begin(), data_->forces.end(), [&](const auto& block) {
    return dissipative ? block->dissipates() : block->supplies();
  });
}

double System::power(bool dissipative, double t, const ConstVec& q, const ConstVec& v,
                     const double* tension) const {
  const Moment at = moment(t, tension);
  double sum = 0;
  for (const auto& block : data_->forces)
    if ((dissipative ? block->dissipates() : block->supplies()) && !block->takes_by_pose()) {
      const double taken = block->dissipation(at, q.data(), v.data());
      sum += dissipative ? taken : block->power(at, q.data(), v.data()) - taken;
    }
  return sum;
}

double System::taken(const ConstVec& q) const {
  double sum = 0;
  for (const auto& block : data_->forces) sum += block->taken(moment(since_), q.data());
  return sum;
}

}  // namespace unfurl
