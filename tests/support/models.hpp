// SPDX-License-Identifier: BSD-3-Clause
// Models that many tests share.
#pragma once

#include <initializer_list>
#include <memory>
#include <utility>

#include "core/simulate/simulation.hpp"
#include "core/structures/custom.hpp"
#include "core/structures/four_bar_ladder.hpp"
#include "core/structures/hoop.hpp"
#include "tests/support/hoop_exact.hpp"

namespace unfurl::testing {

inline std::shared_ptr<const Model> make_model(const Structure& structure, bool eliminate_linear = true) {
  return std::make_shared<const Model>(Model{structure, System(structure, eliminate_linear)});
}

inline Structure hoop_structure(std::initializer_list<std::pair<const char*, ParamValue>> changes = {}) {
  ParamSet params(hoop_params());
  for (const auto& [name, value] : changes) params.set(name, value);
  return build_hoop(params);
}

inline exact::Hoop exact_hoop(std::initializer_list<std::pair<const char*, ParamValue>> changes = {}) {
  ParamSet p(hoop_params());
  for (const auto& [name, value] : changes) p.set(name, value);
  return {static_cast<int>(p.integer("units")),
          p.real("chord_rod_length"),
          p.real("post_length"),
          p.real("density"),
          p.real("section_area"),
          p.real("fold_angle"),
          p.real("hinge_force")};
}

// Two uniform rods hanging from a fixed point, swinging in space under gravity: no symmetry, no plane of
// motion. At any size [m] it moves alike, gravity being as large.
inline Structure double_pendulum(double size = 1.0) {
  CustomSpec spec;
  spec.nodes = {{"O", {0, 0, 0}, {0, 0, 0}, 0.0, true},
                {"A", size * Vec3(1.0, 0, 0), size * Vec3(0, 1.0, 0.5), 0.0, false},
                {"B", size * Vec3(1.0, 0.8, 0), size * Vec3(-0.8, 1.0, 0.3), 0.5, false}};
  spec.rods = {{"OA", {"O", "A"}, 2.0}, {"AB", {"A", "B"}, 1.0}};
  Structure structure = build_custom(spec);
  structure.gravity = {0, 0, -9.81 * size};
  return structure;
}

inline Structure ladder_structure(int windows, double speed) {
  ParamSet params(four_bar_ladder_params());
  params.set("windows", static_cast<long>(windows));
  params.set("speed", speed);
  Structure structure = build_four_bar_ladder(params);
  structure.gravity = {0, -9.81, 0};
  return structure;
}

inline SolverOptions dvm_options(int stages, double step, double end_time) {
  SolverOptions options;
  options.stages = stages;
  options.step = step;
  options.end_time = end_time;
  return options;
}

}  // namespace unfurl::testing
