// SPDX-License-Identifier: BSD-3-Clause
// Structures of every family that have a path, at random, with springs, dampers, drag, gravity, moduli, and
// friction, a stop or a cable, which may slip, hold or pull from the start: the path and the full model say
// the same of them, row by row and column by column.
#include <catch2/catch.hpp>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <random>

#include "core/diagnostics/diagnostics.hpp"
#include "core/path/path_run.hpp"
#include "core/path/path_scope.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "tests/support/number.hpp"
#include "tests/support/runs_apart.hpp"

using namespace unfurl;
using unfurl::testing::joined;

namespace random_family_test {

namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : seeded_(seed) {}
  // Distributions of the standard library differ from one to another.
  double real(double from, double to) {
    return from + (to - from) * static_cast<double>(seeded_()) / 4294967296.0;
  }
  double size(double from, double to) { return std::exp(real(std::log(from), std::log(to))); }
  int whole(int from, int to) { return from + static_cast<int>(real(0, to - from + 1)); }
  bool often(double share) { return real(0, 1) < share; }

 private:
  std::mt19937 seeded_;
};

std::string text(double x) {
  return std::to_string(x);
}

struct Drawn {
  const char* scene;
  std::vector<std::string> changes;
};

Drawn draw(unsigned seed) {
  Dice dice(seed);
  Drawn out{};
  const auto set = [&](const std::string& key, const std::string& value) {
    out.changes.push_back(key + "=" + value);
  };
  // The least and the largest fold angle [deg].
  double least = 20, most = 85;
  switch (dice.whole(0, 4)) {
    case 0:
      out.scene = "hoop6";
      set("structure.units", std::to_string(dice.whole(3, 7)));
      set("structure.post_length", text(dice.size(0.4, 4)));
      set("structure.hinge_force", text(dice.size(5, 400)));
      break;
    case 1:
      out.scene = "scissor_mast";
      set("structure.cells", std::to_string(dice.whole(1, 5)));
      set("structure.deployed_angle", text(dice.real(3, 18)));
      set("structure.tip_force", text(dice.real(5, 80)));
      least = 30;
      break;
    case 2:
      out.scene = "scissor_ring";
      set("structure.units", std::to_string(dice.whole(3, 7)));
      set("structure.deployed_angle", text(dice.real(1, 18)));
      break;
    case 3:
      out.scene = "hoberman";
      set("structure.units", std::to_string(dice.whole(5, 9)));
      set("structure.deployed_angle", text(dice.real(2, 10)));
      most = 50;
      break;
    default:
      out.scene = "reentrant_sheet";
      set("structure.rows", std::to_string(dice.whole(1, 2)));
      set("structure.columns", std::to_string(dice.whole(1, 3)));
      set("structure.deployed_angle", text(dice.real(2, 15)));
  }
  const double fold = dice.real(least, most);
  set("structure.fold_angle", text(fold));
  if (dice.often(0.4)) set("structure.youngs_modulus", text(dice.size(1e9, 1e11)));
  if (dice.often(0.4)) set("gravity.acceleration", "[0,0," + text(dice.real(-9.8, 9.8)) + "]");
  int forces = 0;
  const auto force = [&](const std::string& kind, std::initializer_list<std::string> rest) {
    set("forces[" + std::to_string(forces++) + "]", "{kind=\"" + kind + "\"," + joined(rest) + "}");
  };
  if (dice.often(0.4))
    force("torsion_spring",
          {"fold_angle=true,stiffness=", text(dice.size(0.5, 50)), ",free_angle=", text(dice.real(-20, 90))});
  if (dice.often(0.3)) force("joint_damping", {"nodes=[\"*\"],damping=", text(dice.size(0.02, 2))});
  if (dice.often(0.3)) force("drag", {"nodes=[\"*\"],damping=", text(dice.size(0.02, 5))});
  switch (dice.whole(0, 5)) {  // one of what has modes
    case 0:
      force("friction", {"fold_angle=true,kinetic=", text(dice.size(0.1, 10))});
      break;
    case 1:
      set("constraints[0]",
          joined({"{kind=\"angle_stop\",name=\"s\",fold_angle=true,min=", text(fold * dice.real(0.3, 0.9)),
                  ",max=", text(fold), ",restitution=", dice.often(0.5) ? "0" : "0.5", "}"}));
      break;
    case 2: {
      const auto model = build_model(read_scene_file(find_scene(out.scene), out.changes));
      const auto& nodes = model->structure.nodes;
      const auto any = [&] {
        return nodes[static_cast<std::size_t>(dice.whole(0, static_cast<int>(nodes.size()) - 1))].name;
      };
      const std::string a = any(), b = any();
      if (a != b)
        force("cable", {"nodes=[\"", a, "\",\"", b, "\"],axial_stiffness=", text(dice.size(50, 5000))});
      break;
    }
    default:;
  }
  set("solver.at_deployed", dice.often(0.6) ? "stop" : dice.often(0.5) ? "pass" : "latch");
  set("solver.end_time", "1");
  set("solver.step", "0.005");
  set("solver.stages", "7");
  return out;
}

// States of both runs at one time, of which each has only one. (Where the full model is short of digits it
// takes shorter steps.)
std::vector<std::pair<std::size_t, std::size_t>> shared_states(const std::vector<double>& a,
                                                               const std::vector<double>& b) {
  const auto alone = [](const std::vector<double>& t, std::size_t i) {
    return (i == 0 || t[i] - t[i - 1] > 1e-9) && (i + 1 == t.size() || t[i + 1] - t[i] > 1e-9);
  };
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t i = 0, k = 0; i < a.size(); ++i) {
    while (k + 1 < b.size() && b[k] < a[i] - 1e-9) ++k;
    if (std::abs(b[k] - a[i]) <= 1e-9 && alone(a, i) && alone(b, k)) out.push_back({i, k});
  }
  return out;
}

}  // namespace

// Seven stages in steps of 5 ms: order 12, where the motion is fast next to a singular pose 1e-9 m. A force
// is compared where both call it unique, which vouches for 1e-4 of the largest multiplier; all of one state
// have that in common.
TEST_CASE("structures at random: the path and the full model say the same in every column") {
  int compared = 0, ended_deployed = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Drawn drawn = draw(seed);
    std::string all;
    for (const std::string& change : drawn.changes) all += " --set " + change;
    INFO(seed << ": " << drawn.scene << all);
    const Scene scene = read_scene_file(find_scene(drawn.scene), drawn.changes);
    const auto model = build_model(scene);
    std::optional<Simulation> path;
    try {
      path = simulate_on_path(model, scene.solver);
    } catch (const PathRefused&) {
      continue;
    }
    const Simulation full = simulate(model, scene.solver);
    REQUIRE(full.status == path->status);
    // 1e-13 of a turn tell the time of the last bounces, at 1e-5 of a turn a second, to 1e-8 s.
    CHECK(testing::runs_apart(*path, full, 1e-8) <= 1e-8);
    const Diagnostics a = diagnose(full), b = diagnose(*path);
    ++compared;
    ended_deployed += full.status == RunStatus::deployed ? 1 : 0;
    const auto states = shared_states(a.t, b.t);
    CHECK(states.size() + 12 + 2 * path->events.size() >= b.t.size());
    double differs = 0;
    for (const auto& [i, k] : states) {
      if (full.trajectory.report(i).singular_event) continue;  // forces are extrapolated to it
      const auto of_a = a.axial_force.row(static_cast<Index>(i)),
                 of_b = b.axial_force.row(static_cast<Index>(k));
      const double largest = of_a.cwiseAbs().maxCoeff();
      for (Index rod = 0; rod < of_a.size(); ++rod)
        if (a.force_unique(static_cast<Index>(i), rod) && b.force_unique(static_cast<Index>(k), rod))
          differs = std::max(differs, std::abs(of_a[rod] - of_b[rod]) / (1 + largest));
    }
    CHECK(differs <= 1e-3);
    for (std::size_t c = 0; c < a.columns.size(); ++c) {
      const Series &x = a.columns[c], &y = b.columns[c];
      if (!x.name.ends_with(".reaction_N")) continue;
      INFO(x.name);
      double largest = 1, apart = 0;
      for (const auto& [i, k] : states) {
        CHECK(std::isnan(x.values[i]) == std::isnan(y.values[k]));
        if (std::isnan(x.values[i]) || a.columns[c + 4].values[i] == 0 || b.columns[c + 4].values[k] == 0)
          continue;
        largest = std::max(largest, std::abs(x.values[i]));
        apart = std::max(apart, std::abs(x.values[i] - y.values[k]));
      }
      CHECK(apart <= 1e-3 * largest);
    }
  }
  CHECK(compared >= 40);
  CHECK(ended_deployed >= 15);
}

}  // namespace random_family_test
