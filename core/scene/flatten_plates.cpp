// SPDX-License-Identifier: BSD-3-Clause
// Files with few digits hold faces that are not quite flat. The nodes x are moved by the least sum of squares
// that puts those of every plate into one plane, by Gauss-Newton steps. A plate of n nodes has the plane of
// least squares with the normal N and the coordinates u, v in it; its heights h_i = N . (x_i - middle) are
// those of a plane where they are a sum of 1, u and v, so that with columns w_k that are orthonormal and
// normal to these three
//   r_k = sum_i w_ik h_i = 0,  dr_k / dx_i = w_ik N,  k = 1 ... n - 3.
// A step is dx = -J^T (J J^T)^-1 r. Rows that others say already make J J^T singular: a little is added to
// it.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/math/factors.hpp"
#include "core/scene/imported_shape.hpp"

namespace unfurl {

namespace {

constexpr double flat_already = 1e-9;  // height of a flat plate over its size, beside the round-off of x
constexpr double coordinate_round_off = 1e-15;  // of x over the largest coordinate
constexpr double flat_enough = 1e-3;            // of that
constexpr double most_moved = 0.05;  // of the sizes of the plates around: nearest flat is another shape
constexpr double added_to_diagonal = 1e-12;  // to the diagonal of J J^T, whose entries are 1
constexpr int most_rounds = 20;

struct PlateHeights {
  Vec3 normal;
  MatrixXd w;  // n x (n - 3)
  VectorXd r;
  double size = 0.0;  // [m]
  double off = 0.0;   // the largest height over that of a flat plate
};

PlateHeights heights_of(const ImportedShape& shape, const std::vector<int>& plate) {
  const auto n = static_cast<Index>(plate.size());
  Eigen::MatrixX3d x(n, 3);
  for (Index i = 0; i < n; ++i) x.row(i) = shape.at(plate[static_cast<std::size_t>(i)]).transpose();
  const double far = x.cwiseAbs().maxCoeff();
  x.rowwise() -= x.colwise().mean().eval();
  PlateHeights found;
  found.size = x.cwiseAbs().maxCoeff();
  x /= found.size;
  const MatrixXd axes = symmetric_eigen(x.transpose() * x).vectors;
  found.normal = axes.col(0);
  const VectorXd h = x * found.normal;
  Eigen::MatrixX3d plane(n, 3);
  plane.col(0).setOnes();
  plane.rightCols<2>() = x * axes.rightCols<2>();
  found.w = column_complement(plane, 0.0).rightCols(n - 3);
  found.r = found.size * (found.w.transpose() * h);
  found.off =
      found.size * h.lpNorm<Eigen::Infinity>() / (flat_already * found.size + coordinate_round_off * far);
  return found;
}

// The plates with more than three nodes, and that which is least flat for its size.
struct AllHeights {
  std::vector<PlateHeights> plates;
  std::vector<std::size_t> which;  // of the shape's plates
  std::size_t worst = 0;           // in `which`
  double worst_off = 0.0;
  std::size_t bent = 0;  // plates that are not flat already
  Index rows = 0;
};

AllHeights all_heights(const ImportedShape& shape) {
  AllHeights all;
  for (std::size_t p = 0; p < shape.plates.size(); ++p) {
    if (shape.plates[p].size() < 4) continue;
    all.plates.push_back(heights_of(shape, shape.plates[p]));
    all.which.push_back(p);
    const PlateHeights& plate = all.plates.back();
    all.rows += plate.r.size();
    all.bent += plate.off > 1.0 ? 1 : 0;
    if (plate.off <= all.worst_off) continue;
    all.worst = all.which.size() - 1;
    all.worst_off = plate.off;
  }
  return all;
}

// One step; false where it cannot be computed.
bool step_flatter(const AllHeights& all, const ImportedShape& shape, VectorXd& dx) {
  std::vector<Eigen::Triplet<double>> entries;
  VectorXd r(all.rows);
  Index row = 0;
  for (std::size_t p = 0; p < all.plates.size(); ++p) {
    const PlateHeights& plate = all.plates[p];
    const std::vector<int>& nodes = shape.plates[all.which[p]];
    r.segment(row, plate.r.size()) = plate.r;
    for (Index k = 0; k < plate.r.size(); ++k, ++row)
      for (std::size_t i = 0; i < nodes.size(); ++i)
        for (int c = 0; c < 3; ++c)
          entries.emplace_back(static_cast<int>(row), 3 * nodes[i] + c,
                               plate.w(static_cast<Index>(i), k) * plate.normal[c]);
  }
  SparseColumns jacobian(all.rows, dx.size());
  jacobian.setFromTriplets(entries.begin(), entries.end());
  SparseColumns normal = jacobian * SparseColumns(jacobian.transpose());
  for (Index k = 0; k < all.rows; ++k) normal.coeffRef(k, k) += added_to_diagonal;
  const SparseCholesky factors(normal);
  if (!factors.ok()) return false;
  dx = -(jacobian.transpose() * factors.solve(r));
  return dx.allFinite();
}

}  // namespace

void ImportedShape::flatten() {
  AllHeights all = all_heights(*this);
  const std::size_t bent = all.bent, first = all.plates.empty() ? 0 : all.which[all.worst];
  if (bent == 0) return;
  const std::vector<CustomNode> given = spec.nodes;
  VectorXd dx = VectorXd::Zero(3 * static_cast<Index>(given.size()));
  bool sound = true;
  for (int round = 0; round < most_rounds && sound && all.worst_off > flat_enough; ++round) {
    sound = step_flatter(all, *this, dx);
    for (std::size_t i = 0; sound && i < given.size(); ++i)
      spec.nodes[i].position += dx.segment<3>(3 * static_cast<Index>(i));
    const double before = all.worst_off;
    all = all_heights(*this);
    if (all.worst_off < 1.0 && all.worst_off > 0.5 * before) break;  // round-off
  }
  double moved = 0.0;
  bool far = false;
  for (std::size_t p = 0; p < all.plates.size(); ++p)
    for (const int node : plates[all.which[p]]) {
      const double way = (at(node) - given[static_cast<std::size_t>(node)].position).norm();
      moved = std::max(moved, way);
      far = far || !(way <= most_moved * all.plates[p].size);
    }
  if (!sound || !(all.worst_off <= 1.0) || far)
    plate_places_[first].fail(
        "its vertices are not in one plane, and no small moves put those of all faces into planes; give "
        "them with more digits, or split it into triangles");
  char text[120];
  std::snprintf(text, sizeof text,
                "%zu faces were not quite flat: vertices are moved, by up to %.2g m, into one plane for each",
                bent, moved);
  notes.emplace_back(text);
}

}  // namespace unfurl
