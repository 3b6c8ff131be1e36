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

Deployment some_fold() {
  Deployment fold;
  fold.fold_sine = {{0, 2}, {Vec3(1, 2, -1), Vec3(0.5, 0, 1)}, 0.3};
  fold.fold_cosine = {{1, 2}, {Vec3(-1, 1, 0.2), Vec3(0.1, 1, 0)}, 0.8};
  return fold;
}

// What v has where f looks.
VectorXd in_stencil(const MeasureFunction& f, const VectorXd& v) {
  VectorXd out(std::ssize(f.stencil()));
  for (Index i = 0; i < out.size(); ++i) out[i] = v[f.stencil()[static_cast<std::size_t>(i)]];
  return out;
}

std::vector<Measure> one_of_each() {
  const Vec3 axis = Vec3(1, -2, 0.5).normalized();
  std::vector<Measure> all{of_nodes(MeasureKind::coordinate, {1}, axis),
                           of_nodes(MeasureKind::length, {0, 3}),
                           of_nodes(MeasureKind::angle, {0, 1, 2, 3}),
                           of_nodes(MeasureKind::angle, {1, 0, 1, 4}, axis),
                           of_nodes(MeasureKind::angle, {0, 1, 2, 3, 4, 3}),
                           of_nodes(MeasureKind::angle, {0, 1, 2, 3, 4, 0}, axis),
                           of_nodes(MeasureKind::angle, {0, 1, 2, 3, 4, 0}),
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
  const Deployment fold = some_fold();
  for (const Measure& measure : one_of_each())
    for (int trial = 0; trial < 20; ++trial) {
      const VectorXd q = VectorXd::NullaryExpr(15, [&] { return any(random); }),
                     v = VectorXd::NullaryExpr(15, [&] { return any(random); });
      const MeasureFunction f(measure, fold);
      const VectorXd along = in_stencil(f, v);
      const Index size = along.size();
      MatrixXd hess(size, size);
      f.hessian(q.data(), hess.data());
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

// Of two lines of parts the angle between what is drawn back from each: of 3/2 t_1 - 1/2 t_2. How long the
// parts are changes nothing, and so what acts on it has no component along any of them.
TEST_CASE("an angle of six nodes is that of the tangents and pulls along no part") {
  const Vec3 t1 = Vec3(0.7, -0.3, 0.5).normalized(), t2 = Vec3(0.8, 0.2, 0.4).normalized(),
             s1 = Vec3(-0.4, 0.6, 0.3).normalized(), s2 = Vec3(-0.6, 0.7, -0.1).normalized(),
             one(0.1, 0.9, -0.6), two(0.4, 1.0, -0.35);
  VectorXd there(12);
  there << one, one + 1.5 * t1 - 0.5 * t2, two, two + 1.5 * s1 - 0.5 * s2;
  for (const Vec3& about : {Vec3(Vec3::Zero()), Vec3(Vec3(1, -2, 0.5).normalized())})
    for (const double longer : {1.0, 1.7}) {
      VectorXd q(18), g(18);
      q << one, one + longer * t1, two, two + 0.3 * s1, one + longer * t1 + 0.9 * t2,
          two + 0.3 * s1 + longer * s2;
      const MeasureFunction six(of_nodes(MeasureKind::angle, {0, 1, 2, 3, 4, 5}, about), {}),
          four(of_nodes(MeasureKind::angle, {0, 1, 2, 3}, about), {});
      CHECK(six.value_and_gradient(q.data(), g.data()) == Approx(four.value(there.data())).epsilon(1e-14));
      const auto pull = [&g](int node) -> Vec3 { return g.segment<3>(3 * node); };
      for (const double along : {pull(0).dot(t1), pull(4).dot(t2), pull(2).dot(s1), pull(5).dot(s2)})
        CHECK(std::abs(along) <= 1e-15 * g.lpNorm<1>());
      CHECK((pull(0) + pull(1) + pull(4)).norm() <= 1e-15 * g.lpNorm<1>());
    }
}

// The chords of two equal arcs of a circle turn by the bend b from one to the next, and by b / 2 from its
// tangent to the first: what is drawn back from them, atan(sin b / (3 - cos b)), is b / 2 less b^3 / 4.
TEST_CASE("the tangent of a rod that bends is that of a circle to the third order") {
  for (const double b : {0.4, 0.2, 0.1}) {
    VectorXd q(12);
    q << Vec3::Zero(), std::cos(b / 2), std::sin(b / 2), 0, 1, 0, 0, std::cos(b / 2) + std::cos(1.5 * b),
        std::sin(b / 2) + std::sin(1.5 * b), 0;
    const MeasureFunction angle(of_nodes(MeasureKind::angle, {0, 1, 0, 2, 3, 2}, Vec3(0, 0, -1)), {});
    CHECK(angle.value(q.data()) == Approx(b * b * b / 4).epsilon(b * b));
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

// Of large motions it is the difference of two values, up to turns, of which sums have quarters; of small
// ones the first two terms of Taylor's series, where differences would have lost their digits.
TEST_CASE("what a motion changes of a measure") {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> any(-1, 1);
  const Deployment fold = some_fold();
  for (const Measure& measure : one_of_each())
    for (int trial = 0; trial < 20; ++trial) {
      const VectorXd q = VectorXd::NullaryExpr(15, [&] { return any(random); }),
                     v = VectorXd::NullaryExpr(15, [&] { return any(random); });
      const MeasureFunction f(measure, fold);
      const VectorXd along = in_stencil(f, v);
      VectorXd gradient(along.size());
      const auto value = [&](const VectorXd& at) { return f.value_and_gradient(at.data(), gradient.data()); };
      INFO("kind " << static_cast<int>(measure.kind) << " trial " << trial);
      const VectorXd far = 0.4 * v, there = q + far;
      const double after = value(there), before = value(q), sizes = gradient.cwiseAbs().dot(along.cwiseAbs());
      const double off = f.change(q.data(), far.data()) - (after - before);
      CHECK(std::abs(std::remainder(off, pi / 2)) <= 1e-11 * (1 + sizes));
      const double h = 1e-7;
      const VectorXd near = h * v;
      const double series = h * gradient.dot(along) + 0.5 * h * h * f.curvature_along(q.data(), v.data());
      // Third derivatives of angles are some (sizes)^3, of points near a line a hundred times as much.
      const double next = 100 * std::pow(h * (1 + sizes), 3);
      CHECK(std::abs(f.change(q.data(), near.data()) - series) <= 1e-13 * h * (1 + sizes) + next);
    }
}

}  // namespace measure_curvature_test
