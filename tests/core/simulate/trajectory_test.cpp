// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/trajectory.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "core/scene/library.hpp"
#include "core/simulate/parts.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

TEST_CASE("between its rows a trajectory shows a straight line of what rods give way by") {
  const Simulation rigid = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0]}]
rods = [{nodes = ["A", "B"], mass = 1}]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.07
end_time = 0.5
)");
  Simulation shown = rigid;
  // In proportion to time: straight lines between uneven rows are it.
  VectorXd grows(6);
  grows << 0, 0, 0, 0.3, -0.2, 0.5;
  const Trajectory& rows = rigid.trajectory;
  for (std::size_t i = 0; i < rows.size(); ++i) shown.trajectory.add_stretch(i, rows.time(i) * grows);
  for (const double t : {0.0, 0.013, 0.07, 0.2, 0.333, 0.49, 0.4999, 0.5}) {
    INFO(t);
    const VectorXd moved = shown.trajectory.positions_at(t) - rows.positions_at(t);
    CHECK((moved - t * grows).cwiseAbs().maxCoeff() <= 1e-15 * 4);  // rounding of coordinates of a metre
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const VectorXd moved = shown.trajectory.positions(i) - rows.positions(i);
    CHECK((moved - rows.time(i) * grows).cwiseAbs().maxCoeff() <= 1e-15 * 4);
    CHECK(shown.trajectory.velocities(i) == rows.velocities(i));
  }
}

// Three models of one flight, as where a latch closes and a stop is met: the second begins at a time that
// stands twice.
TEST_CASE("every state of a trajectory belongs to the model that it came from") {
  const std::string flight = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0.3, -0.2, 0.7], velocity = [2, -3, 0.5], mass = 1.5}]
)";
  std::vector<std::shared_ptr<const Model>> m;
  for (int k = 0; k < 5; ++k) m.push_back(testing::model_of(flight));
  const Vec3 start(0.3, -0.2, 0.7), rate(2, -3, 0.5);
  Trajectory all(m[0]);
  const auto add = [&](double t) {
    State s;
    s.t = t, s.z = start + t * rate, s.w = rate;
    all.append(s, {});
  };
  add(0.1), add(0.2), add(0.5);
  all.change_model(m[1]);
  add(0.5), add(0.9);
  all.change_model(m[2]);
  add(1.7);
  const auto models = [&m](const Trajectory& trajectory) {
    std::vector<int> out;
    for (std::size_t i = 0; i < trajectory.size(); ++i)
      for (int k = 0; k < 5; ++k)
        if (&trajectory.model(i) == m[static_cast<std::size_t>(k)].get()) out.push_back(k);
    return out;
  };
  CHECK(models(all) == std::vector{0, 0, 0, 1, 1, 2});
  for (const auto& [t, before] : {std::pair(-1.0, 0),
                                  {0.1, 0},
                                  {0.19, 0},
                                  {0.2, 1},
                                  {0.49, 1},
                                  {0.5, 3},
                                  {0.6, 3},
                                  {0.9, 4},
                                  {1.69, 4},
                                  {1.7, 5},
                                  {2.0, 5}}) {
    INFO(t << " s");
    CHECK(all.state_before(t) == static_cast<std::size_t>(before));
    // The flight is straight; nothing is known outside of it.
    const Vec3 there = start + std::clamp(t, 0.1, 1.7) * rate;
    CHECK((all.positions_at(t) - there).norm() <= 1e-14);
    CHECK((all.velocities_at(t) - rate).norm() <= 1e-14);
  }
  for (std::size_t first = 0; first < 6; ++first)
    for (std::size_t last = first + 1; last <= 6; ++last) {
      const Trajectory part = all.part(first, last, {});
      const std::vector<int> whole = models(all), own = models(part);
      INFO(first << " to " << last);
      REQUIRE(part.size() == last - first);
      CHECK(std::equal(own.begin(), own.end(), whole.begin() + static_cast<std::ptrdiff_t>(first)));
      CHECK(&part.model() == m[0].get());
      CHECK(part.start_time() == all.time(first));
      CHECK(part.end_time() == all.time(last - 1));
    }
  // What rods give by goes with the states; models whose states have been taken back are gone.
  const Vec3 more(0.01, 0.03, -0.02);
  for (std::size_t i = 0; i < 6; ++i) all.add_stretch(i, static_cast<double>(i) * more);
  CHECK((all.positions_at(1.3) - (start + 1.3 * rate + 4.5 * more)).norm() <= 1e-14);
  all.pop_back(), all.pop_back();
  CHECK(all.stretch(4) == nullptr);
  REQUIRE(all.stretch(3) != nullptr);
  CHECK(*all.stretch(3) == 3 * more);
  all.change_model(m[3]);
  add(0.8);
  CHECK(models(all) == std::vector{0, 0, 0, 1, 3});
  all.pop_back(), all.pop_back();
  all.change_model(m[4]);
  add(0.6);
  CHECK(models(all) == std::vector{0, 0, 0, 4});
  all.change_model(m[0]);  // what was held is let go
  add(1.2);
  CHECK(models(all.part(2, 5, {})) == std::vector{0, 4, 0});
  all.change_model(m[4]);
  CHECK(&all.last_model() == m[4].get());
  CHECK(&all.model() == m[0].get());
}

TEST_CASE("how far a run has come is told as a share of its time") {
  const std::string scene_text = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], velocity = [1, 0, 0], mass = 1}]
[solver]
step = 0.5
end_time = 2
)";
  const Scene scene = read_scene_text(scene_text, "s.toml");
  const auto told = [&](std::chrono::milliseconds pause, int steps) {
    std::vector<double> fractions;
    SimulationHooks hooks{[&](double fraction) { fractions.push_back(fraction); },
                          [&] {
                            std::this_thread::sleep_for(pause);
                            return steps-- == 0;
                          }};
    simulate(build_model(scene), scene.solver, hooks);
    return fractions;
  };
  using std::chrono_literals::operator""ms;
  CHECK(told(55ms, -1) == std::vector{0.0, 0.25, 0.5, 0.75, 1.0});
  CHECK(told(55ms, 2) == std::vector{0.0, 0.25, 0.5});  // stopped: it never is at its end
  const Scene arrives = read_scene_text(
      scene_text + "[deployment]\nmeasure = 'coordinate A along 1 0 0'\ndeployed = 1.2\n", "s.toml");
  double last = 0;
  simulate(build_model(arrives), arrives.solver, {[&](double fraction) { last = fraction; }, {}});
  CHECK(last == 1.0);                               // deployed: it is done
  const std::vector<double> quick = told(0ms, -1);  // 20 times a second at most, and at the end
  CHECK(quick.front() == 0.0);
  CHECK(quick.back() == 1.0);
}

// What is done with its parts is no time of the run.
TEST_CASE("the processor time of a run is its own") {
  const Scene scene = read_scene_file(find_scene("pendulum"), {"solver.step=0.001", "solver.end_time=0.5"});
  std::vector<double> times;
  Parts parts{.states = 100, .around = 7};
  double elsewhere = 0;
  parts.take = [&](const Stepper::Window& window, Stepper&) {
    const double begin = thread_cpu_seconds();
    times.push_back(window.run.cpu_s);
    while (thread_cpu_seconds() < begin + 0.03) continue;
    elsewhere += thread_cpu_seconds() - begin;
  };
  const auto model = build_model(scene);
  std::size_t first = 0;
  const double begin = thread_cpu_seconds();
  const Simulation run = simulate_in_parts(model, scene.solver, {}, parts, first);
  const double all = thread_cpu_seconds() - begin;
  REQUIRE(times.size() >= 3);
  times.push_back(run.cpu_s);
  CHECK(times.front() > 0);
  CHECK(std::ranges::is_sorted(times));
  CHECK(run.cpu_s <= all - elsewhere);
  CHECK(run.cpu_s >= 0.5 * (all - elsewhere));  // warnings of the start are not of it
}

TEST_CASE("a run says whether all of a structure or a sector of it was solved") {
  const auto solved = [](const char* model) {
    const Scene scene = read_scene_file(find_scene("hoop6"),
                                        {std::string("structure.model=") + model, "solver.end_time=0.1"});
    const SolvedAs as = solved_as(simulate(build_model(scene), scene.solver));
    return as.name + ": " + as.why;
  };
  CHECK(solved("sector") == "sector: structure.model = \"sector\"");
  CHECK(solved("joints") == "full: solver.model = \"full\"");
}
