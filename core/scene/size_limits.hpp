// SPDX-License-Identifier: BSD-3-Clause
// What no machine can hold is refused before it is tried: every key may be in its range, but not their
// product.
#pragma once

#include "core/scene/scene.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Units of a family (the product of its whole numbers: rows x columns, cells x sides): as many as a ring may
// have, which takes seconds and 2 GB. What is made of lists may be as large as such a ring.
inline constexpr long most_units = 100000, most_custom_nodes = 4 * most_units,
                      most_custom_rods = 5 * most_units;

// Is it a number of things that are built? A seed is not.
bool counts(const ParamSpec& spec);
// Throws StructureError with the key and the number where the structure would be larger.
void require_buildable(const Scene& scene);

// Bytes of memory that the states of a run take when it goes on to its end time.
double bytes_of_states(const Scene& scene, const Model& model);
// What to say of solver.step where they do not fit into `memory` bytes and nothing can end the motion
// earlier; else empty. Adaptive steps are as many as the motion wants, which nobody knows before.
std::string too_many_states(const Scene& scene, const Model& model, double memory);
double machine_memory();  // bytes; infinite where it is not known

}  // namespace unfurl
