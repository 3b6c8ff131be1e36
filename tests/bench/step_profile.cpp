// SPDX-License-Identifier: BSD-3-Clause
// Steps of one case and nothing else, to count instructions:
//
//     valgrind --tool=callgrind --toggle-collect='*Dvm::step*' build/release/tests/bench/step_profile sector
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/bench/cases.hpp"
#include "tests/support/models.hpp"

namespace unfurl::bench {
namespace {

struct ProfiledCase {
  std::string_view name;
  Structure (*build)();
  int stages;
  double h;
  int steps;
};

constexpr ProfiledCase profiled_cases[] = {
    {"ring", [] { return testing::hoop_structure(); }, 5, 0.01, 490},
    {"sector",
     [] {
       return testing::hoop_structure({{"model", std::string("sector")}});
     },
     5, 0.01, 490},
    {"ladder", [] { return testing::ladder_structure(1, 30); }, 6, 0.01, 1000},
    {"ring24",
     [] {
       return testing::hoop_structure({{"units", std::int64_t{24}}});
     },
     3, 0.01, 100},
    {"ring1000",
     [] {
       return testing::hoop_structure({{"units", std::int64_t{1000}}});
     },
     3, 0.01, 20},
    {"chain", [] { return chain_of_rods(1000); }, 3, 0.001, 103},
};

int run_profiled(const ProfiledCase& c) {
  const auto model = testing::make_model(c.build());
  const auto integrator = find_method("dvm")->make(model->system, testing::dvm_options(c.stages, c.h, 1));
  State state = initial_state(model->structure, model->system).state;
  long iterations = 0, factorisations = 0, right_sides = 0;
  for (int i = 0; i < c.steps; ++i) {
    const StepReport report = integrator->step(state, c.h);
    if (!report.ok()) return std::fprintf(stderr, "step %d failed\n", i), 4;
    iterations += report.newton_iterations;
    factorisations += report.factorisations;
    right_sides += report.right_hand_sides;
  }
  std::printf(
      "%d steps of %ld coordinates, %ld constraints: %ld iterations, %ld factorisations, %ld right-hand "
      "sides\n",
      c.steps, static_cast<long>(model->system.solved_coordinates()),
      static_cast<long>(model->system.constraints()), iterations, factorisations, right_sides);
  return 0;
}

}  // namespace
}  // namespace unfurl::bench

int main(int count, char** words) {
  for (const auto& c : unfurl::bench::profiled_cases)
    if (count > 1 && c.name == words[1]) return unfurl::bench::run_profiled(c);
  for (const auto& c : unfurl::bench::profiled_cases)
    std::printf("%.*s\n", static_cast<int>(c.name.size()), c.name.data());
  return 2;
}
