// SPDX-License-Identifier: BSD-3-Clause
// What errors of rows are relative to, and rows that are picked from blocks.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/constraints/alignment.hpp"
#include "core/constraints/linear_rows.hpp"
#include "core/constraints/measure_rows.hpp"
#include "tests/support/table_structure.hpp"

using namespace unfurl;

namespace row_lengths_test {

namespace {

Measure length_of(int a, int b) {
  return {MeasureKind::length, {a, b}, Vec3::Zero(), 0.0, {}};
}

Measure angle_of(int a, int hinge, int b) {
  return {MeasureKind::angle, {hinge, a, hinge, b}, Vec3::Zero(), 0.0, {}};
}

double length_of_row(const Structure& from, const Measure& measure) {
  Structure s = from;
  s.constraints = {{"measure", "row", {}, {}, 0.0, measure, {}}};
  return measure_block(s)->length(0);
}

double length_of_row(const Structure& from, std::vector<MeasureTerm> terms) {
  return length_of_row(from, Measure{MeasureKind::combination, {}, Vec3::Zero(), 0.0, std::move(terms)});
}

double distance(const Structure& s, int a, int b) {
  return (s.nodes[static_cast<std::size_t>(b)].position - s.nodes[static_cast<std::size_t>(a)].position)
      .norm();
}

}  // namespace

// Of lengths the mean of all rods, of angles the shortest side of any, times the largest coefficient, where
// it is above one: a sum of lengths and angles has coefficients with units, which say nothing of its size.
TEST_CASE("rows of measures are as large as what they sum up") {
  const Structure s = testing::table_structure();  // rods of 1.5 and 2 m
  const double ab = distance(s, 0, 1), ac = distance(s, 0, 2), bd = distance(s, 1, 3), cd = distance(s, 2, 3);
  CHECK(length_of_row(s, length_of(0, 3)) == Approx(1.75));
  const double ad = distance(s, 0, 3), bc = distance(s, 1, 2);
  CHECK(length_of_row(s, {{2.6, length_of(0, 3)}, {-3.7, length_of(1, 2)}}) == Approx(2.6 * ad + 3.7 * bc));
  CHECK(length_of_row(s, {{-0.6, length_of(0, 3)}, {0.7, length_of(1, 2)}}) == Approx(0.6 * ad + 0.7 * bc));
  CHECK(length_of_row(s, {{-0.1, length_of(0, 3)}, {0.1, length_of(1, 2)}}) == Approx(1.75));
  CHECK(length_of_row(s, angle_of(1, 0, 2)) == Approx(std::min(ab, ac)));
  const double shortest = std::min({ab, ac, bd, cd});
  for (const auto& [one, two] :
       {std::pair(angle_of(1, 0, 2), angle_of(1, 3, 2)), std::pair(angle_of(1, 3, 2), angle_of(1, 0, 2))}) {
    CHECK(length_of_row(s, {{1.9, one}, {-4.2, two}}) == Approx(4.2 * shortest));
    CHECK(length_of_row(s, {{4.2, length_of(1, 2)}, {5.3, two}}) == Approx(1.75));
  }
}

// As far as the nodes are from the first one, or as the longest rod that ends at one of them.
TEST_CASE("rows of nodes that are folded up are as large as the rods at them") {
  Structure s;
  s.nodes = {{"a", {0.1, 0.2, 0.3}},
             {"b", {0.13, 0.2, 0.3}},
             {"c", {0.1, 0.26, 0.3}},
             {"d", {0.1, 0.2, 0.32}},
             {"e", {2.0, 1.0, 0.3}}};
  const auto length = [&] {
    s.constraints = {{"coplanar", "flat", {0, 1, 2, 3}, {}, 0.0}, {"collinear", "line", {0, 1, 2}, {}, 0.0}};
    CHECK(collinear_block(s)->length(2) == coplanar_block(s)->length(0));
    return coplanar_block(s)->length(0);
  };
  CHECK(length() == Approx(0.06));  // from a to c
  s.rods = {{"be", 1, 4, 1.0, 1.9, "rod", 0.01, 1.0},
            {"eb", 4, 1, 1.0, 2.3, "rod", 0.01, 1.0},
            {"ec", 4, 2, 1.0, 0.7, "rod", 0.01, 1.0}};
  CHECK(length() == Approx(2.3));
}

TEST_CASE("rows that are picked from blocks are those rows") {
  Structure s = testing::table_structure();
  const Vec3 n = Vec3(1, 2, 2) / 3;
  s.constraints = {{"plane", "plane", {0}, {n}, 0.25},
                   {"plane", "table", {2}, {Vec3(0.6, 0, 0.8)}, -0.7},
                   {"line", "line", {1}, {n}, 0.0},
                   {"relation", "relation", {0, 1, 2}, {Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, -1)}, 0.5},
                   {"relation", "other", {3, 1}, {Vec3(0.3, 0, 0.9), Vec3(-0.4, 0.5, 0)}, 1.3}};
  const auto planes = plane_block(s), lines = line_block(s), relations = relation_block(s);
  const std::vector<const ConstraintBlock*> blocks{planes.get(), lines.get(), relations.get()};
  const std::vector<int> picked{1, 2, 4};
  const std::vector<std::pair<const ConstraintBlock*, int>> wanted{
      {planes.get(), 1}, {lines.get(), 0}, {relations.get(), 0}};
  const auto rows = linear_rows_of(blocks, picked, 12);
  REQUIRE(rows->rows() == 3);
  CHECK(rows->linear());
  VectorXd q(12), found(3);
  for (Index i = 0; i < 12; ++i) q[i] = std::cos(0.3 + 1.9 * static_cast<double>(i));
  rows->value(q.data(), found.data());
  std::vector<double> entries(64), own(64);
  rows->jacobian(q.data(), entries.data());
  std::size_t at = 0;
  for (int r = 0; r < 3; ++r) {
    const auto& [block, row] = wanted[static_cast<std::size_t>(r)];
    INFO(block->name(row));
    CHECK(rows->name(r) == block->name(row));
    CHECK(rows->source(r) == block->source(row));
    CHECK(rows->length(r) == block->length(row));
    CHECK(rows->stencil(r) == block->stencil(row));
    VectorXd values(block->rows());
    block->value(q.data(), values.data());
    CHECK(found[r] == Approx(values[row]).epsilon(0).margin(1e-15));
    block->jacobian(q.data(), own.data());
    std::size_t first = 0;
    for (int before = 0; before < row; ++before) first += block->stencil(before).size();
    for (std::size_t e = 0; e < rows->stencil(r).size(); ++e) CHECK(entries[at++] == own[first + e]);
  }
}

}  // namespace row_lengths_test
