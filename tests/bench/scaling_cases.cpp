// SPDX-License-Identifier: BSD-3-Clause
// Cost and memory against size: per step and rod both should stay flat.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/structures/mesh_reflector.hpp"
#include "tests/bench/cases.hpp"
#include "tests/support/models.hpp"

namespace unfurl::bench {
namespace {

struct Measured {
  double seconds = 0, kilobytes = 0;
  int ok = 0;
};

double peak_kilobytes() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word)
    if (word == "VmHWM:") {
      double kb = 0;
      status >> kb;
      return kb;
    }
  return 0;
}

Measured stepped(const Structure& structure, int steps, double h) {
  Measured m;
  const double before = peak_kilobytes();
  const auto model = testing::make_model(structure);
  const auto integrator = find_method("dvm")->make(model->system, testing::dvm_options(3, h, 1));
  State state = initial_state(model->structure, model->system).state;
  m.ok = 1;
  for (int i = 0; i < 3; ++i) m.ok = m.ok && integrator->step(state, h).ok();
  const double begin = cpu_seconds();
  for (int i = 0; i < steps; ++i) m.ok = m.ok && integrator->step(state, h).ok();
  m.seconds = cpu_seconds() - begin;
  m.kilobytes = peak_kilobytes() - before;
  return m;
}

// In a process of its own, so that its peak memory is its own.
Measured measure(const std::function<Structure()>& build, int steps, double h) {
  int ends[2];
  Measured m;
  if (pipe(ends)) return m;
  if (const pid_t child = fork(); child == 0) {
    m = stepped(build(), steps, h);
    const bool written = write(ends[1], &m, sizeof m) == sizeof m;
    _exit(written ? 0 : 1);
  } else {
    close(ends[1]);
    if (read(ends[0], &m, sizeof m) != sizeof m) m = {};
    close(ends[0]);
    waitpid(child, nullptr, 0);
  }
  return m;
}

// A reflector on a ring that its hinges open, radius and focal length growing with the number of its units.
// Folded by 15 degrees its nets are slack, and go taut in the steps that are measured.
Structure reflector(int units, int rings) {
  ParamSet values(mesh_reflector_params());
  values.set("hoop", std::string("hoop"));
  values.set("units", std::int64_t{units});
  values.set("net_rings", std::int64_t{rings});
  values.set("focal_length", 1.0 * units);
  values.set("post_length", 2.2);
  values.set("fold_angle", 15.0);
  return build_mesh_reflector(values);
}

void nets(Report& report) {
  double lowest = 1e300, highest = 0;
  for (const auto& [units, rings] : {std::pair{6, 2}, {12, 4}, {18, 6}, {30, 10}}) {
    const int members = static_cast<int>(std::ssize(reflector(units, rings).forces)), steps = 60000 / members;
    const Measured m =
        measure([u = units, r = rings] { return reflector(u, r); }, std::clamp(steps, 20, 100), 0.002);
    const double cost = 1e6 * m.seconds / std::clamp(steps, 20, 100) / members;
    lowest = std::min(lowest, cost);
    highest = std::max(highest, cost);
    report.add({"scaling",
                "reflector of " + std::to_string(units) + " units, " + std::to_string(members) +
                    " net members" + (m.ok ? "" : " (FAILED)") + ": step and member",
                cost, "us", ""});
  }
  report.add({"scaling", "reflectors, dearest / cheapest", highest / lowest, "ratio", "<= 1.5"});
}

}  // namespace

void scaling_cases(Report& report) {
  report.begin("Cost and memory against size: dvm, 3 stages, h = 0.01 s (chain: 0.001 s), after 3 steps");
  double first = 0, lowest = 1e300, highest = 0;
  const auto row = [&](const std::string& name, const std::function<Structure()>& build, int rods, int steps,
                       double h = 0.01) {
    Measured m = measure(build, steps, h);
    for (int i = 0; i < 2; ++i) m.seconds = std::min(m.seconds, measure(build, steps, h).seconds);
    const double cost = 1e6 * m.seconds / steps / rods;
    if (first == 0) first = cost;
    lowest = std::min(lowest, cost);
    highest = std::max(highest, cost);
    report.add({"scaling", name + (m.ok ? "" : " (FAILED)") + ": step and rod", cost, "us", ""});
    if (rods >= 1000) report.add({"scaling", name + ": peak memory a rod", m.kilobytes / rods, "kB", "<= 6"});
    if (rods >= 50000) report.add({"scaling", name + ": 100 steps", m.seconds * 100 / steps, "s", "<= 60"});
  };
  for (const int n : {6, 24, 100, 1000, 10000})
    row(
        "ring of " + std::to_string(n) + " units",
        [n] {
          return testing::hoop_structure({{"units", std::int64_t{n}}});
        },
        5 * n,
        n >= 10000  ? 30
        : n >= 1000 ? 100
                    : 30000 / n);
  row(
      "chain of 1000 rods", [] { return chain_of_rods(1000); }, 1000, 100, 0.001);
  report.add({"scaling", "dearest / cheapest", highest / lowest, "ratio", "<= 1.5"});
  nets(report);
}

}  // namespace unfurl::bench
