// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/row_dependence.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "core/math/factors.hpp"
#include "core/math/linear_elimination.hpp"
#include "core/structure/node_positions.hpp"
#include "core/system/mobility.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/sparse_rows.hpp"

using namespace unfurl;

namespace row_dependence_test {

// A row follows from those before it where it does not raise their rank, by dense factors of all of them.
TEST_CASE("rows that follow from those before them are those that do not raise the rank") {
  unsigned state = 3u;
  const auto dice = [&state](int sides) {
    state = state * 1664525u + 1013904223u;
    return static_cast<int>((state >> 8) % static_cast<unsigned>(sides));
  };
  int found = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const int columns = 5 + dice(25), rows = 5 + dice(40);
    MatrixXd A = MatrixXd::Zero(rows, columns);
    for (int r = 0; r < rows; ++r) {
      for (int k = dice(4); k >= 0; --k) A(r, dice(columns)) = dice(5) - 2;
      if (r > 2 && dice(3) == 0) A.row(r) = 3 * A.row(dice(r)) - A.row(dice(r)) + 0.5 * A.row(dice(r));
    }
    std::vector<int> follow;
    for (int r = 0; r < rows; ++r)
      if (rank_of(A.topRows(r + 1)) == (r > 0 ? rank_of(A.topRows(r)) : 0)) follow.push_back(r);
    INFO(trial << ": " << rows << " x " << columns);
    const RowDependence ours = dependence_of_rows(testing::sparse_rows(A), 1e-11);
    CHECK(ours.rows == follow);
    CHECK(ours.least > 1e-4);  // small integers: far from doubt
    found += static_cast<int>(follow.size());
  }
  CHECK(found > 100);  // or nothing was tried
}

TEST_CASE("what of a row nearly follows from others is told by its size") {
  MatrixXd A(3, 3);
  A << 1, 2, 0, 0, 1, 1, 1, 3, 1 + 3e-7;
  const RowDependence ours = dependence_of_rows(testing::sparse_rows(A), 1e-11);
  CHECK(ours.rows.empty());
  CHECK(ours.least == Approx(1e-7).epsilon(1e-6));  // 3e-7 of 3, with rounding of 1e-16 / 1e-7
  CHECK(dependence_of_rows(testing::sparse_rows(A), 1e-6).rows == std::vector<int>{2});
}

// Lazy tongs in a plane, every bar a rod with a node in its middle: one way to move, in which all nodes take
// part. Written kind by kind, so that bars are joined only when all of one kind are solved. A row holds some
// ten of 726 coordinates when it is solved (27 where coordinates are those that the most rows hold).
TEST_CASE("few entries of each row are needed to find those of lazy tongs that depend on others") {
  const auto rows_of = [](int cells) {
    const std::string n = std::to_string(cells);
    std::string text = "[variables]\nn = " + n + "\n[structure]\nkind = 'custom'\nnodes = [\n";
    for (const char* const node : {"A", "B"})
      text += std::string("{repeat = {i = '0:n+1'}, name = '") + node + "{i}', position = ['=0.2*i', " +
              (*node == 'A' ? "0" : "1") + ", 0]},\n";
    text +=
        "{repeat = {i = '0:n'}, name = 'C{i}', position = ['=0.2*i+0.1', 0.5, 0], mass = 0.1}]\nrods = [\n";
    for (const char* const ends :
         {"'A{i}', 'B{i+1}'", "'B{i}', 'A{i+1}'", "'A{i}', 'C{i}'", "'B{i}', 'C{i}'"})
      text += std::string("{repeat = {i = '0:n'}, nodes = [") + ends + "], mass = 0.2},\n";
    text += "]\n[[constraints]]\nkind = 'plane'\nnodes = ['*']\nnormal = [0, 0, 1]\n";
    for (const char* const nodes : {"'A{i}', 'C{i}', 'B{i+1}'", "'B{i}', 'C{i}', 'A{i+1}'"})
      text +=
          std::string("[[constraints]]\nrepeat = {i = '0:n'}\nkind = 'collinear'\nnodes = [") + nodes + "]\n";
    const auto model = testing::model_of(text);
    const VectorXd q = node_positions(model->structure);
    return picked_rows(unit_rows(model->system, q), counted_rows(model->system, q));
  };
  constexpr int cells = 80;
  const SparseRows G = rows_of(cells);
  const RowDependence ours = dependence_of_rows(G, dependent_row);
  // 3 (3 n + 2) coordinates, 3 of a body in its plane and 1 of the tongs.
  CHECK(G.rows() - std::ssize(ours.rows) == 3 * (3 * cells + 2) - 4);
  CHECK(ours.rows == eliminate(G, VectorXd::Zero(G.rows()), dependent_row).redundant);
  CHECK(ours.entries < 16 * G.rows());
}

}  // namespace row_dependence_test
