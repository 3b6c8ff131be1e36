// SPDX-License-Identifier: BSD-3-Clause
// The table of figures. To add one: a function in figures/ and a row in figures.cpp.
#pragma once

#include <span>
#include <string_view>

#include "core/diagnostics/diagnostics.hpp"
#include "core/simulate/simulation.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

struct FigureKind {
  std::string_view name;  // the file's stem and what `unfurl figure` is asked for
  std::string_view help;
  bool (*applies)(const Simulation&,
                  const Diagnostics&);  // false: the scene has not the data, make must not be called
  Figure (*make)(const Simulation&, const Diagnostics&);
};

std::span<const FigureKind> figure_kinds();
const FigureKind* find_figure(std::string_view name);  // nullptr where there is none

}  // namespace unfurl
