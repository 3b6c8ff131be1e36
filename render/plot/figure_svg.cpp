#include "render/plot/figure_svg.hpp"

#include "render/plot/painter.hpp"
#include "render/plot/svg_canvas.hpp"

namespace unfurl {

std::string figure_svg(const Figure& figure, const plot::LayoutOptions& options) {
  const plot::FigureLayout layout = plot::lay_out(figure, options);
  plot::SvgCanvas canvas(layout.width, layout.height, figure.title, figure.caption);
  plot::paint(figure, layout, canvas);
  return canvas.finish();
}

}  // namespace unfurl
