// SPDX-License-Identifier: BSD-3-Clause
// Forces where more than one acts, or where a term is only seen off its special value.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/forces/damping.hpp"
#include "core/forces/offload.hpp"
#include "core/forces/varying_loads.hpp"
#include "core/scene/library.hpp"
#include "core/structure/node_positions.hpp"
#include "core/system/mass_matrix.hpp"
#include "core/system/system.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using testing::end_positions, testing::run_scene;

namespace force_sums_test {

namespace {

const std::string point = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [1, 2, 3], velocity = [0.5, -0.25, 0.125], mass = 1.6},
  {name = "O", position = [0, 0, 0], fixed = true}]
[solver]
step = 0.05
end_time = 0.7
)";

}  // namespace

TEST_CASE("loads on one node add up, constant ones and those over time") {
  const Simulation run = run_scene(point + R"(
[[loads]]
nodes = ["A"]
force = [3, -1, 0.5]
[[loads]]
nodes = ["*"]
force = [-0.8, 2.2, 1.7]
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [0.4, 0.6, -2]
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [1, 5, 7]
times = [0, 10]
values = [0.3, 0.3]
)");
  REQUIRE(run.status == RunStatus::completed);
  const Vec3 force(3 - 0.8 + 0.4 + 0.3, -1 + 2.2 + 0.6 + 1.5, 0.5 + 1.7 - 2 + 2.1);
  const Vec3 expected = Vec3(1, 2, 3) + 0.7 * Vec3(0.5, -0.25, 0.125) + 0.5 * 0.49 / 1.6 * force;
  // A parabola, which the method follows to round-off.
  CHECK((end_positions(run).head<3>() - expected).norm() <= 1e-12);
}

TEST_CASE("a stretched cable whose damper would push does nothing") {
  // k (s - s_0) - c u = 50 (0.1) - 20 (1.5) < 0 at the start, and less with every moment of free flight until
  // it is slack at s_0: straight on at 1.5 m/s.
  const Simulation run =
      run_scene(point + R"(
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 50
damping = 20
free_length = 1.9
tension_only = true
)",
                {"structure.nodes.A.position=[0,0,2]", "structure.nodes.A.velocity=[0,0,-1.5]"});
  REQUIRE(run.status == RunStatus::completed);
  for (std::size_t i = 0; i < run.trajectory.size(); ++i)
    CHECK(run.trajectory.node_positions(i)[2] ==
          Approx(2 - 1.5 * run.trajectory.time(i)).epsilon(0).margin(1e-12));
}

TEST_CASE("a taut cable pulls with k (s - s_0) + c s', a slack one with nothing") {
  // From the origin to A at (1, 2, 3) m, s = sqrt 14 m, s' = (0.5 - 2 * 0.25 + 3 * 0.125) / s.
  for (const double rest : {1.9, 5.0}) {
    const auto model = testing::model_of(point + R"(
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 50
damping = 20
tension_only = true
)",
                                         {"forces[0].free_length=" + std::to_string(rest)});
    VectorXd q = VectorXd::Zero(6), v = VectorXd::Zero(6), f = VectorXd::Zero(6);
    q.head<3>() << 1, 2, 3;
    v.head<3>() << 0.5, -0.25, 0.125;
    model->system.add_applied_force(0.1, q, v, 1.0, f);
    const double s = std::sqrt(14.0), stretch = rest < s ? s - rest : 0.0;
    const double pull = rest < s ? 50 * stretch + 20 * 0.375 / s : 0.0;
    CHECK((f.head<3>() + pull * q.head<3>() / s).norm() <= 1e-12);
    CHECK((f.tail<3>() - pull * q.head<3>() / s).norm() <= 1e-12);
    CHECK(model->system.potential_energy(q) == Approx(25 * stretch * stretch).epsilon(0).margin(1e-12));
  }
}

TEST_CASE("a damped joint slows every pair of its rods and holds none") {
  // Three rods at J in a plane, turning at 1, 2 and 4 rad/s: torques c times the differences of their rates.
  CustomSpec spec;
  spec.nodes = {{"J", {0, 0, 0}, {0, 0, 0}, 0.0, true}};
  const double angles[] = {0.3, 1.7, 3.9}, rates[] = {1, 2, 4}, lengths[] = {1.2, 0.8, 1.5};
  for (int i = 0; i < 3; ++i) {
    const Vec3 out(std::cos(angles[i]), std::sin(angles[i]), 0);
    const std::string name(1, static_cast<char>('A' + i));
    spec.nodes.push_back({name, lengths[i] * out, Vec3::Zero(), 0.0, false});
    spec.rods.push_back({"J" + name, {"J", name}, 1.0});
  }
  Structure structure = build_custom(spec);
  Force damper;
  damper.kind = "joint_damping";
  damper.name = "oil";
  damper.nodes = {0};
  damper.damping = 0.35;
  damper.stiffness = 7;  // of another kind of force: says nothing here
  structure.forces.push_back(damper);
  const System system(structure, true);
  VectorXd q = VectorXd::Zero(12), v = q, f = q;
  for (int i = 0; i < 3; ++i) {
    const Vec3 x = structure.nodes[static_cast<std::size_t>(i) + 1].position;
    q.segment<3>(3 * i + 3) = x;
    v.segment<3>(3 * i + 3) = rates[i] * Vec3(-x.y(), x.x(), 0);
  }
  system.add_applied_force(0.2, q, v, 1.0, f);
  for (int i = 0; i < 3; ++i) {
    double torque = 0;
    for (const double other : rates) torque -= 0.35 * (rates[i] - other);
    const Vec3 x = q.segment<3>(3 * i + 3), force = f.segment<3>(3 * i + 3);
    CHECK(x.cross(force).z() == Approx(torque).epsilon(1e-12));
    CHECK(std::abs(x.dot(force)) <= 1e-12);
  }
  CHECK(std::abs(system.potential_energy(q)) <= 1e-14);
}

TEST_CASE("a step is solved where a damper is far stiffer than it") {
  // h c / m = 0.05 * 400 / 1.6 = 12.5: only a Newton matrix with dF/dz' finds it.
  const Simulation run = run_scene(point + R"(
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 30
damping = 400
free_length = 1.9
)",
                                   {"solver.end_time=0.05", "solver.stages=4"});
  INFO(run.message);
  CHECK(run.status == RunStatus::completed);
  // After the frozen iteration has given up, some ten are enough for a step; the first are shorter than
  // asked.
  CHECK(run.newton_iterations <= 30 * run.steps);
  CHECK(run.steps <= 20);
}

TEST_CASE("lumped rods weigh half at either end, consistent ones a third and a sixth") {
  CustomSpec spec;
  spec.nodes = {{"A", {0.1, 0.2, 0.3}, {1, 2, -1}, 0.4, false},
                {"B", {1.3, -0.4, 0.6}, {0, 0, 0}, 0.0, false}};
  spec.rods = {{"AB", {"A", "B"}, 2.7}};
  for (const bool lumped : {true, false}) {
    spec.lumped_mass = lumped;
    const Structure structure = build_custom(spec);
    const System system(structure, true);
    const MatrixXd M = MatrixXd(system.node_mass());
    MatrixXd expected(2, 2);
    if (lumped)
      expected << 0.4 + 1.35, 0, 0, 1.35;
    else
      expected << 0.4 + 0.9, 0.45, 0.45, 0.9;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l)
            CHECK(M(3 * i + k, 3 * j + l) == Approx(k == l ? expected(i, j) : 0.0).epsilon(0).margin(1e-15));
  }
}

// The rods of a cell of a mast cross at a pin between their ends, and turn about it against each other as the
// dashpot of three nodes at the same pin says: its angle is the supplement of theirs.
TEST_CASE("a damped joint acts on rods that carry it between their ends") {
  const auto mast = [](const std::string& force) {
    return build_model(read_scene_file(find_scene("scissor_mast"), {"forces[0]={" + force + "}"}));
  };
  const auto joint = mast(R"(kind="joint_damping",nodes=["P*"],damping=5)"),
             dashpot = mast(R"(kind="torsion_spring",nodes=["L0","P1","R0"],damping=5)"),
             one = mast(R"(kind="joint_damping",nodes=["P1"],damping=5)"),
             end = mast(R"(kind="joint_damping",nodes=["L0"],damping=5)");
  const System& system = joint->system;
  const VectorXd q = node_positions(joint->structure);
  VectorXd w(system.solved_coordinates()), v(q.size());
  for (Index i = 0; i < w.size(); ++i) w[i] = std::sin(1.3 + 2.1 * static_cast<double>(i));
  system.expand_rate(w, v);
  const auto power = [&](const Model& model) {
    VectorXd force = VectorXd::Zero(q.size());
    model.system.add_applied_force(0.2, q, v, 1.0, force);
    return force.dot(v);
  };
  const double bare = power(*end), by_dashpot = power(*dashpot) - bare;
  CHECK(by_dashpot < 0);
  CHECK(power(*one) - bare == Approx(by_dashpot).epsilon(1e-10));  // v has a size of 1: 1e-16 of forces
  CHECK(power(*joint) - bare < 2 * by_dashpot);
  // Where one rod ends there is nothing to damp.
  const auto& notes = end->structure.notes;
  CHECK(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("does nothing: no two rods meet at L0") != std::string::npos;
  }));
  CHECK(one->structure.notes.size() + 1 == notes.size());
}

// x_P = 0.4 x_A + 0.6 x_B, as rows that mix the coordinates, is a pin on A-B; what says anything else, or too
// little, is none.
TEST_CASE("rods meet at a pin between their ends where relations say that it is there") {
  Structure s;
  const Vec3 a(0.2, -0.4, 0.9), b(1.3, 0.8, 0.1), p = 0.4 * a + 0.6 * b;
  s.nodes = {
      {"A", a}, {"B", b}, {"P", p}, {"C", p + Vec3(0.3, -1, 0.6)}, {"D", p - 0.7 * Vec3(0.3, -1, 0.6)}};
  s.rods = {
      {"AB", 0, 1, 1.0, (b - a).norm(), "rod"}, {"CP", 3, 2, 1.0, 1.0, "rod"}, {"PD", 2, 4, 1.0, 1.0, "rod"}};
  Mat3 mix;
  mix << 1, 0.3, -0.2, 0.1, 0.9, 0.4, -0.5, 0.2, 1.3;
  const auto lines = [&](double share_a, double share_b, int rows) {
    s.constraints.clear();
    for (int k = 0; k < rows; ++k) {
      const Vec3 row = mix.row(k);
      s.constraints.push_back(
          {"relation", "pin", {0, 2, 1}, {-share_a * row, row, -share_b * row}, 0.0, {}, {}});
    }
    return rods_at_joint(s, 2);
  };
  const std::vector<RodAtJoint> all = lines(0.4, 0.6, 3);
  REQUIRE(all.size() == 3);
  CHECK((all[0].rod == 0 && all[0].from == 0 && all[0].to == 1));
  CHECK((all[1].rod == 1 && all[1].from == 2 && all[1].to == 3));
  CHECK((all[2].rod == 2 && all[2].from == 2 && all[2].to == 4));
  CHECK(angles_at_joint(s, 2).size() == 3);
  CHECK(lines(0.4, 0.6, 2).size() == 2);
  CHECK(lines(0.6, 0.4, 3).size() == 2);
  CHECK(lines(0, 0.6, 3).size() == 2);
  CHECK(angles_at_joint(s, 2).size() == 1);
}

// A-I-J-B is a rod of 1.2 kg cut in three, beside another one: what I and J weigh hangs on A and B by the
// lever, or on ropes of their own, and a rope that is aside pulls back by its weight over its length.
TEST_CASE("ropes carry their nodes and what lies within a rod by the lever") {
  Structure s;
  s.nodes = {{"C", Vec3(0, 1, 2)},
             {"A", Vec3(0.2, 0.1, 0.5), Vec3::Zero(), 0.3},
             {"I", Vec3(0.6, 0.1, 0.5)},
             {"J", Vec3(1, 0.1, 0.5)},
             {"B", Vec3(1.4, 0.1, 0.5), Vec3::Zero(), 0.7}};
  s.rods = {{"CA", 0, 1, 0.5, 1.0, "rod"}};
  for (int k = 0; k < 3; ++k) {
    s.rods.push_back({"AB", 1 + k, 2 + k, 0.4, 0.4, "rod"});
    s.rods.back().parts = 3;
  }
  s.gravity = {1.2, -3, -9};
  const double g = s.gravity.norm();
  const Vec3 down = s.gravity / g;
  std::vector<Force> ropes(3);
  for (std::size_t k = 0; k < 3; ++k) {
    ropes[k].kind = "offload";
    ropes[k].nodes = {std::vector{1, 4, 2}[k]};
    ropes[k].rope = std::vector{2.5, 4.0, std::numeric_limits<double>::infinity()}[k];
  }
  ropes[1].trolley = Vec3(1.1, 0.4, 77);
  for (const bool inner : {false, true}) {
    s.forces = {ropes[0], ropes[1]};
    if (inner) s.forces.push_back(ropes[2]);
    const auto block = offload_block(s, node_mass_matrix(s));
    VectorXd q(15), v = VectorXd::Zero(15), f = v, wanted = v;
    for (Index i = 0; i < 15; ++i) q[i] = std::sin(1.0 + 2.3 * static_cast<double>(i));
    block->add(0.3, q.data(), v.data(), 0.7, f.data());
    const auto across = [&](const Vec3& x) -> Vec3 { return x - down.dot(x) * down; };
    // Halves of rods at their ends; I and J have 0.4 kg each.
    const double at_A = 0.3 + 0.25 + 0.2 + 0.4 / 3 + (inner ? 0 : 0.8 / 3), at_I = 0.4,
                 at_B = 0.7 + 0.2 + 0.8 / 3 + (inner ? 0 : 0.4 / 3);
    const Vec3 aside_A = across(q.segment<3>(3) - Vec3(0.2, 0.1, 0.5)),
               aside_B = across(q.segment<3>(12) - Vec3(1.1, 0.4, 77));
    wanted.segment<3>(3) = -at_A * (s.gravity + g / 2.5 * aside_A);
    wanted.segment<3>(12) = -at_B * (s.gravity + g / 4 * aside_B);
    if (inner) wanted.segment<3>(6) = -at_I * s.gravity;
    CHECK((f - 0.7 * wanted).norm() <= 1e-13 * wanted.norm() + 1e-13 * 77 * g);
    double energy = at_A * (s.gravity.dot(q.segment<3>(3)) + g / 5 * aside_A.squaredNorm()) +
                    at_B * (s.gravity.dot(q.segment<3>(12)) + g / 8 * aside_B.squaredNorm());
    if (inner) energy += at_I * s.gravity.dot(q.segment<3>(6));
    CHECK(block->potential(0.3, q.data()) == Approx(energy).epsilon(1e-12));
  }
}

// Of a rod that was cut the last two parts tell the tangent at its end, that of the parabola through their
// nodes.
TEST_CASE("a follower goes along its rod or along the tangent at the end of one that bends") {
  const Vec3 c(0.4, -0.2, 0.9), d(0.3, 0.8, -0.1), e(-0.07, 0.05, 0.11);
  const auto on = [&](double u) -> Vec3 { return c + u * d + u * u * e; };
  Structure s;
  s.nodes = {{"A", on(0)}, {"B", on(2)}, {"I", on(1)}};
  VectorXd q(9), v(9);
  q << on(0), on(2), on(1);
  v << Vec3(0.1, 0.2, 0.3), Vec3(-0.4, 0.5, 0.9), Vec3(1, 2, 3);
  for (const bool cut : {false, true}) {
    Force follower;
    follower.kind = "follower";
    follower.nodes = cut ? std::vector{2, 1, 0} : std::vector{0, 1};
    follower.size.kind = TimeFunction::Kind::rate;
    follower.size.offset = 3, follower.size.rate = -8;
    s.forces = {follower};
    const auto block = follower_block(s, {});
    VectorXd f = VectorXd::Zero(9), wanted = f;
    block->add(0.6, q.data(), v.data(), 0.7, f.data());
    wanted.segment<3>(3) = (3 - 8 * 0.6) * (cut ? Vec3(d + 4 * e) : Vec3(on(2) - on(0))).normalized();
    CHECK((f - 0.7 * wanted).norm() <= 1e-14);
    CHECK(block->power(0.6, q.data(), v.data()) == Approx(wanted.dot(v)).epsilon(1e-14));
    ForceDerivative by_q, by_v;
    block->derivatives(0.6, q.data(), v.data(), by_q, by_v);
    MatrixXd K = MatrixXd::Zero(9, 9);
    for (const auto& entry : by_q) K(entry.row(), entry.col()) += entry.value();
    for (Index i = 0; i < 9; ++i) {  // 1e-10 and 1e-16 / 1e-5
      VectorXd up = VectorXd::Zero(9), down = up;
      block->add(0.6, VectorXd(q + 1e-5 * VectorXd::Unit(9, i)).data(), v.data(), 1.0, up.data());
      block->add(0.6, VectorXd(q - 1e-5 * VectorXd::Unit(9, i)).data(), v.data(), 1.0, down.data());
      CHECK(((up - down) / 2e-5 - K.col(i)).norm() <= 1e-8);
    }
  }
}

namespace {

// Two rods from A in space, and what has forces, rows and ghosts of its own, in this order or another.
const std::string linkage = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0], fixed = true}, {name = "G", position = [0.2, -1.1, 0.3], fixed = true},
  {name = "B", position = [0.6, 0.8, 0.1], velocity = [0.8, -0.6, 0], mass = 0.7},
  {name = "C", position = [1.5, 1.1, 0.5], velocity = [0, 0.4, 0.9], mass = 1.1},
  {name = "P", position = [2, 2, 1], fixed = true}]
rods = [{name = "a", nodes = ["A", "B"], mass = 0.9}, {name = "b", nodes = ["B", "C"], mass = 0.6}]
[gravity]
acceleration = [0.3, -0.4, -9.1]
[solver]
stages = 4
step = 0.005
end_time = 0.1
)";

std::vector<std::string> entries() {
  return {R"(kind = "spring"
nodes = ["P", "C"]
stiffness = 43
damping = 1.7
free_length = 0.8)",
          R"(kind = "torsion_spring"
nodes = ["G", "A", "B"]
axis = [0, 0, 1]
stiffness = 7.1
free_angle = 400)",
          R"(kind = "motor"
name = "one"
nodes = ["G", "A", "B"]
axis = [0, 0, 1]
stall_torque = 2.9
no_load_speed = 700
gear_ratio = 1.3
control = "position"
proportional = 5.1
integral = 31
derivative = 0.3
motion = "rate"
rate = 37
inertia = 0.17)",
          R"(kind = "motor"
name = "two"
nodes = ["A", "B", "C"]
axis = [0, 0.6, 0.8]
stall_torque = 3.3
no_load_speed = 500
control = "position"
proportional = 4.1
integral = 23)",
          R"(kind = "winch"
name = "winch"
nodes = ["P", "B"]
stall_torque = 0.9
no_load_speed = 900
drum_radius = 0.07
inertia = 0.002
axial_stiffness = 310
length = 1.7
damping = 2.1)",
          R"(kind = "cable"
nodes = ["G", "B", "C"]
axial_stiffness = 270
length = 2.6
motion = "rate"
rate = -0.3)",
          R"(kind = "combination"
terms = ["1 length G C", "-0.6 angle A B C", "0.4 coordinate B along 0.6 0 0.8"]
stiffness = 19
free_value = 0.7)",
          R"(kind = "drag"
nodes = ["C"]
damping = 0.9)",
          R"(kind = "joint_damping"
nodes = ["B"]
damping = 0.23)",
          R"(kind = "load_over_time"
nodes = ["B"]
force = [1.3, -2, 0.7]
times = [0, 0.2]
values = [1, 3])",
          R"(kind = "follower"
rod = "b"
force = -3.1)",
          R"(kind = "friction"
nodes = ["A", "B", "C"]
axis = [0.6, 0, 0.8]
kinetic = 0.31)",
          R"(kind = "offload"
nodes = ["C"]
length = 3)"};
}

}  // namespace

TEST_CASE("the order in which forces are told changes no motion and no work") {
  const auto run = [](const std::vector<std::string>& all) {
    std::string text = linkage;
    for (const std::string& entry : all) text += "[[forces]]\n" + entry + "\n";
    return run_scene(text);
  };
  std::vector<std::string> all = entries();
  const Simulation told = run(all);
  INFO(told.message);
  REQUIRE(told.status == RunStatus::completed);
  std::ranges::reverse(all);
  const Simulation reversed = run(all);
  std::rotate(all.begin(), all.begin() + 5, all.end());
  const Simulation rotated = run(all);
  const Diagnostics d = diagnose(told);
  CHECK(testing::largest(d, "energy_balance_J") < 1e-6);  // step^6, with rates of some 100 1/s
  CHECK(std::abs(d.at("work_J").values.back()) > 0.1);
  for (const Simulation* other : {&reversed, &rotated}) {
    REQUIRE(other->status == RunStatus::completed);
    // Round-off of 20 steps, and where the iteration of each ends.
    CHECK((end_positions(*other) - end_positions(told)).head<15>().norm() < 1e-11);
    for (const char* column : {"work_J", "dissipated_J", "potential_energy_J"})
      CHECK(diagnose(*other).at(column).values.back() == Approx(d.at(column).values.back()).epsilon(1e-9));
  }
}

}  // namespace force_sums_test
