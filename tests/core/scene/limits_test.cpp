// SPDX-License-Identifier: BSD-3-Clause
// End stops as scenes give them: which limits are taken, which are passed already, and in what unit.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/library.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/stops.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace limits_test {

namespace {

// A and B on two sides of O, C above it, all free but O.
std::string with(const std::string& entry) {
  return "[structure]\nkind = 'custom'\nnodes = [{name='O',position=[0,0,0],fixed=true},\n"
         "{name='A',position=[1,0,0],mass=1},{name='B',position=[-2,0,0],mass=1},\n"
         "{name='C',position=[0,1.5,0],mass=1},{name='D',position=[-3,4,0],mass=1}]\n"
         "rods=[{nodes=['O','A'],mass=1},{nodes=['O','B'],mass=1}]\n[[constraints]]\nname='end'\n" +
         entry + "\n[solver]\nstep = 0.01\n";
}

// What is said, without the place.
std::string said(const std::string& entry) {
  const std::string text = testing::error_of(with(entry));
  const auto at = text.find("constraints");
  return at == std::string::npos ? text : text.substr(at);
}

// All gaps at the start.
std::vector<double> gaps(const std::string& entry) {
  const auto model = testing::model_of(with(entry));
  const State start = initial_state(model->structure, model->system).state;
  const Stops stops(model->structure);
  std::vector<double> out;
  for (std::size_t i = 0; i < stops.size(); ++i) out.push_back(stops.gap(i, model->system, start));
  return out;
}

void are(const std::vector<double>& found, const std::vector<double>& wanted) {
  REQUIRE(found.size() == wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    CHECK(found[i] == Approx(wanted[i]).epsilon(0).margin(1e-12));
}

constexpr double degree = 3.14159265358979323846 / 180;

}  // namespace

TEST_CASE("limits are kept as they are given, lower and upper, in metres and degrees") {
  are(gaps("kind='coordinate_stop'\nnodes=['C']\ndirection=[0,3,4]\nmin=-0.2\nmax=7"), {1.1, 6.1});
  are(gaps("kind='coordinate_stop'\nnodes=['C','D']\ndirection=[0,2,0]\nmax=2.75"), {0.25});
  are(gaps("kind='length_stop'\nnodes=['O','D']\nmin=4.5\nmax=5"), {0.5, 0});
  are(gaps("kind='angle_stop'\nnodes=['A','O','C']\nmin=30\nmax=175"), {60 * degree, 85 * degree});
  are(gaps("kind='angle_stop'\nnodes=['A','O','C']\naxis=[0,0,2]\nmin=-300\nmax=500"),
      {390 * degree, 410 * degree});
  are(gaps("kind='clearance'\nnodes=['O','D']\nclearance=5.75"), {0.75});
  are(gaps("kind='clearance'\nnodes=['O','D']\nclearance=5"), {0});
  const auto model = testing::model_of(
      with("kind='angle_stop'\nnodes=['A','O','C']\nmin=30\nrestitution=0.35\nrest_speed=4"));
  CHECK(model->structure.stops.at(0).restitution == 0.35);
  CHECK(model->structure.stops.at(0).rest_speed == Approx(4 * degree));
  CHECK(model->structure.stops.at(0).name == "end");
  CHECK(std::isinf(model->structure.stops.at(0).max));
}

TEST_CASE("half a turn is the one that lies within the limits") {
  // From A to B about z: 180 degrees, or -180.
  const std::string half = "kind='angle_stop'\nnodes=['A','O','B']\naxis=[0,0,1]\n";
  are(gaps(half + "min=170\nmax=190"), {10 * degree, 10 * degree});
  are(gaps(half + "min=-190\nmax=-150"), {10 * degree, 30 * degree});
  are(gaps(half + "min=-190\nmax=200"), {370 * degree, 20 * degree});
  are(gaps(half + "max=-150"), {30 * degree});
  CHECK(said(half + "min=10\nmax=20").find("max: is passed already at t = 0, where the value is 180") !=
        std::string::npos);
  // Another angle is never turned.
  CHECK(said("kind='angle_stop'\nnodes=['A','O','C']\naxis=[0,0,1]\nmin=-290\nmax=-250")
            .find("max: is passed already at t = 0, where the value is 90") != std::string::npos);
}

TEST_CASE("limits that are passed, never met or missing are refused with the value") {
  const auto refused = [](const std::string& entry, const std::string& why) {
    INFO(entry << ": " << said(entry));
    CHECK(said(entry).find(why) != std::string::npos);
  };
  refused("kind='coordinate_stop'\nnodes=['C']\ndirection=[0,1,0]\nmin=1.6",
          "min: is passed already at t = 0, where the value is 1.5");
  refused("kind='coordinate_stop'\nnodes=['C']\ndirection=[0,1,0]\nmax=1.4",
          "max: is passed already at t = 0, where the value is 1.5");
  refused("kind='length_stop'\nnodes=['O','D']\nmin=5.001",
          "min: is passed already at t = 0, where the value is 5");
  refused("kind='coordinate_stop'\nnodes=['C']\ndirection=[0,1,0]",
          "min: is missing, and so is max: a stop needs a limit");
  refused("kind='coordinate_stop'\nnodes=['C']\ndirection=[0,0,0]\nmin=0", "direction: must not be zero");
  refused("kind='coordinate_stop'\nnodes=['C','D','A']\ndirection=[0,0,1]\nmin=0",
          "nodes: must be one or two");
  refused(
      "kind='angle_stop'\nnodes=['A','O','C']\nmin=-5",
      "min: is never met: without an axis the angle stays between 0 and 180 deg; give the axis of the hinge");
  refused("kind='clearance'\nnodes=['O','D']\nclearance=4.9",
          "clearance: is passed already at t = 0, where the nodes are 5 m apart");
  // Where it touches to a billionth, it is not passed.
  are(gaps("kind='coordinate_stop'\nnodes=['C']\ndirection=[0,1,0]\nmin=1.5000000005"), {-5e-10});
  CHECK(said("kind='coordinate_stop'\nnodes=['C']\ndirection=[0,1,0]\nmin=1.50000001") != "");
}

// A billionth of the structure, whatever its size: of 1 um that is 1e-15 m.
TEST_CASE("what is passed, agrees or is deployed at the start is judged alike at every size") {
  for (const char* size : {"1.0", "1e-6", "1e-9", "1e6"}) {
    const auto with_ending = [&](const std::string& ending) {
      INFO(size);
      return testing::error_of(std::string("[variables]\nL = ") + size +
                               "\n[structure]\nkind = 'custom'\n"
                               "nodes = [{name = 'A', position = [0, 0, 0], fixed = true},\n"
                               "{name = 'B', position = ['=L', 0, 0], mass = 1}]\nrods = []\n" +
                               ending);
    };
    INFO(size);
    const std::string stop = "[[constraints]]\nkind='coordinate_stop'\nnodes=['B']\ndirection=[1,0,0]\n";
    CHECK(with_ending(stop + "min='=L*(1+5e-10)'\n") == "");
    CHECK(with_ending(stop + "min='=L*(1+1e-8)'\n").find("is passed already") != std::string::npos);
    const std::string table =
        "[[constraints]]\nkind='length'\nnodes=['A','B']\nmotion='table'\ntimes=[0,1]\nvalues=";
    CHECK(with_ending(table + "['=L*(1+1e-8)','=2*L']\n").find("they must agree") != std::string::npos);
    const std::string deployment = "[deployment]\nmeasure='length A B'\ndeployed=";
    CHECK(with_ending(deployment + "'=1.01*L'\n") == "");
    CHECK(with_ending(deployment + "'=L*(1+1e-11)'\n").find("nothing deploys") != std::string::npos);
  }
}

TEST_CASE("a table of two rows moves a drive, of one it does not") {
  const std::string drive = "kind='coordinate'\nnodes=['C']\ndirection=[0,1,0]\nmotion='table'\n";
  CHECK(said(drive + "times=[0,2]\nvalues=[1.5,1.75]").empty());
  CHECK_FALSE(said(drive + "times=[0]\nvalues=[1.5]").empty());
  CHECK_FALSE(said(drive + "times=[0,2]\nvalues=[1.5]").empty());
  CHECK(said(drive + "times=[0,2]\nvalues=[1.6,1.75]").find("values: ") != std::string::npos);
}

TEST_CASE("drives that leave what their measure can be are refused, with the time and the key") {
  // 4000 samples of two seconds: the first at which 5 m less 3 m/s is no length is 1.667 s.
  const auto refused = [](const std::string& entry, const std::string& why) {
    const std::string text = testing::error_of(with(entry), {"solver.end_time=2"});
    INFO(text);
    CHECK(text.find(why) != std::string::npos);
  };
  const std::string length = "kind='length'\nnodes=['O','D']\n",
                    angle = "kind='angle'\nnodes=['A','O','C']\n";
  refused(length + "motion='rate'\nrate=-3",
          "rate: takes the length to -0.001 m at t = 1.667 s: it must stay > 0");
  refused(length + "motion='smooth'\nto=-1\nduration=1", "to: takes the length to ");
  refused(length + "motion='table'\ntimes=[0,1,2]\nvalues=[5,-1,4]", "values: takes the length to ");
  refused(angle + "motion='rate'\nrate=50",
          "rate: takes the angle to 180 deg at t = 1.8 s: without an axis the angle stays between 0 and 180 "
          "deg; give the axis of the hinge");
  const std::string sum = "kind='combination'\nmotion='rate'\n", ends = ", as distances stay > 0 and angles";
  refused(sum + "terms=['2 angle A O C']\nrate=120",
          "rate: takes the sum to 360 deg at t = 1.5 s: it stays > 0 deg and < 360 deg" + ends);
  refused(sum + "terms=['1 length O D', '0.5 length O C']\nrate=-4",
          "rate: takes the sum to 0 m at t = 1.438 s: it stays > 0 m" + ends);
  refused(sum + "terms=['-1 length O D']\nrate=4",
          "rate: takes the sum to 0 m at t = 1.25 s: it stays < 0 m");
  refused(angle + "motion='rate'\nrate=-50", "rate: takes the angle to 0 deg at t = 1.8 s: ");
  for (const std::string& fine :
       {length + "motion='rate'\nrate=-2.4", angle + "motion='rate'\nrate=44",
        angle + "axis=[0,0,1]\nmotion='rate'\nrate=500", sum + "terms=['2 angle A O C']\nrate=89",
        sum + "terms=['2 angle A O C about 0 0 1']\nrate=120",
        sum + "terms=['1 length O D', '-1 length O C']\nrate=-30",
        length + "motion='smooth'\nto=0.1\nduration=1",
        std::string("kind='coordinate'\nnodes=['C']\ndirection=[0,1,0]\nmotion='rate'\nrate=-30")})
    CHECK(testing::error_of(with(fine), {"solver.end_time=2"}) == "");
  // What deploys may have ended before; a drive with an end of its own says where it goes.
  const auto ring = [](const std::string& motion) {
    try {
      build_model(read_scene_file(
          find_scene("hoop6"), {"structure.model=joints", "solver.end_time=6",
                                "constraints[0]={kind='length',nodes=['Mb0','Mt0'],motion=" + motion + "}"}));
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(ring("'rate',rate=-3").empty());
  CHECK(ring("'smooth',to=-1,duration=2").find("to: takes the length to ") != std::string::npos);
}

// From 1 m on at -0.1 m/s behind a ramp of 1 s, which is worth half of it: half is left at 5.5 s, nothing at
// 10.5 s. An end_time that is left out is later than both.
TEST_CASE("a drive at a constant rate that a deployment ends before it is at its end is no mistake") {
  const std::string scene =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'W', position = [0, 0, 0], fixed = true}, {name = 'M', "
      "position = [1, 0, 0], mass = 2}]\n[[constraints]]\nkind = 'line'\nnodes = ['M']\ndirection = [1, 0, "
      "0]\n[[constraints]]\nkind = 'length'\nname = 'a'\nnodes = ['W', 'M']\nmotion = 'rate'\nrate = -0.1\n"
      "ramp = 1\n[deployment]\nmeasure = 'a'\ndeployed = 0.5\n[solver]\nstep = 0.01\n";
  const Simulation run = testing::run_scene(scene, {"solver.end_time=11"});
  REQUIRE(run.status == RunStatus::deployed);
  CHECK(run.events.front().t == Approx(5.5).epsilon(1e-9));
  CHECK(testing::run_scene(scene).status == RunStatus::deployed);
  // What passes, and what a latch holds, is driven on.
  for (const char* at : {"pass", "latch"})
    CHECK(testing::error_of(scene, {std::string("solver.at_deployed=") + at})
              .find("rate: takes the length to ") != std::string::npos);
}

// |x| has no way on through 0, nor an angle without a sign through 0 and 180 degrees: it turns back there, a
// stop at such a limit would never act, and no latch would hold.
TEST_CASE("limits at which a measure turns back are refused") {
  const std::string angle = "kind='angle_stop'\nnodes=['A','O','C']\n",
                    length = "kind='length_stop'\nnodes=['O','D']\n", axis = "axis=[0,0,1]\n",
                    never =
                        "is never met: without an axis the angle stays between 0 and 180 deg; give the "
                        "axis of the hinge";
  for (const char* limit : {"max=180", "max=200", "min=0", "min=-10"}) {
    INFO(limit);
    CHECK(said(angle + limit).find(never) != std::string::npos);
    CHECK(said(angle + axis + limit).empty());
  }
  for (const char* limit : {"max=179.5", "min=0.5"}) CHECK(said(angle + limit).empty());
  for (const char* limit : {"min=0", "min=-0.1"})
    CHECK(said(length + limit).find("is never met: a distance stays > 0") != std::string::npos);
  CHECK(said(length + "min=1e-6").empty());
  const auto latched = [](const std::string& deployment, const char* at) {
    return testing::error_of(with("kind='plane'\nnodes=['C']\nnormal=[0,0,1]\n[deployment]\n" + deployment),
                             {std::string("solver.at_deployed=") + at});
  };
  const std::string measure = "measure='angle A O C'\ndeployed=";
  for (const char* end : {"180", "0"}) {
    CHECK(
        latched(measure + end, "latch").find("cannot be held by a latch, as the measure turns back there") !=
        std::string::npos);
    CHECK(latched(measure + end, "stop").empty());
    CHECK(latched(std::string("measure='angle A O C about 0 0 1'\ndeployed=") + end, "latch").empty());
  }
  for (const char* at : {"stop", "latch"}) {
    for (const char* end : {"190", "-3"})
      CHECK(latched(measure + end, at).find("deployed: is never reached: without an axis") !=
            std::string::npos);
    CHECK(latched("measure='length O D'\ndeployed=-1", at).find("is never reached: a distance stays > 0") !=
          std::string::npos);
  }
  // In line at the start a sum of angles has no direction to grow in.
  for (const char* entry : {"kind='combination'\nterms=['1 angle A O B']",
                            "kind='gear'\nnodes=['A','O','B','A','O','C']\nradii=[1,2]",
                            "kind='rack'\nnodes=['A','O','B','C']\nradius=0.3\ndirection=[0,1,0]"}) {
    INFO(entry);
    CHECK(said(entry).find("rods are in line at t = 0, where an angle without one has no direction") !=
          std::string::npos);
  }
}

}  // namespace limits_test
