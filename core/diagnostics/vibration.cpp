// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/vibration.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/diagnostics/bent_rods.hpp"
#include "core/integrators/index1.hpp"
#include "core/math/determined_rows.hpp"
#include "core/math/factors.hpp"
#include "core/simulate/elastic_sharing.hpp"
#include "core/system/rigid_twin.hpp"

namespace unfurl {
namespace {

constexpr double no_rank = 1e-9;   // of a unit row, less what others hold of it: a direction that it does not
constexpr double nothing = 1e-11;  // of what gravity, loads and tensions make of w^2
constexpr double no_potential = 1e-10;  // of the stiffness without rods: asymmetry that is not rounding
constexpr double far_below = 1e-3;      // of the lowest elastic eigenvalue: solved for by itself
constexpr double rounded = 1e-14;       // of the stiffness, in eigenvalues

// Orthonormal columns that span the x with A x = 0; rows of A of unit length or zero.
MatrixXd null_space(const MatrixXd& A) {
  if (A.rows() == 0) return MatrixXd::Identity(A.cols(), A.cols());
  return column_complement(A.transpose(), no_rank);
}

// A B C: products of products take a compiler a second each.
MatrixXd product(const MatrixXd& A, const MatrixXd& B, const MatrixXd& C) {
  const MatrixXd AB = A * B;
  return AB * C;
}

// X^T K X.
MatrixXd congruent(const MatrixXd& K, const MatrixXd& X) {
  const MatrixXd left = X.transpose() * K;
  return left * X;
}

// X with X^T M X = 1 for the columns' span.
MatrixXd orthonormal(const MatrixXd& X, const MatrixXd& M) {
  return Cholesky(congruent(M, X)).solve_lower(X.transpose()).transpose();
}

MatrixXd symmetric(const MatrixXd& A) {
  return 0.5 * (A + A.transpose());
}

VectorXd nodes_of(const System& system, const State& pose) {
  VectorXd q(system.coordinates());
  system.expand(pose.z, q);
  return q;
}

// Rows of node coordinates as rows of solved ones.
MatrixXd reduced_rows(const System& system, const MatrixXd& rows) {
  MatrixXd out(rows.rows(), system.solved_coordinates());
  VectorXd one(out.cols());
  for (Index r = 0; r < rows.rows(); ++r) {
    system.reduce_force(rows.row(r).transpose(), one);
    out.row(r) = one.transpose();
  }
  return out;
}

void make_unit_rows(MatrixXd& A) {
  for (Index row = 0; row < A.rows(); ++row)
    if (const double norm = A.row(row).norm(); norm > 0) A.row(row) /= norm;
}

// The model at the pose, in solved coordinates.
class AtPose {
 public:
  // known: forces N_0 that elastic rods have now, NaN of others; empty: of none. At rest under the loads they
  // have N_0 + N with
  //
  //     M a + G^T (lambda + N) = F - G^T N_0,   G a = 0
  //
  // and N of least energy: N_0 is kept where it is self-stress, and not where it is a load's that has yet to
  // come, or that of a wave.
  AtPose(const Model& model, const State& pose, const VectorXd& known)
      : bent_(model.structure, nodes_of(model.system, pose)), system_(unbent(model).at(pose)) {
    State rest = pose;
    rest.w.setZero(rest.z.size());
    const VectorXd q = nodes_of(system_, rest);
    VectorXd acceleration(rest.z.size());
    SparseRows G = system_.jacobian_pattern();
    std::vector<double> scratch;
    system_.jacobian(q, G, scratch);
    VectorXd compliance = row_compliance(model, rest.t);
    if (compliance.size() == 0) compliance = VectorXd::Zero(G.rows());
    const std::vector<char> rigidly = determined_rows(G);
    const bool all = std::find(rigidly.begin(), rigidly.end(), 0) == rigidly.end();
    Index1 index1(system_, true);
    const VectorXd given = rows_of(model, known, G.rows());
    VectorXd lambda = rest.lambda;
    lambda.setZero(G.rows());
    if (index1.evaluate_at_rest(rest, acceleration, lambda)) {
      lambda -= given;
      ElasticSharing(model, all).share(rest.t, q, false, lambda);
      lambda += given;
    } else {
      lambda = given;
    }
    const std::vector<char> determined = all ? rigidly : determined_rows(G, compliance);
    for (const int row : model.system.rod_rows())
      unique = unique && determined[static_cast<std::size_t>(row)] != 0;
    mass = MatrixXd(system_.mass());
    take_stiffness(model, q, G, compliance, lambda, rest);
  }

  MatrixXd mass, elastic, geometric;  // K = elastic + geometric + skew
  MatrixXd skew;                      // of forces without a potential
  MatrixXd rigid_rows, rows;          // of unit length
  MatrixXd mechanism;  // rods keep their lengths, and those that were cut their shapes; orthonormal by mass
  double pull = 0.0;   // what the applied forces alone may give, of w^2 [1/s^2]
  bool unique = true;

 private:
  System unbent(const Model& model) const {
    return bent_.any() ? System(bent_.unbent, model.system.eliminated()) : model.system;
  }

  static VectorXd rows_of(const Model& model, const VectorXd& known, Index rows) {
    VectorXd given = VectorXd::Zero(rows);
    for (Index r = 0; r < known.size(); ++r)
      if (!std::isnan(known[r])) given[model.system.rod_rows()[static_cast<std::size_t>(r)]] = known[r];
    return given;
  }

  void take_stiffness(const Model& model, const VectorXd& q, const SparseRows& G, const VectorXd& compliance,
                      const VectorXd& lambda, const State& rest) {
    SparseRows by_z, by_w;
    system_.force_derivatives(rest.t, q, VectorXd::Zero(q.size()), by_z, by_w);
    geometric = MatrixXd(system_.curvature(q, lambda)) - MatrixXd(by_z);
    elastic.setZero(mass.rows(), mass.rows());
    rows = MatrixXd(G);
    std::vector<Index> rigid;
    const std::vector<int>& of_rod = model.system.rod_rows();
    for (std::size_t r = 0; r < of_rod.size(); ++r) {
      const Index row = of_rod[r];
      if (!(compliance[row] > 0)) continue;
      const VectorXd g = rows.row(row).transpose();
      elastic += (1 / compliance[row]) * g * g.transpose();
      const Rod& rod = model.structure.rods[r];
      const double longer = 1 + rod.warmed(rest.t);
      geometric -= (lambda[row] / (rod.length * longer * longer)) * g * g.transpose();
    }
    skew = 0.5 * (geometric - geometric.transpose());
    geometric = symmetric(geometric);
    VectorXd force = VectorXd::Zero(q.size()), reduced(mass.rows());
    system_.add_applied_force(rest.t, q, VectorXd::Zero(q.size()), 1.0, force);
    system_.reduce_force(force, reduced);
    double shortest = std::numeric_limits<double>::infinity();
    for (const Rod& rod : model.structure.rods) shortest = std::min(shortest, rod.length);
    if (mass.rows() > 0) pull = Cholesky(mass).solve(reduced).lpNorm<Eigen::Infinity>() / shortest;
    // What sums up a controller's error moves nothing.
    std::vector<Index> sums;
    for (const Force& f : model.structure.forces)
      if (f.motor.integrator >= 0) sums.push_back(3 * f.motor.integrator);
    MatrixXd held = MatrixXd::Zero(std::ssize(sums), q.size());
    for (Index k = 0; k < held.rows(); ++k) held(k, sums[static_cast<std::size_t>(k)]) = 1;
    rows.conservativeResize(rows.rows() + held.rows(), Eigen::NoChange);
    rows.bottomRows(held.rows()) = reduced_rows(system_, held);
    make_unit_rows(rows);
    for (Index row = 0; row < rows.rows(); ++row)
      if (row >= compliance.size() || !(compliance[row] > 0)) rigid.push_back(row);
    rigid_rows = rows(rigid, Eigen::all);
    take_bending();
  }

  // The energy of bending is elastic but for what the mechanism has of it, by moments. K stays the same.
  void take_bending() {
    MatrixXd shapes = reduced_rows(system_, bent_.rigid);
    make_unit_rows(shapes);
    MatrixXd all(rows.rows() + shapes.rows(), rows.cols());
    all.topRows(rows.rows()) = rows;
    all.bottomRows(shapes.rows()) = shapes;
    mechanism = orthonormal(null_space(all), mass);
    if (!bent_.any()) return;
    const MatrixXd g = reduced_rows(system_, bent_.rows);
    MatrixXd of_mechanism = g * mechanism;
    for (Index r = 0; r < g.rows(); ++r)
      for (Index k = 0; k < mechanism.cols(); ++k)
        if (std::abs(of_mechanism(r, k)) <= no_turn * g.row(r).norm() * mechanism.col(k).norm())
          of_mechanism(r, k) = 0;
    const MatrixXd drawn = product(of_mechanism, mechanism.transpose(), mass), own = g - drawn,
                   pulls = bent_.stiffness.asDiagonal() * own, mixed = pulls.transpose() * drawn,
                   drawn_pulls = bent_.stiffness.asDiagonal() * drawn;
    elastic += pulls.transpose() * own;
    geometric += mixed + mixed.transpose();
    geometric += drawn_pulls.transpose() * drawn;
    for (Index r = 0; r < g.rows(); ++r)  // of which the system has all
      if (bent_.bent[static_cast<std::size_t>(r)])
        geometric -= bent_.stiffness[r] * g.row(r).transpose() * g.row(r);
  }

  static constexpr double no_turn = 1e-12;  // of a joint: round-off
  BentRods bent_;
  System system_;
};

double largest_magnitude_of(const VectorXd& values) {
  return values.size() ? values.lpNorm<Eigen::Infinity>() : 0.0;
}

// Eigenvalues w^2 and vectors in solved coordinates, mechanism motions first.
struct Solved {
  std::vector<std::complex<double>> squares;  // in pairs where they are complex: two vectors span the motion
  MatrixXd vectors;
  Index mechanism = 0;
};

// Stiffness with a part that has no potential: K is not symmetric, and of a pair of complex w^2 the real and
// the imaginary part of x are the vectors. N0, Z: orthonormal in the mass metric.
Solved solve_general(const AtPose& at, const MatrixXd& N0, const MatrixXd& Z) {
  const MatrixXd A = congruent(at.elastic + at.geometric + at.skew, Z);
  const ComplexEigen all = complex_eigen(A);
  const double zero = rounded * A.norm();
  std::vector<Index> order;
  for (Index k = 0; k < all.values.size(); ++k) order.push_back(k);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::pair(all.values[a].real(), a) < std::pair(all.values[b].real(), b);
  });
  VectorXd share(all.values.size());
  const MatrixXd by_mass = product(N0.transpose(), at.mass, Z);
  for (Index k = 0; k < share.size(); ++k)
    share[k] = (by_mass * all.vectors.col(k)).squaredNorm() / all.vectors.col(k).squaredNorm();
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return share[a] > share[b]; });
  const auto by_stiffness = [&](Index a, Index b) {
    const std::complex<double> x = all.values[a], y = all.values[b];
    return std::tuple(x.real(), std::abs(x.imag()), x.imag()) <
           std::tuple(y.real(), std::abs(y.imag()), y.imag());
  };
  std::sort(order.begin(), order.begin() + N0.cols(), by_stiffness);
  std::sort(order.begin() + N0.cols(), order.end(), by_stiffness);
  Solved out{{}, MatrixXd(Z.rows(), Z.cols()), N0.cols()};
  for (const Index k : order) {
    const std::complex<double> square = all.values[k];
    const Eigen::VectorXcd x = (square.imag() > 0 ? std::complex<double>(0, -1) : 1.0) * all.vectors.col(k);
    out.vectors.col(std::ssize(out.squares)) = Z * x.real();
    out.squares.push_back(std::abs(square) <= zero ? 0.0 : square);
  }
  return out;
}

Solved solve(const AtPose& at) {
  const MatrixXd &N0 = at.mechanism, Z = orthonormal(null_space(at.rigid_rows), at.mass);
  if (Z.cols() == 0) return {};  // a drive holds all that could move
  if (congruent(at.skew, Z).norm() > no_potential * congruent(at.geometric, Z).norm())
    return solve_general(at, N0, Z);
  const MatrixXd K = at.elastic + at.geometric;
  const SymmetricEigen all = symmetric_eigen(symmetric(congruent(K, Z)));
  const MatrixXd X = Z * all.vectors;
  Solved out;
  out.mechanism = N0.cols();
  std::vector<Index> order(static_cast<std::size_t>(X.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  // What lies in the span of N_0 to first order is the mechanism's.
  const VectorXd share = product(N0.transpose(), at.mass, X).colwise().squaredNorm().transpose();
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return share[a] > share[b]; });
  const auto own = order.begin() + out.mechanism;
  std::sort(order.begin(), own);
  std::sort(own, order.end());
  const double level = rounded * largest_magnitude_of(all.values);
  for (const Index k : order) out.squares.push_back(std::abs(all.values[k]) <= level ? 0.0 : all.values[k]);
  out.vectors = X(Eigen::all, order);
  if (out.mechanism == 0) return out;

  // The mechanism by itself, with what it draws along.
  const MatrixXd N1 = out.vectors.rightCols(X.cols() - out.mechanism);
  MatrixXd drawn = N0;
  if (N1.cols() > 0) {
    const MatrixXd B = N1 - N0 * product(N0.transpose(), at.mass, N1);
    DenseLu K11;
    K11.compute(symmetric(congruent(K, B)));
    drawn -= B * K11.solve(product(B.transpose(), at.geometric, N0));
  }
  // drawn^T K drawn without the round-off of N_0^T elastic, which is zero.
  const MatrixXd stretched = drawn - N0,
                 small = congruent(at.geometric, drawn) + congruent(at.elastic, stretched);
  const MatrixXd to_unit =
      Cholesky(congruent(at.mass, drawn)).solve_lower(MatrixXd::Identity(out.mechanism, out.mechanism));
  const SymmetricEigen own_motions =
      symmetric_eigen(symmetric(product(to_unit, symmetric(small), to_unit.transpose())));
  const double lowest = N1.cols() > 0 ? out.squares[static_cast<std::size_t>(out.mechanism)].real()
                                      : std::numeric_limits<double>::infinity();
  if (!(largest_magnitude_of(own_motions.values) < far_below * lowest)) return out;
  const VectorXd pulls = symmetric_eigenvalues(symmetric(congruent(at.geometric, Z)));
  const double zero = nothing * std::max(at.pull, largest_magnitude_of(pulls));
  out.vectors.leftCols(out.mechanism) = product(drawn, to_unit.transpose(), own_motions.vectors);
  // A spring on what the motion does not change cancels in it, but for the rounding of its terms.
  constexpr double digits = 64 * std::numeric_limits<double>::epsilon();
  const MatrixXd terms = at.geometric.cwiseAbs();
  for (Index k = 0; k < out.mechanism; ++k) {
    const double square = own_motions.values[k];
    const VectorXd way = out.vectors.col(k).cwiseAbs();
    const bool none = std::abs(square) <= std::max(zero, digits * way.dot(terms * way));
    out.squares[static_cast<std::size_t>(k)] = none ? 0.0 : square;
  }
  return out;
}

}  // namespace

double Vibration::lowest_elastic() const {
  return static_cast<std::size_t>(mechanism_motions) < modes.size()
             ? modes[static_cast<std::size_t>(mechanism_motions)].frequency
             : std::numeric_limits<double>::quiet_NaN();
}

namespace {

Vibration vibration_of(const Model& model, const State& pose, const VectorXd& known) {
  const AtPose at(model, pose, known);
  const Solved solved = solve(at);
  Vibration out;
  out.mechanism_motions = solved.mechanism;
  out.t = pose.t;
  out.unique = at.unique;
  VectorXd v(model.system.coordinates());
  for (std::size_t k = 0; k < solved.squares.size(); ++k) {
    VibrationMode mode;
    const std::complex<double> rate = std::sqrt(-solved.squares[k]);  // x ~ exp(rate t); not below 0
    mode.growth = rate.real();
    mode.frequency = std::abs(rate.imag()) / (2 * pi);
    mode.mechanism = static_cast<Index>(k) < solved.mechanism;
    model.system.expand_rate(solved.vectors.col(static_cast<Index>(k)), v);
    mode.shape = whole_velocities(model.structure, v);
    double largest = 0;
    for (Index i = 0; i < mode.shape.size(); i += 3)
      largest = std::max(largest, mode.shape.segment<3>(i).norm());
    if (largest > 0) mode.shape /= largest;
    out.modes.push_back(std::move(mode));
  }
  return out;
}

// Of the mechanism that is left where rods that give are rigid, with the self-stress that they have and what
// the loads make of their forces at rest: at the start of a run they do not bear these yet.
Vibration vibration_of_giving(const Model& model, const State& pose) {
  const System& system = model.system;
  VectorXd q(system.coordinates());
  system.expand(pose.z, q);
  VectorXd known = VectorXd::Constant(static_cast<Index>(model.structure.rods.size()),
                                      std::numeric_limits<double>::quiet_NaN());
  for (const int r : system.giving_rods()) {
    const Rod& rod = model.structure.rods[static_cast<std::size_t>(r)];
    const double length = (q.segment<3>(3 * rod.b) - q.segment<3>(3 * rod.a)).norm();
    known[r] = (length - rod.rest_length(pose.t)) / rod.compliance();  // at rest, whatever warms
  }
  Structure rods = rigid_twin(model.structure, q);
  System rows(rods, system.eliminated());
  const Model twin{std::move(rods), std::move(rows)};
  State at{.t = pose.t, .z = twin.system.reduce(q), .w = {}, .lambda = {}};
  at.w.setZero(at.z.size());
  at.angles = pose.angles;
  return vibration_of(twin, at, known);
}

}  // namespace

Vibration vibration(const Model& model, const State& pose) {
  return model.system.giving_rods().empty() ? vibration_of(model, pose, {})
                                            : vibration_of_giving(model, pose);
}

}  // namespace unfurl
