// SPDX-License-Identifier: BSD-3-Clause
// What a run says of itself does not depend on how its equations were set up, nor on when it began.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string_view>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/stepper.hpp"

using namespace unfurl;

namespace same_table_test {

namespace {

// Columns of one unit have a size in common.
std::string unit_of(const std::string& name) {
  for (const char* unit : {"_m_s", "_rad_s", "_N_m", "_m", "_rad", "_N", "_J", "_W"})
    if (name.ends_with(unit)) return unit;
  return name;
}

// Every column and every force that is unique, to a share of the largest of its unit; what counts rounding
// and work of the solver aside.
void check_same(const Diagnostics& a, const Diagnostics& b, std::size_t from, double share,
                const std::vector<std::string>& aside) {
  REQUIRE(a.t.size() == b.t.size() + from);
  REQUIRE(a.columns.size() == b.columns.size());
  std::map<std::string, double> size;
  for (const Series& column : a.columns)
    for (const double x : column.values)
      if (std::isfinite(x)) size[unit_of(column.name)] = std::max(size[unit_of(column.name)], std::abs(x));
  for (std::size_t c = 0; c < a.columns.size(); ++c) {
    const std::string& name = a.columns[c].name;
    INFO(name);
    REQUIRE(b.columns[c].name == name);
    if (name.starts_with("constraint_") || name == "newton_iterations") continue;
    if (std::ranges::find(aside, name) != aside.end()) continue;
    double apart = 0;
    for (std::size_t i = 0; i < b.t.size(); ++i) {
      const double x = a.columns[c].values[from + i], y = b.columns[c].values[i];
      CHECK(std::isfinite(x) == std::isfinite(y));
      if (std::isfinite(x)) apart = std::max(apart, std::abs(x - y));
    }
    CHECK(apart <= share * size[unit_of(name)]);
  }
  const auto shift = static_cast<Index>(from);
  const Index states = b.axial_force.rows();
  CHECK((a.force_unique.bottomRows(states) == b.force_unique).all());
  const double largest = a.axial_force.cwiseAbs().maxCoeff();
  for (Index i = 0; i < states; ++i)
    for (Index r = 0; r < b.axial_force.cols(); ++r)
      if (b.force_unique(i, r))
        CHECK(std::abs(a.axial_force(i + shift, r) - b.axial_force(i, r)) <= share * largest);
}

// Where forces are one choice of many, the largest may be another's.
const std::vector<std::string> largest_of_many{"axial_force_max_N", "axial_force_min_N",
                                               "axial_force_max_unique", "axial_force_min_unique"};

// Steps are solved to round-off, which forces take 1e7 times as large in poses whose smallest singular value
// is some 1e-3 of the largest, squared; a motor that drives the ring into its deployed pose comes nearer to
// one.
struct Case {
  const char* scene;
  std::vector<std::string> changes = {};
  double share = 1e-7;
  std::vector<std::string> aside = {};
};

}  // namespace

TEST_CASE("eliminated or kept as equations, linear constraints give the same table") {
  // All forces unique, or said not to be; drives, motors, stops, springs and dampers among what acts.
  const Case cases[] = {
      {"hoop6_motor"},
      {"hoop6_motor",
       {R"(constraints[0]={kind="angle",name="m",fold_angle=true,motion="rate",rate=-20})"},
       1e-5},
      {"scissor_mast"},
      {"hoop_arc", {"solver.end_time=2"}, 1e-7, largest_of_many},
      {"four_bar", {"solver.end_time=1"}},
      {"four_bar",
       {R"(forces[0]={kind="motor",rods=["crank","coupler"],stall_torque=0.9,no_load_speed=310,)"
        R"(gear_ratio=-7,axis=[0,1,0]})",
        R"(constraints[0]={kind="length_stop",nodes=["B","D"],max=3.5,restitution=0.7})",
        "solver.end_time=1"}}};
  for (const Case& one : cases) {
    INFO(one.scene << " " << (one.changes.empty() ? "" : one.changes.front()));
    std::array<Diagnostics, 2> tables;
    for (const bool eliminated : {true, false}) {
      std::vector<std::string> changes = one.changes;
      changes.emplace_back(eliminated ? "solver.eliminate_linear=true" : "solver.eliminate_linear=false");
      const Scene scene = read_scene_file(find_scene(one.scene), changes);
      tables[eliminated ? 0 : 1] = diagnose(simulate(build_model(scene), scene.solver));
    }
    check_same(tables[0], tables[1], 0, one.share, one.aside);
  }
}

TEST_CASE("a run that begins in the middle of another says the same of what is left") {
  for (const auto& [name, end] : {std::pair{"hoop6_motor", 3.0}, {"hoop_arc", 2.0}, {"four_bar", 1.0}}) {
    INFO(name);
    const Scene scene = read_scene_file(find_scene(name), {});
    SolverOptions options = scene.solver;
    options.end_time = end;
    const auto model = build_model(scene);
    const Simulation whole = simulate(model, options);
    const std::size_t middle = whole.trajectory.size() / 2;
    Stepper rest(model, options, whole.trajectory.state(middle));
    while (rest.step()) {
    }
    REQUIRE(rest.run().trajectory.start_time() > 0);
    // What adds up over time begins at zero again; the first row has no step before it.
    check_same(diagnose(whole), diagnose(rest.run()), middle, 1e-7,
               {"work_J", "drive_work_J", "motor.energy_J", "dissipated_J", "impact_loss_J",
                "energy_balance_J", "step_s"});
  }
}

}  // namespace same_table_test
