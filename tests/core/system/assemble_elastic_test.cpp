// SPDX-License-Identifier: BSD-3-Clause
// Rods that do not quite fit, and rods that warm.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "core/scene/library.hpp"
#include "core/structure/node_positions.hpp"
#include "tests/support/models.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace assemble_elastic_test {

namespace {

// A square of side a with both diagonals, free in its plane; the diagonal 1-3 is made `error` too long.
constexpr double a = 1.3, EA = 7e10 * 2e-4;
std::string square(double error, const std::string& more = "", const std::string& made = "length") {
  std::ostringstream text;
  text.precision(17);
  text << "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\n" << more;
  const char* at[] = {"[0, 0, 0]", "[1.3, 0, 0]", "[1.3, 1.3, 0]", "[0, 1.3, 0]"};
  for (int k = 0; k < 4; ++k)
    text << "[[structure.nodes]]\nname = '" << k + 1 << "'\nposition = " << at[k] << "\nmass = 0.7\n";
  for (const char* name : {"12", "23", "34", "41", "13", "24"})
    text << "[[structure.rods]]\nname = '" << name << "'\nnodes = ['" << name[0] << "', '" << name[1]
         << "']\nmass = 0.2\narea = 2e-4\n"
         << (error != 0 && name[0] == '1' && name[1] == '3' ? made + " = " + std::to_string(0) + "\n"
                                                            : std::string());
  std::string out = text.str();
  if (error != 0) {
    std::ostringstream length;
    length.precision(17);
    length << made << " = " << a * std::sqrt(2.0) + error << "\n";
    const std::string mark = made + " = 0\n";
    out.replace(out.find(mark), mark.size(), length.str());
  }
  return out +
         "[[structure.constraints]]\nkind = 'plane'\nnodes = ['1', '2', '3', '4']\nnormal = [0, 0, 1]\n" +
         "[solver]\nstep = 1e-5\nend_time = 3e-5\n";
}

// What a note says that nodes were moved by at most.
double moved_by(const std::string& note) {
  const std::string mark = "nodes were moved by at most ";
  const std::size_t at = note.find(mark);
  return at == std::string::npos ? -1 : std::strtod(note.c_str() + at + mark.size(), nullptr);
}

VectorXd first_forces(const Simulation& run) {
  return diagnose(run).axial_force.row(0).transpose();
}

}  // namespace

TEST_CASE("assembly: a square with a diagonal made too long has the self-stress of the unit load method") {
  const double error = 1e-5;
  const Simulation run = run_scene(square(error, "rod_model = 'elastic'\n"));
  REQUIRE(run.status == RunStatus::completed);
  // X (-1/sqrt 2 in each side, 1 in the diagonals): X = -error E A / sum S^2 l, to the first order in the
  // strain, 5e-6.
  const double X = -error * EA / (2 * a + 2 * std::sqrt(2.0) * a), s = -X / std::sqrt(2.0);
  const VectorXd force = first_forces(run);
  const double wanted[] = {s, s, s, s, X, X};
  for (Index r = 0; r < 6; ++r) CHECK(force[r] == Approx(wanted[r]).epsilon(2e-5));
  // It is in balance: nothing moves, and the note tells the largest force.
  CHECK(largest(diagnose(run), "kinetic_energy_J") < 1e-18);
  REQUIRE(run.warnings.size() >= 1);
  CHECK_THAT(run.warnings.front(),
             Catch::Contains("the largest force of self-stress is -") && Catch::Contains("N (rod 13)"));
  // With free_length the nodes stay where they are, and the diagonal starts with all of it.
  const VectorXd stretched = first_forces(run_scene(square(error, "rod_model = 'elastic'\n", "free_length")));
  CHECK(stretched[4] == Approx(-error * EA / (a * std::sqrt(2.0) + error)).epsilon(1e-9));
  CHECK(stretched.head(4).lpNorm<Eigen::Infinity>() < 1e-6);
  // Rigid rods cannot be joined.
  CHECK_THAT(error_of(square(error)), Catch::Contains("rod 13 is given a length"));
  CHECK_THAT(error_of(square(0.03, "rod_model = 'elastic'\n")), Catch::Contains("up to 1 % only"));
}

TEST_CASE("assembly: a ring whose rods are off by seeded errors joins, and the sector refuses") {
  const std::vector<std::string> changes{"structure.model=joints",        "structure.rod_model=elastic",
                                         "structure.youngs_modulus=7e10", "structure.length_error=1e-4",
                                         "structure.fold_angle=60",       "structure.hinge_force=0"};
  const auto model = build_model(read_scene_file(find_scene("hoop6"), changes));
  const System& system = model->system;
  const VectorXd q = node_positions(model->structure);
  VectorXd force(static_cast<Index>(system.giving_rods().size()));
  system.giving_rod_forces(0, q, VectorXd::Zero(q.size()), force);
  // Errors of 1e-4 m in loops of rods of 3 m: strains of 1e-5, some hundred newtons of 2000.
  CHECK(force.lpNorm<Eigen::Infinity>() > 10);
  CHECK(force.lpNorm<Eigen::Infinity>() < 2 * 7e10 * 9e-4 * 1e-4 / 1.2);
  // In balance with the planes of the faces: what is left of the forces is not felt by any free motion.
  auto other = changes;
  other.emplace_back("structure.error_seed=7");
  const auto again = build_model(read_scene_file(find_scene("hoop6"), changes)),
             differs = build_model(read_scene_file(find_scene("hoop6"), other));
  for (std::size_t r = 0; r < model->structure.rods.size(); ++r)
    CHECK(again->structure.rods[r].length == model->structure.rods[r].length);
  CHECK(differs->structure.rods[0].length != model->structure.rods[0].length);
  CHECK_THROWS_WITH(
      build_model(read_scene_file(
          find_scene("hoop6_sector"),
          {"structure.rod_model=elastic", "structure.youngs_modulus=7e10", "structure.length_error=1e-4"})),
      Catch::Contains("structure.length_error: errors of length break the symmetry of a sector"));
}

// Self-stress of rings drives their mechanism, and no pose near the given one has them in balance: the
// mechanism is held. Errors of a few 1e-5 m in loops of rods of about a metre.
TEST_CASE("assembly: rings whose self-stress drives their mechanism join rods that are off") {
  for (const char* name : {"scissor_ring", "hoberman", "cable_ring", "mesh_reflector"}) {
    const std::vector<std::string> changes{"structure.rod_model=elastic", "structure.youngs_modulus=7e10",
                                           "structure.length_error=2e-5"};
    const auto fits = build_model(read_scene_file(find_scene(name), {}));
    const auto model = build_model(read_scene_file(find_scene(name), changes));
    INFO(name);
    const VectorXd q = node_positions(model->structure);
    CHECK((q - node_positions(fits->structure)).lpNorm<Eigen::Infinity>() < 1e-3);
    VectorXd phi(model->system.constraints()), rates = VectorXd::Zero(q.size());
    model->system.constraint(0, q, phi);
    CHECK(phi.lpNorm<Eigen::Infinity>() < 1e-9);
    VectorXd force(static_cast<Index>(model->system.giving_rods().size()));
    model->system.giving_rod_forces(0, q, rates, force);
    double most = 0;  // what a rod would bear whose ends could not move, of errors of five deviations
    for (const int r : model->system.giving_rods())
      most = std::max(most, 1e-4 / model->structure.rods[static_cast<std::size_t>(r)].compliance());
    CHECK(force.lpNorm<Eigen::Infinity>() > 1e-4 * most);
    CHECK(force.lpNorm<Eigen::Infinity>() < most);
  }
}

// Moves that fit errors e are some e; what self-stress makes of a mechanism does not depend on the size of e,
// and was a metre. Links of three rods, closed to loops of a few links, add up to ten errors of three
// deviations at most; 1e-4 m and bars of 0.5 m turn the fold angle by less than 0.4 degrees then.
TEST_CASE("assembly: a ring that self-stress would throw along its mechanism stays where it is") {
  std::vector<std::string> changes{"structure.fold_angle=50",     "structure.deployed_angle=5",
                                   "structure.rod_model=elastic", "structure.youngs_modulus=7e9",
                                   "structure.length_error=0",    "structure.error_seed=1",
                                   "structure.radial_force=10"};
  const auto exact = build_model(read_scene_file(find_scene("hoberman"), changes));
  for (const char* error : {"1e-5", "1e-4"})
    for (int seed = 1; seed <= 10; ++seed) {
      INFO(error << ", seed " << seed);
      changes[4] = std::string("structure.length_error=") + error;
      changes[5] = "structure.error_seed=" + std::to_string(seed);
      const auto model = build_model(read_scene_file(find_scene("hoberman"), changes));
      const VectorXd moved = node_positions(model->structure) - node_positions(exact->structure);
      CHECK(moved.lpNorm<Eigen::Infinity>() < 30 * std::stod(error));
      CHECK(model->structure.deployment.initial_fold_angle ==
            Approx(exact->structure.deployment.initial_fold_angle).epsilon(0).margin(60 * std::stod(error)));
    }
}

// A - M - B between walls 1.5 m apart, both rods of one E A and made l_1 and l_2 long: M stands where both
// have the strain 1.5 / (l_1 + l_2) - 1. What they weigh does not matter; rods without a section are not made
// at all.
TEST_CASE("assembly: errors of length are those of rods without mass, too") {
  const auto chain = [](const std::string& rod) {
    return model_of(
        "[structure]\nkind = 'custom'\nrod_model = 'elastic'\nyoungs_modulus = 1e9\nlength_error = "
        "1e-4\nerror_seed = 5\n"
        "nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'M', position = [0.6, 0, 0], "
        "mass = 1},"
        "{name = 'B', position = [1.5, 0, 0], fixed = true}]\n"
        "rods = [{nodes = ['A', 'M'], area = 1e-4" +
        rod + "}, {nodes = ['M', 'B'], area = 1e-4" + rod +
        "}]\n"
        "[[constraints]]\nkind = 'line'\nnodes = ['M']\ndirection = [1, 0, 0]\n");
  };
  const auto light = chain(", mass = 0"), heavy = chain(", mass = 0.5");
  const std::vector<Rod>& rods = light->structure.rods;
  for (const std::size_t r : {0U, 1U}) CHECK(rods[r].length == heavy->structure.rods[r].length);
  VectorXd force(2);
  const VectorXd q = node_positions(light->structure);
  light->system.giving_rod_forces(0, q, VectorXd::Zero(q.size()), force);
  const double wanted = 1e5 * (1.5 / (rods[0].length + rods[1].length) - 1);
  CHECK(std::abs(wanted) > 0.1);
  for (const Index r : {0, 1})
    CHECK(force[r] == Approx(wanted).epsilon(0).margin(1e-8));  // 1e5 N times rounding of lengths
  for (const std::string& note : light->structure.notes) CHECK(note.find("leaves out") == std::string::npos);
  const auto bare = model_of(
      "[structure]\nkind = 'custom'\nlength_error = 1e-4\n"
      "nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [1, 0, 0], mass = "
      "1}]\n"
      "rods = [{nodes = ['A', 'B'], mass = 0}]\n");
  REQUIRE(bare->structure.notes.size() == 1);
  CHECK(bare->structure.notes[0] == "length_error leaves out rods with neither mass nor area: A-B");
}

// One seed, one error, whatever the rod: a rigid one is 1 + e long, one that is to start stretched 0.9 + e,
// which is what it pulls with from the start (to rounding of lengths, times E A = 7e6 N).
TEST_CASE("assembly: errors of length are those of rods with a free length, too") {
  const auto rod = [](const std::string& more, const char* error) {
    return std::string("[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\nlength_error = ") + error +
           "\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [1, 0, 0], "
           "mass = 1}]\nrods = [{nodes = ['A', 'B'], mass = 1, area = 1e-4" +
           more + "}]\n";
  };
  const std::string stretched = ", elastic = true, free_length = 0.9";
  const double e = model_of(rod("", "1e-3"))->structure.rods[0].length - 1;
  CHECK(std::abs(e) > 1e-5);
  const auto model = model_of(rod(stretched, "1e-3"));
  CHECK(model->structure.rods[0].free_length == Approx(0.9 + e).epsilon(0).margin(1e-14));
  VectorXd force(1);
  const VectorXd q = node_positions(model->structure);
  model->system.giving_rod_forces(0, q, VectorXd::Zero(q.size()), force);
  CHECK(force[0] == Approx(7e6 * (1 / (0.9 + e) - 1)).epsilon(0).margin(1e-6));
  int seed = 1;  // of one that would be made less than nothing
  const auto seeded = [&] {
    return std::vector<std::string>{"structure.error_seed=" + std::to_string(seed)};
  };
  while (seed < 20 && model_of(rod("", "1e-3"), seeded())->structure.rods[0].length > 1 - 5e-4) ++seed;
  CHECK_THAT(error_of(rod(stretched, "5"), seeded()),
             Catch::Contains("structure.length_error: rod A-B would be made -"));
}

// A mast is statically determinate: errors of its lengths stress nothing, and the pose is that of rigid rods,
// whatever the modulus. Both are fitted to round-off of coordinates of some metres.
TEST_CASE("assembly: a mast whose rods are off starts where it would with rigid rods") {
  const std::vector<std::string> errors{"structure.length_error=1e-4", "structure.youngs_modulus=7e10"};
  const auto rigid = build_model(read_scene_file(find_scene("scissor_mast"), errors));
  const VectorXd wanted = node_positions(rigid->structure);
  for (const char* modulus : {"7e10", "7e16"}) {
    auto changes = errors;
    changes.emplace_back("structure.rod_model=elastic");
    changes.emplace_back(std::string("structure.youngs_modulus=") + modulus);
    const auto model = build_model(read_scene_file(find_scene("scissor_mast"), changes));
    const VectorXd q = node_positions(model->structure);
    CHECK((q - wanted).lpNorm<Eigen::Infinity>() < 1e-11);
    REQUIRE_FALSE(model->structure.notes.empty());
    CHECK_THAT(model->structure.notes.back(), Catch::Contains("without self-stress"));
  }
}

// The square with diagonals, of which one is 1e-5 m too long, carries a linkage of three more rods, one of
// them off by as much: the self-stress does not reach it, and nothing throws it along its way to move. What
// fits it turns the linkage by less than ten times the errors.
TEST_CASE("assembly: self-stress beside a mechanism does not move it") {
  const double error = 1e-5;
  std::string text = square(error, "rod_model = 'elastic'\n");
  const auto add = [&](const std::string& table, const std::string& mark) {
    text.insert(text.find(mark), table);
  };
  add("[[structure.nodes]]\nname = '5'\nposition = [2.5, 0.4, 0]\nmass = 0.7\n"
      "[[structure.nodes]]\nname = '6'\nposition = [2.3, 1.6, 0]\nmass = 0.7\n"
      "[[structure.rods]]\nnodes = ['2', '5']\nmass = 0.2\narea = 2e-4\n"
      "[[structure.rods]]\nnodes = ['3', '6']\nmass = 0.2\narea = 2e-4\n"
      "[[structure.rods]]\nnodes = ['5', '6']\nmass = 0.2\narea = 2e-4\nlength = " +
          testing::number(std::hypot(0.2, 1.2) + error) + "\n",
      "[[structure.constraints]]");
  text.replace(text.find("['1', '2', '3', '4']"), 20, "['*']");
  const auto model = model_of(text);
  const double at[] = {0, 0, 0, a, 0, 0, a, a, 0, 0, a, 0, 2.5, 0.4, 0, 2.3, 1.6, 0};
  const VectorXd q = node_positions(model->structure);
  double most = 0;
  for (Index k = 0; k < 18; ++k) most = std::max(most, std::abs(q[k] - at[k]));
  CHECK(most < 10 * error);
  VectorXd force(static_cast<Index>(model->system.giving_rods().size()));
  model->system.giving_rod_forces(0, q, VectorXd::Zero(q.size()), force);
  const double X = -error * EA / (2 * a + 2 * std::sqrt(2.0) * a);
  CHECK(force[4] == Approx(X).epsilon(2e-5));                           // as without the linkage
  CHECK(force.tail(3).lpNorm<Eigen::Infinity>() < 1e-6 * std::abs(X));  // strains of round-off
}

TEST_CASE("temperature: a clamped elastic rod carries -E A alpha dT") {
  const std::string scene =
      "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\nrod_model = 'elastic'\ndamping_time = 1e-4\n"
      "[[structure.nodes]]\nname = 'A'\nposition = [0.1, 0.2, 0]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'M'\nposition = [0.5, 0.2, 0]\nmass = 0.3\n"
      "[[structure.nodes]]\nname = 'B'\nposition = [1.4, 0.2, 0]\nfixed = true\n"
      "[[structure.rods]]\nnodes = ['A', 'M']\nmass = 0.1\narea = 3e-4\n"
      "[[structure.rods]]\nnodes = ['M', 'B']\nmass = 0.2\narea = 3e-4\n"
      "[[constraints]]\nkind = 'line'\nnodes = ['M']\ndirection = [1, 0, 0]\n"
      "[[forces]]\nkind = 'temperature'\nrods = ['rod']\nexpansion = 23e-6\nchange = -60\n"
      "times = [0, 0.02, 0.05]\nvalues = [0, 0.4, 1]\n[solver]\nstep = 1e-3\nend_time = 0.07\n";
  const Simulation run = run_scene(scene);
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  // Colder: tension. N = -E A e / (1 + e) with e = alpha dT, E A over the length without force.
  const double e = 23e-6 * -60, wanted = -7e10 * 3e-4 * e;
  for (const Index r : {0, 1})
    CHECK(d.axial_force(d.axial_force.rows() - 1, r) == Approx(wanted).epsilon(1e-7));
  // What the cold puts in is in the books, and what the dampers take of it as the strain grows, 0.1 J of 26
  // J: by powers of the states, which make 3e-4 of that of steps in which it starts.
  CHECK(largest(d, "energy_balance_J") < 2e-6 * largest(d, "potential_energy_J"));
}

// All rods that are seen are warmed: the links grow and keep their angles, as they do where all rods are
// named.
TEST_CASE("temperature: braces that are not shown warm with the rods of their link") {
  const auto end = [](const char* kind, const std::string& rods, const std::string& more = "") {
    return run_scene("[structure]\nkind = '" + std::string(kind) + "'\n" + more +
                     "[[forces]]\nkind = 'temperature'\nrods = [" + rods +
                     "]\nexpansion = 1e-4\nchange = 100\ntimes = [0, 0.2, 0.3]\nvalues = [0, 1, 1]\n"
                     "[solver]\nstages = 4\nstep = 0.01\nend_time = 0.3\n");
  };
  for (const auto& [kind, seen] : {std::pair("bricard", "'bar', 'hinge pin'"),
                                   std::pair("hoberman", "'left element', 'right element'")}) {
    INFO(kind);
    const Simulation by_groups = end(kind, seen), all = end(kind, "'*'");
    REQUIRE(by_groups.status == RunStatus::completed);
    CHECK(end_positions(by_groups) == end_positions(all));
    CHECK(by_groups.warnings.empty());
  }
  // Of bars that warm between pins that do not, nobody knows what the two braces over each right angle do.
  const auto half = model_of(
      "[structure]\nkind = 'bricard'\n[[forces]]\nkind = 'temperature'\nrods = ['bar']\nexpansion = 1e-5\n"
      "change = 1\ntimes = [0, 1]\nvalues = [0, 1]\n");
  REQUIRE(half->structure.notes.size() == 1);
  CHECK_THAT(half->structure.notes[0], Catch::Contains("12 braces") && Catch::Contains("stay cold"));
}

TEST_CASE("temperature: a ring of rigid rods that warms evenly grows and keeps its angles") {
  std::string ring = "[structure]\nkind = 'custom'\n";
  const int n = 5;
  for (int i = 0; i < n; ++i) {
    const double angle = 0.3 + 2 * pi * i / n;
    ring += "[[structure.nodes]]\nname = '" + std::to_string(i) + "'\nposition = [" +
            std::to_string(std::cos(angle)) + ", " + std::to_string(std::sin(angle)) + ", 0]\n";
  }
  ring += "[[structure.constraints]]\nkind = 'plane'\nnodes = ['*']\nnormal = [0, 0, 1]\n";
  for (int i = 0; i < n; ++i)
    ring += "[[structure.rods]]\nnodes = ['" + std::to_string(i) + "', '" + std::to_string((i + 1) % n) +
            "']\nmass = 0.4\n";
  const Simulation run =
      run_scene(ring +
                "[[forces]]\nkind = 'temperature'\nrods = ['*-*']\nexpansion = 2e-5\nchange = 150\n"
                "times = [0, 0.5]\nvalues = [0, 1]\n[solver]\nend_time = 0.6\n");
  REQUIRE(run.status == RunStatus::completed);
  const VectorXd first = run.trajectory.node_positions(0), last = end_positions(run);
  const Diagnostics d = diagnose(run);
  // Positions of six digits: angles as given, to the round-off of the motion's forces.
  for (int i = 0; i < n; ++i) {
    const auto edge = [&](const VectorXd& q, int k) -> Vec3 {
      return q.segment<3>(3 * ((k + 1) % n)) - q.segment<3>(3 * (k % n));
    };
    CHECK(edge(last, i).norm() / edge(first, i).norm() == Approx(1 + 2e-5 * 150).epsilon(1e-13));
    const auto turn = [&](const VectorXd& q) {
      return edge(q, i).normalized().dot(edge(q, i + 1).normalized());
    };
    CHECK(turn(last) == Approx(turn(first)).epsilon(0).margin(1e-7));
  }
  CHECK(largest(d, "energy_balance_J") < 1e-9);
}

// In line between walls: rods of E A that are made l_1 and l_2 long, on either side of a rigid one of length
// 1. With P off by u, (1 + u) / l_1 = (1 - u) / l_2.
TEST_CASE("assembly: elastic rods beside a rigid one are in balance, and it keeps its length") {
  const double stiff = 1e6;
  for (const auto& [l1, l2] : {std::pair(1.0004, 1.0), std::pair(1.004, 1.002), std::pair(0.997, 1.009)}) {
    INFO(l1 << " " << l2);
    const Simulation run = run_scene(R"([structure]
kind = 'custom'
rod_model = 'elastic'
nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'P', position = [1, 0, 0], mass = 1},
         {name = 'Q', position = [2, 0, 0], mass = 1}, {name = 'B', position = [3, 0, 0], fixed = true}]
rods = [{nodes = ['A', 'P'], mass = 0.1, area = 1e-4, youngs_modulus = 1e10, length = )" +
                                     number(l1) + R"(},
        {nodes = ['P', 'Q'], mass = 0.1},
        {nodes = ['Q', 'B'], mass = 0.1, area = 1e-4, youngs_modulus = 1e10, length = )" +
                                     number(l2) + R"(}]
[[constraints]]
kind = 'line'
nodes = ['P', 'Q']
direction = [1, 0, 0]
[solver]
step = 1e-5
end_time = 3e-5
)");
    const double u = (l1 - l2) / (l1 + l2), wanted = stiff * ((1 + u) / l1 - 1);
    const VectorXd q = run.trajectory.node_positions(0), force = first_forces(run);
    REQUIRE_FALSE(run.warnings.empty());
    CHECK(moved_by(run.warnings.front()) == Approx(std::abs(u)).epsilon(1e-5));  // six digits
    // Rounding of coordinates, 1e-16, is 1e-12 of the strains.
    CHECK(q[3] == Approx(1 + u).epsilon(1e-14));
    CHECK(std::abs(q[6] - q[3] - 1) < 1e-15 * 4);
    for (const Index r : {0, 2}) CHECK(force[r] == Approx(wanted).epsilon(1e-10));
    CHECK(largest(diagnose(run), "kinetic_energy_J") < 1e-18);
  }
}

// One side of the square, or two, are rigid and may turn: what bears on them is their own multipliers.
TEST_CASE("assembly: a square of which one side is rigid is in balance") {
  const bool two = GENERATE(false, true);
  std::string scene = square(1.3e-3, "rod_model = 'elastic'\n");
  for (const char* side : {"12", "23"}) {
    const std::string mark = "name = '" + std::string(side) + "'\n";
    if (two || side[0] == '1') scene.insert(scene.find(mark) + mark.size(), "elastic = false\n");
  }
  const Simulation run = run_scene(scene);
  REQUIRE(run.status == RunStatus::completed);
  const VectorXd q = run.trajectory.node_positions(0);
  CHECK(std::abs((q.segment<3>(3) - q.head<3>()).norm() - a) < 1e-15);
  CHECK((std::abs((q.segment<3>(6) - q.segment<3>(3)).norm() - a) < 1e-15) == two);
  // Forces of 1e4 N that cancel to rounding move 3 kg by nothing in 3e-5 s; off by 1e-6 they would have
  // 1e-14.
  CHECK(std::abs(first_forces(run)[4]) > 1000);
  CHECK(largest(diagnose(run), "kinetic_energy_J") < 1e-18);
}

// The same for both: rods that are warm when the run begins were joined cold. A length that is off by 1e-7
// changes forces by E A 1e-7 = 0.1 N.
TEST_CASE("temperature: rods that do not fit are joined cold, as those that do") {
  const auto forces = [](double length) {
    const Simulation run = run_scene(R"([structure]
kind = 'custom'
rod_model = 'elastic'
nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'P', position = [1, 0, 0], mass = 1},
         {name = 'B', position = [2, 0, 0], fixed = true}]
rods = [{nodes = ['A', 'P'], mass = 0.1, area = 1e-4, youngs_modulus = 1e10, length = )" +
                                     number(length) + R"(},
        {nodes = ['P', 'B'], mass = 0.1, area = 1e-4, youngs_modulus = 1e10}]
[[constraints]]
kind = 'line'
nodes = ['P']
direction = [1, 0, 0]
[[forces]]
kind = 'temperature'
rods = ['A-P']
expansion = 1e-5
change = 100
[solver]
step = 1e-5
end_time = 3e-5
)");
    for (const std::string& warning : run.warnings)
      CHECK(warning.find("no pose near the given one") == std::string::npos);
    return first_forces(run);
  };
  const VectorXd fits = forces(1.0), off = forces(1.0 + 1e-7);
  CHECK(fits[0] == Approx(-1000).epsilon(1e-9));
  CHECK(std::abs(fits[1]) < 1e-6);
  const double u = 1e-7 / (2 + 1e-7);
  CHECK(off[0] == Approx(-1000 - 1e6 * u).epsilon(1e-9));  // of 1000 N: 1e-6 N, and 1e-5 of the 0.05 N
  CHECK(off[1] == Approx(-1e6 * u).epsilon(1e-4));
}

}  // namespace assemble_elastic_test
