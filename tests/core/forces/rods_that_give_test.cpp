// SPDX-License-Identifier: BSD-3-Clause
// Rods that give, each function of theirs against its own differences: those of N as an unknown, too, which
// only Newton's method sees.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "core/forces/elastic_rods.hpp"
#include "core/structure/moment.hpp"

using namespace unfurl;

namespace rods_that_give_test {

namespace {

constexpr int nodes = 4;

// Three rods between four nodes at any place, with dampers but for the last; the first warms.
Structure structure_of(const VectorXd& q) {
  Structure s;
  for (int i = 0; i < nodes; ++i) s.nodes.push_back({"N" + std::to_string(i), q.segment<3>(3 * i)});
  const int ends[][2] = {{0, 1}, {3, 1}, {2, 3}};
  for (int r = 0; r < 3; ++r) {
    Rod rod;
    rod.a = ends[r][0], rod.b = ends[r][1];
    rod.mass = 1;
    rod.length = (q.segment<3>(3 * rod.b) - q.segment<3>(3 * rod.a)).norm() * (0.9 + 0.07 * r);
    rod.area = 1e-4 * (1 + r), rod.youngs_modulus = 3e6 * (2 + r), rod.gives = true, rod.multiplicity = 1 + r;
    rod.damping_time = r < 2 ? 0.02 + 0.05 * r : 0;
    s.rods.push_back(rod);
  }
  s.rods[0].expansion = 2e-3;
  s.rods[0].warming.kind = TimeFunction::Kind::rate;
  s.rods[0].warming.rate = 7;
  Rod rigid = s.rods[1];  // has no place among them
  rigid.gives = false;
  s.rods.insert(s.rods.begin() + 1, rigid);
  return s;
}

MatrixXd dense(const ForceDerivative& entries, Index rows) {
  MatrixXd A = MatrixXd::Zero(rows, 3 * nodes);
  for (const auto& entry : entries) A(entry.row(), entry.col()) += entry.value();
  return A;
}

// Central differences of f at x.
MatrixXd differences(const std::function<VectorXd(const VectorXd&)>& f, const VectorXd& x) {
  constexpr double h = 1e-5;
  MatrixXd A(f(x).size(), x.size());
  for (Index i = 0; i < x.size(); ++i)
    A.col(i) = (f(x + h * VectorXd::Unit(x.size(), i)) - f(x - h * VectorXd::Unit(x.size(), i))) / (2 * h);
  return A;
}

}  // namespace

TEST_CASE("what rods that give do and how it changes with their nodes agree") {
  std::mt19937 dice(12);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    VectorXd q(3 * nodes), v(3 * nodes), N(3);
    for (double& x : q) x = 2 * any(dice);
    for (double& x : v) x = any(dice);
    for (double& x : N) x = 50 * any(dice);
    const Structure s = structure_of(q);
    const ElasticRods rods(s);
    REQUIRE(rods.rods().size() == 3);
    const double t = 1.3;
    const auto stretches = [&](const VectorXd& x, const VectorXd& u) {
      VectorXd e(3);
      rods.stretches(t, x.data(), u.data(), e.data());
      return e;
    };
    for (int r = 0; r < 3; ++r) {
      const Rod& rod = s.rods[r == 0 ? 0U : static_cast<std::size_t>(r) + 1];
      const Vec3 d = q.segment<3>(3 * rod.b) - q.segment<3>(3 * rod.a),
                 u = v.segment<3>(3 * rod.b) - v.segment<3>(3 * rod.a);
      const double grows = r == 0 ? rod.length * 2e-3 * 7 : 0;  // per second
      const double e = d.norm() - rod.length - grows * t + rod.damping_time * (d.dot(u) / d.norm() - grows);
      CHECK(stretches(q, v)[r] == Approx(e).epsilon(1e-12));
      VectorXd force(3);
      rods.forces(t, q.data(), v.data(), force.data());
      // E A of as many rods as it stands for, over its length without heat.
      CHECK(force[r] ==
            Approx(e * rod.youngs_modulus * rod.area * rod.multiplicity / rod.length).epsilon(1e-12));
    }
    const auto pulled = [&](const VectorXd& x) {
      VectorXd f = VectorXd::Zero(x.size());
      rods.add_forces(x.data(), N.data(), 1.7, f.data());
      return VectorXd(f / 1.7);
    };
    // Third derivatives of lengths of a metre, times h^2.
    const auto near = [](const MatrixXd& a, const MatrixXd& b) {
      return (a - b).lpNorm<Eigen::Infinity>() <= 1e-6 * (1 + b.lpNorm<Eigen::Infinity>());
    };
    ForceDerivative by_q, by_v, turned, directions;
    rods.row_derivatives(q.data(), v.data(), by_q, by_v);
    rods.turning(q.data(), N.data(), turned);
    rods.directions(q.data(), directions);
    bool apart = true;  // nodes that nearly meet have no differences
    for (const Rod& rod : rods.rods()) apart = apart && rod.length > 0.5;
    if (!apart) continue;
    const VectorXd none = VectorXd::Zero(v.size());
    CHECK(near(dense(by_q, 3), differences([&](const VectorXd& x) { return stretches(x, v); }, q)));
    CHECK(near(dense(by_v, 3), differences([&](const VectorXd& u) { return stretches(q, u); }, v)));
    CHECK(near(dense(directions, 3), differences([&](const VectorXd& x) { return stretches(x, none); }, q)));
    CHECK(near(dense(turned, 3 * nodes), differences(pulled, q)));
    // F = -N d|d|/dq: the pulls of all rods, by their directions.
    CHECK(near(pulled(q), -dense(directions, 3).transpose() * N));
  }
}

// F . v + dV/dt of springs and dampers together is -N l', N with the damper's part, less c e'^2, which the
// dampers take; by axial forces that are known, these.
TEST_CASE(
    "of what warming puts into damped rods that give their dampers take c times the strain's rate squared") {
  std::mt19937 dice(5);
  std::uniform_real_distribution<double> any(-1, 1);
  VectorXd q(3 * nodes), v(3 * nodes), N(3);
  for (double& x : q) x = 2 * any(dice);
  for (double& x : v) x = any(dice);
  const Structure s = structure_of(q);
  const auto springs = elastic_rods_block(s, {}), dampers = rod_dampers_block(s, {});
  const double t = 1.3, h = 1e-5, grows = s.rods[0].length * 2e-3 * 7;
  ElasticRods(s).forces(t, q.data(), v.data(), N.data());
  VectorXd f = VectorXd::Zero(q.size());
  springs->add(t, q.data(), v.data(), 1.0, f.data());
  dampers->add(t, q.data(), v.data(), 1.0, f.data());
  VectorXd pulled = VectorXd::Zero(q.size());
  ElasticRods(s).add_forces(q.data(), N.data(), 1.0, pulled.data());
  CHECK((f - pulled).norm() <= 1e-13 * f.norm());
  const VectorXd before = q - h * v, after = q + h * v;
  const double rate =  // of the potential; third derivatives of it times h^2
      (springs->potential(t + h, after.data()) - springs->potential(t - h, before.data())) / (2 * h);
  const double power = springs->power(t, q.data(), v.data()) + dampers->power(t, q.data(), v.data());
  CHECK(power == Approx(f.dot(v) + rate).epsilon(1e-7));
  double taken = 0;
  for (const Rod& rod : s.rods) {
    if (!rod.gives) continue;
    const Vec3 d = q.segment<3>(3 * rod.b) - q.segment<3>(3 * rod.a),
               u = v.segment<3>(3 * rod.b) - v.segment<3>(3 * rod.a);
    const double e = d.dot(u) / d.norm() - (rod.expansion != 0 ? grows : 0);
    taken -= rod.damping_time / rod.compliance() * e * e;
  }
  CHECK(dampers->dissipation(t, q.data(), v.data()) == Approx(taken).epsilon(1e-12));
  CHECK(power - taken == Approx(-N[0] * grows).epsilon(1e-9));
  N = 3.0 * N;
  Moment known(t);
  known.tension = N.data();
  CHECK(springs->power(known, q.data(), v.data()) == Approx(-N[0] * grows).epsilon(1e-12));
  CHECK(dampers->power(known, q.data(), v.data()) == Approx(taken).epsilon(1e-12));
}

// A sector's copies: turned about z by a third, and set off.
TEST_CASE("positions of the whole are turned and set off, velocities are turned alone") {
  Structure s;
  s.nodes.resize(2);
  Mat3 third;
  const double c = -0.5, w = std::sqrt(0.75);
  third << c, -w, 0, w, c, 0, 0, 0, 1;
  s.node_copies = {{"A", 0, Mat3::Identity(), Vec3::Zero()},
                   {"B", 1, third, Vec3(0.3, -0.7, 1.1)},
                   {"C", 0, third, Vec3(0, 0, 2)}};
  VectorXd q(6), x(9), y(9);
  q << 1, 2, 3, -0.5, 0.25, 0.75;
  x << 1, 2, 3, 0.25 - 0.25 * w + 0.3, -0.5 * w - 0.125 - 0.7, 0.75 + 1.1, -0.5 - 2 * w, w - 1, 5;
  y << 1, 2, 3, 0.25 - 0.25 * w, -0.5 * w - 0.125, 0.75, -0.5 - 2 * w, w - 1, 3;
  CHECK((whole_positions(s, q) - x).norm() < 1e-15 * 8);
  CHECK((whole_velocities(s, q) - y).norm() < 1e-15 * 8);
}

}  // namespace rods_that_give_test
