// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/fit_lengths.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "core/math/saddle_solver.hpp"
#include "core/structure/node_positions.hpp"
#include "core/structure/structure_error.hpp"
#include "core/system/system.hpp"

namespace unfurl {
namespace {

constexpr double fits = 1e-12;    // of the length: round-off of a distance
constexpr double fitted = 1e-13;  // what rounding coordinates leaves, with a margin
constexpr int fit_iterations = 30;

double node_distance_of(const Structure& structure, const Rod& rod) {
  return (structure.nodes[static_cast<std::size_t>(rod.b)].position -
          structure.nodes[static_cast<std::size_t>(rod.a)].position)
      .norm();
}

// The rigid rod whose length is furthest from the distance of its nodes, relatively.
std::size_t worst_rod(const Structure& structure) {
  std::size_t worst = 0;
  double most = -1;
  for (std::size_t i = 0; i < structure.rods.size(); ++i) {
    const Rod& rod = structure.rods[i];
    if (rod.gives) continue;
    const double off = std::abs(node_distance_of(structure, rod) / rod.length - 1);
    if (off > most) most = off, worst = i;
  }
  return worst;
}

std::string said_of(const Structure& structure, const Rod& rod, const char* apart) {
  std::ostringstream text;
  text.precision(9);
  text << "rod " << rod.name << " is given a length of " << rod.length << " m, but its nodes "
       << structure.nodes[static_cast<std::size_t>(rod.a)].name << " and "
       << structure.nodes[static_cast<std::size_t>(rod.b)].name << apart << node_distance_of(structure, rod)
       << " m apart";
  return text.str();
}

std::string length_key(const GivenRod& given) {
  return "rods[" + std::to_string(given.place) + "].length";
}

}  // namespace

bool lengths_fit(const Structure& structure) {
  return std::ranges::all_of(structure.rods, [&](const Rod& rod) {
    const bool stretched = rod.gives && rod.free_length > 0;
    return stretched || std::abs(node_distance_of(structure, rod) / rod.length - 1) <= fits;
  });
}

std::string note_of_moved_nodes(const Structure& structure) {
  for (const std::string& note : structure.notes)
    if (note.find("nodes were moved") != std::string::npos) return note;
  return "";
}

bool solve_for_pose(const System& system, VectorXd& q) {
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  SaddleSolver saddle(system.mass(), G);
  VectorXd z = system.reduce(q), phi(system.constraints()), x(z.size()), y(phi.size());
  const VectorXd no_force = VectorXd::Zero(z.size());
  for (int it = 0; it <= fit_iterations; ++it) {
    system.expand(z, q);
    system.constraint(0.0, q, phi);
    const double reach = q.lpNorm<Eigen::Infinity>();
    if ((phi.array().abs() <= fitted * system.constraint_lengths().array().max(reach)).all()) return true;
    system.jacobian(q, G, scratch);
    if (!saddle.factorise(G)) return false;
    saddle.solve(no_force, -phi, x, y);
    if (!x.allFinite()) return false;
    z += x;
  }
  return false;
}

Structure kept_straight(const Structure& structure, bool all) {
  std::set<int> held;
  for (const Constraint& c : structure.constraints) {
    if (c.kind == "plane") continue;
    held.insert(c.nodes.begin(), c.nodes.end());
    held.insert(c.measure.nodes.begin(), c.measure.nodes.end());
    for (const MeasureTerm& term : c.measure.terms)
      held.insert(term.measure.nodes.begin(), term.measure.nodes.end());
  }
  Structure out = structure;
  const auto& rods = structure.rods;
  for (std::size_t first = 0; first < rods.size(); first += static_cast<std::size_t>(rods[first].parts)) {
    const auto parts = static_cast<std::size_t>(rods[first].parts);
    const int a = rods[first].a, b = rods[first + parts - 1].b;
    const auto is_held = [&](const Rod& part) { return part.b != b && held.count(part.b) > 0; };
    const auto from = rods.begin() + static_cast<std::ptrdiff_t>(first);
    if (!all && std::any_of(from, from + static_cast<std::ptrdiff_t>(parts), is_held)) continue;
    for (std::size_t k = 1; k < parts; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(parts);
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 e = Vec3::Unit(axis);
        const Rod& part = rods[first + k - 1];
        out.constraints.push_back(
            {"relation", "straight rod " + part.whole, {part.b, a, b}, {e, (share - 1) * e, -share * e}});
      }
    }
  }
  return out;
}

void fit_lengths(Structure& structure, bool eliminate_linear) {
  if (std::all_of(structure.rods.begin(), structure.rods.end(), [](const Rod& rod) { return rod.gives; }))
    return;
  const std::size_t worst = worst_rod(structure);
  const Rod& part = structure.rods[worst];
  const double off = std::abs(node_distance_of(structure, part) / part.length - 1);
  if (off <= fits) return;
  const GivenRod given_one = given_rod(structure, worst);
  const Rod& rod = given_one.rod;
  if (!(off <= fitted_share))
    throw StructureError(length_key(given_one),
                         said_of(structure, rod, " are ") +
                             "; nodes are moved for differences up to 1 % only: give positions that fit, or "
                             "leave the length out");
  const VectorXd given = node_positions(structure);
  VectorXd q = given;
  const Structure straight = kept_straight(structure, true);
  bool solved = solve_for_pose(System(straight, eliminate_linear), q);
  if (!solved && straight.constraints.size() > structure.constraints.size())
    q = given, solved = solve_for_pose(System(structure, eliminate_linear), q);
  double most = 0;
  std::size_t mover = 0;
  Structure moved = structure;
  for (std::size_t i = 0; i < moved.nodes.size(); ++i) {
    const auto at = static_cast<Index>(3 * i);
    moved.nodes[i].position = q.segment<3>(at);
    if (const double far = (q - given).segment<3>(at).norm(); far > most) most = far, mover = i;
  }
  double longest = 0;
  for (const Rod& r : structure.rods) longest = std::max(longest, r.length);
  // Next to a singular pose lengths change with the square of a move: a hundredth asks for a seventh.
  if (!solved || !(most <= 0.2 * longest))
    throw StructureError(
        length_key(given_one),
        said_of(structure, rod, " are ") +
            ", and no pose close to the given one has all the given lengths; mend the length "
            "or the positions, or free a constraint");
  std::ostringstream note;
  note << "nodes were moved to fit the given lengths of rods, at most " << most << " m ("
       << structure.nodes[mover].name << "); the length furthest off was that of " << rod.name << ", by "
       << off * rod.length << " m";
  for (std::size_t i = 0; i < moved.nodes.size(); ++i) structure.nodes[i].position = moved.nodes[i].position;
  if (most > 0) structure.notes.push_back(note.str());
}

}  // namespace unfurl
