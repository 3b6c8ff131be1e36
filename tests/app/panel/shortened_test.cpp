// SPDX-License-Identifier: BSD-3-Clause
// Words of the window that have too little room.
#include <catch2/catch.hpp>
#include <memory>
#include <string>

#include "app/panel/panes/ui.hpp"

using namespace unfurl;

TEST_CASE("what the window shortens ends behind a whole letter and fits") {
  const std::unique_ptr<ImGuiContext, void (*)(ImGuiContext*)> context(
      ImGui::CreateContext(), [](ImGuiContext* c) { ImGui::DestroyContext(c); });
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = {100, 100};
  io.Fonts->AddFontDefault();
  io.Fonts->Build();
  ImGui::NewFrame();
  const std::string text = "8.06\u00D710\u207B\u00B9\u00B9 m, \u6e2c\U0001F6F0 and more";
  for (float width = 0; width < 1.1f * ImGui::CalcTextSize(text.c_str()).x; width += 1) {
    const std::string out = shortened(text, width);
    CAPTURE(out);
    if (out != text) {
      REQUIRE(out.ends_with("\u2026"));
      const std::string kept = out.substr(0, out.size() - std::string("\u2026").size());
      CHECK(text.starts_with(kept));
      // Of UTF-8: what follows begins a letter.
      CHECK((static_cast<unsigned char>(text[kept.size()]) & 0xC0U) != 0x80U);
    }
    if (!out.starts_with("\u2026")) CHECK(ImGui::CalcTextSize(out.c_str()).x <= width);
  }
  CHECK(shortened(text, 1e4f) == text);
  ImGui::EndFrame();
}
