// SPDX-License-Identifier: BSD-3-Clause
// The figures of studies, sweeps, stress runs and of the paper, judged as the figures of runs are.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "core/scene/library.hpp"
#include "render/plot/figure_data.hpp"
#include "render/plot/figures/reproduce_figures.hpp"
#include "render/plot/figures/stress_figures.hpp"
#include "render/plot/figures/study_figures.hpp"
#include "render/plot/figures/sweep_figures.hpp"
#include "render/plot/layout.hpp"
#include "tests/render/plot/recording_canvas.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;

namespace study_figures_test {

namespace {

// Every row of study_settings: what a page of all methods has to hold.
Study study() {
  StudyPlan plan = plan_study(testing::make_model(testing::double_pendulum()),
                              testing::dvm_options(3, 0.01, 0.3), 0.05, 0.0125, {});
  plan.timing.repeats = 1;
  Journal journal({}, study_columns(), study_key_columns);
  return run_study(plan, journal, {});
}

Sweep sweep_of(SweepPlan& plan) {
  for (const char* name : {"deploy_time", "peak_rod_force"}) plan.measures.push_back(find_measure(name));
  Journal journal({}, plan.columns(), plan.axes.size());
  return run_sweep(plan, journal, {});
}

// Two runs whose errors grow as laws of the number of steps say, one of them cut off.
Stress long_stress() {
  Stress stress;
  for (const char* name : {"dvm, s = 3", "rk4", "generalized_alpha"}) {
    LongRun run;
    run.setting = name;
    run.step = 0.01;
    for (double n = 1; n <= 1e6; n *= 10) {
      run.step_count.push_back(n);
      run.energy_error.push_back(name[0] == 'd' ? 1e-9 : 1e-10 * n);
      run.constraint.push_back(name[0] == 'd' ? 0.0 : 1e-12 * n * n);
      run.steps = static_cast<long>(n);
    }
    run.end = name[0] == 'r' ? "constraints lost" : "done";
    stress.long_runs.push_back(run);
  }
  return stress;
}

Reproduction reproduction() {
  Reproduction r;
  for (const char* name :
       {"variational, as printed", "Runge-Kutta 4", "variational, 3 nodes", "variational, 4 nodes"}) {
    ReproducedScheme scheme;
    scheme.name = name;
    const double floor = name[0] == 'R' ? 1e-9 : 1e-15;
    for (const double h : reproduced_steps) {
      ReproducedRun run;
      run.measured.outcome = "ok";
      run.measured.step = h;
      run.measured.position_error = h * h;
      for (double t = 0; t < 4.9; t += 0.1) {
        run.t.push_back(t), run.constraint_error.push_back(floor * t);
        run.comparison_t.push_back(t), run.position_error.push_back(h * h * t);
      }
      scheme.runs.push_back(run);
    }
    r.schemes.push_back(scheme);
  }
  r.motion = std::make_shared<const Simulation>(
      simulate(testing::make_model(testing::hoop_structure({{"model", std::string("sector")}})),
               testing::dvm_options(3, 0.05, 9.0)));
  return r;
}

void judge(const Figure& figure, bool slide = true) {
  CAPTURE(figure.name);
  CHECK(plot::twins(figure) == std::vector<std::string>{});
  for (const FigureStyle& style : figure_styles()) {
    if (style.name == "slide" && !slide) continue;
    CAPTURE(style.name);
    CHECK(plot::faults(figure, style) == std::vector<std::string>{});
  }
  CHECK(figure_csv(figure).size() > 200);
  CHECK(figure_caption(figure).ends_with(".\n"));
}

}  // namespace

TEST_CASE("figures of a study are in order in every style", "[figures]") {
  const Study all = study();
  Figure key = work_precision_figure(all, "Ring");
  for (Curve& c : key.panels.back().curves) c.x = c.y = {1};  // a curve without points tells nothing apart
  REQUIRE(key.panels.back().curves.size() == study_settings({}).size());
  CHECK(plot::twins(key) == std::vector<std::string>{});
  judge(work_precision_figure(all, "Spatial double pendulum of two rods"));
  judge(convergence_figure(all, "Spatial double pendulum of two rods"));
}

TEST_CASE("figures of a sweep are in order in every style: curves, families of curves, maps, words",
          "[figures]") {
  const SceneSource sector{find_scene("hoop6_sector"), {"solver.step=0.05"}};
  for (const std::vector<std::string>& axes :
       {std::vector<std::string>{"structure.fold_angle=40:80:5"},
        {"structure.fold_angle=40:80:4", "structure.hinge_force=100:400:3"},
        {"structure.fold_angle=40:80:5", "structure.hinge_force=100:400:5"},
        {"solver.method=dvm,rk4,rk4_projected,generalized_alpha"},
        {"solver.method=dvm,rk4", "solver.at_deployed=stop,latch,pass"}}) {
    SweepPlan plan{sector, {}, {}, {}};
    for (const std::string& axis : axes) plan.axes.push_back(parse_axis(axis));
    const Sweep sweep = sweep_of(plan);
    const std::vector<Figure> figures = sweep_figures(plan, sweep, "Six-unit ring antenna");
    REQUIRE(figures.size() == 2);
    for (const Figure& figure : figures) judge(figure);
  }
}

TEST_CASE("a sweep over decades is drawn on a log axis, and its axes tell their units", "[figures]") {
  SweepPlan plan{{find_scene("hoop6_sector"), {}}, {parse_axis("solver.step=0.02:0.1:4:log")}, {}, {}};
  plan.measures = {find_measure("energy_error"), find_measure("deploy_time")};
  check_plan(plan);
  Sweep sweep{{plan.columns(), {}}};
  for (std::size_t i = 0; i < 4; ++i)
    sweep.table.rows.push_back(
        {plan.axes[0].values[i], "deployed", i == 0 ? "0" : "1e-" + std::to_string(3 * i), "4.9"});
  const std::vector<Figure> figures = sweep_figures(plan, sweep, "Ring");
  REQUIRE(figures.size() == 2);
  CHECK(figures[0].panels[0].y.log);
  CHECK(figures[0].caption == "4 runs. One exact zero is drawn at the bottom edge.");
  CHECK(figures[0].title == "Energy error: Ring");
  CHECK_FALSE(figures[1].panels[0].y.log);
  CHECK(figures[1].caption == "4 runs.");
  for (const Figure& figure : figures) CHECK(figure.panels[0].x.label == "solver step (s)");
}

TEST_CASE("words of a sweep stand below each other, in their order, beside what was measured", "[figures]") {
  SweepPlan plan{
      {find_scene("hoop6_sector"), {}},
      {parse_axis("solver.at_deployed=stop,pass"), parse_axis("solver.method=rk4,dvm,rk4_projected")},
      {},
      {}};
  plan.measures = {find_measure("deploy_time")};
  check_plan(plan);
  Sweep sweep{{plan.columns(), {}}};
  for (const std::string& end : plan.axes[0].values)
    for (const std::string& method : plan.axes[1].values)
      sweep.table.rows.push_back(
          {end, method, "deployed",
           (end == plan.axes[0].values[0] ? "4." : "5.") + std::to_string(method.size())});
  const Figure figure = sweep_figures(plan, sweep, "Ring").front();
  const Panel& panel = figure.panels[0];
  CHECK(panel.y.names == std::vector<std::string>{"rk4_projected", "dvm", "rk4"});  // from below
  CHECK(panel.y.label == "solver method");
  CHECK(panel.x.label == "deployment time (s)");
  REQUIRE(panel.curves.size() == 2);
  CHECK(panel.curves[0].label == "solver at deployed = stop");
  const std::string csv = figure_csv(figure);
  for (const char* row : {"1,curve,solver at deployed = stop,4.3,rk4,,\n",
                          "1,curve,solver at deployed = pass,5.13,rk4_projected,,\n"})
    CHECK_THAT(csv, Catch::Contains(row));
}

TEST_CASE("a list in any order is drawn as a curve from the left to the right", "[figures]") {
  SweepPlan plan{{find_scene("hoop6_sector"), {}}, {parse_axis("structure.fold_angle=50,80,40,60")}, {}, {}};
  plan.measures = {find_measure("deploy_time")};
  check_plan(plan);
  Sweep sweep{{plan.columns(), {}}};
  for (const std::string& angle : plan.axes[0].values)
    sweep.table.rows.push_back({angle, "deployed", angle + ".5"});
  const Curve curve = sweep_figures(plan, sweep, "Ring").front().panels[0].curves.at(0);
  CHECK(curve.x == std::vector<double>{40, 50, 60, 80});
  CHECK(curve.y == std::vector<double>{40.5, 50.5, 60.5, 80.5});
}

TEST_CASE("a sweep's figure says how many runs never get there, and names thirds shortly", "[figures]") {
  SweepPlan plan{{find_scene("hoop6_sector"), {}},
                 {parse_axis("structure.post_length=1:2:5"), parse_axis("structure.chord_rod_length=2:3:4")},
                 {},
                 {}};
  plan.measures = {find_measure("deploy_time")};
  check_plan(plan);
  Sweep sweep{{plan.columns(), {}}};
  for (const std::string& post : plan.axes[0].values)
    for (const std::string& chord : plan.axes[1].values)
      sweep.table.rows.push_back({post, chord, "completed", chord == "3" ? "inf" : "4.9"});
  const Figure figure = sweep_figures(plan, sweep, "Ring").front();
  CHECK(figure.caption.starts_with("20 runs. Infinite in 5 of the runs, which are not drawn."));
  const auto& curves = figure.panels[0].curves;
  REQUIRE(curves.size() == 4);
  CHECK(curves[0].label == "chord rod length = 2 m");
  CHECK(curves[1].label == "chord rod length = 2.33333 m");
}

TEST_CASE("a sweep's figure says how many runs ended before the deployed pose", "[figures]") {
  SweepPlan plan{{find_scene("hoop6_sector"), {}}, {parse_axis("structure.fold_angle=40,50,60,70")}, {}, {}};
  plan.measures = {find_measure("peak_energy"), find_measure("deploy_time")};
  check_plan(plan);
  const auto captions = [&](const std::vector<std::string>& outcomes) {
    Sweep sweep{{plan.columns(), {}}};
    for (std::size_t i = 0; i < outcomes.size(); ++i)
      sweep.table.rows.push_back(
          {plan.axes[0].values[i], outcomes[i], "300", outcomes[i] == "deployed" ? "4.9" : "inf"});
    std::vector<std::string> said;
    for (const Figure& figure : sweep_figures(plan, sweep, "Ring")) said.push_back(figure.caption);
    REQUIRE(said.size() == 2);
    return said;
  };
  const std::vector<std::string> one = captions({"deployed", "completed", "deployed", "deployed"});
  CHECK(one[0] == "4 runs. 1 of them ended before its structure was deployed.");
  CHECK(one[1] == one[0] + " Infinite in 1 of the runs, which is not drawn.");
  CHECK(captions({"deployed", "completed", "deployed", "completed"})[0] ==
        "4 runs. 2 of them ended before their structures were deployed.");
  CHECK(captions({"deployed", "deployed", "deployed", "deployed"})[0] == "4 runs.");
  CHECK(captions({"completed", "completed", "completed", "completed"})[0] == "4 runs.");  // as all are
  // A run that goes on from the deployed pose has the same outcome as one that did not come to it.
  plan.axes = {parse_axis("solver.step=0.01,0.02"), parse_axis("solver.at_deployed=stop,pass")};
  check_plan(plan);
  Sweep sweep{{plan.columns(), {}}};
  for (const char* step : {"0.01", "0.02"})
    for (const char* then : {"stop", "pass"})
      sweep.table.rows.push_back({step, then, *then == 's' ? "deployed" : "completed", "300", "4.9"});
  const std::vector<Figure> figures = sweep_figures(plan, sweep, "Ring");
  REQUIRE(figures.size() == 2);
  CHECK(figures[0].caption.starts_with("4 runs."));
  CHECK(figures[0].caption.find("ended before") == std::string::npos);
}

// f = u v of each square, bilinear on axes as they are drawn: the hyperbola of a level is far from the chord
// between the square's edges, up to a fifth of the whole range.
TEST_CASE("contour lines lie on the colours of their level", "[figures]") {
  for (const bool log : {false, true}) {
    INFO(log);
    SweepPlan plan{{find_scene("hoop6_sector"), {}}, {}, {}, {}};
    const std::string x = log ? "structure.hinge_force=1:10000:5:log" : "structure.hinge_force=100:500:5";
    plan.axes = {parse_axis(x), parse_axis("structure.fold_angle=40:80:5")};
    plan.measures = {find_measure("deploy_time")};
    check_plan(plan);
    Sweep sweep{{plan.columns(), {}}};
    const auto value_at = [](std::size_t i, std::size_t j) { return i == 2 && j == 2 ? 1.0 : 0.0; };
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t j = 0; j < 5; ++j)
        sweep.table.rows.push_back(
            {plan.axes[0].values[i], plan.axes[1].values[j], "deployed", value_at(i, j) > 0 ? "1" : "0"});
    const auto hat = [](double share) { return std::max(0.0, 1 - std::abs(share - 2)); };  // in squares
    const auto squares = [&](double value) { return log ? std::log10(value) : (value - 100) / 100; };
    const Figure map = sweep_figures(plan, sweep, "Ring").front();
    std::size_t points = 0;
    for (const Curve& c : map.panels.at(0).curves) {
      if (c.label.empty()) continue;
      const double level = std::stod(c.label);
      for (std::size_t k = 0; k + 1 < c.x.size(); k += 3, ++points) {
        const double u = 0.5 * (squares(c.x[k]) + squares(c.x[k + 1])),
                     v = (0.5 * (c.y[k] + c.y[k + 1]) - 40) / 10;
        // A chord of a sixteenth of a square is off by up to 1/4 of the product's 1/16^2; its ends, which lie
        // linearly between two values of a log axis, by up to ln 10 / 8 of 1/16^2, with a slope of 1.
        CHECK(std::abs(hat(u) * hat(v) - level) < (log ? 2.3e-3 : 1.1e-3));
      }
    }
    CHECK(points > 100);
  }
}

TEST_CASE("the table of a map has a row for every cell", "[figures]") {
  SweepPlan plan{{find_scene("hoop6_sector"), {"solver.step=0.05"}}, {}, {}, {}};
  for (const char* axis : {"structure.fold_angle=40:80:5", "structure.hinge_force=100:400:5"})
    plan.axes.push_back(parse_axis(axis));
  const Figure map = sweep_figures(plan, sweep_of(plan), "Ring").front();
  const std::string numbers = figure_csv(map);
  std::size_t cells = 0;
  for (std::size_t at = 0; (at = numbers.find("1,cell,", at)) != std::string::npos; ++at, ++cells)
    CHECK(is_number(numbers.substr(at + 7, numbers.find(',', at + 7) - at - 7)));
  CHECK(cells == map.panels.front().cells.size());
}

TEST_CASE("values that are whole numbers stand at whole ticks", "[figures]") {
  SweepPlan plan{{find_scene("hoop6"), {"solver.step=0.05"}}, {}, {}, {}};
  plan.axes.push_back(parse_axis("structure.units=4,5,6"));
  plan.measures.push_back(find_measure("end_time"));
  check_plan(plan);
  Sweep sweep{{plan.columns(), {}}};
  for (const char* units : {"4", "5", "6"}) sweep.table.rows.push_back({units, "deployed", "3"});
  const std::vector<Figure> figures = sweep_figures(plan, sweep, "Ring");
  REQUIRE(figures.size() == 1);
  CHECK(figures[0].panels.at(0).x.whole);
}

// A map of base + step (5 i + j) over a grid of 5 x 5, where it is known.
Figure map_of(double base, double step, const std::function<bool(int, int)>& known = {}) {
  SweepPlan plan{{find_scene("hoop6_sector"), {}}, {}, {}, {}};
  for (const char* axis : {"structure.fold_angle=40:80:5", "structure.hinge_force=100:400:5"})
    plan.axes.push_back(parse_axis(axis));
  plan.measures = {find_measure("deploy_time")};
  check_plan(plan);
  Sweep sweep{{plan.columns(), {}}};
  for (int k = 0; k < 25; ++k) {
    char value[32];
    const bool here = !known || known(k / 5, k % 5);
    std::snprintf(value, sizeof value, "%.17g",
                  here ? base + step * k : std::numeric_limits<double>::infinity());
    sweep.table.rows.push_back({plan.axes[0].values[static_cast<std::size_t>(k / 5)],
                                plan.axes[1].values[static_cast<std::size_t>(k % 5)], "deployed", value});
  }
  return sweep_figures(plan, sweep, "Ring").front();
}

TEST_CASE("no two contour lines of a map have one number", "[figures]") {
  for (const double step : {1e-1, 1e-5, 1e-9}) {
    const Figure map = map_of(2, step);
    std::set<std::string> numbers;
    std::size_t lines = 0;
    for (const Curve& c : map.panels.front().curves)
      if (!c.label.empty()) ++lines, numbers.insert(c.label);
    CAPTURE(step);
    CHECK(lines > 2);
    CHECK(numbers.size() == lines);
  }
}

TEST_CASE("a map of what differs by rounding alone has no colours, and says its value", "[figures]") {
  const Figure map = map_of(5.42494, 1e-15);
  CHECK(map.panels.size() == 1);
  CHECK(map.panels.front().cells.empty());
  CHECK(map.panels.front().curves.size() == 1);  // the dots
  CHECK(map.caption.find(" = 5.425, computed on") != std::string::npos);
  CHECK(map_of(5.42494, 1e-9).panels.size() == 2);
}

// One square of the grid is known, and one point at a corner and one in the middle, of which no square is.
TEST_CASE("a map has the colour of a value whose neighbours have none", "[figures]") {
  const auto known = [](int i, int j) {
    return (i >= 3 && j <= 1) || (i == 0 && j == 0) || (i == 2 && j == 3);
  };
  const Figure map = map_of(2, 0.125, known);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      const double x = 40 + 10 * i, y = 100 + 75 * j;
      CAPTURE(x, y);
      std::vector<double> there;
      for (const Cell& cell : map.panels.front().cells)
        if (cell.x0 <= x && x <= cell.x1 && cell.y0 <= y && y <= cell.y1)
          there.push_back(std::stod(cell.stands_for));
      if (!known(i, j)) {
        CHECK(there.empty());
      } else {
        REQUIRE(there.size() == 1);
        // Of a lone point the value, of the square's that of a part, half of a 16th off along either way.
        const double value = 2 + 0.125 * (5 * i + j);
        CHECK(std::abs(there[0] - value) <= (i >= 3 ? 0.125 * (5 + 1) / 32 * (1 + 1e-9) : 0));
      }
    }
  CHECK(map.caption.find("small squares") != std::string::npos);
  CHECK(map_of(2, 0.125).caption.find("small squares") == std::string::npos);
}

TEST_CASE("a map has a dot at every point that was computed", "[figures]") {
  SweepPlan plan{{find_scene("hoop6_sector"), {"solver.step=0.05"}}, {}, {}, {}};
  for (const char* axis : {"structure.fold_angle=40:80:6", "structure.hinge_force=100:400:7"})
    plan.axes.push_back(parse_axis(axis));
  const Figure map = sweep_figures(plan, sweep_of(plan), "Ring").front();
  CHECK(map.panels.front().curves.back().marker == Marker::circle);
  std::size_t dots = 0;
  const plot::FigureLayout layout = plot::lay_out(map);
  for (const auto& piece : layout.panels.front().curves.back()) dots += piece.size();
  CHECK(dots == 6 * 7);
}

TEST_CASE("figures of stress runs are in order in every style", "[figures]") {
  StressPlan plan = plan_stress({find_scene("hoop6_sector"), {}}, {"force"});
  plan.extremes[0].values = {1e-3, 1, 1e3};
  plan.steps = {8, 32, 128};
  Journal journal({}, stress_columns(), stress_key_columns);
  const Stress stress = run_stress(plan, journal, {});
  for (const Figure& figure : atlas_figures(plan, stress, "Six-unit ring antenna")) judge(figure);
  CHECK(atlas_figures(plan, {}, "Six-unit ring antenna").empty());  // no reference: nothing to draw
  Stress less = stress;
  CHECK_THAT(atlas_figures(plan, less, "Ring").front().caption, !Catch::Contains("no reference"));
  std::erase_if(less.cells, [](const StressCell& cell) { return cell.value == 1e3; });
  CHECK_THAT(atlas_figures(plan, less, "Ring").front().caption,
             Catch::EndsWith(" White: values of which there is no reference."));
  judge(long_run_figure(long_stress(), "Ladder of four-bar windows"));
}

TEST_CASE("figures beside the paper's are in order in every style", "[figures]") {
  const Reproduction r = reproduction();
  judge(reproduced_poses_figure(r));
  judge(reproduced_constraint_figure(r));
  judge(reproduced_trajectory_figure(r));
}

}  // namespace study_figures_test
