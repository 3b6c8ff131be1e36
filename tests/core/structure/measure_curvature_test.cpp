// SPDX-License-Identifier: BSD-3-Clause
// The second derivative of a measure along a straight line, by scalars, against v^T Hess v.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/structure/measure.hpp"

using namespace unfurl;

namespace measure_curvature_test {

namespace {

Measure of_nodes(MeasureKind kind, std::vector<int> nodes, Vec3 axis = Vec3::Zero()) {
  Measure m;
  m.kind = kind;
  m.nodes = std::move(nodes);
  m.axis = axis;
  return m;
}

std::vector<Measure> one_of_each() {
  const Vec3 axis = Vec3(1, -2, 0.5).normalized();
  std::vector<Measure> all{of_nodes(MeasureKind::coordinate, {1}, axis),
                           of_nodes(MeasureKind::length, {0, 3}),
                           of_nodes(MeasureKind::angle, {0, 1, 2, 3}),
                           of_nodes(MeasureKind::angle, {1, 0, 1, 4}, axis),
                           of_nodes(MeasureKind::angle, {0, 1, 2, 3, 4, 3}),
                           of_nodes(MeasureKind::angle, {0, 1, 2, 3, 4, 0}, axis),
                           of_nodes(MeasureKind::fold, {}),
                           of_nodes(MeasureKind::dihedral, {0, 1, 2, 3})};
  Measure sum;
  sum.kind = MeasureKind::combination;
  for (const Measure& m : all)
    if (m.kind != MeasureKind::fold)
      sum.terms.push_back({0.5 + 0.25 * static_cast<double>(sum.terms.size()), m});
  all.push_back(sum);
  return all;
}

}  // namespace

// Two ways to one number: rounding of some hundred products, of terms up to the sum of the magnitudes. A
// third, the difference of gradients over 2e-5, is off by 1e-10 / 6 times the fourth derivative, which is
// some 1e4 times the second where points happen to lie near a line, and by the rounding of gradients over
// 2e-5.
TEST_CASE("the curvature of a measure along a line is that of its Hessian") {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> any(-1, 1);
  Deployment fold;
  fold.fold_sine = {{0, 2}, {Vec3(1, 2, -1), Vec3(0.5, 0, 1)}, 0.3};
  fold.fold_cosine = {{1, 2}, {Vec3(-1, 1, 0.2), Vec3(0.1, 1, 0)}, 0.8};
  for (const Measure& measure : one_of_each())
    for (int trial = 0; trial < 20; ++trial) {
      const VectorXd q = VectorXd::NullaryExpr(15, [&] { return any(random); }),
                     v = VectorXd::NullaryExpr(15, [&] { return any(random); });
      const MeasureFunction f(measure, fold);
      const std::vector<int>& stencil = f.stencil();
      const auto size = static_cast<Index>(stencil.size());
      MatrixXd hess(size, size);
      f.hessian(q.data(), hess.data());
      VectorXd along(size);
      for (Index i = 0; i < size; ++i) along[i] = v[stencil[static_cast<std::size_t>(i)]];
      const double by_hessian = along.dot(hess * along),
                   terms = along.cwiseAbs().dot(hess.cwiseAbs() * along.cwiseAbs());
      const double curvature = f.curvature_along(q.data(), v.data());
      INFO("kind " << static_cast<int>(measure.kind) << " trial " << trial);
      CHECK(std::abs(curvature - by_hessian) <= 1e-12 * terms);
      const auto rate = [&](double t) {
        const VectorXd there = q + t * v;
        VectorXd gradient(size);
        f.value_and_gradient(there.data(), gradient.data());
        return gradient.dot(along);
      };
      CHECK(std::abs((rate(1e-5) - rate(-1e-5)) / 2e-5 - curvature) <= 1e-5 * terms + 1e-9);
      if (measure.kind == MeasureKind::coordinate)
        CHECK(curvature == 0.0);
      else
        CHECK(terms > 0.0);
    }
}

// The tangents of parabolas through their first two equal parts, at which they begin: of x_0 + a u + b u^2
// the direction a. What is straight has its own.
TEST_CASE("an angle of six nodes is that of the tangents") {
  const Vec3 a(0.7, -0.3, 0.5), b(0.2, 0.4, -0.1), c(-0.4, 0.6, 0.3), d(0.3, 0.1, 0.25), from(0.1, 0.9, -0.6);
  VectorXd q(18), there(12);
  q << from, from + a + b, from + d, from + d + c - 0.5 * b, from + 2 * a + 4 * b, from + d + 2 * c - 2 * b;
  there << from, from + a, from + d, from + d + c;
  const Vec3 axis = Vec3(1, -2, 0.5).normalized();
  for (const Vec3& about : {Vec3(Vec3::Zero()), axis}) {
    const MeasureFunction six(of_nodes(MeasureKind::angle, {0, 1, 2, 3, 4, 5}, about), {}),
        four(of_nodes(MeasureKind::angle, {0, 1, 2, 3}, about), {});
    CHECK(six.value(q.data()) == Approx(four.value(there.data())).epsilon(1e-14));
  }
}

// Two sides of 0.8 and 0.5 m in line turn against each other at w: an angle of 0 has fallen to it, if they
// moved before, and grows from it where a motion begins; one of 180 degrees the other way round. What rests,
// by velocities of rounding, has no rate.
TEST_CASE("an angle in line changes as its sides turn and not at all where they rest") {
  const Vec3 u = Vec3(2, -1, 2) / 3, across = Vec3(1, 2, 0) / std::sqrt(5.0);
  for (const double side : {1.0, -1.0})
    for (const double w : {0.7, 1e-14}) {
      INFO((side > 0 ? "folded" : "stretched") << ", " << w << " rad/s");
      VectorXd q(9), v(9);
      q << Vec3(0.3, -0.2, 0.1), Vec3(0.3, -0.2, 0.1) + 0.8 * u, Vec3(0.3, -0.2, 0.1) + side * 0.5 * u;
      v << Vec3::Zero(), 0.8 * 0.4 * w * across, -side * 0.5 * 0.6 * w * across;
      const MeasureFunction angle(of_nodes(MeasureKind::angle, {0, 1, 0, 2}), {});
      VectorXd g(12);
      for (const double t : {0.0, 0.3}) {
        CHECK(angle.value_and_gradient(q.data(), v.data(), g.data(), Moment(t), -1) ==
              Approx(side > 0 ? 0 : pi).epsilon(0).margin(1e-15));
        const double rate = angle.rate(g.data(), v.data()), grows = (t == 0 ? 1 : -1) * side;
        CHECK(rate == Approx(w > 1e-9 ? grows * w : 0.0).epsilon(0).margin(1e-14 * w));
      }
    }
}

// Of points whose distance has no square: as of points in one place, where the Hessian is zero.
TEST_CASE("the length between points closer than numbers can be squared has no curvature") {
  VectorXd q = VectorXd::Zero(15), v = VectorXd::Zero(15);
  q[9] = 1e-170;
  v[10] = 1.0;
  const MeasureFunction length(of_nodes(MeasureKind::length, {0, 3}), {});
  CHECK(length.curvature_along(q.data(), v.data()) == 0.0);
  q[9] = 0.5;  // v^2 / r
  CHECK(length.curvature_along(q.data(), v.data()) == 2.0);
}

}  // namespace measure_curvature_test
