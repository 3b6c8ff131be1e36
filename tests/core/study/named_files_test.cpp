// SPDX-License-Identifier: BSD-3-Clause
// Files that the values of a sweep name: which they are is known without reading the scene for every value.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "core/scene/toml_tree.hpp"
#include "core/scene/variables.hpp"
#include "core/study/sweep.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace named_files_test {

namespace {

struct Folder {
  fs::path path = fs::temp_directory_path() / ("unfurl_named_files_" + std::to_string(::getpid()));
  Folder() { fs::remove_all(path), fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

using Names = std::set<std::string>;

Names naming(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return variables_of_files(parse_toml(text, "s.toml"), overrides);
}

double cpu_seconds() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

TEST_CASE("variables that files are named by: in braces, through others, and as the number of entries") {
  const std::string variables =
      "[variables]\ng = 9.81\nk = 2\nn = 1\nm = '=k + 1'\nlast = '=2*n'\nidle = '=m'\n";
  const std::string plain = variables + "[structure]\nnodes_file = 'n.csv'\nrods_file = 'r.csv'\n";
  CHECK(naming(plain).empty());
  CHECK(naming(plain, {"variables.g=3", "solver.step=0.1"}).empty());
  CHECK(naming("[structure]\nnodes_file = 'n_{k}.csv'\n").empty());
  CHECK(naming(variables + "[structure]\nnodes_file = 'n_{k}.csv'\n") == Names{"k"});
  CHECK(naming(variables + "[structure]\nrods_file = 'n_{m}.csv'\n") == Names{"k", "m"});
  // An override puts another expression, or none, in a variable's place.
  CHECK(naming(variables + "[structure]\nrods_file = 'n_{m}.csv'\n", {"variables.m=4"}) == Names{"m"});
  CHECK(naming(variables + "[structure]\nrods_file = 'n_{m}.csv'\n", {"variables.m=\"=g\""}) ==
        Names{"g", "m"});
  const auto load = [&](const std::string& repeat, const std::string& table) {
    return naming(variables + "[[forces]]\nrepeat = " + repeat + "\nvalue = '=g'\ntable = '" + table + "'\n");
  };
  CHECK(load("{i = '0:last'}", "t_{i}.csv") == Names{"n", "last"});
  CHECK(load("{i = '0:n'}", "t.csv") == Names{"n"});  // none may name it where the scene stands
  CHECK(load("{i = [1, '=m']}", "t_{i + n}.csv") == Names{"k", "m", "n"});
  CHECK(load("{i = '0:3'}", "t_{i}.csv").empty());
  CHECK(naming(variables, {"forces[0]={repeat={i=\"0:n\"}, table=\"t_{i}.csv\"}"}) == Names{"n"});
}

TEST_CASE("files of a sweep over variables are those of all values, and the scene is read for these alone") {
  const Folder folder;
  // Nodes enough that one reading of the scene outweighs looking at a thousand values.
  for (const char* name : {"n_1.csv", "n_2.csv"}) {
    std::ofstream nodes(folder.path / name);
    nodes << "name,x_m,y_m,z_m,fixed,mass_kg\n";
    for (int i = 0; i < 400; ++i)
      nodes << "N" << i << "," << i << ",0," << name[2] << "," << (i == 0 ? 1 : 0) << ",1\n";
  }
  std::ofstream(folder.path / "s.toml") << "[variables]\ng = 9.81\nk = 1\nj = '=k'\n"
                                           "[structure]\nkind = 'custom'\nnodes_file = 'n_{j}.csv'\n"
                                           "rods = [{nodes = ['N0', 'N1'], mass = 1}]\n"
                                           "[gravity]\nacceleration = [0, 0, '=-g']\n";
  const auto plan = [&](const std::string& axis) {
    return SweepPlan{scene_source((folder.path / "s.toml").string(), {}), {parse_axis(axis)}, {}, {}};
  };
  const std::string both = files_of_points(plan("variables.k=1,2"));
  CHECK(both.find("n_2.csv") != std::string::npos);
  CHECK(both.find("n_1.csv") == std::string::npos);  // of the scene as it stands
  CHECK(files_of_points(plan("variables.k=1,2,3")).find("\"n_3.csv\": not there") != std::string::npos);
  // Another text of one of them is another sweep, and the first one's again the first.
  const auto second = [&](const char* more) {
    std::ofstream(folder.path / "n_2.csv") << "name,x_m,y_m,z_m,fixed,mass_kg\nN0,0,0,2,1,1\nN1,1,0,2,0,1\n"
                                           << more;
    return files_of_points(plan("variables.k=1,2"));
  };
  const std::string few = second(""), more = second("N2,2,0,2,0,1\n");
  CHECK(few != both);
  CHECK(few != more);
  CHECK(second("") == few);
  CHECK_FALSE(identity_of_both(few, more, true));
  CHECK(identity_of_both(few, few, false) == few);
  // Files that either knows of are those of both; one that was not there may have come.
  const std::string scene = "title = 's'\n", third = files_of_points(plan("variables.k=1,2,3"));
  CHECK(identity_of_both(scene + third, scene + few, false) == scene + few + "# \"n_3.csv\": not there\n");
  CHECK(identity_of_both(scene + few, scene + third, false) == scene + third);
  std::ofstream(folder.path / "n_3.csv") << "name,x_m,y_m,z_m\n";
  const std::string come = files_of_points(plan("variables.k=1,2,3"));
  CHECK(identity_of_both(scene + third, scene + come, true) == scene + come);
  CHECK_FALSE(identity_of_both(scene + third, scene + come, false));
  CHECK_FALSE(identity_of_both(scene + come, scene + third, true));  // nor may one have gone
  CHECK_FALSE(identity_of_both(scene + few, "title = 't'\n" + few, true));
  const SweepPlan other = plan("variables.g=1:10:1000");
  other.source.read();
  const double begin = cpu_seconds();
  for (int i = 0; i < 10; ++i) other.source.read();
  const double reading = (cpu_seconds() - begin) / 10, before = cpu_seconds();
  CHECK(files_of_points(other).empty());
  // One reading, and the scene's text looked through; a thousand were read.
  CHECK(cpu_seconds() - before < 50 * reading);
}

}  // namespace named_files_test
