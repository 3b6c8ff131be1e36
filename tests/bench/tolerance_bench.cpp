// SPDX-License-Identifier: BSD-3-Clause
// Accuracy as the input: is the true error below the tolerance, and how does the CPU time of the picked run
// compare with that of the best pair of stages and step found by exhaustive search? On motions with exact
// solutions; the last column is the claim's ratio. Written as CSV (first argument, else tolerance.csv).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/study/tolerance.hpp"
#include "tests/support/four_bar_exact.hpp"
#include "tests/support/models.hpp"

namespace {

using namespace unfurl;
using namespace unfurl::testing;

struct Motion {
  std::string name;
  std::shared_ptr<const Model> model;
  double end;                                                // [s]
  std::function<double(const VectorXd& q, double t)> error;  // largest node position error [m]
};

Motion ladder(int windows, double speed, double end) {
  return {"ladder N=" + std::to_string(windows) + " v=" + std::to_string(static_cast<int>(speed)),
          make_model(ladder_structure(windows, speed)), end, [=](const VectorXd& q, double t) {
            const double phi = exact::FourBarLadder{windows, speed}.angle(t);
            double worst = 0;
            for (int k = 0; k <= windows; ++k)
              worst = std::max(worst,
                               (q.segment<3>(6 * k + 3) - Vec3(k + std::sin(phi), std::cos(phi), 0)).norm());
            return worst;
          }};
}

// A corner and a hinge of the ring against those of the exact fold angle.
Motion ring(long units, double share) {
  const exact::Hoop hoop = exact_hoop({{"units", units}});
  const auto model = make_model(hoop_structure({{"units", units}, {"model", std::string("sector")}}));
  return {"ring n=" + std::to_string(units), model, share * hoop.time(0), [=](const VectorXd& q, double t) {
            const double theta = hoop.angle(t), off = model->structure.deployment.fold_angle(q) - theta;
            // Radius of the corners 2 l1 cos / 2 sin(pi/n) and height of the hinges l1 sin.
            const double radius = hoop.l1 * std::sin(theta) / std::sin(M_PI / hoop.n),
                         height = hoop.l1 * std::cos(theta);
            return std::abs(off) * std::max(radius, height);
          }};
}

double error_of(const Motion& motion, const Simulation& run) {
  if (run.status != RunStatus::completed) return std::numeric_limits<double>::infinity();
  const std::size_t last = run.trajectory.size() - 1;
  return motion.error(run.trajectory.node_positions(last), run.trajectory.time(last));
}

double fastest(const Motion& motion, const SolverOptions& options, double& error) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Simulation run = simulate(motion.model, options);
    error = error_of(motion, run);
    best = std::min(best, run.cpu_s);
    if (run.cpu_s > 0.3) break;
  }
  return best;
}

struct Pair {
  int stages;
  long steps;
  double cpu, error;
};

// Every number of stages with steps halved until round-off or half a second.
std::vector<Pair> all_pairs(const Motion& motion) {
  std::vector<Pair> pairs;
  for (int stages = 2; stages <= 8; ++stages)
    for (double steps = 16; steps < 3e5; steps *= std::sqrt(2.0)) {
      const long count = std::lround(steps);
      Pair pair{stages, count, 0, 0};
      pair.cpu = fastest(motion, dvm_options(stages, motion.end / static_cast<double>(count), motion.end),
                         pair.error);
      pairs.push_back(pair);
      if (pair.error < 2e-11 || pair.cpu > 0.25) break;
    }
  return pairs;
}

}  // namespace

int main(int count, char** words) {
  const std::vector<Motion> motions = {ring(6, 0.9),     ring(12, 0.9),   ladder(1, 1, 2),
                                       ladder(1, 30, 2), ladder(2, 3, 2), ladder(10, 10, 1)};
  std::FILE* csv = std::fopen(count > 1 ? words[1] : "tolerance.csv", "w");
  if (!csv) return 5;
  std::fprintf(
      csv,
      "motion,tolerance_m,error_m,estimate_m,stages,steps,cpu_s,best_stages,best_steps,best_cpu_s,ratio\n");
  std::printf("%-16s %9s %9s %9s %11s %9s %11s %9s %6s\n", "motion", "tolerance", "error", "estimate",
              "picked", "CPU s", "best", "CPU s", "ratio");
  int cases = 0, met = 0, cheap = 0;
  for (const Motion& motion : motions) {
    const std::vector<Pair> pairs = all_pairs(motion);
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      SolverOptions options = dvm_options(3, 0.01, motion.end);
      options.tolerance = tolerance;
      const Simulation run = simulate_as_asked(motion.model, options);
      const double error = error_of(motion, run);
      SolverOptions picked = run.options;
      picked.tolerance = 0;
      double again = 0;
      const double cpu = fastest(motion, picked, again);
      const Pair* best = nullptr;
      for (const Pair& p : pairs)
        if (p.error <= tolerance && (!best || p.cpu < best->cpu)) best = &p;
      if (!best) continue;
      ++cases, met += error <= tolerance, cheap += cpu <= 2 * best->cpu;
      std::printf("%-16s %9.0e %9.1e %9.1e %3d %7ld %9.5f %3d %7ld %9.5f %6.2f\n", motion.name.c_str(),
                  tolerance, error, run.position_estimate, run.options.stages, run.steps, cpu, best->stages,
                  best->steps, best->cpu, cpu / best->cpu);
      std::fprintf(csv, "%s,%g,%g,%g,%d,%ld,%g,%d,%ld,%g,%g\n", motion.name.c_str(), tolerance, error,
                   run.position_estimate, run.options.stages, run.steps, cpu, best->stages, best->steps,
                   best->cpu, cpu / best->cpu);
    }
  }
  std::printf("true error below the tolerance: %d of %d; CPU within 2x of the best pair: %d of %d\n", met,
              cases, cheap, cases);
  return std::fclose(csv) == 0 ? 0 : 5;
}
