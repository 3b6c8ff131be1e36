// SPDX-License-Identifier: BSD-3-Clause
#include "core/constraints/linear_rows.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/math/interleaved.hpp"

namespace unfurl {
namespace {

struct Row {
  std::string name;
  int source;  // index in Structure::constraints
  std::vector<int> coordinates;
  std::vector<double> coefficients;
  double value;
  double length;
};

class LinearRows final : public ConstraintBlock {
 public:
  explicit LinearRows(std::vector<Row> rows) : rows_(std::move(rows)) {}
  int rows() const override { return static_cast<int>(rows_.size()); }
  bool linear() const override { return true; }
  std::string name(int row) const override { return rows_[static_cast<std::size_t>(row)].name; }
  int source(int row) const override { return rows_[static_cast<std::size_t>(row)].source; }
  double length(int row) const override { return rows_[static_cast<std::size_t>(row)].length; }
  std::vector<int> stencil(int row) const override {
    return rows_[static_cast<std::size_t>(row)].coordinates;
  }

  void value(const double* q, double* phi) const override {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      double sum = -rows_[r].value;
      for (std::size_t i = 0; i < rows_[r].coordinates.size(); ++i)
        sum += rows_[r].coefficients[i] * q[rows_[r].coordinates[i]];
      phi[r] = sum;
    }
  }
  void jacobian(const double*, double* g) const override {
    for (const Row& row : rows_) g = std::copy(row.coefficients.begin(), row.coefficients.end(), g);
  }
  void add_force(const double*, const double* lambda, double scale, double* f) const override {
    for (std::size_t r = 0; r < rows_.size(); ++r)
      for (std::size_t i = 0; i < rows_[r].coordinates.size(); ++i)
        f[rows_[r].coordinates[i]] += scale * lambda[r] * rows_[r].coefficients[i];
  }
  bool values(int poses, const double* q, Index stride, double* phi) const override {
    with_wide_columns(poses, [=, this](auto k) { values_of<k()>(q, stride, phi); });
    return true;
  }
  bool add_forces(int poses, const double*, Index, const double* lambda, const double* scale,
                  double* f) const override {
    with_wide_columns(poses, [=, this](auto k) { add_forces_of<k()>(lambda, scale, f); });
    return true;
  }
  void bias(const double*, const double*, double* phi_dd) const override {
    std::fill_n(phi_dd, rows_.size(), 0.0);
  }
  void curvature(const double*, const double*, double* hess) const override {
    for (const Row& row : rows_)
      hess = std::fill_n(hess, row.coordinates.size() * row.coordinates.size(), 0.0);
  }

 private:
  template <LaneCount K>
  void values_of(const double* q, Index stride, double* phi) const {
    for (const Row& row : rows_) {
      Lanes<K> sum = Lanes<K>::all(-row.value);
      for (std::size_t i = 0; i < row.coordinates.size(); ++i)
        sum = sum + row.coefficients[i] * Lanes<K>(q + row.coordinates[i] * stride);
      sum.store(phi);
      phi += K;
    }
  }
  template <LaneCount K>
  void add_forces_of(const double* lambda, const double* scale, double* f) const {
    for (const Row& row : rows_) {
      const Lanes<K> pull = Lanes<K>(scale) * Lanes<K>(lambda);
      for (std::size_t i = 0; i < row.coordinates.size(); ++i) {
        double* const to = f + static_cast<Index>(row.coordinates[i]) * K;
        (Lanes<K>(to) + row.coefficients[i] * pull).store(to);
      }
      lambda += K;
    }
  }

  std::vector<Row> rows_;
};

void append(Row& row, int node, const Vec3& direction) {
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0.0) continue;
    row.coordinates.push_back(3 * node + k);
    row.coefficients.push_back(direction[k]);
  }
}

template <class MakeRows>
std::unique_ptr<ConstraintBlock> block_of(const Structure& structure, std::string_view kind,
                                          MakeRows make_rows) {
  std::vector<Row> rows;
  const double length = reference_length(structure);
  for (std::size_t i = 0; i < structure.constraints.size(); ++i) {
    if (structure.constraints[i].kind != kind) continue;
    const std::size_t before = rows.size();
    make_rows(structure.constraints[i], length, rows);
    for (std::size_t r = before; r < rows.size(); ++r) rows[r].source = static_cast<int>(i);
  }
  if (rows.empty()) return nullptr;
  return std::make_unique<LinearRows>(std::move(rows));
}

// One row that holds x . direction at its value at t = 0.
Row held(const Structure& structure, const Constraint& c, const Vec3& direction, double length,
         const char* suffix) {
  Row row{c.name + suffix,
          -1,
          {},
          {},
          direction.dot(structure.nodes[static_cast<std::size_t>(c.nodes[0])].position),
          length};
  append(row, c.nodes[0], direction);
  return row;
}

}  // namespace

double reference_length(const Structure& structure) {
  double sum = 0, extent = 0;
  for (const Rod& rod : structure.rods) sum += rod.length;
  if (!structure.rods.empty()) return sum / static_cast<double>(structure.rods.size());
  for (const Node& node : structure.nodes) {
    if (node.ghost) break;  // they come last, and are nowhere
    extent = std::max(extent, (node.position - structure.nodes[0].position).norm());
  }
  return extent > 0 ? extent : 1.0;
}

std::unique_ptr<ConstraintBlock> plane_block(const Structure& structure) {
  return block_of(structure, "plane", [](const Constraint& c, double length, std::vector<Row>& rows) {
    Row row{c.name, -1, {}, {}, c.value, length};
    append(row, c.nodes[0], c.vectors[0]);
    rows.push_back(std::move(row));
  });
}

std::unique_ptr<ConstraintBlock> line_block(const Structure& structure) {
  return block_of(structure, "line", [&](const Constraint& c, double length, std::vector<Row>& rows) {
    const Vec3 along = c.vectors[0].normalized();
    Index axis;
    along.cwiseAbs().minCoeff(&axis);
    const Vec3 first = along.cross(Vec3::Unit(axis)).normalized();
    rows.push_back(held(structure, c, first, length, " (first direction)"));
    rows.push_back(held(structure, c, along.cross(first), length, " (second direction)"));
  });
}

std::unique_ptr<ConstraintBlock> fixed_block(const Structure& structure) {
  return block_of(structure, "fixed", [&](const Constraint& c, double length, std::vector<Row>& rows) {
    rows.push_back(held(structure, c, Vec3::UnitX(), length, " x"));
    rows.push_back(held(structure, c, Vec3::UnitY(), length, " y"));
    rows.push_back(held(structure, c, Vec3::UnitZ(), length, " z"));
  });
}

std::unique_ptr<ConstraintBlock> relation_block(const Structure& structure) {
  return block_of(structure, "relation", [](const Constraint& c, double length, std::vector<Row>& rows) {
    double longest = 0;
    for (const Vec3& vector : c.vectors) longest = std::max(longest, vector.stableNorm());
    const double scale = longest > 0 ? longest : 1.0;
    Row row{c.name, -1, {}, {}, c.value / scale, length};
    for (std::size_t i = 0; i < c.nodes.size(); ++i) append(row, c.nodes[i], c.vectors[i] / scale);
    rows.push_back(std::move(row));
  });
}

std::unique_ptr<ConstraintBlock> linear_rows_of(std::span<const ConstraintBlock* const> blocks,
                                                std::span<const int> picked, Index coordinates) {
  const VectorXd zero = VectorXd::Zero(coordinates);
  std::vector<Row> rows;
  int first = 0;
  std::size_t next = 0;
  for (const ConstraintBlock* block : blocks) {
    VectorXd at_zero(block->rows());
    block->value(zero.data(), at_zero.data());
    std::vector<std::vector<int>> stencils;
    std::size_t entries = 0;
    for (int r = 0; r < block->rows(); ++r) entries += stencils.emplace_back(block->stencil(r)).size();
    std::vector<double> coefficients(entries);
    block->jacobian(zero.data(), coefficients.data());
    auto from = coefficients.begin();
    for (int r = 0; r < block->rows(); ++r) {
      const auto& stencil = stencils[static_cast<std::size_t>(r)];
      const auto to = from + static_cast<std::ptrdiff_t>(stencil.size());
      if (next < picked.size() && picked[next] == first + r) {
        rows.push_back(
            {block->name(r), block->source(r), stencil, {from, to}, -at_zero[r], block->length(r)});
        ++next;
      }
      from = to;
    }
    first += block->rows();
  }
  return std::make_unique<LinearRows>(std::move(rows));
}

}  // namespace unfurl
