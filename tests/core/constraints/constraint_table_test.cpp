// SPDX-License-Identifier: BSD-3-Clause
// Every row of the constraint table: Jacobian, curvature, bias and force against finite differences of the
// values.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <random>

#include "core/constraints/constraint.hpp"
#include "tests/support/table_structure.hpp"

using namespace unfurl;

namespace constraint_table_test {

namespace {

// A structure that has at least one constraint of every kind. A new kind must be added here: the test fails
// without.
Structure sample() {
  Structure s = testing::table_structure();
  const Vec3 n = Vec3(1, 2, 2) / 3;
  s.rods[1].expansion = 0.3;  // and is warmed
  s.rods[1].warming.kind = TimeFunction::Kind::smooth;
  s.rods[1].warming.rise = 0.7, s.rods[1].warming.duration = 2.0;
  s.constraints = {{"plane", "plane", {0}, {n}, 0.25},
                   {"line", "line", {1}, {n}, 0.0},
                   {"fixed", "fixed", {2}, {}, 0.0},
                   {"relation", "relation", {0, 1, 2}, {Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, -1)}, 0.5},
                   {"collinear", "collinear", {0, 1, 2}, {}, 0.0},
                   {"coplanar", "coplanar", {0, 1, 2, 3}, {}, 0.0}};
  Measure sum;
  sum.kind = MeasureKind::combination;
  sum.terms = {{0.7, {MeasureKind::length, {1, 3}, Vec3::Zero(), 0, {}}},
               {-1.3, {MeasureKind::coordinate, {0, 2}, n, 0, {}}},
               {0.4, {MeasureKind::angle, {0, 1, 2, 3}, n, 0.5, {}}},
               {0.9, {MeasureKind::dihedral, {3, 0, 1, 2}, Vec3::Zero(), -0.4, {}}}};
  const Measure measures[] = {sum,
                              {MeasureKind::dihedral, {0, 1, 2, 3}, Vec3::Zero(), 0.3, {}},
                              {MeasureKind::coordinate, {2}, n, 0, {}},
                              {MeasureKind::coordinate, {0, 3}, n, 0, {}},
                              {MeasureKind::length, {1, 3}, Vec3::Zero(), 0, {}},
                              {MeasureKind::angle, {1, 0, 1, 2}, Vec3::Zero(), 0, {}},
                              {MeasureKind::angle, {0, 1, 2, 3}, n, 0.5, {}},
                              {MeasureKind::fold, {}, Vec3::Zero(), 0, {}}};
  for (const Measure& measure : measures) {
    s.constraints.push_back({"measure", "measure", {}, {}, 0.0, measure, {}});
    TimeFunction& target = s.constraints.back().target;
    target.kind = TimeFunction::Kind::smooth;
    target.rise = 0.7;
    target.duration = 2.0;
  }
  return s;
}

MatrixXd dense_jacobian(const ConstraintBlock& block, const VectorXd& q) {
  std::vector<double> values;
  for (int r = 0; r < block.rows(); ++r) values.resize(values.size() + block.stencil(r).size());
  block.jacobian(q.data(), values.data());
  MatrixXd G = MatrixXd::Zero(block.rows(), q.size());
  std::size_t e = 0;
  for (int r = 0; r < block.rows(); ++r)
    for (int c : block.stencil(r)) G(r, c) += values[e++];
  return G;
}

// Summed up over the rows.
MatrixXd dense_curvature(const ConstraintBlock& block, const VectorXd& q, const VectorXd& lambda) {
  std::size_t size = 0;
  for (int r = 0; r < block.rows(); ++r) size += block.stencil(r).size() * block.stencil(r).size();
  std::vector<double> hess(size + 1, 7.7);  // all of it is written, and nothing behind it
  block.curvature(q.data(), lambda.data(), hess.data());
  CHECK(hess.back() == 7.7);
  MatrixXd H = MatrixXd::Zero(q.size(), q.size());
  const double* h = hess.data();
  for (int r = 0; r < block.rows(); ++r)
    for (const auto c = block.stencil(r); int j : c)
      for (int i : c) H(i, j) += *h++;
  return H;
}

// Rows of collinear nodes are differentiated across their line, which is what their value does on it: three
// nodes on a line e, velocities that keep them there, multipliers across it.
void put_on_a_line(const std::array<Index, 3>& node, VectorXd& q, VectorXd& v, VectorXd& lambda) {
  const Vec3 e = Vec3(0.36, -0.48, 0.8), spin(0.3, 0.7, -0.2);
  q.segment<3>(3 * node[1]) = q.segment<3>(3 * node[0]) + 0.9 * e;
  q.segment<3>(3 * node[2]) = q.segment<3>(3 * node[0]) - 0.4 * e;
  v.segment<3>(3 * node[1]) = v.segment<3>(3 * node[0]) + 0.9 * spin.cross(e) + 0.15 * e;
  v.segment<3>(3 * node[2]) = v.segment<3>(3 * node[0]) - 0.4 * spin.cross(e) - 0.65 * e;
  lambda -= e.dot(lambda) * e;
}

}  // namespace

TEST_CASE("every constraint kind: value, Jacobian and curvature agree") {
  // The second time no kind's first node is the structure's first.
  const bool backwards = GENERATE(false, true);
  Structure structure = sample();
  for (Constraint& c : structure.constraints)
    for (int& node : c.nodes) node = backwards ? 3 - node : node;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const ConstraintKind& kind : constraint_kinds()) {
    const auto block = kind.make(structure);
    INFO("constraint " << kind.kind);
    REQUIRE(block);
    const Index n = 12, m = block->rows();
    VectorXd q(n), v(n), lambda(m);
    for (VectorXd* x : {&q, &v, &lambda})
      for (Index i = 0; i < x->size(); ++i) (*x)[i] = uniform(random);
    if (kind.kind == "collinear")
      put_on_a_line(backwards ? std::array<Index, 3>{3, 2, 1} : std::array<Index, 3>{0, 1, 2}, q, v, lambda);
    const MatrixXd G = dense_jacobian(*block, q);
    // Central differences: round-off 1e-16 / 3e-6 = 3e-11; truncation step^2 = 1e-11 times derivatives of up
    // to 100 for angles.
    const double step = 3e-6;
    VectorXd up(m), down(m);
    for (Index i = 0; i < n; ++i) {
      VectorXd moved = q;
      moved[i] += step;
      block->value(moved.data(), up.data());
      moved[i] -= 2 * step;
      block->value(moved.data(), down.data());
      CHECK(((up - down) / (2 * step) - G.col(i)).cwiseAbs().maxCoeff() <= 1e-8);
    }
    VectorXd f = VectorXd::Zero(n);
    block->add_force(q.data(), lambda.data(), 2.0, f.data());
    CHECK((f - 2.0 * G.transpose() * lambda).cwiseAbs().maxCoeff() <=
          1e-14);  // the same products, once added
    VectorXd bias(m);
    block->bias(q.data(), v.data(), bias.data());
    const VectorXd turned =
        (dense_jacobian(*block, q + step * v) - dense_jacobian(*block, q - step * v)) * v / (2 * step);
    CHECK((bias - turned).cwiseAbs().maxCoeff() <= 1e-8);

    const MatrixXd H = dense_curvature(*block, q, lambda);
    for (Index i = 0; i < n; ++i) {
      VectorXd unit = VectorXd::Unit(n, i) * step;
      const VectorXd column =
          (dense_jacobian(*block, q + unit) - dense_jacobian(*block, q - unit)).transpose() * lambda /
          (2 * step);
      CHECK((H.col(i) - column).cwiseAbs().maxCoeff() <= 1e-8);
    }
    if (!block->rheonomic()) {
      CHECK(block->linear() == H.isZero(1e-12));
      continue;
    }
    CHECK(!block->linear());  // eliminated rows cannot move
    for (int order : {1, 2}) {
      VectorXd rate = VectorXd::Zero(m), later = rate, earlier = rate;
      block->add_target(order, 0.8, 1.0, rate.data());
      block->add_target(order - 1, 0.8 + step, 1.0, later.data());
      block->add_target(order - 1, 0.8 - step, 1.0, earlier.data());
      CHECK(((later - earlier) / (2 * step) - rate).cwiseAbs().maxCoeff() <= 1e-7);
    }
  }
}

// All that a block says of its rows at a pose, row by row; what belongs together is summed up by the rows.
struct Said {
  std::vector<std::string> names;
  std::vector<double> lengths;
  std::vector<int> sources, stencils, driven;
  VectorXd values, near, bias, target, rate;
  MatrixXd jacobian, curvature;
  VectorXd force;

  Said(const ConstraintBlock& block, const VectorXd& q, const VectorXd& v, const VectorXd& lambda)
      : values(block.rows()),
        near(values),
        bias(values),
        target(VectorXd::Zero(block.rows())),
        rate(target),
        jacobian(dense_jacobian(block, q)),
        curvature(dense_curvature(block, q, lambda)),
        force(VectorXd::Zero(q.size())) {
    for (int r = 0; r < block.rows(); ++r) {
      names.push_back(block.name(r));
      lengths.push_back(block.length(r));
      sources.push_back(block.source(r));
      const std::vector<int> stencil = block.stencil(r);
      stencils.insert(stencils.end(), stencil.begin(), stencil.end());
    }
    std::vector<Drive> drives;
    block.list_drives(drives);
    for (const Drive& drive : drives) driven.insert(driven.end(), {drive.constraint, drive.row});
    block.value(q.data(), values.data());
    block.value_at(0.3, q.data(), near.data());
    block.bias(q.data(), v.data(), bias.data());
    block.add_target(0, 0.8, 1.0, target.data());
    block.add_target(1, 0.8, 2.0, rate.data());
    block.add_force(q.data(), lambda.data(), 0.6, force.data());
    MatrixXd summed = MatrixXd::Zero(q.size(), q.size());
    std::vector<Eigen::Triplet<double>> entries;
    block.add_curvature(q.data(), lambda.data(), entries);
    for (const auto& e : entries) summed(e.row(), e.col()) += e.value();
    // The same numbers, summed up in another order.
    CHECK((curvature - summed).cwiseAbs().maxCoeff() <= 1e-14);
  }
};

template <class T>
std::vector<T> both(std::vector<T> a, const std::vector<T>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
VectorXd both(const VectorXd& a, const VectorXd& b) {
  VectorXd out(a.size() + b.size());
  out << a, b;
  return out;
}

TEST_CASE("two constraints of a kind do what each does by itself") {
  Structure all = sample();
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform(-1, 1);
  VectorXd q(12), v(12);
  for (VectorXd* x : {&q, &v})
    for (Index i = 0; i < x->size(); ++i) (*x)[i] = uniform(random);
  for (const ConstraintKind& kind : constraint_kinds()) {
    INFO("constraint " << kind.kind);
    Structure first = all, second = all, pair = all;
    // The same kind on other nodes, and elsewhere; a rod is no constraint of its own.
    pair.constraints.clear();
    for (const Constraint& c : all.constraints) {
      if (c.kind != kind.kind) continue;
      Constraint other = c;
      for (int& node : other.nodes) node = 3 - node;
      other.name += "_other";
      other.value += 0.3;
      pair.constraints.push_back(c);
      pair.constraints.push_back(other);
      break;
    }
    if (pair.constraints.empty())
      first.rods.pop_back(), second.rods.erase(second.rods.begin());
    else
      first.constraints = {pair.constraints[0], {}}, second.constraints = {{}, pair.constraints[1]};
    const auto a = kind.make(first), b = kind.make(second), ab = kind.make(pair);
    REQUIRE(a);
    REQUIRE(b);
    REQUIRE(ab);
    REQUIRE(ab->rows() == a->rows() + b->rows());
    VectorXd of_a(a->rows()), of_b(b->rows());
    for (VectorXd* x : {&of_a, &of_b})
      for (Index i = 0; i < x->size(); ++i) (*x)[i] = uniform(random);
    const Said one(*a, q, v, of_a), two(*b, q, v, of_b), said(*ab, q, v, both(of_a, of_b));
    CHECK(said.names == both(one.names, two.names));
    CHECK(said.lengths == both(one.lengths, two.lengths));
    CHECK(said.sources == both(one.sources, two.sources));
    CHECK(said.stencils == both(one.stencils, two.stencils));
    std::vector<int> driven = two.driven;
    for (std::size_t i = 1; i < driven.size(); i += 2) driven[i] += a->rows();
    CHECK(said.driven == both(one.driven, driven));
    const auto same = [](const auto& x, const auto& y) { return (x - y).cwiseAbs().maxCoeff() <= 1e-14; };
    CHECK(said.values == both(one.values, two.values));
    CHECK(said.near == both(one.near, two.near));
    CHECK(said.bias == both(one.bias, two.bias));
    CHECK(said.target == both(one.target, two.target));
    CHECK(said.rate == both(one.rate, two.rate));
    CHECK(said.jacobian.topRows(a->rows()) == one.jacobian);
    CHECK(said.jacobian.bottomRows(b->rows()) == two.jacobian);
    CHECK(same(said.force, one.force + two.force));
    CHECK(same(said.curvature, one.curvature + two.curvature));
  }
}

TEST_CASE("a block of constraints takes several poses at once as it takes each") {
  Structure structure = sample();
  structure.rods[1].expansion = 0.0;  // those that are warmed are asked pose by pose
  std::mt19937 random(23);
  std::uniform_real_distribution<double> uniform(-1, 1);
  constexpr int poses = 3;
  constexpr Index stride = 4;
  int offered = 0;
  for (const ConstraintKind& kind : constraint_kinds()) {
    INFO("constraint " << kind.kind);
    const auto block = kind.make(structure);
    const Index m = block->rows();
    std::vector<double> q(12 * stride), phi(static_cast<std::size_t>(m * poses)), lambda(phi.size()),
        f(12 * poses, 0.0);
    for (std::vector<double>* x : {&q, &lambda})
      for (double& number : *x) number = uniform(random);
    const double scale[poses] = {1.0, -0.6, 2.5};
    const bool values = block->values(poses, q.data(), stride, phi.data());
    const bool forces = block->add_forces(poses, q.data(), stride, lambda.data(), scale, f.data());
    CHECK(values == forces);
    if (!values) continue;
    offered += 1;
    for (int c = 0; c < poses; ++c) {
      VectorXd pose(12), multipliers(m), one(m), force = VectorXd::Zero(12);
      for (Index i = 0; i < 12; ++i) pose[i] = q[static_cast<std::size_t>(i * stride + c)];
      for (Index r = 0; r < m; ++r) multipliers[r] = lambda[static_cast<std::size_t>(r * poses + c)];
      block->value(pose.data(), one.data());
      block->add_force(pose.data(), multipliers.data(), scale[c], force.data());
      for (Index r = 0; r < m; ++r)
        CHECK(phi[static_cast<std::size_t>(r * poses + c)] == Approx(one[r]).epsilon(0).margin(1e-14));
      for (Index i = 0; i < 12; ++i)
        CHECK(f[static_cast<std::size_t>(i * poses + c)] == Approx(force[i]).epsilon(0).margin(1e-13));
    }
  }
  CHECK(offered > 1);
}

TEST_CASE("collinear rows have rank two off their line, too") {
  const Structure structure = sample();
  const auto kinds = constraint_kinds();
  const auto kind =
      std::find_if(kinds.begin(), kinds.end(), [](const auto& k) { return k.kind == "collinear"; });
  REQUIRE(kind != kinds.end());
  const auto block = kind->make(structure);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double off : {1e-1, 1e-4, 1e-8}) {
    VectorXd q(12), v(12), lambda = VectorXd::Zero(3);
    for (Index i = 0; i < 12; ++i) {
      q[i] = uniform(random);
      v[i] = uniform(random);
    }
    put_on_a_line({0, 1, 2}, q, v, lambda);
    q.segment<3>(3) += off * Vec3(0.5, 0.6, -0.2);
    const MatrixXd G = dense_jacobian(*block, q);
    // Three rows across one direction: the sum that is left is round-off of entries of order one.
    VectorXd bias(3);
    block->bias(q.data(), v.data(), bias.data());
    const Vec3 e = (q.segment<3>(3) - q.segment<3>(0)).normalized();
    CHECK((e.transpose() * G).cwiseAbs().maxCoeff() <= 1e-14);
    CHECK(std::abs(e.dot(bias)) <= 1e-14);
  }
}

}  // namespace constraint_table_test
