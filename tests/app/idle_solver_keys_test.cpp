// SPDX-License-Identifier: BSD-3-Clause
// What a scene or --set says of the solver and a verb has no use for.
#include <catch2/catch.hpp>

#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace idle_solver_keys_test {

namespace {

const std::vector<std::string> quick_study = {"study",   "double_pendulum", "--set", "solver.end_time=0.4",
                                              "--steps", "0.05:0.01"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

TEST_CASE("what a scene says of its solver and a verb does not do is told") {
  const ScratchDirectory dir;
  const auto told = [](const std::vector<std::string>& words) {
    const ProgramResult r = run_program(words);
    INFO(r.err);
    CHECK(r.code == 0);
    return r.err;
  };
  for (const char* model : {"path", "sector", "full", "auto"}) {
    const auto words =
        quick_study +
        std::vector<std::string>{
            "--repeats", "1", "--force", "-o", dir / "out", "--set", std::string("solver.model=") + model};
    const bool idle = std::string(model) == "path" || std::string(model) == "sector";
    const std::string err = told(words);
    CHECK((err.find("solver.model does nothing here: every method steps the whole model") < err.size()) ==
          idle);
  }
  const std::vector<std::string> settings = {"--set", "solver.model=path", "--set", "solver.tolerance=1e-6"};
  const std::string modes = told(std::vector<std::string>{"modes", "four_bar"} + settings),
                    margin = told(std::vector<std::string>{"margin", "hoop6_sector"} + settings);
  for (const char* setting : {"solver.model=path", "solver.tolerance=1e-6"}) {
    CHECK(modes.find(std::string("--set ") + setting + " does nothing: the pose at the start") <
          modes.size());
    CHECK(margin.find(std::string("--set ") + setting + " does nothing: margins are") < margin.size());
  }
  // A pose in motion is one of the motion as the scene has it solved.
  CHECK(told(std::vector<std::string>{"modes", "four_bar", "--at", "0.1"} + settings).empty());
}

TEST_CASE("a margin is warned of at the start as a run is, but for its steps") {
  const auto warned = [](const char* verb, const std::vector<std::string>& more) {
    const ScratchDirectory dir;
    std::vector<std::string> words{verb, "scissor_mast", "--quiet", "-o", dir / "out"};
    words.insert(words.end(), {"--set", "structure.cells=2", "--set", "solver.end_time=0.05"});
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult r = run_program(words);
    INFO(r.err);
    CHECK(r.code == 0);
    return r.err;
  };
  for (const std::vector<std::string>& more : {
           std::vector<std::string>{},
           {"--set", "structure.length_error=1e-3"},
           {"--set", R"(forces[0]={kind="latch",stiffness=10})", "--set", "structure.error_seed=3"},
       })
    CHECK(warned("margin", more) == warned("run", more));
}

}  // namespace idle_solver_keys_test
