// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/quadrature.hpp"

#include <cmath>
#include <stdexcept>

namespace unfurl {
namespace {

struct Legendre {
  long double value;       // P_n(x)
  long double derivative;  // P_n'(x)
  long double previous;    // P_{n-1}(x)
};

// Three-term recurrence (k+1) P_{k+1} = (2k+1) x P_k - k P_{k-1}; derivative from (x^2-1) P_n' = n (x P_n -
// P_{n-1}).
Legendre legendre(int n, long double x) {
  long double p0 = 1, p1 = x;
  for (int k = 1; k < n; ++k) {
    const long double p2 = ((2 * k + 1) * x * p1 - k * p0) / (k + 1);
    p0 = p1;
    p1 = p2;
  }
  return {p1, n * (x * p1 - p0) / (x * x - 1), p0};
}

}  // namespace

Quadrature gauss_legendre(int n) {
  if (n < 1) throw std::invalid_argument("gauss_legendre: at least one point");
  Quadrature rule{VectorXd(n), VectorXd(n)};
  for (int i = 0; i < n; ++i) {
    long double x = -std::cos(static_cast<long double>(pi) * (i + 0.75L) / (n + 0.5L));
    if (2 * i + 1 == n) x = 0;
    for (int it = 0; it < 8 && n > 1; ++it) {
      const Legendre p = legendre(n, x);
      x -= p.value / p.derivative;
    }
    const long double d = n == 1 ? 1 : legendre(n, x).derivative;
    rule.nodes[i] = static_cast<double>((1 + x) / 2);
    rule.weights[i] = static_cast<double>(1 / ((1 - x * x) * d * d));
  }
  return rule;
}

Quadrature gauss_lobatto(int n) {
  if (n < 2) throw std::invalid_argument("gauss_lobatto: at least two points");
  Quadrature rule{VectorXd(n), VectorXd(n)};
  const int m = n - 1;  // interior nodes: zeros of P_m'
  for (int i = 0; i < n; ++i) {
    long double x = -std::cos(static_cast<long double>(pi) * i / m);
    if (i == 0) x = -1;
    if (i == m) x = 1;
    if (2 * i == m) x = 0;
    if (i > 0 && i < m) {
      for (int it = 0; it < 12; ++it) {  // Newton on P_m'; P_m'' from Legendre's equation
        const Legendre p = legendre(m, x);
        const long double second = (2 * x * p.derivative - m * (m + 1) * p.value) / (1 - x * x);
        x -= p.derivative / second;
      }
    }
    const long double value = (i == 0) ? (m % 2 ? -1 : 1) : (i == m) ? 1 : legendre(m, x).value;
    rule.nodes[i] = static_cast<double>((1 + x) / 2);
    rule.weights[i] = static_cast<double>(1 / (m * (m + 1) * value * value));
  }
  return rule;
}

Quadrature gauss_between(const std::vector<double>& points, double from, double to) {
  static const Quadrature gauss = gauss_legendre(3);
  std::vector<double> ends = points;
  ends.insert(ends.begin(), from);
  ends.push_back(to);
  const auto parts = static_cast<Index>(ends.size()) - 1;
  Quadrature out{VectorXd(3 * parts), VectorXd(3 * parts)};
  for (Index i = 0; i < parts; ++i) {
    const double begin = ends[static_cast<std::size_t>(i)];
    const double share = (ends[static_cast<std::size_t>(i) + 1] - begin) / (to - from);
    out.nodes.segment<3>(3 * i) = ((begin - from) / (to - from) + share * gauss.nodes.array()).matrix();
    out.weights.segment<3>(3 * i) = share * gauss.weights;
  }
  return out;
}

}  // namespace unfurl
