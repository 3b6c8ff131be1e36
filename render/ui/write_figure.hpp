// SPDX-License-Identifier: BSD-3-Clause
// Figures to files: PNG through OpenGL, SVG and PDF without.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "render/gl/context.hpp"
#include "render/image/image.hpp"
#include "render/plot/figure_style.hpp"
#include "render/plot/layout.hpp"
#include "render/plot/typeface.hpp"

namespace unfurl {

struct FigureOptions {
  double dpi = 0;  // pixels per inch of a PNG; 0: the style's
  const FigureStyle* style = &figure_styles().front();
  const plot::Typeface* face = &plot::typefaces().front();
};

// Throws FileError, with the package to install, where a typeface that is asked for is not installed. (Where
// the default is missing, PNG and SVG do without.)
void require_installed(const plot::Typeface& face);

// Paints figures; what that needs (a context, a font atlas) is made once, at the first PNG.
class FigureWriter {
 public:
  explicit FigureWriter(FigureOptions options = {});
  // In a context of the caller's, which must outlive the writer.
  explicit FigureWriter(GlContext& context, FigureOptions options = {});
  ~FigureWriter();
  FigureWriter(const FigureWriter&) = delete;
  FigureWriter& operator=(const FigureWriter&) = delete;

  // By extension, .png, .svg or .pdf; throws std::invalid_argument for another one, FileError where it cannot
  // be written, GraphicsError where there is no OpenGL for a PNG. The file appears whole or not at all.
  void write(const Figure& figure, const std::filesystem::path& path);
  Image paint(const Figure& figure);

 private:
  double dpi() const;

  struct Painter;
  FigureOptions options_;
  GlContext* given_ = nullptr;
  std::unique_ptr<Painter> painter_;
};

void write_figure(const Figure& figure, const std::filesystem::path& path, FigureOptions options = {});
void write_figure(const Figure& figure, const std::filesystem::path& path, GlContext& context,
                  FigureOptions options = {});

// The figure as an SVG document: text as text, no OpenGL involved.
std::string figure_svg(const Figure& figure, const FigureStyle& style = figure_styles().front());
// The figure as a PDF document with its font embedded. Throws FileError where the font is not installed.
std::string figure_pdf(const Figure& figure, const FigureStyle& style = figure_styles().front());

}  // namespace unfurl
