// SPDX-License-Identifier: BSD-3-Clause
// Which of its solutions a reference is, and what it says of itself.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "core/integrators/dvm.hpp"
#include "core/integrators/integrator.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/study/extrapolation.hpp"
#include "core/study/reference.hpp"
#include "core/study/table.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace reference_levels_test {

namespace {

// Node coordinates at the times of so many intervals, by steps of the extrapolation of 1/parts of one.
std::vector<VectorXd> solution(const Model& model, double end, int intervals, int parts) {
  State state = initial_state(model.structure, model.system).state;
  Extrapolation method(model.system);
  std::vector<VectorXd> out;
  VectorXd q(model.system.coordinates());
  for (int i = 0; i <= intervals * parts; ++i) {
    if (i % parts == 0) {
      model.system.expand(state.z, q);
      out.push_back(q);
    }
    if (i < intervals * parts) REQUIRE(method.step(state, end / (intervals * parts)));
  }
  return out;
}

double apart(const std::vector<VectorXd>& a, const std::vector<VectorXd>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (Index n = 0; n < a[i].size(); n += 3)
      most = std::max(most, (a[i].segment<3>(n) - b[i].segment<3>(n)).norm());
  return most;
}

}  // namespace

// Twice as many steps at each level, until two of them agree as well as is asked for; the other method, dvm,
// is brought as near as that.
TEST_CASE("a reference is the first of its solutions that agrees with the one before as well as is enough") {
  const auto model = make_model(double_pendulum());
  constexpr double end = 1.3;
  int found = 0;
  for (const int intervals : {2, 3, 6}) {
    std::vector<std::vector<VectorXd>> all{solution(*model, end, intervals, 1)};
    for (int level = 1; level < 5; ++level) {
      all.push_back(solution(*model, end, intervals, 1 << level));
      const double d = apart(all[all.size() - 1], all[all.size() - 2]);
      if (!(d < 5e-7) || d < 1e-12) continue;  // as near as a reference has to be, and above round-off
      INFO(intervals << " intervals, level " << level << ": " << d << " m");
      const Reference r = solve_reference(model, end, intervals, {}, 1.5 * d / structure_size(*model));
      CHECK(r.how == "Bulirsch-Stoer extrapolation of order 16 on the index-1 equations with " +
                         std::to_string(intervals << level) + " basic steps");
      // Round-off of some 40 steps, larger than that of single ones by the growth in a swing.
      CHECK(apart(r.q, all.back()) < 1e-12);
      CHECK(r.uncertainty >= 0.999 * d);
      CHECK(r.uncertainty <= 1.5 * d);
      CHECK(r.confirmed);
      REQUIRE(r.t.size() == static_cast<std::size_t>(intervals) + 1);
      for (int i = 0; i <= intervals; ++i)
        CHECK(r.t[static_cast<std::size_t>(i)] == Approx(end * i / intervals).epsilon(1e-15));
      CHECK(r.size == structure_size(*model));
      ++found;
    }
  }
  CHECK(found >= 3);
}

// P goes round O on a stretched spring, m v^2 / r = k (r - l): an angle of v t / r. The spring's own swings
// are too quick for the steps of the extrapolation, which blows up; dvm has none of them.
TEST_CASE("where the extrapolation blows up dvm is the reference and what it says of itself is true") {
  const double mass = 1.7, radius = 1.25, speed = 2.3, end = 0.9, stiffness = 1e5;
  const Vec3 out(0.6, 0, 0.8), along(0.48, 0.8, -0.36);  // unit vectors, at right angles
  const auto triple = [](const Vec3& v) {
    return "[" + exact_number(v.x()) + ", " + exact_number(v.y()) + ", " + exact_number(v.z()) + "]";
  };
  const auto model = build_model(read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name = 'P', "
      "position = " +
          triple(radius * out) + ", velocity = " + triple(speed * along) + ", mass = " + exact_number(mass) +
          "}]\n[[forces]]\nkind = 'spring'\nnodes = ['O', 'P']\nstiffness = " + exact_number(stiffness) +
          "\nfree_length = " + exact_number(radius - mass * speed * speed / (radius * stiffness)) + "\n",
      "round.toml", {}));
  for (const int intervals : {2, 3}) {
    const Reference r = solve_reference(model, end, intervals, {});
    INFO(r.how << ", " << r.uncertainty << " m");
    CHECK_FALSE(r.confirmed);
    int nodes = 0, steps = 0;
    REQUIRE(std::sscanf(r.how.c_str(), "dvm with %d nodes and %d steps", &nodes, &steps) == 2);
    CHECK(r.how.ends_with(" steps, because the index-1 equations do not pass this motion"));
    SolverOptions options;
    options.stages = nodes;
    const auto method = careful_dvm().make(model->system, options);
    State state = initial_state(model->structure, model->system).state;
    for (int i = 0; i < steps; ++i) REQUIRE(method->step(state, end / steps).ok());
    VectorXd q(model->system.coordinates());
    model->system.expand(state.z, q);
    // The spring multiplies what rounding leaves of a step by k h^2 / m, some 100 at most.
    CHECK(node_distance(q, r.q.back()) < 1e-12);
    REQUIRE(r.q.size() == static_cast<std::size_t>(intervals) + 1);
    for (std::size_t i = 0; i < r.q.size(); ++i) {
      const double angle = speed * r.t[i] / radius;
      const Vec3 exact = radius * (std::cos(angle) * out + std::sin(angle) * along);
      CHECK((r.q[i].tail<3>() - exact).norm() < 1e-6 * radius);
      CHECK((r.q[i].tail<3>() - exact).norm() < 1e-11 + 10 * r.uncertainty);
    }
  }
}

// A slide that a drive takes along from some time on, at once.
TEST_CASE("a drive may jump at the ends of a reference and not between them") {
  const auto reference = [](double start) {
    return solve_reference(build_model(read_scene_text(
                               "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0.3, 0.2, "
                               "0.1], mass = 1.5}]\n[[constraints]]\nkind = 'coordinate'\nnodes = "
                               "['P']\ndirection = [1, 0, 0]\nmotion = 'rate'\nrate = 0.7\nstart = " +
                                   exact_number(start) + "\n",
                               "slide.toml", {})),
                           0.9, 3, {});
  };
  for (const double start : {0.0, 0.9, 1.4}) {
    const Reference r = reference(start);
    for (std::size_t i = 0; i < r.q.size(); ++i)
      CHECK(r.q[i].x() == Approx(0.3 + 0.7 * std::max(0.0, r.t[i] - start)).epsilon(1e-13));
  }
  for (const double start : {0.3, 0.41, 0.75})
    CHECK_THROWS_WITH(reference(start), Catch::StartsWith("there is no reference across the time of " +
                                                          short_number(start, 6) + " s"));
}

// 1.3 kg, free, under F until t0, none until t1 and G from there on. Times of the reference are sums that may
// round to either side of those of the jumps.
TEST_CASE("a reference sees of a load that jumps at one of its times only what is before it") {
  constexpr double mass = 1.3, F = 2.1, G = -4.7;
  for (const auto& [end, intervals, t0, t1] : {std::tuple{1.2, 12, 0.3, 0.7},
                                               {1.2, 12, 0.6, 1.1},
                                               {0.9, 3, 0.3, 0.6},
                                               {2.1, 7, 0.9, 1.8},
                                               {1.2, 12, 0.31, 0.61}}) {
    CAPTURE(end, intervals, t0, t1);
    const std::string first = exact_number(t0), second = exact_number(t1);
    const Reference r = solve_reference(
        build_model(read_scene_text(
            "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0.3, 0.2, 0.1], mass = 1.3}, "
            "{name = "
            "'O', position = [1.3, 0.2, 0.7], fixed = true}]\n[[forces]]\nkind = 'load_over_time'\nnodes = "
            "['P']\nforce = [1, 0, 0]\ntimes = [0, " +
                first + ", " + first + ", " + second + ", " + second +
                ", 9]\nvalues = [2.1, 2.1, 0, 0, -4.7, -4.7]\n",
            "jumps.toml", {})),
        end, intervals, {});
    CHECK(r.confirmed);
    for (std::size_t i = 0; i < r.q.size(); ++i) {
      const double t = r.t[i], u = std::min(t, t0), w = std::max(0.0, t - t1);
      const double x = 0.3 + (0.5 * F * u * u + F * u * (t - u) + 0.5 * G * w * w) / mass;
      CHECK(r.q[i].x() == Approx(x).epsilon(1e-13));
    }
  }
}

}  // namespace reference_levels_test
