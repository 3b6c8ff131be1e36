// SPDX-License-Identifier: BSD-3-Clause
// Entries that are switched off, expressions of whole numbers, errors of length that nothing can take up.
#include <catch2/catch.hpp>
#include <string>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace left_out_test {

TEST_CASE("an entry that is switched off does without the file of its table") {
  const std::string body = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [1, 0, 0], mass = 2}, {name = "O", position = [0, 0, 0], fixed = true}]
rods = [{nodes = ["O", "A"], mass = 1}]
)";
  for (const char* entry :
       {"[[forces]]\nkind = 'load_over_time'\nnodes = ['A']\nforce = [0, 0, 1]\n",
        "[[constraints]]\nkind = 'coordinate'\nnodes = ['A']\ndirection = [0, 0, 1]\nmotion = 'table'\n",
        "[[forces]]\nkind = 'temperature'\nrods = ['*']\nexpansion = 1e-5\nchange = 10\n"}) {
    CAPTURE(entry);
    const std::string scene = body + entry + "table = 'none.csv'\n";
    CHECK_THAT(testing::error_of(scene), Catch::Contains("table"));
    CHECK(testing::error_of(scene + "enabled = false\n") == "");
  }
}

// 4.2 / 0.7 is 6.000000000000001 in doubles, and 0.6 / 0.1 5.999999999999999.
TEST_CASE("a whole number may be an expression that is one but for rounding") {
  for (const char* units : {"=4.2/0.7", "=0.6/0.1", "=6"}) {
    CAPTURE(units);
    const std::string scene = std::string("[structure]\nkind = 'hoop'\nunits = '") + units + "'\n";
    CHECK(testing::model_of(scene)->structure.rods.size() ==
          testing::model_of("[structure]\nkind = 'hoop'\nunits = 6\n")->structure.rods.size());
  }
  CHECK(testing::error_of("[structure]\nkind = 'hoop'\nunits = '=6.001'\n").find("whole number") !=
        std::string::npos);
}

// Six units of rods have 78 rows of rank 71: no pose has lengths of their own, whatever the error's size.
TEST_CASE("errors of length that rigid rods cannot take up are named by their key") {
  for (const char* size : {"1e-11", "1e-9", "1e-3"}) {
    const std::string said =
        testing::error_of(std::string("[structure]\nkind = 'hoop'\nlength_error = ") + size + "\n");
    CHECK_THAT(said, Catch::Contains("structure.length_error: ") &&
                         Catch::Contains("rod_model = \"elastic\"") && !Catch::Contains("rods["));
  }
}

}  // namespace left_out_test
