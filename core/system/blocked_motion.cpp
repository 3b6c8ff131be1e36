// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/blocked_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "core/math/coupled_columns.hpp"
#include "core/math/factors.hpp"
#include "core/math/singular_values.hpp"
#include "core/system/consistency.hpp"
#include "core/system/mobility.hpp"

namespace unfurl {
namespace {

constexpr Index most_coordinates = 300;  // dense algebra within a fraction of a second
// Singular values of unit rows. Round-off leaves 1e-15 of a dependent row; a structure that is so near to a
// singular pose on purpose (the folded ring of a thousand units: 1e-7) has no digits left to say so.
constexpr double round_off = 1e-14, meant = 1e-7;
// What is rigid by its make, slender or on short pins, is farther from a pose in which it moves.
constexpr double nearly_free = 1e-5, alone = 1e-2;
// Misfits below this let a run of usual length be right to eight digits.
constexpr double worth_a_word = 3e-13;

std::string rounded(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

// The longest of what constraints hold.
double size_of(const System& system) {
  return std::max(system.all_lengths().maxCoeff(), std::numeric_limits<double>::min());
}

// Node coordinates with the least |Phi| near q, by Levenberg's and Marquardt's method, without row `left_out`
// (-1: with all), or with that row moved by `by`: whether that is a pose.
bool leads_to_pose(const System& system, double t, VectorXd q, Index left_out, double by) {
  const double size = size_of(system);
  const Index n = q.size(), m = system.all_constraints();
  const auto residual = [&](const VectorXd& x) {
    VectorXd phi(m);
    system.all_constraint_values(t, x, phi);
    if (left_out >= 0) phi[left_out] = by != 0 ? phi[left_out] + by : 0;
    return phi;
  };
  VectorXd phi = residual(q);
  double damping = 1e-3;
  for (int it = 0; it < 200; ++it) {
    if (!(phi.norm() > 1e-9 * size)) return phi.allFinite();
    MatrixXd G(system.all_jacobian(q));
    if (left_out >= 0 && by == 0) G.row(left_out).setZero();
    const MatrixXd A = G.transpose() * G + damping * MatrixXd::Identity(n, n);
    const VectorXd next = q - Cholesky(A).solve(VectorXd(G.transpose() * phi)), there = residual(next);
    const bool better = there.norm() < phi.norm();
    const bool ends = better && there.norm() > (1 - 1e-6) * phi.norm();
    damping = std::max(1e-10, damping * (better ? 0.1 : 10));
    if (better) q = next, phi = there;
    if (ends || damping > 1e12) break;
  }
  // At a limit of the reach Newton's method is slow, and a millionth of the structure is there.
  return phi.norm() <= 1e-6 * size;
}

// From rods in line the method may find no way out of the line: asked again a thousandth beside it.
bool has_pose(const System& system, double t, const VectorXd& q, Index left_out, double by = 0) {
  if (leads_to_pose(system, t, q, left_out, by)) return true;
  VectorXd beside(q.size());
  for (Index i = 0; i < q.size(); ++i)
    beside[i] = 1e-3 * size_of(system) * std::cos(1.0 + static_cast<double>(i));
  return leads_to_pose(system, t, q + beside, left_out, by) ||
         leads_to_pose(system, t, q - beside, left_out, by);
}

// What hangs together by its rows, and how few digits show there.
struct Doubt {
  double misfit = 0;  // the largest singular value that is neither round-off nor meant
  double nearly = 0;  // of what stands still by its own rows: how far it is from a pose in which it moves
  std::vector<int> held{};  // those rows
  bool afloat = false;      // they move as one body
};

// Rows in sets that share no coordinate.
std::vector<std::vector<int>> sets_of_rows(const SparseRows& G, const std::vector<int>& rows) {
  CoupledColumns columns(G.cols());
  columns.join_rows_of(picked_rows(G, rows));
  std::map<Index, std::vector<int>> sets;
  for (const int r : rows)
    if (SparseRows::InnerIterator it(G, r); it) sets[columns.set_of(it.col())].push_back(r);
  std::vector<std::vector<int>> out;
  for (auto& [first, set] : sets) out.push_back(std::move(set));
  return out;
}

// Some rows with the columns that they have entries in.
MatrixXd dense_rows(const SparseRows& G, const std::vector<int>& rows) {
  std::map<Index, Index> place;
  for (const int r : rows)
    for (SparseRows::InnerIterator it(G, r); it; ++it) place.emplace(it.col(), 0);
  if (std::ssize(place) > most_coordinates) return {};
  Index count = 0;
  for (auto& [column, at] : place) at = count++;
  MatrixXd out = MatrixXd::Zero(std::ssize(rows), count);
  for (Index k = 0; k < out.rows(); ++k)
    for (SparseRows::InnerIterator it(G, rows[static_cast<std::size_t>(k)]); it; ++it)
      out(k, place.at(it.col())) = it.value();
  return out;
}

// Of a set, what bears the self-stress that its smallest singular value but for round-off nearly is, and all
// that takes part in nothing else: without what hangs from it.
std::vector<int> stressed_rows(const SparseRows& G, const std::vector<int>& set, const MatrixXd& D) {
  constexpr double bears = 1e-3;  // what hangs from it bears as little as that singular value
  const MatrixXd nearly = column_complement(D, nearly_free), dependent = column_complement(D, dependent_row);
  if (nearly.cols() != dependent.cols() + 1) return {};
  const MatrixXd other = nearly - dependent * (dependent.transpose() * nearly);
  Index most = 0;
  other.colwise().norm().maxCoeff(&most);
  const VectorXd stress = other.col(most).cwiseAbs();
  std::vector<bool> touched(static_cast<std::size_t>(G.cols()), false);
  const auto each = [&](int row, const auto& act) {
    for (SparseRows::InnerIterator it(G, row); it; ++it) act(static_cast<std::size_t>(it.col()));
  };
  for (std::size_t k = 0; k < set.size(); ++k)
    if (stress[static_cast<Index>(k)] > bears * stress.maxCoeff())
      each(set[k], [&](std::size_t column) { touched[column] = true; });
  std::vector<int> out = set;
  std::erase_if(out, [&](int row) {
    bool beyond = false;
    each(row, [&](std::size_t column) { beyond = beyond || !touched[column]; });
    return beyond;
  });
  return out;
}

// What stands still by these rows, if it nearly does not.
void find_held(const System& system, const ConstVec& q, const SparseRows& G, const std::vector<int>& rows,
               const MatrixXd& D, const VectorXd& values, Doubt& doubt) {
  // Slender bodies have several small values of alike size.
  const Index rank = (values.array() > dependent_row).count();
  const auto stands_alone = [&] { return rank == 1 || values[rank - 1] < alone * values[rank - 2]; };
  if (rank == 0 || !(values[rank - 1] < nearly_free) || !stands_alone()) return;
  const Index rigid = rigid_motions(picked_rows(G, rows), q, system.ghosts());
  if (rank + rigid == D.cols()) {
    doubt.nearly = values[rank - 1];
    doubt.held = rows;
    doubt.afloat = rigid > 0;
    return;
  }
  const std::vector<int> part = stressed_rows(G, rows, D);
  if (part.empty() || part.size() == rows.size()) return;
  const MatrixXd of_part = dense_rows(G, part);
  find_held(system, q, G, part, of_part, singular_values(of_part), doubt);
}

Doubt doubt_of_rows(const System& system, const ConstVec& q) {
  Doubt doubt;
  // A drive moves what the others leave free, so that with its row they look independent.
  std::vector<int> rows = counted_rows(system, q);
  const std::vector<int> sources = system.all_sources();
  for (const Drive& drive : system.drives())
    std::erase_if(rows, [&](int r) { return sources[static_cast<std::size_t>(r)] == drive.constraint; });
  for (const int implied : system.rows_of_digits()) std::erase(rows, implied);
  const SparseRows G = unit_rows(system, q);
  for (const std::vector<int>& set : sets_of_rows(G, rows)) {
    const MatrixXd D = dense_rows(G, set);
    if (D.size() == 0 || same_rank(D, round_off, nearly_free)) continue;  // as nearly always, and cheaper
    const VectorXd values = singular_values(D);
    for (const double value : values)
      if (value > round_off && value < meant) doubt.misfit = std::max(doubt.misfit, value);
    find_held(system, q, G, set, D, values, doubt);
  }
  return doubt;
}

}  // namespace

double misfit_of_rows(const System& system, const ConstVec& q) {
  return doubt_of_rows(system, q).misfit;
}

std::string misfit_warning(const System& system, const ConstVec& q) {
  const Doubt doubt = doubt_of_rows(system, q);
  const double misfit = doubt.misfit;
  if (!doubt.held.empty()) {
    const std::vector<std::string> all = system.all_names();
    std::vector<std::string> names;
    for (const bool rods : {true, false})
      for (const int row : doubt.held)
        if (const std::string& name = all[static_cast<std::size_t>(row)]; name.starts_with("rod ") == rods)
          names.push_back(name);
    return listed(names, 4) + " hold each other " + (doubt.afloat ? "as one rigid body" : "and stand still") +
           ", though they nearly leave one motion (all but " + rounded(doubt.nearly, 2) +
           " of their size): if it is meant, " +
           (doubt.nearly < rounding_of_rows(system, q)
                ? "move the structure near the origin, from which it stands too far for the digits that a "
                  "number has"
                : "give its positions all 16 digits (an expression, \"=...\", has them)");
  }
  if (misfit < worth_a_word) return "";
  const std::string found = "constraints of this structure follow from one another only to " +
                            rounded(misfit, 2) + " of their size";
  if (misfit < rounding_of_rows(system, q))
    return found +
           ", which is what rounding its positions leaves so far from the origin; the motion is no better "
           "than "
           "that and worse over time: move the structure near the origin";
  return found +
         ": its positions have too few digits (unless they are next to a singular pose on "
         "purpose), and the motion is no better than they are and worse over time; give them all 16 digits, "
         "or solver.model = \"path\"";
}

std::string beyond_reach(const System& system, double t, double h, const ConstVec& q) {
  if (system.coordinates() > most_coordinates || system.drives().empty()) return "";
  const std::vector<int> sources = system.all_sources();
  const auto row_of = [&](const Drive& drive) {
    return std::find(sources.begin(), sources.end(), drive.constraint) - sources.begin();
  };
  const auto value = [](const Drive& drive, double when) {
    const double unit = drive.angle ? 180 / std::numbers::pi : 1;
    return rounded(unit * drive.target(when), 4) + (drive.angle ? " deg" : " m");
  };
  for (const double soon : {h, 4 * h, 16 * h, 0.02 * t}) {
    if (!(soon > 0) || has_pose(system, t + soon, q, -1)) continue;
    for (const Drive& drive : system.drives()) {
      const Index row = row_of(drive);
      if (row == std::ssize(sources) || !has_pose(system, t + soon, q, row)) continue;
      return "the drive " + drive.name + " asks for " + value(drive, t + soon) +
             " at t = " + rounded(t + soon, 4) + " s, past what the other constraints reach (it was at " +
             value(drive, t) + " at t = " + rounded(t, 4) + " s): let it move less far";
    }
    return "";
  }
  for (const Drive& drive : system.drives()) {
    constexpr double next = 1e-4;  // far more than what counts as a pose, and nothing to what is driven
    const Index row = row_of(drive);
    if (row == std::ssize(sources) || !drive.target.moves()) continue;
    for (const double by : {-next, next}) {
      if (has_pose(system, t + h, q, row, by * size_of(system))) continue;
      // Rows are value - target: with `by` more of it the value would be by less than the target.
      const bool leaves = by * (drive.target(t + h) - drive.target(t - h)) > 0;
      const std::string utmost = ", the utmost that the other constraints reach (a dead centre), ";
      if (leaves)
        return "the drive " + drive.name + " sets out from " + value(drive, t) + utmost +
               "where it turns the rods without a bound: make solver.step smaller";
      return "the drive " + drive.name + " leads to " + value(drive, t + h) + utmost +
             "where no step goes on: let it end a ten-thousandth of its way before";
    }
  }
  return "";
}

// To second order a motion q + e v + e^2 w/2 needs G v = 0 and v^T H_k v + g_k w = 0 for every row k. With a
// self-stress y, sum y_k g_k = 0, that leaves K(v) = sum y_k v^T H_k v = 0: where K is of one sign over the
// null space of G, all that it does not vanish for is blocked (Connelly & Whiteley 1996: prestress
// stability). v^T H_k v are second differences, exact but for rounding where Phi is a square.
std::string held_at_second_order(const System& system, const ConstVec& q) {
  const Index n = system.coordinates(), m = system.all_constraints();
  const auto& rods = system.rod_rows();
  if (n > most_coordinates || std::ranges::any_of(rods, [](int row) { return row < 0; })) return "";
  const MatrixXd G(system.all_jacobian(q));
  const MatrixXd V = column_complement(G.transpose(), 1e-9), Y = column_complement(G, 1e-9);
  constexpr Index most_free = 60;
  if (V.cols() == 0 || V.cols() > most_free || Y.cols() == 0) return "";
  const double step = 1e-4 * size_of(system);
  VectorXd here(m), there(m), back(m);
  system.all_constraint_values(0.0, q, here);
  const auto bent = [&](const VectorXd& v) -> VectorXd {
    system.all_constraint_values(0.0, q + step * v, there);
    system.all_constraint_values(0.0, q - step * v, back);
    return (there + back - 2 * here) / (step * step);
  };
  std::vector<MatrixXd> K(static_cast<std::size_t>(Y.cols()), MatrixXd(V.cols(), V.cols()));
  for (Index i = 0; i < V.cols(); ++i)
    for (Index j = 0; j <= i; ++j) {
      const VectorXd both = Y.transpose() * (bent(V.col(i) + V.col(j)) - bent(V.col(i) - V.col(j))) / 4;
      for (Index k = 0; k < Y.cols(); ++k) {
        MatrixXd& of = K[static_cast<std::size_t>(k)];
        of(i, j) = of(j, i) = both[k];
      }
    }
  const std::vector<std::string> all = system.all_names();
  for (Index k = 0; k < Y.cols(); ++k) {
    const VectorXd e = symmetric_eigen(K[static_cast<std::size_t>(k)]).values;
    const double most = e.cwiseAbs().maxCoeff();
    // With l the longest rod, K is some 1 / l, and second differences are good to 1e-16 / 1e-8 of that.
    if (!(most * step > 1e-8) || (e.minCoeff() < -1e-4 * most && e.maxCoeff() > 1e-4 * most)) continue;
    std::vector<std::string> names;
    for (Index r = 0; r < m; ++r)
      if (std::abs(Y(r, k)) > 1e-6 && all[static_cast<std::size_t>(r)].starts_with("rod "))
        names.push_back(all[static_cast<std::size_t>(r)]);
    if (!names.empty()) return listed(names, 4);
  }
  return "";
}

// As above: of a motion that goes on, y . (v^T H v) vanishes for every self-stress y. What two cranks in line
// with their coupler leave of it is of the size of the curvatures, not of their round-off.
bool of_no_branch(const System& system, const ConstVec& q, const ConstVec& v) {
  const Index m = system.all_constraints();
  const double speed = v.size() ? v.lpNorm<Eigen::Infinity>() : 0.0;
  if (system.coordinates() > most_coordinates || !(speed > 0) || system.rheonomic()) return false;
  const MatrixXd Y = column_complement(MatrixXd(system.all_jacobian(q)), 1e-9);
  if (Y.cols() == 0) return false;
  const double step = 1e-4 * size_of(system);
  const VectorXd way = step / speed * v;
  VectorXd here(m), there(m), back(m);
  system.all_constraint_values(0.0, q, here);
  system.all_constraint_values(0.0, q + way, there);
  system.all_constraint_values(0.0, q - way, back);
  const VectorXd bent = there + back - 2 * here;
  constexpr double rounding = 1e-6;
  return (Y.transpose() * bent).norm() > rounding * std::max(bent.norm(), step * 1e-4);
}

}  // namespace unfurl
