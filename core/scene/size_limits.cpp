// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/size_limits.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "core/structure/structure_error.hpp"
#include "core/structures/family.hpp"

namespace unfurl {

namespace {

std::string limit_text(const std::string& what, double count, long most) {
  char text[200];
  std::snprintf(text, sizeof text, "%s %.0f is more than %ld, the most that is built", what.c_str(), count,
                most);
  return text;
}

}  // namespace

bool counts(const ParamSpec& spec) {
  return spec.kind == ParamKind::integer && spec.name != "error_seed";
}

void require_buildable(const Scene& scene) {
  const Family* family = find_family(scene.kind);
  if (!family) {
    const auto nodes = static_cast<long>(scene.custom.nodes.size()),
               rods = static_cast<long>(scene.custom.rods.size());
    if (nodes > most_custom_nodes)
      throw StructureError("nodes",
                           limit_text("their number of", static_cast<double>(nodes), most_custom_nodes));
    if (rods > most_custom_rods)
      throw StructureError("rods",
                           limit_text("their number of", static_cast<double>(rods), most_custom_rods));
    return;
  }
  double units = 1;
  std::string product, largest;
  for (const ParamSpec& spec : family->params()) {
    if (spec.kind != ParamKind::integer || !scene.structure.has(spec.name)) continue;
    const long value = scene.structure.integer(spec.name);
    if (!counts(spec) || value == 1) continue;
    units *= static_cast<double>(value);
    product += (product.empty() ? "" : " x ") + std::string(spec.name);
    if (largest.empty() || value > scene.structure.integer(largest)) largest = spec.name;
  }
  if (units > static_cast<double>(most_units))
    throw StructureError(largest, limit_text(product + " =", units, most_units));
}

// A state is its time and three vectors: coordinates, rates and multipliers, each on the heap.
double bytes_of_states(const Scene& scene, const Model& model) {
  const double steps = scene.solver.end_time / scene.solver.step;
  constexpr double overhead_of_heap = 16;
  const auto numbers =
      static_cast<double>(2 * model.system.solved_coordinates() + model.system.constraints());
  return steps * (sizeof(State) + sizeof(StepReport) + 3 * overhead_of_heap + sizeof(double) * numbers);
}

std::string too_many_states(const Scene& scene, const Model& model, double memory) {
  const bool may_end_earlier = !model.structure.deployment.empty() && scene.solver.at_deployed == "stop";
  if (scene.solver.adaptive || scene.solver.tolerance > 0 || may_end_earlier) return "";
  const double bytes = bytes_of_states(scene, model);
  if (bytes <= memory) return "";
  char text[300];
  std::snprintf(
      text, sizeof text,
      "%.3g steps to solver.end_time are %.3g GB of states, and this machine has %.3g GB of memory; take "
      "a larger step or an earlier end",
      scene.solver.end_time / scene.solver.step, 1e-9 * bytes, 1e-9 * memory);
  return text;
}

double machine_memory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || size <= 0) return std::numeric_limits<double>::infinity();
  return static_cast<double>(pages) * static_cast<double>(size);
}

}  // namespace unfurl
