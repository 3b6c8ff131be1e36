// SPDX-License-Identifier: BSD-3-Clause
#include "core/constraints/alignment.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "core/constraints/linear_rows.hpp"

namespace unfurl {
namespace {

using Vec9 = Eigen::Matrix<double, 9, 1>;

struct Entry {
  std::string name;
  int source;  // index in Structure::constraints
  std::vector<int> nodes;
  double length;  // l
};

// What the edges of an entry are at most: between its first node and the others at t = 0, or, where these are
// folded up then, the longest rod at one of its nodes. Phi in edges of l is known to what rounding the nodes
// leaves, whatever the size of the rest of the structure.
class OwnLengths {
 public:
  explicit OwnLengths(const Structure& structure) : s_(structure), longest_(structure.nodes.size(), 0.0) {
    for (const Rod& rod : s_.rods)
      for (const int end : {rod.a, rod.b}) {
        double& longest = longest_[static_cast<std::size_t>(end)];
        longest = std::max(longest, rod.length);
      }
  }
  double of(const std::vector<int>& nodes) const {
    const Vec3& first = s_.nodes[static_cast<std::size_t>(nodes[0])].position;
    double most = 0;
    for (const int node : nodes) {
      const auto i = static_cast<std::size_t>(node);
      most = std::max({most, longest_[i], (s_.nodes[i].position - first).norm()});
    }
    return most > 0 ? most : reference_length(s_);
  }

 private:
  const Structure& s_;
  std::vector<double> longest_;  // rod at each node; 0: none
};

Eigen::Map<const Vec3> at(const double* x, int node) {
  return Eigen::Map<const Vec3>(x + 3 * static_cast<Index>(node));
}

// The three numbers at x, to be written.
Eigen::Map<Vec3> three(double* x) {
  return Eigen::Map<Vec3>(x);
}

Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

std::vector<int> coordinates_of(const std::vector<int>& nodes) {
  std::vector<int> stencil;
  for (const int node : nodes)
    for (int k = 0; k < 3; ++k) stencil.push_back(3 * node + k);
  return stencil;
}

class Alignment : public ConstraintBlock {
 public:
  Alignment(const Structure& structure, std::string_view kind) {
    std::optional<OwnLengths> lengths;
    for (std::size_t i = 0; i < structure.constraints.size(); ++i)
      if (const Constraint& c = structure.constraints[i]; c.kind == kind) {
        if (!lengths) lengths.emplace(structure);
        entries_.push_back({c.name, static_cast<int>(i), c.nodes, lengths->of(c.nodes)});
      }
  }
  bool empty() const { return entries_.empty(); }
  bool linear() const override { return false; }

 protected:
  std::vector<Entry> entries_;
};

// With u = b - a, w = c - a: d(u x w) = du x w + u x dw; by a: -(d/du + d/dw). The cross product has no share
// along the line e, whatever the pose: one of the rows follows from the others. Off the line the derivatives
// would have one, of the size of the error: a third equation where there are two, which the stages of an
// explicit method would answer with accelerations of order one. So they are taken across the line,
// P = 1 - e e^T, and the rows have rank two everywhere; on the line nothing changes.
class Collinear final : public Alignment {
 public:
  using Alignment::Alignment;
  int rows() const override { return 3 * static_cast<int>(entries_.size()); }
  std::string name(int row) const override {
    return entries_[static_cast<std::size_t>(row / 3)].name + " " + "xyz"[row % 3];
  }
  int source(int row) const override { return entries_[static_cast<std::size_t>(row / 3)].source; }
  double length(int row) const override { return entries_[static_cast<std::size_t>(row / 3)].length; }
  std::vector<int> stencil(int row) const override {
    return coordinates_of(entries_[static_cast<std::size_t>(row / 3)].nodes);
  }
  // The row of the axis that is nearest to the line: e . (rows) = 0, with the largest coefficient.
  std::vector<int> implied_rows(const double* q) const override {
    std::vector<int> rows;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      Index nearest = 0;
      line_of(entries_[i], q).cwiseAbs().maxCoeff(&nearest);
      rows.push_back(static_cast<int>(3 * i) + static_cast<int>(nearest));
    }
    return rows;
  }
  void value(const double* q, double* phi) const override {
    for (const Entry& e : entries_) {
      three(phi) = edge(e, 1, q).cross(edge(e, 2, q)) / e.length;
      phi += 3;
    }
  }
  void jacobian(const double* q, double* g) const override {
    for (const Entry& e : entries_) {
      Eigen::Map<Eigen::Matrix<double, 3, 9, Eigen::RowMajor>> rows(g);
      const Mat3 P = across(e, q) / e.length;
      rows.middleCols<3>(3) = -P * cross_matrix(edge(e, 2, q));
      rows.middleCols<3>(6) = P * cross_matrix(edge(e, 1, q));
      rows.leftCols<3>() = -rows.middleCols<3>(3) - rows.middleCols<3>(6);
      g += 27;
    }
  }
  // lambda . (u x w): gradient w x lambda by u, lambda x u by w.
  void add_force(const double* q, const double* lambda, double scale, double* f) const override {
    for (const Entry& e : entries_) {
      const Vec3 l = scale / e.length * (across(e, q) * Eigen::Map<const Vec3>(lambda));
      const Vec3 by_u = edge(e, 2, q).cross(l), by_w = l.cross(edge(e, 1, q));
      Eigen::Map<Vec3>(f + 3 * static_cast<Index>(e.nodes[0])) -= by_u + by_w;
      Eigen::Map<Vec3>(f + 3 * static_cast<Index>(e.nodes[1])) += by_u;
      Eigen::Map<Vec3>(f + 3 * static_cast<Index>(e.nodes[2])) += by_w;
      lambda += 3;
    }
  }
  void bias(const double* q, const double* v, double* phi_dd) const override {
    for (const Entry& e : entries_) {
      three(phi_dd) = 2 / e.length * (across(e, q) * edge(e, 1, v).cross(edge(e, 2, v)));
      phi_dd += 3;
    }
  }
  // Row k of u x w: d^2/du dw = -[e_k]_x, spread over a, b, c. Of multipliers across the line.
  void curvature(const double* q, const double* lambda, double* hess) const override {
    for (std::size_t row = 0; row < 3 * entries_.size(); ++row) {
      const Entry& e = entries_[row / 3];
      const auto k = static_cast<Index>(row % 3);
      const double l = across(e, q).row(k).dot(Eigen::Map<const Vec3>(lambda + row - row % 3));
      const Mat3 B = -l / e.length * cross_matrix(Vec3::Unit(k));
      Eigen::Matrix<double, 9, 9> H;
      H << B + B.transpose(), -B.transpose(), -B, -B, Mat3::Zero(), B, -B.transpose(), B.transpose(),
          Mat3::Zero();
      hess = std::copy_n(H.data(), 81, hess);
    }
  }

 private:
  static Vec3 edge(const Entry& e, std::size_t k, const double* x) {
    return at(x, e.nodes[k]) - at(x, e.nodes[0]);
  }
  // Along it: the longer of u and w.
  static Vec3 line_of(const Entry& e, const double* q) {
    const Vec3 u = edge(e, 1, q), w = edge(e, 2, q);
    return u.squaredNorm() >= w.squaredNorm() ? u : w;
  }
  // P.
  static Mat3 across(const Entry& e, const double* q) {
    const Vec3 along = line_of(e, q);
    const double square = along.squaredNorm();
    if (!(square > 0)) return Mat3::Identity();
    return Mat3::Identity() - along * along.transpose() / square;
  }
};

// det(u, w, r) with u = b - a, w = c - a, r = d - a: gradients w x r, r x u, u x w.
class Coplanar final : public Alignment {
 public:
  using Alignment::Alignment;
  int rows() const override { return static_cast<int>(entries_.size()); }
  std::string name(int row) const override { return entries_[static_cast<std::size_t>(row)].name; }
  int source(int row) const override { return entries_[static_cast<std::size_t>(row)].source; }
  double length(int row) const override { return entries_[static_cast<std::size_t>(row)].length; }
  std::vector<int> stencil(int row) const override {
    return coordinates_of(entries_[static_cast<std::size_t>(row)].nodes);
  }
  void value(const double* q, double* phi) const override {
    for (const Entry& e : entries_) {
      const Mat3 edges = edges_of(e, q);
      *phi++ = edges.determinant() / (e.length * e.length);
    }
  }
  void jacobian(const double* q, double* g) const override {
    for (const Entry& e : entries_) {
      const Vec9 by_edges = gradient(e, q);
      std::copy(by_edges.begin(), by_edges.end(), g + 3);
      Eigen::Map<Vec3> first(g);
      first.setZero();
      for (int k = 1; k < 4; ++k) first -= Eigen::Map<Vec3>(g + 3 * k);
      g += 12;
    }
  }
  void add_force(const double* q, const double* lambda, double scale, double* f) const override {
    for (const Entry& e : entries_) {
      const Vec9 g = scale * *lambda++ * gradient(e, q);
      for (Index k = 0; k < 3; ++k) {
        Eigen::Map<Vec3>(f + 3 * static_cast<Index>(e.nodes[static_cast<std::size_t>(k + 1)])) +=
            g.segment<3>(3 * k);
        Eigen::Map<Vec3>(f + 3 * static_cast<Index>(e.nodes[0])) -= g.segment<3>(3 * k);
      }
    }
  }
  void bias(const double* q, const double* v, double* phi_dd) const override {
    for (const Entry& e : entries_) {
      const Mat3 x = edges_of(e, q), y = edges_of(e, v);
      double sum = 0;
      for (Index k = 0; k < 3; ++k) sum += x.col(k).dot(y.col((k + 1) % 3).cross(y.col((k + 2) % 3)));
      *phi_dd++ = 2 * sum / (e.length * e.length);
    }
  }
  void curvature(const double* q, const double* lambda, double* hess) const override {
    for (const Entry& e : entries_) {
      const Mat3 x = edges_of(e, q);
      Eigen::Matrix<double, 9, 9> H = Eigen::Matrix<double, 9, 9>::Zero();
      for (Index k = 0; k < 3; ++k) {  // gradient by edge k+1 of x_k . (x_{k+1} x x_{k+2})
        const Index i = (k + 1) % 3, j = (k + 2) % 3;
        H.block<3, 3>(3 * i, 3 * j) = -cross_matrix(x.col(k));
        H.block<3, 3>(3 * j, 3 * i) = cross_matrix(x.col(k));
      }
      H *= *lambda++ / (e.length * e.length);
      Eigen::Matrix<double, 9, 12> from_nodes = Eigen::Matrix<double, 9, 12>::Zero();
      for (Index k = 0; k < 3; ++k) {
        from_nodes.block<3, 3>(3 * k, 0) = -Mat3::Identity();
        from_nodes.block<3, 3>(3 * k, 3 * k + 3) = Mat3::Identity();
      }
      const Eigen::Matrix<double, 12, 9> rows = from_nodes.transpose().lazyProduct(H);
      const Eigen::Matrix<double, 12, 12> by_nodes = rows.lazyProduct(from_nodes);
      hess = std::copy_n(by_nodes.data(), 144, hess);
    }
  }

 private:
  static Mat3 edges_of(const Entry& e, const double* x) {
    Mat3 edges;
    for (Index k = 0; k < 3; ++k)
      edges.col(k) = at(x, e.nodes[static_cast<std::size_t>(k + 1)]) - at(x, e.nodes[0]);
    return edges;
  }
  static Vec9 gradient(const Entry& e, const double* q) {
    const Mat3 x = edges_of(e, q);
    Vec9 g;
    g << x.col(1).cross(x.col(2)), x.col(2).cross(x.col(0)), x.col(0).cross(x.col(1));
    return g / (e.length * e.length);
  }
};

template <class Block>
std::unique_ptr<ConstraintBlock> block_of(const Structure& structure, std::string_view kind) {
  auto block = std::make_unique<Block>(structure, kind);
  if (block->empty()) return nullptr;
  return block;
}

}  // namespace

std::unique_ptr<ConstraintBlock> collinear_block(const Structure& structure) {
  return block_of<Collinear>(structure, "collinear");
}

std::unique_ptr<ConstraintBlock> coplanar_block(const Structure& structure) {
  return block_of<Coplanar>(structure, "coplanar");
}

}  // namespace unfurl
