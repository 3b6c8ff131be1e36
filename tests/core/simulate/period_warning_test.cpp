// SPDX-License-Identifier: BSD-3-Clause
// Steps that do not resolve a swing: which are warned of, and by what numbers.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/simulate/elastic_period.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/study/table.hpp"
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
  // Damping in proportion, c = b k, of that mode: it does not swing from b w = 2 on.
  options.step = 10 * period;
  CHECK_FALSE(said(*of(1.95 / std::sqrt(square)), options).empty());
  CHECK(said(*of(2.05 / std::sqrt(square)), options).empty());
  options.method = "generalized_alpha";  // which lets them die out
  CHECK(said(*springs, options).empty());
}

}  // namespace period_warning_test
