// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/symmetry.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>

#include "core/math/linear_elimination.hpp"
#include "core/path/entry_turns.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/node_positions.hpp"

namespace unfurl {
namespace {

// Of positions, loads and linear constraints, as a share of the structure's size or the largest load.
constexpr double turned_share = 2e-13;
constexpr double nearly_share = 1e-2;  // only to say what is unlike
constexpr int fewest_sectors = 3;

std::size_t slot(int i) {
  return static_cast<std::size_t>(i);
}

// "a 5th", "an 8th", "a 23rd"
std::string part_of_turn(int order) {
  const std::string n = std::to_string(order);
  const bool vowel = n.front() == '8' || order == 11 || order == 18, teen = order / 10 % 10 == 1;
  static constexpr std::array ends{"th", "st", "nd", "rd"};
  const int last = order % 10;
  return (vowel ? "an " : "a ") + n + (teen || last > 3 ? "th" : ends[slot(last)]);
}

// Nodes by place, to within a tolerance.
class Places {
 public:
  Places(const Structure& structure, double tolerance)
      : structure_(structure), tolerance_(tolerance), cell_(64 * tolerance) {
    for (int i = 0; i < static_cast<int>(structure.nodes.size()); ++i)
      cells_[key(structure.nodes[slot(i)].position)].push_back(i);
  }
  // All nodes there, in their order.
  std::vector<int> there(const Vec3& x) const {
    std::vector<std::array<long, 3>> seen;
    std::vector<int> found;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 side(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const auto k = key(x + tolerance_ * side);
      if (std::find(seen.begin(), seen.end(), k) != seen.end()) continue;
      seen.push_back(k);
      const auto cell = cells_.find(k);
      if (cell == cells_.end()) continue;
      for (const int i : cell->second)
        if ((structure_.nodes[slot(i)].position - x).norm() <= tolerance_) found.push_back(i);
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  struct Hash {
    std::size_t operator()(const std::array<long, 3>& k) const {
      std::size_t h = 0;
      for (const long x : k) h = h * 0x9e3779b97f4a7c15ULL + static_cast<std::size_t>(x);
      return h;
    }
  };
  std::array<long, 3> key(const Vec3& x) const {
    std::array<long, 3> out{};
    for (int c = 0; c < 3; ++c) out[slot(c)] = static_cast<long>(std::floor(x[c] / cell_));
    return out;
  }
  const Structure& structure_;
  double tolerance_, cell_;
  std::unordered_map<std::array<long, 3>, std::vector<int>, Hash> cells_;
};

// One order of one axis, entry by entry.
class Trial {
 public:
  Trial(const Structure& structure, const Vec3& axis, const Vec3& centre, double size, int order)
      : structure_(structure), size_(size) {
    found_.order = order;
    found_.axis = axis;
    found_.centre = centre;
    step_.turn = found_.turn(1);
  }

  bool nodes(const Places& places) {
    const auto& all = structure_.nodes;
    step_.to.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::vector<int> to = places.there(found_.turned(all[i].position, 1));
      const std::vector<int> from = places.there(all[i].position);
      if (to.size() != from.size()) return false;  // several in one place: in their order
      step_.to[i] =
          to[slot(static_cast<int>(std::find(from.begin(), from.end(), static_cast<int>(i)) - from.begin()))];
    }
    return true;
  }

  // Throws what is unlike of rods that are nearly so.
  void nearly_alike() {
    turned_rods();
    throw SectorRefused("its nodes are not quite where a turn takes others");
  }

  std::size_t alike() const { return alike_; }  // entries, before it was refused

  Symmetry entries(const System& system) {
    found_.nodes = images(
        step_.to, [&](std::size_t i) { return "node " + structure_.nodes[i].name; }, nullptr);
    at_nodes();
    found_.rods = images(
        turned_rods(), [&](std::size_t i) { return "rod " + structure_.rods[i].name; }, nullptr);
    found_.forces = images(
        turned_forces(), [&](std::size_t i) { return structure_.forces[i].name; }, &found_.whole_force);
    found_.constraints = images(
        turned_constraints(), [&](std::size_t i) { return structure_.constraints[i].name; },
        &found_.whole_constraint);
    if (uses_fold_) same_fold();
    linear_constraints(system);
    return found_;
  }

 private:
  [[noreturn]] void unlike(const std::string& what) const {
    throw SectorRefused(what + " has no equal " + part_of_turn(found_.order) + " of a turn on");
  }

  // The cycles of a permutation: all of n entries, or of one that acts on the whole (where `whole` asks).
  template <class Name>
  std::vector<TurnedImage> images(const std::vector<int>& to, const Name& name,
                                  std::vector<char>* whole) const {
    std::vector<TurnedImage> out(to.size(), TurnedImage{-1, 0});
    if (whole) whole->assign(to.size(), 0);
    for (std::size_t i = 0; i < to.size(); ++i) {
      if (out[i].source >= 0) continue;
      int turns = 0;
      for (int j = static_cast<int>(i); out[slot(j)].source < 0; j = to[slot(j)], ++turns)
        out[slot(j)] = {static_cast<int>(i), turns};
      if (turns == found_.order) continue;
      if (turns != 1) unlike(name(i));
      if (!whole) throw SectorRefused(name(i) + " lies on the axis");
      (*whole)[i] = 1;
    }
    return out;
  }

  void at_nodes() {
    std::vector<Vec3> load(structure_.nodes.size(), Vec3::Zero());
    double largest = 0;
    for (const Load& l : structure_.loads) load[slot(l.node)] += l.force;
    for (const Vec3& l : load) largest = std::max(largest, l.norm());
    double fastest = 0;
    for (const Node& node : structure_.nodes) fastest = std::max(fastest, node.velocity.norm());
    const auto differs = [&](std::size_t i, const auto& values, double most) {
      return !((step_.turn * values(i) - values(slot(step_.to[i]))).norm() <= turned_share * most);
    };
    // The odd one of a node and the next: where the one after that is unlike as well, the next.
    const auto odd = [&](std::size_t i, const auto& values, double most) -> const std::string& {
      const std::size_t next = slot(step_.to[i]);
      return structure_.nodes[differs(next, values, most) ? next : i].name;
    };
    const auto loads = [&](std::size_t i) -> const Vec3& { return load[i]; };
    const auto velocities = [&](std::size_t i) -> const Vec3& { return structure_.nodes[i].velocity; };
    for (std::size_t i = 0; i < load.size(); ++i) {
      const Node &node = structure_.nodes[i], &next = structure_.nodes[slot(step_.to[i])];
      if (differs(i, loads, largest)) unlike("the load on " + odd(i, loads, largest));
      if (node.mass != next.mass) unlike("the mass of node " + node.name);
      if (node.ghost) throw SectorRefused("a motor has a number of its own: " + node.name);
      if (differs(i, velocities, fastest)) unlike("the velocity of node " + odd(i, velocities, fastest));
      ++alike_;
    }
    if (!((step_.turn * structure_.gravity - structure_.gravity).norm() <=
          turned_share * structure_.gravity.norm()))
      throw SectorRefused("gravity does not act along the ring's axis");
  }

  static bool same(const Rod& a, const Rod& b, double) { return same_entry(a, b); }
  template <class Entry>
  static bool same(const Entry& a, const Entry& b, double size) {
    return same_entry(a, b, size);
  }

  // For each entry the one that it is turned onto.
  template <class Entry, class Turned, class Key, class Name>
  std::vector<int> onto(const std::vector<Entry>& all, const Turned& turned, const Key& key,
                        const Name& name) {
    std::map<std::vector<int>, std::vector<int>> by_key;
    for (std::size_t i = 0; i < all.size(); ++i) by_key[key(all[i])].push_back(static_cast<int>(i));
    std::vector<int> to(all.size(), -1);
    std::vector<char> is_image(all.size(), 0);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Entry image = turned(all[i]);
      std::vector<int>& there = by_key[key(image)];
      const auto equal =
          std::find_if(there.begin(), there.end(), [&](int j) { return same(image, all[slot(j)], size_); });
      if (equal == there.end()) continue;
      to[i] = *equal;
      ++alike_;
      is_image[slot(*equal)] = true;
      there.erase(equal);
    }
    const auto none = std::find(to.begin(), to.end(), -1);
    if (none == to.end()) return to;
    for (std::size_t i = 0; i < to.size(); ++i)  // rather than its neighbour, whose image it is not
      if (to[i] < 0 && !is_image[i]) unlike(name(all[i]));
    unlike(name(all[static_cast<std::size_t>(none - to.begin())]));
  }

  std::vector<int> turned_rods() {
    return onto(
        structure_.rods,
        [&](Rod rod) {
          rod.a = step_.to[slot(rod.a)];
          rod.b = step_.to[slot(rod.b)];
          return rod;
        },
        [](const Rod& rod) {
          return std::vector<int>{std::min(rod.a, rod.b), std::max(rod.a, rod.b)};
        },
        [](const Rod& rod) { return "rod " + rod.name; });
  }

  static void list_nodes(const Measure& measure, std::vector<int>& out) {
    out.insert(out.end(), measure.nodes.begin(), measure.nodes.end());
    for (const MeasureTerm& term : measure.terms) list_nodes(term.measure, out);
  }
  template <class Entry>
  static std::vector<int> key_of(const Entry& entry) {
    std::vector<int> out = entry.nodes;
    list_nodes(entry.measure, out);
    std::sort(out.begin(), out.end());
    return out;
  }

  void look_for_fold(const Measure& measure) {
    uses_fold_ = uses_fold_ || measure.kind == MeasureKind::fold;
    for (const MeasureTerm& term : measure.terms) look_for_fold(term.measure);
  }

  // Kinds whose entries know their nodes, measure and direction and nothing else of the structure.
  std::vector<int> turned_forces() {
    static constexpr std::array known{"load_over_time", "follower", "spring",        "torsion_spring",
                                      "combination",    "motor",    "joint_damping", "drag"};
    for (const Force& force : structure_.forces) {
      if (std::find(known.begin(), known.end(), force.kind) == known.end())
        throw SectorRefused("a force of the kind \"" + force.kind + "\" is not known to sectors");
      look_for_fold(force.measure);
    }
    return onto(
        structure_.forces, [&](const Force& f) { return step_.force(f); }, key_of<Force>,
        [](const Force& f) { return f.name; });
  }

  // Coordinates are others where a turn about another axis than one through the origin takes them: by what
  // they are in the pose at the start, all that is prescribed of them is.
  Constraint turned(const Constraint& from, const VectorXd& q) const {
    Constraint out = step_.constraint(from);
    if (from.kind != "measure" || is_angle(from.measure)) return out;
    const auto at_start = [&](const Measure& measure) {
      return MeasureFunction(measure, structure_.deployment).value(q.data());
    };
    const double farther = at_start(out.measure) - at_start(from.measure);
    if (!(std::abs(farther) > 1e-9 * size_)) return out;  // rounding
    out.target.offset += farther;
    for (double& value : out.target.values) value += farther;
    return out;
  }

  std::vector<int> turned_constraints() {
    static constexpr std::array known{"measure", "collinear", "coplanar"};
    std::vector<Constraint> rest;
    std::vector<int> place;
    for (std::size_t i = 0; i < structure_.constraints.size(); ++i) {
      const Constraint& c = structure_.constraints[i];
      if (is_linear(c)) continue;
      if (std::find(known.begin(), known.end(), c.kind) == known.end())
        throw SectorRefused("a constraint of the kind \"" + c.kind + "\" is not known to sectors");
      look_for_fold(c.measure);
      rest.push_back(c);
      place.push_back(static_cast<int>(i));
    }
    const VectorXd q = node_positions(structure_);
    const std::vector<int> rest_to = onto(
        rest, [&](const Constraint& c) { return turned(c, q); }, key_of<Constraint>,
        [](const Constraint& c) { return c.name; });
    std::vector<int> to(structure_.constraints.size());
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<int>(i);  // linear: looked at elsewhere
    for (std::size_t k = 0; k < rest_to.size(); ++k) to[slot(place[k])] = place[slot(rest_to[k])];
    return to;
  }

  // What pulls at the fold angle must pull at all sectors alike.
  void same_fold() const {
    const Deployment& d = structure_.deployment;
    for (const LinearForm* form : {&d.fold_sine, &d.fold_cosine})
      if (!same_form(step_.form(*form), *form))
        throw SectorRefused("the fold angle is that of one sector, and something acts on it");
  }

  void linear_constraints(const System& system) const {
    const VectorXd q = node_positions(structure_);
    const SparseRows all = system.all_jacobian(q);
    VectorXd value(all.rows());
    system.all_constraint_values(0.0, q, value);
    const std::vector<int> sources = system.all_sources();
    std::vector<Index> rows;
    for (std::size_t r = 0; r < sources.size(); ++r)
      if (sources[r] >= 0 && is_linear(structure_.constraints[slot(sources[r])]))
        rows.push_back(static_cast<Index>(r));
    SparseRows A(std::ssize(rows), q.size());
    VectorXd b(A.rows());
    std::vector<Eigen::Triplet<double>> entries;
    for (Index r = 0; r < A.rows(); ++r) {
      for (SparseRows::InnerIterator it(all, rows[static_cast<std::size_t>(r)]); it; ++it)
        entries.emplace_back(static_cast<int>(r), static_cast<int>(it.col()), it.value());
      b[r] = -value[rows[static_cast<std::size_t>(r)]];
    }
    A.setFromTriplets(entries.begin(), entries.end());
    b += A * q;
    const LinearElimination space = eliminate(A, b);
    VectorXd z(space.B.cols());
    for (Index i = 0; i < z.size(); ++i)  // in general position
      z[i] = q[space.free_coordinates[static_cast<std::size_t>(i)]] +
             size_ * std::sin(1.0 + 0.7 * static_cast<double>(i) + 0.11 * static_cast<double>(i % 17));
    const VectorXd there = space.q0 + space.B * z;
    VectorXd turned(q.size());
    for (std::size_t i = 0; i < structure_.nodes.size(); ++i)
      turned.segment<3>(3 * step_.to[i]) = found_.turned(there.segment<3>(3 * static_cast<Index>(i)), 1);
    const VectorXd error = A * turned - b;
    Index worst = 0;
    if (error.size() == 0 || error.cwiseAbs().maxCoeff(&worst) <= 1e-11 * turned.cwiseAbs().maxCoeff())
      return;
    const int source = sources[static_cast<std::size_t>(rows[static_cast<std::size_t>(worst)])];
    unlike(structure_.constraints[slot(source)].name);
  }

  const Structure& structure_;
  double size_;
  Symmetry found_;
  NodeTurn step_;
  std::size_t alike_ = 0;
  bool uses_fold_ = false;
};

// Orders that take the first node off the axis onto a node, the largest first.
std::vector<int> orders_of(const Structure& structure, const Vec3& axis, const Vec3& centre,
                           double tolerance) {
  const auto arm = [&](const Node& node) -> Vec3 {
    const Vec3 r = node.position - centre;
    return r - r.dot(axis) * axis;
  };
  double longest = 0;
  for (const Node& node : structure.nodes) longest = std::max(longest, arm(node).norm());
  const double off_axis = std::min(1e3 * tolerance, 0.5 * longest);
  const auto first = std::find_if(structure.nodes.begin(), structure.nodes.end(), [&](const Node& node) {
    return !node.ghost && arm(node).norm() > off_axis;
  });
  if (first == structure.nodes.end()) return {};
  const Vec3 from = arm(*first);
  std::vector<int> orders;
  for (const Node& node : structure.nodes) {
    const Vec3 to = arm(node);
    if (std::abs(to.norm() - from.norm()) > 8 * tolerance ||
        std::abs((node.position - first->position).dot(axis)) > 8 * tolerance)
      continue;
    const double angle = std::atan2(axis.dot(from.cross(to)), from.dot(to));
    if (angle < 1e-6 || angle * from.norm() <= 8 * tolerance) continue;
    const double n = 2 * pi / angle, off = std::abs(2 * pi / std::round(n) - angle) * from.norm();
    if (off <= 8 * tolerance && n > fewest_sectors - 0.5) orders.push_back(static_cast<int>(std::lround(n)));
  }
  std::sort(orders.rbegin(), orders.rend());
  orders.erase(std::unique(orders.begin(), orders.end()), orders.end());
  return orders;
}

}  // namespace

Mat3 Symmetry::turn(int turns) const {
  return Eigen::AngleAxisd(2 * pi * (turns % order) / order, axis).toRotationMatrix();
}

bool is_linear(const Constraint& constraint) {
  return constraint.kind == "plane" || constraint.kind == "line" || constraint.kind == "fixed" ||
         constraint.kind == "relation";
}

Symmetry find_symmetry(const Structure& structure, const System& system) {
  if (structure.node_copies.size() > structure.nodes.size()) throw SectorRefused("it is a sector already");
  if (!structure.stops.empty())
    throw SectorRefused("stops and cables that are paid out are not known to sectors");
  Vec3 mean = Vec3::Zero();
  for (const Node& node : structure.nodes)
    mean += node.position / static_cast<double>(structure.nodes.size());
  double size = 0;
  for (const Node& node : structure.nodes) size = std::max(size, (node.position - mean).norm());
  if (mean.norm() <= 1e3 * turned_share * size) mean.setZero();
  std::optional<SectorRefused> why;  // of the turn that got furthest
  std::size_t furthest = 0;
  for (const double share : {turned_share, nearly_share}) {
    const Places places(structure, share * size);
    for (const Vec3& axis : {Vec3::UnitZ().eval(), Vec3::UnitX().eval(), Vec3::UnitY().eval()}) {
      Vec3 centre = mean - mean.dot(axis) * axis;
      if (centre.norm() <= 1e3 * turned_share * size) centre.setZero();
      for (const int order : orders_of(structure, axis, centre, share * size)) {
        Trial trial(structure, axis, centre, size, order);
        if (!trial.nodes(places)) continue;
        try {
          if (share > turned_share) trial.nearly_alike();
          return trial.entries(system);
        } catch (const SectorRefused& refused) {
          if (!why || trial.alike() > furthest) why = refused, furthest = trial.alike();
        }
      }
    }
    if (why) throw *why;
  }
  throw SectorRefused("no turn by a third of one or less takes its nodes onto each other");
}

}  // namespace unfurl
