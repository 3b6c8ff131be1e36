// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/overrides.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

using namespace unfurl;

namespace overrides_test {

namespace {

constexpr const char* document =
    "title = 'x'\n[solver]\nstep = 0.01\n[structure]\nkind = 'custom'\n"
    "[[structure.nodes]]\nname = 'A'\n[[structure.nodes]]\nname = 'B.0'\n"
    "[[structure.rods]]\nnodes = ['A', 'B.0']\n";

struct Result {
  TomlTree tree;
  std::string problems;
};

Result with(const std::vector<std::string>& overrides) {
  Result result{parse_toml(document, "x.toml"), ""};
  std::vector<SceneProblem> problems;
  apply_overrides(result.tree, overrides, problems);
  for (const auto& problem : problems) result.problems += problem_text(problem) + "\n";
  return result;
}

}  // namespace

TEST_CASE("an override replaces, adds and makes tables") {
  const Result r =
      with({"solver.step=0.5", "solver.method=rk4", "render.size=[10, 20]", "title = Two words"});
  CHECK(r.problems == "");
  CHECK(r.tree.find("solver")->find("step")->real == 0.5);
  CHECK(r.tree.find("solver")->find("method")->text == "rk4");
  CHECK(r.tree.find("render")->find("size")->items[1].integer == 20);
}

TEST_CASE("the value is TOML where it can be, else a bare word") {
  CHECK(with({"title=true"}).tree.find("title")->kind == TomlTree::Kind::boolean);
  CHECK(with({"title=1"}).tree.find("title")->kind == TomlTree::Kind::integer);
  CHECK(with({"title='1'"}).tree.find("title")->text == "1");
  CHECK(with({"title=sector"}).tree.find("title")->text == "sector");
  CHECK(with({"title=B*"}).tree.find("title")->text == "B*");
  CHECK(with({"title=nan"}).tree.find("title")->kind == TomlTree::Kind::real);
}

TEST_CASE("entries of arrays go by index or name") {
  CHECK(with({"structure.nodes[1].mass=2"})
            .tree.find("structure")
            ->find("nodes")
            ->items[1]
            .find("mass")
            ->integer == 2);
  CHECK(with({"structure.nodes.A.mass=2"})
            .tree.find("structure")
            ->find("nodes")
            ->items[0]
            .find("mass")
            ->integer == 2);
  CHECK(with({"structure.nodes.\"B.0\".mass=2"}).problems == "");
  CHECK(with({"structure.rods.\"A-B.0\".mass=2"}).problems == "");
}

TEST_CASE("what goes by its nodes gives way to what has that name, and is not chosen among several") {
  const auto masses = [](const std::string& entries, std::string& problems) {
    TomlTree tree = parse_toml("[[forces]]\nnodes = ['A', 'B']\nsize = 1\n" + entries, "x.toml");
    std::vector<SceneProblem> found;
    apply_overrides(tree, {"forces[A-B].size=7"}, found);
    problems = found.empty() ? "" : problem_text(found[0]);
    std::vector<long> sizes;
    for (const TomlTree& item : tree.find("forces")->items) sizes.push_back(item.find("size")->integer);
    return sizes;
  };
  const std::string named = "[[forces]]\nname = 'A-B'\nnodes = ['C', 'D']\nsize = 2\n",
                    alike = "[[forces]]\nnodes = ['A', 'B']\nsize = 3\n",
                    other = "[[forces]]\nname = 'own'\nnodes = ['A', 'B']\nsize = 4\n";
  std::string problems;
  CHECK(masses(named, problems) == std::vector<long>{1, 7});
  CHECK(masses(other, problems) == std::vector<long>{7, 4});
  CHECK(masses(alike + named, problems) == std::vector<long>{1, 3, 7});
  CHECK(problems == "");
  CHECK(masses(other + alike, problems) == std::vector<long>{1, 4, 3});
  CHECK(problems ==
        "--set forces[A-B].size: forces has 2 entries that go by 'A-B'; the first is [0], the second [2]");
}

TEST_CASE("the index behind the last adds an entry of loads, forces or constraints, of nothing else") {
  const Result r = with({"forces[0]={kind = 'drag', nodes = ['A']}", "forces[0].damping=2",
                         "forces[1]={kind = 'drag', nodes = ['B.0']}", "loads[0].nodes=['A']"});
  CHECK(r.problems == "");
  const auto& forces = r.tree.find("forces")->items;
  REQUIRE(forces.size() == 2);
  CHECK(forces[0].find("damping")->integer == 2);
  CHECK(forces[1].find("nodes")->items[0].text == "B.0");
  CHECK(r.tree.find("loads")->items.size() == 1);
  CHECK(with({"forces[1]={kind = 'drag'}"}).problems ==
        "--set forces[1]: forces has 0 entries; a new one is [0]\n");
  CHECK(with({"structure.nodes[2].mass=1"}).problems == "");  // behind the last: a new one
}

TEST_CASE("entries of lists that a scene does not have yet, and names with brackets and dots in them") {
  const Result r =
      with({"surfaces[0].kind=net", "render.camera_keys[0].time=1.5", "render.camera_keys[1]={time = 2.5}",
            "forces[0].name='a b.c[2]'", "forces[\"a b.c[2]\"].damping=3"});
  CHECK(r.problems == "");
  CHECK(r.tree.find("surfaces")->items.size() == 1);
  CHECK(r.tree.find("render")->find("camera_keys")->items.size() == 2);
  CHECK(r.tree.find("forces")->items[0].find("damping")->integer == 3);
  CHECK(with({"forces[pull].damping=3"}).problems ==
        "--set forces[pull].damping: forces has no entry named 'pull'; a new one is [0]\n");
  CHECK(with({"forces[0].kind=drag", "forces[pull].damping=3"}).problems ==
        "--set forces[pull].damping: forces has no entry named 'pull'; the first is [0]\n");
}

TEST_CASE("a name may begin with a sign as long as it is no number") {
  for (const char* name : {"-Y panel", "+X.2", "--", "-1"}) {
    INFO(name);
    const Result r =
        with({"forces[0].name='" + std::string(name) + "'", "forces['" + std::string(name) + "'].damping=3"});
    CHECK(r.problems == "");
    CHECK(r.tree.find("forces")->items[0].find("damping")->integer == 3);
  }
  CHECK(with({"forces[0].name=-Y panel", "forces[-Y panel].damping=3"}).problems != "");  // a value in quotes
  CHECK(with({"forces[0].name='-Y panel'", "forces[-Y panel].damping=3"}).problems == "");
  for (const char* index : {"-1", "+1", "", "''", "-"})
    CHECK(with({"structure.nodes[" + std::string(index) + "].mass=1"}).problems ==
          "--set structure.nodes[" + std::string(index) +
              "].mass: an index must be a whole number in brackets, [0] the first, or a name\n");
}

TEST_CASE("one component of a vector that the scene leaves out") {
  const Result r = with({"gravity.acceleration[2]=-1.5", "structure.nodes[1].velocity[0]=2"});
  CHECK(r.problems == "");
  const TomlTree* g = r.tree.find("gravity")->find("acceleration");
  REQUIRE(g->items.size() == 3);
  CHECK(g->items[0].integer == 0);
  CHECK(g->items[2].real == -1.5);
  const TomlTree* v = r.tree.find("structure")->find("nodes")->items[1].find("velocity");
  REQUIRE(v->items.size() == 3);
  CHECK(v->items[0].integer == 2);
  CHECK(with({"gravity.acceleration[3]=1"}).problems ==
        "--set gravity.acceleration[3]: gravity.acceleration is not a list\n");
}

TEST_CASE("overrides that cannot be applied say why") {
  CHECK(with({"solver.step"}).problems == "--set solver.step: must be key=value\n");
  CHECK(with({"solver.step="}).problems == "--set solver.step: has no value\n");
  CHECK(with({"solver.step=1 2"}).problems ==
        "--set solver.step: not a TOML value: '1 2'; text goes in quotes unless it is a bare word\n");
  const auto written = [](const std::string& value) { return with({"solver.step=" + value}).problems; };
  const std::string no_value = "--set solver.step: not a TOML value: '";
  CHECK(written(".5") == no_value + ".5'; write 0.5\n");
  CHECK(written("+.5") == no_value + "+.5'; write 0.5\n");
  CHECK(written("-.25e1") == no_value + "-.25e1'; write -2.5\n");
  CHECK(written("0,0,-9.81") == no_value + "0,0,-9.81'; write [0,0,-9.81]\n");
  CHECK(with({"solver.method=.dvm"}).problems == "");  // a word
  CHECK(with({"solver.step=1\nx=2"}).problems == "--set solver.step: the value must be one TOML value\n");
  CHECK(with({"title.x=1"}).problems == "--set title.x: title is text, not a table\n");
  CHECK(with({"structure.nodes[7].mass=1"}).problems ==
        "--set structure.nodes[7].mass: structure.nodes has 2 entries; a new one is [2]\n");
  CHECK(with({"structure.nodes.a.mass=1"}).problems ==
        "--set structure.nodes.a.mass: structure.nodes has no entry named 'a'; did you mean 'A'?\n");
  CHECK(with({"solver[0]=1"}).problems == "--set solver[0]: solver is not a list\n");
  CHECK(with({"a..b=1"}).problems == "--set a..b: the key has an empty part\n");
  CHECK(with({"a[x]=1"}).problems == "--set a[x]: a is not a list\n");
  CHECK(with({"\"a=1"}).problems == "--set \"a: a quote in the key stays open\n");
  CHECK(with({"title.\"\"=1"}).problems ==
        "--set title.\"\": title is text, not a table\n");  // an empty name
  CHECK(with({"=1"}).problems.find("the key has an empty part") != std::string::npos);
}

TEST_CASE("a name with an equals sign is set as it stands") {
  TomlTree root = parse_toml("[[forces]]\nname = 'a=b'\nx = 1\n[t]\n'c=d' = 1\n", "x.toml");
  std::vector<SceneProblem> problems;
  apply_overrides(root, {"forces[a=b].x=2", "t.'c=d'=\"e=f\"", "forces[\"a=b\"].y=3"}, problems);
  CHECK(problems.empty());
  CHECK(root.find("forces")->items[0].find("x")->integer == 2);
  CHECK(root.find("forces")->items[0].find("y")->integer == 3);
  CHECK(root.find("t")->find("c=d")->text == "e=f");
  CHECK(equals_of("forces[a]b=c") == 10);
  CHECK(equals_of("structure.nodes[Bob's].mass=1") == 27);
  CHECK(equals_of("solver.step") == std::string_view::npos);
}

TEST_CASE("one bad override does not hide another") {
  const Result r = with({"title.x=1", "solver.step=0.5", "a..b=1"});
  CHECK(std::count(r.problems.begin(), r.problems.end(), '\n') == 2);
  CHECK(r.tree.find("solver")->find("step")->real == 0.5);
}

}  // namespace overrides_test
