// SPDX-License-Identifier: BSD-3-Clause
// Hinges that jam, against closed forms and runs with that friction.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/path/margin.hpp"
#include "core/path/path.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/table.hpp"

using namespace unfurl;

namespace stuck_hinges_test {

namespace {

// A four-bar linkage O A B P in the plane.
std::string four_bar(const std::string& a, const std::string& b, const std::string& more) {
  return R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [3, 0, 0], fixed = true},
  {name = "A", )" +
         a + R"(}, {name = "B", )" + b + R"(}]
rods = [{nodes = ["O", "A"], mass = 0.3}, {nodes = ["A", "B"], mass = 0.3}, {nodes = ["B", "P"], mass = 0.3}]
[[constraints]]
kind = "plane"
nodes = ["A", "B"]
normal = [0, 0, 1]
)" + more;
}

const std::string node_a = "position = [0, 1, 0], mass = 1", node_b = "position = [2, 2, 0], mass = 1";

std::vector<StuckHinge> stuck_in(const Scene& scene) {
  const auto model = build_model(scene);
  return stuck_hinges(model, scene.solver, margin_of(model, scene.solver), 0);
}

// Of hinge O-A / A-B in a run.
std::vector<double> angles_at_a(const Simulation& run) {
  std::vector<double> out;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const VectorXd q = run.trajectory.node_positions(i);
    const Vec3 a = q.segment<3>(0) - q.segment<3>(6), b = q.segment<3>(9) - q.segment<3>(6);
    out.push_back(std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  return out;
}

}  // namespace

// A motor of the hinge itself, which gives 0.05 N m times its gear where it does not turn: a jam of that
// torque holds it, and one that is less does not, however fast its speed is used up.
TEST_CASE("a jam holds a motor in its hinge at the motor's stall torque") {
  const Scene scene = read_scene_text(four_bar(node_a, node_b, R"([deployment]
measure = "angle O A B"
deployed = 150
[[forces]]
kind = "motor"
nodes = ["O", "A", "B"]
axis = [0, 0, 1]
stall_torque = 0.05
no_load_speed = 1800
gear_ratio = 100
inertia = 0
[solver]
end_time = 20
)"),
                                      "motor.toml");
  const auto hinges = stuck_in(scene);
  REQUIRE(hinges.size() == 2);
  CHECK(hinges[0].static_torque == Approx(5).epsilon(1e-9));
  // Bisected to 1e-7.
  CHECK(hinges[0].stall_torque == Approx(5).epsilon(3e-7));
  CHECK(hinges[0].stall_at <= 1e-6);
}

TEST_CASE("with dampers a jam stalls the motion where a run with that friction in the hinge stalls") {
  const auto text = [](const std::string& friction) {
    return four_bar(node_a, node_b, R"([[loads]]
nodes = ["A"]
force = [1, 0, 0]
[[forces]]
kind = "drag"
nodes = ["A", "B"]
damping = 5
[deployment]
measure = "angle O A B"
deployed = 130
[solver]
end_time = 60
)" + friction);
  };
  const auto hinges = stuck_in(read_scene_text(text(""), "drag.toml"));
  REQUIRE(hinges.size() == 2);
  // It creeps: what holds it at rest in the worst pose nearly stalls it.
  CHECK(hinges[0].stall_torque == Approx(hinges[0].static_torque).epsilon(1e-3));
  for (const double share : {0.99, 1.01}) {
    const Scene scene = read_scene_text(
        text("[[forces]]\nkind = \"friction\"\nnodes = [\"O\", \"A\", \"B\"]\naxis = [0, 0, 1]\nkinetic = " +
             exact_number(share * hinges[0].stall_torque) + "\n"),
        "friction.toml");
    const Simulation run = simulate(build_model(scene), scene.solver);
    INFO(share);
    CHECK((run.status == RunStatus::deployed) == (share < 1));
  }
}

// No force but a damper's: a rod of I = 1 kg m^2 that turns at 3 rad/s, c = 0.5 N m s, has gone 6 (1 -
// e^-0.5) rad in a second, and with T in its hinge comes to rest at w / c - T / c^2 ln(1 + c w / T).
TEST_CASE("a jam stops what moves by its start alone") {
  const Scene scene = read_scene_text(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "G", position = [0, -1, 0], fixed = true},
  {name = "B", position = [1, 0, 0], velocity = [0, 3, 0]}]
rods = [{nodes = ["A", "G"], mass = 0}, {nodes = ["A", "B"], mass = 3}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 0, 1]
[[forces]]
kind = "joint_damping"
nodes = ["A"]
damping = 0.5
[solver]
stages = 4
step = 0.01
end_time = 1
)",
                                      "own");
  double low = 1e-3, high = 10;
  while (high - low > 1e-12) {
    const double T = 0.5 * (low + high);
    (3 / 0.5 - T / 0.25 * std::log1p(0.5 * 3 / T) > 6 * (1 - std::exp(-0.5)) ? low : high) = T;
  }
  const auto hinges = stuck_in(scene);
  REQUIRE(hinges.size() == 1);
  // It is found to 1e-7, by motions of 1e-9, on a way known to 1e-9.
  CHECK(hinges.front().stall_torque == Approx(low).epsilon(1e-6));
}

TEST_CASE("what holds a hinge at rest is the rest force of a pose, not of a part of the way") {
  const auto hinges = stuck_in(read_scene_text(four_bar(node_a, node_b, R"([[forces]]
kind = "torsion_spring"
nodes = ["O", "A", "B"]
stiffness = 2
free_angle = 140
[deployment]
measure = "angle O A B"
deployed = 139.9
[solver]
end_time = 60
)"),
                                               "spring.toml"));
  REQUIRE(hinges.size() == 2);
  // In the deployed pose, a tenth of a degree before the spring is free: that is found to 1e-14 rad.
  CHECK(hinges[0].static_torque == Approx(2 * 0.1 * radians_per_degree).epsilon(1e-9));
}

// A spring k from O to B that is free at 0.1 m turns the hinge A by k (1 - 0.1 / r) sqrt(5) sin(angle), r =
// OB, which grows from 117 to 95 degrees. Two hinges turn: of two there is one pair, where two may be paired.
TEST_CASE("a hinge is held most easily at the start where what drives it grows and pairs are of few") {
  const Scene scene = read_scene_text(four_bar(node_a, node_b, R"([[forces]]
kind = "spring"
nodes = ["O", "B"]
stiffness = 7
free_length = 0.1
[deployment]
measure = "angle O A B"
deployed = 95
[solver]
end_time = 60
)"),
                                      "drawn.toml");
  const auto model = build_model(scene);
  const Margin margin = margin_of(model, scene.solver);
  for (const std::size_t most : {0U, 1U, 2U, 3U}) {
    const auto hinges = stuck_hinges(model, scene.solver, margin, most);
    REQUIRE(hinges.size() == (most < 2 ? 2U : 3U));
    const auto own = std::ranges::find_if(hinges, [](const StuckHinge& h) {
      return h.name.find(" and ") == std::string::npos && h.name.find("O-A") != std::string::npos;
    });
    REQUIRE(own != hinges.end());
    // There r = sqrt(8), and the sine 2 / sqrt(5).
    CHECK(own->static_torque == Approx(7 * (1 - 0.1 / std::sqrt(8.0)) * 2).epsilon(1e-9));
  }
}

// Whichever way it goes, and where it turns back or passes in line: as in a run, whose sum over states is
// short where the hinge passes in line between two of them, by less than its turn in a step: twice, 0.002
// rad.
TEST_CASE("a hinge turns as far as in a run, without a deployed pose too") {
  const std::string solver = "[solver]\nend_time = ", steps = "\nstep = 0.001\nstages = 4\n";
  const std::string push = "[[loads]]\nnodes = [\"A\"]\nforce = [";
  for (const std::string& text : {four_bar(node_a, node_b, push + "1, 0, 0]\n" + solver + "0.8" + steps),
                                  four_bar(node_a, node_b, push + "-1, 0, 0]\n" + solver + "0.8" + steps),
                                  four_bar("position = [1, 0, 0], velocity = [0, 3, 0], mass = 1",
                                           "position = [3, 2.2, 0]", solver + "2" + steps)}) {
    const Scene scene = read_scene_text(text, "turns.toml");
    const auto hinges = stuck_in(scene);
    REQUIRE(hinges.size() == 2);
    const std::vector<double> angle = angles_at_a(simulate(build_model(scene), scene.solver));
    double turned = 0;
    for (std::size_t i = 1; i < angle.size(); ++i) turned += std::abs(angle[i] - angle[i - 1]);
    CHECK(hinges[0].turn == Approx(turned).epsilon(0).margin(4e-3));
    CHECK(hinges[0].turn >= turned - 1e-9);
  }
}

namespace {

// Slider and crank: A H of 0.5 m from 70 degrees, H B of 0.9 m, B on x under 2 N past a spring beside it of
// k N/m; deployed where B is at 1.38 m. By the crank's angle p, hinge H has turned by p + asin(r sin p / l)
// less than at the start.
struct SliderCrank {
  static constexpr double r = 0.5, l = 0.9, start = 70 * radians_per_degree, force = 2;
  double k = 0;

  static double x(double p) { return r * std::cos(p) + std::sqrt(l * l - std::pow(r * std::sin(p), 2)); }
  static double angle(double p) { return p + std::asin(r * std::sin(p) / l); }
  static double end() {
    double low = 0, high = start;
    for (int it = 0; it < 80; ++it) (x(0.5 * (low + high)) > 1.38 ? low : high) = 0.5 * (low + high);
    return high;
  }
  double spring(double at) const { return std::hypot(at - 1.15, 0.2); }
  double energy(double p) const {  // where it is let go of at rest
    return force * (x(p) - x(start)) - 0.5 * k * std::pow(spring(x(p)) - spring(x(start)), 2);
  }
  // Of the hinge.
  double stalled_at(double p) const { return energy(p) / (angle(start) - angle(p)); }
  double held_at(double p) const {
    const double at = x(p), L = spring(at);
    const double f = force - k * (L - spring(x(start))) * (at - 1.15) / L;
    return f * r * std::sin(p);  // dx by the hinge's angle
  }
  // Among 400 thousand angles: next to a least one a parabola, 1e-11 of it.
  template <class Torque>
  std::pair<double, double> least(const Torque& torque) const {
    std::pair<double, double> out{1e300, 0.0};
    constexpr int many = 400000;
    const double last = end();
    for (int i = 1; i <= many; ++i) {
      const double p = start + (last - start) * i / many;
      out = std::min(out, {torque(p), p});
    }
    return out;
  }

  std::string scene(const std::string& load, const std::string& solver) const {
    std::string text = R"toml([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "S", position = [1.15, 0, 0.2], fixed = true},
  {name = "H", position = ["=0.5*cos(70*deg)", 0, "=0.5*sin(70*deg)"], mass = 0.3},
  {name = "B", position = ["=0.5*cos(70*deg)+sqrt(0.81-(0.5*sin(70*deg))^2)", 0, 0], mass = 1}]
rods = [{name = "crank", nodes = ["A", "H"], mass = 1}, {name = "coupler", nodes = ["H", "B"], mass = 2}]
[[constraints]]
kind = "plane"
nodes = ["H"]
normal = [0, 1, 0]
[[constraints]]
kind = "line"
nodes = ["B"]
direction = [1, 0, 0]
)toml" + load + solver;
    if (k > 0)
      text += "[[forces]]\nkind = \"spring\"\nnodes = [\"S\", \"B\"]\nstiffness = " + exact_number(k) + "\n";
    return text;
  }
};

const std::string push = "[[loads]]\nnodes = [\"B\"]\nforce = [2, 0, 0]\n";
const std::string deployed = "[deployment]\nmeasure = \"length A B\"\ndeployed = 1.38\n";

}  // namespace

TEST_CASE("a jam stalls the motion, and holds it at rest, where it is least between states too") {
  for (const double k : {0.0, 40.0, 60.0, 80.0}) {
    const SliderCrank crank{k};
    const auto hinges =
        stuck_in(read_scene_text(crank.scene(push, deployed + "[solver]\nend_time = 20\n"), "crank.toml"));
    INFO(k);
    REQUIRE(hinges.size() == 1);
    const auto [stall, at] = crank.least([&](double p) { return crank.stalled_at(p); });
    const auto [hold, held_at] = crank.least([&](double p) { return std::max(0.0, crank.held_at(p)); });
    CHECK(hinges[0].stall_torque == Approx(stall).epsilon(1e-9));
    CHECK(hinges[0].static_torque == Approx(hold).epsilon(1e-9));
    CHECK(hinges[0].turn ==
          Approx(SliderCrank::angle(SliderCrank::start) - SliderCrank::angle(SliderCrank::end())));
  }
}

// A spring from A pushes B until it has its free length, just where the way ends: nothing pushes there, and
// any torque holds what comes to rest. What is left of its force there is 1e-16 of 60 N/m times 0.44 m.
TEST_CASE("no torque at all is 0 and not what rounding leaves") {
  const SliderCrank crank;
  const auto hinges = stuck_in(read_scene_text(
      crank.scene(
          "[[forces]]\nkind = \"spring\"\nnodes = [\"A\", \"B\"]\nstiffness = 60\nfree_length = 1.38\n",
          deployed + "[solver]\nend_time = 20\n"),
      "slack.toml"));
  REQUIRE(hinges.size() == 1);
  CHECK(hinges[0].static_torque == 0.0);
  const auto stretch = [](double p) { return 1.38 - SliderCrank::x(p); };
  const double from = stretch(SliderCrank::start);
  const auto stalled_at = [&](double p) {
    return 30 * (from * from - stretch(p) * stretch(p)) /
           (SliderCrank::angle(SliderCrank::start) - SliderCrank::angle(p));
  };
  CHECK(hinges[0].stall_torque == Approx(crank.least(stalled_at).first).epsilon(1e-9));
}

// With the same force all the time as by energy; with one that falls to 1.2 N and rises again as in runs.
TEST_CASE("a jam with loads over time stalls the motion where it rests, not where it is late") {
  const auto text = [&](const SliderCrank& crank, const std::string& values, const std::string& end,
                        const std::string& more) {
    return crank.scene(
        "[[forces]]\nkind = \"load_over_time\"\nnodes = [\"B\"]\nforce = [2, 0, 0]\ntimes = [0, 0.3, "
        "0.6]\nvalues = " +
            values + "\n",
        more + "[solver]\nend_time = " + end + "\n");
  };
  for (const double k : {0.0, 60.0}) {
    const SliderCrank crank{k};
    const auto [stall, at] = crank.least([&](double p) { return crank.stalled_at(p); });
    INFO(k);
    for (const char* end : {"1.5", "2", "3", "60"}) {
      const auto hinges = stuck_in(read_scene_text(text(crank, "[1, 1, 1]", end, deployed), "timed.toml"));
      INFO(end);
      REQUIRE(hinges.size() == 1);
      // Bisected to 1e-7.
      CHECK(hinges[0].stall_torque == Approx(stall).epsilon(3e-7));
    }
  }
  // Without a deployed pose the way is that until the end time, which every jam makes late.
  const SliderCrank crank;
  const auto timed = stuck_in(read_scene_text(text(crank, "[1, 1, 1]", "0.8", ""), "way.toml"));
  const auto at_once = stuck_in(read_scene_text(crank.scene(push, "[solver]\nend_time = 0.8\n"), "way.toml"));
  REQUIRE((timed.size() == 1 && at_once.size() == 1));
  CHECK(timed[0].stall_torque == Approx(at_once[0].stall_torque).epsilon(3e-7));

  const auto hinges = stuck_in(read_scene_text(text(crank, "[1, 0.6, 1]", "1.5", deployed), "dip.toml"));
  REQUIRE(hinges.size() == 1);
  for (const double share : {0.999, 1.001}) {
    const Scene scene = read_scene_text(
        text(crank, "[1, 0.6, 1]", "60",
             deployed + "[[forces]]\nkind = \"friction\"\nnodes = [\"A\", \"H\", \"B\"]\nkinetic = " +
                 exact_number(share * hinges[0].stall_torque) + "\n"),
        "friction.toml");
    INFO(share);
    CHECK((simulate(build_model(scene), scene.solver).status == RunStatus::deployed) == (share < 1));
  }
}

// A parallelogram that friction, or a load the other way, keeps from setting out: both its hinges turn on the
// way on which it does not go, and no jam is needed to stall it. A triangle that slides has none that turn.
TEST_CASE("hinges of a motion that stalls at its start or sets out the other way are told with no torque") {
  const std::string linkage = R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [0, 0, 1]},
  {name = "C", position = [1, 0, 1]}, {name = "D", position = [1, 0, 0], fixed = true}]
rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 1}, {nodes = ["C", "D"], mass = 1}]
constraints = [{kind = "plane", nodes = ["*"], normal = [0, 1, 0]}]
[deployment]
measure = "angle D A B"
deployed = 30
)";
  const std::string slider = R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0]}, {name = "B", position = [1, 0, 0]},
  {name = "C", position = [1, 0, 1]}, {name = "D", position = [9, 0, 0], fixed = true}]
rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 1}, {nodes = ["C", "A"], mass = 1}]
constraints = [{kind = "plane", nodes = ["*"], normal = [0, 1, 0]}, {kind = "plane", nodes = ["A", "B"], normal = [0, 0, 1]}]
[deployment]
measure = "length A D"
deployed = 7
)";
  const auto load = [](const std::string& x) {
    return "[[loads]]\nnodes = [\"C\"]\nforce = [" + x + ", 0, 0]\n";
  };
  const auto timed = [](const std::string& x) {
    return "[[forces]]\nkind = \"load_over_time\"\nnodes = [\"C\"]\nforce = [" + x +
           ", 0, 0]\ntimes = [0, 1]\nvalues = [1, 0.9]\n";
  };
  const auto friction = [](const std::string& nodes) {
    return "[[forces]]\nkind = \"friction\"\nnodes = [" + nodes + "]\nkinetic = 1e9\n";
  };
  for (const std::string& more : {load("2") + friction("\"A\", \"B\", \"C\""), load("-2"),
                                  timed("2") + friction("\"A\", \"B\", \"C\""), timed("-2")}) {
    INFO(more);
    const auto hinges = stuck_in(read_scene_text(linkage + more, "held.toml"));
    REQUIRE(hinges.size() == 2);
    for (const StuckHinge& hinge : hinges)
      CHECK((hinge.stall_torque == 0 && hinge.static_torque == 0 && hinge.stall_at == 0 && hinge.turn == 0));
  }
  for (const std::string& more : {load("2") + friction("\"A\", \"D\""), load("-2")})
    CHECK(stuck_in(read_scene_text(slider + more, "slider.toml")).empty());
}

// One scissor: two rods l on a pin in their middle, pushed up by F on both tips (half of it each), so that by
// the angle p of the rods with the axis the force has gone l (cos p - cos p_0), while the rods turn against
// each other by 2 (p_0 - p). At rest the pin holds F l sin p / 2.
TEST_CASE("the pin in the middle of a scissor jams, like a hinge at the ends of rods") {
  const double start = 84 * radians_per_degree, l = 1.3, force = 37;
  for (const double deployed_angle : {35.0, 61.0}) {
    const double end = deployed_angle * radians_per_degree;
    const std::string shape =
        "[structure]\nkind = \"scissor_mast\"\ncells = 1\nrod_length = 1.3\nfold_angle = 84\n"
        "tip_force = 37\ndeployed_angle = " +
        exact_number(deployed_angle) + "\n[solver]\nend_time = 20\n";
    const auto hinges = stuck_in(read_scene_text(shape, "scissor.toml"));
    INFO(deployed_angle);
    REQUIRE(hinges.size() == 1);
    CHECK(hinges[0].turn == Approx(2 * (start - end)).epsilon(1e-10));
    // (cos p - cos p_0) / (p_0 - p) is the mean of the sine on the way, which falls: least at the end.
    CHECK(hinges[0].stall_torque ==
          Approx(force * l * (std::cos(end) - std::cos(start)) / (2 * (start - end))).epsilon(1e-9));
    CHECK(hinges[0].static_torque == Approx(0.5 * force * l * std::sin(end)).epsilon(1e-9));
  }
  // Of two cells: both pins, and at two ends a rod below and a rod above, which turn alike.
  const auto two = stuck_in(read_scene_text(
      "[structure]\nkind = \"scissor_mast\"\ncells = 2\nfold_angle = 84\n[solver]\nend_time = 20\n",
      "two.toml"));
  REQUIRE(two.size() == 4);
  for (const StuckHinge& hinge : two) CHECK(hinge.stall_torque == Approx(two[0].stall_torque).epsilon(1e-9));
}

// A motor so weak that it does nothing, but whose angle has no axis and turns back in line, at 1.4 m: motions
// that step over the deployed pose see that, and need not.
TEST_CASE("a jam does not ask for what lies behind the deployed pose") {
  const SliderCrank crank;
  const auto hinges = stuck_in(read_scene_text(
      crank.scene(push,
                  deployed +
                      "[[forces]]\nkind = \"motor\"\nnodes = [\"A\", \"H\", \"B\"]\nstall_torque = 1e-12\n"
                      "no_load_speed = 1000\n[solver]\nend_time = 20\n"),
      "motor.toml"));
  REQUIRE(hinges.size() == 1);
  const auto [stall, at] = crank.least([&](double p) { return crank.stalled_at(p); });
  // Bisected to 1e-7.
  CHECK(hinges[0].stall_torque == Approx(stall).epsilon(3e-7));
}

TEST_CASE("a sector model has every hinge of the whole ring, up to symmetry") {
  const auto hinges_in = [](const char* name) {
    const Scene scene = read_scene_file(find_scene(name), {"structure.fold_angle=80"});
    const auto model = build_model(scene);
    return stuck_hinges(model, scene.solver, margin_of(model, scene.solver), 0);
  };
  const auto whole = hinges_in("hoop6"), sector = hinges_in("hoop6_sector");
  REQUIRE_FALSE(sector.empty());
  CHECK(sector.size() < whole.size());
  const auto has = [](const std::vector<StuckHinge>& hinges, const StuckHinge& one) {
    return std::any_of(hinges.begin(), hinges.end(), [&](const StuckHinge& other) {
      // Torques are energies of motions that are resolved to 1e-13, angles next to 90 degrees differences.
      return std::abs(other.stall_torque - one.stall_torque) <= 1e-7 * one.stall_torque &&
             std::abs(other.static_torque - one.static_torque) <= 1e-7 * one.static_torque &&
             std::abs(other.turn - one.turn) <= 1e-7;
    });
  };
  for (const StuckHinge& hinge : whole) {
    INFO(hinge.name);
    CHECK(has(sector, hinge));
  }
  for (const StuckHinge& hinge : sector) {
    INFO(hinge.name);
    CHECK(has(whole, hinge));
    CHECK(std::any_of(whole.begin(), whole.end(), [&](const StuckHinge& h) { return h.name == hinge.name; }));
  }
}

}  // namespace stuck_hinges_test
