// SPDX-License-Identifier: BSD-3-Clause
// Gaps of stops and what pushes along them do, against the principle of virtual power with masses and lengths
// worked out here.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/push_responses.hpp"
#include "core/simulate/stops.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace sides_test {

namespace {

// Two rods that hang from a fixed node, and a free mass.
const std::string linkage = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0.1, 0.2, 0], fixed = true},
         {name = "A", position = [1.1, 0.4, 0.3], velocity = [0.3, -0.9, 0.7], mass = 0.4},
         {name = "B", position = [1.6, 1.3, -0.2], velocity = [-1.2, 0.4, 0.8], mass = 0.6},
         {name = "C", position = [-0.5, 0.7, 0.9], velocity = [0.5, 0.6, -0.4], mass = 0.8}]
rods = [{nodes = ["O", "A"], mass = 1.2}, {nodes = ["A", "B"], mass = 0.9}]
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["B"]
direction = [0, 0.6, 0.8]
min = -2
max = 5
restitution = 0.3
[[constraints]]
kind = "length_stop"
name = "rope"
nodes = ["B", "C"]
min = 0.25
max = 3.3
restitution = 0.7
[[constraints]]
kind = "length_stop"
name = "rod"
nodes = ["O", "A"]
min = 0.5
[[forces]]
kind = "spring"
nodes = ["O", "C"]
stiffness = 7
[gravity]
acceleration = [0.4, 0.5, -9.5]
[solver]
step = 0.001
end_time = 1
)";

Vec3 at(const VectorXd& x, int node) {
  return x.segment<3>(3 * node);
}

// Twice the kinetic energy, as a form of two velocities: of uniform rods and lumped masses.
double power(const VectorXd& v, const VectorXd& w) {
  double sum = 0.4 * at(v, 1).dot(at(w, 1)) + 0.6 * at(v, 2).dot(at(w, 2)) + 0.8 * at(v, 3).dot(at(w, 3));
  for (const auto& [a, b, m] : {std::tuple{0, 1, 1.2}, {1, 2, 0.9}})
    sum += m / 6 *
           (2 * at(v, a).dot(at(w, a)) + at(v, a).dot(at(w, b)) + at(v, b).dot(at(w, a)) +
            2 * at(v, b).dot(at(w, b)));
  return sum;
}

VectorXd velocities(const System& system, const VectorXd& w) {
  VectorXd v(system.coordinates());
  system.expand_rate(w, v);
  return v;
}

double stretching(const VectorXd& q, const VectorXd& v) {
  return std::max(std::abs((at(q, 1) - at(q, 0)).dot(at(v, 1) - at(v, 0))),
                  std::abs((at(q, 2) - at(q, 1)).dot(at(v, 2) - at(v, 1))));
}

// Gaps of: floor, ceiling, rope at its shortest and its longest, rod; and their rates.
std::vector<double> gaps(const VectorXd& q) {
  const double height = Vec3(0, 0.6, 0.8).dot(at(q, 2)), rope = (at(q, 3) - at(q, 2)).norm();
  return {height + 2, 5 - height, rope - 0.25, 3.3 - rope, (at(q, 1) - at(q, 0)).norm() - 0.5};
}
std::vector<double> gap_rates(const VectorXd& q, const VectorXd& v) {
  const double rise = Vec3(0, 0.6, 0.8).dot(at(v, 2));
  const Vec3 rope = at(q, 3) - at(q, 2);
  const double pay = rope.dot(at(v, 3) - at(v, 2)) / rope.norm();
  return {rise, -rise, pay, -pay, 0.0};
}

// Both models have the same motion; of the one linear constraints are eliminated.
struct Case {
  std::shared_ptr<const Model> model;
  State state;
  VectorXd q, v, other;  // other: velocities that the rods allow, too
};

Case make_case(bool eliminate) {
  Structure structure = testing::model_of(linkage)->structure;
  Case c{testing::make_model(structure, eliminate), {}, {}, {}, {}};
  c.state = initial_state(structure, c.model->system).state;
  c.q.resize(12);
  c.model->system.expand(c.state.z, c.q);
  c.v = velocities(c.model->system, c.state.w);
  for (Node& node : structure.nodes) node.velocity = Vec3(node.velocity.y(), 0.8, -node.velocity.x());
  structure.nodes[0].velocity.setZero();
  const State second = initial_state(structure, c.model->system).state;
  c.other = velocities(c.model->system, second.w);
  return c;
}

}  // namespace

TEST_CASE("gaps of stops and their rates are those of lengths and heights") {
  for (const bool eliminate : {true, false}) {
    const Case c = make_case(eliminate);
    const System& system = c.model->system;
    const Stops stops(c.model->structure);
    REQUIRE(stops.size() == 5);
    const auto gap = gaps(c.q), rate = gap_rates(c.q, c.v);
    for (std::size_t i = 0; i < 5; ++i) {
      double found = 0;
      CHECK(stops.gap(i, system, c.state) == Approx(gap[i]).epsilon(1e-13));
      CHECK(stops.gap(i, c.state, c.q, c.v, found) == Approx(gap[i]).epsilon(1e-13));
      CHECK(found == Approx(rate[i]).epsilon(1e-12).margin(1e-13));
      CHECK(stops.gap_rate(i, system, c.state) == found);
    }
    CHECK(std::abs(rate[0]) > 0.1);
    CHECK(std::abs(rate[2]) > 0.1);
  }
}

TEST_CASE("pushes along several gaps answer by the work that each does along the others") {
  for (const bool eliminate : {true, false}) {
    const Case c = make_case(eliminate);
    const System& system = c.model->system;
    const Stops stops(c.model->structure);
    PushResponses responses(system, c.state);
    REQUIRE(responses.ok());
    const LimitMotion limits[] = {{0, 0}, {0.4, -0.7}, {0, 0}, {-1.1, 0.9}, {0, 0}};
    for (std::size_t i = 0; i < 5; ++i)
      responses.add(stops[i].function, stops[i].sign, stops[i].near(c.state), limits[i]);
    REQUIRE(responses.size() == 5);
    const auto rate = gap_rates(c.q, c.v);
    const VectorXd found = responses.rates(c.state.w);
    const MatrixXd D = responses.matrix();
    CHECK(D == D.transpose());
    for (Index i = 0; i < 5; ++i) {
      const auto k = static_cast<std::size_t>(i);
      CHECK(found[i] == Approx(rate[k] - stops[k].sign * limits[k].rate).epsilon(1e-12).margin(1e-13));
      CHECK(responses.movable(i) == (i != 4));
      if (i == 4) continue;
      VectorXd w = c.state.w;
      responses.give(1.3 * VectorXd::Unit(5, i), w);
      const VectorXd jump = velocities(system, w) - c.v;
      CHECK(stretching(c.q, jump) <= 1e-13);
      CHECK(power(c.other, jump) == Approx(1.3 * gap_rates(c.q, c.other)[k]).epsilon(1e-10));
      const auto changed = gap_rates(c.q, jump);
      for (Index j = 0; j < 4; ++j)
        CHECK(1.3 * D(j, i) == Approx(changed[static_cast<std::size_t>(j)]).epsilon(1e-10).margin(1e-12));
    }
    // Rates five steps long, from one side: the derivative to h^4.
    const double h = c.model->system.solved_coordinates() > 0 ? 1e-3 : 0;
    const auto method = find_method("dvm")->make(system, testing::dvm_options(4, h, 1));
    State moving = c.state;
    VectorXd slope = VectorXd::Zero(5);
    for (const double weight : {-25.0, 48.0, -36.0, 16.0, -3.0}) {
      for (Index i = 0; i < 5; ++i)
        slope[i] += weight / (12 * h) * stops.gap_rate(static_cast<std::size_t>(i), system, moving);
      REQUIRE(method->step(moving, h).ok());
    }
    const VectorXd accelerations = responses.accelerations(c.model->structure, c.state).value;
    for (Index i = 0; i < 5; ++i) {
      const auto k = static_cast<std::size_t>(i);
      // The fifth derivative of a rate is some 10^3 of it here: h^4 times that, a fifth.
      CHECK(accelerations[i] ==
            Approx(slope[i] - stops[k].sign * limits[k].acceleration).epsilon(0).margin(1e-7));
    }
  }
}

TEST_CASE("stops that are held are constraints at their limits, by name, and push by their multipliers") {
  const Case c = make_case(true);
  Stops stops(c.model->structure);
  Structure held = c.model->structure;
  const std::size_t own = held.constraints.size();
  const std::set<std::size_t> which = {0, 1, 3};
  stops.hold(which, held);
  REQUIRE(held.constraints.size() == own + 3);
  const std::string names[] = {"floor (held at its lower limit)", "floor (held at its upper limit)",
                               "rope (held at its upper limit)"};
  const double limits[] = {-2, 5, 3.3};
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(held.constraints[own + k].name == names[k]);
    CHECK(held.constraints[own + k].kind == "measure");
    CHECK(held.constraints[own + k].target(0.7) == limits[k]);
    CHECK(held.constraints[own + k].target.derivative(1, 0.7) == 0);
  }
  const auto model = testing::make_model(held, false);
  State state;
  state.lambda.resize(model->system.constraints());
  for (Index r = 0; r < state.lambda.size(); ++r) state.lambda[r] = 1.5 + static_cast<double>(r * r);
  std::size_t k = 0;
  for (const std::size_t i : which) {
    const int row = model->system.constraint_row(static_cast<int>(own + k++));
    CHECK(stops.push(i, *model, which, state) == -stops[i].sign * state.lambda[row]);
  }
}

TEST_CASE("a cable that is paid out bounds its length by what is out, until it stands still") {
  Structure structure = make_case(true).model->structure;
  TimeFunction out;
  out.kind = TimeFunction::Kind::rate;
  out.offset = 2.1, out.rate = 0.4, out.start = 0.5;
  structure.stops.assign(1, Stop{"winch", {MeasureKind::length, {2, 3}, Vec3::Zero(), 0.0, {}}});
  structure.stops[0].reel = out;
  structure.stops[0].reeled = true;
  Stops stops(structure);
  REQUIRE(stops.size() == 1);
  CHECK(stops[0].sign == -1);
  Case c = make_case(true);
  const double length = (at(c.q, 3) - at(c.q, 2)).norm(), pay = gap_rates(c.q, c.v)[2];
  for (const double t : {0.2, 1.75}) {
    c.state.t = t;
    CHECK(stops.gap(0, c.model->system, c.state) == Approx(out(t) - length));
    CHECK(stops.gap_rate(0, c.model->system, c.state) == Approx((t > 0.5 ? 0.4 : 0.0) - pay));
  }
  Structure held = structure;
  stops.hold({0}, held);
  CHECK(held.constraints.back().name == "winch");
  CHECK(held.constraints.back().target(1.75) == Approx(2.6));
  CHECK(held.constraints.back().target.derivative(1, 1.75) == Approx(0.4));
  stops.stop_reels(1.75);
  c.state.t = 3;
  CHECK(stops.gap(0, c.model->system, c.state) == Approx(2.6 - length));
  CHECK(stops.gap_rate(0, c.model->system, c.state) == Approx(-pay));
}

}  // namespace sides_test
