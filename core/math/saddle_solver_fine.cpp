// SPDX-License-Identifier: BSD-3-Clause
// The parts of SaddleSolver that work in twice the digits.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/math/saddle_solver.hpp"
#include "core/math/twofold_ldlt.hpp"

namespace unfurl {
namespace {

// e, and the pivot up to which a row counts as redundant: such rows have some e, thousands of them where many
// depend on each other, and the square of a singular value of 1e-11 where an error of 1e-14 in the
// constraints over a weak direction of 1e-3 tells them apart. Up to `may_be_e` it is asked what e makes of
// one.
constexpr double fine_regularisation = 1e-23, redundant_pivot = 1e-20, may_be_e = 1e-14;
// Pivots in doubles say something of a row where they are this many times e.
constexpr double clear_of_regularisation = 1000;

// Columns of right-hand sides: one, or two side by side.
void load(const double* from, Twofold& to) {
  to = *from;
}
void load(const double* from, TwofoldPair& to) {
  to = DoublePair{from[0], from[1]};
}
void store(const Twofold& from, double* to) {
  *to = static_cast<double>(from);
}
void store(const TwofoldPair& from, double* to) {
  const DoublePair sum = from.hi + from.lo;
  to[0] = sum[0];
  to[1] = sum[1];
}
Twofold scaled(const Twofold& x, double scale) {
  return x * scale;
}
TwofoldPair scaled(const TwofoldPair& x, double scale) {
  return x * TwofoldPair(DoublePair{scale, scale});
}

}  // namespace

// Vectors are in the safe order of elimination.
struct SaddleSolver::Fine {
  Fine(const SparseLdlt& pattern, std::size_t size)
      : factors(pattern), shift(size, 0.0), right(size), x(size), r(size) {}
  TwofoldLdlt factors;
  std::vector<double> shift;       // of the diagonal, from -e in doubles
  double e = fine_regularisation;  // what is left of it: that in doubles has its own last digit
  std::vector<Twofold> right, x, r;
  std::vector<TwofoldPair> rights, xs, rs;  // of two right-hand sides at once
  // Of the row at this place of the order, without what e makes of it: all of it where the row is redundant.
  double pivot_of_row(std::size_t place) const {
    constexpr double round_off = 1e-6;
    const double pivot = std::abs(factors.pivot(static_cast<Index>(place)));
    if (!(pivot >= redundant_pivot && pivot < may_be_e)) return pivot;
    const double left = pivot - e * factors.pivot_rate(place);
    return left < round_off * pivot ? 0.0 : left;
  }
  auto vectors(Twofold) { return std::tie(right, x, r); }
  auto vectors(TwofoldPair) {
    for (auto* v : {&rights, &xs, &rs}) v->resize(right.size());
    return std::tie(rights, xs, rs);
  }
};

void SaddleSolver::FineDelete::operator()(Fine* fine) const {
  delete fine;
}

double SaddleSolver::weakest_pivot(double bound) {
  if (in_use_ == sparse_.get() && !fine_ready_) {
    if (shows_none_below(bound)) return bound;
    if (!factorise_safely()) return 0.0;
  }
  Index below = 0;
  for (Index r = 0; r < m_; ++r) below += pivot_of_row(r) < bound + 2 * regularisation_ ? 1 : 0;
  if (below <= redundant_) return bound;
  if (!fine_ready_) {
    by_pivot_.resize(static_cast<std::size_t>(m_));
    std::iota(by_pivot_.begin(), by_pivot_.end(), Index{0});
    const auto next = by_pivot_.begin() + redundant_;
    std::ranges::nth_element(by_pivot_, next, {}, [this](Index r) { return pivot_of_row(r); });
    const double pivot = pivot_of_row(*next);
    if (pivot > clear_of_regularisation * regularisation_ &&
        pivot > 2 * regularisation_ * in_use_->ldlt.pivot_rate(place_of_row(*next, *in_use_)))
      return std::min(bound, pivot);
    if (!factorise_finely()) return 0.0;
    fine_ready_ = weakest_ <= clear_of_regularisation * regularisation_;
  }
  return std::min(bound, weakest_);
}

bool SaddleSolver::may_be_below(Index r, double bound) const {
  return pivot_of_row(r) < 2 * (bound + regularisation_) || growth_ * 2 * bound >= 1;
}

Index SaddleSolver::rows_below(double bound) const {
  Index below = 0;
  for (Index r = 0; r < m_; ++r) below += pivot_of_row(r) < 2 * (bound + regularisation_) ? 1 : 0;
  return below;
}

bool SaddleSolver::all_independent(double least) {
  constexpr double of_few_others = 10;  // times e
  return rows_below(of_few_others * regularisation_) == 0 && factorise_finely() && redundant_ == 0 &&
         weakest_ >= least;
}

Index SaddleSolver::rows_below_finely(double bound) {
  Index below = 0;
  if (!factorise_finely()) return below;
  for (Index r = 0; r < m_; ++r) below += fine_->pivot_of_row(place_of_row(r, safe_)) < bound ? 1 : 0;
  fine_ready_ = weakest_ <= clear_of_regularisation * regularisation_;
  return below;
}

std::vector<int> SaddleSolver::dependent_rows(double bound, const std::vector<int>& guess) {
  constexpr double may_depend = 1e-4;  // of a row, whose square is a pivot
  if (!factorise_finely()) return guess;
  std::vector<std::pair<double, int>> left;  // of a combination of rows of unit length
  for (Index r = 0; r < m_; ++r) {
    const std::size_t place = place_of_row(r, safe_);
    const double pivot = fine_->pivot_of_row(place);
    if (pivot < may_depend) left.emplace_back(pivot / fine_->factors.pivot_rate(place), static_cast<int>(r));
  }
  std::vector<double> shift(fine_->shift);
  for (Index r = 0; r < m_; ++r) shift[place_of_row(r, safe_)] = regularisation_ + bound * bound;
  if (!fine_->factors.factorise(values_.data(), shift.data())) return guess;
  Index below = -n_;  // as many pivots of the coordinates are positive
  for (Index k = 0; k < n_ + m_; ++k) below += fine_->factors.pivot(k) > 0 ? 1 : 0;
  fine_ready_ = false;
  const auto wanted = static_cast<std::size_t>(std::clamp(below, Index{0}, std::ssize(left)));
  if (wanted == guess.size()) return guess;
  std::ranges::sort(left);
  std::vector<int> rows;
  for (std::size_t k = 0; k < wanted; ++k) rows.push_back(left[k].second);
  std::ranges::sort(rows);
  return rows;
}

bool SaddleSolver::factorise_finely() {
  if (!fine_) {
    fine_.reset(new Fine(safe_.ldlt, static_cast<std::size_t>(n_ + m_)));
    for (Index r = 0; r < m_; ++r)
      fine_->shift[place_of_row(r, safe_)] = regularisation_ - fine_regularisation;
    fine_->e = regularisation_ - (regularisation_ - fine_regularisation);
  }
  fine_ready_ = fine_->factors.factorise(values_.data(), fine_->shift.data());
  redundant_ = 0;
  weakest_ = 1.0;
  for (Index r = 0; r < m_ && fine_ready_; ++r) {
    const double pivot = fine_->pivot_of_row(place_of_row(r, safe_));
    if (pivot < redundant_pivot)
      ++redundant_;
    else
      weakest_ = std::min(weakest_, pivot);
  }
  return fine_ready_;
}

double SaddleSolver::motion_of_error() const {
  return m_ == 0 ? 0.0 : row_scale_.maxCoeff() * column_scale_.maxCoeff();
}

// Solves twice: the second time for what the rows can reach, G x instead of g. The rest of g, round-off above
// all, would come back in the multipliers of redundant rows as (rest / e).
void SaddleSolver::apply_finely(double* f, double* g, int columns) const {
  Fine& fine = *fine_;
  const auto place = [this](Index i) {
    return static_cast<std::size_t>(safe_.place[static_cast<std::size_t>(i)]);
  };
  const auto apply = [&](int c, auto number) {
    auto [right, x, r] = fine.vectors(number);
    const auto take = [&, &to = right](const double* from, const VectorXd& scale, Index first) {
      for (Index i = 0; i < scale.size(); ++i) {
        load(from + i * columns + c, number);
        to[place(first + i)] = scaled(number, scale[i]);
      }
    };
    take(f, column_scale_, 0);
    take(g, row_scale_, n_);
    x = right;
    fine.factors.solve_ordered(x.data());
    number = {};
    for (Index i = 0; i < m_; ++i) x[place(n_ + i)] = number;
    std::fill(r.begin(), r.end(), number);
    fine.factors.subtract_product(values_.data(), x.data(), r.data());
    for (Index i = 0; i < m_; ++i) right[place(n_ + i)] = -r[place(n_ + i)];
    fine.factors.solve_ordered(right.data());
    const auto give = [&, &from = right](double* to, const VectorXd& scale, Index first) {
      for (Index i = 0; i < scale.size(); ++i)
        store(scaled(from[place(first + i)], scale[i]), to + i * columns + c);
    };
    give(f, column_scale_, 0);
    give(g, row_scale_, n_);
  };
  int c = 0;
  for (; c + 2 <= columns; c += 2) apply(c, TwofoldPair());
  if (c < columns) apply(c, Twofold());
}

// What e leaves of a weak direction, e / sigma^2 <= 1e-3, two refinements take below 1e-9; then the
// multipliers, as above, again and again: round-off d of redundant rows, a singular value, makes 3 d / e of
// multipliers that nothing determines, of which each time leaves 3 d^2 / e: 1e-8 of 1e7 where it is 1e-16,
// 1e-4 of 1e9 where many rows of a ring depend on each other and it is 2e-14.
// One pass leaves the motion right, whose rows are those that it can reach.
void SaddleSolver::solve_finely(const ConstVec& f, const ConstVec& g, MutVec x, MutVec y,
                                int most_passes) const {
  constexpr double settled = 1e-10;  // multipliers, of the largest
  Fine& fine = *fine_;
  const auto place = [this](Index i) {
    return static_cast<std::size_t>(safe_.place[static_cast<std::size_t>(i)]);
  };
  VectorXd before(m_);
  for (Index i = 0; i < n_; ++i) fine.right[place(i)] = Twofold(f[i]) * column_scale_[i];
  for (Index i = 0; i < m_; ++i) fine.right[place(n_ + i)] = Twofold(g[i]) * row_scale_[i];
  const auto residual = [&] {
    fine.r = fine.right;
    fine.factors.subtract_product(values_.data(), fine.x.data(), fine.r.data());
  };
  // Once where e is nothing beside the weakest direction, which leaves what round-off makes of redundant
  // rows.
  const int refinements = fine.e < 1e-9 * weakest_ ? 1 : 2;
  const auto refine = [&] {
    fine.x = fine.right;
    fine.factors.solve_ordered(fine.x.data());
    for (int pass = 0; pass < refinements; ++pass) {
      residual();
      for (Index i = 0; i < m_; ++i)
        fine.r[place(n_ + i)] = fine.r[place(n_ + i)] - Twofold(regularisation_) * fine.x[place(n_ + i)];
      fine.factors.solve_ordered(fine.r.data());
      for (std::size_t i = 0; i < fine.x.size(); ++i) fine.x[i] = fine.x[i] + fine.r[i];
    }
  };
  refine();
  double last = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < most_passes; ++pass) {
    for (Index i = 0; i < m_; ++i) before[i] = static_cast<double>(fine.x[place(n_ + i)]);
    for (Index i = 0; i < m_; ++i) fine.x[place(n_ + i)] = 0.0;
    residual();
    for (Index i = 0; i < m_; ++i)
      fine.right[place(n_ + i)] = fine.right[place(n_ + i)] - fine.r[place(n_ + i)];
    refine();
    double size = 0, change = 0;
    for (Index i = 0; i < m_; ++i) {
      const auto now = static_cast<double>(fine.x[place(n_ + i)]);
      size = std::max(size, std::abs(now));
      change = std::max(change, std::abs(now - before[i]));
    }
    // What is left falls as the change has fallen.
    if (pass > 0 && (change * (change / last) <= settled * size || !(change < 0.5 * last))) break;
    last = change;
  }
  for (Index i = 0; i < n_; ++i) x[i] = static_cast<double>(fine.x[place(i)] * column_scale_[i]);
  for (Index i = 0; i < m_; ++i) y[i] = static_cast<double>(fine.x[place(n_ + i)] * row_scale_[i]);
}

void SaddleSolver::solve_motion(const ConstVec& g, MutVec x) const {
  VectorXd y(m_);
  solve_finely(VectorXd::Zero(n_), g, x, y, 1);
}

}  // namespace unfurl
