// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/initial_state.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "core/integrators/index1.hpp"
#include "core/structure/node_positions.hpp"

namespace unfurl {
namespace {

// Regularisation of a projection next to a singular pose: modes whose scaled singular value lies below its
// root would answer round-off with motion, and stay as they are.
constexpr double weak_modes_left_alone = 1e-6;

}  // namespace

Projector::Projector(const System& system)
    : system_(system),
      jacobian_(system.jacobian_pattern()),
      saddle_(system.mass(), jacobian_, 1, weak_modes_left_alone) {}

void Projector::operator()(State& state) {
  system_.follow(state);
  VectorXd q(system_.coordinates()), phi(system_.constraints()), x(system_.solved_coordinates());
  VectorXd y(phi.size()), rate(phi.size());
  const VectorXd no_force = VectorXd::Zero(x.size());
  for (int it = 0; it < 2; ++it) {
    system_.expand(state.z, q);
    system_.constraint(state.t, q, phi);
    system_.jacobian(q, jacobian_, scratch_);
    if (!saddle_.factorise(jacobian_)) return;
    saddle_.solve(no_force, -phi, x, y, 0);
    state.z += x;
  }
  const VectorXd p = system_.mass() * state.w;
  system_.target_rate(state.t, rate);
  saddle_.solve(p, rate, state.w, y);
}

void project(const System& system, State& state) {
  Projector{system}(state);
}

VectorXd fitted_rates(const System& system, double t, const ConstVec& q, const ConstVec& v) {
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  system.jacobian(q, G, scratch);
  SaddleSolver saddle(system.mass(), G);
  if (!saddle.factorise(G))
    throw CannotFactorise("the constraint matrix cannot be factorised where velocities change");
  VectorXd p(system.solved_coordinates()), w(p.size()), y(system.constraints()), rate(y.size());
  system.target_rate(t, rate);
  system.reduce_force(system.node_mass() * v, p);
  saddle.solve(p, rate, w, y);
  return w;
}

InitialState initial_state(const Structure& structure, const System& system) {
  const VectorXd q = node_positions(structure);
  VectorXd v(q.size());
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    v.segment<3>(3 * static_cast<Index>(i)) = structure.nodes[i].velocity;
  InitialState out;
  State& s = out.state;
  s.z = system.reduce(q);
  s.lambda.setZero(system.constraints());
  // B w ~ v in the mass metric: exact where v fulfils the linear constraints.
  s.w = system.reduce_rate(v);
  VectorXd rate(system.constraints());
  system.target_rate(0.0, rate);
  if (!v.isZero(0.0) || !rate.isZero(0.0)) {
    VectorXd back(system.coordinates());
    s.w = fitted_rates(system, 0.0, q, v);
    system.expand_rate(s.w, back);
    for (Index i = 0; i < space_coordinates(structure); i += 3)
      if (!v.segment<3>(i).isZero(0.0))
        out.velocity_change = std::max(out.velocity_change, (back - v).segment<3>(i).norm());
  }
  System followed = system.at(s);
  followed.count_on(s);
  VectorXd acceleration(system.solved_coordinates());
  Index1 index1(followed);
  if (!index1.evaluate(0.0, s.z, s.w, acceleration, s.lambda)) s.lambda.setZero();
  return out;
}

std::string velocity_warning(const InitialState& start, const Structure& structure) {
  double fastest = 0;
  for (const Node& node : structure.nodes)
    if (!node.ghost) fastest = std::max(fastest, node.velocity.norm());
  if (fastest == 0 || start.velocity_change <= 1e-9 * fastest) return {};  // none given: a drive sets out
  std::ostringstream text;
  text << "the initial velocities violate the constraints and were projected on them (largest change "
       << start.velocity_change << " m/s)";
  return text.str();
}

}  // namespace unfurl
