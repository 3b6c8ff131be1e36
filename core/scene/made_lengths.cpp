// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/made_lengths.hpp"

#include <algorithm>

#include "core/structures/family.hpp"

namespace unfurl {

StructureError of_made_lengths(const Scene& scene, const StructureError& error) {
  const bool given =
      std::ranges::any_of(scene.custom.rods, [](const CustomRod& rod) { return rod.length > 0; });
  const double size = !find_family(scene.kind)              ? scene.custom.material.length_error
                      : scene.structure.has("length_error") ? scene.structure.real("length_error")
                                                            : 0.0;
  // Other things that cannot be have causes and cures of their own.
  const bool of_lengths =
      error.key.ends_with(".length") && error.message.find("no pose close") != std::string::npos;
  if (given || !(size > 0) || !of_lengths) return error;
  return {"length_error",
          "no pose close to the given one has the lengths that rods are made with, as where rigid rods are "
          "redundant: take rod_model = \"elastic\", whose rods give, or length_error = 0"};
}

}  // namespace unfurl
