// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/simulator.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>

using namespace unfurl;

namespace simulator_test {

namespace {

// What comes of the newest request; gives up after a minute.
std::optional<SimulationOutcome> outcome_of(Simulator& simulator) {
  for (int i = 0; i < 60000; ++i) {
    if (auto outcome = simulator.take()) return outcome;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return std::nullopt;
}

SceneDocument hoop(double step, double end_time = 6.0) {
  SceneDocument document = open_document("hoop6", {});
  document.edits["solver.step"] = step;
  document.edits["solver.end_time"] = end_time;
  return document;
}

}  // namespace

TEST_CASE("a background simulation is the command line's") {
  Simulator simulator;
  const long id = simulator.submit(hoop(0.02));
  const auto outcome = outcome_of(simulator);
  REQUIRE(outcome);
  REQUIRE(outcome->run);
  CHECK(outcome->id == id);
  CHECK(outcome->run->simulation.status == RunStatus::deployed);
  // The paper's ring deploys after 4.92 s, printed to two decimals.
  CHECK(outcome->run->simulation.events.at(0).t == Approx(4.92).margin(0.005));
  CHECK_FALSE(simulator.busy());
}

TEST_CASE("a run says which model was solved and why, in the summary's words") {
  struct Asked {
    const char *key, *value, *sentence;
  };
  const auto asked =
      GENERATE(Asked{"solver.model", "full", "model full: solver.model = \"full\""},
               Asked{"solver.model", "auto", "model path: one degree of freedom; solver.model = \"auto\""},
               Asked{"structure.model", "sector", "model sector: structure.model = \"sector\""});
  SceneDocument document = hoop(0.05);
  document.edits[asked.key] = std::string(asked.value);
  Simulator simulator;
  simulator.submit(document);
  const auto outcome = outcome_of(simulator);
  REQUIRE(outcome);
  REQUIRE(outcome->run);
  const std::string sentence = state_sentence(*outcome->run);
  CHECK(sentence.starts_with("deployed at 4.9"));
  CHECK(sentence.find(std::string("\n") + asked.sentence) != std::string::npos);
}

TEST_CASE("only the newest of many requests comes out, and stale work is not finished") {
  Simulator simulator;
  long last = 0;
  // Each alone would take far longer than all together may: half a million steps.
  for (int i = 0; i < 50; ++i) last = simulator.submit(hoop(1e-5 * (1 + 0.001 * i)));
  last = simulator.submit(hoop(0.05));
  const auto outcome = outcome_of(simulator);
  REQUIRE(outcome);
  CHECK(outcome->id == last);
  REQUIRE(outcome->run);
  CHECK(outcome->run->scene.solver.step == 0.05);
  CHECK_FALSE(simulator.take());
  CHECK(simulator.started() <= 51);
}

TEST_CASE("a scene at fault comes back with the command line's message at its key") {
  Simulator simulator;
  SceneDocument document = open_document("hoop6", {});
  document.edits["structure.units"] = 2L;
  simulator.submit(document);
  const auto outcome = outcome_of(simulator);
  REQUIRE(outcome);
  CHECK_FALSE(outcome->run);
  REQUIRE(outcome->problems.size() == 1);
  CHECK(outcome->problems[0].key == "structure.units");
  CHECK(outcome->problems[0].message.find("[3, 100000]") != std::string::npos);
}

TEST_CASE("a large ring is shown by one of its sectors first, and by itself then") {
  std::vector<SimulationOutcome> seen;  // taken by the thread that says that they are there: none is missed
  std::atomic<int> taken = 0;
  Simulator* asked = nullptr;
  Simulator simulator([&] {
    auto outcome = asked->take();
    if (!outcome) return;
    seen.push_back(std::move(*outcome));
    ++taken;
  });
  asked = &simulator;
  SceneDocument document = hoop(0.02, 0.1);  // a beginning will do
  document.edits["structure.units"] = 80L;
  simulator.submit(document);
  for (int i = 0; i < 60000 && taken < 2; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  REQUIRE(taken == 2);
  REQUIRE(seen[0].run);
  REQUIRE(seen[1].run);
  const LiveRun &first = *seen[0].run, &second = *seen[1].run;
  CHECK(first.coarse);
  CHECK(first.scene.structure.text("model") == "sector");
  CHECK(first.document == document);  // what was asked for
  CHECK_FALSE(second.coarse);
  CHECK(second.scene.structure.text("model") == "full");
  // The same parts under the same names, near the same places: a selection and a picture fit both.
  const Trajectory &a = first.simulation.trajectory, &b = second.simulation.trajectory;
  REQUIRE(a.structure().node_copies.size() == b.structure().node_copies.size());
  CHECK(a.structure().node_copies[7].name == b.structure().node_copies[7].name);
  CHECK((a.positions_at(0.08) - b.positions_at(0.08)).cwiseAbs().maxCoeff() < 1e-3);
}

TEST_CASE("a cancelled simulation leaves nothing behind, and its end is not waited for") {
  Simulator simulator;
  simulator.submit(hoop(1e-5));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  simulator.cancel();
  for (int i = 0; i < 10000 && simulator.busy(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK_FALSE(simulator.busy());
  CHECK_FALSE(simulator.take());
}

}  // namespace simulator_test
