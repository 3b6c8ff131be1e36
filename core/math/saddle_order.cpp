// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/saddle_order.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cmath>

namespace unfurl {

std::vector<int> minimum_degree_order(const SparseRows& upper) {
  Eigen::SparseMatrix<double, Eigen::ColMajor, int> full = upper.selfadjointView<Eigen::Upper>();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  Eigen::AMDOrdering<int>()(full, inverse);  // inverse.indices()[k]: the row eliminated k-th
  return {inverse.indices().data(), inverse.indices().data() + inverse.indices().size()};
}

namespace {

using Lists = std::vector<std::vector<int>>;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// Constraints and the eliminated coordinates that they have for their own.
class Owners {
 public:
  Owners(Lists choices, std::size_t coordinates)
      : choices_(std::move(choices)), owner_(coordinates, -1), gone_(coordinates, 0), seen_(coordinates, 0) {}
  void eliminate(int coordinate) { gone_[at(coordinate)] = 1; }
  // Whether the constraint could be given one; others may have got another in exchange.
  bool serve(int constraint) {
    ++round_;
    return find(constraint, 0);
  }

 private:
  bool find(int constraint, int exchanges) {
    constexpr int most_exchanges = 8;
    for (const int c : choices_[at(constraint)]) {
      if (!gone_[at(c)] || seen_[at(c)] == round_) continue;
      seen_[at(c)] = round_;
      if (owner_[at(c)] >= 0 && (exchanges == most_exchanges || !find(owner_[at(c)], exchanges + 1)))
        continue;
      owner_[at(c)] = constraint;
      return true;
    }
    return false;
  }

  Lists choices_;           // of every constraint: coordinates
  std::vector<int> owner_;  // of every coordinate: constraint, or -1
  std::vector<char> gone_;
  std::vector<int> seen_;
  int round_ = 0;
};

// `minimum_degree`, with constraints moved behind a coordinate of their own or behind all.
std::vector<int> behind_coordinates(const std::vector<int>& minimum_degree, const Lists& acting,
                                    std::vector<int> open, Owners owners) {
  const int n = static_cast<int>(acting.size());
  std::vector<char> waiting(open.size(), 0);
  std::vector<int> order;
  order.reserve(minimum_degree.size());
  const auto try_constraint = [&](int c) {
    const bool served = owners.serve(c);
    waiting[at(c)] = !served && open[at(c)] > 0;
    if (!waiting[at(c)]) order.push_back(n + c);
  };
  for (const int row : minimum_degree) {
    if (row >= n) {
      try_constraint(row - n);
      continue;
    }
    order.push_back(row);
    owners.eliminate(row);
    for (const int c : acting[at(row)]) --open[at(c)];
    for (const int c : acting[at(row)])
      if (waiting[at(c)]) try_constraint(c);
  }
  return order;
}

}  // namespace

SaddleOrders saddle_orders(const SparseRows& upper, const SparseRows& G) {
  constexpr double share = 0.1;
  const auto n = static_cast<std::size_t>(G.cols()), m = static_cast<std::size_t>(G.rows());
  std::vector<int> open(m, 0);
  Lists acting(n), large(m);
  for (int r = 0; r < G.outerSize(); ++r) {
    double most = 0;
    for (SparseRows::InnerIterator it(G, r); it; ++it) most = std::max(most, std::abs(it.value()));
    for (SparseRows::InnerIterator it(G, r); it; ++it) {
      ++open[at(r)];
      acting[at(static_cast<int>(it.col()))].push_back(r);
      if (most > 0 && std::abs(it.value()) >= share * most)
        large[at(r)].push_back(static_cast<int>(it.col()));
    }
  }
  const std::vector<int> start = minimum_degree_order(upper);
  return {behind_coordinates(start, acting, open, Owners(Lists(m), n)),
          behind_coordinates(start, acting, open, Owners(large, n))};
}

}  // namespace unfurl
