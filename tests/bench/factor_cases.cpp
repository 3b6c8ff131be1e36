// SPDX-License-Identifier: BSD-3-Clause
// Who factorises the saddle-point matrices of real models fastest: ours (L D L^T in a fixed order,
// constraints behind their coordinates), Eigen's SimplicialLDLT, SuiteSparse's KLU and CHOLMOD. The mix is
// that of a step with 4 stages: one factorisation, four solutions for three right-hand sides; patterns are
// analysed beforehand.
#include <cholmod.h>
#include <klu.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <functional>

#include "core/math/saddle_solver.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/contender.hpp"
#include "tests/support/models.hpp"

namespace unfurl::bench {
namespace {

using Columns = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
constexpr int right_hand_sides = 3, solutions = 4, repeats = 5;

// [M G^T; G -e I] with unit diagonal of M and unit rows of G, as SaddleSolver scales it.
Columns saddle_matrix(const System& system, const SparseRows& G) {
  const Index n = G.cols();
  VectorXd scale(n);
  for (Index i = 0; i < n; ++i) scale[i] = 1.0 / std::sqrt(system.mass().coeff(i, i));
  std::vector<Eigen::Triplet<double>> entries;
  for (int r = 0; r < n; ++r)
    for (SparseRows::InnerIterator it(system.mass(), r); it; ++it)
      entries.emplace_back(r, it.col(), it.value() * scale[r] * scale[it.col()]);
  for (int r = 0; r < G.outerSize(); ++r) {
    double square = 0;
    for (SparseRows::InnerIterator it(G, r); it; ++it) square += std::pow(it.value() * scale[it.col()], 2);
    for (SparseRows::InnerIterator it(G, r); it; ++it) {
      const double value = it.value() * scale[it.col()] / std::sqrt(square);
      entries.emplace_back(n + r, it.col(), value);
      entries.emplace_back(it.col(), n + r, value);
    }
    entries.emplace_back(n + r, n + r, -SaddleSolver::standard_regularisation);
  }
  Columns K(n + G.rows(), n + G.rows());
  K.setFromTriplets(entries.begin(), entries.end());
  K.makeCompressed();
  return K;
}

double seconds_of(const std::function<void()>& work) {
  double best = 1e300;
  for (int r = 0; r < repeats; ++r) {
    long count = 0;
    const double begin = cpu_seconds();
    do work(), ++count;
    while (cpu_seconds() - begin < 0.02);
    best = std::min(best, (cpu_seconds() - begin) / static_cast<double>(count));
  }
  return best;
}

double klu_seconds(Columns K, MatrixXd b) {
  klu_common common;
  klu_defaults(&common);
  const int size = static_cast<int>(K.rows());
  int *start = K.outerIndexPtr(), *row = K.innerIndexPtr();
  klu_symbolic* symbolic = klu_analyze(size, start, row, &common);
  klu_numeric* numeric = klu_factor(start, row, K.valuePtr(), symbolic, &common);
  const double seconds = seconds_of([&] {
    klu_refactor(start, row, K.valuePtr(), symbolic, numeric, &common);
    for (int i = 0; i < solutions; ++i) {
      MatrixXd x = b;
      klu_solve(symbolic, numeric, size, right_hand_sides, x.data(), &common);
    }
  });
  klu_free_numeric(&numeric, &common);
  klu_free_symbolic(&symbolic, &common);
  return seconds;
}

double cholmod_seconds(const Columns& K, MatrixXd b) {
  cholmod_common common;
  cholmod_start(&common);
  common.supernodal = CHOLMOD_SIMPLICIAL;  // the only one of its methods that takes indefinite matrices
  common.final_ll = 0;
  Columns upper = K.triangularView<Eigen::Upper>();
  cholmod_sparse A{};
  A.nrow = A.ncol = static_cast<std::size_t>(K.rows());
  A.nzmax = static_cast<std::size_t>(upper.nonZeros());
  A.p = upper.outerIndexPtr();
  A.i = upper.innerIndexPtr();
  A.x = upper.valuePtr();
  A.stype = 1;
  A.itype = CHOLMOD_INT;
  A.xtype = CHOLMOD_REAL;
  A.dtype = CHOLMOD_DOUBLE;
  A.sorted = A.packed = 1;
  cholmod_dense B{};
  B.nrow = B.d = A.nrow;
  B.ncol = right_hand_sides;
  B.nzmax = B.nrow * B.ncol;
  B.x = b.data();
  B.xtype = CHOLMOD_REAL;
  B.dtype = CHOLMOD_DOUBLE;
  cholmod_factor* L = cholmod_analyze(&A, &common);
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;
  const double seconds = seconds_of([&] {
    cholmod_factorize(&A, L, &common);
    for (int i = 0; i < solutions; ++i)
      cholmod_solve2(CHOLMOD_A, L, &B, nullptr, &x, nullptr, &y, &e, &common);
  });
  for (cholmod_dense** v : {&x, &y, &e}) cholmod_free_dense(v, &common);
  cholmod_free_factor(&L, &common);
  cholmod_finish(&common);
  return seconds;
}

double eigen_seconds(const Columns& K, const MatrixXd& b) {
  Eigen::SimplicialLDLT<Columns, Eigen::Upper> ldlt;
  ldlt.analyzePattern(K);
  return seconds_of([&] {
    ldlt.factorize(K);
    for (int i = 0; i < solutions; ++i) const MatrixXd x = ldlt.solve(b);
  });
}

double our_seconds(const System& system, const SparseRows& G) {
  SaddleSolver saddle(system.mass(), G, right_hand_sides);
  const auto columns = static_cast<std::size_t>(right_hand_sides);
  std::vector<double> f(columns * static_cast<std::size_t>(G.cols())),
      g(columns * static_cast<std::size_t>(G.rows()));
  return seconds_of([&] {
    if (!saddle.factorise(G)) throw std::runtime_error("the factorisation broke down");
    for (int i = 0; i < solutions; ++i) {
      std::fill(f.begin(), f.end(), 1.0);
      std::fill(g.begin(), g.end(), 1.0);
      saddle.apply(f.data(), g.data(), right_hand_sides);
    }
  });
}

void compare(Report& report, const std::string& name, const Structure& structure) {
  const auto model = testing::make_model(structure);
  const System& system = model->system;
  const State start = initial_state(model->structure, system).state;
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  VectorXd q(system.coordinates());
  system.expand(start.z, q);
  system.jacobian(q, G, scratch);
  const Columns K = saddle_matrix(system, G);
  const MatrixXd b = MatrixXd::Ones(K.rows(), right_hand_sides);
  const double ours = our_seconds(system, G);
  report.add({"factor", name + " (" + std::to_string(K.rows()) + " unknowns): ours", 1e6 * ours, "us", ""});
  report.add({"factor", name + ": Eigen SimplicialLDLT / ours", eigen_seconds(K, b) / ours, "ratio", ""});
  report.add({"factor", name + ": KLU / ours", klu_seconds(K, b) / ours, "ratio", ""});
  report.add({"factor", name + ": CHOLMOD / ours", cholmod_seconds(K, b) / ours, "ratio", ""});
}

}  // namespace

void factor_cases(Report& report) {
  report.begin("One factorisation and 4 solutions for 3 right-hand sides of [M G^T; G -e I]: CPU time");
  compare(report, "ring of 6 units", testing::hoop_structure());
  compare(report, "ring of 100 units", testing::hoop_structure({{"units", std::int64_t{100}}}));
  compare(report, "ladder of 40 windows", testing::ladder_structure(40, 30));
  compare(report, "chain of 1000 rods", chain_of_rods(1000));
}

}  // namespace unfurl::bench
