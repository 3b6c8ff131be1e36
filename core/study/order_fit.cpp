// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/order_fit.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace unfurl {
namespace {

// 97.5 % quantiles of Student's t for 1, 2, ... degrees of freedom; 1.96 beyond.
double quantile(std::size_t freedom) {
  constexpr std::array<double, 10> t{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
  return freedom <= t.size() ? t[freedom - 1] : 1.96;
}

}  // namespace

ObservedOrder fit_order(const std::vector<double>& step, const std::vector<double>& error) {
  const std::size_t n = step.size();
  ObservedOrder fit;
  fit.points = static_cast<int>(n);
  fit.order = fit.low = fit.high = std::numeric_limits<double>::quiet_NaN();
  if (n < 3) return fit;
  double mx = 0, my = 0, sxx = 0, sxy = 0, rest = 0;
  const auto count = static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) mx += std::log(step[i]) / count, my += std::log(error[i]) / count;
  for (std::size_t i = 0; i < n; ++i) {
    const double dx = std::log(step[i]) - mx;
    sxx += dx * dx;
    sxy += dx * (std::log(error[i]) - my);
  }
  fit.order = sxy / sxx;
  for (std::size_t i = 0; i < n; ++i) {
    const double r = std::log(error[i]) - my - fit.order * (std::log(step[i]) - mx);
    rest += r * r;
  }
  const double half = quantile(n - 2) * std::sqrt(rest / (count - 2) / sxx);
  fit.low = fit.order - half;
  fit.high = fit.order + half;
  return fit;
}

}  // namespace unfurl
