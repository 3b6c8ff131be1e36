// SPDX-License-Identifier: BSD-3-Clause
// What studies, sweeps and solve do not take: it is told, and nothing of it is left.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace refused_studies_test {

TEST_CASE("damaged rows of an earlier sweep are told of and computed anew") {
  const ScratchDirectory dir;
  const std::vector<std::string> sweep = {"sweep",     "pendulum", "--vary", "structure.angle=10,20,30",
                                          "--measure", "energy",   "--set",  "solver.end_time=0.3",
                                          "-o",        dir / "out"};
  REQUIRE(run_program(sweep).code == 0);
  const std::string right = file_text(dir / "out/sweep.csv");
  const std::size_t begin = right.find("\n20,") + 1, end = right.find('\n', begin);
  REQUIRE(begin > 1);
  for (const char* row : {"20,banana,0.12", "20,completed,nan", "20,completed,inf", "20,completed,-1"}) {
    INFO(row);
    std::ofstream(dir / "out/sweep.csv") << right.substr(0, begin) << row << right.substr(end);
    const ProgramResult again = run_program(sweep);
    CHECK(again.code == 0);
    CHECK(again.err.find("sweep.csv: line 3 is no finished result and was not taken") != std::string::npos);
    CHECK(file_text(dir / "out/sweep.csv") == right);
  }
  CHECK(run_program(sweep).err.find("no finished result") == std::string::npos);
}

TEST_CASE("a study that is refused leaves nothing behind") {
  const ScratchDirectory dir;
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--methods", "rk5"}, {"--steps", "0.1:0.2"}, {"--steps", "90:0.1"}}) {
    std::vector<std::string> words{"study", "pendulum", "-o", dir / "out"};
    words.insert(words.end(), wrong.begin(), wrong.end());
    const ProgramResult r = run_program(words);
    INFO(r.err);
    CHECK(r.code == 2);
    CHECK_FALSE(std::filesystem::exists(dir / "out"));
  }
}

TEST_CASE("solve says of a key that takes no number what it is") {
  for (const std::vector<std::string>& where :
       {std::vector<std::string>{}, std::vector<std::string>{"--between", "1:2"}}) {
    std::vector<std::string> words{"solve",           "hoop6",    "--find",
                                   "structure.model", "--target", "deploy_time=4.92"};
    words.insert(words.end(), where.begin(), where.end());
    const ProgramResult r = run_program(words);
    CHECK(r.code == 2);
    CHECK(r.err.find("unfurl: 'structure.model' takes no number: it is ") == 0);
    CHECK(r.err.find("--set") == std::string::npos);
  }
  // A key that is not there keeps its own message.
  const ProgramResult unknown =
      run_program({"solve", "hoop6", "--find", "structure.modl", "--target", "deploy_time=4.92"});
  CHECK(unknown.err.find("did you mean 'model'?") != std::string::npos);
}

}  // namespace refused_studies_test
