// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/reactions.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/math/determined_rows.hpp"
#include "core/simulate/elastic_sharing.hpp"

namespace unfurl {
namespace {

// A node of which a measure tells where it is in space, not against others, and what the measure changes by
// where that one is moved by a metre.
struct Place {
  int node;
  Vec3 change;
};

// A ghost is nowhere.
void add_places(const Structure& structure, const Measure& measure, double share,
                std::vector<Place>& places) {
  if (measure.kind == MeasureKind::coordinate && measure.nodes.size() == 1 &&
      !structure.nodes[static_cast<std::size_t>(measure.nodes.front())].ghost)
    places.push_back({measure.nodes.front(), share * measure.axis});
  for (const MeasureTerm& term : measure.terms)
    add_places(structure, term.measure, share * term.coefficient, places);
}

// Of what the ground holds: none where the measure stays as it is when everything is moved. Of a rack these
// are its own node, not those of the pinion's angle.
std::vector<Place> places_of(const Structure& structure, const Measure& measure) {
  std::vector<Place> places;
  add_places(structure, measure, 1.0, places);
  Vec3 sum = Vec3::Zero();
  for (const Place& place : places) sum += place.change;
  if (sum.isZero()) places.clear();
  return places;
}

bool linear(const Constraint& c) {
  return c.kind == "fixed" || c.kind == "plane" || c.kind == "line" || c.kind == "relation";
}

bool ties_to_ground(const Structure& structure, const Constraint& c) {
  if (c.kind == "measure") return !places_of(structure, c.measure).empty();
  return linear(c) && !c.symmetry && c.nodes.size() == 1;
}

// Per row of these sources, 1: it belongs to a support.
VectorXd rows_of_supports(const Structure& structure, const std::vector<int>& sources) {
  VectorXd rows = VectorXd::Zero(std::ssize(sources));
  for (std::size_t r = 0; r < sources.size(); ++r)
    if (sources[r] >= 0 &&
        ties_to_ground(structure, structure.constraints[static_cast<std::size_t>(sources[r])]))
      rows[static_cast<Index>(r)] = 1.0;
  return rows;
}

std::string column_of(const Structure& structure, int support, const char* what) {
  return structure.nodes[static_cast<std::size_t>(support)].name + ".reaction" + what;
}

// Per row of all constraints; empty where no rod is elastic.
VectorXd all_compliances(const Model& model) {
  const VectorXd kept = row_compliance(model);
  if (kept.size() == 0) return {};
  const std::vector<int> sources = model.system.all_sources();
  VectorXd compliance = VectorXd::Zero(std::ssize(sources));
  std::size_t rod = 0;  // rods are in their order, without those that give
  for (std::size_t r = 0; r < sources.size(); ++r) {
    if (sources[r] >= 0) continue;
    while (model.system.rod_rows()[rod] < 0) ++rod;
    compliance[static_cast<Index>(r)] = kept[model.system.rod_rows()[rod++]];
  }
  return compliance;
}

// Per support. `rests`: what does there.
std::vector<char> unique_supports(const Trajectory& trajectory, std::size_t i, bool shared,
                                  const std::vector<char>& rests) {
  const Model& model = trajectory.model(i);
  const VectorXd q = trajectory.node_positions(i);
  const RestingRows resting(model);
  const SparseRows constraints = model.system.all_jacobian(q), G = resting.behind(constraints, q, rests);
  const VectorXd compliance = shared ? RestingRows::behind(all_compliances(model), G.rows()) : VectorXd();
  // With what keeps a support in the plane of a flat structure: there it gives nothing, but to be chosen.
  const std::vector<int> nodes = supports(trajectory.structure());
  const std::vector<int>& sources = model.system.all_sources();
  std::vector<Eigen::Triplet<double>> entries;
  const auto tell_places = [&](Index row, const Measure& measure) {
    for (const Place& place : places_of(model.structure, measure))
      for (const int axis : {0, 1, 2})
        entries.emplace_back(static_cast<int>(row), 3 * place.node + axis, place.change[axis]);
  };
  for (Index r = 0; r < constraints.rows(); ++r) {
    const int source = sources[static_cast<std::size_t>(r)];
    if (source < 0) continue;
    const Constraint& c = model.structure.constraints[static_cast<std::size_t>(source)];
    if (c.kind == "measure")
      tell_places(r, c.measure);
    else if (ties_to_ground(model.structure, c) ||
             (c.symmetry && c.nodes.size() == 1 && std::ranges::binary_search(nodes, c.nodes.front())))
      for (SparseRows::InnerIterator it(constraints, r); it; ++it)
        entries.emplace_back(static_cast<int>(r), static_cast<int>(it.col()), it.value());
  }
  Index row = constraints.rows();
  for (const Measure& measure : resting.measures(rests)) tell_places(row++, measure);
  SparseRows told(G.rows(), G.cols());
  told.setFromTriplets(entries.begin(), entries.end());
  const std::vector<char> sums = determined_sums(G, told, compliance);
  std::vector<char> unique;
  for (const int node : nodes)
    unique.push_back(std::all_of(sums.begin() + 3 * node, sums.begin() + 3 * node + 3, std::identity()));
  return unique;
}

}  // namespace

std::vector<int> supports(const Structure& structure) {
  std::set<int> nodes;
  if (structure.sectors != 1.0) return {};
  const auto add_nodes = [&](const Measure& measure) {
    for (const Place& place : places_of(structure, measure)) nodes.insert(place.node);
  };
  for (const Constraint& c : structure.constraints) {
    if (c.kind == "measure")
      add_nodes(c.measure);
    else if (ties_to_ground(structure, c))
      nodes.insert(c.nodes.front());
  }
  for (const Stop& stop : structure.stops) add_nodes(stop.measure);
  for (const Force& force : structure.forces)
    if (force.kind == "friction") add_nodes(force.measure);
  std::erase_if(nodes, [&](int node) { return structure.nodes[static_cast<std::size_t>(node)].ghost; });
  return {nodes.begin(), nodes.end()};
}

ReactionColumns::ReactionColumns(const Model& first, std::vector<Series>& columns)
    : columns_(columns), first_(columns.size()), supports_(supports(first.structure)) {
  for (const int node : supports_) {
    const std::string name = first.structure.nodes[static_cast<std::size_t>(node)].name + " reaction";
    const auto add = [&](const char* what, const std::string& label, const char* unit) {
      columns.push_back({column_of(first.structure, node, what), label, unit, {}});
    };
    add("_N", name, "N");
    add("_x_N", name + " x", "N");
    add("_y_N", name + " y", "N");
    add("_z_N", name + " z", "N");
    add("_unique", name + " is unique", "");
  }
}

void ReactionColumns::enter(const Model& model) {
  model_ = &model;
  kept_ = rows_of_supports(model.structure, model.system.sources());
  measured_.clear();
  for (Index r = 0; r < kept_.size(); ++r) {
    const int source = model.system.sources()[static_cast<std::size_t>(r)];
    if (kept_[r] == 0) continue;
    const Constraint& c = model.structure.constraints[static_cast<std::size_t>(source)];
    if (c.kind != "measure") continue;
    kept_[r] = 0.0;
    for (const Place& place : places_of(model.structure, c.measure))
      measured_.push_back({r, place.node, place.change});
  }
  solver_.reset();
  if (!model.system.eliminated()) return;
  const std::vector<int> sources = model.system.all_sources();
  const SparseRows all = model.system.all_jacobian(VectorXd::Zero(model.system.coordinates()));
  std::vector<int> picked;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t r = 0; r < sources.size(); ++r) {
    if (sources[r] < 0 || !linear(model.structure.constraints[static_cast<std::size_t>(sources[r])]))
      continue;
    for (SparseRows::InnerIterator it(all, static_cast<Index>(r)); it; ++it)
      entries.emplace_back(static_cast<int>(picked.size()), static_cast<int>(it.col()), it.value());
    picked.push_back(sources[r]);
  }
  linear_ = rows_of_supports(model.structure, picked);
  if (linear_.isZero()) return;
  rows_.resize(std::ssize(picked), model.system.coordinates());
  rows_.setFromTriplets(entries.begin(), entries.end());
  SparseRows identity(rows_.cols(), rows_.cols());
  identity.setIdentity();
  // Multipliers of rows that are there twice keep round-off of 1e-16 over this.
  constexpr double regularisation = 1e-7;
  solver_ = std::make_unique<SaddleSolver>(identity, rows_, 1, regularisation);
  if (!solver_->factorise(rows_)) kept_.setConstant(std::numeric_limits<double>::quiet_NaN());
}

void ReactionColumns::append(const Model& model, const System& system, const State& state, const VectorXd& q,
                             const VectorXd& v, const VectorXd& a, const VectorXd& lambda) {
  if (supports_.empty()) return;
  if (model_ != &model) enter(model);
  VectorXd reaction = VectorXd::Zero(q.size());
  system.add_constraint_force(q, kept_.cwiseProduct(lambda), -1.0, reaction);
  for (const Held& held : measured_) reaction.segment<3>(3 * held.node) -= lambda[held.row] * held.change;
  if (solver_) {
    VectorXd rest = VectorXd::Zero(q.size()), left(q.size()), mu(rows_.rows());  // rest = A^T mu
    if (state.tension.size() > 0) {
      system.add_other_force(state.t, q, v, state.tension, 1.0, rest);
      system.add_giving_rod_forces(q, state.tension, 1.0, rest);
    } else {
      system.add_applied_force(state.t, q, v, 1.0, rest);
    }
    system.add_constraint_force(q, lambda, -1.0, rest);
    rest.noalias() -= system.node_mass() * a;
    constexpr int refinements = 40;  // as many as leave 1e-7 of the weakest rows nothing
    solver_->solve(rest, VectorXd::Zero(mu.size()), left, mu, refinements);
    reaction.noalias() -= rows_.transpose() * linear_.cwiseProduct(mu);
  }
  std::size_t column = first_;
  for (const int node : supports_) {
    const Vec3 force = reaction.segment<3>(3 * node);
    for (const double x : {force.norm(), force.x(), force.y(), force.z(), 1.0})
      columns_[column++].values.push_back(x);
  }
}

void mark_reactions(const Trajectory& trajectory, const ForceUniqueness& uniqueness,
                    const std::vector<char>& waves, Diagnostics& d) {
  const Structure& structure = trajectory.structure();
  const std::vector<int> nodes = supports(structure);
  if (nodes.empty()) return;
  const auto first = std::find_if(d.columns.begin(), d.columns.end(), [&](const Series& column) {
    return column.name == column_of(structure, nodes.front(), "_N");
  });
  if (first == d.columns.end()) return;
  std::map<const std::vector<char>*, std::vector<char>> known;  // by what holds for the rows of the state
  for (std::size_t i = 0; i < d.t.size(); ++i) {
    const auto [at, is_new] = known.try_emplace(&uniqueness.at(i));
    if (is_new)
      at->second = unique_supports(trajectory, i, uniqueness.regular(i) && !uniqueness.all_by_rigid_rods(i),
                                   uniqueness.rests(i));
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      Series* const column = &*first + 5 * k;
      const bool unique = at->second[k] && !waves[i] && !std::isnan(column[0].values[i]);
      column[4].values[i] = unique ? 1.0 : 0.0;
    }
  }
}

std::vector<std::size_t> reaction_dips(const Diagnostics& d, std::string_view column) {
  constexpr std::size_t most = 3;
  constexpr std::string_view size = ".reaction_N";
  if (!column.ends_with(size) || !d.find(column)) return {};
  const std::string name(column.substr(0, column.size() - size.size()));
  const auto at = [&](std::size_t i) {
    Vec3 force;
    for (int k = 0; k < 3; ++k) force[k] = d.at(name + ".reaction_" + "xyz"[k] + "_N").values[i];
    return force;
  };
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t i = 0; i + 1 < d.t.size(); ++i) {
    const Vec3 a = at(i), change = at(i + 1) - a;
    const double u = -a.dot(change) / change.squaredNorm();
    if (u > 0 && u < 1) found.push_back({(a + u * change).norm(), i});
  }
  std::ranges::stable_sort(found, std::less(), [](const auto& f) { return f.first; });
  std::vector<std::size_t> steps;
  for (std::size_t k = 0; k < std::min(found.size(), most); ++k) steps.push_back(found[k].second);
  return steps;
}

std::vector<PeakReaction> peak_reactions(const Structure& structure, const Diagnostics& d) {
  std::vector<PeakReaction> peaks;
  for (const int node : supports(structure)) {
    const std::vector<double>& size = d.at(column_of(structure, node, "_N")).values;
    const std::vector<double>& unique = d.at(column_of(structure, node, "_unique")).values;
    PeakReaction peak{node, std::numeric_limits<double>::quiet_NaN()};
    for (std::size_t i = 0; i < size.size(); ++i)
      if (!std::isnan(size[i]) && !(size[i] <= peak.force_N))
        peak = {node, size[i], d.t[i], unique[i] != 0.0};
    peaks.push_back(peak);
  }
  return peaks;
}

}  // namespace unfurl
