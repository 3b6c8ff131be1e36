// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/latch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/forces/latch_spring.hpp"
#include "core/integrators/index1.hpp"
#include "core/simulate/initial_state.hpp"

namespace unfurl {
namespace {

// A share of the coordinates. Latches hold heights in space: a rim that what it carries has tilted is
// turned back as they close, by the least motion; without that, the rods would take its errors.
constexpr double settled = 1e-13;
constexpr int most_projections = 30;  // each leaves 1e-6 / (sigma^2 + 1e-6) of a mode, twice

double constraint_error(const System& system, const State& state) {
  if (system.constraints() == 0) return 0.0;
  VectorXd q(system.coordinates()), phi(system.constraints());
  system.expand(state.z, q);
  system.constraint(state.t, q, phi);
  return phi.cwiseQuotient(system.constraint_lengths()).lpNorm<Eigen::Infinity>();
}

// All that waits for the deployed pose, as one: several entries hold each place side by side, and what it
// bears is what they bear together.
std::optional<Force> waiting_spring(const Structure& structure) {
  std::optional<Force> sum;
  for (const Force& force : structure.forces) {
    if (!latch_waits(force)) continue;
    if (sum) {
      sum->stiffness += force.stiffness;
      sum->damping += force.damping;
    } else {
      sum = force;
    }
  }
  return sum;
}

// An impulse changes no length: rods that give pull as before it, where lengths do not tell their forces.
// What their dampers add by the rates that it has changed is not followed.
void keep_tension(const Model& from, const State& before, const Model& to, State& after) {
  if (before.tension_error.size() == 0 || from.system.giving_rods() != to.system.giving_rods()) return;
  after.tension = before.tension;
  after.tension_error = before.tension_error;
  if (before.tension.size() == 0) return;
  VectorXd q(from.system.coordinates()), v(q.size()), pull(before.tension.size()), pulled(pull.size());
  from.system.expand(before.z, q);
  from.system.expand_rate(before.w, v);
  from.system.giving_rod_forces(before.t, q, v, pulled);
  to.system.expand_rate(after.w, v);
  to.system.giving_rod_forces(before.t, q, v, pull);
  after.tension_error = after.tension_error.cwiseMax((pull - pulled).cwiseAbs());
}

}  // namespace

// cos(d) sine - sin(d) cosine with d the deployed fold angle.
LinearForm remaining_form(const Deployment& deployment) {
  LinearForm form;
  const auto add = [&form](double factor, const LinearForm& part) {
    for (std::size_t i = 0; i < part.nodes.size(); ++i) {
      form.nodes.push_back(part.nodes[i]);
      form.coefficients.push_back(factor * part.coefficients[i]);
    }
    form.offset += factor * part.offset;
  };
  add(std::cos(deployment.deployed_fold_angle), deployment.fold_sine);
  if (const double s = std::sin(deployment.deployed_fold_angle); s != 0) add(-s, deployment.fold_cosine);
  return form;
}

bool latch_gives(const Structure& structure) {
  return std::any_of(structure.forces.begin(), structure.forces.end(), latch_waits);
}

std::shared_ptr<const Model> latched_model(const Model& model, bool eliminate_linear) {
  Structure structure = model.structure;
  const Deployment& deployment = structure.deployment;
  std::optional<Force> spring = waiting_spring(structure);  // what gives in its place
  if (deployment.measured && deployment.latches.empty()) {
    const bool gives = spring.has_value();
    if (gives) {
      spring->measure = deployment.measure;
      spring->rest = deployment.deployed;
      spring->slack = false;
      *std::ranges::find_if(structure.forces, latch_waits) = *std::move(spring);
    }
    TimeFunction held;
    held.offset = deployment.deployed;
    if (!gives)
      structure.constraints.push_back(
          {"measure", "latch of the deployment", {}, {}, 0.0, deployment.measure, held, false, true});
    System locked(structure, eliminate_linear);
    return std::make_shared<const Model>(Model{std::move(structure), std::move(locked)});
  }
  std::vector<LinearForm> latches = deployment.latches;
  if (latches.empty()) latches.push_back(remaining_form(deployment));
  for (const LinearForm& form : latches) {
    const std::string name =
        deployment.latches.empty()
            ? "latch of the fold angle"
            : "latch of " + structure.nodes[static_cast<std::size_t>(form.nodes[0])].name;
    if (spring) {
      spring->form = form;
      spring->name = name;
      structure.forces.push_back(*spring);
    } else {
      structure.constraints.push_back(
          {"relation", name, form.nodes, form.coefficients, -form.offset, {}, {}});
    }
  }
  System system(structure, eliminate_linear);
  return std::make_shared<const Model>(Model{std::move(structure), std::move(system)});
}

State in_coordinates(const System& from, const State& state, const System& to) {
  VectorXd q(from.coordinates()), v(q.size());
  from.expand(state.z, q);
  from.expand_rate(state.w, v);
  State moved = state;
  moved.z = to.reduce(q);
  moved.w = to.reduce_rate(v);
  return moved;
}

Handover hand_over(const Model& from, const State& state, const Model& to) {
  VectorXd q(from.system.coordinates()), v(q.size());
  from.system.expand(state.z, q);
  from.system.expand_rate(state.w, v);
  Handover out;
  State& s = out.state;
  s.t = state.t;
  s.angles = state.angles;
  // A sum that is latched counts the deployment's angles (which come first), behind the others.
  const Index counted = state.angles.size(), own = to.structure.deployment.first_angles().size();
  if (own <= counted && to.system.followed_angles() == counted + own) {
    s.angles.conservativeResize(counted + own);
    s.angles.tail(own) = state.angles.head(own);
  }
  s.z = to.system.reduce(q);
  s.w = to.system.reduce_rate(v);
  const System near = to.system.at(s);
  VectorXd held(q.size());  // q but for what linear constraints that are new make them differ by
  to.system.expand(s.z, held);
  if ((held - q).lpNorm<Eigen::Infinity>() > settled * q.lpNorm<Eigen::Infinity>()) {
    for (int it = 0; it < most_projections && constraint_error(near, s) > settled; ++it) project(near, s);
    to.system.expand(s.z, q);
  }
  s.w = fitted_rates(near, s.t, q, v);
  keep_tension(from, state, to, s);
  s.lambda.setZero(to.system.constraints());
  VectorXd acceleration(s.z.size());
  const System followed = to.system.at(s);
  Index1 index1(followed);
  if (!index1.evaluate(s, acceleration, s.lambda)) s.lambda.setZero();
  VectorXd taken(v.size());
  to.system.expand_rate(s.w, taken);
  taken -= v;
  out.energy_lost = 0.5 * taken.dot(to.system.node_mass() * taken);
  return out;
}

}  // namespace unfurl
