// SPDX-License-Identifier: BSD-3-Clause
// The figures of a run on disk.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "app/command.hpp"
#include "core/diagnostics/diagnostics.hpp"
#include "render/plot/figures.hpp"
#include "render/ui/write_figure.hpp"

namespace unfurl {

// The figure of that name; throws UsageError with the nearest one.
const FigureKind& figure_named(const std::string& name);

// --style, --font and --dpi; throws UsageError with the nearest name, FileError where the font is missing.
FigureOptions figure_options(const Arguments& arguments);

// Writes these figures, those that the scene has data for, as NAME.png, NAME.svg and NAME.pdf into the
// directory, with NAME.csv and NAME.caption.txt beside; the directory is made where it is missing. Stops at
// Ctrl-C; returns whether all were written. Throws FileError, GraphicsError.
bool write_figures(const std::filesystem::path& directory, const std::vector<const FigureKind*>& kinds,
                   const Simulation& run, const Diagnostics& diagnostics, FigureWriter& writer,
                   const Arguments& arguments);

std::vector<const FigureKind*> all_figures();

}  // namespace unfurl
