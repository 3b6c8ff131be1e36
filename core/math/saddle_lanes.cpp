// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/saddle_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/interleaved.hpp"

namespace unfurl {
namespace {

constexpr int lane_count = SaddleLanes::lanes;
template <int width>
using LaneOf = Lanes<LaneCount(lane_count, width)>;

std::size_t at(std::size_t entry) {
  return entry * static_cast<std::size_t>(lane_count);
}

}  // namespace

SaddleLanes::SaddleLanes(const SaddleSolver& alone)
    : alone_(alone), ldlt_(alone.first().ldlt), place_(alone.first().place.data()) {
  const auto n = static_cast<std::size_t>(ldlt_.size());
  row_scale_.assign(at(static_cast<std::size_t>(alone.m_)), 1.0);
  for (const double value : alone.values_) values_.insert(values_.end(), lane_count, value);
  for (const int place : alone.jacobian_place_)
    std::fill_n(values_.begin() + static_cast<std::ptrdiff_t>(at(static_cast<std::size_t>(place))),
                lane_count, 0.0);
  l_.assign(at(ldlt_.row_index_.size()), 0.0);
  for (auto* x : {&pivot_, &inverse_pivot_, &work_, &packed_, &right_, &best_, &try_}) x->assign(at(n), 0.0);
  fill_.assign(n, 0);
}

void SaddleLanes::set(int lane, const SparseRows& G) {
  const int* start = G.outerIndexPtr();
  const int* column = G.innerIndexPtr();
  const double* from = G.valuePtr();
  const int* const place = alone_.jacobian_place_.data();
  double* const values = values_.data() + lane;
  for (int r = 0, rows = static_cast<int>(alone_.m_); r < rows; ++r) {
    double square = 0;
    for (int p = start[r]; p < start[r + 1]; ++p) {
      const double value = from[p] * alone_.column_scale_[column[p]];
      square += value * value;
      values[static_cast<Index>(place[p]) * lane_count] = value;
    }
    const double scale = square > 0 ? 1.0 / std::sqrt(square) : 1.0;
    row_scale_[at(static_cast<std::size_t>(r)) + static_cast<std::size_t>(lane)] = scale;
    for (int p = start[r]; p < start[r + 1]; ++p) values[static_cast<Index>(place[p]) * lane_count] *= scale;
  }
}

void SaddleLanes::factorise() {
  ok_.fill(true);
  std::copy(ldlt_.column_start_.begin(), ldlt_.column_start_.end() - 1, fill_.begin());
  with_widest([this](auto width) { eliminate<width()>(); });
}

// SparseLdlt::factorise.
template <int width>
void SaddleLanes::eliminate() {
  using Lane = LaneOf<width>;
  const SparseLdlt& a = ldlt_;
  const auto n = static_cast<std::size_t>(a.size());
  double* const y = work_.data();
  double* const l = l_.data();
  const int* const rows = a.row_index_.data();
  const Lane zero = Lane::all(0.0);
  for (std::size_t k = 0; k < n; ++k) {
    for (auto e = static_cast<std::size_t>(a.entry_start_[k]),
              end = static_cast<std::size_t>(a.entry_start_[k + 1]);
         e < end; ++e) {
      double* const to = y + at(static_cast<std::size_t>(a.entry_row_[e]));
      (Lane(to) + Lane(values_.data() + at(static_cast<std::size_t>(a.entry_source_[e])))).store(to);
    }
    const Lane own(y + at(k));
    Lane d = own;
    zero.store(y + at(k));
    for (auto r = static_cast<std::size_t>(a.reach_start_[k]),
              last = static_cast<std::size_t>(a.reach_start_[k + 1]);
         r < last; ++r) {
      const auto i = static_cast<std::size_t>(a.reach_[r]);
      const Lane yi(y + at(i));
      zero.store(y + at(i));
      const int end = fill_[i];
      for (int p = a.column_start_[i]; p < end; ++p) {
        double* const to = y + static_cast<Index>(rows[p]) * lane_count;
        (Lane(to) - Lane(l + static_cast<Index>(p) * lane_count) * yi).store(to);
      }
      const Lane lki = yi * Lane(inverse_pivot_.data() + at(i));
      d = d - lki * yi;
      lki.store(l + static_cast<Index>(end) * lane_count);
      ++fill_[i];
    }
    double before[lane_count], after[lane_count];
    own.store(before);
    d.store(after);
    settle_pivot(k, before, after);
  }
}

// Of a lane that breaks down nothing is used any more.
void SaddleLanes::settle_pivot(std::size_t k, const double* own, double* d) {
  for (std::size_t c = 0; c < lane_count; ++c) {
    if (own[c] < 0.0 && d[c] > 0.5 * own[c]) d[c] = own[c];  // only round-off is left of a redundant row
    if (d[c] == 0.0 || !std::isfinite(d[c]) || (alone_.sparse_ && SaddleSolver::grown(d[c]))) ok_[c] = false;
    pivot_[at(k) + c] = d[c];
    inverse_pivot_[at(k) + c] = 1.0 / d[c];
  }
}

void SaddleLanes::take(const std::vector<double>& from, int lane, double* to) {
  for (std::size_t i = 0, size = from.size() / lane_count; i < size; ++i)
    to[i] = from[at(i) + static_cast<std::size_t>(lane)];
}

bool SaddleLanes::shows_none_below(int lane, double bound, SaddleSolver& alone) const {
  if (!ok(lane)) return false;
  SaddleSolver::Factors& first = alone.sparse_ ? *alone.sparse_ : alone.safe_;
  alone.fine_ready_ = false;
  take(pivot_, lane, first.ldlt.pivot_.data());
  return (!alone.sparse_ || alone.first_serves(true)) && alone.shows_none_below(bound);
}

bool SaddleLanes::hand_over(int lane, SaddleSolver& alone) const {
  alone.fine_ready_ = false;
  take(row_scale_, lane, alone.row_scale_.data());
  take(values_, lane, alone.values_.data());
  SparseLdlt& to = alone.sparse_ ? alone.sparse_->ldlt : alone.safe_.ldlt;
  take(l_, lane, to.l_.data());
  take(pivot_, lane, to.pivot_.data());
  take(inverse_pivot_, lane, to.inverse_pivot_.data());
  return alone.sparse_ ? alone.first_serves(ok(lane)) : ok(lane);
}

template <int width>
void SaddleLanes::solve_ordered(double* const b) const {
  using Lane = LaneOf<width>;
  const SparseLdlt& a = ldlt_;
  const int n = static_cast<int>(a.size());
  const double* const l = l_.data();
  const int* const rows = a.row_index_.data();
  const int* const start = a.column_start_.data();
  for (int j = 0; j < n; ++j) {
    const Lane bj(b + j * lane_count);
    for (int p = start[j], end = start[j + 1]; p < end; ++p) {
      double* const to = b + static_cast<Index>(rows[p]) * lane_count;
      (Lane(to) - Lane(l + static_cast<Index>(p) * lane_count) * bj).store(to);
    }
  }
  for (int j = n - 1; j >= 0; --j) {
    Lane bj = Lane(inverse_pivot_.data() + j * lane_count) * Lane(b + j * lane_count);
    for (int p = start[j], end = start[j + 1]; p < end; ++p)
      bj = bj -
           Lane(l + static_cast<Index>(p) * lane_count) * Lane(b + static_cast<Index>(rows[p]) * lane_count);
    bj.store(b + j * lane_count);
  }
}

// r -= K_0 x, in the order of SparseLdlt::subtract_product and SaddleSolver::solve.
template <int width>
void SaddleLanes::subtract_product(const double* x, double* r) const {
  using Lane = LaneOf<width>;
  const SparseLdlt& a = ldlt_;
  for (int k = 0, n = static_cast<int>(a.size()); k < n; ++k) {
    const Lane xk(x + static_cast<Index>(k) * lane_count);
    Lane sum = Lane::all(0.0);
    for (auto e = static_cast<std::size_t>(a.entry_start_[static_cast<std::size_t>(k)]),
              end = static_cast<std::size_t>(a.entry_start_[static_cast<std::size_t>(k) + 1]);
         e < end; ++e) {
      const int row = a.entry_row_[e];
      const Lane value(values_.data() + at(static_cast<std::size_t>(a.entry_source_[e])));
      sum = sum + value * Lane(x + static_cast<Index>(row) * lane_count);
      double* const to = r + static_cast<Index>(row) * lane_count;
      if (row != k) (Lane(to) - value * xk).store(to);
    }
    double* const to = r + static_cast<Index>(k) * lane_count;
    (Lane(to) - sum).store(to);
  }
  const int* const row = place_ + alone_.n_;
  for (Index i = 0; i < alone_.m_; ++i) {
    double* const to = r + static_cast<Index>(row[i]) * lane_count;
    (Lane(to) - alone_.regularisation_ * Lane(x + static_cast<Index>(row[i]) * lane_count)).store(to);
  }
}

SaddleLanes::Norms SaddleLanes::residual_norms(const double* r) const {
  using Lane = LaneOf<2>;
  Lane f = Lane::all(0.0), g = f;
  const int* place = place_;
  const auto add = [&](Lane& sum, Index count) {
    for (Index i = 0; i < count; ++i, ++place) {
      const Lane x(r + static_cast<Index>(*place) * lane_count);
      sum = sum + x * x;
    }
  };
  add(f, alone_.n_);
  add(g, alone_.m_);
  Norms of_f, of_g;
  f.store(of_f.data());
  g.store(of_g.data());
  for (std::size_t c = 0; c < lane_count; ++c) of_f[c] = std::sqrt(of_f[c]) + std::sqrt(of_g[c]);
  return of_f;
}

SaddleLanes::Norms SaddleLanes::solve(const Vectors& f, const Vectors& g, Vectors& x, Vectors& y,
                                      int max_refinements) const {
  const Index n = alone_.n_, m = alone_.m_;
  const int* const coordinate = place_;
  const int* const row = coordinate + n;
  const auto entry = [](std::vector<double>& v, int i, std::size_t c) -> double& {
    return v[at(static_cast<std::size_t>(i)) + c];
  };
  const auto scale = [&](Index i, std::size_t c) { return row_scale_[at(static_cast<std::size_t>(i)) + c]; };
  for (std::size_t c = 0; c < lane_count; ++c) {
    for (Index i = 0; i < n; ++i)
      entry(right_, coordinate[i], c) = f[c].size() ? f[c][i] * alone_.column_scale_[i] : 0.0;
    for (Index i = 0; i < m; ++i) entry(right_, row[i], c) = g[c].size() ? g[c][i] * scale(i, c) : 0.0;
  }
  Norms size = residual_norms(right_.data()), best{};
  std::array<bool, lanes> active{};
  for (std::size_t c = 0; c < lane_count; ++c) {
    size[c] = std::max(size[c], 1e-300);
    best[c] = 2.0 * size[c];
    active[c] = ok_[c] && f[c].size() > 0 && std::isfinite(size[c]);
  }
  for (auto* v : {&best_, &try_}) std::fill(v->begin(), v->end(), 0.0);
  for (int it = 0; it <= max_refinements + 1; ++it) {
    std::copy(right_.begin(), right_.end(), packed_.begin());
    if (it > 0) with_widest([this](auto width) { subtract_product<width()>(try_.data(), packed_.data()); });
    const Norms residual = residual_norms(packed_.data());
    std::array<bool, lanes> better{};
    for (std::size_t c = 0; c < lane_count; ++c) {
      better[c] = active[c] = active[c] && residual[c] < best[c];
      if (!better[c]) continue;
      const bool slow = residual[c] > 0.5 * best[c];
      best[c] = residual[c];
      if (it > 0 && (slow || residual[c] <= 2e-16 * size[c])) active[c] = false;
    }
    for (std::size_t i = 0; i < try_.size(); i += lane_count)
      for (std::size_t c = 0; c < lane_count; ++c)
        if (better[c]) best_[i + c] = try_[i + c];
    if (std::none_of(active.begin(), active.end(), [](bool a) { return a; })) break;
    with_widest([this](auto width) { solve_ordered<width()>(packed_.data()); });
    for (std::size_t i = 0; i < try_.size(); ++i) try_[i] += packed_[i];
  }
  if (max_refinements < 0) best_ = try_;
  for (std::size_t c = 0; c < lane_count; ++c) {
    const bool known = f[c].size() > 0 && ok_[c] && std::isfinite(size[c]);
    x[c].setConstant(n, std::numeric_limits<double>::quiet_NaN());
    y[c].setConstant(m, std::numeric_limits<double>::quiet_NaN());
    for (Index i = 0; known && i < n; ++i) x[c][i] = entry(best_, coordinate[i], c) * alone_.column_scale_[i];
    for (Index i = 0; known && i < m; ++i) y[c][i] = entry(best_, row[i], c) * scale(i, c);
  }
  for (std::size_t c = 0; c < lane_count; ++c) best[c] /= size[c];
  return best;
}

}  // namespace unfurl
