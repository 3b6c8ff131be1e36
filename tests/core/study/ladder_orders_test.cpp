// SPDX-License-Identifier: BSD-3-Clause
// Which runs of a ladder an order is read off, where it ends, and how a sweep is parted: of numbers that are
// known.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "core/study/study.hpp"
#include "core/study/sweep.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace ladder_orders_test {

namespace {

constexpr double end = 0.6;
const std::vector<long> steps = {12, 18, 24, 36, 48, 72, 96, 144, 192, 288};

// A plan of which every run is in the journal: nothing is run but the reference.
struct Kept {
  StudyPlan plan;
  Journal journal{{}, study_columns(), study_key_columns};
  double size;

  Kept() {
    plan.model = make_model(double_pendulum());
    plan.end = end;
    plan.ladder.grid = 6;
    plan.ladder.steps = steps;
    size = structure_size(*plan.model);
  }
  // Errors by steps; a negative one is of a run that failed.
  void add(const std::string& name, const std::vector<double>& errors) {
    Setting setting;
    setting.name = name;
    plan.settings.push_back(setting);
    Study study;
    study.curves.push_back({setting, {}, {}});
    for (std::size_t i = 0; i < steps.size(); ++i) {
      MeasuredRun run;
      run.outcome = errors[i] < 0 ? "solver failed" : "ok";
      run.steps = steps[i];
      run.step = end / static_cast<double>(steps[i]);
      run.position_error = std::abs(errors[i]);
      run.repeats = 1;
      study.curves[0].runs.push_back(run);
    }
    for (const auto& row : points_table(study).rows) journal.append(row);
  }
};

// The slope of the logarithms of those errors over their steps.
double slope(const std::vector<double>& errors, const std::vector<std::size_t>& taken) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(taken.size());
  for (const std::size_t i : taken) {
    const double x = std::log(end / static_cast<double>(steps[i])), y = std::log(errors[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace

TEST_CASE("an order is read off the five smallest steps that are right and above what is left of round-off") {
  Kept kept;
  const double s = kept.size;
  const std::vector<double> all = {0.2 * s,  0.011 * s, 0.008 * s,  0.002 * s, 7e-4 * s,
                                   2e-4 * s, 6e-5 * s,  1.1e-5 * s, 5e-6 * s,  9e-7 * s};
  // The second run failed; from the sixth on smaller steps gain nothing: it is left with some 3e-11 of the
  // size, and everybody's errors below twice that, 6.6e-11, are not the method's own, 8e-11 is.
  const std::vector<double> stuck = {0.002 * s,   -1e-5 * s,   4e-6 * s,    2e-8 * s,    8e-11 * s,
                                     3.1e-11 * s, 3.3e-11 * s, 2.9e-11 * s, 2.8e-11 * s, 2.7e-11 * s};
  // Below that floor once, above it again.
  const std::vector<double> dips = {0.009 * s, 3e-3 * s, 1e-4 * s, 6.5e-11 * s, 5e-6 * s,
                                    1e-6 * s,  3e-7 * s, 1e-7 * s, 4e-8 * s,    1e-8 * s};
  // Above a billionth of the size what gains nothing is no round-off, and its ladder goes on.
  const std::vector<double> flat = {0.004 * s,  0.003 * s,  2e-9 * s, 1.9e-9 * s, 1.8e-9 * s,
                                    1.7e-9 * s, 1.6e-9 * s, 1e-9 * s, 4e-10 * s,  1e-10 * s};
  kept.add("all", all), kept.add("stuck", stuck), kept.add("dips", dips), kept.add("flat", flat);
  const Study study = run_study(kept.plan, kept.journal, {});
  REQUIRE(study.complete);
  REQUIRE(study.curves.size() == 4);
  CHECK(study.size == s);
  CHECK(study.end == end);
  const Reference reference = solve_reference(kept.plan.model, end, 6, {});
  CHECK(study.reference_uncertainty == reference.uncertainty);
  CHECK(study.reference == reference.how);
  CHECK(study.reference_confirmed == reference.confirmed);
  REQUIRE(10 * study.reference_uncertainty < 6e-11 * s);
  const auto fits = [&](std::size_t curve, const std::vector<double>& errors,
                        std::vector<std::size_t> taken) {
    const ObservedOrder& order = study.curves[curve].order;
    CHECK(order.points == static_cast<int>(taken.size()));
    CHECK(order.order == Approx(slope(errors, taken)).epsilon(1e-9));
  };
  CHECK(study.curves[0].runs.size() == 10);
  fits(0, all, {5, 6, 7, 8, 9});
  CHECK(study.curves[1].runs.size() == 8);  // two in a row that gained nothing
  fits(1, stuck, {0, 2, 3, 4});
  CHECK(study.curves[2].runs.size() == 10);
  fits(2, dips, {0, 1, 2});
  CHECK(study.curves[3].runs.size() == 10);
  fits(3, flat, {5, 6, 7, 8, 9});
  // Runs come as they were kept.
  for (std::size_t i = 0; i < 10; ++i) {
    CHECK(study.curves[0].runs[i].steps == steps[i]);
    CHECK(study.curves[0].runs[i].position_error == all[i]);
  }
  CHECK(study.curves[1].runs[1].outcome == "solver failed");
}

TEST_CASE("the best of a setting's runs is told by how far it is, or that it is below what is known") {
  Study study;
  study.reference_uncertainty = 3e-12;
  for (const double best : {2e-12, 4e-12}) {
    StudyCurve curve;
    for (const double error : {1e-5, best, 7e-10}) {
      MeasuredRun run;
      run.outcome = "ok";
      run.position_error = error;
      run.step = 0.1 + error;
      curve.runs.push_back(run);
    }
    MeasuredRun failed = curve.runs[1];
    failed.outcome = "other motion", failed.position_error = 0;
    curve.runs.push_back(failed);
    study.curves.push_back(curve);
  }
  const Table table = orders_table(study);
  const std::size_t column = table.column("best error (m)");
  CHECK(table.rows.at(0).at(column) == "below 3e-12");
  CHECK(table.rows.at(1).at(column) == "4e-12");
}

namespace {

// Steele, Lea, Flood: Fast splittable pseudorandom number generators (2014), the one that follows state n.
std::uint64_t splitmix64(std::uint64_t state) {
  std::uint64_t z = state + 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

}  // namespace

// Machines that share a sweep by hand have to part it alike, whatever their version: by the generator whose
// first number from zero is e220a8397b1dcdaf.
TEST_CASE("shards are every so many of the points in the order of splitmix64") {
  REQUIRE(splitmix64(0) == 0xe220a8397b1dcdaf);
  SweepPlan plan;
  plan.axes = {parse_axis("structure.length=1:2:7"), parse_axis("structure.bob_mass=1:2:5")};
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < 35; ++i) order.push_back(i);
  const auto number = [](std::size_t i) { return splitmix64(i * 0x9e3779b97f4a7c15); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return number(a) < number(b); });
  for (int index = 1; index <= 4; ++index) {
    plan.shard = {index, 4};
    std::vector<std::size_t> own;
    for (std::size_t i = static_cast<std::size_t>(index) - 1; i < 35; i += 4) own.push_back(order[i]);
    std::sort(own.begin(), own.end());
    CHECK(points_of_shard(plan) == own);
  }
}

}  // namespace ladder_orders_test
