// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/same_curves.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "render/plot/figures.hpp"
#include "render/plot/figures/study_figures.hpp"
#include "render/plot/layout.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;

namespace same_curves_test {

namespace {

Curve line(std::string label, double slope, double offset = 0) {
  Curve c;
  c.label = std::move(label);
  for (double x = 1; x <= 4; ++x) c.x.push_back(x), c.y.push_back(slope * x + offset);
  return c;
}

std::string said(std::vector<Panel> panels) {
  Figure f;
  f.panels = std::move(panels);
  return plot::same_curves_sentence(f);
}

Panel panel(std::vector<Curve> curves, std::string label = "force (N)") {
  Panel p;
  p.y.label = std::move(label);
  p.curves = std::move(curves);
  return p;
}

// Of a rod that hangs still: nothing moves, and no method has an error to make.
Study study_at_rest() {
  const Scene scene =
      read_scene_file(find_scene("pendulum"), {"structure.angle=0", "gravity.acceleration=[0,0,0]"});
  StudyPlan plan = plan_study(testing::make_model(build_structure(scene)), testing::dvm_options(3, 0.01, 0.3),
                              0.05, 0.0125, {});
  plan.timing.repeats = 1;
  Journal journal({}, study_columns(), study_key_columns);
  return run_study(plan, journal, {});
}

}  // namespace

TEST_CASE("curves that lie on each other are named", "[figures]") {
  CHECK(said({panel({line("A", 1), line("B", 2)})}).empty());
  CHECK(said({panel({line("A", 1), line("B", 2), line("C", 1)})}) == " A and C lie on each other.");
  // Half the width of a line, and three of them, on axes from 0.85 to 4.15.
  CHECK(said({panel({line("A", 1), line("B", 1, 0.005)})}) == " A and B lie on each other.");
  CHECK(said({panel({line("A", 1), line("B", 1, 0.03)})}).empty());
  std::vector<Curve> many;
  for (const char* name : {"A", "B", "C", "D", "E"}) many.push_back(line(name, 0));
  CHECK(said({panel(many)}) == " A, B, C and 2 more lie on each other.");
  CHECK(said({panel({line("A", 1), line("B", 2)}), panel({line("A", 1), line("B", 1)}, "power (W)")}) ==
        " A and B lie on each other (power).");
  std::vector<Panel> both{panel({line("A", 1), line("B", 2)}), panel({line("A", 1), line("B", 1)})};
  both[1].x.label = "time (s)";
  CHECK(said(both) == " A and B lie on each other (force over time).");
}

TEST_CASE("what has no values or another axis lies on nothing", "[figures]") {
  CHECK(said({panel({line("A", NAN), line("B", NAN)})}).empty());
  CHECK(said({panel({line("", 1), line("B", 1)})}).empty());
  Curve right = line("B", 1);
  right.right_axis = true;
  CHECK(said({panel({line("A", 1), right})}).empty());
}

TEST_CASE("errors of a study at rest are drawn at the floor, and that they are the same is said",
          "[figures]") {
  const Study study = study_at_rest();
  REQUIRE(study.curves.size() > 5);
  for (const Figure& figure : {work_precision_figure(study, "Rest"), convergence_figure(study, "Rest")}) {
    CAPTURE(figure.name);
    const plot::FigureLayout layout = plot::lay_out(figure);
    for (const plot::PanelLayout& panel : layout.panels)
      for (const auto& label : panel.labels) CHECK(label.text != "no data");
    CHECK(figure.caption.find(" Exact zeros are drawn at the bottom edge.") != std::string::npos);
  }
  CHECK(convergence_figure(study, "Rest")
            .caption.find(" lie on each other (position error, constraint error, energy error).") !=
        std::string::npos);
}

TEST_CASE("a figure of the rods says which of them bear the same", "[figures]") {
  // Two rods below each other that hang still without weight: both bear nothing.
  const Scene scene = read_scene_file(find_scene("double_pendulum"), {"gravity.acceleration=[0,0,0]"});
  SolverOptions options = testing::dvm_options(3, 0.01, 0.05);
  Structure still = build_structure(scene);
  for (Node& node : still.nodes) node.velocity.setZero();
  const Simulation run = simulate(testing::make_model(still), options);
  const Figure figure = find_figure("rod_forces")->make(run, diagnose(run));
  CHECK(figure.caption.find(" lie on each other.") != std::string::npos);
}

}  // namespace same_curves_test
