// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/assemble_elastic.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/math/factors.hpp"
#include "core/structure/node_positions.hpp"
#include "core/structure/structure_error.hpp"
#include "core/system/fit_lengths.hpp"
#include "core/system/system.hpp"

namespace unfurl {
namespace {

constexpr double joins = 1e-12;      // of the length: what fits
constexpr double shortening = 1e-8;  // e M over K
constexpr double redundant = 1e-3;   // times 1 / K: for rows that depend on others
constexpr int most_steps = 60;
constexpr int fewest_steps = 3;  // the first multipliers move rows away, the next ones back

double misfit(const Structure& structure, const Rod& rod) {
  const Vec3 d = structure.nodes[static_cast<std::size_t>(rod.b)].position -
                 structure.nodes[static_cast<std::size_t>(rod.a)].position;
  return std::abs(d.norm() / rod.length - 1);
}

// The rod that gives whose own length is furthest off; -1: all fit.
int furthest_off(const Structure& structure) {
  int worst = -1;
  double most = joins;
  for (std::size_t r = 0; r < structure.rods.size(); ++r) {
    const Rod& rod = structure.rods[r];
    if (!rod.gives || rod.free_length > 0) continue;
    if (const double off = misfit(structure, rod); off > most) most = off, worst = static_cast<int>(r);
  }
  return worst;
}

// Rods and constraints alone, what bends among them, rods that give as cold as those who join them: warmth
// acts on the rods as they stand then, whether they fit or not.
Structure unloaded(const Structure& structure) {
  Structure bare = structure;
  std::erase_if(bare.forces, [](const Force& force) { return force.kind != "bending"; });
  bare.loads.clear();
  bare.gravity.setZero();
  for (Rod& rod : bare.rods) {
    rod.damping_time = 0;
    if (rod.gives) rod.expansion = 0;
  }
  return bare;
}

// Where all lengths fit without force, there is the pose that rigid rods of these lengths have, whatever the
// modulus is. Rods with a free_length stay out of it. True where there is such a pose near q.
bool fits_without_force(const Structure& structure, bool eliminate_linear, VectorXd& q) {
  constexpr double near = 0.2;  // of the longest rod, as of rigid rods (fit_lengths.cpp)
  Structure rigid = kept_straight(unloaded(structure), true);
  double longest = 0;
  for (Rod& rod : rigid.rods) {
    longest = std::max(longest, rod.length);
    if (!(rod.free_length > 0)) rod.gives = false;
  }
  VectorXd fitted = q;
  if (!solve_for_pose(System(rigid, eliminate_linear), fitted)) return false;
  if (!((fitted - q).lpNorm<Eigen::Infinity>() <= near * longest)) return false;
  q = fitted;
  return true;
}

void add(std::vector<Eigen::Triplet<double>>& entries, const SparseRows& A, double scale) {
  for (int i = 0; i < A.outerSize(); ++i)
    for (SparseRows::InnerIterator it(A, i); it; ++it)
      entries.emplace_back(i, static_cast<int>(it.col()), scale * it.value());
}

class Balance {
 public:
  explicit Balance(const System& system)
      : system_(system), G_(system.jacobian_pattern()), lambda_(VectorXd::Zero(system.constraints())) {}

  // True where it is found; q: the pose that was reached.
  bool find(VectorXd& q) {
    VectorXd z = system_.reduce(q);
    double before = std::numeric_limits<double>::infinity();
    for (int it = 0; it < most_steps; ++it) {
      VectorXd step;
      system_.expand(z, q);
      if (!solve(q, step)) return false;
      z += step;
      const double size = step.lpNorm<Eigen::Infinity>(), reach = q.lpNorm<Eigen::Infinity>();
      // Newton's steps fall to what rounding leaves, along the mechanism of the size of round-off / e.
      const bool settled = it >= fewest_steps && size <= 1e-7 * reach && size > 0.5 * before;
      if (size <= 1e-13 * reach || settled) {
        system_.expand(z, q);
        return true;
      }
      before = size;
    }
    return false;
  }

 private:
  // lambda goes on from that of the step before: what keeps redundant rows solvable leaves no error then, and
  // rows bend the way by what they hold.
  bool solve(const VectorXd& q, VectorXd& step) {
    const Index n = system_.solved_coordinates(), m = system_.constraints();
    const VectorXd rest = VectorXd::Zero(q.size());
    SparseRows by_z, by_w;
    system_.force_derivatives(0.0, q, rest, by_z, by_w);
    system_.jacobian(q, G_, scratch_);
    double stiffest = 0, largest = 1e-300;
    for (Index i = 0; i < n; ++i) {
      largest = std::max(largest, std::abs(by_z.coeff(i, i)));
      stiffest = std::max(stiffest, std::abs(by_z.coeff(i, i)) / system_.mass().coeff(i, i));
    }
    std::vector<Eigen::Triplet<double>> entries;
    const double kept = redundant / largest;
    add(entries, by_z, -1.0);
    add(entries, system_.curvature(q, lambda_), 1.0);
    add(entries, system_.mass(), shortening * stiffest);
    for (int r = 0; r < G_.outerSize(); ++r) {
      const int row = static_cast<int>(n) + r;
      for (SparseRows::InnerIterator it(G_, r); it; ++it) {
        entries.emplace_back(row, static_cast<int>(it.col()), it.value());
        entries.emplace_back(static_cast<int>(it.col()), row, it.value());
      }
      entries.emplace_back(row, row, -kept);
    }
    SparseColumns A(n + m, n + m);
    A.setFromTriplets(entries.begin(), entries.end());
    VectorXd force = VectorXd::Zero(q.size()), phi(m), b(n + m), reduced(n);
    system_.add_applied_force(0.0, q, rest, 1.0, force);
    system_.reduce_force(force, reduced);
    system_.constraint(0.0, q, phi);
    b << reduced, -phi - kept * lambda_;
    const SparseLu factors(A);
    if (!factors.ok()) return false;
    const VectorXd x = factors.solve(b);
    step = x.head(n), lambda_ = x.tail(m);
    return x.allFinite();
  }

  const System& system_;
  SparseRows G_;
  std::vector<double> scratch_;
  VectorXd lambda_;
};

// The same with what moves without stretching a rod held where it is: steps
//
//     [ e M  G^T  D^T ] [ dz     ]   [  0               ]
//     [ G     0    0  ] [ lambda ] = [ -Phi             ]       D = d|d|/dz
//     [ D     0   -C  ] [ N      ]   [ -(|d| - l)       ]
//
// with e large beside what self-stress makes of the stiffness, small beside the rods' own.
class Joint {
 public:
  Joint(const System& system, const Structure& structure) : system_(system), structure_(structure) {}

  bool find(VectorXd& q) {
    const VectorXd given = q;
    VectorXd z = system_.reduce(q), step;
    double first = 0;
    for (int it = 0; it < most_steps; ++it) {
      if (!solve(q, held, step)) return false;
      z += step;
      system_.expand(z, q);
      const double size = step.lpNorm<Eigen::Infinity>();
      if (it == 0) first = size;
      if (size <= settled * first) break;
    }
    return (q - given).lpNorm<Eigen::Infinity>() <= farthest * first;
  }

  // How far nodes move in the linear theory, from a pose where what moves the mechanism stretches no rod:
  // what gives a little, as a long truss does, moves all of its way, the mechanism not at all. A negative
  // number where that cannot be told.
  double linear_move(const VectorXd& q) {
    VectorXd step, moved(q.size());
    lambda_.resize(0);
    if (!solve(q, barely_held, step)) return -1;
    system_.expand(system_.reduce(q) + step, moved);
    return (moved - q).lpNorm<Eigen::Infinity>();
  }

 private:
  static constexpr double held = 1e-3;  // e M over K
  static constexpr double barely_held = 1e-9;
  static constexpr double settled = 1e-6;  // of the first step
  static constexpr double farthest = 50;   // first steps

  // lambda goes on from that of the step before, so that what keeps redundant rows solvable leaves no error.
  bool solve(const VectorXd& q, double hold, VectorXd& step) {
    const std::vector<int>& giving = system_.giving_rods();
    const Index n = system_.solved_coordinates(), m = system_.constraints(), k = std::ssize(giving);
    SparseRows G = system_.jacobian_pattern();
    std::vector<double> scratch;
    system_.jacobian(q, G, scratch);
    const SparseRows D = system_.giving_rod_directions(q);
    VectorXd phi(m), b = VectorXd::Zero(n + m + k);
    system_.constraint(0.0, q, phi);
    std::vector<Eigen::Triplet<double>> entries;
    const auto add_row = [&](const SparseRows& A, int from, Index to) {
      for (SparseRows::InnerIterator it(A, from); it; ++it) {
        entries.emplace_back(static_cast<int>(to), static_cast<int>(it.col()), it.value());
        entries.emplace_back(static_cast<int>(it.col()), static_cast<int>(to), it.value());
      }
    };
    VectorXd stiffness = VectorXd::Zero(n);
    for (int i = 0; i < k; ++i) {
      const Rod& rod = structure_.rods[static_cast<std::size_t>(giving[static_cast<std::size_t>(i)])];
      const Index at = n + m + i;
      b[at] = rod.natural_length() - (node_vector(q.data(), rod.b) - node_vector(q.data(), rod.a)).norm();
      add_row(D, i, at);
      entries.emplace_back(static_cast<int>(at), static_cast<int>(at), -rod.compliance());
      for (SparseRows::InnerIterator it(D, i); it; ++it)
        stiffness[it.col()] += it.value() * it.value() / rod.compliance();
    }
    const double stiffest = (stiffness.array() / system_.mass().diagonal().array()).maxCoeff();
    const double kept = redundant / stiffness.maxCoeff();
    if (lambda_.size() != m) lambda_ = VectorXd::Zero(m);
    b.segment(n, m) = -phi - kept * lambda_;
    for (int r = 0; r < m; ++r) {
      add_row(G, r, n + r);
      entries.emplace_back(static_cast<int>(n) + r, static_cast<int>(n) + r, -kept);
    }
    add(entries, system_.mass(), hold * stiffest);
    SparseColumns A(n + m + k, n + m + k);
    A.setFromTriplets(entries.begin(), entries.end());
    const SparseLu factors(A);
    if (!factors.ok()) return false;
    const VectorXd x = factors.solve(b);
    step = x.head(n), lambda_ = x.segment(n, m);
    return x.allFinite();
  }

  const System& system_;
  const Structure& structure_;
  VectorXd lambda_;
};

// Goes on from where the mechanism was held: before that, forces of lengths that only are not fitted yet are
// all that there is to hold it. False, and q as it was, where no balance is found near: along a mechanism
// self-stress falls to a pose that the size of the errors has nothing to do with.
bool find_balance(const System& system, const Structure& structure, VectorXd& q) {
  constexpr double farthest = 3;  // times the linear theory: errors up to 1 % also turn what they move
  VectorXd held = q;
  Joint joint(system, structure);
  if (!joint.find(held)) held = q;
  if (!Balance(system).find(held)) return false;
  const double linear = joint.linear_move(q);
  if (linear >= 0 && !((held - q).lpNorm<Eigen::Infinity>() <= farthest * linear)) return false;
  q = held;
  return true;
}

void note_fit(Structure& structure, double most) {
  std::ostringstream note;
  note << "nodes were moved by at most " << most
       << " m to fit the lengths of elastic rods, without self-stress";
  structure.notes.push_back(note.str());
}

void note_self_stress(Structure& structure, const System& system, const VectorXd& q, double most,
                      bool balanced) {
  VectorXd force(static_cast<Index>(system.giving_rods().size()));
  system.giving_rod_forces(0.0, q, VectorXd::Zero(q.size()), force);
  Index at = 0;
  for (Index k = 0; k < force.size(); ++k) {
    force[k] /= structure.rods[static_cast<std::size_t>(system.giving_rods()[static_cast<std::size_t>(k)])]
                    .multiplicity;
    if (std::abs(force[k]) > std::abs(force[at])) at = k;
  }
  const Rod& rod =
      structure.rods[static_cast<std::size_t>(system.giving_rods()[static_cast<std::size_t>(at)])];
  std::ostringstream note;
  note << "rods that do not quite fit were joined: nodes were moved by at most " << most
       << " m, and the largest force of self-stress is " << force[at] << " N (rod " << rod.name << ")";
  if (!balanced)
    note << "; no pose near the given one has them in balance, so that they drive the mechanism, which was "
            "held as it is";
  structure.notes.push_back(note.str());
}

}  // namespace

void assemble_elastic(Structure& structure, bool eliminate_linear) {
  const int worst = furthest_off(structure);
  if (worst < 0) return;
  const GivenRod given_one = given_rod(structure, static_cast<std::size_t>(worst));
  const Rod& rod = given_one.rod;
  const std::string key = "rods[" + std::to_string(given_one.place) + "].length";
  std::ostringstream off;
  off << "elastic rod " << rod.name << " is " << 100 * misfit(structure, rod)
      << " % off the distance of its nodes";
  if (misfit(structure, rod) > fitted_share)
    throw StructureError(key, off.str() +
                                  "; nodes are moved for differences up to 1 % only: give positions "
                                  "that fit, or free_length for a rod that starts stretched");
  const System system(kept_straight(unloaded(structure), false), eliminate_linear);
  const VectorXd given = node_positions(structure);
  VectorXd q = given;
  const bool fits = fits_without_force(structure, eliminate_linear, q);
  const bool held = system.solved_coordinates() == 0;
  const bool balanced = fits || held || find_balance(system, structure, q);
  if (!balanced && !Joint(system, structure).find(q))
    throw StructureError(key, off.str() + ", and no pose near the given one has the rods in balance");
  double most = 0;
  for (std::size_t i = 0; i < structure.nodes.size(); ++i) {
    const auto at = static_cast<Index>(3 * i);
    structure.nodes[i].position = q.segment<3>(at);
    most = std::max(most, (q - given).segment<3>(at).norm());
  }
  if (fits)
    note_fit(structure, most);
  else
    note_self_stress(structure, system, q, most, balanced);
}

}  // namespace unfurl
