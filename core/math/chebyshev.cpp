// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/chebyshev.hpp"

#include <cmath>
#include <map>
#include <mutex>

namespace unfurl {

VectorXd chebyshev_points(int n) {
  VectorXd x(n + 1);
  for (int k = 0; k <= n; ++k) x[k] = std::sin(0.5 * pi * (2 * k - n) / n);  // odd about 0 to the last bit
  return x;
}

const MatrixXd& chebyshev_transform(int n) {
  static std::mutex mutex;
  static std::map<int, MatrixXd> made;
  const std::lock_guard lock(mutex);
  MatrixXd& T = made[n];
  if (T.size() > 0) return T;
  T.resize(n + 1, n + 1);
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) {
      const double ends = (i == 0 || i == n ? 0.5 : 1.0) * (k == 0 || k == n ? 0.5 : 1.0);
      // The angle of point i is pi (n - i) / n; whole turns are taken out of k (n - i) exactly.
      T(i, k) = 2.0 / n * ends * std::cos(pi * static_cast<double>((k * (n - i)) % (2 * n)) / n);
    }
  return T;
}

double chebyshev_value(const double* c, Index size, double x) {
  double b1 = 0, b2 = 0;
  for (Index k = size - 1; k > 0; --k) {
    const double b = c[k] + 2 * x * b1 - b2;
    b2 = b1;
    b1 = b;
  }
  return c[0] + x * b1 - b2;
}

ValueAndSlope chebyshev_value_and_slope(const double* c, Index size, double x) {
  double b1 = 0, b2 = 0, d1 = 0, d2 = 0;
  for (Index k = size - 1; k > 0; --k) {
    const double d = 2 * b1 + 2 * x * d1 - d2;
    d2 = d1;
    d1 = d;
    const double b = c[k] + 2 * x * b1 - b2;
    b2 = b1;
    b1 = b;
  }
  return {c[0] + x * b1 - b2, b1 + x * d1 - d2};
}

double chebyshev_divided_difference(const double* c, Index size, double x, double y) {
  double b1 = 0, b2 = 0, d1 = 0, d2 = 0;  // b at y
  for (Index k = size - 1; k > 0; --k) {
    const double d = 2 * b1 + 2 * x * d1 - d2;
    d2 = d1;
    d1 = d;
    const double b = c[k] + 2 * y * b1 - b2;
    b2 = b1;
    b1 = b;
  }
  return b1 + x * d1 - d2;
}

void chebyshev_value(const MatrixXd& c, double x, MutVec out) {
  const Index size = c.cols();
  double t0 = 1, t1 = x;
  out = c.col(0);
  for (Index k = 1; k < size; ++k) {
    out += t1 * c.col(k);
    const double t2 = 2 * x * t1 - t0;
    t0 = t1;
    t1 = t2;
  }
}

VectorXd chebyshev_integral(const VectorXd& c) {
  const Index n = c.size();
  const auto at = [&](Index k) { return k < n ? c[k] : 0.0; };
  VectorXd P = VectorXd::Zero(n + 1);
  if (n > 0) P[1] = at(0) - 0.5 * at(2);
  for (Index k = 2; k <= n; ++k) P[k] = (at(k - 1) - at(k + 1)) / (2.0 * static_cast<double>(k));
  for (Index k = 1; k <= n; ++k) P[0] -= (k % 2 ? -1.0 : 1.0) * P[k];
  return P;
}

}  // namespace unfurl
