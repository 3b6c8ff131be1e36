// SPDX-License-Identifier: BSD-3-Clause
// Rings at and next to their flat pose, in which the constraints lose rank.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "core/integrators/integrator.hpp"
#include "core/path/path_run.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"

using namespace unfurl;

namespace flat_pose_test {

namespace {

Simulation ring(const std::vector<std::string>& changes, const std::string& model = "full",
                bool on_path = false) {
  std::vector<std::string> all = changes;
  all.push_back("structure.model=" + model);
  const Scene scene = read_scene_file(find_scene("hoop6"), all);
  const auto built = build_model(scene);
  return on_path ? simulate_on_path(built, scene.solver) : simulate(built, scene.solver);
}

// The largest axial force of the last state.
double last_force(const Simulation& run) {
  const std::size_t n = run.trajectory.size();
  const Simulation piece{.trajectory = run.trajectory.part(n - 6, n, run.options), .options = run.options};
  return diagnose(piece).axial_force.row(5).maxCoeff();
}

}  // namespace

// Led to rest in the flat pose by u^3 (10 - 15 u + 6 u^2), a ring is next to it for a percent of the way: it
// is deployed when the drive has come to its end.
TEST_CASE("a ring whose drive ends in the flat pose is deployed then, with every method") {
  for (const double duration : {1.0, 3.0, 10.0})
    for (const int units : {3, 6})
      for (const std::string then : {"stop", "latch"}) {
        const std::vector<std::string> led = {
            "structure.units=" + std::to_string(units), "solver.at_deployed=" + then,
            "constraints[0]={kind=\"angle\", fold_angle=true, motion=\"smooth\", to=0.0, duration=" +
                std::to_string(duration) + "}",
            "solver.end_time=" + std::to_string(1.2 * duration),
            "solver.step=" + std::to_string(duration / 150)};
        for (const Method& method : methods()) {
          if (then == "latch" && duration != 3) continue;
          auto by = led;
          by.push_back("solver.method=" + std::string(method.name));
          const Simulation run = ring(by);
          CAPTURE(duration, units, then, method.name, run.message);
          CHECK(run.status == (then == "stop" ? RunStatus::deployed : RunStatus::completed));
          REQUIRE_FALSE(run.events.empty());
          CHECK(run.events[0].t == Approx(duration).epsilon(1e-12));
          // Flat, and at rest.
          if (then == "stop") {
            const std::size_t last = run.trajectory.size() - 1;
            double low = 1e9, high = -1e9;
            const VectorXd q = run.trajectory.positions(last);
            for (Index i = 2; i < q.size(); i += 3) low = std::min(low, q[i]), high = std::max(high, q[i]);
            CHECK(run.trajectory.velocities(last).lpNorm<Eigen::Infinity>() <= 1e-9);
            CHECK(run.trajectory.end_time() == Approx(duration).epsilon(1e-12));
            CHECK(high - low == Approx(1.2).epsilon(0).margin(1e-7));  // the length of a post
          }
        }
        if (then == "stop") CHECK(ring(led, "full", true).events.at(0).t == Approx(duration).epsilon(1e-12));
      }
}

// Nothing of what acts in it may be read off the nearest poses by fits that have nothing but their round-off:
// (2 m_1 + m_2 / 2) k l_1 theta'^2 / (2 sin(pi / n)), theta'^2 = 3 f sin(theta_0) / (l_1 m_1), but for shares
// of (pi / n)^2, 4e-4 of it. One sector alone has 1e-6 of that round-off.
TEST_CASE("forces in the flat pose of a ring of 150 units are those of its sector") {
  const double m1 = 3000 * 9e-4 * 3, m2 = 3000 * 9e-4 * 1.2, k = 1 / std::sin(M_PI / 150);
  for (const double fold : {30.0, 60.0}) {
    const std::vector<std::string> changes = {"structure.units=150",
                                              "structure.fold_angle=" + std::to_string(fold),
                                              "solver.stages=4", "solver.step=0.02", "solver.end_time=400"};
    const double rate2 = 3 * 200 * std::sin(fold * M_PI / 180) / (3 * m1),
                 about = (2 * m1 + m2 / 2) * k * 3 * rate2 * k / 2;
    const double sector = last_force(ring(changes, "sector"));
    const Simulation full = ring(changes);
    CAPTURE(fold, full.warnings);
    CHECK(sector == Approx(about).epsilon(1e-3));
    CHECK(last_force(full) == Approx(about).epsilon(1e-2));
    CHECK(full.warnings.empty());
  }
}

// A run that ends within a tenth of a millisecond of it has nothing behind its last state to tell its forces
// by.
TEST_CASE("forces of a last state next to the flat pose are those of the motion") {
  for (const int units : {6, 12})
    for (const char* end : {"4.91", "4.919", "4.9199", "4.91997"}) {
      const std::vector<std::string> changes = {"structure.units=" + std::to_string(units), "solver.stages=5",
                                                std::string("solver.end_time=") + end};
      const Simulation full = ring(changes), sector = ring(changes, "sector");
      CAPTURE(units, end);
      const MatrixXd of_full = diagnose(full).axial_force, of_sector = diagnose(sector).axial_force;
      // Chords, which carry most, are alike; of 4 % round-off one in a thousand is left.
      CHECK(of_full.row(of_full.rows() - 1).maxCoeff() ==
            Approx(of_sector.row(of_sector.rows() - 1).maxCoeff()).epsilon(1e-3));
      CHECK(of_full.row(of_full.rows() - 1).minCoeff() ==
            Approx(of_sector.row(of_sector.rows() - 1).minCoeff()).epsilon(1e-3));
    }
}

// The positions of a family have all digits that there are.
TEST_CASE("a ring that starts next to a pose that loses rank is not told to give more digits") {
  for (const char* fold : {"89.99999", "89.999999", "1e-5", "1e-7"}) {
    const Simulation run =
        ring({std::string("structure.fold_angle=") + fold, "solver.stages=4", "solver.end_time=0.1"});
    CAPTURE(fold, run.message);
    for (const std::string& warning : run.warnings) CHECK(warning.find("digits") == std::string::npos);
    CHECK(run.message.find("digits") == std::string::npos);
  }
}

}  // namespace flat_pose_test
