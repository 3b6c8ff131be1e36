// SPDX-License-Identifier: BSD-3-Clause
// The deployment time of rings that start next to their dead centre against the exact one: start x model x
// stages x step, errors in seconds and CPU time.
//
//     build/release/tests/bench/weak_modes_bench [smallest step, default 0.005]
#include <cstdio>
#include <cstdlib>

#include "tests/support/models.hpp"

namespace unfurl::bench {
namespace {

void row(const char* model, double fold_angle, int stages, double step, bool eliminate_linear) {
  SolverOptions options = testing::dvm_options(stages, step, 30);
  options.eliminate_linear = eliminate_linear;
  const Structure ring = testing::hoop_structure({{"model", std::string(model)}, {"fold_angle", fold_angle}});
  const Simulation run = simulate(testing::make_model(ring, eliminate_linear), options);
  std::printf("%-7s%-6s %-13.10g %d %7g  ", model, eliminate_linear ? "" : " -el", fold_angle, stages, step);
  if (run.status == RunStatus::deployed)
    std::printf("%+9.1e s", run.events[0].t - testing::exact_hoop({{"fold_angle", fold_angle}}).time(0));
  else
    std::printf("%s", run.message.c_str());
  std::printf("  %8.3f s\n", run.cpu_s);
  std::fflush(stdout);
}

}  // namespace
}  // namespace unfurl::bench

int main(int count, char** arguments) {
  const double smallest = count > 1 ? std::atof(arguments[1]) : 0.005;
  std::printf("model         start [deg]   s    step  error of the time  CPU\n");
  for (const char* model : {"full", "sector", "joints"})
    for (const double fold_angle : {80.0, 89.0, 89.9, 89.99, 89.9999, 89.9999999})
      for (const int stages : {4, 5, 6})
        for (const double step : {0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001})
          if (step >= smallest) unfurl::bench::row(model, fold_angle, stages, step, true);
  for (const double fold_angle : {89.0, 89.9999, 89.9999999})
    unfurl::bench::row("full", fold_angle, 4, 0.02, false);
}
