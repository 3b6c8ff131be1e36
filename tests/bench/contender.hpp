// SPDX-License-Identifier: BSD-3-Clause
// One competitor of a race for CPU time at a measured error.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/integrators/integrator.hpp"
#include "core/simulate/simulation.hpp"
#include "tests/bench/report.hpp"
#include "tests/support/ida_reference.hpp"

namespace unfurl::bench {

// What is raced over: a model to `end`, and its exact node coordinates at the times where errors are
// measured.
struct Track {
  std::shared_ptr<const Model> model;
  double end;  // [s]
  std::vector<double> times;
  std::vector<VectorXd> exact;  // node coordinates at `times` [m]
};

struct Contender {
  std::string name;
  std::function<std::unique_ptr<Integrator>(const Model&)> make;
  double h;
  double best = 1e300;       // CPU time of the stepping loop, the smallest of all repeats [s]
  double error = 0;          // largest distance of a node from where it should be, at the track's times [m]
  std::string failure = {};  // why it did not finish
  double absolute_tolerance = 0;  // of IDA [m], [m/s]
  double relative_tolerance = 0;  // of what takes steps of its own; 0: it takes steps of h
  std::string settings = {};      // in words, where neither of them tells
};

Contender dvm(int stages, double h);
// With steps that follow the motion (solver.adaptive), those between two of the track's times its own.
Contender adaptive_dvm(int stages, double largest_step, double turn);
Contender rk4(double h);
// IDA has no step: `h` is its relative tolerance.
Contender ida(double relative_tolerance, double absolute_tolerance);

void run(Contender& c, const Track& track);
// Repeats are interleaved: a slow spell of the machine meets every contender.
void race(const std::vector<Contender*>& contenders, const Track& track, int repeats);

void add(Report& report, const std::string& group, const Contender& c);
void ratio(Report& report, const std::string& group, const std::string& what, const Contender& a,
           const Contender& b, const char* target);

}  // namespace unfurl::bench
