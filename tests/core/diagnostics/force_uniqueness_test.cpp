// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/force_uniqueness.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/math/factors.hpp"
#include "core/scene/library.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace force_uniqueness_test {

using testing::run_scene;

namespace {

Simulation library_run(const char* scene, const std::vector<std::string>& changes) {
  const Scene s = read_scene_file(find_scene(scene), changes);
  return simulate(build_model(s), s.solver);
}

Index rank(const MatrixXd& A) {
  return A.size() > 0 ? rank_of(A, 1e-9) : 0;
}

// By the definition: removing a rod's row lowers the rank.
bool unique_by_rank(const Trajectory& trajectory, std::size_t state, Index rod) {
  const System& system = trajectory.model(state).system;
  MatrixXd G(system.all_jacobian(trajectory.node_positions(state)));
  for (Index r = 0; r < G.rows(); ++r)
    if (const double norm = G.row(r).norm(); norm > 0) G.row(r) /= norm;
  const auto rods = static_cast<Index>(trajectory.structure().rods.size());
  const Index all = rank(G);
  G.row(G.rows() - rods + rod).setZero();
  return rank(G) < all;
}

}  // namespace

TEST_CASE("at every state of a run a force is unique where removing its rod lowers the rank") {
  const std::vector<std::pair<const char*, std::vector<std::string>>> runs{
      {"hoop6", {"structure.units=4", "solver.step=0.2"}},
      {"hoop6", {"structure.units=4", "solver.step=0.2", "solver.at_deployed=latch"}},
      {"hoop6_motor", {"structure.units=3", "solver.step=0.5"}},
      {"hoop6_sector", {"solver.step=0.2"}},
      {"bricard", {"solver.step=0.2"}},
      {"four_bar", {"solver.end_time=1"}},
      {"hoop_arc", {"solver.end_time=0.5"}},
      {"scissor_mast", {"solver.step=0.2"}}};
  for (const auto& [scene, changes] : runs) {
    const Simulation run = library_run(scene, changes);
    const Diagnostics d = diagnose(run);
    const auto rods = static_cast<Index>(run.trajectory.structure().rods.size());
    int compared = 0;
    for (std::size_t i = 0; i < run.trajectory.size(); i += 7) {
      if (run.trajectory.report(i).singular_event) continue;  // carried over as a limit
      for (Index r = 0; r < rods; ++r, ++compared) {
        INFO(scene << ", state " << i << ", rod " << r);
        CHECK(d.force_unique(static_cast<Index>(i), r) == unique_by_rank(run.trajectory, i, r));
      }
    }
    CHECK(compared > 0);
  }
}

TEST_CASE("rods that are parallel or there twice are not unique, and carry together what one would") {
  const std::string twice =
      "[structure]\nkind = 'custom'\n"
      "[[structure.nodes]]\nname = 'O'\nposition = [0.2, 0, 0]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'A'\nposition = [1.3, 0, -0.4]\nmass = 1.7\n"
      "[[structure.nodes]]\nname = 'B'\nposition = [1.9, 0, -1.3]\nmass = 0.6\n"
      "[[structure.rods]]\nname = 'upper'\nnodes = ['O', 'A']\nmass = 0.8\n"
      "[[structure.rods]]\nname = 'lower'\nnodes = ['A', 'B']\nmass = 0.5\n";
  const std::string rest =
      "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstages = 4\nstep = 0.01\nend_time = 0.5\n";
  const Diagnostics one = diagnose(run_scene(twice + rest)),
                    two = diagnose(run_scene(
                        twice + "[[structure.rods]]\nname = 'again'\nnodes = ['O', 'A']\nmass = 0\n" + rest));
  REQUIRE(one.t.size() == two.t.size());
  CHECK(one.rod_unique == std::vector<char>{1, 1});
  CHECK(two.rod_unique == std::vector<char>{0, 1, 0});
  double off = 0, largest = 0;
  for (Index i = 0; i < one.axial_force.rows(); ++i) {
    off = std::max({off, std::abs(two.axial_force(i, 0) + two.axial_force(i, 2) - one.axial_force(i, 0)),
                    std::abs(two.axial_force(i, 1) - one.axial_force(i, 1))});
    largest = std::max(largest, std::abs(one.axial_force(i, 0)));
  }
  // The reported multipliers carry 1e-9 of round-off in redundant directions (index1.hpp).
  CHECK(off < 1e-8 * largest);
  CHECK(peak_rod_force(one).unique);
}

TEST_CASE("a parallelogram that starts flat opens its forces at the start alone") {
  const Simulation run = run_scene(
      "[structure]\nkind = 'custom'\n"
      "[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'P'\nposition = [2, 0, 0]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'A'\nposition = [1, 0, 0]\nvelocity = [0, 0, 1]\nmass = 1.3\n"
      "[[structure.nodes]]\nname = 'B'\nposition = [3, 0, 0]\nvelocity = [0, 0, 1]\nmass = 0.7\n"
      "[[structure.constraints]]\nkind = 'plane'\nnodes = ['A', 'B']\nnormal = [0, 1, 0]\n"
      "[[structure.rods]]\nname = 'left'\nnodes = ['O', 'A']\nmass = 0.2\n"
      "[[structure.rods]]\nname = 'right'\nnodes = ['P', 'B']\nmass = 0.3\n"
      "[[structure.rods]]\nname = 'coupler'\nnodes = ['A', 'B']\nmass = 0.4\n"
      "[solver]\nstages = 4\nstep = 0.013\nend_time = 1.0\n");
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  CHECK(d.rod_unique == std::vector<char>{1, 1, 1});
  for (Index r = 0; r < 3; ++r) {
    CHECK_FALSE(d.force_unique(0, r));
    for (Index i = 1; i < d.force_unique.rows(); ++i) CHECK(d.force_unique(i, r));
  }
  CHECK(d.at("axial_force_max_unique").values.front() == 0.0);
  CHECK(d.at("axial_force_max_unique").values.back() == 1.0);
}

// Every rod has a twin with a modulus, or both have: what they share is known but in the flat pose, where the
// parallelogram's own forces are open. The motion is that of twice the rods.
TEST_CASE("twins of rods leave a flat pose as open as it is without them") {
  for (const bool both : {false, true}) {
    std::string rods;
    int count = 0;
    for (const std::string ends : {"'A', 'B'", "'B', 'C'", "'D', 'C'"})
      for (const bool gives : {both, true})
        rods += std::string(rods.empty() ? "" : ", ") + "{name = 'r" + std::to_string(++count) +
                "', nodes = [" + ends + "], mass = 1" + (gives ? ", area = 1e-4, youngs_modulus = 1e9" : "") +
                "}";
    const Simulation run = run_scene(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
        "{name = 'D', position = [2, 0, 0], fixed = true}, {name = 'B', position = [1, 0, 0], velocity = [0, "
        "0, "
        "1]}, {name = 'C', position = [3, 0, 0], velocity = [0, 0, 1]}]\nrods = [" +
        rods +
        "]\n[[constraints]]\nkind = 'plane'\nnodes = ['B', 'C']\nnormal = [0, 1, 0]\n[[loads]]\nnodes = "
        "['C']\nforce = [7, 0, 0]\n[solver]\nstep = 0.01\nstages = 5\nend_time = 0.1\n");
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    for (Index r = 0; r < 6; ++r) {
      CHECK_FALSE(d.force_unique(0, r));
      for (Index i = 1; i < d.force_unique.rows(); ++i) CHECK(d.force_unique(i, r));
    }
  }
}

TEST_CASE("a largest force that is not known is not unique") {
  // Rods in line would have to bear the weight across: the deployed pose has no forces.
  const Simulation run = library_run("hoop6", {"structure.youngs_modulus=7e10", "structure.fold_angle=60",
                                               "gravity.acceleration=[0,0,-1]", "solver.step=0.05"});
  REQUIRE(run.status == RunStatus::deployed);
  const Diagnostics d = diagnose(run);
  for (const std::string which : {"axial_force_max", "axial_force_min"}) {
    CHECK(std::isnan(d.at(which + "_N").values.back()));
    CHECK(d.at(which + "_unique").values.back() == 0.0);
    CHECK(d.at(which + "_unique").values.front() == 1.0);
  }
}

TEST_CASE("the largest force names its rod, its time and whether it is unique") {
  const Simulation run = library_run("hoop6", {"structure.units=4", "solver.step=0.1"});
  const Diagnostics d = diagnose(run);
  const PeakForce peak = peak_rod_force(d);
  REQUIRE(peak.rod >= 0);
  CHECK(std::abs(peak.force_N) == d.axial_force.cwiseAbs().maxCoeff());
  CHECK(run.trajectory.structure().rods[static_cast<std::size_t>(peak.rod)].group == "chord");
  CHECK_FALSE(peak.unique);
  CHECK(unique_rods(run.trajectory.structure(), d) == 4);  // the posts
  for (const double flag : d.at("axial_force_max_unique").values) CHECK((flag == 0.0 || flag == 1.0));

  const Simulation sector = library_run("hoop6_sector", {"solver.step=0.1"});
  CHECK(peak_rod_force(diagnose(sector)).unique);  // under the sector's symmetry
}

TEST_CASE("of pull and push each has its own largest, which is unique where all that equal it are") {
  Diagnostics d;
  d.t = {0.5, 1.25, 3};
  d.axial_force.resize(3, 2);
  d.axial_force << 4, -9, 7, -2, std::nan(""), 7 * (1 - 1e-11);
  d.force_unique.setConstant(3, 2, true);
  const auto is = [&](Pull pull, double force, Index rod, double t, bool unique) {
    const PeakForce peak = peak_rod_force(d, pull);
    CHECK(peak.force_N == force);
    CHECK(peak.rod == rod);
    CHECK(peak.t == t);
    CHECK(peak.unique == unique);
  };
  is(Pull::either, -9, 1, 0.5, true);
  is(Pull::tension, 7, 0, 1.25, true);
  is(Pull::compression, -9, 1, 0.5, true);
  d.force_unique(0, 1) = false;
  is(Pull::either, -9, 1, 0.5, false);
  is(Pull::tension, 7, 0, 1.25, true);
  is(Pull::compression, -9, 1, 0.5, false);
  d.force_unique(0, 1) = true, d.force_unique(2, 1) = false;  // as large, up to round-off
  is(Pull::either, -9, 1, 0.5, true);
  is(Pull::tension, 7, 0, 1.25, false);
  d.axial_force(2, 1) = 7 * (1 - 1e-7);
  is(Pull::tension, 7, 0, 1.25, true);
  d.axial_force.setConstant(std::nan(""));
  CHECK(peak_rod_force(d).rod == -1);
}

TEST_CASE("what a drive gives is unique unless something else holds the same") {
  const Diagnostics d = diagnose(library_run("hoop6_motor", {"structure.units=3", "solver.step=0.25"}));
  for (const double flag : d.at("motor.torque_unique").values) CHECK(flag == 1.0);
}

// Three rows of the rank three, if a weak one (B is 0.01 off the line): forces are determined, and zero.
TEST_CASE("the forces of a flat triangle that falls freely are unique, being none") {
  const std::string triangle = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 1}, {name = "B", position = [1, 0, 0.01], mass = 1},
  {name = "C", position = [2, 0, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 0}, {nodes = ["B", "C"], mass = 0}, {nodes = ["A", "C"], mass = 0}]
[gravity]
acceleration = [1.3, 0.7, -9.81]
[solver]
end_time = 0.05
)";
  const Diagnostics d = diagnose(run_scene(triangle));
  CHECK(d.axial_force.cwiseAbs().maxCoeff() < 1e-10);
  CHECK(d.force_unique.minCoeff() == 1);
  CHECK(peak_rod_force(d).unique);
}

// A ring is the same from every bay, whatever rounding makes of the pose without rank that it is deployed in:
// in no state does one chord have a unique force and another one not. Their halves carry a state of
// self-stress.
TEST_CASE("what is unique in one bay of a ring is unique in all") {
  for (const int units : {7, 9, 12}) {
    CAPTURE(units);
    const Simulation run = library_run("hoop12", {"structure.units=" + std::to_string(units)});
    const Diagnostics d = diagnose(run);
    const std::vector<Rod>& rods = run.trajectory.structure().rods;
    REQUIRE(d.force_unique.cols() == std::ssize(rods));
    for (std::size_t r = 0; r < rods.size(); ++r)
      if (rods[r].name.find('M') != std::string::npos)
        CHECK(d.force_unique.col(static_cast<Index>(r)).maxCoeff() == 0);
  }
  for (const int units : {5, 8}) {
    CAPTURE(units);
    const Simulation run =
        library_run("hoop6", {"structure.model=joints", "structure.units=" + std::to_string(units),
                              "structure.fold_angle=26.508", "solver.step=0.02", "solver.end_time=2",
                              "solver.at_deployed=latch"});
    const Diagnostics d = diagnose(run);
    const std::vector<Rod>& rods = run.trajectory.structure().rods;
    std::vector<Index> chords;
    for (std::size_t r = 0; r < rods.size(); ++r)
      if (rods[r].name.find('M') != std::string::npos) chords.push_back(static_cast<Index>(r));
    REQUIRE(std::ssize(chords) == 4 * units);
    REQUIRE(&run.trajectory.last_model() != &run.trajectory.model());  // latched
    for (Index i = 0; i < d.force_unique.rows(); ++i)
      for (const Index r : chords) CHECK(d.force_unique(i, r) == d.force_unique(i, chords[0]));
  }
}

}  // namespace force_uniqueness_test
