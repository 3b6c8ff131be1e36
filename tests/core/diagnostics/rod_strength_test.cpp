// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/rod_strength.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/diagnostics/measures.hpp"
#include "core/export/summary.hpp"
#include "core/scene/library.hpp"
#include "core/scene/write.hpp"
#include "core/structures/rod_material.hpp"
#include "core/system/mobility.hpp"
#include "tests/support/family_structure.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace rod_strength_test {

using testing::run_scene;

namespace {

constexpr double E = 2.1e11, A = 3.1e-4, P = 4321.0, pull = 2500.0, l = 1.7, strength = 2.4e8;

// A strut of 1.7 m that a load pushes on, a tie that another pulls on, each along a guide; what is free to
// move besides does nothing.
std::string strut_and_tie(const std::string& material) {
  return "[structure]\nkind = 'custom'\n" + material +
         "[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
         "[[structure.nodes]]\nname = 'S'\nposition = [0, 0, 1.7]\nmass = 1\n"
         "[[structure.nodes]]\nname = 'free'\nposition = [0, 1, 0]\nmass = 1\n"
         "[[structure.nodes]]\nname = 'T'\nposition = [0.9, 0, 0]\nmass = 1\n"
         "[[structure.rods]]\nname = 'strut'\nnodes = ['O', 'S']\nmass = 0\narea = 3.1e-4\n"
         "[[structure.rods]]\nname = 'tie'\nnodes = ['O', 'T']\nmass = 0\narea = 1.1e-4\n"
         "[[structure.constraints]]\nkind = 'line'\nnodes = ['S']\ndirection = [0, 0, 1]\n"
         "[[structure.constraints]]\nkind = 'line'\nnodes = ['T']\ndirection = [1, 0, 0]\n"
         "[[loads]]\nnodes = ['S']\nforce = [0, 0, -4321]\n[[loads]]\nnodes = ['T']\nforce = [2500, 0, 0]\n"
         "[solver]\nstep = 0.1\nend_time = 0.2\n";
}

std::string refusal(const std::string& scene) {
  try {
    build_model(read_scene_text(scene, "test.toml"));
    return "";
  } catch (const SceneError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("Euler's load and the stress of rods of every section") {
  struct Case {
    std::string material;
    double second_moment;
  };
  // A tube of wall t and area A has the mean diameter D = A / (pi t): I = pi/8 t D (D^2 + t^2).
  const double t = 2e-3, D = A / (pi * t);
  const std::vector<Case> cases{
      {"section = 'round'\n", A * A / (4 * pi)},
      {"section = 'square'\n", A * A / 12},
      {"section = 'tube'\nwall_thickness = 2e-3\n", pi / 8 * t * D * (D * D + t * t)}};
  for (const Case& c : cases) {
    INFO(c.material);
    const Simulation run =
        run_scene(strut_and_tie("youngs_modulus = 2.1e11\nstrength = 2.4e8\n" + c.material));
    const Diagnostics d = diagnose(run);
    const Structure& s = run.trajectory.structure();
    const double euler = pi * pi * E * c.second_moment / (l * l);
    CHECK(euler_load(s.rods[0]) == Approx(euler).epsilon(1e-12));
    const auto last = [&](const char* column) { return d.at(column).values.back(); };
    CHECK(last("buckling_ratio_max") == Approx(P / euler).epsilon(1e-9));
    CHECK(last("axial_stress_min_Pa") == Approx(-P / A).epsilon(1e-9));
    CHECK(last("axial_stress_max_Pa") == Approx(pull / 1.1e-4).epsilon(1e-9));
    CHECK(last("stress_ratio_max") == Approx(pull / 1.1e-4 / strength).epsilon(1e-9));
    CHECK(find_measure("peak_stress").value(run, d) == Approx(pull / 1.1e-4).epsilon(1e-9));
    CHECK(find_measure("buckling_margin").value(run, d) == Approx(euler / P - 1).epsilon(1e-9));
    CHECK(find_measure("stress_margin").value(run, d) == Approx(strength * 1.1e-4 / pull - 1).epsilon(1e-9));
    CHECK(find_measure("buckling_margin_unique").value(run, d) == 1.0);
    const Model& model = run.trajectory.model();
    const auto json = nlohmann::json::parse(summary_json(
        "test", run, d, analyse_mobility(model.system, run.trajectory.node_positions(0))))["strength"];
    CHECK(json["buckling"]["rod"] == "strut");
    CHECK(json["buckling"]["margin"].get<double>() == Approx(euler / P - 1).epsilon(1e-9));
    CHECK(json["axial_stress"]["rod"] == "tie");
    CHECK(json["axial_stress"]["unique"] == true);
    CHECK(json["stress"]["rod"] == "tie");
  }
}

TEST_CASE("Euler's load is that of a rod's own length, not of the distance at which it starts") {
  // N = E A (0.9 - 1) / 1 = -100 N over pi^2 E I / (1 m)^2.
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
rod_model = "elastic"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [0.9, 0, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 0.1, youngs_modulus = 1e7, area = 1e-4, second_moment = 1e-10, free_length = 1.0}]
[solver]
end_time = 0.01
step = 0.001
)");
  const Diagnostics d = diagnose(run);
  CHECK(d.axial_force(0, 0) == Approx(-100).epsilon(1e-12));
  CHECK(d.at("buckling_ratio_max").values.front() == Approx(100 / (pi * pi * 1e7 * 1e-10)).epsilon(1e-12));
}

TEST_CASE("a rod's own second moment, modulus and strength go before those of all rods") {
  const std::string scene = strut_and_tie("youngs_modulus = 2.1e11\nstrength = 2.4e8\n");
  const std::string own = "area = 3.1e-4\nsecond_moment = 8e-9\nyoungs_modulus = 7e10\nstrength = 1e8\n";
  std::string changed = scene;
  changed.replace(changed.find("area = 3.1e-4\n"), 14, own);
  const Scene read = read_scene_text(changed, "test.toml");
  for (const Scene& s : {read, read_scene_text(scene_text(read), "again.toml")}) {
    const Structure structure = build_structure(s);
    CHECK(euler_load(structure.rods[0]) == Approx(pi * pi * 7e10 * 8e-9 / (l * l)).epsilon(1e-12));
    CHECK(structure.rods[0].strength == 1e8);
    CHECK(structure.rods[1].strength == 2.4e8);
    CHECK(structure.rods[1].youngs_modulus == 2.1e11);
  }
}

TEST_CASE("without a modulus there is no stress, no margin and no column for them") {
  const Simulation run = run_scene(strut_and_tie(""));
  const Diagnostics d = diagnose(run);
  for (const char* column :
       {"axial_stress_max_Pa", "axial_stress_min_Pa", "stress_ratio_max", "buckling_ratio_max"})
    CHECK(d.find(column) == nullptr);
  CHECK(std::isnan(find_measure("buckling_margin").value(run, d)));
  CHECK(worst_rod(run.trajectory.structure(), d, axial_stress).rod == -1);
}

TEST_CASE("what cannot be a material is refused by its key") {
  const auto with = [](const std::string& text) { return refusal(strut_and_tie(text)); };
  CHECK_THAT(with("youngs_modulus = 0.0\n"),
             Catch::Contains("structure.youngs_modulus: must be > 0 Pa; got 0"));
  CHECK_THAT(with("youngs_modulus = -7e10\n"), Catch::Contains("structure.youngs_modulus: must be > 0 Pa"));
  CHECK_THAT(with("youngs_modulus = nan\n"),
             Catch::Contains("structure.youngs_modulus: must be a finite number > 0 Pa"));
  CHECK(with("youngs_modulus = inf\n").empty());
  CHECK_THAT(with("section = 'tube'\n"), Catch::Contains("a tube needs the thickness of its wall"));
  CHECK_THAT(with("section = 'tube'\nwall_thickness = 0.02\n"),
             Catch::Contains("a tube needs the thickness of its wall"));
  std::string no_area = strut_and_tie("youngs_modulus = 7e10\n");
  no_area.replace(no_area.find("mass = 0\narea = 3.1e-4"), 22, "mass = 1");
  CHECK_THAT(refusal(no_area),
             Catch::Contains("rods[0].area: a rod with a youngs_modulus needs its area, in m^2"));
  CHECK_THAT(testing::refusal("hoop", {{"section", std::string("tube")}}),
             Catch::Contains("wall_thickness: a tube needs the thickness of its wall"));
}

TEST_CASE("every family with a section area takes a modulus, which leaves braces rigid") {
  int families_with = 0;
  for (const Family& family : families()) {
    ParamSet params(family.params());
    if (!params.has("section_area")) continue;
    ++families_with;
    params.set("youngs_modulus", 7e10);
    const Structure s = family.build(params);
    INFO(family.kind);
    CHECK(any_elastic(s));
    for (const Rod& rod : s.rods) CHECK(rod.elastic() == (rod.group != "brace"));
  }
  CHECK(families_with == 9);
}

// Forces that are made up, of two rods of 1 and 4 cm^2 and one that is rigid, at three states.
TEST_CASE("the worst rod is the first that bears most of all at whichever state") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 1}, {name = "B", position = [1, 0, 0], mass = 1},
         {name = "C", position = [1, 1, 0], mass = 1}, {name = "D", position = [1, 1, 1], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 1, area = 1e-4, youngs_modulus = 7e10},
        {nodes = ["B", "C"], mass = 1, area = 4e-4, youngs_modulus = 7e10}, {nodes = ["C", "D"], mass = 1}]
[solver]
step = 0.05
end_time = 0.1
)");
  Diagnostics d = diagnose(run);
  REQUIRE(d.t.size() == 3);
  const auto worst = [&](std::vector<double> forces) {
    d.axial_force = Eigen::Map<Eigen::Matrix3d>(forces.data()).transpose();
    return worst_rod(run.trajectory.structure(), d, axial_stress);
  };
  const WorstRod first = worst({3, -900, 7, 100, 20, 8000, -200, 890, 9});
  CHECK(first.rod == 1);
  CHECK(first.value == Approx(-900 / 4e-4).epsilon(1e-14));
  CHECK(first.t == 0);
  const WorstRod last = worst({3, -900, 7, 100, 20, 8000, -300, 890, 9});
  CHECK(last.rod == 0);
  CHECK(last.value == Approx(-300 / 1e-4).epsilon(1e-14));
  CHECK(last.t == d.t[2]);
  CHECK(worst({5, 20, 7, 5, 20, 7, -5, -20, 9}).t == 0);
  const double nan = std::nan("");
  const WorstRod known = worst({3, nan, 7, 100, 20, 8000, nan, 890, 9});
  CHECK(known.rod == 1);
  CHECK(known.t == d.t[2]);
  CHECK(!known.unique);
}

}  // namespace rod_strength_test
