// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/study/extrapolation.hpp"
#include "core/study/reference.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

TEST_CASE("the reference of the ring is the quadrature of its energy") {
  const auto model = make_model(hoop_structure({{"model", std::string("sector")}}));
  const Reference reference = solve_reference(model, 4.9, 49, {});
  const exact::Hoop exact = exact_hoop();
  // The start has the rounding of its coordinates, 2e-16 m over the 0.0115 rad that the chords lean, which
  // grows as that angle does, 136 times; the quadrature is good to 1e-13 in time, times some 5 rad/s at the
  // end.
  for (const std::size_t k : {std::size_t{20}, std::size_t{40}, std::size_t{49}})
    CHECK(std::abs(model->structure.deployment.fold_angle(reference.q[k]) - exact.angle(reference.t[k])) <
          1e-12);
  CHECK(reference.uncertainty < 1e-12);
}

// Its size is the way that it goes: 0.05 m, of which 1e-6 are let pass and rounding is what is expected.
TEST_CASE("one node alone has a reference, moving or at rest") {
  const std::string text =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], mass = 2}]\n";
  const Reference rest = solve_reference(build_model(read_scene_text(text, "rest.toml")), 0.1, 4, {}),
                  fall =
                      solve_reference(build_model(read_scene_text(
                                          text + "[gravity]\nacceleration = [0, 0, -9.81]\n", "fall.toml")),
                                      0.1, 4, {});
  CHECK(rest.q.back().isZero(0.0));
  CHECK(fall.q.back().z() == Approx(-0.5 * 9.81 * 0.01).epsilon(1e-14));
  CHECK(fall.uncertainty <= 1e-15);
  CHECK(rest.size == 0);
  CHECK(fall.size == Approx(0.5 * 9.81 * 0.01).epsilon(1e-14));
  // Thrown up it comes back to its start after 0.1 s, whose way is v^2 / (2 g) = 12 mm.
  const Reference thrown = solve_reference(
      build_model(read_scene_text("[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], "
                                  "velocity = [0, 0, 0.4905], mass = 2}]\n"
                                  "[gravity]\nacceleration = [0, 0, -9.81]\n",
                                  "thrown.toml")),
      0.1, 4, {});
  CHECK(thrown.size == Approx(0.4905 * 0.4905 / (2 * 9.81)).epsilon(1e-12));
  CHECK(thrown.how.starts_with("Bulirsch"));
  // Thrown slower it ends farther below its start than it rose.
  const Reference fallen = solve_reference(
      build_model(read_scene_text("[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], "
                                  "velocity = [0, 0, 0.3], mass = 2}]\n"
                                  "[gravity]\nacceleration = [0, 0, -9.81]\n",
                                  "fallen.toml")),
      0.1, 4, {});
  CHECK(fallen.size == Approx(0.5 * 9.81 * 0.01 - 0.3 * 0.1).epsilon(1e-12));
}

// Far from the origin, on either side of it, and where all nodes are in one place.
TEST_CASE("the size of a structure is how far its nodes lie apart along an axis or how far one goes") {
  const auto model = [](const std::string& nodes) {
    return build_model(read_scene_text(
        "[structure]\nkind = 'custom'\nnodes = [" + nodes + "]\n[gravity]\nacceleration = [0, 0, -9.81]\n",
        "size.toml", {}));
  };
  const auto two = model(
      "{name = 'A', position = [7.5, -3, 2], mass = 1}, {name = 'B', position = [6, -3.5, 4.25], mass = 1}, "
      "{name = 'C', position = [6.5, -3.25, 3], mass = 1}");
  CHECK(structure_size(*two) == 2.25);
  SolverOptions options = dvm_options(3, 0.05, 0.4);
  const Simulation both = simulate(two, options);
  CHECK(size_of_motion(*two, both.trajectory) == 2.25);
  const auto one = model("{name = 'A', position = [7.5, -3, 2], mass = 1, velocity = [0, 0, 1.1]}");
  CHECK(structure_size(*one) == 0);
  const Simulation fall = simulate(one, options);
  CHECK(size_of_motion(*one, fall.trajectory) == Approx(0.5 * 9.81 * 0.16 - 0.44).epsilon(1e-12));
}

TEST_CASE("references of a whole ring, in which errors grow, are certain to round-off at every step") {
  // As above, over a chord's 3 m: 1e-13 m of the start, and by the rounding of every step or of a
  // constraint's value as much again where they are not carried.
  const auto model = make_model(hoop_structure());
  const auto last = [&](int steps) {
    State state = initial_state(model->structure, model->system).state;
    Extrapolation method(model->system);
    for (int i = 0; i < steps; ++i) REQUIRE(method.step(state, 4.9 / steps));
    VectorXd q(model->system.coordinates());
    model->system.expand(state.z, q);
    return q;
  };
  CHECK(node_distance(last(98), last(245)) < 2e-13);
}

TEST_CASE("a reference is known as well as two methods agree, not one with itself") {
  const Reference swing = solve_reference(make_model(double_pendulum()), 1.2, 12, {});
  CHECK(swing.confirmed);
  CHECK(swing.uncertainty < 1e-11);
}

TEST_CASE("a reference knows of a load that acts between two of its times") {
  // 3 kg, free; 840 N along x, up within 0.1 ms, on for 1 ms and down again: 0.924 kg m/s in all, symmetric
  // about its middle, so that x goes on from there with 0.308 m/s.
  const Scene scene = read_scene_text(
      "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'P'\nposition = [0.3, 0.2, 0.1]\nmass = "
      "3.0\n"
      "[[structure.nodes]]\nname = 'O'\nposition = [1.3, 0.2, 0.7]\nfixed = true\n"
      "[[forces]]\nkind = 'load_over_time'\nnodes = ['P']\nforce = [840, 0, 0]\n"
      "times = [0.5031, 0.5032, 0.5042, 0.5043]\nvalues = [0, 1, 1, 0]\n",
      "blow.toml", {});
  const Reference reference = solve_reference(build_model(scene), 1.2, 6, {});
  // Six intervals of 0.2 s: straight on before and after.
  CHECK(reference.q[2][0] == Approx(0.3).epsilon(1e-14));
  CHECK(reference.q[6][0] == Approx(0.3 + 840 * 0.0011 / 3 * (1.2 - 0.5037)).epsilon(1e-12));
  CHECK(reference.uncertainty < 1e-13);
}

TEST_CASE("distances keep what is not a number") {
  VectorXd a = VectorXd::LinSpaced(9, 0, 1), b = a;
  b[8] += 0.25;
  CHECK(node_distance(a, b) == Approx(0.25));
  b[1] = std::numeric_limits<double>::quiet_NaN();  // of the first node, with a larger distance after it
  CHECK(std::isnan(node_distance(a, b)));
}

TEST_CASE("extrapolation is of order 16") {
  const auto model = make_model(double_pendulum());
  const Reference truth = solve_reference(model, 0.8, 8, {});
  const auto error = [&](int steps) {
    State state = initial_state(model->structure, model->system).state;
    Extrapolation method(model->system);
    for (int i = 0; i < steps; ++i) REQUIRE(method.step(state, 0.8 / steps));
    VectorXd q(model->system.coordinates());
    model->system.expand(state.z, q);
    return node_distance(q, truth.q.back());
  };
  // From steps of 0.2 s to 0.1 s, large enough for errors far above round-off (3e-6 m to 2e-10 m), so not yet
  // asymptotic.
  CHECK(std::log2(error(4) / error(8)) > 13);
}

TEST_CASE("a motion that no two solutions agree on has no reference") {
  // The pendulum is chaotic: after a minute the smallest differences have grown to its own size.
  const auto model = make_model(double_pendulum());
  CHECK_THROWS_WITH(solve_reference(model, 60, 10, {}), Catch::Contains("the reference does not converge"));
}

// 1 kg on 1e8 N/m swings in 2 pi / 1e4 s, of which intervals of 40 in 64 parts leave 1.6 parts in each, those
// of 16 four. Told with three digits.
TEST_CASE("a swing that no steps of a reference resolve is told, with steps that do") {
  const auto model = build_model(read_scene_text(R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [1.0001, 0, 0], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["P"]
direction = [1, 0, 0]
[[forces]]
kind = "spring"
nodes = ["O", "P"]
stiffness = 1e8
free_length = 1
)",
                                                 "stiff.toml"));
  CHECK_THROWS_WITH(solve_reference(model, 0.05, 2, {}),
                    Catch::Contains("do not resolve the fastest swing") &&
                        Catch::Contains("solver.step = 0.000628") && !Catch::Contains("chaotic"));
  // Rounding of 1e-16 m in the place is 1e-12 of the swing.
  const Reference found = solve_reference(model, 0.05, 5, {});
  CHECK(found.q.back()[3] == Approx(1 + 1e-4 * std::cos(500.0)).epsilon(0).margin(1e-11));
}

TEST_CASE("a reference can be cancelled") {
  StudyHooks hooks;
  hooks.cancelled = [] { return true; };
  CHECK_THROWS_AS(solve_reference(make_model(double_pendulum()), 1, 4, hooks), Cancelled);
}
