// SPDX-License-Identifier: BSD-3-Clause
// Position errors beside the window: true, of the right motion, and out of the way of the next run.
#include "app/panel/runs/error_meter.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>

#include "tests/support/four_bar_exact.hpp"

using namespace unfurl;

namespace error_meter_test {

namespace {

constexpr double scene_speed = 1.0;  // of the library's ladder of two windows [m/s]

SceneDocument ladder(const char* method, long stages, double step) {
  SceneDocument document = open_document("ladder", {});
  document.edits["solver.end_time"] = 1.5;
  document.edits["solver.method"] = std::string(method);
  document.edits["solver.stages"] = stages;
  document.edits["solver.step"] = step;
  return document;
}

template <class Condition>
bool comes_true(const Condition& condition) {  // within a minute
  for (int i = 0; i < 60000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

std::shared_ptr<const LiveRun> run_of(Simulator& simulator, const SceneDocument& document) {
  simulator.submit(document);
  std::shared_ptr<const LiveRun> run;
  comes_true([&] {
    const auto outcome = simulator.take();
    if (outcome) run = outcome->run;
    return outcome.has_value();
  });
  return run;
}

std::vector<RunError> all_errors(ErrorMeter& meter) {
  std::vector<RunError> all;
  comes_true([&] {
    for (RunError& error : meter.take()) all.push_back(std::move(error));
    return !meter.busy();
  });
  return all;
}

double true_error(const LiveRun& run) {
  return exact::largest_head_error({2, scene_speed}, run.simulation.trajectory);
}

}  // namespace

TEST_CASE("errors of all runs of a motion are the true ones, and its reference is solved once") {
  Simulator simulator;
  ErrorMeter meter;
  std::vector<std::shared_ptr<const LiveRun>> runs;
  for (const auto& document : {ladder("dvm", 2, 0.05), ladder("dvm", 3, 0.023), ladder("rk4", 3, 0.01)}) {
    runs.push_back(run_of(simulator, document));
    REQUIRE(runs.back());
    meter.measure(runs.back());
  }
  const std::vector<RunError> errors = all_errors(meter);
  REQUIRE(errors.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    REQUIRE(errors[i].run == runs[i]->id);
    CHECK(errors[i].why == "");
    CHECK(errors[i].uncertainty < 1e-11);
    const double truth = true_error(*runs[i]);
    CHECK(truth > 1e-9);
    // What the reference is not certain of, and round-off of sums of metres.
    CHECK(std::abs(errors[i].error - truth) < 2 * errors[i].uncertainty + 1e-14);
  }
  CHECK(meter.solved() == 1);
  meter.measure(run_of(simulator, ladder("dvm", 4, 0.05)));
  CHECK(all_errors(meter).size() == 1);
  CHECK(meter.begun() == 1);
}

TEST_CASE("another motion has another reference, and what stays the same keeps it") {
  Simulator simulator;
  ErrorMeter meter;
  const auto slow = run_of(simulator, ladder("dvm", 3, 0.02));
  SceneDocument fast = ladder("dvm", 3, 0.02);
  fast.edits["structure.speed"] = 2.0;
  const auto other = run_of(simulator, fast);
  CHECK_FALSE(same_motion(slow->motion, other->motion));
  SceneDocument looks = ladder("dvm", 5, 0.1);
  looks.edits["render.fps"] = 12L;
  looks.edits["solver.adaptive"] = true;
  looks.edits["solver.tolerance"] = 1e-5;
  CHECK(same_motion(slow->motion, run_of(simulator, looks)->motion));
  SceneDocument longer = ladder("dvm", 3, 0.02);
  longer.edits["solver.end_time"] = 1.6;
  CHECK_FALSE(same_motion(slow->motion, run_of(simulator, longer)->motion));
  meter.measure(slow);
  const auto first = all_errors(meter);
  meter.measure(other);
  const auto second = all_errors(meter);
  REQUIRE(first.size() == 1);
  REQUIRE(second.size() == 1);
  CHECK(first[0].error == Approx(true_error(*slow)).epsilon(1e-3));
  // Against the slow motion's reference this would be metres.
  CHECK(second[0].error < 1e-3);
  CHECK(meter.solved() == 2);
  meter.measure(slow);
  CHECK(all_errors(meter).at(0).error == first[0].error);
  CHECK(meter.begun() == 2);
}

TEST_CASE("a newer motion, a hold and the end interrupt a reference that takes long") {
  Simulator simulator;
  SceneDocument large = open_document("hoop6", {});
  large.edits["structure.units"] = 60L;
  large.edits["solver.step"] = 0.05;
  const auto slow = run_of(simulator, large);
  REQUIRE(slow);
  const auto quick = run_of(simulator, ladder("dvm", 3, 0.02));
  {
    ErrorMeter meter;
    meter.hold(true);
    meter.measure(slow);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    CHECK(meter.begun() == 0);
    meter.hold(false);
    REQUIRE(comes_true([&] { return meter.begun() == 1; }));
    meter.measure(quick);
    const auto errors = all_errors(meter);
    REQUIRE(errors.size() == 1);  // the slow one was given up without a word
    CHECK(errors[0].run == quick->id);
    CHECK(meter.begun() == 2);
    CHECK(meter.solved() == 1);
  }
  const auto start = std::chrono::steady_clock::now();
  {
    ErrorMeter meter;
    meter.measure(slow);
    REQUIRE(comes_true([&] { return meter.begun() == 1; }));
    meter.hold(true);
    CHECK(meter.busy());
  }
  // A held one ends all the same, within a step of some milliseconds instead of the seconds that it needs.
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}

}  // namespace error_meter_test
