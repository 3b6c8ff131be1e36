// SPDX-License-Identifier: BSD-3-Clause
// Times and poses along the path of a rod that turns about its end, of which s is sqrt(I) times the angle.
#include "core/path/path_time.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/structure/node_positions.hpp"
#include "core/study/table.hpp"
#include "tests/support/one_freedom.hpp"

using namespace unfurl;

namespace path_time_test {

namespace {

constexpr double mass = 1.7, length = 0.8, degrees = pi / 180;
const double root_inertia = std::sqrt(mass * length * length / 3);

// O at the origin, P at (cos a, 0, -sin a) * length.
struct Rod {
  std::shared_ptr<const Model> model;
  std::unique_ptr<Path> path;
  double start, way;  // angle at s = 0; which way it grows with s

  explicit Rod(double angle) : start(angle) {
    model = build_model(read_scene_text(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = "
        "true}, {name = 'P', position = [" +
            exact_number(length * std::cos(angle)) + ", 0, " + exact_number(-length * std::sin(angle)) +
            "]}]\nrods = [{nodes = ['O', 'P'], mass = " + exact_number(mass) +
            "}]\n[[constraints]]\nkind = 'plane'\nnodes = ['P']\nnormal = "
            "[0, 1, 0]\n",
        "rod.toml", {}));
    path = std::make_unique<Path>(std::shared_ptr<const System>(model, &model->system),
                                  model->system.reduce(node_positions(model->structure)));
    VectorXd z, tangent, q(6);
    REQUIRE(path->point(0.1, z, tangent));
    model->system.expand(z, q);
    way = std::cos(start) * -q[5] - std::sin(start) * q[3] > 0 ? 1 : -1;
  }
  double s(double angle) const { return way * root_inertia * (angle - start); }
};

// At P, of `weight` newtons at the middle of the rod downwards.
VectorXd force(double weight) {
  VectorXd f = VectorXd::Zero(6);
  f[5] = -0.5 * weight;
  f[2] = -0.5 * weight;
  return f;
}

}  // namespace

TEST_CASE("the time from rest is the quadrature of the energy over however many pieces of the path") {
  for (const double at : {20.0, -115.0}) {
    const Rod rod(at * degrees);
    for (const double weight : {13.0, -4.1})
      for (const auto& [from, to] : {std::pair{20.0, 20.7}, std::pair{-55.0, 71.0}, std::pair{-89.0, 88.0},
                                     std::pair{37.0, 140.0}, std::pair{75.0, 99.0}}) {
        const double up = weight > 0 ? 0.0 : 180.0;  // the other way up: angles counted from there
        const double a = from * degrees, b = to * degrees, turned = up * degrees;
        CAPTURE(at, weight, from, to);
        const exact::OneFreedom exact{[](double) { return root_inertia * root_inertia; },
                                      [&](double x) {  // weight * length / 2 * (sin(a + x) - sin a)
                                        return std::abs(weight) * length * std::cos(a + 0.5 * x) *
                                               std::sin(0.5 * x);
                                      }};
        // 1e-18 of the quadrature, 1e-15 of the path; hardly more where it hardly falls at first.
        const double time = exact.time(b - a);
        CHECK(time_from_rest(*rod.path, force(weight), rod.s(a + turned), rod.s(b + turned)) ==
              Approx(time).epsilon(1e-11));
        // Back from the other side, mirrored.
        CHECK(time_from_rest(*rod.path, force(weight), rod.s(pi - a + turned), rod.s(pi - b + turned)) ==
              Approx(time).epsilon(1e-11));
      }
    // The other way, and beyond where it turns: from 20 degrees below on one side to as far on the other.
    CHECK(std::isnan(time_from_rest(*rod.path, force(13), rod.s(20 * degrees), rod.s(10 * degrees))));
    CHECK(std::isnan(time_from_rest(*rod.path, force(13), rod.s(20 * degrees), rod.s(161 * degrees))));
    CHECK(std::isnan(time_from_rest(*rod.path, force(13), rod.s(160 * degrees), rod.s(12 * degrees))));
  }
}

// x of P is length * cos(angle); what deploys it lies ahead where it comes there from its stowed side.
TEST_CASE("the deployed pose is the first that is come to from the stowed side both ways") {
  for (const double at : {20.0, 75.0, 200.0, -70.0}) {
    const Rod rod(at * degrees);
    Deployment d;
    d.measured = true;
    d.measure = {MeasureKind::coordinate, {1}, Vec3::UnitX(), 0.0, {}};
    for (const auto& [stowed, deployed] : {std::pair{0.3, 0.8}, std::pair{0.9, 0.4}, std::pair{-0.2, -0.7}}) {
      CAPTURE(at, stowed, deployed);
      d.stowed = stowed * length, d.deployed = deployed * length;
      const double pose = std::acos(deployed) / degrees;
      // Towards the deployed side x passes there at `pose` or at -pose, by its sense; going on by a turn.
      const bool rises = deployed > stowed;
      for (const bool forward : {true, false}) {
        const double sense = forward ? rod.way : -rod.way;  // of the angle
        // cos falls where the angle grows beyond 0: it rises to `deployed` at -pose on the way up.
        double angle = (rises ? -1 : 1) * sense * pose;
        while (sense * (angle - at) <= 0) angle += sense * 360;
        while (sense * (angle - at) > 360) angle -= sense * 360;
        const auto found = deployed_pose(*rod.path, d, forward, 100);
        REQUIRE(found);
        CHECK(*found == Approx(rod.s(angle * degrees)).epsilon(1e-12));
        CHECK_FALSE(deployed_pose(*rod.path, d, forward, 0));
      }
    }
    d.stowed = 0.1, d.deployed = 1.001 * length;
    CHECK_FALSE(deployed_pose(*rod.path, d, true, 30));
    d.deployed = length;  // touched, not passed, as far from the turn as the root of rounding
    const auto touched = deployed_pose(*rod.path, d, true, 100);
    REQUIRE(touched);
    const double turns = (rod.start + rod.way * *touched / root_inertia) / (2 * pi);
    CHECK(std::abs(turns - std::round(turns)) < 1e-6);
    CHECK(std::abs(*touched) <= 2 * pi * root_inertia * (1 + 1e-6));
  }
}

TEST_CASE("a pose is found on the path on either side of its start and one beside the path is not") {
  for (const double at : {20.0, 200.0, -70.0}) {
    const Rod rod(at * degrees);
    const auto pose = [&](double angle, double far) {
      VectorXd q = VectorXd::Zero(6);
      q[3] = far * length * std::cos(angle);
      q[5] = -far * length * std::sin(angle);
      return rod.model->system.reduce(q);
    };
    for (const double turn : {0.013, 0.7, 2.3, -0.019, -0.6, -2.1}) {
      CAPTURE(at, turn);
      const double angle = rod.start + turn;
      const auto found = rod.path->locate(pose(angle, 1), 20);
      REQUIRE(found);
      // Coordinates of 1 m at rounding.
      CHECK(*found == Approx(rod.s(angle)).epsilon(0).margin(1e-13));
      CHECK_FALSE(rod.path->locate(pose(angle, 1 + 1e-7), 20));
      if (std::abs(turn) > 2) CHECK_FALSE(rod.path->locate(pose(angle, 1), 1));
    }
  }
}

TEST_CASE("the first time at which something is above zero is seen at edges and before jumps") {
  const auto rise = [](double t) { return t * t - 0.7; };
  for (const double h : {0.01, 0.13, 5.0})
    CHECK(first_time_above(rise, 0.1, 2.3, h, {}) == Approx(std::sqrt(0.7)).epsilon(1e-14));
  CHECK(first_time_above(rise, 0.1, 0.6, 0.05, {}) == 0.6);
  CHECK(first_time_above(rise, 0.1, 0.9, 5, {}) == Approx(std::sqrt(0.7)).epsilon(1e-14));
  // A peak of 1 ms at 0.413: up from -1 to 1, where it is seen, and down.
  const auto peak = [](double t) { return 1 - 2 * std::abs(t - 0.413) / 1e-3; };
  const std::vector<TimeEdge> corners{{0.2}, {0.412}, {0.413}, {0.414}, {0.9}};
  for (const double from : {0.0, 0.2, 0.3, 0.412})
    CHECK(first_time_above(peak, from, 1.7, 0.25, corners) == Approx(0.4125).epsilon(1e-14));
  CHECK(first_time_above(peak, 0.4138, 1.7, 0.25, corners) == 1.7);
  // It rises through 0.4 and jumps away at 0.55; from then on it is what it was before.
  const auto falls = [](double t) { return t < 0.55 ? t - 0.4 : -1.0; };
  for (const double h : {0.5, 0.26})
    CHECK(first_time_above(falls, 0.3, 1.2, h, {{0.35}, {0.55, true}, {0.8}}) == Approx(0.4).epsilon(1e-14));
  const auto jumps = [](double t) { return t < 0.55 ? t - 0.6 : 0.3; };
  CHECK(first_time_above(jumps, 0.3, 1.2, 0.5, {{0.35}, {0.55, true}, {0.8}}) == Approx(0.55).epsilon(1e-14));
  const auto never = [](double t) { return t < 0.55 ? t - 0.6 : -0.3; };
  CHECK(first_time_above(never, 0.3, 1.2, 0.5, {{0.35}, {0.55, true}, {0.8}}) == 1.2);
}

}  // namespace path_time_test
