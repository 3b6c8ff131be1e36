// SPDX-License-Identifier: BSD-3-Clause
// Steps that do not resolve a swing: which are warned of, and by what numbers.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>

#include "core/diagnostics/accuracy.hpp"
#include "core/math/factors.hpp"
#include "core/simulate/elastic_period.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/study/table.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace period_warning_test {

namespace {

// The number that follows a phrase of a text; NaN: none does.
double number_behind(const std::string& text, const std::string& phrase) {
  const std::size_t at = text.find(phrase);
  return at == std::string::npos ? std::nan("") : std::strtod(text.c_str() + at + phrase.size(), nullptr);
}

// What is said of the swing on the cable, once at most.
std::string told(const Simulation& run) {
  std::string all;
  for (const std::string& w : run.warnings)
    if (w.starts_with("what rope holds swings on it in ")) {
      CHECK(all.empty());
      all = w;
    }
  return all;
}

// 1.7 and 0.6 kg on both ends of a cable over two fixed pulleys, one of which goes where it draws taut.
constexpr double m1 = 1.7, m2 = 0.6, k = 5200;
const std::string over_pulleys = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0.4, 0, 0], velocity = [-0.3, 0, 0], mass = 1.7},
         {name = "P", position = [1, 0, 0], fixed = true},
         {name = "Q", position = [1, 2, 0], fixed = true},
         {name = "B", position = [1, 2, 0.5], mass = 0.6}]
[[forces]]
kind = "cable"
name = "rope"
nodes = ["A", "P", "Q", "B"]
axial_stiffness = 16146
length = 3.105
[solver]
stages = 3
end_time = 0.1
)";

}  // namespace

// By w^2 = k (1/m_1 + 1/m_2); a quarter of a period is followed by three stages, with s by (s - 1)/2 times as
// much, whatever the method without stages.
TEST_CASE("steps that are too long for what swings on a cable are told, with the period and what would do") {
  const double period = 2 * pi / std::sqrt(k * (1 / m1 + 1 / m2));
  const auto run = [&](double step, const char* method, int stages) {
    return run_scene(over_pulleys,
                     {"solver.step=" + exact_number(step), "solver.stages=" + std::to_string(stages),
                      "solver.method=\"" + std::string(method) + "\""});
  };
  struct Case {
    const char* method;
    int stages;
    double quarters;
  };
  for (const Case& c : {Case{"dvm", 2, 1}, {"dvm", 3, 1}, {"dvm", 4, 1.5}, {"dvm", 6, 2.5}, {"rk4", 6, 1}}) {
    INFO(c.method << " " << c.stages);
    const double followed = 0.25 * period * c.quarters;
    CHECK(told(run(0.97 * followed, c.method, c.stages)).empty());
    const std::string text = told(run(1.03 * followed, c.method, c.stages));
    // Numbers have three digits.
    CHECK(number_behind(text, "swings on it in ") == Approx(period).epsilon(6e-3));
    CHECK(number_behind(text, "which the step of ") == Approx(1.03 * followed).epsilon(6e-3));
    CHECK(number_behind(text, "solver.step = ") == Approx(followed).epsilon(6e-3));
  }
}

// That the step does not resolve the motion towards the cable is what follows from it; taut at the start it
// is what swings fastest then.
TEST_CASE("one swing on a cable is told once") {
  const std::string scene = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0]},
         {name = "P", position = [0, 1, 0], fixed = true}]
rods = [{nodes = ["A", "B"], mass = 0.1}]
[[forces]]
kind = "cable"
name = "rope"
nodes = ["P", "B"]
axial_stiffness = 1e6
[gravity]
acceleration = [0, -9.81, 0]
[solver]
step = 0.01
end_time = 0.5
)";
  for (const auto& [length, about] :
       {std::pair{"1.41", "the fastest swing on springs, "}, {"1.5", "what rope holds swings on it in "}}) {
    const Simulation run = run_scene(scene, {"forces[rope].length=" + std::string(length)});
    REQUIRE(run.status == RunStatus::completed);
    int told_of_it = 0;
    for (const std::string& w : warnings_of(run, diagnose(run)))
      if (w.find("does not resolve") != w.npos) {
        CHECK(w.find(about) != w.npos);
        ++told_of_it;
      }
    CHECK(told_of_it == 1);
  }
}

// Damped by c it swings where c/2 < sqrt(k / by), by = 1/m_1 + 1/m_2.
TEST_CASE("what does not swing on a cable for its damping is not warned of") {
  const double by = 1 / m1 + 1 / m2, critical = 2 * std::sqrt(k / by);
  const std::string step = "solver.step=" + exact_number(0.5 * 2 * pi / std::sqrt(k * by));
  const auto damped = [&](double share) {
    return told(run_scene(over_pulleys, {step, "forces[rope].damping=" + exact_number(share * critical)}));
  };
  CHECK_FALSE(damped(0.97).empty());
  CHECK(damped(1.03).empty());
}

// Two masses in line on two elastic rods from a support: (k_1 + k_2 - m_1 w^2)(k_2 - m_2 w^2) = k_2^2. Rods
// without mass; w^2 is found to a thousandth from below.
TEST_CASE("the fastest elastic period is that of the stiffest mode, and the step that follows it a quarter") {
  const double E = 3e6, A1 = 1e-4, A2 = 2.5e-4, l1 = 0.5, l2 = 0.8, ma = 0.7, mb = 1.9;
  const auto model = model_of(R"(
[structure]
kind = "custom"
rod_model = "elastic"
youngs_modulus = 3e6
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [0.5, 0, 0], mass = 0.7},
         {name = "B", position = [1.3, 0, 0], mass = 1.9}]
rods = [{nodes = ["O", "A"], mass = 0, area = 1e-4}, {nodes = ["A", "B"], mass = 0, area = 2.5e-4}]
)");
  const double k1 = E * A1 / l1, k2 = E * A2 / l2;
  const double a = ma * mb, b = ma * k2 + mb * (k1 + k2), c = k1 * k2;
  const double period = 2 * pi / std::sqrt((b + std::sqrt(b * b - 4 * a * c)) / (2 * a));
  const State start = initial_state(model->structure, model->system).state;
  CHECK(fastest_elastic_period(*model, start) == Approx(period).epsilon(1e-3));
  CHECK(fastest_elastic_period(*model, start) >= period * (1 - 1e-9));
  SolverOptions options;
  options.stages = 3;
  for (const auto& [share, warned] : {std::pair{0.24, false}, {0.26, true}, {0.98, true}, {1.02, true}}) {
    INFO(share);
    options.step = share * period;
    const std::string text = elastic_step_warning(*model, start, options);
    CHECK(text.empty() != warned);
    if (!warned) continue;
    CHECK(number_behind(text, "the step of ") == Approx(options.step).epsilon(6e-3));
    CHECK(number_behind(text, "elastic period, ") == Approx(period).epsilon(6e-3));
    CHECK(number_behind(text, "solver.step = ") == Approx(0.25 * period).epsilon(6e-3));
    CHECK((text.find("solver.stages = 4") != std::string::npos) == (share > 1));
  }
  options.method = "generalized_alpha";  // which lets them die out
  CHECK(elastic_step_warning(*model, start, options).empty());
}

// 90 masses in a row on 91 springs, more than are ever looked at at once: by dense eigenvalues.
TEST_CASE("the fastest swing of a long row of springs is that of its dense eigenvalues") {
  for (const double spread : {0.0, 0.02, 0.1, 0.2, 0.4, 0.8}) {
    constexpr int count = 90;
    const auto point_mass = [&](int i) { return 1 + spread * std::sin(1.7 * i * i); };
    const auto cord_stiffness = [&](int i) { return 700 * (1 + spread * std::cos(2.1 * i * i + 0.3)); };
    std::string nodes = "{name = 'N0', position = [0, 0, 0], fixed = true}", line, cords;
    for (int i = 1; i <= count + 1; ++i) {
      const std::string name = "N" + std::to_string(i);
      nodes += ", {name = '" + name + "', position = [" + std::to_string(i) + ", 0, 0], " +
               (i > count ? "fixed = true}" : "mass = " + number(point_mass(i)) + "}");
      if (i <= count) line += (i > 1 ? ", '" : "'") + name + "'";
      cords += "[[forces]]\nkind = 'spring'\nnodes = ['N" + std::to_string(i - 1) + "', '" + name +
               "']\nstiffness = " + number(cord_stiffness(i)) + "\n";
    }
    const auto model = model_of("[structure]\nkind = 'custom'\nnodes = [" + nodes +
                                "]\n[[constraints]]\nkind = 'line'\nnodes = [" + line +
                                "]\ndirection = [1, 0, 0]\n" + cords);
    MatrixXd A = MatrixXd::Zero(count, count);  // M^-1/2 K M^-1/2
    for (int i = 1; i <= count; ++i) {
      A(i - 1, i - 1) = (cord_stiffness(i) + cord_stiffness(i + 1)) / point_mass(i);
      if (i < count)
        A(i - 1, i) = A(i, i - 1) = -cord_stiffness(i + 1) / std::sqrt(point_mass(i) * point_mass(i + 1));
    }
    const double square = symmetric_eigenvalues(A).maxCoeff();
    const State start = initial_state(model->structure, model->system).state;
    INFO(spread);
    // A thousandth of w^2 is left.
    CHECK(fastest_elastic_period(*model, start) == Approx(2 * pi / std::sqrt(square)).epsilon(1e-3));
  }
}

// A clamped strip in segments of equal length l: of a free end with mass m across, k = E I / l^3 by one bend.
TEST_CASE("bending has a period too, and rigid rods have none") {
  const std::string strip = R"(
[structure]
kind = "custom"
nodes = [{name = "W", position = [-0.5, 0, 0], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [0.5, 0, 0], mass = 0.4}]
rods = [{nodes = ["W", "O"], mass = 0}, {nodes = ["O", "A"], mass = 0}]
)";
  const auto rigid = model_of(strip),
             bends =
                 model_of(strip + "[[forces]]\nkind = 'bending'\nnodes = ['W', 'O', 'A']\nstiffness = 7\n");
  const State start = initial_state(rigid->structure, rigid->system).state;
  CHECK(std::isinf(fastest_elastic_period(*rigid, start)));
  // A moment of 7 N m^2 / 0.5 m per rad at an arm of 0.5 m.
  const double stiffness = 7 / 0.5 / (0.5 * 0.5);
  CHECK(fastest_elastic_period(*bends, initial_state(bends->structure, bends->system).state) ==
        Approx(2 * pi * std::sqrt(0.4 / stiffness)).epsilon(1e-3));
}

// Two masses in line on two springs from a support: (k_1 + k_2 - m_1 w^2)(k_2 - m_2 w^2) = k_2^2.
TEST_CASE("springs that a step does not follow are told with the period of the fastest") {
  const double k1 = 3100, k2 = 1900, ma = 0.7, mb = 1.9;
  const double a = ma * mb, b = ma * k2 + mb * (k1 + k2);
  const double square = (b + std::sqrt(b * b - 4 * a * k1 * k2)) / (2 * a),
               period = 2 * pi / std::sqrt(square);
  const auto of = [&](double damping) {
    return model_of(R"(
[structure]
kind = "custom"
rods = []
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [0.5, 0, 0], mass = 0.7},
         {name = "B", position = [1.3, 0, 0], mass = 1.9}]
constraints = [{kind = "line", nodes = ["A", "B"], direction = [1, 0, 0]}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 3100
damping = )" + exact_number(k1 * damping) +
                    R"(
[[forces]]
kind = "spring"
nodes = ["A", "B"]
stiffness = 1900
damping = )" + exact_number(k2 * damping) +
                    "\n");
  };
  const auto said = [&](const Model& model, SolverOptions options) {
    return elastic_step_warning(model, initial_state(model.structure, model.system).state, options);
  };
  SolverOptions options;
  const auto springs = of(0);
  for (const int stages : {2, 3, 4, 5}) {
    INFO(stages);
    options.stages = stages;
    options.step = 10 * period;
    const double followed = number_behind(said(*springs, options), "solver.step = ");
    // A swing at such steps, by itself: cos(w t) is 0.05 rad behind in each period by the first term of that,
    // up to twice what there is; with few points a quarter of a period is followed, whatever it is behind.
    const double w = 2 * pi, step = followed / period;
    const Simulation run = run_scene(
        "[structure]\nkind = 'custom'\nrods = []\nnodes = [{name = 'O', position = [0, 0, 0], fixed = "
        "true},\n"
        "  {name = 'P', position = [1, 0, 0], mass = 1}]\n[[forces]]\nkind = 'spring'\nnodes = ['O', 'P']\n"
        "stiffness = " +
            exact_number(w * w) + "\nfree_length = 0.9\n",
        {"solver.stages=" + std::to_string(stages), "solver.step=" + exact_number(step),
         "solver.end_time=" + exact_number(8 * step)});
    const std::size_t end = run.trajectory.size() - 1;
    const double phase =
        std::atan2(-run.trajectory.velocities(end)[3] / w, run.trajectory.positions(end)[3] - 0.9);
    const double behind = std::abs(std::remainder(phase - 8 * step * w, 2 * pi)) / (8 * step);
    INFO(step << " of a period: " << behind << " rad behind in each");
    if (stages > 3) {
      CHECK(behind <= 0.05);
      CHECK(behind >= 0.02);
    } else {
      CHECK(step == Approx(0.25).epsilon(6e-3));
    }
    options.step = 0.99 * followed;
    CHECK(said(*springs, options).empty());
    options.step = 1.01 * followed;
    const std::string text = said(*springs, options);
    // Numbers have three digits.
    CHECK(number_behind(text, "the step of ") == Approx(options.step).epsilon(6e-3));
    CHECK(number_behind(text, "swing on springs, ") == Approx(period).epsilon(6e-3));
    CHECK(number_behind(text, "solver.step = ") == Approx(followed).epsilon(6e-3));
  }
  // Damping in proportion, c = b k, of that mode: it does not swing from b w = 2 on, and the other one is
  // left.
  options.step = 10 * period;
  const auto fastest = [&](double damping) {
    return number_behind(said(*of(damping / std::sqrt(square)), options), "swing on springs, ");
  };
  const double slow = std::sqrt(k1 * k2 / (a * square));  // its w: the product of both squares is that
  CHECK(fastest(1.95) == Approx(period).epsilon(6e-3));
  CHECK(fastest(2.05) == Approx(2 * pi / slow).epsilon(6e-3));
  CHECK(said(*of(2.05 / slow), options).empty());
  options.method = "generalized_alpha";  // which lets them die out
  CHECK(said(*springs, options).empty());
}

// Masses of 1 kg on lines of their own, each on a spring of this stiffness and damping. Undamped ones swing
// with w^2 = k, those with c > 2 sqrt(k) do not.
TEST_CASE("a swing is told whatever else is stiffer and does not swing for its damping") {
  using Springs = std::vector<std::pair<double, double>>;
  const auto told_period = [](const Springs& springs, const std::string& more = "") {
    std::string nodes, forces, lines;
    for (std::size_t i = 0; i < springs.size(); ++i) {
      const std::string n = std::to_string(i), at = ", " + n + ", 0]";
      nodes += "{name = 'O" + n + "', position = [0" + at + ", fixed = true}, {name = 'A" + n +
               "', position = [1.1" + at + ", mass = 1}, ";
      lines += "'A" + n + "', ";
      forces += "[[forces]]\nkind = 'spring'\nnodes = ['O" + n + "', 'A" + n +
                "']\nstiffness = " + exact_number(springs[i].first) +
                "\ndamping = " + exact_number(springs[i].second) + "\n";
    }
    const auto model = model_of("[structure]\nkind = 'custom'\nrods = []\nnodes = [" + nodes +
                                "]\nconstraints = [{kind = 'line', nodes = [" + lines +
                                "], direction = [1, 0, 0]}]\n" + forces + more);
    SolverOptions options;
    options.step = 10;
    return number_behind(
        elastic_step_warning(*model, initial_state(model->structure, model->system).state, options),
        "swing on springs, ");
  };
  const auto period_of = [](double square) { return Approx(2 * pi / std::sqrt(square)).epsilon(6e-3); };
  CHECK(told_period({{1e6, 0}, {4e6, 1e4}}) == period_of(1e6));
  CHECK(told_period({{1e6, 0}, {4e6, 3e3}}) == period_of(4e6));
  CHECK(told_period({{1e6, 0}, {1e6, 1e4}, {100, 0}}) == period_of(1e6));  // alike but for damping
  CHECK(told_period({{1e6, 5e4}, {4e6, 1e4}, {100, 0}}) == period_of(100));
  CHECK(std::isnan(told_period({{1e6, 5e4}, {4e6, 1e4}})));
  // More that do not swing, no two alike, than directions are looked into.
  Springs many{{1e6, 100}};
  for (int i = 0; i < 80; ++i) many.emplace_back(4e6 * (1 + 0.05 * i), 2.2e4);
  CHECK(told_period(many) == period_of(1e6));
}

// A mass of 1.2 kg that a load of 500 N keeps off a wall: w^2 = k / m, of what pulls only as of any spring.
// Half as stiff by k (e + w) / (2 w) in the middle of what is smoothed, e = 0.
TEST_CASE("what pulls only and is taut from the start is told as springs are") {
  const auto told_period = [](const std::string& force, double x) {
    const auto model = model_of(
        "[structure]\nkind = 'custom'\nrods = []\n"
        "nodes = [{name = 'O', position = [0, 0, 0], fixed = true},\n"
        "  {name = 'A', position = [" +
        exact_number(x) +
        ", 0, 0], mass = 1.2}]\n"
        "constraints = [{kind = 'line', nodes = ['A'], direction = [1, 0, 0]}]\n"
        "[[loads]]\nnodes = ['A']\nforce = [500, 0, 0]\n"
        "[[forces]]\nnodes = ['O', 'A']\n" +
        force);
    SolverOptions options;
    options.step = 10;
    return number_behind(
        elastic_step_warning(*model, initial_state(model->structure, model->system).state, options),
        "swing on springs, ");
  };
  const std::string cable = "kind = 'cable'\naxial_stiffness = 8e4\nlength = 2\n",
                    spring = "kind = 'spring'\nstiffness = 4e4\nfree_length = 2\n";
  const auto period = Approx(2 * pi * std::sqrt(1.2 / 4e4)).epsilon(6e-3);
  for (const std::string& force :
       {spring, spring + "tension_only = true\n", cable, cable + "smoothing = 1e-3\n"}) {
    INFO(force);
    CHECK(told_period(force, 2.0125) == period);
  }
  CHECK(std::isnan(told_period(cable, 1.9)));
  CHECK(std::isnan(told_period(spring + "tension_only = true\n", 1.9)));
  CHECK(told_period(cable + "smoothing = 1e-3\n", 2) == Approx(2 * pi * std::sqrt(1.2 / 2e4)).epsilon(6e-3));
}

// Elsewhere in the structure a mass of 1 kg on an elastic rod of E A / l = 1000 N/m, and one on a spring.
TEST_CASE("beside elastic rods a swing on a spring is told as such, if it is one") {
  const auto said = [](double stiffness, double damping, double step) {
    const auto model = model_of(R"(
[structure]
kind = "custom"
rods = [{nodes = ["E", "F"], mass = 0, area = 1e-6, youngs_modulus = 1e9, elastic = true}]
nodes = [{name = "E", position = [0, 8, 0], fixed = true}, {name = "F", position = [1, 8, 0], mass = 1},
         {name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1.1, 0, 0], mass = 1}]
constraints = [{kind = "line", nodes = ["A", "F"], direction = [1, 0, 0]}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = )" + exact_number(stiffness) +
                                "\ndamping = " + exact_number(damping) + "\n");
    SolverOptions options;
    options.stages = 3;
    options.step = step;
    return elastic_step_warning(*model, initial_state(model->structure, model->system).state, options);
  };
  const double rod = 2 * pi / std::sqrt(1000);
  const auto told_rod = [](const std::string& text) { return number_behind(text, "elastic period, "); };
  const auto told_spring = [](const std::string& text) { return number_behind(text, "swing on springs, "); };
  for (const double damping : {0.0, 1e4}) {
    const bool swings = damping == 0;
    INFO(damping);
    const std::string fine = said(4e6, damping, 0.2 * rod), coarse = said(4e6, damping, 0.3 * rod);
    CHECK(fine.empty() != swings);
    CHECK(std::isnan(told_rod(fine)));
    CHECK(told_rod(coarse) == Approx(rod).epsilon(6e-3));
    for (const std::string& text : {fine, coarse}) {
      if (swings)
        CHECK(told_spring(text) == Approx(2 * pi / 2000).epsilon(6e-3));
      else
        CHECK(std::isnan(told_spring(text)));
    }
  }
  // A spring that is slower than the rod.
  CHECK(std::isnan(told_spring(said(100, 0, 0.3 * rod))));
  CHECK(told_spring(said(100, 0, rod)) == Approx(2 * pi / 10).epsilon(6e-3));
}

// A rod of 1 m turns about A, drawn by a spring from P beside A, of the length d = sqrt(2 - 2 sin t) where
// the rod has turned by t towards it: V = k (d - d0)^2 / 2, V'' = k d'^2 + k (d - d0) d''. In the plane, t =
// 0, d' = -1 / sqrt(2) and d'' = -1 / (2 sqrt(2)). About the axis AP nothing changes d.
TEST_CASE(
    "under pretension what rods keep at its distance swings slower than the spring's force alone says") {
  constexpr double stretch = 1e6, mass = 0.3;
  const auto said = [](double length, double damping, bool plane) {
    const auto model =
        model_of(R"([structure]
kind = 'custom'
nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [1, 0, 0]},
  {name = 'P', position = [0, 1, 0], fixed = true}]
rods = [{nodes = ['A', 'B'], mass = )" +
                 exact_number(mass) + "}]\n" +
                 (plane ? "constraints = [{kind = 'plane', nodes = ['B'], normal = [0, 0, 1]}]\n" : "") +
                 "[[forces]]\nkind = 'spring'\nnodes = ['P', 'B']\nstiffness = " + exact_number(stretch) +
                 "\ndamping = " + exact_number(damping) + "\nfree_length = " + exact_number(length) + "\n");
    SolverOptions options;
    options.step = 10;
    return elastic_step_warning(*model, initial_state(model->structure, model->system).state, options);
  };
  for (const double length : {0.9, 1.2, std::sqrt(2.0), 1.6})
    for (const bool plane : {true, false}) {
      const double d = std::sqrt(2.0), stiffness = stretch / 2 - stretch * (d - length) / (2 * d);
      CHECK(number_behind(said(length, 0, plane), "swing on springs, ") ==
            Approx(2 * pi / std::sqrt(stiffness / (mass / 3))).epsilon(6e-3));
    }
  // Overdamped in the plane, free to turn out of it.
  CHECK(said(1.41, 1e4, false).empty());
  CHECK(said(0.9, 1e4, false).empty());
}

}  // namespace period_warning_test
