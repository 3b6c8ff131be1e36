// SPDX-License-Identifier: BSD-3-Clause
// The ring that a cable draws open, and the net on it.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "core/structure/node_positions.hpp"
#include "core/structures/force_density.hpp"
#include "core/system/mobility.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace cable_ring_test {

namespace {

using testing::error_of, testing::model_of, testing::run_scene;

const std::string ring = R"(
[structure]
kind = "cable_ring"
units = 6
longeron_length = 1.7
post_length = 0.8
fold_angle = 77
cable_rate = 0.6
cable_ramp = 1.5
joint_damping = 4
[solver]
stages = 3
step = 0.02
)";

double path(double fold_deg) {
  return 6 * std::sqrt(1.7 * 1.7 + 0.8 * 0.8 + 2 * 1.7 * 0.8 * std::sin(fold_deg * pi / 180));
}

}  // namespace

// What is drawn in by t is rate (t - ramp / 2): the ring is deployed when that is the difference of the
// paths.
TEST_CASE("a ring drawn open by a cable is deployed when so much of it is drawn in") {
  const Simulation run = run_scene(ring);
  REQUIRE(run.status == RunStatus::deployed);
  const double t = 0.75 + (path(77) - path(0)) / 0.6;
  CHECK(run.trajectory.end_time() == Approx(t).epsilon(1e-6));
  // On the way the fold angle follows the cable.
  const std::size_t i = run.trajectory.size() / 2;
  const double left = path(77) - 0.6 * (run.trajectory.time(i) - 0.75);
  const double sine = (left * left / 36 - 1.7 * 1.7 - 0.8 * 0.8) / (2 * 1.7 * 0.8);
  CHECK(run.trajectory.structure().deployment.fold_angle(run.trajectory.node_positions(i)) ==
        Approx(std::asin(sine)).epsilon(0).margin(1e-9));
}

// A ring of n bays has 2 n longerons, each with two ends that turn against a batten by the fold angle: the
// power is 4 n c rate^2. By trapezia, off by h^2 / 12 of the curve's bends.
TEST_CASE("dampers act at both ends of every longeron of a ring that a cable draws") {
  const double c = 1.7;
  for (const char* kind : {"cable_ring", "mesh_reflector"}) {
    INFO(kind);
    const bool nets = std::string(kind) == "mesh_reflector";
    const Simulation run =
        run_scene("[structure]\nkind = '" + std::string(kind) +
                  "'\nunits = 6\nfold_angle = 70\ncable_ramp = 0.5\njoint_damping = " + testing::number(c) +
                  (nets ? "\nnets = false" : "") + "\n[solver]\nstages = 4\nstep = 0.01\nend_time = 2\n");
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    const std::vector<double>&rate = d.at("fold_rate_rad_s").values, &lost = d.at("dissipated_J").values;
    double squares = 0;
    for (std::size_t i = 0; i + 1 < rate.size(); ++i)
      squares += 0.5 * (d.t[i + 1] - d.t[i]) * (rate[i] * rate[i] + rate[i + 1] * rate[i + 1]);
    CHECK(lost.back() == Approx(4 * 6 * c * squares).epsilon(1e-4));
  }
}

TEST_CASE("gears leave a ring of bays one freedom, without them it has one for each bay but three more") {
  const auto freedom = [](const std::vector<std::string>& changes) {
    const auto model = model_of(ring, changes);
    return analyse_mobility(model->system, node_positions(model->structure)).degrees_of_freedom;
  };
  CHECK(freedom({}) == 6 + 1);  // of them 6 as a whole
  // Each post holds the bays beside it, though one of the six is redundant.
  int holds = 0;
  const auto model = model_of(ring);
  for (const Constraint& c : model->structure.constraints) holds += c.name.starts_with("bays at post B");
  CHECK(holds == 6);
  CHECK(freedom({"structure.gears=false"}) == 6 + 6 - 3);
}

TEST_CASE("rings that cannot be are refused") {
  CHECK(error_of(ring, {"structure.units=7"}).find("units: must be even") != std::string::npos);
  CHECK(error_of("[structure]\nkind = 'mesh_reflector'\nfocal_length = 0.5\n")
            .find("would meet in the middle") != std::string::npos);
}

// Schek's example: a chain of equal densities under equal loads. D x = f is then the second difference of x,
// constant: x lies on a parabola, exactly.
TEST_CASE("equal force densities under equal loads put nodes on a parabola") {
  const int n = 17;
  std::vector<NetMember> members;
  std::vector<bool> fixed(n + 1, false);
  fixed.front() = fixed.back() = true;
  std::vector<Vec3> loads(n + 1, Vec3(0, 0, -0.3)), x(n + 1, Vec3::Zero());
  x.front() = Vec3(0, 0, 1);
  x.back() = Vec3(5, 0, 2);
  for (int i = 0; i < n; ++i) members.push_back({i, i + 1, 2.5});
  find_form(members, fixed, loads, x);
  for (int i = 0; i <= n; ++i) {
    const double u = i;  // z'' = 0.3 / 2.5 per node squared
    CHECK(x[static_cast<std::size_t>(i)][0] == Approx(5 * u / n).epsilon(0).margin(1e-13));
    CHECK(x[static_cast<std::size_t>(i)][2] ==
          Approx(1 + u / n - 0.5 * 0.3 / 2.5 * u * (n - u)).epsilon(0).margin(1e-12));
  }
  members.erase(members.begin() + 3);
  members.erase(members.begin() + 9);
  CHECK_THROWS_WITH(find_form(members, fixed, loads, x), Catch::Contains("hang on nothing"));
}

// What an error advises must help; a net of one ring has no edge where the rim's longerons are one.
TEST_CASE("nets find room in a rim that is folded as the error says") {
  const std::string text = "[structure]\nkind = 'mesh_reflector'\n";
  for (const char* fold : {"5", "20"}) {
    INFO(fold);
    const std::string said = error_of(text, {std::string("structure.fold_angle=") + fold});
    CHECK_THAT(said, Catch::Contains("fold it more, or take"));
  }
  CHECK(error_of(text, {"structure.fold_angle=40"}).empty());
  for (const char* hoop : {"cable_ring", "hoop"}) {
    INFO(hoop);
    const std::vector<std::string> one{"structure.net_rings=1", std::string("structure.hoop=") + hoop};
    REQUIRE(error_of(text, one).empty());
    const auto folded = model_of(text, one);
    long members = 0;
    for (const Force& f : folded->structure.forces) members += f.name == "net";
    CHECK(members == 2 * 6 + 1 + (std::string(hoop) == "hoop" ? 2 * 6 : 0));  // spokes, a tie, edges
    const VectorXd q = node_positions(folded->structure);
    VectorXd f = VectorXd::Zero(q.size());
    if (std::string(hoop) == "cable_ring") {
      folded->system.add_applied_force(0.0, q, VectorXd::Zero(q.size()), 1.0, f);
      CHECK(f.isZero(0.0));
    }
  }
}

// Latched and at rest the nets hang in the form that was found: no node feels a force.
TEST_CASE("nets are slack when folded and on their paraboloid when deployed") {
  const std::string text =
      "[structure]\nkind = 'mesh_reflector'\nunits = 6\nnet_rings = 3\nfocal_length = 5\nfold_angle = 70\n";
  const auto folded = model_of(text);
  const Structure& s = folded->structure;
  const VectorXd q = node_positions(s);
  VectorXd f = VectorXd::Zero(q.size());
  folded->system.add_applied_force(0.0, q, VectorXd::Zero(q.size()), 1.0, f);
  CHECK(f.isZero(0.0));
  CHECK(s.surfaces.at(0).rms(q) > 0.01);
}

// Nets of one ring on a rim of radius R = 1.6 m: a node in the middle, drawn to the six corners above it by
// spokes and to the other net by its tie. At rest in the deployed rim every spoke pulls with q times its
// length, whether that stretches it by more than the smoothed part of its law or by far less, where members
// had pulled with up to 2.5 times as much and the surface was off its paraboloid.
TEST_CASE("nets pull with their force density when deployed, however far the smoothing goes") {
  const double R = 1.6, half = 1.1, focal = 6, vertex = half - R * R / (4 * focal);
  for (const double smoothing : {1e-7, 1e-4, 3e-4, 1e-3, 1e-2})
    for (const double density : {0.5, 5.0}) {
      INFO("smoothing " << smoothing << " m, " << density << " N/m");
      const auto model = model_of(
          "[structure]\nkind = 'mesh_reflector'\nunits = 6\nlongeron_length = 1.6\npost_length = "
          "2.2\nnet_rings = 1\nfocal_length = 6\nfold_angle = 70\nsmoothing = " +
          testing::number(smoothing) + "\nforce_density = " + testing::number(density) + "\n");
      const Structure& s = model->structure;
      VectorXd q = node_positions(s);
      std::vector<Vec3> wanted(s.nodes.size(), Vec3::Zero());
      for (std::size_t i = 0; i < s.nodes.size(); ++i) {
        const std::string& name = s.nodes[i].name;
        const double side = name[0] == 'F' || name[0] == 'T' ? 1 : -1;
        const Vec3 middle(0, 0, side * vertex);
        Vec3 x = middle;
        if (name[0] == 'T' || name[0] == 'B') {
          const double angle = 2 * pi * std::stoi(name.substr(1)) / 6;
          x = Vec3(R * std::cos(angle), R * std::sin(angle), side * half);
          wanted[i] = density * (middle - x);
        }
        q.segment<3>(static_cast<Index>(3 * i)) = x;
      }
      VectorXd f = VectorXd::Zero(q.size());
      model->system.add_applied_force(0.0, q, VectorXd::Zero(q.size()), 1.0, f);
      // Rounding of metres over the smoothing, but E A = 2000 N over the lengths: 1e-12 N; of the tie twice
      // that.
      for (std::size_t i = 0; i < s.nodes.size(); ++i)
        CHECK((f.segment<3>(static_cast<Index>(3 * i)) - wanted[i]).norm() <= 1e-11);
    }
}

// The rim's radius is R = 1.6 m (six longerons of 1.6 m), and both nets are a post of 2.2 m apart there: each
// falls by R^2 / (4 f) and they meet in the middle for f = R^2 / (2 post).
TEST_CASE("a reflector whose nets would meet says which focal length, or which post, keeps them apart") {
  const auto error = [](double post, double focal) -> std::string {
    try {
      model_of(
          "[structure]\nkind = 'mesh_reflector'\nunits = 6\nlongeron_length = 1.6\nnet_rings = 2\n"
          "fold_angle = 30\npost_length = " +
          std::to_string(post) + "\nfocal_length = " + std::to_string(focal) + "\n");
    } catch (const std::exception& e) {
      return e.what();
    }
    return "";
  };
  const Catch::Matchers::StdString::ContainsMatcher short_one = Catch::Contains("is too short");
  CHECK_THAT(error(2.2, 0.5), Catch::Contains("it must be > 0.581818 m, or post_length > 2.56 m"));
  CHECK_THAT(error(0.1, 6), Catch::Contains("it must be > 12.8 m, or post_length > 0.213333 m"));
  // Beyond, whatever else such a net lacks.
  for (const auto& [post, focal] :
       {std::pair(2.2, 0.59), std::pair(2.57, 0.5), std::pair(0.22, 6.0), std::pair(0.1, 12.9)})
    CHECK_THAT(error(post, focal), !short_one);
}

// Members strike all the way, at frequencies of 600 rad/s: a pose of the deployed event that is extrapolated
// over more than their period would shake them with energy out of nothing, 2 J and more. (3 s: no deployment
// with nets is shorter.)
TEST_CASE("a reflector deploys, latches and settles near its paraboloid, and its books close") {
  const Simulation run = run_scene(R"(
[structure]
kind = "mesh_reflector"
units = 6
longeron_length = 1.6
post_length = 2.2
fold_angle = 30
cable_rate = 1.3
net_rings = 2
[solver]
stages = 3
step = 0.002
at_deployed = "latch"
end_time = 3.9
)");
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  REQUIRE(run.events.size() >= 2);
  CHECK(run.events.back().kind == "latch");
  const Diagnostics d = diagnose(run);
  // Strikes last some 1 mm / 0.3 m/s, two steps of order 4; 2 J are turned over.
  CHECK(d.at("drive_work_J").values.back() > 2);
  CHECK(testing::largest(d, "energy_balance_J") <= 2e-4);
  // Round-off of 2 m, in the deployed pose too, which is extrapolated from shaken ones.
  CHECK(testing::largest(d, "constraint_max_m") <= 1e-12);
  // 100 mm and more when folded; then nets in motion of 0.1 J against E A = 2000 N.
  CHECK(d.at("surface_rms_m").values.front() > 0.1);
  CHECK(d.at("surface_rms_m").values.back() < 0.02);
}

// Members of a large net are short, and its members go taut at h omega = 1 to 3. Pulled open within a few
// steps: the iteration converges in every one, the energy of the drive is found again.
TEST_CASE("a net of two thousand members on a ring of eighteen bays goes taut without a step that fails") {
  const Simulation run = run_scene(R"(
[structure]
kind = "mesh_reflector"
units = 18
net_rings = 6
focal_length = 18
fold_angle = 15
cable_rate = 3.9
cable_ramp = 0.3
[solver]
stages = 3
step = 0.002
end_time = 0.13
)");
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.trajectory.size() <= 70);  // 65 steps, the start and what events add
  const Diagnostics d = diagnose(run);
  CHECK(testing::largest(d, "constraint_max_m") <= 1e-12);
  // Order 4 in steps that members take three of to begin to pull.
  CHECK(testing::largest(d, "energy_balance_J") <= 1e-4 * d.at("drive_work_J").values.back());
}

}  // namespace cable_ring_test
