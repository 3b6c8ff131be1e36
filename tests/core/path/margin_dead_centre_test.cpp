// SPDX-License-Identifier: BSD-3-Clause
// Static margins where nothing that acts has a lever: a ratio of nothing, whose limit is known.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/path/margin.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/table.hpp"

using namespace unfurl;

namespace margin_dead_centre_test {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

// A crank of 1 m and 1 kg that is 150 degrees from x, with a load of 2 N at its tip along x and a weight
// along -x, of half its mass at the tip: the lever of both is the sine of the angle.
Scene crank(double deployed, double weight, const std::vector<std::string>& more = {}) {
  static const std::string text = R"toml(
[structure]
kind = "custom"
nodes = [{name = "Q", position = [1, 0, 0], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
         {name = "P", position = ["=-cos(30*deg)", 0, "=sin(30*deg)"]}]
rods = [{nodes = ["O", "P"], mass = 1}]
[[constraints]]
kind = "plane"
nodes = ["*"]
normal = [0, 1, 0]
[[loads]]
nodes = ["P"]
force = [2, 0, 0]
[deployment]
measure = "angle P O Q about 0 1 0"
[solver]
end_time = 10
)toml";
  std::vector<std::string> changes{"deployment.deployed=" + exact_number(deployed),
                                   "gravity.acceleration=[" + exact_number(-weight) + ",0,0]"};
  changes.insert(changes.end(), more.begin(), more.end());
  return read_scene_text(text, "crank.toml", changes);
}

Margin margin_there(const Scene& scene) {
  return margin_of(build_model(scene), scene.solver);
}

// All levers vanish in the same way, so that ratios are those of the levers' factors everywhere: known to
// 1e-16 of the forces on the way, over the 1e-5 of the way next to it in which the limit is taken.
void check_margin(double value, double truth) {
  if (std::isfinite(truth))
    CHECK(value == Approx(truth).epsilon(1e-8).margin(1e-8));
  else
    CHECK(value == truth);
}

}  // namespace

TEST_CASE("a crank has the margin of its load over its weight up to its dead centre and behind it") {
  for (const double weight : {0.0, 1.7, 2.0, 3.3}) {
    const double before = weight > 0 ? 2 / (weight / 2) - 1 : unbounded;
    const double behind = weight / 2 / 2 - 1;
    INFO("weight " << weight);
    for (const double deployed : {0.0, 1e-6, 0.001, 0.3, 41.7, 143.0}) {
      INFO("deployed " << deployed);
      const Margin margin = margin_there(crank(deployed, weight));
      check_margin(margin.worst.margin, before);
      for (const MarginPoint& point : margin.points) check_margin(point.margin, before);
    }
    for (const double deployed : {-0.03, -1.0, -20.2, -25.3, -74.6, -90.0, -150.0}) {
      INFO("deployed " << deployed);
      const Margin margin = margin_there(crank(deployed, weight));
      check_margin(margin.worst.margin, std::min(before, behind));
      check_margin(margin.points.front().margin, before);
      check_margin(margin.points.back().margin, behind);
    }
  }
}

TEST_CASE("a limit at a dead centre is that of ratios that change on the way to it") {
  const auto spring = [](const std::string& free) {
    return "forces[0]={kind=\"torsion_spring\",nodes=[\"P\",\"O\",\"Q\"],axis=[0,1,0],stiffness=0.1,free_"
           "angle=" +
           free + "}";
  };
  // A spring with the torque 0.1 (150 deg - angle) resists at the dead centre, where nothing drives.
  check_margin(margin_there(crank(0, 0, {spring("150")})).worst.margin, -1);
  // One that is free at the dead centre drives with 0.1 angle, beside the load's 2 sin(angle) against 3.5 of
  // the weight: least at the end, as a / sin a is.
  check_margin(margin_there(crank(0, 7, {spring("0")})).worst.margin, 2.1 / 3.5 - 1);
}

TEST_CASE("the least margin behind a dead centre that is passed is the limit there of what follows") {
  // p = 0.1 t resists before, and drives against the load behind: p / 2 - 1, which rises with the time.
  const Margin margin =
      margin_there(crank(-74.6, 0,
                         {"forces[0]={kind=\"load_over_time\",name=\"p\",nodes=[\"P\"],force=[-1,0,0],"
                          "times=[0,100],values=[0,10]}"}));
  CHECK(margin.arrives);
  const double centre = margin.end_s * 150 / (150 + 74.6);
  std::vector<const MarginPoint*> behind;
  for (const MarginPoint& point : margin.points) {
    if (point.s < centre + 1e-3 || behind.size() == 5) continue;
    CHECK(point.margin == Approx(0.05 * point.t - 1).epsilon(1e-9));
    behind.push_back(&point);
  }
  // Steps of some 5e-3 s: the fifth power of that is what five of them leave.
  const double time = [&] {
    double sum = 0;
    for (const MarginPoint* a : behind) {
      double weight = 1;
      for (const MarginPoint* b : behind)
        if (a != b) weight *= (centre - b->s) / (a->s - b->s);
      sum += weight * a->t;
    }
    return sum;
  }();
  CHECK(margin.worst.margin == Approx(0.05 * time - 1).epsilon(2e-9));
  CHECK(margin.worst.s == Approx(centre).epsilon(2e-5));
}

TEST_CASE("masts and rings that deploy to their dead centre have the margins of the poses before it") {
  for (const auto& [cells, sides] : {std::pair{2, 1}, {5, 1}, {6, 1}, {10, 1}, {20, 1}, {6, 4}, {20, 4}})
    for (const double angle : {0.0, 1e-9, 1.0})
      for (const bool heavy : {true, false}) {
        INFO(cells << " cells, " << sides << " sides, " << angle << (heavy ? " deg, heavy" : " deg"));
        const Scene scene = read_scene_file(
            find_scene("scissor_mast"),
            {"structure.cells=" + std::to_string(cells), "structure.sides=" + std::to_string(sides),
             "structure.deployed_angle=" + exact_number(angle),
             std::string("gravity.acceleration=[0,0,") + (heavy ? "-0.5]" : "0]")});
        const auto model = build_model(scene);
        // All heights grow alike: those of the start tell the ratio of the works.
        const Structure& mast = model->structure;
        double top = 0, moment = 0;
        for (const Node& node : mast.nodes) {
          top = std::max(top, node.position.z());
          moment += node.mass * node.position.z();
        }
        for (const Rod& rod : mast.rods)
          moment += rod.mass * 0.5 *
                    (mast.nodes[static_cast<std::size_t>(rod.a)].position.z() +
                     mast.nodes[static_cast<std::size_t>(rod.b)].position.z());
        const Margin margin = margin_of(model, scene.solver);
        check_margin(margin.worst.margin, heavy ? 40 * top / (0.5 * moment) - 1 : unbounded);
        check_margin(margin.points.back().margin, margin.points.front().margin);
      }
  for (const std::string name : {"scissor_ring", "hoberman", "reentrant_sheet"}) {
    INFO(name);
    const Scene scene = read_scene_file(find_scene(name), {"structure.deployed_angle=0"});
    check_margin(margin_there(scene).worst.margin, unbounded);
  }
}

// Friction needs no lever: it holds where nothing drives, however small it is.
TEST_CASE("friction that goes on holding leaves no margin at a dead centre") {
  for (const double kinetic : {1e-9, 1e-5, 1e-2})
    for (const double deployed : {0.0, -25.3}) {
      INFO(kinetic << " N m, deployed at " << deployed << " deg");
      const Margin margin = margin_there(
          crank(deployed, 1.7,
                {"forces[0]={kind=\"friction\",name=\"fr\",nodes=[\"P\",\"O\",\"Q\"],axis=[0,1,0],kinetic=" +
                 exact_number(kinetic) + "}"}));
      CHECK(margin.worst.margin <= -1 + 1e-6);
    }
}

// A torsion spring drives an arm from rest up to its free angle and resists as far behind it: all its work is
// taken up where the motion ends, of both only rounding differs.
TEST_CASE("a margin that is nothing is told as nothing") {
  const Margin margin = margin_there(read_scene_text(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "G", position = [1, 0, 0], fixed = true},
         {name = "B", position = [1, 0, 0]}]
rods = [{nodes = ["A", "B"], mass = 3}, {nodes = ["A", "G"], mass = 1}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[[forces]]
kind = "torsion_spring"
nodes = ["G", "A", "B"]
axis = [0, 1, 0]
stiffness = 10
free_angle = 45
[deployment]
measure = "angle G A B about 0 1 0"
deployed = 90
[solver]
end_time = 20
)",
                                                     "arm.toml"));
  CHECK(margin.dynamic_min == 0.0);
  CHECK(margin.arrives);
}

}  // namespace margin_dead_centre_test
