// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/text_overlay.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/text/utf8.hpp"
#include "render/plot/painter.hpp"
#include "render/plot/style.hpp"
#include "render/plot/written_text.hpp"
#include "render/ui/fonts.hpp"
#include "render/ui/imgui_canvas.hpp"
#include "render/ui/sheet.hpp"

namespace unfurl {

namespace {

ImU32 packed(const Color& c) {
  return ImGui::ColorConvertFloat4ToU32(ImVec4(c.r, c.g, c.b, c.a));
}

void write(const TextLabel& label, const ImFont& font, ImDrawList& paper) {
  const char* first = label.text.c_str();
  const float length = font.CalcTextSizeA(label.height, FLT_MAX, 0.0f, first).x;
  const ImVec2 at(std::round(label.x - label.align * length), std::round(label.y));
  if (label.backing.a > 0) {
    const float room = 0.25f * label.height;
    paper.AddRectFilled({at.x - room, at.y}, {at.x + length + room, at.y + label.height},
                        packed(label.backing), room);
  }
  paper.AddText(&font, label.height, at, packed(label.color), first);
}

// Dark for light and light for dark, hues as they are: a figure for paper before the night.
ImU32 at_night(ImU32 color) {
  const ImVec4 c = ImGui::ColorConvertU32ToFloat4(color);
  const float high = std::max({c.x, c.y, c.z}), low = std::min({c.x, c.y, c.z}), shift = 1 - high - low;
  const auto moved = [&](float x) { return std::clamp(0.07f + 0.93f * (x + shift), 0.0f, 1.0f); };
  return ImGui::ColorConvertFloat4ToU32({moved(c.x), moved(c.y), moved(c.z), c.w});
}

plot::FigureLayout inset_layout(const Inset& inset) {
  return plot::lay_out(*inset.figure, {.title = false, .caption = false});
}

void draw_inset(const Inset& inset, bool night, Sheet& sheet, ImDrawList& paper) {
  const int first = paper.VtxBuffer.Size;
  paper.AddRectFilled({inset.x, inset.y}, {inset.x + inset.width, inset.y + inset.height},
                      packed({1, 1, 1, 0.85f}), 0.03f * inset.height);
  plot::ImguiCanvas canvas(paper, [&](float pixels) { return sheet.font(pixels); }, inset.pixels_per_point,
                           {static_cast<double>(inset.x), static_cast<double>(inset.y)});
  plot::paint(*inset.figure, inset_layout(inset), canvas);
  if (!night) return;
  for (int i = first; i < paper.VtxBuffer.Size; ++i)
    paper.VtxBuffer[i].col = at_night(paper.VtxBuffer[i].col);
}

}  // namespace

// Where in a texture a letter stands shows in the last bit of its pixels: each list is drawn with a sheet
// that has what it needs and nothing else, so that a frame is the same whatever was drawn before it.
struct TextOverlay::Fonts {
  // Heights of lines, bold or not, and letters that fonts do not have from the start.
  struct Needs {
    std::set<std::pair<float, bool>> sizes;
    std::set<std::string> letters;
    auto operator<=>(const Needs&) const = default;
  };
  std::map<Needs, Sheet> sheets;

  static void add_letters(const std::string& text, Needs& needs) {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t first = at;
      if (!is_common(next_code_point(text, at))) needs.letters.insert(text.substr(first, at - first));
    }
  }

  static Needs needs_of(const DrawList& list) {
    Needs needs;
    for (const TextLabel& label : list.labels) {
      needs.sizes.emplace(label.height, label.bold);
      add_letters(label.text, needs);
    }
    if (!list.inset.figure) return needs;
    plot::WrittenText written;
    plot::paint(*list.inset.figure, inset_layout(list.inset), written);
    add_letters(written.all(), needs);
    for (const double size : plot::text_sizes)
      needs.sizes.emplace(plot::ImguiCanvas::font_pixels(size, list.inset.pixels_per_point), false);
    return needs;
  }

  Sheet& of(const DrawList& list) {
    constexpr std::size_t most = 8;  // of a window that changes its size
    const Needs needs = needs_of(list);
    if (const auto found = sheets.find(needs); found != sheets.end()) return found->second;
    if (sheets.size() >= most) sheets.clear();
    Sheet& sheet = sheets[needs];
    for (const std::string& letter : needs.letters) sheet.need(letter);
    for (const auto& [height, bold] : needs.sizes) sheet.font(height, bold);
    return sheet;
  }
};

TextOverlay::TextOverlay() : fonts_(std::make_unique<Fonts>()) {}
TextOverlay::~TextOverlay() = default;

void TextOverlay::draw(const DrawList& list, int width, int height) {
  const Inset& inset = list.inset;
  if (list.labels.empty() && list.lines.empty() && list.areas.empty() && !inset.figure) return;
  Sheet& sheet = fonts_->of(list);
  ImDrawList& paper = sheet.begin(width, height);
  for (const OverlayArea& area : list.areas)
    paper.AddRectFilled({area.x0, area.y0}, {area.x1, area.y1}, packed(area.color), area.round);
  for (const OverlayLine& line : list.lines)
    paper.AddLine({line.x0, line.y0}, {line.x1, line.y1}, packed(line.color), line.width);
  for (const TextLabel& label : list.labels) write(label, *sheet.font(label.height, label.bold), paper);
  const Color& ground = list.background_top;
  const bool night = !list.transparent && ground.r + ground.g + ground.b < 1.2f;
  if (inset.figure) draw_inset(inset, night, sheet, paper);
  sheet.end();
}

}  // namespace unfurl
