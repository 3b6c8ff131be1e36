// SPDX-License-Identifier: BSD-3-Clause
// B^T A B where A is asked for again and again, against dense products; the derivatives of forces found so,
// against those of one call.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "core/system/reduced_sum.hpp"
#include "core/system/system.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace reduced_sum_test {

namespace {

std::mt19937 random_bits(7);
double any() {
  return std::uniform_real_distribution<double>(-1, 1)(random_bits);
}
int one_of(Index count) {
  return std::uniform_int_distribution<int>(0, static_cast<int>(count) - 1)(random_bits);
}

// Rows of `length` entries; every fourth has one, every fifth none.
SparseRows spread(int rows, int columns, int length) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < (i % 5 == 4 ? 0 : i % 4 == 3 ? 1 : length); ++k)
      entries.emplace_back(i, (i + 3 * k) % columns, any());
  SparseRows B(rows, columns);
  B.setFromTriplets(entries.begin(), entries.end());
  return B;
}

// The sum of `entries`, and the same in dense matrices.
void compare(ReducedSum& sum, const SparseRows& B, const std::vector<Eigen::Triplet<double>>& entries) {
  ForceDerivative& given = sum.begin(B);
  CHECK(given.empty());
  given.insert(given.end(), entries.begin(), entries.end());
  MatrixXd A = MatrixXd::Zero(B.rows(), B.rows());
  for (const auto& entry : entries) A(entry.row(), entry.col()) += entry.value();
  const MatrixXd exact = MatrixXd(B).transpose() * A * MatrixXd(B);
  const MatrixXd found = sum.sum();
  REQUIRE(found.rows() == exact.rows());
  // Sums of a few hundred products of numbers below 1.
  CHECK((found - exact).cwiseAbs().maxCoeff() <= 1e-12);
}

}  // namespace

TEST_CASE("sums of entries that come again are those of matrices") {
  const int length = GENERATE(1, 3, 12);  // 12: by products of matrices
  const SparseRows B = spread(40, 30, length);
  ReducedSum sum;
  compare(sum, B, {});
  std::vector<Eigen::Triplet<double>> entries;
  for (int e = 0; e < 200; ++e) entries.emplace_back(one_of(40), one_of(12), any());
  compare(sum, B, entries);
  const Index places = sum.sum().nonZeros();
  CHECK(places > 0);
  for (auto& entry : entries) entry = {entry.row(), entry.col(), any()};
  compare(sum, B, entries);  // others at the same places
  CHECK(sum.sum().nonZeros() == places);
  for (auto& entry : entries) entry = {entry.row(), entry.col() + 20, any()};
  compare(sum, B, entries);  // as many at other places
  entries.resize(50);
  compare(sum, B, entries);  // some of them
  compare(sum, B, {});
}

// A cable that goes slack: what it adds is zero, at the places where it pulled.
TEST_CASE("derivatives of forces asked for at every step are those of one call") {
  const auto model = testing::model_of(R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1, 0.1, 0], mass = 2},
  {name = "B", position = [1.7, 0.9, 0.3], mass = 1}]
rods = [{nodes = ["O", "A"], mass = 0}]
[[forces]]
kind = "spring"
nodes = ["A", "B"]
stiffness = 80
damping = 3
[[forces]]
kind = "spring"
tension_only = true
nodes = ["O", "B"]
stiffness = 500
damping = 7
free_length = 1.9
[solver]
end_time = 1
)");
  const System& system = model->system;
  ForceDerivatives again;
  REQUIRE(system.coordinates() == 9);
  VectorXd q(9), v(9);
  std::vector<Index> places;
  for (const double far : {0.5, 1.0, 1.5, 0.7}) {
    q << 0, 0, 0, 1, 0.1, 0, far * 1.7, far * 0.9, far * 0.3;
    for (Index i = 0; i < v.size(); ++i) v[i] = any();
    SparseRows by_z, by_w;
    system.force_derivatives(0.0, q, v, by_z, by_w);
    system.force_derivatives(0.0, q, v, again);
    // Rounding of sums in another order; entries are up to 1e3.
    CHECK((MatrixXd(again.by_z.sum()) - MatrixXd(by_z)).cwiseAbs().maxCoeff() <= 1e-12 * 1e3);
    CHECK((MatrixXd(again.by_w.sum()) - MatrixXd(by_w)).cwiseAbs().maxCoeff() <= 1e-12 * 1e3);
    CHECK(MatrixXd(by_z).cwiseAbs().maxCoeff() > 1);
    places.push_back(again.by_z.sum().nonZeros());
  }
  CHECK(std::all_of(places.begin(), places.end(), [&](Index n) { return n == places.front(); }));
}

}  // namespace reduced_sum_test
