// SPDX-License-Identifier: BSD-3-Clause
// The rival to name: an adaptive Runge-Kutta method of order 8 with KLU, in our own coordinates. Both sides
// are run over a list of settings, and for each accuracy the cheapest of each side that reaches it is
// compared.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/simulate/initial_state.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/contender.hpp"
#include "tests/bench/dop853_klu.hpp"
#include "tests/support/four_bar_exact.hpp"
#include "tests/support/models.hpp"

namespace unfurl::bench {
namespace {

VectorXd start_of(const Structure& structure) {
  VectorXd q(3 * std::ssize(structure.nodes));
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    q.segment<3>(3 * static_cast<Index>(i)) = structure.nodes[i].position;
  return q;
}

// Rows are picked at the pose `rows`, where they have full rank.
Contender dop853(const Track& track, const VectorXd& rows, double tolerance, bool pivoting) {
  Contender c{pivoting ? "adaptive DOP853 with KLU, pivoting" : "adaptive DOP853 with KLU",
              [=](const Model& m) { return make_dop853_klu(m.system, rows, tolerance, pivoting); },
              track.times.front()};
  c.relative_tolerance = tolerance;
  return c;
}

const Contender* cheapest(const std::vector<Contender>& all, double accuracy) {
  const Contender* found = nullptr;
  for (const Contender& c : all)
    if (c.failure.empty() && c.error <= accuracy && (!found || c.best < found->best)) found = &c;
  return found;
}

void duel(Report& report, const std::string& what, const Track& track, std::vector<Contender> ours,
          std::vector<Contender> rivals, const std::vector<double>& accuracies, int repeats) {
  std::vector<Contender*> all;
  for (auto* side : {&ours, &rivals})
    for (Contender& c : *side) all.push_back(&c);
  race(all, track, repeats);
  for (const double accuracy : accuracies) {
    const Contender *a = cheapest(ours, accuracy), *b = cheapest(rivals, accuracy);
    char text[64];
    std::snprintf(text, sizeof text, "%s at %.0e m: ", what.c_str(), accuracy);
    for (const auto& [side, found] : {std::pair{"dvm", a}, std::pair{"DOP853 with KLU", b}}) {
      if (!found) {
        report.add({"rival", std::string(text) + side + " does not get there", std::nan(""), "s"});
        continue;
      }
      Contender named = *found;
      named.name = text + named.name;
      add(report, "rival", named);
    }
    if (a && b) ratio(report, "rival", std::string(text) + "dvm / DOP853 with KLU", *a, *b, "<= 0.5");
  }
}

Track ring_track(const char* kind) {
  constexpr double end = 4.9;  // [s]
  const double theta = testing::exact_hoop().angle(end);
  const Structure there =
      testing::hoop_structure({{"fold_angle", theta * 180 / pi}, {"model", std::string(kind)}});
  return {testing::make_model(testing::hoop_structure({{"model", std::string(kind)}})),
          end,
          {end},
          {start_of(there)}};
}

void rings(Report& report) {
  for (const char* kind : {"full", "sector"}) {
    const Track track = ring_track(kind);
    const VectorXd half =
        start_of(testing::hoop_structure({{"fold_angle", 45.0}, {"model", std::string(kind)}}));
    std::vector<Contender> ours, rivals;
    for (const auto& [stages, h] :
         {std::pair{4, 0.07}, std::pair{4, 0.05}, std::pair{5, 0.07}, std::pair{6, 0.098}, std::pair{6, 0.07},
          std::pair{7, 0.098}, std::pair{7, 0.07}, std::pair{8, 0.07}, std::pair{8, 0.05},
          std::pair{8, 0.035}, std::pair{7, 0.035}})
      ours.push_back(dvm(stages, h));
    for (const auto& [stages, largest, turn] : {std::tuple{6, 1.6, 0.36},
                                                {6, 1.2, 0.28},
                                                {7, 1.6, 0.36},
                                                {6, 0.8, 0.2},
                                                {7, 0.8, 0.2},
                                                {7, 0.8, 0.1},
                                                {8, 0.8, 0.1},
                                                {9, 0.8, 0.2}})
      ours.push_back(adaptive_dvm(stages, largest, turn));
    for (int digits = 5; digits <= 13; ++digits)
      rivals.push_back(dop853(track, half, std::pow(10.0, -digits), false));
    duel(report, std::string("ring, ") + kind, track, ours, rivals, {1e-6, 1e-8, 1e-10, 1e-12}, 5);
  }
}

void ladder(Report& report) {
  constexpr double speed = 30, end = 10;
  const Structure structure = testing::ladder_structure(1, speed);
  const exact::FourBarLadder exact_ladder{1, speed};
  Track track{testing::make_model(structure), end, {}, {}};
  for (int k = 1; k <= 20; ++k) {
    const double t = end * k / 20, phi = exact_ladder.angle(t);
    VectorXd q(3 * std::ssize(structure.nodes));
    for (int i = 0; i <= 1; ++i) {
      q.segment<3>(6 * i) << i, 0, 0;
      q.segment<3>(6 * i + 3) << i + std::sin(phi), std::cos(phi), 0;
    }
    track.times.push_back(t);
    track.exact.push_back(q);
  }
  std::vector<Contender> rivals;
  for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12})
    rivals.push_back(dop853(track, start_of(structure), tolerance, true));
  duel(report, "ladder", track, {dvm(6, 0.01), dvm(5, 0.01), dvm(6, 0.005), dvm(4, 0.01)}, rivals,
       {1e-4, 1e-6, 1e-8}, 3);
}

// There is no exact motion of a chain: the rival's own, with the least tolerance that it has.
void chain(Report& report) {
  constexpr double end = 0.8;
  const Structure structure = chain_of_rods(100);
  Track track{testing::make_model(structure), end, {0.2, 0.4, 0.6, end}, {}};
  const auto best = make_dop853_klu(track.model->system, start_of(structure), 1e-14, false);
  State state = initial_state(track.model->structure, track.model->system).state;
  double at = 0;
  for (const double t : track.times) {
    best->step(state, t - std::exchange(at, t));
    VectorXd q(track.model->system.coordinates());
    track.model->system.expand(state.z, q);
    track.exact.push_back(q);
  }
  std::vector<Contender> rivals;
  for (const double tolerance : {1e-5, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12})
    rivals.push_back(dop853(track, start_of(structure), tolerance, false));
  duel(report, "chain of 100 rods", track,
       {dvm(3, 0.01), dvm(4, 0.01), dvm(5, 0.01), dvm(6, 0.01), dvm(7, 0.01), dvm(6, 0.005), dvm(8, 0.005),
        dvm(8, 0.0025)},
       rivals, {1e-6, 1e-8, 1e-10}, 2);
}

}  // namespace

void rival_cases(Report& report) {
  report.begin("An adaptive DOP853 with KLU in our own coordinates: the cheapest settings of both");
  rings(report);
  ladder(report);
  chain(report);
}

}  // namespace unfurl::bench
