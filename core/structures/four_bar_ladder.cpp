// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/four_bar_ladder.hpp"

#include <string>

namespace unfurl {
namespace {

void add_nodes(Structure& out, int windows, double length, double speed) {
  for (int i = 0; i <= windows; ++i) {
    const std::string number = std::to_string(i);
    const int foot = 2 * i, head = 2 * i + 1;
    out.nodes.push_back({"A" + number, {i * length, 0.0, 0.0}});
    out.nodes.push_back({"B" + number, {i * length, length, 0.0}, {speed, 0.0, 0.0}});
    out.constraints.push_back({"fixed", "fixed of A" + number, {foot}, {}, 0.0});
    out.constraints.push_back({"plane", "plane of B" + number, {head}, {Vec3::UnitZ()}, 0.0, {}, {}, true});
  }
}

void add_rod(Structure& out, int a, int b, double mass, double length, const char* group) {
  const auto& nodes = out.nodes;
  Rod rod;
  rod.name = nodes[static_cast<std::size_t>(a)].name + "-" + nodes[static_cast<std::size_t>(b)].name;
  rod.a = a;
  rod.b = b;
  rod.mass = mass;
  rod.length = length;
  rod.group = group;
  out.rods.push_back(rod);
}

}  // namespace

const std::vector<ParamSpec>& four_bar_ladder_params() {
  static const std::vector<ParamSpec> params{
      integer_param("windows", 2, 1, 100000, "number of four-bar windows side by side"),
      positive_param("rod_length", "m", 1.0, "length of every rod"),
      positive_param("rod_mass", "kg", 1.0, "mass of every rod"),
      real_param("speed", "m/s", 1.0, -1e6, 1e6, "speed of every upper node in +x at t = 0"),
  };
  return params;
}

Structure build_four_bar_ladder(const ParamSet& params) {
  const int windows = static_cast<int>(params.integer("windows"));
  const double length = params.real("rod_length"), mass = params.real("rod_mass");
  Structure out;
  out.kind = "four_bar_ladder";
  add_nodes(out, windows, length, params.real("speed"));
  for (int i = 0; i <= windows; ++i) add_rod(out, 2 * i, 2 * i + 1, mass, length, "upright");
  for (int i = 0; i < windows; ++i) add_rod(out, 2 * i + 1, 2 * i + 3, mass, length, "bar");
  show_as_solved(out);
  return out;
}

}  // namespace unfurl
