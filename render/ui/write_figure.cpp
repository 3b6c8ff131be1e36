// SPDX-License-Identifier: BSD-3-Clause
#include "render/ui/write_figure.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/export/atomic_file.hpp"
#include "render/gl/framebuffer.hpp"
#include "render/image/png.hpp"
#include "render/plot/painter.hpp"
#include "render/plot/pdf_canvas.hpp"
#include "render/plot/scaled_canvas.hpp"
#include "render/plot/style.hpp"
#include "render/plot/svg_canvas.hpp"
#include "render/plot/written_text.hpp"
#include "render/ui/font_file.hpp"
#include "render/ui/imgui_canvas.hpp"
#include "render/ui/sheet.hpp"

namespace unfurl {

struct FigureWriter::Painter {
  explicit Painter(GlContext* given)
      : own(given ? nullptr : make_offscreen_context()), context(given ? given : own.get()) {
    context->make_current();
    sheet = std::make_unique<Sheet>();
  }
  ~Painter() { sheet.reset(); }  // before its context

  std::unique_ptr<GlContext> own;
  GlContext* context;
  std::unique_ptr<Sheet> sheet;
};

void require_installed(const plot::Typeface& face) {
  if (!font_bytes(face.file).empty()) return;
  throw FileError(face.file, "the font of figures is missing; install " + std::string(face.package) +
                                 " or name a folder that has it in UNFURL_FONTS");
}

FigureWriter::FigureWriter(FigureOptions options) : options_(options) {
  if (options.face != &plot::typefaces().front())
    for (const plot::Typeface* face : {options.face, &plot::typefaces().front()}) require_installed(*face);
}
FigureWriter::FigureWriter(GlContext& context, FigureOptions options) : FigureWriter(options) {
  given_ = &context;
}
FigureWriter::~FigureWriter() = default;

Image FigureWriter::paint(const Figure& figure) {
  const plot::TypefaceScope scope(*options_.face);
  const plot::FigureLayout layout = plot::lay_out(figure, layout_options(figure, *options_.style));
  if (!painter_) painter_ = std::make_unique<Painter>(given_);
  painter_->context->make_current();
  const double scale = layout.scale * dpi() / 72.0;
  const int width = std::max(1, static_cast<int>(std::lround(layout.width * scale)));
  const int height = std::max(1, static_cast<int>(std::lround(layout.height * scale)));
  const Framebuffer picture(width, height, 0);  // ImGui smooths its own edges
  Sheet& sheet = *painter_->sheet;
  plot::WrittenText written;
  plot::paint(figure, layout, written);
  sheet.need(written.all());
  for (const double size : plot::text_sizes) sheet.plot_font(plot::ImguiCanvas::font_pixels(size, scale));
  picture.bind();
  ImDrawList& list = sheet.begin(width, height);
  {
    plot::ImguiCanvas canvas(
        list, [&](float pixels) { return sheet.plot_font(pixels); }, scale);
    plot::paint(figure, layout, canvas);
  }
  sheet.end();
  Image image = picture.read();
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

double FigureWriter::dpi() const {
  return options_.dpi > 0 ? options_.dpi : options_.style->dpi;
}

void FigureWriter::write(const Figure& figure, const std::filesystem::path& path) {
  const plot::TypefaceScope scope(*options_.face);
  const std::string extension = path.extension().string();
  if (extension == ".svg") return write_file_atomically(path, figure_svg(figure, *options_.style));
  if (extension == ".pdf") return write_file_atomically(path, figure_pdf(figure, *options_.style));
  if (extension == ".png")
    return write_file_atomically(path, with_resolution(encode_png(paint(figure)), dpi()));
  throw std::invalid_argument("a figure is written as .png, .svg or .pdf, not as '" +
                              path.filename().string() + "'");
}

void write_figure(const Figure& figure, const std::filesystem::path& path, FigureOptions options) {
  FigureWriter(options).write(figure, path);
}

void write_figure(const Figure& figure, const std::filesystem::path& path, GlContext& context,
                  FigureOptions options) {
  FigureWriter(context, options).write(figure, path);
}

std::string figure_svg(const Figure& figure, const FigureStyle& style) {
  const plot::FigureLayout layout = plot::lay_out(figure, layout_options(figure, style));
  plot::SvgCanvas canvas(layout.scale * layout.width, layout.scale * layout.height, figure.title,
                         figure.caption);
  plot::ScaledCanvas page(canvas, layout.scale);
  plot::paint(figure, layout, page);
  return canvas.finish();
}

namespace {

plot::TrueType font_of(const plot::Typeface& face) {
  require_installed(face);
  return plot::TrueType(std::string(font_bytes(face.file)));
}

}  // namespace

std::string figure_pdf(const Figure& figure, const FigureStyle& style) {
  const plot::Typeface &face = plot::typeface(), &lender = plot::typefaces().front();
  const plot::TrueType own = font_of(face), lent = font_of(lender);
  const plot::FigureLayout layout = plot::lay_out(figure, layout_options(figure, style));
  plot::PdfCanvas canvas(layout.scale * layout.width, layout.scale * layout.height,
                         {{face, own}, {lender, lent}});
  plot::ScaledCanvas page(canvas, layout.scale);
  plot::paint(figure, layout, page);
  return canvas.finish(figure.title, figure.caption);
}

}  // namespace unfurl
