// SPDX-License-Identifier: BSD-3-Clause
// Every row of the force table: derivatives, potential and power against finite differences of the force.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "core/forces/force.hpp"
#include "core/system/mass_matrix.hpp"
#include "tests/support/table_structure.hpp"

using namespace unfurl;

namespace force_table_test {

namespace {

// Values that no special case hides: the defaults of a kind with every number that a force may need.
ParamSet values_of(const ForceKind& kind) {
  ParamSet values(kind.params());
  double number = 0.7;
  for (const ParamSpec& spec : kind.params()) {
    if (spec.name == "static")
      values.set("static", 99.0);  // no less than kinetic
    else if (spec.name.starts_with("pin_"))
      continue;  // of hinges of a structure that moves (pin_friction_test)
    else if (spec.name == "times")
      values.set("times", std::vector<double>{0, 1, 2});
    else if (spec.name == "values")
      values.set("values", std::vector<double>{1, 3, 2});
    else if (spec.kind == ParamKind::vector && spec.required)
      values.set(spec.name, std::vector<double>{0.4, -0.8, 1.1});
    else if (spec.kind == ParamKind::real && (spec.required || std::get<double>(spec.fallback) == 0.0))
      values.set(spec.name, number += 0.6);
  }
  return values;
}

// A force of a kind as an entry of a scene makes it, on members of the sample.
Force force_of(const ForceKind& kind) {
  Force force;
  force.kind = kind.kind;
  force.rest = 0.9;
  if (kind.members == Members::each_node) force.nodes = {1};
  if (kind.members == Members::node_list) force.nodes = {0, 2, 3};
  if (kind.members == Members::three_nodes) force.nodes = {0, 1, 2};
  if (kind.members == Members::rod) force.nodes = {0, 1};
  if (kind.members == Members::two_nodes) force.measure = {MeasureKind::length, {0, 3}, Vec3::Zero(), 0, {}};
  if (kind.members == Members::angle) force.measure = {MeasureKind::angle, {1, 0, 1, 2}, Vec3::Zero(), 0, {}};
  if (kind.members == Members::path || kind.members == Members::terms) {
    force.measure.kind = MeasureKind::combination;
    force.measure.terms = {{1.0, {MeasureKind::length, {0, 1}, Vec3::Zero(), 0, {}}},
                           {1.0, {MeasureKind::length, {1, 3}, Vec3::Zero(), 0, {}}}};
    force.rest = 0.4;  // of more than two spans: taut
  }
  if (kind.members == Members::terms)
    force.measure.terms.push_back({-0.6, {MeasureKind::dihedral, {3, 0, 1, 2}, Vec3::Zero(), -0.4, {}}});
  if (kind.members == Members::measure) force.measure = {MeasureKind::length, {1, 3}, Vec3::Zero(), 0, {}};
  kind.fill(values_of(kind), force);
  force.slip = -1;  // of friction: what sticks has no force
  if (kind.members == Members::path) {
    force.smoothing = 0.0;
    force.kinetic = 0.3;  // on its pulleys, over which tensions grow by no more than e
    force.rest = force.unstressed.offset = 0.4;
    force.unstressed.kind = TimeFunction::Kind::rate;
    force.unstressed.rate = 0.3;
  }
  if (kind.kind == "latch")
    force.form = {{0, 2, 0}, {Vec3(0.4, -0.3, 0.9), Vec3(-1.1, 0.2, 0.5), Vec3(0.3, 0.6, -0.2)}, 0.35};
  return force;
}

// A structure that has at least one force of every kind: each as the table makes it, and special ones
// besides.
Structure sample() {
  Structure s = testing::table_structure();
  const Vec3 n = Vec3(1, 2, 2) / 3;
  s.gravity = {0, 1, -9.81};
  s.loads = {{1, {3, 4, 5}}};
  const auto add = [&](const char* kind, std::vector<int> nodes) -> Force& {
    s.forces.push_back({});
    s.forces.back().kind = kind;
    s.forces.back().nodes = std::move(nodes);
    s.forces.back().stiffness = 2.0;
    s.forces.back().damping = 0.7;
    return s.forces.back();
  };
  Rod& rod = s.rods.front();  // gives, is damped, and warms
  rod.gives = true;
  rod.area = 0.8;
  rod.youngs_modulus = 2.3;
  rod.damping_time = 0.4;
  rod.expansion = 0.1;
  rod.warming.kind = TimeFunction::Kind::rate;
  rod.warming.rate = 0.7;
  for (const ForceKind& kind : force_kinds())
    if (kind.params) s.forces.push_back(force_of(kind));
  Force& cable = add("spring", {});
  cable.measure = {MeasureKind::length, {0, 2}, Vec3::Zero(), 0, {}};
  cable.one_sided = true;
  Force net = force_of(*std::find_if(force_kinds().begin(), force_kinds().end(),
                                     [](const ForceKind& kind) { return kind.members == Members::path; }));
  net.smoothing = 5.0;  // wider than any stretch here: within its bend
  net.damping = 0.3;
  s.forces.push_back(net);
  // Over a node where it creeps, and back to it at once.
  net.measure.terms.push_back({1.0, {MeasureKind::length, {3, 2}, Vec3::Zero(), 0, {}}});
  net.kinetic = 0.4;
  net.holding = 7.0;  // faster than anything here
  s.forces.push_back(net);
  add("torsion_spring", {}).measure = {MeasureKind::angle, {0, 1, 2, 3}, n, 0.5, {}};
  add("torsion_spring", {}).measure = {MeasureKind::fold, {}, Vec3::Zero(), 0, {}};
  return s;
}

}  // namespace

TEST_CASE("every force kind: derivatives, potential and power agree with the force") {
  const Structure structure = sample();
  const SparseRows mass = node_mass_matrix(structure);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Index n = 12;
  for (const ForceKind& kind : force_kinds()) {
    INFO("force " << kind.kind);
    // A temperature is no force; bends fold back here, bending_test has others.
    if (kind.kind == "temperature" || kind.kind == "bending") continue;
    const auto block = kind.make(structure, mass);
    REQUIRE(block);
    VectorXd q(n), v(n);
    for (VectorXd* x : {&q, &v})
      for (Index i = 0; i < n; ++i) (*x)[i] = uniform(random);
    const double t = 0.6, step = 1e-5;
    const auto force = [&](const VectorXd& at, const VectorXd& rate) {
      VectorXd f = VectorXd::Zero(n);
      block->add(t, at.data(), rate.data(), 1.0, f.data());
      return f;
    };
    const auto potential = [&](const VectorXd& at) { return block->potential(t, at.data()); };
    ForceDerivative by_q, by_v;
    block->derivatives(t, q.data(), v.data(), by_q, by_v);
    SparseRows K(n, n), D(n, n);
    K.setFromTriplets(by_q.begin(), by_q.end());
    D.setFromTriplets(by_v.begin(), by_v.end());
    double rate_of_potential = 0;
    for (Index i = 0; i < n; ++i) {
      const VectorXd unit = VectorXd::Unit(n, i) * step;
      // Truncation step^2 times third derivatives of order 10 to 100, round-off 1e-16 / step: 1e-8.
      CHECK(((force(q + unit, v) - force(q - unit, v)) / (2 * step) - MatrixXd(K).col(i))
                .cwiseAbs()
                .maxCoeff() <= 2e-7);
      CHECK(((force(q, v + unit) - force(q, v - unit)) / (2 * step) - MatrixXd(D).col(i))
                .cwiseAbs()
                .maxCoeff() <= 2e-7);
      rate_of_potential += (potential(q + unit) - potential(q - unit)) / (2 * step) * v[i];
    }
    rate_of_potential +=
        (block->potential(t + step, q.data()) - block->potential(t - step, q.data())) / (2 * step);
    if (!block->constant())  // those are booked by System itself
      CHECK(block->power(t, q.data(), v.data()) ==
            Approx(force(q, v).dot(v) + rate_of_potential).epsilon(0).margin(1e-7));
    if (block->dissipates()) CHECK(block->dissipation(t, q.data(), v.data()) <= 0.0);
    if (block->takes_by_pose()) {
      if (block->power(t, q.data(), v.data()) > 0) v = -v;  // the way that it slips
      double rate_of_taken = 0;
      for (Index i = 0; i < n; ++i) {
        const VectorXd unit = VectorXd::Unit(n, i) * step;
        rate_of_taken +=
            (block->taken(t, VectorXd(q + unit).data()) - block->taken(t, VectorXd(q - unit).data())) /
            (2 * step) * v[i];
      }
      CHECK(block->power(t, q.data(), v.data()) == Approx(-rate_of_taken).epsilon(1e-7));
    }
    if (block->constant()) CHECK((force(q, v) - force(v, q)).isZero(0.0));
  }
}

// The same force on other nodes, half as large where it is by a measure.
Measure other_way(Measure measure) {
  for (int& node : measure.nodes) node = 3 - node;
  for (auto& term : measure.terms) term.measure = other_way(term.measure);
  return measure;
}
Force other(Force force) {
  for (int& node : force.nodes) node = 3 - node;
  for (int& node : force.form.nodes) node = 3 - node;
  force.measure = other_way(force.measure);
  force.stiffness *= 0.5, force.damping *= 0.7, force.rest *= 0.8;
  return force;
}

// What a block says at one moment; sums of blocks' add up.
struct Said {
  VectorXd force = VectorXd::Zero(12);
  MatrixXd by_q = MatrixXd::Zero(12, 12), by_v = by_q;
  VectorXd numbers = VectorXd::Zero(4);

  static Said of(const ForceBlock* block, const VectorXd& q, const VectorXd& v) {
    Said out;
    if (!block) return out;
    const double t = 0.6;
    block->add(t, q.data(), v.data(), 0.7, out.force.data());
    ForceDerivative by_q, by_v;
    block->derivatives(t, q.data(), v.data(), by_q, by_v);
    for (const auto& e : by_q) out.by_q(e.row(), e.col()) += e.value();
    for (const auto& e : by_v) out.by_v(e.row(), e.col()) += e.value();
    out.numbers << block->potential(t, q.data()), block->power(t, q.data(), v.data()),
        block->dissipation(t, q.data(), v.data()), block->taken(t, q.data());
    return out;
  }
  double apart(const Said& o) const {
    const auto far = [](const auto& a, const auto& b) { return (a - b).cwiseAbs().maxCoeff(); };
    return std::max({far(force, o.force), far(by_q, o.by_q), far(by_v, o.by_v), far(numbers, o.numbers)});
  }
  Said plus(const Said& o) const {
    return {force + o.force, by_q + o.by_q, by_v + o.by_v, numbers + o.numbers};
  }
};

TEST_CASE("two forces of a kind do what each does by itself") {
  Structure bare = sample();
  bare.forces.clear();
  bare.rods.push_back({"cd", 2, 3, 1.0, 2.0, "rod", 0.01, 1.0});  // two joints
  std::mt19937 random(12);
  std::uniform_real_distribution<double> uniform(-1, 1);
  VectorXd q(12), v(12);
  for (VectorXd* x : {&q, &v})
    for (Index i = 0; i < x->size(); ++i) (*x)[i] = uniform(random);
  int with_members = 0;
  for (const ForceKind& kind : force_kinds()) {
    INFO("force " << kind.kind);
    if (!kind.params || kind.kind == "temperature") continue;
    with_members += 1;
    const auto said = [&](std::vector<Force> forces) {
      Structure s = bare;
      s.forces = std::move(forces);
      const SparseRows mass = node_mass_matrix(s);
      return Said::of(kind.make(s, mass).get(), q, v);
    };
    const Force one = force_of(kind), two = other(one);
    const Said first = said({one}), second = said({two}), none = said({});
    CHECK(first.apart(none) > 1e-3);
    CHECK(second.apart(none) > 1e-3);
    CHECK(first.apart(second) > 1e-3);
    // Round-off of some sums of numbers up to 1e3.
    CHECK(said({one, two}).plus(none).apart(first.plus(second)) <= 1e-12);
    CHECK(said({two, one}).plus(none).apart(first.plus(second)) <= 1e-12);
  }
  CHECK(with_members > 10);
}

TEST_CASE("internal forces exert no net force and no net torque") {
  const Structure structure = sample();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const ForceKind& kind : force_kinds()) {
    if (kind.kind != "spring" && kind.kind != "cable" && kind.kind != "joint_damping") continue;
    VectorXd q(12), v(12), f = VectorXd::Zero(12);
    for (Index i = 0; i < 12; ++i) q[i] = uniform(random), v[i] = uniform(random);
    kind.make(structure, {})->add(0.0, q.data(), v.data(), 1.0, f.data());
    Vec3 net = Vec3::Zero(), torque = Vec3::Zero();
    for (Index i = 0; i < 12; i += 3) {
      net += f.segment<3>(i);
      torque += Vec3(q.segment<3>(i)).cross(Vec3(f.segment<3>(i)));
    }
    CHECK(net.norm() <= 1e-13);  // round-off of a dozen terms of size 1
    CHECK(torque.norm() <= 1e-13);
  }
}

}  // namespace force_table_test
