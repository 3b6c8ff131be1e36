// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "render/plot/figure_data.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <charconv>
#include <map>
#include <set>

#include "tests/render/plot/recording_canvas.hpp"
#include "tests/support/family_structure.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

namespace unfurl {
namespace {

struct Run {
  Simulation simulation;
  Diagnostics diagnostics;
  Figure figure(std::string_view name) const { return find_figure(name)->make(simulation, diagnostics); }
};

Run run(const Structure& structure, double step, double end_time) {
  Simulation s = simulate(testing::make_model(structure), testing::dvm_options(3, step, end_time));
  Diagnostics d = diagnose(s);
  return {std::move(s), std::move(d)};
}

const Run& hoop() {
  static const Run r = run(testing::hoop_structure({{"units", 4L}, {"fold_angle", 60.0}}), 0.02, 9.0);
  return r;
}
const Run& sector() {
  static const Run r =
      run(testing::hoop_structure({{"units", 4L}, {"fold_angle", 60.0}, {"model", std::string("sector")}}),
          0.02, 9.0);
  return r;
}
const Run& sheet() {
  static const Run r =
      run(testing::family_structure("reentrant_sheet", {{"rows", 2L}, {"columns", 2L}}), 0.02, 9.0);
  return r;
}
const Run& steel() {
  static const Run r =
      run(build_structure(read_scene_file(find_scene("hoop6"),
                                          {"structure.units=4", "structure.fold_angle=60",
                                           "structure.youngs_modulus=2.1e11", "structure.strength=3e8"})),
          0.02, 9.0);
  return r;
}
const Run& motor() {
  static const Run r = run(build_structure(read_scene_file(find_scene("hoop6_motor"), {})), 0.02, 1.0);
  return r;
}
const Run& pendulum() {
  static const Run r = run(testing::double_pendulum(), 0.02, 1.0);
  return r;
}

}  // namespace

TEST_CASE("every figure of the table is found by its name and names its file", "[figures]") {
  std::set<std::string_view> names;
  for (const FigureKind& kind : figure_kinds()) {
    CHECK(find_figure(kind.name) == &kind);
    CHECK(names.insert(kind.name).second);
    CHECK_FALSE(kind.help.empty());
    if (!kind.applies(hoop().simulation, hoop().diagnostics)) continue;
    CHECK(hoop().figure(kind.name).name == kind.name);
  }
  CHECK(find_figure("no such figure") == nullptr);
}

TEST_CASE("figures of real runs are in order", "[figures]") {
  std::set<std::string_view> drawn;
  for (const Run* r : {&hoop(), &sector(), &pendulum(), &sheet(), &steel(), &motor()}) {
    for (const FigureKind& kind : figure_kinds()) {
      if (!kind.applies(r->simulation, r->diagnostics)) continue;
      drawn.insert(kind.name);
      CAPTURE(kind.name, r->simulation.trajectory.structure().kind);
      const Figure figure = r->figure(kind.name);
      CHECK(plot::twins(figure) == std::vector<std::string>{});
      for (const FigureStyle& style : figure_styles()) {
        CAPTURE(style.name);
        CHECK(plot::faults(figure, style) == std::vector<std::string>{});
      }
    }
  }
  CHECK(drawn.size() == figure_kinds().size());  // every kind was judged
}

TEST_CASE("the phase portrait runs from the released fold angle at rest to the deployed pose", "[figures]") {
  const Panel p = hoop().figure("phase").panels.at(0);
  CHECK(p.curves.at(0).x.front() == Approx(60).epsilon(1e-12));
  CHECK(p.curves.at(0).y.front() == 0.0);
  // The exact rate from the energy of the ring of four units (model's own data): compared with itself through
  // finite differences of the angle, which the rate is the derivative of: second order, 1e-3 at h = 0.02 s.
  const std::vector<double>&a = p.curves.at(0).x, &rate = p.curves.at(0).y, &t = hoop().diagnostics.t;
  const std::size_t i = a.size() / 2;
  CHECK((a[i + 1] - a[i - 1]) / (t[i + 1] - t[i - 1]) == Approx(rate[i]).epsilon(1e-3));
  CHECK(p.curves.at(2).x.at(0) == a.back());
}

TEST_CASE("the histogram of steps counts every step once", "[figures]") {
  const Figure f = hoop().figure("steps");
  REQUIRE(f.panels.size() == 2);
  for (const Panel& p : f.panels) {
    double sum = 0;
    const std::vector<double>& counts = p.bands.at(0).upper;  // each bar has two points and a gap
    for (std::size_t k = 0; k < counts.size(); k += 3) sum += counts[k];
    CHECK(sum == static_cast<double>(hoop().diagnostics.t.size() - 1));
  }
}

TEST_CASE("an impact is a state of its own and no step", "[figures]") {
  const Scene scene = read_scene_file(find_scene("cable_ring"));  // latches at 8.9 s
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics d = diagnose(run);
  const std::vector<double>& sizes = d.at("step_s").values;
  const auto steps = std::ranges::count_if(sizes, [](double h) { return h > 0; });
  REQUIRE(steps < std::ssize(sizes) - 1);
  const Figure f = find_figure("steps")->make(run, d);
  double sum = 0;
  for (std::size_t k = 0; k < f.panels[0].bands.at(0).upper.size(); k += 3)
    sum += f.panels[0].bands[0].upper[k];
  CHECK(sum == static_cast<double>(steps));
  CHECK(f.caption.starts_with(std::to_string(steps) + " steps from"));
}

TEST_CASE("captions have the numbers of the run", "[figures]") {
  CHECK(hoop().figure("jacobian").caption.find("zero to round-off") != std::string::npos);
  CHECK(hoop().figure("phase").caption.find("From 60\u00B0") != std::string::npos);
  CHECK(hoop().figure("steps").caption.find(std::to_string(hoop().diagnostics.t.size() - 1) + " steps") == 0);
}

TEST_CASE("a run that ended at once still has its figures", "[figures]") {
  const Run r = run(testing::double_pendulum(), 0.02, 0.02);
  Run first = {r.simulation, {}};
  while (first.simulation.trajectory.size() > 1) first.simulation.trajectory.pop_back();
  first.simulation.status = RunStatus::failed;
  first.simulation.message = "at t = 0 s: the state is not finite any more";
  first.diagnostics = diagnose(first.simulation);
  for (const FigureKind& kind : figure_kinds())
    if (kind.applies(first.simulation, first.diagnostics))
      CHECK(plot::faults(first.figure(kind.name)).empty());
  CHECK(first.figure("energy").caption.find("failed at t = 0 s") != std::string::npos);
}

TEST_CASE("what a scene has no data for does not apply", "[figures]") {
  const FigureKind* deployment = find_figure("deployment");
  CHECK(deployment->applies(hoop().simulation, hoop().diagnostics));
  CHECK_FALSE(deployment->applies(pendulum().simulation, pendulum().diagnostics));
}

TEST_CASE("the deployment figure shows degrees from the first to the last and marks the event", "[figures]") {
  const Figure f = hoop().figure("deployment");
  const Panel& p = f.panels.at(0);
  CHECK(p.curves.at(0).y.front() == Approx(60).epsilon(1e-12));
  CHECK(std::abs(p.curves.at(0).y.back()) < 1e-6);  // located to about 1e-8 rad
  CHECK(p.curves.at(1).right_axis);
  CHECK(p.curves.at(1).y.back() == Approx(1).epsilon(1e-9));
  REQUIRE(p.lines.size() == 1);
  CHECK(p.lines[0].label == "deployed");
  CHECK(p.lines[0].value == hoop().simulation.events.at(0).t);
}

TEST_CASE("errors are drawn on log axes with the round-off of a double", "[figures]") {
  const Panel p = hoop().figure("constraint_error").panels.at(0);
  CHECK(p.y.log);
  CHECK(p.y.zeros_at_floor);
  CHECK(std::any_of(p.lines.begin(), p.lines.end(),
                    [](const ReferenceLine& l) { return l.horizontal && l.value == std::ldexp(1.0, -52); }));
}

TEST_CASE("exact zeros on a log axis are owned up to in the caption", "[figures]") {
  Run r = {hoop().simulation, hoop().diagnostics};
  for (Series& s : r.diagnostics.columns)
    if (s.name == "constraint_velocity_max_m_s")
      std::replace(s.values.begin(), s.values.end(), 0.0, 1e-16);
    else if (s.name == "constraint_relative_max")
      std::fill(s.values.begin(), s.values.begin() + 3, 0.0),
          std::replace(s.values.begin() + 3, s.values.end(), 0.0, 1e-16);
  CHECK(r.figure("constraint_error").caption.find("The 3 exact zeros are drawn at the bottom edge.") !=
        std::string::npos);
}

namespace {

Run run_of(const std::string& text) {
  Simulation s = testing::run_scene(text);
  Diagnostics d = diagnose(s);
  return {std::move(s), std::move(d)};
}

const std::string swinging =
    "[structure]\nkind = 'custom'\n"
    "[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
    "[[structure.nodes]]\nname = 'A'\nposition = [0.9, 0, 0]\nmass = 1.4\n"
    "[[structure.rods]]\nname = 'OA'\nnodes = ['O', 'A']\nmass = 0.6\n"
    "[[structure.constraints]]\nkind = 'plane'\nnodes = ['A']\nnormal = [0, 1, 0]\n"
    "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstages = 4\nstep = 0.01\nend_time = 0.8\n"
    "[[loads]]\nnodes = ['A']\nforce = [0.7, 0, 0.4]\n";

// The largest magnitude of the sum that a caption writes out, "Below: magnitude of A + B - C - the energy at
// the start ..., at most ...", with each term from the column of that label.
double written_balance(const std::string& caption, const Diagnostics& d) {
  const std::string begin = "magnitude of ", end = " \u2212 the energy at the start";
  const auto from = caption.find(begin) + begin.size(), to = caption.find(end);
  REQUIRE(to != std::string::npos);
  std::string terms = " + " + caption.substr(from, to - from) + " + ";
  double largest = 0;
  for (std::size_t i = 0; i < d.t.size(); ++i) {
    double sum = -d.at("kinetic_energy_J").values[0] - d.at("potential_energy_J").values[0];
    int used = 0;
    for (const Series& s : d.columns)
      for (const auto& [sign, factor] : {std::pair{" + ", 1.0}, std::pair{" \u2212 ", -1.0}})
        if (terms.find(sign + s.label + " ") != std::string::npos && s.unit == "J")
          sum += factor * s.values[i], ++used;
    REQUIRE(used >= 2);
    largest = std::max(largest, std::abs(sum));
  }
  return largest;
}

}  // namespace

TEST_CASE("the balance that the energy figure's caption writes is the one that it gives", "[figures]") {
  const std::map<std::string, std::string> scenes{
      {"free", ""},
      {"damped", "[[forces]]\nkind = 'drag'\nnodes = ['A']\ndamping = 0.8\n"},
      {"impact",
       "[[constraints]]\nkind = 'coordinate_stop'\nname = 'floor'\nnodes = ['A']\ndirection = [0, 0, 1]\n"
       "min = -0.6\nrestitution = 0.4\n"},
      {"driven",
       "[[constraints]]\nkind = 'coordinate'\nname = 'lift'\nnodes = ['A']\ndirection = [0, 0, 1]\n"
       "motion = 'smooth'\nto = 0.5\nduration = 0.7\n"}};
  const std::map<std::string, std::string> own{{"damped", "energy taken by dampers and friction"},
                                               {"impact", "energy lost in impacts"},
                                               {"driven", "work of the drives"}};
  for (const auto& [name, more] : scenes) {
    INFO(name);
    const Run r = run_of(swinging + more);
    REQUIRE(r.simulation.status == RunStatus::completed);
    const Figure f = r.figure("energy");
    INFO(f.caption);
    const double given = testing::largest(r.diagnostics, "energy_balance_J");
    const double turned = testing::largest(r.diagnostics, "kinetic_energy_J");
    // Six terms are added in another order: some ulp of the energies.
    CHECK(written_balance(f.caption, r.diagnostics) == Approx(given).margin(1e-14 * turned));
    CHECK(given < 1e-3 * turned);
    if (own.count(name) == 0) continue;
    const auto& curves = f.panels.at(0).curves;
    CHECK(std::count_if(curves.begin(), curves.end(),
                        [&, &key = name](const Curve& c) { return c.label == own.at(key); }) == 1);
  }
}

TEST_CASE("forces that the rigid model does not determine are dashed, and the caption counts them",
          "[figures]") {
  const Figure f = hoop().figure("rod_forces");
  for (const Curve& c : f.panels.at(0).curves)
    CHECK((c.dash == Dash::dashed || c.dash == Dash::dotted) == (c.label.rfind("post", 0) != 0));
  CHECK(f.caption.find("16 of the 20 rods") != std::string::npos);
  CHECK(f.caption.find("not unique)") != std::string::npos);  // the peak is a chord's
  const Figure s = sector().figure("rod_forces");
  for (const Curve& c : s.panels.at(0).curves) CHECK((c.dash == Dash::solid || c.dash == Dash::dash_dot));
  CHECK(s.caption.find("symmetry of the sector") != std::string::npos);
}

TEST_CASE("states of self-stress are drawn one by one, and are not offered where there is none",
          "[figures]") {
  const FigureKind* kind = find_figure("self_stress");
  REQUIRE(kind);
  CHECK_FALSE(kind->applies(pendulum().simulation, pendulum().diagnostics));
  CHECK_FALSE(kind->applies(sector().simulation, sector().diagnostics));
  REQUIRE(kind->applies(hoop().simulation, hoop().diagnostics));
  const Figure f = hoop().figure("self_stress");
  REQUIRE(f.panels.size() >= 5);  // n + 1 states of a ring of n units
  for (std::size_t k = 0; k < 5; ++k) {
    REQUIRE(f.panels[k].segments.size() == 20);
    const auto members = std::count_if(f.panels[k].segments.begin(), f.panels[k].segments.end(),
                                       [](const Segment& s) { return s.color < 2; });
    CHECK(members >= 2);
    CHECK(members <= 16);  // posts belong to no state
    // What pulls at held nodes is drawn over the rods, and no further: depth is shown by colour.
    double nearest = -1e300, farthest = 1e300;
    for (const Segment& s : f.panels[k].segments)
      if (s.color < 2) nearest = std::max(nearest, s.depth), farthest = std::min(farthest, s.depth);
    for (const Dot& dot : f.panels[k].dots) {
      CHECK(dot.depth >= nearest);
      CHECK(dot.depth - nearest <= 20);  // of a ring of 12 m
    }
    CHECK(nearest - farthest < 20);
  }
  CHECK(f.caption.find("5 states") != std::string::npos);
  // The table has what colours and widths show: of each rod its force, which balances at free nodes.
  const std::string table = figure_csv(f);
  for (const Segment& s : f.panels[0].segments) {
    CHECK((s.value > 0) == (s.color == 1));
    CHECK((s.value < 0) == (s.color == 0));
    if (s.value == 0) continue;
    char text[40];
    *std::to_chars(text, text + sizeof text, s.value).ptr = 0;
    CHECK(table.find(",rod," + std::string(text) + ",") != std::string::npos);
  }
}

TEST_CASE("what rods bear is drawn where they have a modulus, then forces are unique", "[figures]") {
  const FigureKind* kind = find_figure("rod_strength");
  REQUIRE(kind);
  CHECK_FALSE(kind->applies(hoop().simulation, hoop().diagnostics));
  const Run elastic =
      run(testing::family_structure(
              "hoop", {{"units", 4L}, {"fold_angle", 60.0}, {"youngs_modulus", 7e10}, {"strength", 1e8}}),
          0.02, 9.0);
  REQUIRE(kind->applies(elastic.simulation, elastic.diagnostics));
  const Figure f = elastic.figure("rod_strength");
  REQUIRE(f.panels.size() == 2);
  for (const Panel& p : f.panels) CHECK_FALSE(p.curves.empty());
  for (const char* words : {"Largest stress", "Largest share of the strength", "Euler's load"})
    CHECK(f.caption.find(words) != std::string::npos);
  const Figure forces = elastic.figure("rod_forces");
  CHECK(forces.caption.find("share by their stiffness") != std::string::npos);
  CHECK(forces.caption.find("not unique") == std::string::npos);
}

TEST_CASE("energies that are zero throughout are left out", "[figures]") {
  const auto labels = [](const Figure& f) {
    std::vector<std::string> out;
    for (const Curve& c : f.panels.at(0).curves) out.push_back(c.label);
    return out;
  };
  CHECK(labels(hoop().figure("energy")) == std::vector<std::string>{"kinetic energy", "work of the loads"});
  CHECK(labels(pendulum().figure("energy")) ==
        std::vector<std::string>{"kinetic energy", "potential energy"});
}

TEST_CASE("an energy that hardly changes is shown as the level it is", "[figures]") {
  Run r = {pendulum().simulation, pendulum().diagnostics};
  for (Series& s : r.diagnostics.columns)
    for (std::size_t i = 0; i < s.values.size(); ++i) {
      if (s.name == "kinetic_energy_J") s.values[i] = 22 + (i % 2 ? 1e-9 : 0);
      if (s.name == "potential_energy_J" || s.name == "work_J") s.values[i] = 0;
    }
  const Panel p = r.figure("energy").panels.at(0);
  CHECK(p.y.min == 0);
  CHECK(p.y.max > 22);
}

TEST_CASE("rod forces are drawn by group, and a sector stands for the whole", "[figures]") {
  for (const Run* r : {&hoop(), &sector()}) {
    const Figure f = r->figure("rod_forces");
    std::set<std::string> labels;
    for (const Curve& c : f.panels.at(0).curves) labels.insert(c.label.substr(0, c.label.find(',')));
    for (const Band& b : f.panels.at(0).bands) labels.insert(b.label.substr(0, b.label.find(',')));
    CHECK(labels.count("chord (16 rods)") == 1);
    CHECK(labels.count("post (4 rods)") == 1);
  }
  const Figure single = pendulum().figure("rod_forces");
  CHECK(single.panels.at(0).curves.size() == 2);
  CHECK(single.panels.at(0).curves.at(0).label == "OA");
}

TEST_CASE("poses show every rod six times to one scale, the sector's whole ring included", "[figures]") {
  const Figure full = hoop().figure("poses"), part = sector().figure("poses");
  REQUIRE(full.panels.size() == 6);
  for (std::size_t k = 0; k < 6; ++k) {
    const Panel &a = full.panels[k], &b = part.panels[k];
    REQUIRE(a.segments.size() == 20);
    REQUIRE(b.segments.size() == 20);
    CHECK(a.dots.size() == 16);
    CHECK(a.equal_scale);
    CHECK(a.x.max - a.x.min == Approx(full.panels[0].x.max - full.panels[0].x.min));
    for (std::size_t i = 0; i < 20; ++i) {
      // A projection shortens rods; it never lengthens them.
      const Segment& s = a.segments[i];
      CHECK(std::hypot(s.x1 - s.x0, s.y1 - s.y0) <= 3.0 * (1 + 1e-9));
      // Full and sector model agree to about 1e-9 m in time and place; rods come in the same order.
      CHECK(s.x0 == Approx(b.segments[i].x0).margin(1e-5));
      CHECK(s.y1 == Approx(b.segments[i].y1).margin(1e-5));
    }
  }
  CHECK(full.panels.front().title == "0.00 s, 0 %");
  CHECK(full.panels.back().title.find("100 %") != std::string::npos);
}

TEST_CASE("a plane mechanism is seen along its normal", "[figures]") {
  CustomSpec spec;
  spec.nodes = {{"O", {0, 2, 0}, {0, 0, 0}, 0.0, true}, {"A", {0.6, 2, -0.8}, {0, 0, 0}, 0.0, false}};
  spec.rods = {{"OA", {"O", "A"}, 2.0}};
  Structure structure = build_custom(spec);
  structure.gravity = {0, 0, -9.81};
  const Run r = run(structure, 0.02, 1.0);
  const Figure poses = r.figure("poses");
  REQUIRE(poses.panels.size() == 6);
  for (const Panel& p : poses.panels) {
    const Segment& s = p.segments.at(0);
    CHECK(std::hypot(s.x1 - s.x0, s.y1 - s.y0) ==
          Approx(1).epsilon(1e-6));  // true length; cubic between the steps
  }
}

TEST_CASE("Poisson's ratio has a figure where a structure names its strains", "[figures]") {
  const FigureKind* kind = find_figure("poisson");
  REQUIRE(kind);
  CHECK_FALSE(kind->applies(hoop().simulation, hoop().diagnostics));
  REQUIRE(kind->applies(sheet().simulation, sheet().diagnostics));
  const Figure f = sheet().figure("poisson");
  REQUIRE(f.panels.size() == 2);
  CHECK(f.panels[0].curves.size() == 2);
  CHECK(f.panels[1].curves.at(0).y == sheet().diagnostics.at("poisson_ratio").values);
  // Flat, there is no strain along.
  const Scene flat = read_scene_file(find_scene("reentrant_sheet"), {"structure.deployed_angle=0"});
  const Run opened = run(build_structure(flat), flat.solver.step, flat.solver.end_time);
  REQUIRE_FALSE(std::isfinite(opened.diagnostics.at("poisson_ratio").values.back()));
  CHECK_THAT(opened.figure("poisson").caption,
             Catch::Contains("the last that is known") && !Catch::Contains("not a number"));
}

}  // namespace unfurl
