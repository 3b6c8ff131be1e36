// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/drives.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "core/forces/motor.hpp"
#include "core/forces/spring.hpp"
#include "core/simulate/stops.hpp"

namespace unfurl {
namespace {

constexpr double unknown_effort = std::numeric_limits<double>::quiet_NaN();

// The row of a side of the stops that is held.
int held_row(const Model& model, int side) {
  const auto& constraints = model.structure.constraints;
  for (std::size_t i = constraints.size(); i-- > 0;)
    if (constraints[i].side == side) return model.system.constraint_row(static_cast<int>(i));
  return -1;
}

}  // namespace

int DriveChannel::row(const Model& model) const {
  if (kind_ == Kind::reel) return held_row(model, cable_);
  int row = -1;
  for (const Drive& d : model.system.drives())
    if (d.constraint == static_cast<int>(index_)) row = d.row;
  return row;
}

bool DriveChannel::unique(const Model& model, const std::vector<char>& rows) const {
  if (!by_row()) return true;
  const int row = this->row(model);
  if (row < 0) return kind_ == Kind::reel;  // nothing pulls
  return rows.empty() || rows[static_cast<std::size_t>(row)] != 0;
}

DriveSample DriveChannel::of_row(const Model& model, double t, const VectorXd& lambda) const {
  DriveSample s;
  // A reel stands still once the structure is locked.
  const TimeFunction& target = kind_ == Kind::reel ? model.structure.stops[index_].reel : target_;
  s.value = target(t);
  const int row = this->row(model);
  if (row < 0 && kind_ == Kind::reel) return s;
  s.effort = row >= 0 ? -scale_ * lambda[row] : unknown_effort;
  s.power = s.effort * target.derivative(1, t);
  return s;
}

DriveSample DriveChannel::sample(const Model& model, const System& system, double t, const VectorXd& q,
                                 const VectorXd& v, const VectorXd& lambda) const {
  if (by_row()) return of_row(model, t, lambda);
  const Force& force = model.structure.forces[index_];
  const MeasureFunction& measure = measure_.front();
  std::vector<double> gradient(measure.stencil().size());
  if (kind_ == Kind::motor) {
    const MotorState s =
        motor_state(force, measure, followed_, system.moment(t), q.data(), v.data(), gradient.data());
    return {s.value, s.effort, s.effort * s.rate};
  }
  const SpringLaw law = spring_law(force, t, q.data());
  const double s = measure.value_and_gradient(q.data(), gradient.data(), system.moment(t), followed_);
  const SpringPull pull = spring_pull(force, law, s, measure.rate(gradient.data(), v.data()) - law.rest_rate);
  return {law.rest, -pull.tension, pull.reeling};
}

double DriveChannel::work(const Model& model, double t, const VectorXd& lambda,
                          const std::function<double(int)>& of_reel) const {
  if (!by_row()) return 0.0;
  if (row(model) >= 0) return of_row(model, t, lambda).power;
  return kind_ == Kind::reel ? of_reel(cable_) : 0.0;
}

std::vector<DriveChannel> drive_channels(const Model& model) {
  std::vector<DriveChannel> out;
  std::set<std::string> taken;
  const auto add = [&](DriveChannel::Kind kind, const std::string& name, std::size_t index) -> DriveChannel& {
    DriveChannel channel;
    channel.kind_ = kind;
    channel.index_ = index;
    channel.name_ = name;  // a scene's names are unique in each of its tables, a program's need not be
    for (int number = 2; !taken.insert(channel.name_).second; ++number)
      channel.name_ = name + " (" + std::to_string(number) + ")";
    out.push_back(std::move(channel));
    return out.back();
  };
  for (const Drive& drive : model.system.drives()) {
    DriveChannel& c = add(DriveChannel::Kind::row, drive.name, static_cast<std::size_t>(drive.constraint));
    c.scale_ = drive.scale;
    c.angle_ = drive.angle;
    c.target_ = drive.target;
  }
  const Structure& structure = model.structure;
  const Stops stops(structure);
  for (std::size_t i = 0; i < stops.size(); ++i)
    if (stops[i].reeled)
      add(DriveChannel::Kind::reel, stops[i].name, static_cast<std::size_t>(stops[i].stop)).cable_ =
          static_cast<int>(i);
  const FollowedAngles followed = followed_angles(structure);
  for (std::size_t i = 0; i < structure.forces.size(); ++i) {
    const Force& force = structure.forces[i];
    const bool winch = force.kind == "cable" && force.unstressed.moves();
    if (force.kind != "motor" && !winch) continue;
    DriveChannel& c = add(winch ? DriveChannel::Kind::winch : DriveChannel::Kind::motor, force.name, i);
    c.angle_ = is_angle(force.measure);
    c.followed_ = followed.of_force[i];
    c.measure_.emplace_back(force.measure, structure.deployment);
  }
  return out;
}

DriveColumns::DriveColumns(const Model& model, std::vector<Series>& columns)
    : columns_(columns), first_(columns.size()), drives_(drive_channels(model)) {
  for (const DriveChannel& drive : drives_) {
    const std::string& name = drive.name();
    const bool angle = drive.angle();
    const char* effort = angle ? " torque" : " force";
    columns.push_back({name + (angle ? ".angle_rad" : ".value_m"), name, angle ? "rad" : "m", {}});
    columns.push_back({name + (angle ? ".torque_N_m" : ".force_N"), name + effort, angle ? "N m" : "N", {}});
    columns.push_back({name + ".power_W", name + " power", "W", {}});
    columns.push_back({name + ".energy_J", name + " energy", "J", {}});
    columns.push_back(
        {name + (angle ? ".torque_unique" : ".force_unique"), name + effort + " is unique", "", {}});
    if (angle) columns.push_back({name + ".angle_deg", name, "deg", {}});
  }
}

void DriveColumns::append(const Model& model, const System& system, double t, const VectorXd& q,
                          const VectorXd& v, const VectorXd& lambda,
                          const std::function<double(std::size_t)>& energy) {
  std::size_t column = first_;
  for (std::size_t d = 0; d < drives_.size(); ++d) {
    const DriveSample now = drives_[d].sample(model, system, t, q, v, lambda);
    for (const double x :
         {now.value, now.effort, now.power, energy(d), drives_[d].unique(model, {}) ? 1.0 : 0.0})
      columns_[column++].values.push_back(x);
    if (drives_[d].angle()) columns_[column++].values.push_back(now.value / radians_per_degree);
  }
}

}  // namespace unfurl
