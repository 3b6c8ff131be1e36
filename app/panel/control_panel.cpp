// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/control_panel.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <thread>

#include "app/panel/panes/panes.hpp"
#include "app/panel/shortcuts.hpp"
#include "render/gl/graphics_error.hpp"
#include "render/plot/style.hpp"
#include "render/ui/fonts.hpp"
#include "render/ui/imgui_canvas.hpp"

namespace unfurl {

namespace {

constexpr std::size_t most_trade_points = 200;
// Fewer frames a second than 30, and that so many times in a row.
constexpr double slow_frame = 1.0 / 30;
constexpr int slow_enough = 3;
constexpr float bar_height = 46, timeline_height = 58;  // [points]

// One pane: an ImGui window that fills a rectangle.
struct Pane {
  Pane(const char* name, float x, float y, float width, float height, ImGuiWindowFlags flags = 0) {
    ImGui::SetNextWindowPos({x, y});
    ImGui::SetNextWindowSize({std::max(1.0f, width), std::max(1.0f, height)});
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | flags);
  }
  // Where an exception passes, ImGui closes what is open, in its order (ControlPanel::draw).
  ~Pane() {
    if (std::uncaught_exceptions() == before_) ImGui::End();
  }
  Pane(const Pane&) = delete;
  Pane& operator=(const Pane&) = delete;

 private:
  int before_ = std::uncaught_exceptions();
};

}  // namespace

ControlPanel::ControlPanel(GlContext& context, SceneDocument document, PanelOptions options)
    : context_(context),
      options_(std::move(options)),
      state_(std::move(document)),
      view_(context),
      export_(options_.wake),
      study_(options_.wake),
      errors_(options_.wake),
      simulator_(options_.wake) {
  state_.dark = options_.settings.dark;
  state_.left_open = options_.settings.left_open;
  state_.right_open = options_.settings.right_open;
  const auto& open = options_.settings.open_figures;
  const auto is_open = [&](std::string_view name) {
    return std::find(open.begin(), open.end(), name) != open.end();
  };
  cards_.trade().open = is_open("trade");
  for (FigureCard& card : cards_.cards()) card.open = is_open(card.kind->name);
  state_.base = base_scene(state_.history.now());
  state_.sections = param_sections(state_.base);
  context_.make_current();
  make_context();
  painter_ = std::make_unique<ImguiPainter>();
  make_fonts();
  resize(options_.width, options_.height);
  follow_document();
}

ControlPanel::~ControlPanel() {
  context_.make_current();
  imgui_.reset();
}

PanelSettings ControlPanel::settings() {
  PanelSettings now = options_.settings;
  now.dark = state_.dark;
  now.left_open = state_.left_open;
  now.right_open = state_.right_open;
  now.open_figures.clear();
  if (cards_.trade().open) now.open_figures.emplace_back("trade");
  for (const FigureCard& card : cards_.cards())
    if (card.open) now.open_figures.emplace_back(card.kind->name);
  return now;
}

void ControlPanel::make_context() {
  imgui_.reset(ImGui::CreateContext());
  ImGui::SetCurrentContext(imgui_.get());
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.MousePos = {-FLT_MAX, -FLT_MAX};
  ImguiPainter::announce(io);
  map_keys(io);
  io.ClipboardUserData = this;
  io.SetClipboardTextFn = [](void* self, const char* text) {
    auto& panel = *static_cast<ControlPanel*>(self);
    panel.clipboard_ = text;
    if (panel.options_.set_clipboard) panel.options_.set_clipboard(text);
  };
  io.GetClipboardTextFn = [](void* self) {
    auto& panel = *static_cast<ControlPanel*>(self);
    if (panel.options_.get_clipboard) panel.clipboard_ = panel.options_.get_clipboard();
    return panel.clipboard_.c_str();
  };
  ui_.scale = options_.scale;
  ui_.theme = apply_theme(state_.dark, ui_.scale);
  dark_drawn_ = state_.dark;
}

void ControlPanel::make_fonts() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  ui_.regular = add_font(atlas, std::round(ui_.px(15)));
  ui_.bold = add_font(atlas, std::round(ui_.px(15)), true);
  ui_.small = add_font(atlas, std::round(ui_.px(12)));
  for (const double size : plot::text_sizes) {
    const float pixels = plot::ImguiCanvas::font_pixels(size, figure_pixels_per_point * ui_.scale);
    figure_fonts_[static_cast<int>(std::lround(64 * pixels))] = add_font(atlas, pixels);
  }
  ui_.figure_font = [this](float pixels) {
    const auto it = figure_fonts_.lower_bound(static_cast<int>(std::lround(64 * pixels)));
    return it == figure_fonts_.end() ? figure_fonts_.rbegin()->second : it->second;
  };
  atlas.Build();
  painter_->upload_fonts(atlas);
}

void ControlPanel::resize(int width, int height) {
  options_.width = std::max(width, 64);
  options_.height = std::max(height, 64);
  context_.make_current();
  picture_.reset();
  picture_ =
      std::make_unique<Framebuffer>(options_.width, options_.height, 0);  // ImGui smooths its own edges
  damage_.forget();
  settling_ = 3;
}

void ControlPanel::apply(const InputEvent& event) {
  ImGuiIO& io = ImGui::GetIO();
  using Kind = InputEvent::Kind;
  switch (event.kind) {
    case Kind::move:
      io.MousePos = {event.x, event.y};
      break;
    case Kind::button:
      if (event.button >= 0 && event.button < 3) io.MouseDown[event.button] = event.down;
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
      if (event.down && !io.WantTextInput) press(state_, event);
      break;
    case Kind::text:
      io.AddInputCharactersUTF8(event.text.c_str());
      if (event.text == "?" && !io.WantTextInput) state_.help_open = !state_.help_open;
      break;
    case Kind::focus_lost:
      std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
      std::fill(std::begin(io.MouseDown), std::end(io.MouseDown), false);
      io.KeyCtrl = io.KeyShift = io.KeyAlt = false;
      break;
  }
}

// Up to the next press or release of a button or key, so that a click shorter than a frame is seen.
void ControlPanel::take_events() {
  using Kind = InputEvent::Kind;
  while (!events_.empty()) {
    const InputEvent event = std::move(events_.front());
    events_.pop_front();
    apply(event);
    settling_ = std::max(settling_, 2);
    if (event.kind == Kind::button || event.kind == Kind::key) break;
  }
}

void ControlPanel::take_results() {
  const auto outcome = simulator_.take();
  state_.progress = simulator_.progress();
  if (outcome) {
    settling_ = std::max(settling_, 2);
    state_.problems = outcome->problems;
    state_.message = outcome->message;
    if (outcome->run && !outcome->run->simulation.trajectory.empty()) {
      const bool first = !state_.shown;
      state_.shown = outcome->run;
      state_.trade.push_back(trade_point(*state_.shown));
      ++state_.trade_news;
      if (options_.measure_errors)
        errors_.measure(state_.shown);
      else
        note_error(state_.trade, {.run = state_.shown->id, .why = "not asked for"});
      if (state_.trade.size() > most_trade_points) state_.trade.erase(state_.trade.begin());
      if (state_.shown->document == state_.history.now())
        state_.picture = state_.shown->scene.render;
      else
        update_picture();
      const Trajectory& trajectory = state_.shown->simulation.trajectory;
      if (first) state_.playback.t = options_.at;
      state_.playback.t = std::clamp(state_.playback.t, trajectory.start_time(), trajectory.end_time());
    }
  }
  state_.pending = simulator_.busy();
  take_errors();
}

void ControlPanel::take_errors() {
  for (const RunError& error : errors_.take()) {
    note_error(state_.trade, error);
    ++state_.trade_news;
    settling_ = std::max(settling_, 2);
  }
  errors_.hold(state_.pending);  // the next run comes first
}

// How things look needs no simulation.
void ControlPanel::update_picture() {
  try {
    state_.picture = read_document(state_.history.now()).render;
    state_.problems.clear();
  } catch (const SceneError& error) {
    state_.problems = error.problems();
  }
}

// A change of the scene asks for its simulation.
void ControlPanel::follow_document() {
  if (!(state_.described == state_.selected)) {
    state_.described = state_.selected;
    state_.sections = param_sections(state_.base, state_.selected);
    settling_ = std::max(settling_, 2);
  }
  const SceneDocument& now = state_.history.now();
  if (state_.wants_stop) {
    simulator_.cancel();
    state_.wants_stop = false;
  }
  if (submitted_ && *submitted_ == now) return;
  if (!submitted_ || *submitted_->text != *now.text || submitted_->overrides != now.overrides ||
      submitted_->added != now.added) {
    try {
      state_.base = base_scene(now);
      state_.described = state_.selected;
      state_.sections = param_sections(state_.base, state_.selected);
    } catch (const SceneError& error) {
      if (!submitted_) throw;
      state_.problems = error.problems();
    }
  }
  const bool same_run = submitted_ && simulated_part(*submitted_) == simulated_part(now);
  submitted_ = now;
  if (same_run) {
    update_picture();
  } else {
    errors_.hold(true);
    simulator_.submit(now);
    state_.pending = true;
  }
  settling_ = std::max(settling_, 2);
}

template <class Part>
void ControlPanel::timed(double& sum, const Part& part) {
  if (!options_.measured) return part();
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  part();
  picture_->finish();
  sum += std::chrono::duration<double>(Clock::now() - start).count();
}

// The edge between two panes, to drag. `way`: of a wider pane.
void ControlPanel::draw_splitter(const char* name, float x, float top, float bottom, float& width,
                                 float way) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  const float thick = std::round(ui_.px(6));
  const Pane pane(name, x - thick / 2, top, thick, bottom - top, ImGuiWindowFlags_NoBackground);
  ImGui::PopStyleVar(2);
  ImGui::InvisibleButton(name, {thick, std::max(1.0f, bottom - top)});
  ui_.note(name);
  const bool held = ImGui::IsItemActive();
  const float line = held || ImGui::IsItemHovered() ? ui_.px(3) : 1.0f;
  ImGui::GetWindowDrawList()->AddRectFilled(
      {x - line / 2, top}, {x + line / 2, bottom},
      ui_.color(held || ImGui::IsItemHovered() ? ui_.theme.accent : ui_.theme.rule));
  if (held) width = std::clamp(width + way * ImGui::GetIO().MouseDelta.x / ui_.scale, 200.0f, 900.0f);
}

void ControlPanel::draw_panes() {
  const auto width = static_cast<float>(options_.width), height = static_cast<float>(options_.height);
  const float top = std::round(ui_.px(bar_height)), bottom = height - std::round(ui_.px(timeline_height));
  const float left =
      state_.left_open ? std::min(std::round(ui_.px(options_.settings.left_width)), 0.4f * width) : 0;
  const float right =
      state_.right_open ? std::min(std::round(ui_.px(options_.settings.right_width)), 0.4f * width) : 0;
  {
    const Pane pane("bar", 0, 0, width, top, ImGuiWindowFlags_NoScrollWithMouse);
    draw_top_bar(ui_, state_);
  }
  if (left > 0) {
    const Pane pane("scene", 0, top, left, bottom - top, ImGuiWindowFlags_AlwaysVerticalScrollbar);
    draw_scene_pane(ui_, state_);
  }
  view_place_ = {left, top, width - right, bottom};
  timed(times_.scene, [&] {
    view_.prepare(static_cast<int>(view_place_.width()), static_cast<int>(view_place_.height()), state_);
  });
  {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    const Pane pane("view", left, top, width - right - left, bottom - top,
                    ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleVar();
    draw_view_pane(ui_, state_, view_);
  }
  // Of the panes, which no click brings to the front, ImGui puts a new one below those that there are: the
  // lines of the present time have theirs first, and are drawn into it when the figures have said where they
  // are.
  const auto cursors = [&](const auto& draw) {
    const Pane pane("cursors", width - right, top, right, bottom - top,
                    ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoBackground);
    draw();
  };
  if (right > 0) cursors([] {});
  if (right > 0) {
    const Pane pane("figures", width - right, top, right, bottom - top,
                    ImGuiWindowFlags_AlwaysVerticalScrollbar);
    ui_.cursors.clear();
    draw_right_tabs(ui_, state_);
    timed(times_.figures, [&] {
      if (state_.studies_open)
        draw_study_pane(ui_, state_, cards_, study_);
      else
        draw_figure_pane(ui_, state_, cards_);
    });
  }
  if (right > 0) cursors([this] { draw_cursors(ui_); });
  {
    const Pane pane("timeline", 0, bottom, width, height - bottom, ImGuiWindowFlags_NoScrollWithMouse);
    draw_timeline(ui_, state_);
  }
  if (left > 0) draw_splitter("left edge", left, top, bottom, options_.settings.left_width, 1);
  if (right > 0) draw_splitter("right edge", width - right, top, bottom, options_.settings.right_width, -1);
  draw_help(ui_, state_);
  draw_export(ui_, state_, export_);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled({0, 0}, {width, top}, ui_.color(ui_.theme.window));
}

// While something moves and frames take long, smooth edges wait until it rests.
bool ControlPanel::coarse_view(double seconds) {
  const bool moves = state_.playback.playing || view_.moved(state_) || ImGui::IsAnyMouseDown();
  if (slow_frames_ < slow_enough && moves && seconds > 0)
    slow_frames_ = seconds > slow_frame ? slow_frames_ + 1 : 0;
  return moves && slow_frames_ >= slow_enough;
}

// What is as it was stays; the view's picture goes below whatever lies over it.
void ControlPanel::paint(bool coarse) {
  const plot::Rect& v = view_place_;
  std::vector<plot::Rect> parts = damage_.update(*ImGui::GetDrawData());
  bool copied = false;
  timed(times_.scene, [&] { copied = view_.paint(state_, coarse); });
  const auto below = [&](const plot::Rect& part) { return part.overlaps(v); };
  if (copied || std::any_of(parts.begin(), parts.end(), below)) parts.push_back(v);
  const ImVec4& ground = ui_.theme.window;
  for (const plot::Rect& part : merged(std::move(parts))) {
    const int x = static_cast<int>(part.x0), y = static_cast<int>(part.y0);
    timed(times_.scene, [&] {
      picture_->fill(ground.x, ground.y, ground.z, x, y, static_cast<int>(part.width()),
                     static_cast<int>(part.height()));
      if (below(part)) view_.copy_to(*picture_, static_cast<int>(v.x0), static_cast<int>(v.y0));
    });
    timed(times_.painting, [&] { painter_->draw(*ImGui::GetDrawData(), part); });
  }
}

void ControlPanel::settle() {
  frame(0);
  while (simulating() || state_.pending || errors_.busy()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    frame(0, false);
  }
  for (int i = 0; i < 4; ++i) frame(0);
}

// What goes wrong in a part of a frame is said, and the window with its changes stays. Graphics that are lost
// are another matter.
template <class Part>
void ControlPanel::survive(const Part& part) {
  try {
    part();
  } catch (const GraphicsError&) {
    throw;
  } catch (const std::exception& error) {
    state_.message = error.what();
    settling_ = std::max(settling_, 2);
  }
}

bool ControlPanel::frame(double seconds, bool visible) {
  context_.make_current();
  ImGui::SetCurrentContext(imgui_.get());
  take_events();
  survive([this] { take_results(); });
  if (state_.shown) {
    const Trajectory& trajectory = state_.shown->simulation.trajectory;
    if (state_.playback.playing && seconds > 0) {
      const double rate = 1 / seconds, before = state_.frames_per_second;
      state_.frames_per_second = before > 0 ? before + 0.1 * (rate - before) : rate;
    }
    state_.playback = advanced(state_.playback, seconds, trajectory.start_time(), trajectory.end_time());
  }
  if (state_.dark != dark_drawn_) {
    ui_.theme = apply_theme(state_.dark, ui_.scale);
    dark_drawn_ = state_.dark;
  }
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(options_.width), static_cast<float>(options_.height)};
  io.DeltaTime = static_cast<float>(std::clamp(seconds, 1e-4, 0.25));
  ui_.places.clear();
  times_ = {};
  double building = 0;
  timed(building, [&] {
    ImGui::NewFrame();
    survive([this] {
      ImGui::PushFont(ui_.regular);
      draw_panes();
      ImGui::PopFont();
    });
    ImGui::ErrorCheckEndFrameRecover(nullptr);  // does nothing after a frame that came to its end
    imgui_->FontStack.clear();                  // which it leaves as it is
    ImGui::Render();
  });
  times_.widgets = building - times_.scene - times_.figures;
  survive([this] { follow_document(); });
  const std::pair jobs(study_.running(), export_.running());
  if (std::exchange(jobs_, jobs) != jobs) settling_ = std::max(settling_, 2);  // other widgets, other sizes
  if (visible) paint(coarse_view(seconds));
  settling_ = std::max(0, settling_ - 1);
  return settling_ > 0 || !events_.empty() || state_.playback.playing || io.WantTextInput ||
         (visible && view_.coarse());
}

}  // namespace unfurl
