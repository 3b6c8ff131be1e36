// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/scalar_motion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/math/quadrature.hpp"

namespace unfurl {
namespace {

constexpr int n = ScalarStep::points;
using Matrix = Eigen::Matrix<double, n, n>;
using Vector = Eigen::Matrix<double, n, 1>;

// Tails of s'' that count as nothing: as a share of its largest value, and of what it is the sum of.
constexpr double step_resolved = 1e-13, step_round_off = 2e-15;
// What rounding of the place and of the speed leaves in s'', in its coefficients over a step, as a share.
constexpr double rounded = 2e-15;
constexpr int most_iterations = 14, most_tries = 200;
constexpr double shortest = 1e-15;  // step, as a share of the time

// Legendre polynomials on [0, 1] at x with their first and second integrals from 0.
void legendre(double x, double* p, double* first, double* second) {
  std::array<double, n + 3> P{};
  const double u = 2 * x - 1;
  P[0] = 1;
  P[1] = u;
  for (int k = 1; k < n + 2; ++k)
    P[static_cast<std::size_t>(k) + 1] =
        ((2 * k + 1) * u * P[static_cast<std::size_t>(k)] - k * P[static_cast<std::size_t>(k) - 1]) / (k + 1);
  // integral of P_k = (P_{k+1} - P_{k-1}) / (2 (2k + 1)), with P_{-1} = -1 for k = 0
  const auto integral = [&](int k) {
    return (P[static_cast<std::size_t>(k) + 1] - (k == 0 ? -1.0 : P[static_cast<std::size_t>(k) - 1])) /
           (2 * (2 * k + 1));
  };
  for (int k = 0; k < n; ++k) {
    if (p) p[k] = P[static_cast<std::size_t>(k)];
    first[k] = integral(k);
    second[k] = k == 0 ? 0.5 * x * x : (integral(k + 1) - integral(k - 1)) / (2 * (2 * k + 1));
  }
}

struct Rule {
  Vector node;
  Matrix A, AA;    // values of s'' at the points to its first and second integrals there
  Matrix project;  // to its Legendre coefficients
};

Rule make_rule() {
  const Quadrature gauss = gauss_legendre(n);
  Rule rule;
  rule.node = gauss.nodes;
  Matrix first, second;
  for (int i = 0; i < n; ++i) {
    std::array<double, n> p{}, I{}, II{};
    legendre(gauss.nodes[i], p.data(), I.data(), II.data());
    for (int k = 0; k < n; ++k) {
      rule.project(k, i) = (2 * k + 1) * gauss.weights[i] * p[static_cast<std::size_t>(k)];
      first(i, k) = I[static_cast<std::size_t>(k)];
      second(i, k) = II[static_cast<std::size_t>(k)];
    }
  }
  rule.A = first * rule.project;
  rule.AA = second * rule.project;
  return rule;
}

const Rule& rule() {
  static const Rule made = make_rule();
  return made;
}

struct Stages {
  Vector k = Vector::Zero();
  double scale = 0, noise = 0;
  int iterations = 0;
};

// Newton's method for k = Q(s0 + h c v0 + h^2 AA k, v0 + h A k); its matrix is made anew where it gains less
// than a digit.
bool solve_stages(const ScalarLaw& law, double t, double s, double v, double h, Stages& stages) {
  const Rule& r = rule();
  Eigen::PartialPivLU<Matrix> lu;
  bool have = false;
  double last = std::numeric_limits<double>::infinity();
  const ScalarLaw::Value start = law.at(s, v, t);
  stages.k.setConstant(start.Q);
  for (int it = 0; it < most_iterations; ++it) {
    ++stages.iterations;
    const Vector place = h * h * (r.AA * stages.k), speed = h * (r.A * stages.k);
    Vector residual, by_s, by_v;
    stages.scale = stages.noise = 0;
    for (int i = 0; i < n; ++i) {
      const ScalarLaw::Value q = law.at(s + h * r.node[i] * v + place[i], v + speed[i], t + h * r.node[i]);
      residual[i] = stages.k[i] - q.Q;
      by_s[i] = q.by_s;
      by_v[i] = q.by_v;
      stages.scale = std::max(stages.scale, q.scale);
      const double from_place = std::abs(q.by_s * (s + h * r.node[i] * v + place[i]));
      const double from_speed = std::abs(q.by_v * (v + speed[i]));
      stages.noise = std::max(stages.noise, q.noise + rounded * (from_place + from_speed));
    }
    const double size = residual.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    if (!std::isfinite(size)) return false;
    const double left = std::max(1e-14 * stages.scale, stages.noise);  // with Newton at its end
    if (size <= 4e-16 * stages.scale || (size <= left && size > 0.3 * last)) return true;
    if (size > 2 * last && it > 4) return false;
    if (!have || size > 0.1 * last) {
      lu.compute(Matrix::Identity() - by_s.asDiagonal() * (h * h * r.AA) - by_v.asDiagonal() * (h * r.A));
      have = true;
    }
    stages.k -= lu.solve(residual);
    last = size;
  }
  return last <= std::max(1e-13 * stages.scale, stages.noise);
}

}  // namespace

void ScalarStep::at(double t, double& s, double& v) const {
  std::array<double, n> I{}, II{};
  const double x = (t - t0) / h;
  legendre(x, nullptr, I.data(), II.data());
  double first = 0, second = 0;
  for (std::size_t k = points; k-- > 0;) {
    first += c[k] * I[k];
    second += c[k] * II[k];
  }
  s = s0 + h * (x * v0 + h * second);
  v = v0 + h * first;
}

bool scalar_step(const ScalarLaw& law, double t, double s, double v, double latest, double& h,
                 ScalarStep& step) {
  for (int i = 0; i < most_tries; ++i) {
    const bool last = t + 1.01 * h >= latest;
    const double length = last ? latest - t : h;
    if (!(length > shortest * std::abs(t)) || !(length > 0)) return false;
    Stages stages;
    if (!solve_stages(law, t, s, v, length, stages)) {
      h = 0.4 * length;
      continue;
    }
    const Vector c = rule().project * stages.k;
    const double left = std::max(std::abs(c[n - 1]), 0.1 * std::abs(c[n - 2]));
    const double allowed = std::max(
        {step_resolved * stages.k.cwiseAbs().maxCoeff(), step_round_off * stages.scale, stages.noise});
    const double factor = left > 0 ? 0.85 * std::pow(allowed / left, 1.0 / n) : 3.0;
    if (left > allowed) {
      h = length * std::clamp(factor, 0.2, 0.8);
      continue;
    }
    step.t0 = t;
    step.h = length;
    step.s0 = s;
    step.v0 = v;
    for (int k = 0; k < n; ++k) step.c[static_cast<std::size_t>(k)] = c[k];
    step.iterations = stages.iterations;
    // A last step is as long as what was left: it says nothing of the length that could have been.
    const double next = length * std::clamp(factor, 0.5, 3.0);
    h = last ? std::max(h, next) : next;
    return true;
  }
  return false;
}

}  // namespace unfurl
