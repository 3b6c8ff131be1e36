// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/held_nodes.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "core/math/coupled_columns.hpp"
#include "core/structure/prescribed_waves.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {

VectorXd resting_coordinates(const System& system, double t, double h) {
  constexpr double still = 1e-9;  // of the row's length, in a step
  const SparseRows rows = system.jacobian_pattern();
  CoupledColumns columns(rows.cols());
  columns.join_rows_of(rows);
  VectorXd rate(system.constraints()), moves = VectorXd::Zero(rows.cols()), rests = moves;
  system.target_rate(t, rate);
  for (int r = 0; r < rows.outerSize(); ++r)
    if (SparseRows::InnerIterator it(rows, r);
        it && std::abs(rate[r]) * h > still * system.constraint_lengths()[r])
      moves[columns.set_of(it.col())] = 1;
  for (Index i = 0; i < rests.size(); ++i) rests[i] = 1 - moves[columns.set_of(i)];
  return rests;
}

bool comes_to_rest(const System& system, const VectorXd& resting, double t, double h) {
  return ((resting - resting_coordinates(system, t, h)).array() > 0).any();
}

std::vector<int> nodes_at_rest(const Model& model, const VectorXd& resting, double t, double h) {
  const auto& [structure, system] = model;
  const std::vector<int> sources = system.sources();
  const SparseRows rows = system.jacobian_pattern();
  Structure of_them;
  for (int r = 0; r < rows.outerSize(); ++r) {
    bool any = false;
    for (SparseRows::InnerIterator it(rows, r); it; ++it) any = any || resting[it.col()] > 0;
    const int source = sources[static_cast<std::size_t>(r)];
    if (any && source < 0) of_them.rods = structure.rods;  // that are warmed
    if (any && source >= 0)
      of_them.constraints.push_back(structure.constraints[static_cast<std::size_t>(source)]);
  }
  const std::vector<TimeEdge> edges = prescribed_edges(of_them, h);
  if (edge_after(edges, t) != edges.end() || std::isfinite(fastest_wave(of_them, t).period)) return {};
  VectorXd any(resting.size()), moves(system.coordinates()), others(moves.size());
  for (Index k = 0; k < any.size(); ++k) any[k] = std::sin(1.0 + static_cast<double>(k));
  system.expand_rate(any, moves);
  system.expand_rate(any.cwiseProduct(VectorXd::Ones(any.size()) - resting), others);
  std::vector<int> out;
  for (int i = 0; i < static_cast<int>(structure.nodes.size()); ++i)
    if (moves.segment<3>(3 * i).any() && !others.segment<3>(3 * i).any()) out.push_back(i);
  return out;
}

std::shared_ptr<const Model> model_with_held(const Model& model, const HeldNodes& held, std::size_t first,
                                             std::size_t end, bool eliminate_linear) {
  Structure structure = model.structure;
  for (std::size_t i = first; i < end; ++i)
    for (int k = 0; k < 3; ++k) {
      const int node = held.nodes[i];
      const std::string name = "hold of " + structure.nodes[static_cast<std::size_t>(node)].name;
      const double place = held.places[3 * static_cast<Index>(i) + k];
      structure.constraints.push_back({"plane", name, {node}, {Vec3::Unit(k)}, place, {}, {}});
    }
  System system(structure, eliminate_linear);
  return std::make_shared<const Model>(Model{std::move(structure), std::move(system)});
}

}  // namespace unfurl
