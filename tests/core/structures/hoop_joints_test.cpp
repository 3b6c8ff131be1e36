// SPDX-License-Identifier: BSD-3-Clause
// The hoop without planes of symmetry: closed or an arc, driven evenly or not, floating free.
#include "core/structures/hoop_joints.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/diagnostics/accuracy.hpp"
#include "core/simulate/stepper.hpp"
#include "core/system/mobility.hpp"
#include "tests/support/deployment_check.hpp"
#include "tests/support/family_structure.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace hoop_joints_test {

namespace {

const std::string joints = "joints";

// Momentum and angular momentum about the origin, sum of x_i x (M v)_i: exact for uniform rods, whose
// consistent mass matrix is that of a rigid rod.
Eigen::Matrix<double, 6, 1> momenta(const Trajectory& t, std::size_t i) {
  const VectorXd q = t.node_positions(i), p = t.model().system.node_mass() * t.node_velocities(i);
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  for (Index k = 0; k < q.size(); k += 3) {
    sum.head<3>() += p.segment<3>(k);
    sum.tail<3>() += q.segment<3>(k).cross(p.segment<3>(k));
  }
  return sum;
}

}  // namespace

TEST_CASE("joints alone leave a hoop of p posts 3 p + 2 degrees of freedom") {
  for (const bool closed : {true, false})
    for (const long n : {3L, 5L, 8L}) {
      const Structure s = family_structure(
          "hoop", {{"model", joints}, {"closed", closed}, {"units", n}, {"fold_angle", 50.0}});
      INFO(n << " units");
      const Mobility m = analyse_mobility(System(s, true), node_positions(s));
      const Index posts = closed ? n : n + 1;
      CHECK(m.coordinates == 6 * posts + 6 * n);
      CHECK(m.degrees_of_freedom == 3 * posts + 2);
      CHECK(m.rigid_motions == 6);
      CHECK(static_cast<Index>(m.redundant.size()) == posts - 1);  // parallel posts: one length is enough
    }
}

TEST_CASE("an evenly driven ring of joints moves as the symmetric one") {
  const Changes changes = {{"model", joints}, {"units", 5L}, {"fold_angle", 75.0}, {"chord_rod_length", 1.5}};
  const exact::Hoop hoop = exact_hoop(changes);
  const double end = 0.9 * hoop.time(0);
  const Simulation run =
      simulate(make_model(family_structure("hoop", changes)), dvm_options(4, end / 200, end));
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  // Order 6 with 200 steps: 1e-10 or so; the free shapes of the polygon are driven by round-off only.
  for (std::size_t i = 20; i < d.t.size(); i += 20) {
    const double theta = d.at("fold_angle_rad").values[i];
    CHECK(std::abs((hoop.time(theta) - d.t[i]) * hoop.rate(theta)) <= 1e-8);
  }
  CHECK(largest(d.at("constraint_relative_max")) <= 1e-13);
}

TEST_CASE("an unevenly driven arc floats without momentum and keeps its energy balance") {
  const Simulation run = simulate(make_model(family_structure("hoop", {{"model", joints},
                                                                       {"closed", false},
                                                                       {"units", 4L},
                                                                       {"arc_angle", 150.0},
                                                                       {"fold_angle", 70.0},
                                                                       {"perturbed_unit", 0L},
                                                                       {"perturbed_force", 60.0}})),
                                  dvm_options(4, 0.01, 1.0));
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  // Round-off of coordinates of several rods' lengths. Order 6 at a hundredth of the motion's second: 1e-12,
  // and ten thousandfold.
  CHECK(largest(d.at("constraint_relative_max")) <= 1e-13);
  CHECK(largest(d.at("energy_balance_J")) <= 1e-8 * largest(d.at("work_J")));
  // Every unit's forces cancel, and so do their moments as long as its hinges stand above each other, which
  // the mirror plane z = 0 of the loads makes them do. Bars of some 100 kg at 1 m/s: round-off of 1e-13 a
  // step, 100 steps.
  const double size = 100.0;
  for (std::size_t i = 0; i < run.trajectory.size(); i += 20)
    CHECK(momenta(run.trajectory, i).cwiseAbs().maxCoeff() <= 1e-9 * size);
  // Driven evenly, units 0 and 3, at the ends, would mirror each other. Unit 0 lags: its hinges are less
  // unfolded.
  const VectorXd q = run.trajectory.positions(run.trajectory.size() - 1);
  const auto sag = [&](Index k) { return q[3 * (4 * k + 2) + 2] - q[3 * (4 * k) + 2]; };
  CHECK(sag(0) > sag(3) + 0.1);
}

TEST_CASE("what only joints allow is refused to the symmetric models") {
  CHECK(refusal("hoop", {{"closed", false}}) ==
        "closed: an open arc has no planes of symmetry: closed = false needs model = \"joints\"");
  CHECK(refusal("hoop", {{"perturbed_unit", 2L}})
            .starts_with("perturbed_unit: planes of symmetry keep all units alike"));
  CHECK(refusal("hoop", {{"model", joints}, {"perturbed_unit", 6L}}) ==
        "perturbed_unit: perturbed_unit = 6 is none of the 6 units, which count from 0");
}

TEST_CASE("the unevenness of a hoop is the farthest that corners and sides are from each other") {
  const Simulation run = run_scene(
      "[structure]\nkind = 'hoop'\nmodel = 'joints'\nunits = 5\n[solver]\nstep = 0.01\nend_time = 0.01\n");
  const Structure& s = run.trajectory.structure();
  const VectorXd even = run.trajectory.node_positions(0);
  const double length = s.rods.front().length, by = 0.01 * length;
  CHECK(unevenness(s, even) <= 1e-14);
  const Index posts = even.size() / 12;
  for (Index k = 0; k < posts; ++k) {
    VectorXd q = even;
    q[12 * k + 2] += by;
    CHECK(unevenness(s, q) == Approx(0.01).epsilon(1e-12));
    // A corner along the side to the next: that one is shorter by as much, the one before at most longer by
    // it.
    const auto corner = [&](Index i) { return Vec3(even.segment<3>(12 * (i % posts))); };
    const Vec3 along = (corner(k + 1) - corner(k)).normalized();
    q = even;
    q.segment<3>(12 * k) += by * along;
    const double side = (corner(k + 1) - corner(k)).norm();
    const double before = (corner(k) + by * along - corner(k + posts - 1)).norm();
    CHECK(unevenness(s, q) == Approx((std::max(before, side) - (side - by)) / length).epsilon(1e-12));
  }
}

TEST_CASE("a ring is driven evenly where all that acts on it is the same for every unit") {
  const Structure ring = testing::model_of(R"(
[structure]
kind = "hoop"
model = "joints"
units = 5
)")
                             ->structure;
  REQUIRE(driven_evenly(ring));
  const auto even = [&](const auto& change) {
    Structure s = ring;
    change(s);
    return driven_evenly(s);
  };
  const auto with = [&](const char* kind, const char* name, MeasureKind measured) {
    return even([&](Structure& s) {
      s.constraints.push_back({kind, name, {}, {}, 0.0, {measured, {}, Vec3::Zero(), 0.0, {}}, {}});
    });
  };
  CHECK(with("coplanar", "any", MeasureKind::length));
  CHECK(with("relation", "post 3", MeasureKind::length));
  CHECK_FALSE(with("relation", "bar 3", MeasureKind::length));
  CHECK_FALSE(with("plane", "post 3", MeasureKind::length));
  CHECK(with("measure", "drive", MeasureKind::fold));  // of all units as one
  CHECK_FALSE(with("measure", "drive", MeasureKind::length));
  CHECK_FALSE(with("relation", "drive", MeasureKind::fold));
  CHECK_FALSE(even(
      [](Structure& s) { s.constraints.front().kind = "relation", s.constraints.front().name = "post 1"; }));
  CHECK_FALSE(even([](Structure& s) { s.constraints.clear(); }));
  CHECK_FALSE(even([](Structure& s) { s.forces.emplace_back(); }));
  CHECK_FALSE(even([](Structure& s) { s.stops.emplace_back(); }));
  CHECK(even([](Structure& s) { s.gravity = Vec3(0, 0, -3); }));
  CHECK_FALSE(even([](Structure& s) { s.gravity = Vec3(0.1, 0, -3); }));
  CHECK_FALSE(even([](Structure& s) { s.gravity = Vec3(0, 0.1, -3); }));
  CHECK_FALSE(even([](Structure& s) { s.kind = "custom"; }));
  // One rod unlike the others of its group, made so or by its temperature.
  CHECK_FALSE(even([](Structure& s) { s.rods.back().length *= 1 + 1e-6; }));
  CHECK_FALSE(even([](Structure& s) { s.rods[7].free_length = s.rods[7].length * (1 - 1e-6); }));
  const auto warm = [](Rod& rod, double change) { rod.expansion = 1e-5, rod.warming.offset = change; };
  CHECK_FALSE(even([&](Structure& s) { warm(s.rods[7], 60); }));
  CHECK(even([&](Structure& s) {
    for (Rod& rod : s.rods) warm(rod, 60);
  }));
  CHECK_FALSE(even([](Structure& s) { s.rods.pop_back(); }));
  CHECK_FALSE(even([](Structure& s) { s.nodes.pop_back(); }));
  const auto loaded = [&](const std::vector<Vec3>& forces) {  // on the same node of every unit
    return even([&](Structure& s) {
      for (std::size_t k = 0; k < forces.size(); ++k)
        s.loads.push_back({static_cast<int>(4 * k + 2), forces[k]});
    });
  };
  CHECK(loaded(std::vector<Vec3>(5, Vec3(0, 0, 2.5))));
  CHECK_FALSE(loaded(std::vector<Vec3>(4, Vec3(0, 0, 2.5))));
  CHECK_FALSE(loaded(std::vector<Vec3>(5, Vec3(0.1, 0, 2.5))));
  CHECK_FALSE(loaded(std::vector<Vec3>(5, Vec3(0, 0.1, 2.5))));
  CHECK(loaded({Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0, 0, 1)}));
}

// A controller pushes one post of a ring that is driven evenly but for that: the motion of the same ring with
// that load, which nothing calls round-off.
TEST_CASE("what a controller pushes on one node of an even ring is no round-off") {
  const std::string ring =
      "[structure]\nkind = 'hoop'\nunits = 5\nmodel = 'joints'\nfold_angle = 64\nhinge_force = 284\n"
      "[solver]\nmethod = 'rk4'\nstep = 0.01\nend_time = 0.5\n";
  const Scene scene = read_scene_text(ring, "ring.toml", {});
  const auto model = build_model(scene);
  const std::vector<Node>& nodes = model->structure.nodes;
  const auto pushed = std::ranges::find(nodes, "Mb2", &Node::name);
  REQUIRE(pushed != nodes.end());
  Stepper stepper(model, scene.solver);
  stepper.set_force(static_cast<int>(pushed - nodes.begin()), Vec3(3, 0, 0));
  while (stepper.step()) {
  }
  Simulation run = stepper.take();
  const Diagnostics d = judge(run);
  INFO(run.message);
  CHECK(run.status == RunStatus::completed);
  const Simulation loaded = run_scene(ring + "[[loads]]\nnodes = ['Mb2']\nforce = [3, 0, 0]\n");
  REQUIRE(run.trajectory.size() == loaded.trajectory.size());
  const std::size_t last = run.trajectory.size() - 1;
  // The same equations by the same steps, 50 of them: round-off of some 1e-15 m each, which the ring
  // magnifies a thousandfold at most so far from its deployed pose.
  CHECK((run.trajectory.positions(last) - loaded.trajectory.positions(last)).lpNorm<Eigen::Infinity>() <
        1e-10);
  // It would have been called round-off.
  CHECK(unevenness(model->structure, run.trajectory.node_positions(last)) > 1e-3);
}

}  // namespace hoop_joints_test
