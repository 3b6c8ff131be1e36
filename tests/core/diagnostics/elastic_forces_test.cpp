// SPDX-License-Identifier: BSD-3-Clause
// Forces that a rigid model leaves open, shared by rods that have a modulus: closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/force_uniqueness.hpp"
#include "core/scene/library.hpp"
#include "core/simulate/elastic_sharing.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace elastic_forces_test {

using testing::run_scene;

namespace {

Simulation library_run(const char* scene, const std::vector<std::string>& changes) {
  const Scene s = read_scene_file(find_scene(scene), changes);
  return simulate(build_model(s), s.solver);
}

// A pendulum of two links that swings in space; whatever hangs beside the upper link.
std::string pendulum(const std::string& upper, const std::string& beside) {
  return "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\n"
         "[[structure.nodes]]\nname = 'O'\nposition = [0.2, 0, 0]\nfixed = true\n"
         "[[structure.nodes]]\nname = 'A'\nposition = [1.3, 0.2, -0.4]\nmass = 1.7\n"
         "[[structure.nodes]]\nname = 'B'\nposition = [1.9, 0, -1.3]\nmass = 0.6\n"
         "[[structure.rods]]\nname = 'upper'\nnodes = ['O', 'A']\nmass = 0.8\n" +
         upper + "[[structure.rods]]\nname = 'lower'\nnodes = ['A', 'B']\nmass = 0.5\narea = 3e-4\n" +
         beside +
         "[gravity]\nacceleration = [0.3, 0, -9.81]\n[solver]\nstages = 4\nstep = 0.01\nend_time = 0.3\n";
}

std::string beside(const std::string& name, const std::string& of) {
  return "[[structure.rods]]\nname = '" + name + "'\nnodes = ['O', 'A']\nmass = 0\n" + of;
}

// The largest difference of a rod's force from a share of the force that `alone` has in its first rod,
// relative to that rod's largest.
double off_share(const Diagnostics& d, Index rod, double share, const Diagnostics& alone) {
  return (d.axial_force.col(rod) - share * alone.axial_force.col(0)).lpNorm<Eigen::Infinity>() /
         alone.axial_force.col(0).lpNorm<Eigen::Infinity>();
}

}  // namespace

TEST_CASE("a length that is held beside a rod takes its whole force, whatever hangs elsewhere") {
  // Two pendulums that have nothing in common: A-P, held twice, and D-E on a rod as soft as it may be.
  const std::string scene =
      "[structure]\nkind = 'custom'\n"
      "[[structure.nodes]]\nname = 'A'\nposition = [0, 0, 0]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'P'\nposition = [1, 0.3, 0]\nmass = 1\n"
      "[[structure.nodes]]\nname = 'D'\nposition = [5, 0, 0]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'E'\nposition = [6, 0, 0]\nmass = 1\n"
      "[[structure.rods]]\nnodes = ['A', 'P']\nmass = 1\narea = 1e-2\nyoungs_modulus = 2e11\n"
      "[[constraints]]\nkind = 'length'\nname = 'hold'\nnodes = ['A', 'P']\n"
      "[[loads]]\nnodes = ['P']\nforce = [1000, 300, 0]\n"
      "[gravity]\nacceleration = [0, -9.81, 0]\n[solver]\nend_time = 0.03\nstep = 0.01\n"
      "[[structure.rods]]\nnodes = ['D', 'E']\nmass = 0.1\narea = 1e-7\nyoungs_modulus = ";
  for (const char* modulus : {"1e16", "1e12", "1e10", "1e9", "1e8", "1e6", "1e4"}) {
    const Diagnostics d = diagnose(run_scene(scene + modulus + "\n"));
    CAPTURE(modulus);
    CHECK(d.rod_unique[0] != 0);
    // A guide costs no energy. Forces of 1 kN to round-off, 1e-16 of a compliance over another one.
    CHECK(d.axial_force.col(0).lpNorm<Eigen::Infinity>() < 1e-5);
    CHECK(d.axial_force.col(1).lpNorm<Eigen::Infinity>() > 0.1);  // it is as it would be alone
  }
}

TEST_CASE("rods side by side share by their stiffness, at every state of a motion") {
  const std::string area = "area = 2e-4\n";
  const Diagnostics alone = diagnose(run_scene(pendulum(area, "")));
  struct Case {
    std::string upper, beside;
    std::vector<double> shares;  // of the upper link and of the rods beside it
  };
  const std::vector<Case> cases{
      {area, beside("again", area), {1.0 / 2, 1.0 / 2}},
      {area, beside("again", area) + beside("third", area), {1.0 / 3, 1.0 / 3, 1.0 / 3}},
      {area, beside("stiff", area + "youngs_modulus = 1.4e11\n"), {1.0 / 3, 2.0 / 3}},
      {area, beside("thick", "area = 6e-4\n"), {1.0 / 4, 3.0 / 4}},
      // What has no modulus does not give way: it carries all.
      {area, beside("rigid", ""), {0.0, 1.0}}};
  for (const Case& c : cases) {
    const Diagnostics d = diagnose(run_scene(pendulum(c.upper, c.beside)));
    REQUIRE(d.t.size() == alone.t.size());
    INFO(c.beside);
    CHECK(d.rod_unique == std::vector<char>(c.shares.size() + 1, 1));
    CHECK(off_share(d, 0, c.shares[0], alone) < 1e-12);
    for (std::size_t k = 1; k < c.shares.size(); ++k)
      CHECK(off_share(d, static_cast<Index>(k) + 1, c.shares[k], alone) < 1e-12);
    CHECK((d.axial_force.col(1) - alone.axial_force.col(1)).lpNorm<Eigen::Infinity>() <
          1e-12 * alone.axial_force.col(1).lpNorm<Eigen::Infinity>());
  }
}

TEST_CASE("a rod that is there twice changes nothing of the motion, and neither does its modulus") {
  const std::string area = "area = 2e-4\n";
  const Simulation one = run_scene(pendulum(area, "")),
                   two = run_scene(pendulum(area, beside("again", area)));
  REQUIRE(one.trajectory.size() == two.trajectory.size());
  double off = 0;
  for (std::size_t i = 0; i < one.trajectory.size(); ++i)
    off =
        std::max(off, (one.trajectory.positions(i) - two.trajectory.positions(i)).lpNorm<Eigen::Infinity>());
  CHECK(off < 1e-12);
}

TEST_CASE("two rigid rods side by side stay open, an elastic one beside them carries nothing") {
  const Diagnostics d = diagnose(run_scene(
      pendulum("youngs_modulus = inf\n", beside("rigid", "") + beside("elastic", "area = 2e-4\n"))));
  CHECK(d.rod_unique == std::vector<char>{0, 1, 0, 1});
  CHECK(d.axial_force.col(3).lpNorm<Eigen::Infinity>() <
        1e-12 * d.axial_force.col(0).lpNorm<Eigen::Infinity>());
}

namespace {

// A square in the plane z = 0: 1 pinned, 4 on a horizontal guide, 1000 N along x on 3.
std::string square(const std::string& diagonal_24) {
  std::string text =
      "[structure]\nkind = 'custom'\nyoungs_modulus = 2e11\n"
      "[[structure.nodes]]\nname = '1'\nposition = [0, 0, 0]\nfixed = true\n";
  const char* at[] = {"[0, 1, 0]", "[1, 1, 0]", "[1, 0, 0]"};
  for (int k = 0; k < 3; ++k)
    text +=
        "[[structure.nodes]]\nname = '" + std::to_string(k + 2) + "'\nposition = " + at[k] + "\nmass = 1\n";
  for (const char* rod : {"12", "23", "34", "41", "13"})
    text += "[[structure.rods]]\nname = '" + std::string(rod) + "'\nnodes = ['" + rod[0] + "', '" + rod[1] +
            "']\nmass = 0\narea = 1e-4\n";
  return text + diagonal_24 +
         "[[structure.constraints]]\nkind = 'plane'\nnodes = ['2', '3', '4']\nnormal = [0, 0, 1]\n"
         "[[structure.constraints]]\nkind = 'plane'\nnodes = ['4']\nnormal = [0, 1, 0]\n"
         "[[loads]]\nnodes = ['3']\nforce = [1000, 0, 0]\n[solver]\nstep = 0.01\nend_time = 0.02\n";
}

}  // namespace

TEST_CASE("SSNL105: a square with two diagonal cables, of which one is slack") {
  const Diagnostics d = diagnose(run_scene(
      square("[[forces]]\nkind = 'spring'\nnodes = ['2', '4']\nstiffness = 1e7\ntension_only = true\n")));
  CHECK(d.rod_unique == std::vector<char>(5, 1));
  const double wanted[] = {0, 0, -1000, 0, 1000 * std::sqrt(2.0)};
  for (Index i = 0; i < d.axial_force.rows(); ++i)
    for (Index r = 0; r < 5; ++r) CHECK(std::abs(d.axial_force(i, r) - wanted[r]) < 1e-6);
}

TEST_CASE("the same square with both diagonals as bars: the unit load method") {
  const std::string bar = "[[structure.rods]]\nname = '24'\nnodes = ['2', '4']\nmass = 0\narea = 1e-4\n";
  const Diagnostics d = diagnose(run_scene(square(bar)));
  CHECK(d.rod_unique == std::vector<char>(6, 1));
  // X in 24 with self-stress S = (-1/sqrt 2 in each side, 1 in the diagonals): X = -sum N S l / sum S^2 l.
  const double P = 1000, s = 1 / std::sqrt(2.0), X = -P * (2 + s) / (2 + 2 * std::sqrt(2.0));
  const double wanted[] = {-s * X, -s * X, -P - s * X, -s * X, P / s + X, X};
  for (Index i = 0; i < d.axial_force.rows(); ++i)
    for (Index r = 0; r < 6; ++r) CHECK(std::abs(d.axial_force(i, r) - wanted[r]) < 1e-9 * P);
}

TEST_CASE("a ring of elastic rods has unique forces, those of its sector, up to the deployed pose") {
  const std::vector<std::string> changes{"solver.step=0.05", "solver.stages=4"};
  std::vector<std::string> elastic = changes;
  elastic.emplace_back("structure.youngs_modulus=7e10");
  const Simulation ring = library_run("hoop6", elastic), sector = library_run("hoop6_sector", changes);
  const Diagnostics d = diagnose(ring), s = diagnose(sector);
  REQUIRE(ring.status == RunStatus::deployed);
  REQUIRE(d.t.size() == s.t.size());
  CHECK(unique_rods(ring.trajectory.structure(), d) == 30);
  CHECK(peak_rod_force(d).unique);
  const auto& whole = sector.trajectory.structure().rod_copies;
  const double peak = peak_rod_force(s).force_N;
  for (Index i = 0; i < d.axial_force.rows(); ++i) {
    // The deployed pose is singular: there both rows are extrapolated from those before, over a step of 0.05
    // s.
    const double tolerance = i + 1 < d.axial_force.rows() ? 1e-8 : 1e-4;
    for (Index r = 0; r < 30; ++r) {
      CHECK(d.force_unique(i, r));
      const double wanted = s.axial_force(i, whole[static_cast<std::size_t>(r)].source);
      CHECK(std::abs(d.axial_force(i, r) - wanted) < tolerance * peak);
    }
  }
  // The rigid ring determines its posts alone.
  CHECK(unique_rods(ring.trajectory.structure(), diagnose(library_run("hoop6", changes))) == 6);
}

TEST_CASE("a sector's rods stand for several: the share does not depend on the model") {
  const std::vector<std::string> changes{"solver.step=0.1", "structure.youngs_modulus=7e10"};
  const Simulation sector = library_run("hoop6_sector", changes);
  for (const Rod& rod : sector.trajectory.structure().rods) {
    CHECK(rod.area == 9e-4);
    CHECK(rod.compliance() == Approx(rod.length / (7e10 * 9e-4 * rod.multiplicity)).epsilon(1e-15));
  }
}

TEST_CASE("where no rod has a modulus nothing is shared") {
  const Scene scene = read_scene_file(find_scene("hoop6"));
  CHECK(row_compliance(*build_model(scene)).size() == 0);
}

}  // namespace elastic_forces_test
