// SPDX-License-Identifier: BSD-3-Clause
// What reports of studies say in words that are not the program's own.
#include <catch2/catch.hpp>
#include <fstream>

#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace study_report_test {

TEST_CASE("a name with marks is what it is in the report of a study") {
  const ScratchDirectory dir;
  std::ofstream(dir / "drop.toml") << R"([structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 0], fixed = true}, {name = "Q", position = [-1, 0, 1], fixed = true},
         {name = "B", position = [-1, 0, 0], mass = 1.0}]
rods = [{nodes = ["P", "B"], mass = 1.0}]
[[forces]]
kind = "cable"
name = "`a` *b*"
nodes = ["Q", "B"]
axial_stiffness = 15.0
length = 1.5
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.02
end_time = 0.6
)";
  const ProgramResult r = run_program({"study", dir / "drop.toml", "--methods", "dvm", "--repeats", "1",
                                       "--steps", "0.04:0.02", "-o", dir / "out", "--quiet"});
  REQUIRE(r.code == 0);
  CHECK(file_text(dir / "out/study.md").find(R"(the first time that \`a\` \*b\* pulls)") !=
        std::string::npos);
}

}  // namespace study_report_test
