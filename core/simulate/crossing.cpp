// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unfurl {
namespace {

constexpr double close_enough = 0.01;  // of what counts as zero
constexpr double at_once = 1e-6;       // share of the step
constexpr int most_trials = 60;

class CrossingSearch {
 public:
  CrossingSearch(const Probe& from, const Probe& to, const Solve& solve)
      : from_(from), high_(to), whole_(to.at), solve_(solve) {}

  // The end of the search moves to a pose inside the step where a margin that dips is below zero, in the
  // first of its dips where it is.
  void look_between(const MatrixXd& between) {
    const Probe to = high_;
    for (Index i = 0; i < to.margins.size(); ++i)
      for (const Index bottom : may_dip(between, to, i))
        if (look_at_bottom(i, bottom, between, to)) break;
  }

  std::optional<Crossing> search() {
    std::vector<Index> crossed = below(high_);
    if (crossed.empty()) return std::nullopt;
    for (Index tries = from_.margins.size(); !crossed.empty() && tries >= 0; --tries) {
      last_crossed_ = crossed;
      const Index i = earliest(crossed);
      Probe low;
      if (!room_before(i, low)) return crossing_at_start(i);
      if (!close_in(i, low)) break;
      crossed = below(high_);
    }
    Crossing out{high_, {}};
    for (const Index i : last_crossed_)
      if (std::abs(high_.margins[i]) <= 1 || i == chosen_) out.which.push_back(static_cast<std::size_t>(i));
    return out;
  }

 private:
  static std::vector<Index> below(const Probe& p) {
    std::vector<Index> out;
    for (Index i = 0; i < p.margins.size(); ++i)
      if (p.margins[i] < -1) out.push_back(i);
    return out;
  }

  // A step that cannot be solved lies behind the crossing, as far as one can tell.
  void solve(double at, Index i, Probe& probe) {
    if (solve_(at, probe)) return;
    probe.at = at;
    probe.margins = high_.margins;
    probe.margins[i] = std::min(-2.0, high_.margins[i]);
    probe.rates = VectorXd::Constant(probe.margins.size(), std::numeric_limits<double>::quiet_NaN());
  }

  // The parts of the step around which margin i has a least value that comes near zero. By the rates at the
  // ends, too: -1 and the number of parts are the step's start and end.
  std::vector<Index> may_dip(const MatrixXd& between, const Probe& to, Index i) const {
    std::vector<Index> known, out;
    double most = to.margins[i];
    for (Index k = 0; k < between.cols(); ++k) {
      if (!std::isfinite(between(i, k))) continue;
      known.push_back(k);
      most = std::max(most, between(i, k));
    }
    if (known.empty()) return out;
    const double start = from_.margins[i], end = to.margins[i];
    const auto near_zero = [most](double bottom) { return bottom < 0.1 * most; };
    const bool falls = start > 1 ? from_.rates[i] < 0 : from_.rates[i] * whole_ < -1;  // the latter at once
    if (falls && start <= between(i, known.front()) && near_zero(start)) out.push_back(-1);
    for (std::size_t j = 0; j < known.size(); ++j) {
      const Index k = known[j];
      const double bottom = between(i, k);
      if (!near_zero(bottom)) continue;
      if (j > 0 ? !(bottom < between(i, known[j - 1])) : k == 0 && !(bottom < start)) continue;
      if (j + 1 < known.size() ? bottom <= between(i, known[j + 1]) : bottom < end) out.push_back(k);
    }
    if (end > 1 && to.rates[i] > 0 && end <= between(i, known.back()) && near_zero(end))
      out.push_back(between.cols());
    return out;
  }

  // Around the part that looked lowest, until a solved state is below zero or none can be. True in the former
  // case.
  bool look_at_bottom(Index i, Index part, const MatrixXd& between, const Probe& to) {
    const double width = to.at / static_cast<double>(between.cols() + 1);
    const double middle = width * static_cast<double>(part + 1);
    Probe a = from_, b = to;
    if (part >= 0) solve(middle - (part > 0 ? 1.0 : 0.9) * width, i, a);
    if (part < between.cols()) solve(std::min(middle + width, to.at), i, b);
    const bool rates = std::isfinite(a.rates[i]) && std::isfinite(b.rates[i]);
    return (rates ? bottom_by_rates(i, a, b) : bottom_by_values(i, a, b)) || take(i, a) || take(i, b);
  }

  // True where the search ends, at a margin below zero.
  bool take(Index i, const Probe& p) {
    if (!(p.margins[i] < -1)) return false;
    if (p.at < high_.at) high_ = p;
    return true;
  }

  // Zero of the rate by regula falsi (Illinois). With the curvature c that both ends tell, no margin falls
  // below m - r^2 / 2c by much.
  bool bottom_by_rates(Index i, Probe a, Probe b) {
    double ra = a.rates[i], rb = b.rates[i];
    Probe p;
    for (int k = 0; k < most_trials && ra < 0 && rb > 0 && b.at - a.at > 1e-9 * whole_; ++k) {
      const double curvature = (b.rates[i] - a.rates[i]) / (b.at - a.at);
      solve((a.at * rb - b.at * ra) / (rb - ra), i, p);
      const double r = p.rates[i];
      if (take(i, p)) return true;
      if (!std::isfinite(r)) return bottom_by_values(i, a, b);
      if (p.margins[i] - r * r / curvature > 1) break;
      if (r < 0) {
        a = p, ra = r, rb *= 0.5;
      } else {
        b = p, rb = r, ra *= 0.5;
      }
    }
    return false;
  }

  bool bottom_by_values(Index i, const Probe& from, const Probe& to) {
    constexpr double golden = 0.381966011250105;
    double a = from.at, b = to.at;
    Probe p, q;
    solve(a + golden * (b - a), i, p);
    solve(b - golden * (b - a), i, q);
    while (b - a > 1e-3 * whole_) {
      if (take(i, p) || take(i, q)) return true;
      const bool left = p.margins[i] < q.margins[i];
      (left ? b : a) = left ? q.at : p.at;
      std::swap(p, q);
      left ? solve(a + golden * (b - a), i, p) : solve(b - golden * (b - a), i, q);
    }
    return false;
  }

  // Where the cubic of values and rates at both ends (a straight line where rates are not known) is zero, as
  // a share of the way from low to high; low is above zero, high below.
  static double guess(const Probe& low, const Probe& high, Index i) {
    const double h = high.at - low.at, a = low.margins[i], b = high.margins[i];
    const double ra = h * low.rates[i], rb = h * high.rates[i];
    if (!std::isfinite(ra) || !std::isfinite(rb)) return a / (a - b);
    double left = 0, right = 1;
    for (int k = 0; k < 30; ++k) {
      const double u = 0.5 * (left + right), v = 1 - u;
      const double f = v * v * (1 + 2 * u) * a + u * v * v * ra + u * u * (3 - 2 * u) * b - u * u * v * rb;
      (f > 0 ? left : right) = u;
    }
    return 0.5 * (left + right);
  }

  Index earliest(const std::vector<Index>& crossed) const {
    Index first = crossed.front();
    double least = std::numeric_limits<double>::infinity();
    for (const Index i : crossed) {
      const double u = from_.margins[i] <= 1 ? 0.0 : guess(from_, high_, i);
      if (u < least) least = u, first = i;
    }
    return first;
  }

  // A solved state before the crossing of margin i; false where it is passed at once.
  bool room_before(Index i, Probe& low) {
    low = from_;
    if (from_.margins[i] > 1) return true;
    const double rate = from_.rates[i];
    if (std::isfinite(rate) && rate * whole_ < -1) return false;
    double at = 0.125 * high_.at;
    // Top of the parabola through both values and the rate: a throw that comes down again.
    if (std::isfinite(rate) && rate > 0)
      if (const double top =
              high_.at * rate * high_.at / (2 * (rate * high_.at + from_.margins[i] - high_.margins[i]));
          top > at_once * whole_)
        at = top;
    for (; at > at_once * whole_; at *= 0.125) {
      solve(at, i, low);
      if (low.margins[i] > 0) return true;
      high_ = low;
    }
    return false;
  }

  // Brings high_ to the crossing of margin i.
  bool close_in(Index i, Probe low) {
    chosen_ = i;
    double weight_low = 1, weight_high = 1;
    double share = guess(low, high_, i);
    Probe middle;
    for (int k = 0; k < most_trials; ++k) {
      const double width = high_.at - low.at;
      if (!(width > 1e-15 * whole_)) break;
      solve(low.at + std::clamp(share, 1e-12, 1 - 1e-12) * width, i, middle);
      const double m = middle.margins[i];
      const bool is_low = m > 0;
      (is_low ? weight_high : weight_low) *= is_low == was_low_ && k > 0 ? 0.5 : 1.0;
      (is_low ? weight_low : weight_high) = 1;
      was_low_ = is_low;
      const double newton = middle.at - m / middle.rates[i];
      (is_low ? low : high_) = middle;
      if (std::abs(m) <= close_enough) return high_ = middle, true;
      const double a = weight_low * low.margins[i], b = weight_high * high_.margins[i];
      share = newton > low.at && newton < high_.at ? (newton - low.at) / (high_.at - low.at) : a / (a - b);
    }
    if (low.at == from_.at) return false;
    high_ = low;
    return true;
  }

  Crossing crossing_at_start(Index i) const {
    Crossing out{from_, {}};
    for (const Index j : last_crossed_)
      if (j == i || (from_.margins[j] <= 1 && high_.margins[j] <= 0 && !(from_.rates[j] * whole_ > 1)))
        out.which.push_back(static_cast<std::size_t>(j));
    return out;
  }

  const Probe& from_;
  Probe high_;  // behind the crossing
  double whole_;
  const Solve& solve_;
  std::vector<Index> last_crossed_;
  Index chosen_ = -1;
  bool was_low_ = false;
};

}  // namespace

std::optional<Crossing> first_crossing(const Probe& from, const Probe& to, const MatrixXd& between,
                                       const Solve& solve) {
  CrossingSearch search(from, to, solve);
  search.look_between(between);
  return search.search();
}

}  // namespace unfurl
