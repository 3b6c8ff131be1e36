// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "core/math/coupled_columns.hpp"
#include "core/math/factors.hpp"
#include "core/math/singular_values.hpp"
#include "core/structure/node_positions.hpp"
#include "core/structure/structure_error.hpp"
#include "core/system/mobility.hpp"

namespace unfurl {

std::string listed(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < most; ++i) text += (i ? ", " : "") + names[i];
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text;
}

namespace {

constexpr Index max_coordinates = 900;
// Share of a row's length, or of the structure's if that is longer: positions typed with nine digits pass, a
// missing digit does not.
constexpr double violated = 1e-7;
// Of unit rows: round-off of a dense factorisation, far below the distance of real poses from singular ones.
constexpr double dependent = 1e-10;

// Rows of unit size, and what they were divided by. What is none of the equations is zero.
SparseRows unit_rows(const System& system, const VectorXd& q, VectorXd& norms) {
  SparseRows G(system.all_jacobian(q));
  for (const int r : system.rows_of_digits()) G.row(r) *= 0;
  norms.resize(G.rows());
  for (int r = 0; r < G.rows(); ++r) {
    norms[r] = G.row(r).norm();
    if (norms[r] > 0) G.row(r) /= norms[r];
  }
  return G;
}

// -g' of those rows.
VectorXd unit_rates(const System& system, double t, const VectorXd& q, const VectorXd& norms) {
  VectorXd rate(norms.size());
  std::vector<double> scratch;
  system.all_constraint_rates(t, q, VectorXd::Zero(q.size()), rate, scratch);
  for (Index r = 0; r < rate.size(); ++r)
    if (norms[r] > 0) rate[r] /= norms[r];
  return rate;
}

// At some time, however soon, late or fast.
bool changes(const TimeFunction& f) {
  if (f.kind == TimeFunction::Kind::spline || f.kind == TimeFunction::Kind::linear)
    return std::ranges::any_of(f.values, [&](double x) { return x != f.values[0]; });
  if (f.kind == TimeFunction::Kind::sine) return f.rate != 0 || f.rise != 0;
  return f.kind == TimeFunction::Kind::rate ? f.rate != 0 : f.moves() && f.rise != 0;
}

class Checker {
 public:
  Checker(const Structure& structure, const System& system)
      : system_(system),
        names_(system.all_names()),
        sources_(system.all_sources()),
        q_(node_positions(structure)),
        in_space_(space_coordinates(structure)),
        elastic_(std::any_of(structure.rods.begin(), structure.rods.end(),
                             [](const Rod& rod) { return rod.elastic(); })),
        warms_(std::any_of(
            structure.rods.begin(), structure.rods.end(),
            [](const Rod& rod) { return !rod.gives && rod.expansion != 0 && changes(rod.warming); })),
        own_(structure.kind == "custom") {}

  void run() {
    check_positions();
    const bool driven = !system_.drives().empty();
    if (!driven && system_.all_constraints() < system_.coordinates()) return;
    if (!driven && system_.coordinates() > max_coordinates) return check_freedom_of_many();
    G_ = unit_rows(system_, q_, norms_);
    if (driven)
      for (const Drive& drive : system_.drives()) check_drive(drive);
    else if (!elastic_ && !warms_)
      check_freedom();
  }

 private:
  const std::string& name(Index row) const { return names_[static_cast<std::size_t>(row)]; }

  double reach() const { return q_.size() ? q_.lpNorm<Eigen::Infinity>() : 0.0; }

  // The longest side of the box that holds the nodes [m]: where the origin lies is no excuse for an error.
  double extent_of_nodes() const {
    if (in_space_ == 0) return 0.0;
    const Eigen::Map<const Eigen::Matrix3Xd> x(q_.data(), 3, in_space_ / 3);
    return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
  }

  void check_positions() const {
    VectorXd phi(system_.all_constraints());
    system_.all_constraint_values(0.0, q_, phi);
    const VectorXd lengths = system_.all_lengths();
    const double extent = extent_of_nodes(), noise = 64 * std::numeric_limits<double>::epsilon() * reach();
    std::vector<std::string> wrong;
    double worst = 0;
    for (Index r = 0; r < phi.size(); ++r) {
      if (std::abs(phi[r]) <= violated * std::max(lengths[r], extent) + noise) continue;
      wrong.push_back(name(r));
      worst = std::max(worst, std::abs(phi[r]));
    }
    if (wrong.empty()) return;
    std::ostringstream text;
    text << "the structure cannot be assembled as given: " << listed(wrong)
         << (wrong.size() == 1 ? " is" : " are") << " violated at t = 0, by up to " << worst << " m";
    throw StructureError("", text.str());
  }

  // Row r as a sum of the others, share by share; empty where it is none. Others that are a change of 1/|y|
  // of their size away from leaving the motion free count as leaving it below what counts as dependent. Of
  // those that share no coordinate with it, be it through others, its shares are zero.
  static VectorXd combination(const SparseRows& G, int r) {
    CoupledColumns sets(G.cols());
    sets.join_rows_of(G);
    const auto set_of_row = [&](int k) {
      const SparseRows::InnerIterator it(G, k);
      return it ? sets.set_of(it.col()) : -1;
    };
    std::vector<Index> rows, place(static_cast<std::size_t>(G.cols()), 0);
    for (int k = 0; k < G.rows(); ++k)
      if (set_of_row(k) == set_of_row(r)) rows.push_back(k);
    Index count = 0;
    for (Index k = 0; k < G.cols(); ++k)
      if (sets.set_of(k) == set_of_row(r)) place[static_cast<std::size_t>(k)] = count++;
    if (count > max_coordinates) return {};
    MatrixXd A = MatrixXd::Zero(count, std::ssize(rows));
    for (Index k = 0; k < A.cols(); ++k)
      for (SparseRows::InnerIterator it(G, rows[static_cast<std::size_t>(k)]); it; ++it)
        A(place[static_cast<std::size_t>(it.col())], k) = it.value();
    const Index own = std::ranges::find(rows, r) - rows.begin();
    const VectorXd row = A.col(own);
    A.col(own).setZero();
    const VectorXd y = least_squares(A, row);
    constexpr double round_off = 1e-13;  // of each share
    const double most = y.norm(), left = (A * y - row).norm();
    if (most * dependent_row > 1 || left > std::max(dependent, round_off * most)) return {};
    VectorXd shares = VectorXd::Zero(G.rows());
    shares(rows) = y;
    return shares;
  }
  static std::vector<Index> members_of(const VectorXd& shares) {
    std::vector<Index> found;
    for (Index k = 0; k < shares.size(); ++k)
      if (std::abs(shares[k]) > 1e-6) found.push_back(k);
    return found;
  }
  bool is_drive(Index row) const {
    const int source = sources_[static_cast<std::size_t>(row)];
    return std::any_of(system_.drives().begin(), system_.drives().end(),
                       [&](const Drive& d) { return d.constraint == source; });
  }

  // A drive whose row follows from rows that stand still asks them to move.
  void check_drive(const Drive& drive) const {
    const auto row = static_cast<int>(std::ranges::find(sources_, drive.constraint) - sources_.begin());
    std::vector<std::string> held;
    const VectorXd shares = combination(G_, row);
    for (const Index k : members_of(shares)) {
      if (is_drive(k)) return check_agreement(row, shares);
      held.push_back(name(k));
    }
    if (held.empty()) return;
    throw StructureError("", "the drive " + drive.name +
                                 " moves what other constraints hold: " + listed(held) + "; " +
                                 too_few_digits(1 / shares.norm()) + "remove the drive, or one of these");
  }

  // Rows that depend on each other in every pose must ask for the same: g'_r = sum share_k g'_k at all times.
  void check_agreement(int row, const VectorXd& shares) const {
    VectorXd moved = q_, norms_moved;
    const double shift = 1e-3 * extent_of_nodes();
    for (Index i = 0; i < moved.size(); ++i) moved[i] += shift * std::sin(1.0 + 2.3 * static_cast<double>(i));
    const VectorXd shares_moved = combination(unit_rows(system_, moved, norms_moved), row);
    if (shares_moved.size() == 0 || (shares_moved - shares).norm() > 1e-6 * shares.norm()) return;
    for (const double t : times_of_drives()) {
      const VectorXd wanted = unit_rates(system_, t, q_, norms_);
      if (std::abs(wanted[row] - shares.dot(wanted)) <= 1e-9 * wanted.lpNorm<Eigen::Infinity>()) continue;
      std::vector<std::string> names{name(row)};
      for (const Index k : members_of(shares)) names.push_back(name(k));
      std::ostringstream text;
      text << "drives contradict each other at t = " << t << " s: " << listed(names)
           << " hold or drive the same motion; remove one, or let them agree";
      throw StructureError("", text.str());
    }
  }

  // Between all times at which something begins, ends or is tabled, and after the last.
  std::vector<double> times_of_drives() const {
    std::vector<double> knots{0.0};
    for (const Drive& drive : system_.drives()) {
      const TimeFunction& f = drive.target;
      knots.insert(knots.end(), f.times.begin(), f.times.end());
      for (const double t : {f.start, f.start + f.ramp, f.start + f.duration}) knots.push_back(t);
    }
    std::sort(knots.begin(), knots.end());
    knots.push_back(knots.back() + 1);
    std::vector<double> times;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i)
      for (const double u : {0.0, 0.3, 0.7}) times.push_back(knots[i] + u * (knots[i + 1] - knots[i]));
    return times;
  }

  // By the tolerance of check's degrees of freedom: what has none stands still.
  void check_freedom() const {
    const MatrixXd G(G_);
    if (rank_of(G, 0.01 * dependent_row) < G.cols()) return;  // as nearly always, and cheaper
    const VectorXd values = singular_values(G);
    if (values.size() < G.cols() || !(values[G.cols() - 1] > dependent_row)) return;
    refuse_to_stand_still(too_few_digits(values[G.cols() - 1]));
  }
  // By sparse elimination. Families of many parts are made to move.
  void check_freedom_of_many() const {
    if (!own_ || elastic_ || warms_ || !system_.drives().empty()) return;
    if (analyse_mobility(system_, q_).degrees_of_freedom == 0)
      refuse_to_stand_still("if it is meant to move, give its positions all 16 digits; else ");
  }
  void refuse_to_stand_still(const std::string& doubt) const {
    std::vector<std::string> names, members;
    for (const int row : counted_rows(system_, q_)) names.push_back(name(row));
    for (auto n = names.rbegin(); n != names.rend(); ++n)  // what is held or driven by name comes first
      if (n->rfind("rod ", 0) != 0) members.push_back(*n);
    for (const auto& n : names)
      if (n.rfind("rod ", 0) == 0) members.push_back(n);
    throw StructureError("", "nothing can move: " + std::to_string(names.size()) + " constraints hold all " +
                                 std::to_string(system_.coordinates()) + " coordinates; " + doubt +
                                 "free one of " + listed(members));
  }

  // A structure that moves has rows that depend on each other exactly; positions with few digits leave a
  // remainder. What is rigid by its make is farther from such a pose.
  std::string too_few_digits(double smallest) const {
    constexpr double by_rounding = 1e-3;
    if (!(smallest < by_rounding)) return "";
    std::ostringstream text;
    text << std::setprecision(2) << "they nearly leave one motion (all but " << smallest
         << " of their size): if it is meant to move, "
         << (smallest < rounding_of_rows(system_, q_)
                 ? "move it near the origin, from which it stands too far for the digits that a number has"
                 : "give its positions all 16 digits (an expression, \"=...\", has them)")
         << "; else ";
    return text.str();
  }

  const System& system_;
  std::vector<std::string> names_;
  std::vector<int> sources_;
  VectorXd q_;
  Index in_space_;  // of q_; behind it lie ghosts
  bool elastic_;    // a truss that stands still has forces and frequencies all the same
  bool warms_;      // a row prescribes a motion, whenever that is
  bool own_;        // a scene's own structure
  SparseRows G_;    // unit rows
  VectorXd norms_;
};

}  // namespace

void check_consistency(const Structure& structure, const System& system) {
  Checker(structure, system).run();
}

std::string driven_against(const System& system, double t, const VectorXd& q) {
  constexpr double too_much = 1e-3;  // of the rates
  if (system.coordinates() > max_coordinates) return "";
  VectorXd norms;
  const MatrixXd G(unit_rows(system, q, norms));
  const VectorXd wanted = unit_rates(system, t, q, norms);
  const double most = wanted.size() > 0 ? wanted.lpNorm<Eigen::Infinity>() : 0.0;
  if (!(most > 0)) return "";
  const VectorXd found = least_squares(G, wanted);
  if ((G * found - wanted).norm() <= too_much * wanted.norm()) return "";
  const std::vector<std::string> all = system.all_names();
  std::vector<std::string> names;
  for (Index r = 0; r < wanted.size(); ++r)
    if (std::abs(wanted[r]) > 1e-9 * most) names.push_back(all[static_cast<std::size_t>(r)]);
  return listed(names);
}

}  // namespace unfurl
