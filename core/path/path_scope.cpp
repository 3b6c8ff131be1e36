// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/path_scope.hpp"

#include <algorithm>

#include "core/path/path_forces.hpp"
#include "core/simulate/push_responses.hpp"
#include "core/simulate/run_words.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/node_positions.hpp"
#include "core/system/mobility.hpp"

namespace unfurl {
namespace {

bool drives_something(const Constraint& constraint) {
  return constraint.kind == "measure" && constraint.target.moves();
}

bool warms(const Rod& rod) {
  return !rod.gives && rod.expansion != 0;
}

}  // namespace

const Constraint* driven_row(const Structure& structure) {
  const Constraint* found = nullptr;
  for (const Constraint& constraint : structure.constraints) {
    if (!drives_something(constraint)) continue;
    if (found) throw PathRefused("more than one drive prescribes the motion");
    found = &constraint;
  }
  return found;
}

double driven_second_rate(const Structure& structure, const System& system, const VectorXd& z,
                          const VectorXd& rate, const VectorXd& second_rate) {
  if (rate.isZero(0) && second_rate.isZero(0)) return 0;  // also where a measure has a kink
  const MeasureFunction measure(driven_row(structure)->measure, structure.deployment);
  VectorXd q(system.coordinates()), dq(q.size()), ddq(q.size()),
      gradient(static_cast<Index>(measure.stencil().size()));
  system.expand(z, q);
  system.expand_rate(rate, dq);
  system.expand_rate(second_rate, ddq);
  measure.value_and_gradient(q.data(), gradient.data());
  return measure.curvature_along(q.data(), dq.data()) + measure.rate(gradient.data(), ddq.data());
}

namespace {

bool has_cables(const Structure& structure) {
  return std::any_of(structure.forces.begin(), structure.forces.end(),
                     [](const Force& force) { return force.one_sided; });
}

}  // namespace

std::shared_ptr<const System> path_system(const std::shared_ptr<const Model>& model) {
  const Structure& structure = model->structure;
  if (const std::string unknown = unknown_to_path(structure); !unknown.empty()) throw PathRefused(unknown);
  std::shared_ptr<const System> system(model, &model->system);
  if (const Constraint* drive = driven_row(structure)) {
    if (!structure.stops.empty() || has_cables(structure))
      throw PathRefused("a drive beside stops or cables");
    Structure freed = structure;
    freed.constraints.erase(freed.constraints.begin() + (drive - structure.constraints.data()));
    system = std::make_shared<const System>(freed, true);
  }
  if (std::ranges::any_of(structure.rods, warms)) throw PathRefused("rods change their length with time");
  const Mobility mobility = analyse_mobility(*system, node_positions(structure));
  if (mobility.degrees_of_freedom != 1)
    throw PathRefused("the structure has " + std::to_string(mobility.degrees_of_freedom) +
                      " degrees of freedom at its start, and a path needs 1" +
                      (mobility.rigid_motions > 0 ? " (" + std::to_string(mobility.rigid_motions) +
                                                        " of them move it as a rigid body)"
                                                  : ""));
  return system;
}

std::shared_ptr<const Path> trace_path(const std::shared_ptr<const Model>& model) {
  auto system = path_system(model);
  const VectorXd z = system->reduce(node_positions(model->structure));
  return std::make_shared<const Path>(std::move(system), z);
}

void refuse_friction(const OneSided& sides, const Structure& structure, const SolverOptions& options) {
  if (!sides.any_friction()) return;
  if (sides.size() > 1) throw PathRefused("friction beside stops, cables or other friction");
  if (driven_row(structure)) throw PathRefused("a drive beside friction");
  if (options.at_deployed == "latch" && !structure.deployment.empty())
    throw PathRefused("friction beside latches");
}

void refuse_other_ways(const OneSided& sides, std::size_t stop, const System& system, const State& here) {
  constexpr double one_way = 1 - 1e-6;
  PushResponses responses(system, here);
  responses.add(sides.measure(stop), sides.sign(stop), sides.near(stop, here),
                sides.limit_motion(stop, here.t));
  if (!(responses.taken(0, here.w) > one_way))
    throw PathRefused("at t = " + seconds(here.t) + ": a stop is met in a pose with other ways to move");
}

}  // namespace unfurl
