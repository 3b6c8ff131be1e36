#pragma once

#include <string>

#include "render/plot/layout.hpp"

namespace unfurl {

// The figure as an SVG document: text as text, no OpenGL involved.
std::string figure_svg(const Figure& figure, const plot::LayoutOptions& options = {});

}  // namespace unfurl
