// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/pin_loads.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/math/saddle_solver.hpp"

namespace unfurl {
namespace {

constexpr int most_rounds = 200;
constexpr double settled = 4 * std::numeric_limits<double>::epsilon();

Structure without_pin_friction(const Structure& structure) {
  Structure out = structure;
  for (Force& force : out.forces)
    if (PinLoads::arm(force) > 0) force.slip = 0, force.size.offset = 0;
  return out;
}

// Nodes without mass that are held: any mass will do.
SparseRows positive_mass(const SparseRows& mass) {
  SparseRows out = mass;
  for (Index i = 0; i < out.rows(); ++i)
    if (!(out.coeff(i, i) > 0)) out.coeffRef(i, i) = 1.0;
  out.makeCompressed();
  return out;
}

}  // namespace

bool PinLoads::any(const Structure& structure) {
  return std::any_of(structure.forces.begin(), structure.forces.end(),
                     [](const Force& force) { return arm(force) > 0; });
}

int PinLoads::rod_of(const Structure& structure, const Force& force) {
  if (force.measure.kind != MeasureKind::angle || force.measure.nodes[0] != force.measure.nodes[2]) return -1;
  const int hinge = force.measure.nodes[0], other = force.measure.nodes[1];
  for (std::size_t i = 0; i < structure.rods.size(); ++i) {
    const Rod& rod = structure.rods[i];
    if ((rod.a == hinge && rod.b == other) || (rod.b == hinge && rod.a == other)) return static_cast<int>(i);
  }
  return -1;
}

PinLoads::PinLoads(const Structure& structure, const SparseRows& node_mass)
    : bare_(without_pin_friction(structure)), mass_(positive_mass(node_mass)) {
  for (const ForceKind& kind : force_kinds())
    if (auto block = kind.make(bare_, node_mass)) forces_.push_back(std::move(block));
  if (std::any_of(bare_.rods.begin(), bare_.rods.end(), [](const Rod& r) { return r.gives; }))
    rods_ = std::make_unique<ElasticRods>(bare_);
  for (const ConstraintKind& kind : constraint_kinds()) {
    auto block = kind.make(bare_);
    if (!block) continue;
    if (kind.kind == "rod") rod_row_ = rows_;
    rows_ += block->rows();
    constraints_.push_back(std::move(block));
  }
  const std::vector<int> followed = followed_angles(structure).of_force;
  for (std::size_t i = 0; i < structure.forces.size(); ++i) {
    const int rod = rod_of(structure, structure.forces[i]);
    if (arm(structure.forces[i]) > 0 && rod >= 0) add_pin(structure, i, rod, followed[i], node_mass);
  }
}

void PinLoads::add_pin(const Structure& structure, std::size_t force, int rod, int followed,
                       const SparseRows& node_mass) {
  const Force& f = structure.forces[force];
  const auto before = static_cast<int>(std::count_if(structure.rods.begin(), structure.rods.begin() + rod,
                                                     [](const Rod& r) { return r.gives; }));
  const bool gives = structure.rods[static_cast<std::size_t>(rod)].gives;
  std::vector<char> apart;
  for (const Force& any : structure.forces) apart.push_back(arm(any) > 0);
  pins_.push_back({force, MeasureFunction(f.measure, structure.deployment), followed, f.kinetic, arm(f),
                   f.slip, rod, f.measure.nodes[0], f.measure.nodes[1], gives ? -1 : rod - before,
                   gives ? before : -1,
                   RodCouples(bare_, node_mass, constraints_, rod, f.measure.nodes[0], apart)});
}

SparseRows PinLoads::jacobian(const double* q) const {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> values;
  int row = 0;
  for (const auto& block : constraints_) {
    std::size_t count = 0, next = 0;
    for (int r = 0; r < block->rows(); ++r) count += block->stencil(r).size();
    values.resize(count);
    block->jacobian(q, values.data());
    for (int r = 0; r < block->rows(); ++r, ++row)
      for (const int c : block->stencil(r)) entries.emplace_back(row, c, values[next++]);
  }
  SparseRows G(rows_, mass_.rows());
  G.setFromTriplets(entries.begin(), entries.end());
  return G;
}

Vec3 PinLoads::linear_load(const Pin& pin, const double* q, const Response& r) const {
  const Rod& rod = bare_.rods[static_cast<std::size_t>(pin.rod)];
  const Vec3 here = r.a.segment<3>(3 * pin.hinge), there = r.a.segment<3>(3 * pin.other);
  Vec3 load = bare_.lumped_mass ? Vec3(rod.mass / 2 * here) : Vec3(rod.mass / 6 * (2 * here + there));
  if (pin.row >= 0)
    load +=
        r.lambda[rod_row_ + pin.row] / rod.length * (node_vector(q, pin.hinge) - node_vector(q, pin.other));
  return load + pin.couples.of_rows(q, r.lambda);
}

Vec3 PinLoads::given_load(const Pin& pin, const Moment& at, const double* q, const double* v) const {
  const Rod& rod = bare_.rods[static_cast<std::size_t>(pin.rod)];
  const Vec3 load = -rod.mass / 2 * bare_.gravity + pin.couples.of_forces(at, q, v);
  if (pin.giving < 0) return load;
  std::vector<double> pull;
  if (!at.tension) {
    pull.resize(rods_->rods().size());
    rods_->forces(at.t, q, v, pull.data());
  }
  return load + (at.tension ? at.tension : pull.data())[pin.giving] * along(pin, q);
}

// To all other forces, and to a unit torque of each friction in the sense in which its hinge is held back.
// Empty: the equations cannot be solved.
std::vector<PinLoads::Response> PinLoads::responses(const Moment& at, const double* q, const double* v,
                                                    const SparseRows& G) const {
  const Index n = mass_.rows();
  VectorXd force = VectorXd::Zero(n), bias = VectorXd::Zero(rows_);
  for (const auto& block : forces_)
    if (!at.tension || !block->of_giving_rods()) block->add(at, q, v, 1.0, force.data());
  if (at.tension) rods_->add_forces(q, at.tension, 1.0, force.data());
  double* row = bias.data();
  for (const auto& block : constraints_) {
    block->bias(q, v, row);
    if (block->rheonomic()) block->add_target(2, at.t, -1.0, row);
    row += block->rows();
  }
  SaddleSolver saddle(mass_, G);
  if (!saddle.factorise(G)) return {};
  std::vector<Response> out;
  const auto respond = [&](const VectorXd& f, const VectorXd& g) {
    out.push_back({VectorXd(n), VectorXd(rows_)});
    saddle.solve(f, g, out.back().a, out.back().lambda);
  };
  respond(force, -bias);
  for (const Pin& pin : pins_) respond(unit_torque(pin, at, q, pin.slip), VectorXd::Zero(rows_));
  return out;
}

VectorXd PinLoads::unit_torque(const Pin& pin, const Moment& at, const double* q, double slip) const {
  VectorXd force = VectorXd::Zero(mass_.rows()), gradient(std::ssize(pin.measure.stencil()));
  pin.measure.value_and_gradient(q, gradient.data(), at.near(pin.followed, pin.measure.reference()));
  for (Index i = 0; i < gradient.size(); ++i)
    force[pin.measure.stencil()[static_cast<std::size_t>(i)]] -= slip * gradient[i];
  return force;
}

// F = F_0 + tau dF/dtau with tau = mu r |F| has an answer for every F_0 while mu r |dF/dtau| < 1.
std::vector<double> PinLoads::longest_arms(double t, const double* q) const {
  std::vector<double> out(bare_.forces.size(), std::numeric_limits<double>::infinity());
  const SparseRows G = jacobian(q);
  SaddleSolver saddle(mass_, G);
  if (!saddle.factorise(G)) return out;
  for (const Pin& pin : pins_) {
    Response r{VectorXd(mass_.rows()), VectorXd(rows_)};
    saddle.solve(unit_torque(pin, t, q, 1.0), VectorXd::Zero(rows_), r.a, r.lambda);
    out[pin.force] = 1 / (linear_load(pin, q, r) - pin.couples.of_measure(pin.force, q)).norm();
  }
  return out;
}

PinLoads::SelfLocking PinLoads::self_locking(const Structure& structure, const SparseRows& node_mass,
                                             double t, const double* q) {
  if (!any(structure)) return {};
  const std::vector<double> most = PinLoads(structure, node_mass).longest_arms(t, q);
  for (std::size_t i = 0; i < most.size(); ++i) {
    const Force& force = structure.forces[i];
    if (!(arm(force) >= most[i])) continue;
    const Rod& rod = structure.rods[static_cast<std::size_t>(rod_of(structure, force))];
    std::ostringstream text;
    text.precision(3);
    text << "times pin_radius is " << arm(force) << " m, and must be below " << most[i]
         << " m in this pose: rod " << rod.name << " of " << rod.length
         << " m locks itself on the pin, whose friction raises the pin's force by more than it takes to make "
            "it; give a smaller pin_friction or pin_radius, or a constant torque by kinetic";
    return {force.name, text.str()};
  }
  return {};
}

int PinLoads::giving_rod(std::size_t force) const {
  for (const Pin& pin : pins_)
    if (pin.force == force) return pin.giving;
  return -1;
}

PinLoads::Loads PinLoads::evaluate(const Moment& at, const double* q, const double* v) const {
  const std::vector<double> none(bare_.forces.size(), 0.0);
  Loads out{none, none};
  const std::size_t count = pins_.size();
  const SparseRows G = jacobian(q);
  const std::vector<Response> all = responses(at, q, v, G);
  std::vector<double> tau(count);
  std::vector<std::vector<Vec3>> loads(count);  // of each pin, by each response
  for (std::size_t k = 0; k < count && !all.empty(); ++k) {
    const Pin& pin = pins_[k];
    tau[k] = pin.slip ? pin.kinetic : 0.0;
    loads[k].push_back(given_load(pin, at, q, v) + linear_load(pin, q, all[0]));
    for (std::size_t i = 0; i < count; ++i)
      loads[k].push_back(linear_load(pin, q, all[i + 1]) -
                         pins_[i].slip * pin.couples.of_measure(pins_[i].force, q));
  }
  for (int round = 0; round < most_rounds && !all.empty(); ++round) {
    double change = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const Pin& pin = pins_[k];
      Vec3 sum = loads[k][0];
      for (std::size_t i = 0; i < count; ++i) sum += tau[i] * loads[k][i + 1];
      out.size[pin.force] = sum.norm();
      if (pin.giving >= 0 && sum.norm() > 0) out.by_tension[pin.force] = along(pin, q).dot(sum) / sum.norm();
      const double next = pin.slip ? pin.kinetic + pin.arm * sum.norm() : 0.0;
      change = std::max(change, std::abs(next - tau[k]) / std::max(next, 1e-300));
      tau[k] = next;
    }
    if (change <= settled) return out;
    if (!std::isfinite(change)) break;
  }
  for (const Pin& pin : pins_) out.size[pin.force] = std::numeric_limits<double>::quiet_NaN();
  return out;
}

}  // namespace unfurl
