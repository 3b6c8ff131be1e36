// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/sector.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/integrators/index1.hpp"
#include "core/path/sector_build.hpp"
#include "core/simulate/force_sizes.hpp"
#include "core/simulate/stretched.hpp"
#include "core/structure/structure_error.hpp"

namespace unfurl {
namespace {

// Two solutions of one equation, next to a pose where it is nearly singular; constraints of the whole.
constexpr double same_acceleration = 1e-7, rounded_share = 1e-12, same_constraints_share = 1e-10;

}  // namespace

Sector::Sector(std::shared_ptr<const Model> whole)
    : whole_(std::move(whole)), symmetry_(find_symmetry(whole_->structure, whole_->system)) {
  SectorStructure built = build_sector_structure(whole_->structure, whole_->system, symmetry_);
  node_at_ = std::move(built.node_at);
  rod_at_ = std::move(built.rod_at);
  constraint_at_ = std::move(built.constraint_at);
  try {
    System system(built.structure, true);
    sector_ = std::make_shared<const Model>(Model{std::move(built.structure), std::move(system)});
  } catch (const StructureError& error) {
    throw SectorRefused("a sector of it has no equations: " + std::string(error.what()));
  }
}

VectorXd Sector::expand(const VectorXd& q, bool positions) const {
  VectorXd out(3 * std::ssize(symmetry_.nodes));
  std::vector<Mat3> turns;
  for (int k = 0; k < symmetry_.order; ++k) turns.push_back(symmetry_.turn(k));
  for (std::size_t i = 0; i < symmetry_.nodes.size(); ++i) {
    const auto& [source, k] = symmetry_.nodes[i];
    Vec3 x = q.segment<3>(3 * static_cast<Index>(node_at_[static_cast<std::size_t>(source)]));
    if (k > 0) {
      if (positions) x -= symmetry_.centre;
      x = turns[static_cast<std::size_t>(k)] * x;
      if (positions) x += symmetry_.centre;
    }
    out.segment<3>(3 * static_cast<Index>(i)) = x;
  }
  return out;
}

void Sector::lift_multipliers(const VectorXd& lambda, VectorXd& out) const {
  const System &from = sector_->system, &to = whole_->system;
  for (std::size_t r = 0; r < symmetry_.rods.size(); ++r) {
    const int row = to.rod_rows()[r];
    const int at = rod_at_[static_cast<std::size_t>(symmetry_.rods[r].source)];
    if (row >= 0) out[row] = lambda[from.rod_rows()[static_cast<std::size_t>(at)]];
  }
  const auto& constraints = whole_->structure.constraints;
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    const int row = to.constraint_row(static_cast<int>(c));
    const auto& [source, k] = symmetry_.constraints[c];
    const int at = constraint_at_[static_cast<std::size_t>(source)];
    if (row < 0 || at < 0) continue;
    const int own = from.constraint_row(at);
    if (own < 0) continue;
    if (constraints[c].kind == "collinear")  // a vector in space
      out.segment<3>(row) = symmetry_.turn(k) * lambda.segment<3>(own);
    else
      out[row] = lambda[own] * (symmetry_.whole_constraint[c] ? symmetry_.order : 1);
  }
}

State Sector::whole_state(const State& state, bool multipliers) const {
  const System &from = sector_->system, &to = whole_->system;
  State out;
  out.t = state.t;
  VectorXd q(from.coordinates());
  from.expand(state.z, q);
  out.z = to.reduce(expand(q, true));
  from.expand_rate(state.w, q);
  out.w = to.reduce_rate(expand(q, false));
  out.lambda.setZero(to.constraints());
  if (multipliers) lift_multipliers(state.lambda, out.lambda);
  const std::vector<int>&giving = to.giving_rods(), own = from.giving_rods();
  if (state.tension.size() > 0) out.tension.resize(std::ssize(giving));
  if (state.tension_error.size() > 0) out.tension_error.resize(std::ssize(giving));
  if (state.stage_tension.size() > 0)
    out.stage_tension.resize(std::ssize(giving), state.stage_tension.cols());
  for (std::size_t k = 0; k < giving.size(); ++k) {
    const int source = symmetry_.rods[static_cast<std::size_t>(giving[k])].source;
    const auto at = std::find(own.begin(), own.end(), rod_at_[static_cast<std::size_t>(source)]);
    if (out.tension.size() > 0) out.tension[static_cast<Index>(k)] = state.tension[at - own.begin()];
    if (out.tension_error.size() > 0)
      out.tension_error[static_cast<Index>(k)] = state.tension_error[at - own.begin()];
    if (out.stage_tension.size() > 0)
      out.stage_tension.row(static_cast<Index>(k)) = state.stage_tension.row(at - own.begin());
  }
  return out;
}

// Accelerations and constraints of the whole in a state of the sector.
void Sector::compare(const State& of_sector, const State& of_whole) const {
  const System& whole = whole_->system;
  VectorXd q(whole.coordinates()), phi(whole.all_constraints());
  whole.expand(of_whole.z, q);
  whole.at(of_whole).all_constraint_values(of_whole.t, q, phi);
  if (phi.size() > 0 &&
      !(phi.cwiseAbs().cwiseQuotient(whole.all_lengths()).maxCoeff() <= same_constraints_share))
    throw SectorRefused("a constraint of the whole does not hold in the sector's motion");
  double sum = 0;  // of what the whole's forces are made of
  const auto acceleration = [&sum](const Model& model, const State& state) {
    const System followed = model.system.at(state);
    Index1 index1(followed);
    VectorXd a(state.z.size()), lambda = VectorXd::Zero(followed.constraints());
    if (!index1.evaluate(state.t, state.z, state.w, a, lambda))
      a.setConstant(std::numeric_limits<double>::quiet_NaN());
    sum = free_acceleration(followed, model.structure, state, lambda);
    return a;
  };
  VectorXd own(sector_->system.coordinates());
  sector_->system.expand_rate(acceleration(*sector_, of_sector), own);
  const VectorXd a = acceleration(*whole_, of_whole), b = whole.reduce_rate(expand(own, false));
  const auto size = [&](const VectorXd& u) { return std::sqrt(u.dot(whole.mass() * u)); };
  if (!(size(a - b) <= same_acceleration * (size(a) + size(b)) + rounded_share * sum))
    throw SectorRefused("the equations of motion hold something that the symmetry does not know");
}

// What becomes of a force becomes of all its images at once.
std::vector<Event> Sector::whole_events(const std::vector<Event>& events) const {
  const std::vector<Force>& forces = whole_->structure.forces;
  std::vector<Event> out;
  for (const Event& event : events) {
    out.push_back(event);
    if (event.element.empty()) continue;
    std::size_t source = 0;
    while (source < forces.size() &&
           (forces[source].name != event.element || symmetry_.forces[source].turns != 0))
      ++source;
    for (std::size_t i = source + 1; i < forces.size(); ++i) {
      if (symmetry_.forces[i].source != static_cast<int>(source)) continue;
      Event image = event;
      image.element = forces[i].name;
      image.name.replace(image.name.find(event.element), event.element.size(), image.element);
      image.energy_lost = 0;  // the event's is the whole ring's
      out.push_back(std::move(image));
    }
  }
  return out;
}

Simulation Sector::whole(Simulation run) const {
  const Trajectory& from = run.trajectory;
  Simulation out{.trajectory = Trajectory(whole_, from.options()),
                 .status = run.status,
                 .message = std::move(run.message),
                 .warnings = std::move(run.warnings),
                 .events = whole_events(run.events),
                 .options = run.options,
                 .solved_as = {},
                 .position_estimate = run.position_estimate,
                 .steps = run.steps,
                 .newton_iterations = run.newton_iterations,
                 .factorisations = run.factorisations,
                 .cpu_s = run.cpu_s};
  System followed = whole_->system;
  for (std::size_t i = 0; i < from.size(); ++i) {
    State state = whole_state(from.state(i), from.report(i).singular_event);
    if (i > 0 && followed.followed_angles() > 0) {
      followed.follow(out.trajectory.state(i - 1));
      followed.count_on(state);
    }
    out.trajectory.append(std::move(state), from.report(i));
  }
  for (const std::size_t i : {std::size_t{0}, from.size() / 2})
    if (i < from.size() && !from.report(i).singular_event) compare(from.state(i), out.trajectory.state(i));
  if (whole_->structure.quasi_static) add_stretch(out.trajectory);
  return out;
}

Simulation simulate_sector(
    const std::shared_ptr<const Model>& model, const SolverOptions& options,
    const std::function<Simulation(const std::shared_ptr<const Model>&, const SolverOptions&)>& solve) {
  if (options.at_deployed == "latch" && !model->structure.deployment.empty())
    throw SectorRefused("latches are not known to sectors");
  if (!options.eliminate_linear) throw SectorRefused("solver.eliminate_linear = false keeps all nodes");
  const Sector sector(model);
  Simulation run = sector.whole(solve(sector.model(), options));
  run.solved_as.name = "sector";
  run.solved_as.why = "one of " + std::to_string(sector.order()) + " equal sectors";
  return run;
}

}  // namespace unfurl
