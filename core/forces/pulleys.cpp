// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/pulleys.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace unfurl {
namespace {

// The gradient of a span's length is minus its direction at the node before it, and its direction behind.
Eigen::Map<const Vec3> span_direction(const double* gradient, Index first) {
  return Eigen::Map<const Vec3>(gradient + first + 3);
}

double slip_share(double x) {
  if (std::abs(x) >= 1) return x > 0 ? 1 : -1;
  const double y = x * x;
  return x * (35 + y * (-35 + y * (21 - 5 * y))) / 16;
}

double slip_slope(double x) {
  return std::abs(x) >= 1 ? 0 : 35.0 / 16 * std::pow(1 - x * x, 3);
}

}  // namespace

Pulleys::Pulleys(const Force& cable, const Deployment& deployment)
    : stencil_(MeasureFunction(cable.measure, deployment).stencil()),
      friction_(cable.kinetic),
      creep_(cable.holding) {
  Index first = 0;
  for (const MeasureTerm& term : cable.measure.terms) {
    MeasureFunction length(term.measure, deployment);
    const Index size = std::ssize(length.stencil());
    if (term.measure.kind == MeasureKind::length) spans_.push_back({std::move(length), first});
    first += size;
  }
}

std::vector<Pulleys::Pass> Pulleys::passes(const double* v, const double* gradient) const {
  std::vector<Pass> out(spans_.size());
  double running = 0;  // u of the pulley before the span
  std::vector<double> x(spans_.size());
  for (std::size_t i = spans_.size() - 1; i > 0; --i) {
    running -= spans_[i].length.rate(gradient + spans_[i].first, v);
    x[i] = running / creep_;
  }
  for (std::size_t i = 1; i < spans_.size(); ++i) {
    const Vec3 before = span_direction(gradient, spans_[i - 1].first),
               behind = span_direction(gradient, spans_[i].first);
    const double wrap = std::atan2(before.cross(behind).norm(), before.dot(behind)), share = slip_share(x[i]);
    out[i] = {out[i - 1].c * std::exp(-friction_ * wrap * share), wrap, share, slip_slope(x[i])};
  }
  return out;
}

void Pulleys::weigh(const double* v, double* gradient) const {
  const std::vector<Pass> along = passes(v, gradient);
  for (std::size_t i = 1; i < spans_.size(); ++i)
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(gradient + spans_[i].first) *= along[i].c;
}

// With the directions a before and b behind, e_a and e_b the unit vectors across them towards the other:
// dbeta = -e_a . da - e_b . db, and da = (1 - a a^T) (dx_1 - dx_0) / l.
void Pulleys::add_wrap(std::size_t i, const Pass& pass, const double* q, const double* gradient,
                       VectorXd& out) const {
  const Index before = spans_[i - 1].first, behind = spans_[i].first;
  const Vec3 a = span_direction(gradient, before), b = span_direction(gradient, behind);
  const double sine = a.cross(b).norm(), cosine = a.dot(b);
  if (!(sine > 0)) return;
  const Vec3 by_a = -friction_ * pass.share / (sine * spans_[i - 1].length.value(q)) * (b - cosine * a),
             by_b = -friction_ * pass.share / (sine * spans_[i].length.value(q)) * (a - cosine * b);
  out.segment<3>(before) -= by_a;
  out.segment<3>(before + 3) += by_a;
  out.segment<3>(behind) -= by_b;
  out.segment<3>(behind + 3) += by_b;
}

void Pulleys::derivatives(const double* q, const double* v, double tension, ForceDerivative& by_q,
                          ForceDerivative& by_v) const {
  const Index size = std::ssize(stencil_);
  VectorXd gradient = VectorXd::Zero(size), turned = gradient;  // the latter: Hess l_m v
  for (const Span& span : spans_) {
    span.length.value_and_gradient(q, gradient.data() + span.first);
    span.length.add_hessian_times(q, v, 1.0, turned.data() + span.first);
  }
  const std::vector<Pass> along = passes(v, gradient.data());
  // Of c_i / c_i: the part that all later spans have too, and what A_i adds for them, all entries at once.
  VectorXd wrap = VectorXd::Zero(size), c_q(size), c_v(size);
  std::vector<double> A(spans_.size(), 0.0);
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    spans_[i].length.add_hessian(q, -tension * along[i].c, by_q);
    if (i == 0) continue;
    A[i] = A[i - 1] + friction_ * along[i].wrap * along[i].slope / creep_;
    add_wrap(i, along[i], q, gradient.data(), wrap);
    c_q = -wrap;
    c_v.setZero();
    for (std::size_t m = 1; m < spans_.size(); ++m) {
      const Index first = spans_[m].first;
      // A of spans behind i is that of i.
      const double by_rate = A[std::min(i, m)];
      c_q.segment<6>(first) += by_rate * turned.segment<6>(first);
      c_v.segment<6>(first) = by_rate * gradient.segment<6>(first);
    }
    for (Index r = spans_[i].first; r < spans_[i].first + 6; ++r)
      for (Index k = 0; k < size; ++k) {
        const double scale = -tension * along[i].c * gradient[r];
        const int row = stencil_[static_cast<std::size_t>(r)], column = stencil_[static_cast<std::size_t>(k)];
        if (c_q[k] != 0.0) by_q.emplace_back(row, column, scale * c_q[k]);
        if (c_v[k] != 0.0) by_v.emplace_back(row, column, scale * c_v[k]);
      }
  }
}

}  // namespace unfurl
