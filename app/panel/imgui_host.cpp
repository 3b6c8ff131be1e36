// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/imgui_host.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <utility>

#include "app/panel/panes/figure_cards.hpp"
#include "render/plot/style.hpp"
#include "render/ui/fonts.hpp"
#include "render/ui/imgui_canvas.hpp"

namespace unfurl {

namespace {

constexpr std::pair<ImGuiKey, Key> known_keys[] = {{ImGuiKey_Tab, Key::tab},
                                                   {ImGuiKey_LeftArrow, Key::left},
                                                   {ImGuiKey_RightArrow, Key::right},
                                                   {ImGuiKey_UpArrow, Key::up},
                                                   {ImGuiKey_DownArrow, Key::down},
                                                   {ImGuiKey_PageUp, Key::page_up},
                                                   {ImGuiKey_PageDown, Key::page_down},
                                                   {ImGuiKey_Home, Key::home},
                                                   {ImGuiKey_End, Key::end},
                                                   {ImGuiKey_Insert, Key::insert},
                                                   {ImGuiKey_Delete, Key::del},
                                                   {ImGuiKey_Backspace, Key::backspace},
                                                   {ImGuiKey_Space, Key::space},
                                                   {ImGuiKey_Enter, Key::enter},
                                                   {ImGuiKey_Escape, Key::escape},
                                                   {ImGuiKey_A, Key::a},
                                                   {ImGuiKey_C, Key::c},
                                                   {ImGuiKey_V, Key::v},
                                                   {ImGuiKey_X, Key::x},
                                                   {ImGuiKey_Y, Key::y},
                                                   {ImGuiKey_Z, Key::z}};

}  // namespace

ImguiHost::ImguiHost(float scale, Clipboard clipboard)
    : context_(ImGui::CreateContext()), clipboard_(std::move(clipboard)) {
  make_current();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  io.MousePos = {-FLT_MAX, -FLT_MAX};
  ImguiPainter::announce(io);
  for (const auto& [theirs, ours] : known_keys) io.KeyMap[theirs] = static_cast<int>(ours);
  io.ClipboardUserData = this;
  io.SetClipboardTextFn = [](void* self, const char* text) {
    auto& host = *static_cast<ImguiHost*>(self);
    host.copied_ = text;
    if (host.clipboard_.set) host.clipboard_.set(text);
  };
  io.GetClipboardTextFn = [](void* self) {
    auto& host = *static_cast<ImguiHost*>(self);
    if (host.clipboard_.get) host.copied_ = host.clipboard_.get();
    return host.copied_.c_str();
  };
  ui_.scale = scale;
  painter_ = std::make_unique<ImguiPainter>();
  make_fonts();
}

void ImguiHost::make_fonts() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  ui_.regular = add_font(atlas, std::round(ui_.px(15)), false, Letters::window);
  ui_.bold = add_font(atlas, std::round(ui_.px(15)), true, Letters::window);
  ui_.small = add_font(atlas, std::round(ui_.px(12)), false, Letters::window);
  for (const double size : plot::text_sizes) {
    const float pixels = plot::ImguiCanvas::font_pixels(size, figure_pixels_per_point * ui_.scale);
    figure_fonts_[static_cast<int>(std::lround(64 * pixels))] =
        add_font(atlas, pixels, false, Letters::window);
  }
  ui_.figure_font = [this](float pixels) {
    const auto it = figure_fonts_.lower_bound(static_cast<int>(std::lround(64 * pixels)));
    return it == figure_fonts_.end() ? figure_fonts_.rbegin()->second : it->second;
  };
  atlas.Build();
  painter_->upload_fonts(atlas);
}

void ImguiHost::apply(const InputEvent& event) {
  ImGuiIO& io = ImGui::GetIO();
  using Kind = InputEvent::Kind;
  switch (event.kind) {
    case Kind::move:
      io.MousePos = {event.x, event.y};
      break;
    case Kind::button:
      if (event.button < 0 || event.button >= 3) break;
      io.MouseDown[event.button] = event.down;
      if (!event.down) break;
      if (event.time >= 0 && pressed_[event.button] >= 0) since_ = event.time - pressed_[event.button];
      pressed_[event.button] = event.time;
      break;
    case Kind::wheel:
      io.MouseWheelH += event.x;
      io.MouseWheel += event.y;
      break;
    case Kind::key:
      io.KeysDown[static_cast<int>(event.key)] = event.down;
      io.KeyCtrl = event.control;
      io.KeyShift = event.shift;
      io.KeyAlt = event.alt;
      break;
    case Kind::text: {
      // In a number a comma is a point, as on half of the keyboards: a box for numbers would drop it, a field
      // for expressions asks whether it is the comma of a function.
      const ImGuiID active = ImGui::GetActiveID();
      const bool number = active != 0 && active == context_->TempInputId && active != ui_.typed.id;
      std::string text = event.text;
      if (number) std::replace(text.begin(), text.end(), ',', '.');
      io.AddInputCharactersUTF8(text.c_str());
      break;
    }
    case Kind::drop:
    case Kind::close:
      break;
    case Kind::focus_lost:
      std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
      std::fill(std::begin(io.MouseDown), std::end(io.MouseDown), false);
      io.KeyCtrl = io.KeyShift = io.KeyAlt = false;
      break;
  }
}

bool ImguiHost::widget_takes(Key key) const {
  constexpr Key used[] = {Key::tab, Key::left,    Key::right,     Key::up,    Key::down,  Key::home,
                          Key::end, Key::page_up, Key::page_down, Key::space, Key::enter, Key::escape};
  const bool has = ImGui::GetIO().NavVisible || context_->OpenPopupStack.Size > 0;
  return has && std::find(std::begin(used), std::end(used), key) != std::end(used);
}

void ImguiHost::focus_pane(bool next) {
  constexpr const char* panes[] = {"scene", "figures", "timeline", "bar", "view"};
  constexpr int count = static_cast<int>(std::size(panes));
  pane_ = next && context_->NavId != 0 ? (pane_ + 1) % count : 0;
  for (int i = 0; i < count; ++i, pane_ = (pane_ + 1) % count)  // the next one that is open
    if (ImGuiWindow* window = ImGui::FindWindowByName(panes[pane_]); window != nullptr && window->WasActive) {
      ImGui::FocusWindow(window);
      ImGui::NavInitWindow(window, true);
      context_->NavDisableHighlight = false;
      context_->NavDisableMouseHover = true;
      return;
    }
}

bool ImguiHost::close_popups() const {
  if (context_->OpenPopupStack.Size == 0) return false;
  ImGui::ClosePopupToLevel(0, true);
  return true;
}

// ImGui counts the time of frames: none passes for it while nothing is drawn, and where frames are slow the
// presses and releases of a quick double click, which have one each, are far apart. Where the desktop's clock
// is known it decides, and an event may be told of as late as a frame takes.
void ImguiHost::judge_clicks(double seconds) {
  constexpr double quick = 0.3;  // [s]
  const double present = std::clamp(seconds, 0.0, 1.0), limit = quick + frame_seconds_ + present;
  frame_seconds_ = present;
  float& longest = ImGui::GetIO().MouseDoubleClickTime;
  longest = static_cast<float>(limit);
  if (since_ >= 0) longest = since_ < limit ? FLT_MAX : 0;
  since_ = -1;
}

// ImGui keeps the steps back of the field that was typed into last, for when that is entered again. By then
// its text may be another (undone, of another scene, emptied), and they would be taken out of its bounds.
void ImguiHost::forget_left_field() {
  ImGuiInputTextState& typed = context_->InputTextState;
  if (typed.ID != 0) typed_ = typed.ID;
  if (typed.ID != context_->ActiveId) typed.ID = 0;
}

// Behind Enter no field is active, and ImGui would begin with the first one: from that which was left, where
// it still has the keyboard.
void ImguiHost::tab_from_left_field() const {
  ImGuiContext& g = *context_;
  const bool first = (g.NavMoveFlags & ImGuiNavMoveFlags_Tabbing) != 0 && g.NavTabbingDir == 0;
  if (first && g.NavId != 0 && g.NavId == typed_ && !g.NavDisableHighlight) g.NavTabbingDir = 1;
}

void ImguiHost::leave_field() const {
  if (typing()) ImGui::ClearActiveID();
}

void ImguiHost::frame(int width, int height, double seconds, const std::function<void()>& draw) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = static_cast<float>(std::clamp(seconds, 1e-4, 0.25));
  judge_clicks(seconds);
  // Enter does what Space does; by itself it only begins to type.
  if (io.KeysDown[static_cast<int>(Key::enter)]) io.NavInputs[ImGuiNavInput_Activate] = 1;
  ImGui::NewFrame();
  forget_left_field();
  tab_from_left_field();
  std::exception_ptr thrown;
  try {
    ui_.typed.drawn = false;
    ImGui::PushFont(ui_.regular);
    draw();
    ImGui::PopFont();
    if (!ui_.typed.drawn) ui_.typed.id = 0;
  } catch (...) {
    thrown = std::current_exception();
  }
  ImGui::ErrorCheckEndFrameRecover(nullptr);  // does nothing after a frame that came to its end
  context_->FontStack.clear();                // which it leaves as it is
  ImGui::Render();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace unfurl
