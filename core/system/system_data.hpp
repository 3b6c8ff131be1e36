// SPDX-License-Identifier: BSD-3-Clause
// What a System holds; for its own sources only.
#pragma once

#include "core/forces/elastic_rods.hpp"
#include "core/forces/force.hpp"
#include "core/math/row_sums.hpp"
#include "core/structure/measure.hpp"
#include "core/system/system.hpp"

namespace unfurl {

using ConstraintBlocks = std::vector<const ConstraintBlock*>;

struct System::Data {
  std::vector<std::unique_ptr<ConstraintBlock>> owned;
  ConstraintBlocks all, kept, linear, leaving;      // leaving: linear ones, eliminated where that pays
  std::vector<std::unique_ptr<ForceBlock>> forces;  // those that depend on t, q or v
  VectorXd unloaded_force;                          // the sum of the others but the loads [N]
  VectorXd gravity_force;                           // its part, for energies
  SparseRows node_mass, mass, B, B_transposed;
  RowSums of_solved;  // B once more
  VectorXd q0, start;
  // z that q0 is at: zero unless the structure is far from the origin (size 0: zero). There q0 + B z would be
  // known to several times what rounding the coordinates leaves, and rows that depend on each other fit to
  // that.
  VectorXd origin;
  std::vector<int> free_coordinates, ghosts;
  std::vector<Index>
      integrators;  // solved coordinates that are integrals of controllers: they have no energy
  bool eliminated = false, rheonomic = false;
  Index coordinates = 0, rows = 0, linear_rows = 0;
  VectorXd lengths;
  std::vector<std::string> names;
  std::vector<int> rod_rows, constraint_rows, giving;
  const ElasticRods* elastic_rods = nullptr;  // among forces; nullptr: no rod gives
  std::vector<Drive> drives;
  std::vector<MeasureFunction> followed;  // angles that count turns
  // G_z: every entry is a sum of entries of the node Jacobian.
  SparseRows pattern;
  RowSums sums;
  std::vector<std::size_t> block_entries;  // entries of the node Jacobian of each kept block
  std::size_t entries = 0;
  std::vector<int> row_ends;  // of the kept rows, among those entries
  // Kept rows that the eliminated ones (and others of their own constraint) imply, to the digits that
  // positions are given with: they are no equations, their errors are what positions have.
  std::vector<int> implied;
  // The node Jacobian of all blocks, entry by entry: columns, where rows end, entries of each block.
  std::vector<int> all_columns;
  std::vector<std::size_t> all_row_ends, all_block_entries;

  // A derivative by node coordinates as one by the solved ones, of forces and of other rows.
  SparseRows reduced_forces(const ForceDerivative& entries) const;
  SparseRows reduced_rows(const ForceDerivative& entries, Index count) const;
  void build_blocks(const Structure& structure, bool eliminate_linear);
  void add_blocks(const Structure& structure, bool eliminate_linear);
  void build_coordinates();
  void move_origin();
  void keep_own_coefficients(std::vector<int>& these, double negligible, const std::vector<double>& there,
                             const std::vector<double>& here) const;
  void build_forces(const Structure& structure);
  void find_integrators(const Structure& structure);
  void build_jacobian_map();
  // Implied rows of G_z and those that are rounding alone, of entries of the node Jacobian that cancel,
  // become zero: rows are taken in units of their own size where they are solved for, and would hold what
  // they do not touch.
  void clear_rounding(const std::vector<double>& entries, SparseRows& G) const;
  void build_stencils();
  void find_constraint_rows(std::size_t constraints);
  void check_kinds(const Structure& structure) const;
  void check_mass(const Structure& structure) const;
};

}  // namespace unfurl
