// SPDX-License-Identifier: BSD-3-Clause
// Springs, cables, drums and latches in all of their states: what a block says of itself agrees with its
// force, and what its dampers take with the law written down.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <tuple>

#include "core/forces/bending.hpp"
#include "core/forces/latch_spring.hpp"
#include "core/forces/motor.hpp"
#include "core/forces/spring.hpp"
#include "tests/support/table_structure.hpp"

using namespace unfurl;

namespace force_books_test {

namespace {

constexpr double t = 0.6;

using Path = std::vector<int>;

// Over nodes in order, and what a drum has drawn in.
Measure path_of(const Path& nodes, int drum = -1) {
  Measure path;
  path.kind = MeasureKind::combination;
  for (std::size_t i = 1; i < nodes.size(); ++i)
    path.terms.push_back({1.0, {MeasureKind::length, {nodes[i - 1], nodes[i]}, Vec3::Zero(), 0, {}}});
  if (drum >= 0) path.terms.push_back({1.0, {MeasureKind::coordinate, {drum}, Vec3::UnitX(), 0, {}}});
  return path;
}

Force cable(const Path& nodes, double length, double damping, int drum = -1) {
  Force f;
  f.kind = "cable";
  f.measure = path_of(nodes, drum);
  f.one_sided = true;
  f.axial_stiffness = 6.3;
  f.damping = damping;
  f.rest = f.unstressed.offset = length;
  return f;
}

Force reeled(Force f, double rate = 0.37) {
  f.unstressed.kind = TimeFunction::Kind::rate;
  f.unstressed.rate = rate;
  return f;
}

Force rubbing(Force f, double creep) {
  f.kinetic = 0.3;
  f.holding = creep;
  return f;
}

Force slack(Force f) {
  f.slack = true;
  return f;
}

Force smoothed(Force f, double width) {
  f.smoothing = width;
  return f;
}

// Two nodes, with a law of its own in place of E A.
Force straight(double damping, bool one_sided) {
  Force f;
  f.kind = "spring";
  f.measure = {MeasureKind::length, {1, 3}, Vec3::Zero(), 0, {}};
  f.stiffness = 2.3;
  f.rest = 0.9;
  f.damping = damping;
  f.one_sided = one_sided;
  return f;
}

struct Variant {
  const char* name;
  Force force;
};

std::vector<Variant> variants() {
  const Path two = {1, 3}, bent = {0, 1, 3}, many = {0, 1, 2, 3, 0, 2, 1, 3, 2, 0, 1};
  Force reeled_two = reeled(cable(two, 0.8, 0.9));
  reeled_two.measure = reeled_two.measure.terms[0].measure;
  Force sum = straight(0.4, false);
  sum.kind = "combination";
  sum.measure = path_of(bent);
  sum.measure.terms[1].coefficient = -1.7;
  Force across = straight(0.4, false);
  across.measure = {MeasureKind::coordinate, {1, 3}, Vec3(0.6, 0.48, -0.64), 0, {}};
  return {{"spring", straight(0, false)},
          {"across", across},
          {"damped spring", straight(0.6, false)},
          {"damped sum", sum},
          {"pulls only", straight(0.6, true)},
          {"pulls smoothly", smoothed(straight(0.6, true), 4)},
          {"slack", slack(straight(0.6, true))},
          {"cable", cable(bent, 0.7, 0)},
          {"damped cable", cable(bent, 0.7, 0.8)},
          {"reeled", reeled(cable(bent, 0.7, 0))},
          {"reeled between two", reeled_two},
          {"damped and reeled", reeled(cable(bent, 0.7, 0.8), -0.23)},
          {"damped and reeled, smoothly", smoothed(reeled(cable(bent, 0.7, 0.8)), 5)},
          {"slack and reeled", slack(reeled(cable(bent, 0.7, 0.8)))},
          {"rubbing", rubbing(cable({0, 1, 3, 2}, 0.7, 0.2), 0.01)},
          {"creeping", rubbing(reeled(cable({0, 1, 3, 2}, 0.7, 0.2)), 9)},
          {"drum", cable({3, 1, 2}, 1.9, 0, 0)},
          {"damped drum", cable({3, 1, 2}, 1.9, 0.5, 0)},
          {"slack drum", slack(cable({3, 1, 2}, 1.9, 0.5, 0))},
          {"rubbing drum", rubbing(cable({3, 1, 2}, 1.9, 0.5, 0), 7)},
          {"another drum", cable({3, 0, 2}, 1.9, 0.5, 1)},
          {"many spans", cable(many, 2.1, 0.8)}};
}

struct State {
  VectorXd q, v;
};

State random_state(std::mt19937& dice, Index n = 12) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  State s{VectorXd(n), VectorXd(n)};
  for (VectorXd* x : {&s.q, &s.v})
    for (double& one : *x) one = uniform(dice);
  return s;
}

VectorXd force_of(const ForceBlock& block, const VectorXd& q, const VectorXd& v, double scale = 1) {
  VectorXd f = VectorXd::Zero(q.size());
  block.add(t, q.data(), v.data(), scale, f.data());
  return f;
}

// By differences with 1e-5: 1e-10 times third derivatives of 10 to 10^4, where two nodes are a tenth apart,
// and 1e-16 / 1e-5.
constexpr double near = 2e-6;

void check_derivatives(const ForceBlock& block, const State& at) {
  const Index n = at.q.size();
  const double step = 1e-5;
  ForceDerivative by_q, by_v;
  block.derivatives(t, at.q.data(), at.v.data(), by_q, by_v);
  MatrixXd K = MatrixXd::Zero(n, n), D = K;
  for (const auto& e : by_q) K(e.row(), e.col()) += e.value();
  for (const auto& e : by_v) D(e.row(), e.col()) += e.value();
  for (Index i = 0; i < n; ++i) {
    const VectorXd unit = VectorXd::Unit(n, i) * step;
    const VectorXd k = (force_of(block, at.q + unit, at.v) - force_of(block, at.q - unit, at.v)) / (2 * step),
                   d = (force_of(block, at.q, at.v + unit) - force_of(block, at.q, at.v - unit)) / (2 * step);
    CHECK((k - K.col(i)).cwiseAbs().maxCoeff() <= near * (1 + k.cwiseAbs().maxCoeff()));
    CHECK((d - D.col(i)).cwiseAbs().maxCoeff() <= near * (1 + d.cwiseAbs().maxCoeff()));
  }
}

// F . v + d(V + taken)/dt is what comes in: all of power().
void check_power(const ForceBlock& block, const State& at) {
  const double step = 1e-5;
  const auto stored = [&](double by) {
    const VectorXd q = at.q + by * at.v;
    return block.potential(t + by, q.data()) + block.taken(t + by, q.data());
  };
  const double in = force_of(block, at.q, at.v).dot(at.v) + (stored(step) - stored(-step)) / (2 * step);
  CHECK(block.power(t, at.q.data(), at.v.data()) == Approx(in).epsilon(near).margin(near));
}

// What a spring has stored, and what its damper takes by N = max(k e + c e', 0), over a smooth beginning by
// its share of c: of a cable that nothing rubs on.
struct Energies {
  double stored, taken;
};
Energies energies_of(const Force& f, const VectorXd& q, const VectorXd& v) {
  double s = 0, rate = 0, drawn = 0, k = f.stiffness, rest = f.rest, rest_rate = 0;
  const auto add = [&](double c, const Measure& m) {
    const auto a = 3 * static_cast<Index>(m.nodes[0]);
    if (m.kind == MeasureKind::coordinate && m.nodes.size() == 2) {
      s += m.axis.dot(q.segment<3>(3 * m.nodes[1]) - q.segment<3>(a));
      rate += m.axis.dot(v.segment<3>(3 * m.nodes[1]) - v.segment<3>(a));
      return;
    }
    if (m.kind == MeasureKind::coordinate) {
      drawn = q[a];
      s += c * q[a], rate += c * v[a];
      return;
    }
    const auto b = 3 * static_cast<Index>(m.nodes[1]);
    const Vec3 d = q.segment<3>(b) - q.segment<3>(a);
    s += c * d.norm(), rate += c * d.normalized().dot(v.segment<3>(b) - v.segment<3>(a));
  };
  if (f.measure.terms.empty()) add(1, f.measure);
  for (const MeasureTerm& term : f.measure.terms) add(term.coefficient, term.measure);
  if (f.axial_stiffness > 0) {
    rest = f.unstressed.offset + t * f.unstressed.rate, rest_rate = f.unstressed.rate;
    k = f.axial_stiffness / (rest - drawn);
  }
  const double e = s - rest, w = f.one_sided ? f.smoothing : 0, along = rate - rest_rate;
  const double share = !f.one_sided || e > w ? 1 : e < -w ? 0 : (e + w) / (2 * w);
  const double elastic = k * (w > 0 && std::abs(e) < w ? (e + w) * (e + w) / (4 * w) : share * e);
  const double all = elastic + f.damping * share * along;
  // Of k (e + w)^2 / (4 w) from -w to e, and of k e from there on.
  const double stored = w == 0   ? share * e * e / 2
                        : e >= w ? e * e / 2 + w * w / 6
                                 : share * share * share * 2 * w * w / 3;
  return {k * stored, ((f.one_sided ? std::max(all, 0.0) : all) - elastic) * along};
}

}  // namespace

TEST_CASE("springs and cables of every sort say of themselves what their force does") {
  const Deployment none;
  std::mt19937 dice(7);
  for (const auto& [name, force] : variants()) {
    const auto block = spring_block({force}, none);
    int acts = 0;
    for (int k = 0; k < 24; ++k) {
      INFO(name << ", state " << k);
      const State at = random_state(dice);
      check_derivatives(*block, at);
      check_power(*block, at);
      acts += !force_of(*block, at.q, at.v).isZero(0.0);
      const double dissipated = block->dissipation(t, at.q.data(), at.v.data());
      if (force.kinetic > 0)
        CHECK(dissipated <= 0);
      else if (!force.slack)
        CHECK(-dissipated == Approx(energies_of(force, at.q, at.v).taken).epsilon(0).margin(1e-12));
      CHECK(block->potential(t, at.q.data()) ==
            Approx(energies_of(force, at.q, at.v).stored).epsilon(0).margin(1e-12));
    }
    INFO(name);
    CHECK((acts >= 4) == !force.slack);
    CHECK(block->dissipates() == (force.damping > 0 || force.kinetic > 0));
    CHECK(block->supplies() == (force.unstressed.kind == TimeFunction::Kind::rate));
  }
}

// Zeros where nothing pulls keep entries at their places for sums that ask for that, and for no others.
TEST_CASE("a spring's derivatives keep their places where it lets go") {
  for (const bool one_sided : {false, true})
    for (const double damping : {0.0, 0.6}) {
      Force force = straight(damping, one_sided);
      const auto block = spring_block({force}, {});
      std::mt19937 dice(10);
      int with = 0, without = 0;
      for (int k = 0; k < 20; ++k) {
        const State at = random_state(dice);
        ForceDerivative by_q, by_v, kept_q, kept_v;
        kept_q.keeps_places = kept_v.keeps_places = true;
        block->derivatives(t, at.q.data(), at.v.data(), by_q, by_v);
        block->derivatives(t, at.q.data(), at.v.data(), kept_q, kept_v);
        CHECK(kept_q.size() == 36);  // of two nodes
        CHECK(kept_v.size() == (damping > 0 ? 36U : 0U));
        const bool pulls = !force_of(*block, at.q, at.v).isZero(0.0);
        ++(pulls ? with : without);
        CHECK(by_q.size() == (pulls ? 36U : 0U));
        CHECK(by_v.size() == (pulls && damping > 0 ? 36U : 0U));
      }
      CHECK(with > 3);
      CHECK((without > 3) == one_sided);
    }
}

// All in one block, which has one room for their gradients: the sum, the long ones first or last.
TEST_CASE("springs and cables of every sort in one block add up") {
  const Deployment none;
  std::mt19937 dice(8);
  const State at = random_state(dice);
  const auto numbers = [&](const ForceBlock& b) {
    const double *q = at.q.data(), *v = at.v.data();
    return Eigen::Vector4d(b.potential(t, q), b.power(t, q, v), b.dissipation(t, q, v), b.taken(t, q));
  };
  std::vector<Force> all;
  VectorXd force = VectorXd::Zero(12);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const Variant& one : variants()) {
    all.push_back(one.force);
    const auto block = spring_block({one.force}, none);
    force += force_of(*block, at.q, at.v, 0.7);
    sum += numbers(*block);
  }
  for (int order = 0; order < 2; ++order, std::ranges::reverse(all)) {
    const auto block = spring_block(all, none);
    // Round-off of some hundred terms of size 10.
    CHECK((force_of(*block, at.q, at.v, 0.7) - force).cwiseAbs().maxCoeff() <= 1e-12);
    CHECK((numbers(*block) - sum).cwiseAbs().maxCoeff() <= 1e-12);
    CHECK((block->dissipates() && block->supplies()));
  }
}

namespace {

struct Said {
  using Read = double (*)(const Force&);
  const char *kind, *key;
  double value, wanted;
  Read read;
};

std::vector<Said> entries() {
  constexpr double degree = pi / 180;
  using Read = Said::Read;
  const Read stiffness = [](const Force&f) { return f.stiffness; },
             damping = [](const Force&f) { return f.damping; }, rest = [](const Force&f) { return f.rest; },
             size = [](const Force&f) { return f.size(0.6); };
  return {{"spring", "stiffness", 2.3, 2.3, stiffness},
          {"spring", "damping", 2.3, 2.3, damping},
          {"spring", "free_length", 2.3, 2.3, rest},
          {"torsion_spring", "stiffness", 2.3, 2.3, stiffness},
          {"torsion_spring", "damping", 2.3, 2.3, damping},
          {"torsion_spring", "free_angle", 23, 23 * degree, rest},
          {"combination", "stiffness", 2.3, 2.3, stiffness},
          {"combination", "damping", 2.3, 2.3, damping},
          {"combination", "free_value", 2.3, 2.3, rest},
          {"bending", "stiffness", 2.3, 2.3, stiffness},
          {"bending", "damping", 2.3, 2.3, damping},
          {"latch", "stiffness", 2.3, 2.3, stiffness},
          {"latch", "damping", 2.3, 2.3, damping},
          {"drag", "damping", 2.3, 2.3, damping},
          {"joint_damping", "damping", 2.3, 2.3, damping},
          {"cable", "axial_stiffness", 2.3, 2.3, [](const Force& f) { return f.axial_stiffness; }},
          {"cable", "damping", 2.3, 2.3, damping},
          {"cable", "smoothing", 2.3, 2.3, [](const Force& f) { return f.smoothing; }},
          {"cable", "length", 2.3, 2.3, [](const Force& f) { return f.unstressed(0.6); }},
          {"cable", "length", 2.3, 2.3, rest},
          {"cable", "length", 2.3, 1, [](const Force& f) { return double(f.one_sided); }},
          {"cable", "pulley_friction", 2.3, 2.3, [](const Force& f) { return f.kinetic; }},
          {"cable", "pulley_creep", 2.3, 2.3, [](const Force& f) { return f.holding; }},
          {"follower", "force", -2.3, -2.3, size},
          {"temperature", "expansion", 0.023, 0.023, [](const Force& f) { return f.expansion; }},
          {"temperature", "change", 2.3, 2.3, size},
          {"friction", "kinetic", 2.3, 2.3, [](const Force& f) { return f.kinetic; }},
          {"friction", "kinetic", 2.3, 2.3, [](const Force& f) { return f.holding; }},
          {"friction", "static", 9.3, 9.3, [](const Force& f) { return f.holding; }},
          {"offload", "length", 2.3, 2.3, [](const Force& f) { return f.rope; }},
          {"motor", "stall_torque", 2.3, 2.3, [](const Force& f) { return f.motor.stall; }},
          {"motor", "no_load_speed", 23, 23 * degree, [](const Force& f) { return f.motor.no_load_speed; }},
          {"motor", "gear_ratio", -2.3, -2.3, [](const Force& f) { return f.motor.gear_ratio; }},
          {"motor", "voltage", -0.23, -0.23, [](const Force& f) { return f.motor.command(0.6); }},
          {"motor", "proportional", 2.3, 2.3, [](const Force& f) { return f.motor.proportional; }},
          {"motor", "integral", 2.3, 2.3, [](const Force& f) { return f.motor.integral; }},
          {"motor", "derivative", 2.3, 2.3, [](const Force& f) { return f.motor.derivative; }}};
}

Force filled(const char* name, const std::vector<std::pair<const char*, ParamValue>>& given) {
  const auto kind = std::ranges::find(force_kinds(), name, &ForceKind::kind);
  ParamSet values(kind->params());
  for (const auto& [key, value] : given) values.set(key, value);
  Force force;
  force.measure = {MeasureKind::angle, {0, 1, 1, 2}, Vec3::UnitZ(), 0, {}};
  force.rest = 0.7;
  kind->fill(values, force);
  return force;
}

}  // namespace

TEST_CASE("what an entry of a kind says is what its force has in its unit") {
  for (const Said& said : entries()) {
    INFO(said.kind << "." << said.key);
    const auto kind = std::ranges::find(force_kinds(), said.kind, &ForceKind::kind);
    ParamSet values(kind->params());
    values.set(said.key, said.value);
    Force force;
    force.rest = 0.7;
    kind->fill(values, force);
    CHECK(said.read(force) == Approx(said.wanted).epsilon(1e-15));
    if (said.key == std::string("stiffness") || said.key == std::string("damping"))
      CHECK(force.rest == 0.7);  // as built
  }
}

TEST_CASE("what entries of a force say together is what it has") {
  constexpr double degree = pi / 180;
  CHECK(filled("combination", {{"free_value", 23.0}}).rest == Approx(23 * degree).epsilon(1e-15));
  const Force spring = filled("spring", {{"tension_only", true}}), both = filled("spring", {});
  CHECK((spring.one_sided && !both.one_sided));
  const Force hinge = filled("friction", {{"pin_friction", 0.3}, {"pin_radius", 0.04}});
  CHECK(hinge.size(0.2) == Approx(0.012).epsilon(1e-15));
  CHECK(filled("motor", {{"current_limit", 3.0}, {"torque_constant", 0.2}}).motor.limit ==
        Approx(0.6).epsilon(1e-15));
  CHECK(std::isinf(filled("motor", {}).motor.limit));
  // Along a ramp from where it is, of its rate from there, too.
  for (const char* control : {"position", "rate"}) {
    const Motor motor = filled("motor", {{"control", std::string(control)},
                                         {"proportional", 2.0},
                                         {"motion", std::string("rate")},
                                         {"rate", 23.0}})
                            .motor;
    CHECK((motor.control == Motor::Control::rate) == (control[0] == 'r'));
    CHECK(motor.command(0.6) == Approx(0.7 + 0.6 * 23 * degree).epsilon(1e-15));
    CHECK(bends(motor));
  }
  CHECK(!bends(filled("motor", {}).motor));
  CHECK(bends(filled("motor", {{"current_limit", 3.0}, {"torque_constant", 0.2}}).motor));
  const std::vector<double> place = {0.3, -0.4, 0.9};
  const Force rope = filled("offload", {{"position", place}}),
              above = filled("offload", {{"trolley", std::string("following")}});
  CHECK(rope.trolley == Vec3(0.3, -0.4, 0.9));
  CHECK((std::isnan(above.trolley.x()) && std::isinf(above.rope)));
  // A table of factors: of loads by straight lines, of temperatures through its points.
  const std::vector<double> times = {0.1, 0.5, 1.3}, factors = {0.4, -2, 1.2};
  for (const auto& [name, key, factor] :
       {std::tuple{"follower", "force", 3.1}, {"temperature", "change", 3.1}, {"load_over_time", "", 1.0}}) {
    std::vector<std::pair<const char*, ParamValue>> given = {{"times", times}, {"values", factors}};
    if (*key) given.emplace_back(key, factor);
    if (!*key) given.emplace_back("force", place);
    const Force load = filled(name, given);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(load.size(times[i]) == Approx(factor * factors[i]).epsilon(1e-14));
    if (*key == 'c') continue;
    CHECK(load.size(0.4) == Approx(factor * (0.25 * 0.4 - 0.75 * 2)).epsilon(1e-14));
    if (!*key) CHECK(load.direction == Vec3(0.3, -0.4, 0.9));
  }
}

TEST_CASE("rods that bend with damping say of themselves what their force does") {
  Structure s = testing::table_structure();
  for (const Path& nodes : {Path{0, 1, 2}, {3, 1, 0}}) {
    s.forces.push_back({});
    s.forces.back().kind = "bending";
    s.forces.back().nodes = nodes;
    s.forces.back().stiffness = 1.7;
    s.forces.back().damping = nodes[0] ? 0.0 : 0.8;
  }
  const auto block = bending_block(s, {});
  std::mt19937 dice(9);
  for (int k = 0; k < 6; ++k) {
    State at = random_state(dice);
    for (Index i = 0; i < 12; ++i)
      at.q[i] = s.nodes[static_cast<std::size_t>(i / 3)].position[i % 3] + 0.2 * at.q[i];
    check_derivatives(*block, at);
    check_power(*block, at);
    CHECK(block->dissipation(t, at.q.data(), at.v.data()) < 0);
  }
}

// k s + c s' along a linear form, of which a node that stands twice has both parts.
TEST_CASE("a latch that gives pulls its form to zero and no other coordinate") {
  Structure s = testing::table_structure();
  const Vec3 a(0.4, 0, 0.9), b(-1.1, 0.2, 0.5), c(0.3, 0.6, -0.2);
  for (const double damping : {0.0, 0.8}) {
    Force latch;
    latch.kind = "latch";
    latch.stiffness = 2.3, latch.damping = damping;
    latch.form = {{1, 2, 1}, {a, b, c}, 0.35};
    Force other = latch;
    other.damping = 0;
    other.form = {{3}, {b}, -0.2};
    s.forces = {latch, other};
    const auto block = latch_spring_block(s, {});
    std::mt19937 dice(15);
    const State at = random_state(dice);
    const Vec3 x = at.q.segment<3>(3), y = at.q.segment<3>(6), v = at.v.segment<3>(3), w = at.v.segment<3>(6);
    const double value = (a + c).dot(x) + b.dot(y) + 0.35, rate = (a + c).dot(v) + b.dot(w);
    const double second = b.dot(at.q.tail<3>()) - 0.2, pull = 2.3 * value + damping * rate;
    VectorXd wanted(12);
    wanted << Vec3::Zero(), -pull * (a + c), -pull * b, -2.3 * second * b;
    CHECK((force_of(*block, at.q, at.v) - wanted).norm() <= 1e-14);
    CHECK(block->potential(t, at.q.data()) ==
          Approx(1.15 * (value * value + second * second)).epsilon(1e-14));
    CHECK(block->power(t, at.q.data(), at.v.data()) == Approx(-damping * rate * rate).epsilon(1e-14));
    CHECK(block->has_power() == (damping > 0));
    check_derivatives(*block, at);
    CHECK(latch_load(s, t, at.q, at.v) ==
          Approx(std::max(std::abs(pull), 2.3 * std::abs(second))).epsilon(1e-14));
    std::ranges::reverse(s.forces);
    s.forces.push_back(straight(0.6, false));
    s.forces.back().stiffness = 900;  // no latch
    CHECK(latch_load(s, t, at.q, at.v) ==
          Approx(std::max(std::abs(pull), 2.3 * std::abs(second))).epsilon(1e-14));
    s.forces[0].form = {};  // of nothing yet: it waits
    CHECK(latch_waits(s.forces[0]));
    CHECK(latch_load(s, t, at.q, at.v) == Approx(std::abs(pull)).epsilon(1e-14));
  }
}

}  // namespace force_books_test
