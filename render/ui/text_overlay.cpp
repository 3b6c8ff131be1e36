#include "render/ui/text_overlay.hpp"

#include <cmath>

#include "render/ui/sheet.hpp"

namespace unfurl {

struct TextOverlay::Fonts {
  Sheet sheet;
};

TextOverlay::TextOverlay() : fonts_(std::make_unique<Fonts>()) {}
TextOverlay::~TextOverlay() = default;

void TextOverlay::draw(const std::vector<TextLabel>& labels, int width, int height) {
  if (labels.empty()) return;
  Sheet& sheet = fonts_->sheet;
  for (const TextLabel& label : labels) sheet.font(label.height, label.bold);
  ImDrawList& list = sheet.begin(width, height);
  for (const TextLabel& label : labels) {
    ImFont* font = sheet.font(label.height, label.bold);
    const char* first = label.text.c_str();
    const float length = font->CalcTextSizeA(label.height, FLT_MAX, 0.0f, first).x;
    const ImVec2 at(std::round(label.x - label.align * length), std::round(label.y));
    const Color& c = label.color;
    list.AddText(font, label.height, at, ImGui::ColorConvertFloat4ToU32(ImVec4(c.r, c.g, c.b, c.a)), first);
  }
  sheet.end();
}

}  // namespace unfurl
