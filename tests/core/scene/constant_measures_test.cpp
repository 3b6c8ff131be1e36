// SPDX-License-Identifier: BSD-3-Clause
// Sums that nothing changes are refused; what [deployment] names is told for what it is.
#include <catch2/catch.hpp>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace constant_measures_test {

namespace {

using testing::error_of, testing::model_of, testing::run_scene;

// A bar of 1.3 m that turns about O, a second one at its end, P and Q held, C free.
const std::string bars = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "P", position = [0.3, -1, 0], fixed = true},
  {name = "Q", position = [-0.6, 0.2, 0.5], fixed = true},
  {name = "A", position = [0.5, 1.2, 0], mass = 0.7},
  {name = "B", position = [1.4, 1.3, 0.2], mass = 1.1},
  {name = "C", position = [1.0, 0.3, 0.7], mass = 1}]
rods = [{nodes = ["O", "A"], mass = 2}, {nodes = ["A", "B"], mass = 0.5}]
[solver]
step = 0.01
end_time = 0.02
)";

std::string with_terms(const std::string& terms) {
  return "kind = 'combination'\nstiffness = 1\nterms = [" + terms + "]\n";
}

}  // namespace

// By an identity of geometry each: |AC| = |CA|; an angle about an axis has the sign of the axis, the dihedral
// that of the order of its ends; x + y along (1, 1, 0) is the sum of both, over the root of 2; a line has no
// angle to itself.
TEST_CASE("sums whose terms cancel or stay are refused with their place") {
  const std::string cancel = "terms: is the same whatever moves: its terms cancel",
                    stay = "terms: is the same whatever moves: rigid rods keep their lengths";
  for (const char* terms :
       {"'1 length A C', '-1 length A C'", "'1 length A C', '-1 length C A'",
        "'2 length A C', '-1 length C B', '-2 length A C', '1 length B C'",
        "'1 angle O A B about 0 0 1', '1 angle O A B about 0 0 -1'",
        "'1 dihedral O A B C', '-1 dihedral C B A O'", "'1 angle C A C'",
        "'1 coordinate C along 1 0 0', '1 coordinate C along 0 1 0', '-1.4142135623730951 coordinate C along "
        "1 1 0'"}) {
    INFO(terms);
    CHECK(error_of(bars + "[[forces]]\n" + with_terms(terms)).find("forces[0]." + cancel) !=
          std::string::npos);
    CHECK(error_of(bars + "[[constraints]]\nkind = 'combination'\nterms = [" + terms + "]\n")
              .find("constraints[0]." + cancel) != std::string::npos);
  }
  for (const char* terms : {"'1 length P Q'", "'1 coordinate P along 1 0 0', '2 angle P O Q'"}) {
    INFO(terms);
    CHECK(error_of(bars + "[[forces]]\n" + with_terms(terms)).find("forces[0]." + stay) != std::string::npos);
  }
  for (const char* term : {"1 length O A", "-2 length A B", "1 length P Q"}) {
    INFO(term);
    CHECK(error_of(bars + "[deployment]\nmeasure = ['" + term + "', '3 length A B']\ndeployed = 9\n")
              .find("deployment.measure: is the same whatever moves: rigid rods keep their lengths") !=
          std::string::npos);
  }
}

// What changes with something that moves stays allowed: half of a pair that cancels, a rod that gives or that
// is warmed, a held and a free node; a spring along a rigid rod, which is idle until the rod gives.
TEST_CASE("sums that something changes are taken") {
  for (const char* terms :
       {"'1 length O A'", "'1 length A C', '-0.5 length C A'", "'1 length P C'",
        "'1 length O A', '1 length A C'", "'1 angle O A B about 0 0 1', '-1 angle O A B about 0 1 1'",
        "'1 coordinate C along 1 0 0', '-1 "
        "coordinate A along 1 0 0'"}) {
    INFO(terms);
    CHECK(error_of(bars + "[[forces]]\n" + with_terms(terms)).empty());
  }
  CHECK(error_of(bars + "[[forces]]\n" + with_terms("'1 length O A'"),
                 {"structure.rods.O-A.elastic=true", "structure.rods.O-A.youngs_modulus=7e10",
                  "structure.rods.O-A.area=1e-4"})
            .empty());
}

TEST_CASE("a deployment says what is wrong with the entry that it names") {
  const std::string entries =
                        "[[forces]]\nkind = 'spring'\nname = 'pull'\nnodes = ['P', 'C']\nstiffness = 2\n"
                        "[[forces]]\nkind = 'drag'\nname = 'air'\nnodes = ['C']\ndamping = 0.1\n",
                    at = "deployment.measure: ";
  const auto said = [&](const std::string& measure, const std::vector<std::string>& set = {}) {
    return error_of(bars + entries + "[deployment]\nmeasure = " + measure + "\ndeployed = 0.4\n", set);
  };
  CHECK(said("'pull'").empty());
  CHECK(said("'pull'", {"forces.pull.enabled=false"}).find(at + "'pull' is switched off: enabled = false") !=
        std::string::npos);
  CHECK(said("['pull', '1 length A C']")
            .find(at + "'pull' is an entry, which is measured by itself, in no sum") != std::string::npos);
  CHECK(said("'pul'").find(at + "there is no force and no constraint 'pul'; did you mean 'pull'?") !=
        std::string::npos);
  CHECK(error_of(bars +
                 "[[forces]]\nkind = 'spring'\nname = 'length_pull'\nnodes = ['P', 'C']\nstiffness = 2\n" +
                 "[deployment]\nmeasure = 'length_pul'\ndeployed = 0.4\n")
            .find("'length_pul'; did you mean 'length_pull'?") != std::string::npos);
  CHECK(said("'air'").find(at + "'air' measures nothing") != std::string::npos);
  CHECK(said("'banana'").find("does not begin with a number") != std::string::npos);
  CHECK(said("['1 length A C', '-1 length C A']").find(at + "is the same whatever moves") !=
        std::string::npos);
  // A term is one, also where an entry that is off is called by it.
  const std::string off = "[[forces]]\nenabled = false\n" + with_terms("'1 length A C'");
  CHECK(error_of(bars + off + "[deployment]\nmeasure = '1 length A C'\ndeployed = 0.4\n").empty());
}

// C leaves P, a metre a second along x, in a pin with a play of 0.5 m: it is 0.25 m away after 0.25 s. The
// event is found to 1e-9 of the step at least.
TEST_CASE("a deployment measures a clearance as the distance of its nodes") {
  const std::string play = R"(
structure = {kind = "custom", nodes = [{name = "P", position = [0, 0, 0], fixed = true},
  {name = "C", position = [0, 0, 0], velocity = [1, 0, 0], mass = 1}]}
constraints = [{kind = "clearance", name = "play", nodes = ["P", "C"], clearance = 0.5}]
solver = {step = 0.01, end_time = 0.4}
deployment = {deployed = 0.25, measure = )";
  for (const char* measure : {"'play'", "'length P C'"}) {
    const Simulation run = run_scene(play + measure + "}\n");
    INFO(measure);
    REQUIRE(run.events.size() == 1);
    CHECK(run.events[0].name == "deployed");
    CHECK(std::abs(run.events[0].t - 0.25) < 1e-11);
  }
}

}  // namespace constant_measures_test
