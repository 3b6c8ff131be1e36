// SPDX-License-Identifier: BSD-3-Clause
// The ladder of four-bar windows at 30 m/s for 10 s, some 97 passes through collinear poses. Uprights are 1 m
// long: the distance of an upper node from where it should be, in metres, is the phase error in radians.
#include "tests/bench/cases.hpp"
#include "tests/bench/contender.hpp"
#include "tests/support/four_bar_exact.hpp"
#include "tests/support/models.hpp"

namespace unfurl::bench {
namespace {

constexpr double speed = 30, end = 10;

Track ladder_track(int windows) {
  const Structure structure = testing::ladder_structure(windows, speed);
  const exact::FourBarLadder ladder{windows, speed};
  Track track{testing::make_model(structure), end, {}, {}};
  for (int k = 1; k <= 20; ++k) {  // multiples of every step in use
    const double t = end * k / 20, phi = ladder.angle(t);
    VectorXd q(static_cast<Index>(3 * structure.nodes.size()));
    for (int i = 0; i <= windows; ++i) {
      q.segment<3>(6 * i) << i, 0, 0;
      q.segment<3>(6 * i + 3) << i + std::sin(phi), std::cos(phi), 0;
    }
    track.times.push_back(t);
    track.exact.push_back(q);
  }
  return track;
}

void ladder(Report& report, int windows, Contender accurate, Contender matching, Contender bdf, int repeats,
            const char* seconds_wanted) {
  const std::string group = "ladder", name = "N = " + std::to_string(windows) + ": ";
  const Track track = ladder_track(windows);
  race({&accurate, &matching, &bdf}, track, repeats);
  for (Contender* c : {&accurate, &matching, &bdf}) {
    c->name = name + c->name;
    add(report, group, *c);
  }
  report.add({group, name + "CPU time at 1e-9 rad", accurate.best, "s", seconds_wanted, accurate.error});
  ratio(report, group, name + "dvm at 1e-9 rad / IDA at its 5e-3", accurate, bdf, "");
  ratio(report, group, name + "dvm / IDA at matching error", matching, bdf, "");
}

}  // namespace

// Tolerances of IDA: of all tried, those that cost least where it comes to the end with the error of three
// stages; with tighter ones its corrector fails at a collinear pose.
void ladder_cases(Report& report) {
  report.begin("Ladder at 30 m/s for 10 s: CPU time, largest error (m, the same in rad)");
  ladder(report, 1, dvm(6, 0.01), dvm(3, 0.01), ida(3e-9, 3e-7), 5, "<= 0.016");
  ladder(report, 40, dvm(6, 0.01), dvm(3, 0.01), ida(3e-9, 3e-7), 2, "<= 1.0");
}

}  // namespace unfurl::bench
