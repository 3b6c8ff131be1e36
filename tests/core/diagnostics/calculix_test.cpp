// SPDX-License-Identifier: BSD-3-Clause
// Natural frequencies against a finite-element code, CalculiX (Debian: calculix-ccx), of the same bars:
// springs of E A / l between nodes, half of a rod's mass at each end, what is rigid as linear equations.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "core/diagnostics/vibration.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace calculix_test {

namespace {

namespace fs = std::filesystem;

// Rows in reduced echelon form, every pivot 1 and alone in its column; what depends on others falls out.
std::vector<std::pair<Index, VectorXd>> echelon(MatrixXd A) {
  std::vector<std::pair<Index, VectorXd>> rows;
  for (Index r = 0; r < A.rows(); ++r) {
    Index pivot = 0;
    VectorXd row = A.row(r).transpose();
    for (const auto& [column, known] : rows) row -= row[column] * known;
    if (!(row.cwiseAbs().maxCoeff(&pivot) > 1e-9)) continue;
    row /= row[pivot];
    for (auto& [column, known] : rows) known -= known[pivot] * row;
    rows.emplace_back(pivot, row);
  }
  return rows;
}

// The model at its start as an input file for the `count` lowest frequencies.
std::string input_of(const Model& model, int count) {
  const Structure& s = model.structure;
  std::ostringstream text;
  text.precision(12);  // a field is 20 characters wide
  text << std::scientific << "*NODE,NSET=NALL\n";
  VectorXd q(model.system.coordinates());
  for (std::size_t i = 0; i < s.nodes.size(); ++i) {
    const Vec3& x = s.nodes[i].position;
    q.segment<3>(3 * static_cast<Index>(i)) = x;
    text << i + 1 << "," << x.x() << "," << x.y() << "," << x.z() << "\n";
  }
  for (std::size_t r = 0; r < s.rods.size(); ++r)
    if (s.rods[r].elastic())
      text << "*ELEMENT,TYPE=SPRINGA,ELSET=S" << r << "\n"
           << r + 1 << "," << s.rods[r].a + 1 << "," << s.rods[r].b + 1 << "\n*SPRING,ELSET=S" << r << "\n\n"
           << 1 / s.rods[r].compliance() << "\n";
  for (std::size_t i = 0; i < s.nodes.size(); ++i)
    text << "*ELEMENT,TYPE=MASS,ELSET=M" << i << "\n"
         << 100000 + i << "," << i + 1 << "\n*MASS,ELSET=M" << i << "\n"
         << model.system.node_mass().coeff(3 * static_cast<Index>(i), 3 * static_cast<Index>(i)) << "\n";
  const MatrixXd all(model.system.all_jacobian(q));
  const std::vector<int> sources = model.system.all_sources();
  std::vector<Index> rigid;
  std::size_t rod = 0;
  for (std::size_t r = 0; r < sources.size(); ++r)
    if (sources[r] >= 0 || !s.rods[rod++].elastic()) rigid.push_back(static_cast<Index>(r));
  REQUIRE(rod == s.rods.size());
  for (const auto& [pivot, row] : echelon(all(rigid, Eigen::all))) {
    std::vector<Index> others;
    for (Index c = 0; c < row.size(); ++c)
      if (c != pivot && std::abs(row[c]) > 1e-12) others.push_back(c);
    if (others.empty()) {
      text << "*BOUNDARY\n" << pivot / 3 + 1 << "," << pivot % 3 + 1 << "," << pivot % 3 + 1 << "\n";
      continue;
    }
    text << "*EQUATION\n" << others.size() + 1 << "\n" << pivot / 3 + 1 << "," << pivot % 3 + 1 << ",1.\n";
    for (const Index c : others) text << c / 3 + 1 << "," << c % 3 + 1 << "," << row[c] << "\n";
  }
  text << "*STEP\n*FREQUENCY\n" << count << "\n*END STEP\n";
  return text.str();
}

// In Hz, rising; empty where the program failed.
std::vector<double> frequencies_of(const std::string& input) {
  const fs::path folder =
      fs::temp_directory_path() / ("unfurl_ccx_" + std::to_string(std::random_device{}()));
  fs::create_directories(folder);
  std::ofstream(folder / "job.inp") << input;
  const std::string command = "cd '" + folder.string() + "' && ccx job > log 2>&1";
  std::vector<double> found;
  if (std::system(command.c_str()) == 0) {
    std::ifstream results(folder / "job.dat");
    bool table = false;
    for (std::string line; std::getline(results, line);) {
      if (line.find("E I G E N V A L U E") != std::string::npos) table = true;
      if (line.find("P A R T I C") != std::string::npos) break;
      std::istringstream in(line);
      int mode = 0;
      double square = 0;
      if (table && in >> mode >> square) found.push_back(std::sqrt(square) / (2 * pi));
    }
  }
  fs::remove_all(folder);
  return found;
}

void compare(const Model& model, int count) {
  const std::vector<double> theirs = frequencies_of(input_of(model, count));
  const Vibration ours = vibration(model, initial_state(model.structure, model.system).state);
  REQUIRE(ours.mechanism_motions == 0);
  REQUIRE(theirs.size() == static_cast<std::size_t>(count));
  // They print seven digits of the square.
  for (std::size_t k = 0; k < theirs.size(); ++k)
    CHECK(ours.modes[k].frequency == Approx(theirs[k]).epsilon(1e-6));
}

bool installed() {
  const bool there = std::system("command -v ccx > /dev/null") == 0;
  if (!there) WARN("ccx is not installed: nothing was compared");
  return there;
}

// Rods of steel between nodes of a plane grid, cell by cell of 0.3 m, with one diagonal each.
std::string grid(int nx, int ny) {
  std::string text = "[structure]\nkind = 'custom'\nmass = 'lumped'\nyoungs_modulus = 2.1e11\n";
  const auto name = [](int i, int j) { return std::to_string(i) + "," + std::to_string(j); };
  for (int i = 0; i <= nx; ++i)
    for (int j = 0; j <= ny; ++j)
      text += "[[structure.nodes]]\nname = '" + name(i, j) + "'\nposition = [" + std::to_string(0.3 * i) +
              ", " + std::to_string(0.3 * j) + ", 0]\nfixed = " + (i == 0 ? "true" : "false") + "\n";
  const auto rod = [&](const std::string& a, const std::string& b) {
    text += "[[structure.rods]]\nnodes = ['" + a + "', '" + b + "']\ndensity = 7850\narea = 1.3e-4\n";
  };
  for (int i = 0; i <= nx; ++i)
    for (int j = 0; j <= ny; ++j) {
      if (i < nx) rod(name(i, j), name(i + 1, j));
      if (j < ny && i > 0) rod(name(i, j), name(i, j + 1));
      if (i < nx && j < ny) rod(name(i, j), name(i + 1, j + 1));
    }
  return text + "[[structure.constraints]]\nkind = 'plane'\nnodes = ['*']\nnormal = [0, 0, 1]\n";
}

}  // namespace

TEST_CASE("frequencies of a bar agree with CalculiX") {
  if (!installed()) return;
  std::string bar = grid(32, 0);
  bar += "[[structure.constraints]]\nkind = 'plane'\nnodes = ['*']\nnormal = [0, 1, 0]\n";
  compare(*testing::model_of(bar), 5);
}

TEST_CASE("frequencies of a square frame agree with CalculiX") {
  if (!installed()) return;
  compare(*testing::model_of(grid(4, 4)), 6);
}

// Half open, held by an actuator across it: planes, mirrors and the sleeves of its hinges are rigid rows.
TEST_CASE("frequencies of a hoop of six units agree with CalculiX") {
  if (!installed()) return;
  const std::string hoop =
      "[structure]\nkind = 'hoop'\nunits = 6\nchord_rod_length = 2.7\npost_length = 1.3\ndensity = 1700\n"
      "section_area = 4e-4\nfold_angle = 25\nhinge_force = 0\nmass = 'lumped'\nyoungs_modulus = 7e10\n"
      "[[constraints]]\nkind = 'length'\nnodes = ['B0', 'B2']\n";
  compare(*testing::model_of(hoop), 4);  // of 23: its solver wants several vectors for each
}

}  // namespace calculix_test
