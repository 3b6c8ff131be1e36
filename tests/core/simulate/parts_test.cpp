// SPDX-License-Identifier: BSD-3-Clause
// Long runs in parts: what is handed over is the run, and a run that is archived goes on to the same bits.
#include "core/simulate/parts.hpp"

#include <catch2/catch.hpp>
#include <cstring>

#include "core/scene/library.hpp"
#include "tests/support/bennett_loops.hpp"
#include "tests/support/coulomb_oscillator.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace parts_test {

namespace {

// Turns round and comes to rest.
const std::string rubbing = testing::coulomb_oscillator + "[solver]\nstages = 4\nstep = 0.01\nend_time = 9\n";

// Bounces until it rests on its stop, beside a cable that goes taut and slack.
const std::string bouncing = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0.7], mass = 2},
  {name = "O", position = [3, 0, 0], fixed = true},
  {name = "B", position = [3.7, 0, 0], velocity = [1, 0, 0], mass = 1}]
[[forces]]
kind = "spring"
name = "cable"
nodes = ["O", "B"]
stiffness = 100
free_length = 1
tension_only = true
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["A"]
direction = [0, 0, 1]
min = 0.1
restitution = 0.6
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 0, 1]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 4
step = 0.011
end_time = 5
)";

struct Case {
  std::string scene;  // a text, or the name of a library scene
  std::vector<std::string> changes;
};

Scene scene_of(const Case& c) {
  return c.scene.find('\n') == std::string::npos ? read_scene_file(find_scene(c.scene), c.changes)
                                                 : read_scene_text(c.scene, "s.toml", c.changes);
}

bool same(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}
bool same(const VectorXd& a, const VectorXd& b) {
  return a.size() == b.size() &&
         (a.size() == 0 ||
          std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0);
}

// All that a run says, in the order in which it was handed over.
struct Whole {
  std::vector<State> states;
  std::vector<std::string> archives;  // behind every part
  std::size_t most = 0;               // states that were held at once
  Simulation end;

  void take(const Simulation& run, std::size_t first, std::size_t last) {
    most = std::max(most, run.trajectory.size());
    for (std::size_t i = first; i < last; ++i) states.push_back(run.trajectory.state(i));
  }
};

Whole in_parts(const Case& c, std::size_t states, std::size_t around, const std::string* archived = nullptr) {
  const Scene scene = scene_of(c);
  const auto model = build_model(scene);
  Whole out{{}, {}, 0, Simulation{.trajectory = Trajectory(model)}};
  Parts parts{.states = states, .around = around};
  parts.take = [&](const Stepper::Window& window, Stepper& stepper) {
    REQUIRE(window.first < window.last);
    // What lies around the new states is the part before it.
    if (window.first > 0 && !out.states.empty())
      CHECK(same(window.run.trajectory.state(window.first - 1).z, out.states.back().z));
    out.take(window.run, window.first, window.last);
    Archive archive;
    stepper.archive(archive);
    out.archives.push_back(archive.bytes());
  };
  Archive archive = archived ? Archive(*archived) : Archive();
  if (archived) parts.archived = &archive;
  std::size_t first = 0;
  out.end = simulate_in_parts(model, scene.solver, {}, parts, first);
  out.take(out.end, first, out.end.trajectory.size());
  return out;
}

// The last states of `all`, to the bit.
void check_same_end(const Whole& part, const Whole& all) {
  REQUIRE(part.states.size() <= all.states.size());
  std::size_t wrong = 0;
  for (std::size_t i = 1; i <= part.states.size(); ++i) {
    const State &a = part.states[part.states.size() - i], &b = all.states[all.states.size() - i];
    if (!same(a.t, b.t) || !same(a.z, b.z) || !same(a.w, b.w) || !same(a.lambda, b.lambda) ||
        !same(a.angles, b.angles))
      ++wrong;
  }
  CHECK(wrong == 0);
  CHECK(part.end.status == all.end.status);
  CHECK(part.end.message == all.end.message);
  CHECK(part.end.warnings == all.end.warnings);
  CHECK(part.end.steps == all.end.steps);
  CHECK(part.end.newton_iterations == all.end.newton_iterations);
  REQUIRE(part.end.events.size() == all.end.events.size());
  for (std::size_t i = 0; i < all.end.events.size(); ++i) {
    CHECK(part.end.events[i].name == all.end.events[i].name);
    CHECK(same(part.end.events[i].t, all.end.events[i].t));
    CHECK(same(part.end.events[i].energy_lost, all.end.events[i].energy_lost));
  }
}

}  // namespace

TEST_CASE("a run that was archived goes on to the same bits, whatever it has") {
  const auto c =
      GENERATE(Case{rubbing, {}}, Case{rubbing, {"solver.adaptive=true", "solver.step=0.05"}},
               Case{rubbing, {"solver.method=rk4_projected"}}, Case{bouncing, {}},
               Case{bouncing, {"solver.method=generalized_alpha", "solver.step=0.003"}},
               Case{"hoop6", {"solver.at_deployed=latch"}},
               Case{"hoop6_sector", {"solver.adaptive=true", "solver.step=0.05", "solver.at_deployed=latch"}},
               Case{"hoop6_motor", {}}, Case{"double_pendulum", {"solver.end_time=4"}}, Case{"pendulum", {}},
               Case{testing::bennett_loops(0, 1, 0.0), {"solver.method=rk4", "solver.end_time=2"}});
  CAPTURE(c.scene, c.changes);
  const Whole all = in_parts(c, 37, 5);
  REQUIRE(all.archives.size() >= 2);
  // The same run as in one piece, but for round-off behind every part.
  const Scene scene = scene_of(c);
  const Simulation one = simulate(build_model(scene), scene.solver);
  CHECK(all.states.size() == one.trajectory.size());
  CHECK(all.end.status == one.status);
  CHECK(all.end.events.size() == one.events.size());
  for (const std::size_t k : {std::size_t{0}, all.archives.size() / 2, all.archives.size() - 1})
    check_same_end(in_parts(c, 37, 5, &all.archives[k]), all);
}

// Chaotic, with events in the way, with steps of any length, of 128 states a part.
TEST_CASE("a run that is kept whole has the bits of one that is handed over part by part") {
  const auto c =
      GENERATE(Case{"double_pendulum", {"solver.end_time=50"}}, Case{bouncing, {"solver.step=0.0009"}},
               Case{"hoop6_sector", {"solver.adaptive=true", "solver.step=0.0005", "solver.stages=3"}},
               Case{"chain", {}}, Case{rubbing, {"solver.step=0.0015", "solver.method=rk4"}});
  CAPTURE(c.scene, c.changes);
  const Scene scene = scene_of(c);
  const auto model = build_model(scene);
  const Parts usual = parts_for(*model);
  const Whole all = in_parts(c, usual.states, usual.around);
  REQUIRE(all.archives.size() >= 1);
  Whole one{{}, {}, 0, simulate(model, scene.solver)};
  one.take(one.end, 0, one.end.trajectory.size());
  REQUIRE(one.states.size() == all.states.size());
  check_same_end(one, all);
}

TEST_CASE("what a run in parts holds does not grow with its length") {
  const Case c{"double_pendulum", {"solver.end_time=20"}};
  const Whole all = in_parts(c, 100, 10);
  CHECK(all.states.size() > 1000);
  CHECK(all.most <= 100 + 3 * 10);
}

TEST_CASE("an archive that was cut short is refused") {
  const Whole all = in_parts({bouncing, {}}, 50, 5);
  const std::string& whole = all.archives.front();
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, whole.size() / 3, whole.size() - 1}) {
    const std::string cut = whole.substr(0, size);
    CHECK_THROWS_AS(in_parts({bouncing, {}}, 50, 5, &cut), ArchiveError);
  }
}

}  // namespace parts_test
