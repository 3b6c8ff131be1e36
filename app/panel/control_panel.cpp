// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/control_panel.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <thread>
#include <utility>

#include "app/panel/actions.hpp"
#include "app/panel/panes/panes.hpp"
#include "core/export/atomic_file.hpp"
#include "core/text/nearest_name.hpp"
#include "render/gl/graphics_error.hpp"

namespace unfurl {

namespace {

// Fewer frames a second than 30, and that so many times in a row.
constexpr double slow_frame = 1.0 / 30;
constexpr int slow_enough = 3;
constexpr int until_typing = 4;  // frames that the text field of a box that opens takes to get the keyboard
constexpr float bar_height = 46, timeline_height = 58;  // [points]

}  // namespace

ControlPanel::ControlPanel(GlContext& context, SceneDocument document, PanelOptions options)
    : context_(context),
      options_(std::move(options)),
      session_(std::move(document),
               {options_.at, options_.measure_errors, options_.wake, [this] { return picture_->read(); },
                options_.moment, options_.replayed}),
      view_(context, options_.scale) {
  PanelState& now = state();
  now.dark = options_.settings.dark;
  now.left_open = options_.settings.left_open;
  now.right_open = options_.settings.right_open;
  now.recent = options_.settings.recent;
  now.tour = options_.settings.tour_seen ? 0 : 1;
  const auto& open = options_.settings.open_figures;
  const auto is_open = [&](std::string_view name) {
    return std::find(open.begin(), open.end(), name) != open.end();
  };
  cards_.trade().open = is_open("trade");
  for (FigureCard& card : cards_.cards()) card.open = is_open(card.kind->name);
  context_.make_current();
  Clipboard clipboard = options_.clipboard;
  if (!options_.record.empty()) {
    recorder_ = std::make_unique<SessionRecorder>(
        options_.record,
        SessionStart{now.history.now(), options_.settings, options_.width, options_.height, options_.scale,
                     options_.at, options_.measure_errors, context_.description()});
    if (clipboard.get)
      clipboard.get = [this, get = options_.clipboard.get] {
        std::string text = get();
        if (recorder_) recorder_->note_clipboard(text);
        return text;
      };
  }
  host_ = std::make_unique<ImguiHost>(options_.scale, std::move(clipboard));
  resize(options_.width, options_.height);
}

ControlPanel::~ControlPanel() {
  context_.make_current();
  host_.reset();
}

PanelSettings ControlPanel::settings() {
  PanelSettings now = options_.settings;
  now.dark = state().dark;
  now.left_open = state().left_open;
  now.right_open = state().right_open;
  now.recent = state().recent;
  now.tour_seen = now.tour_seen || state().tour == 0;
  now.open_figures.clear();
  if (cards_.trade().open) now.open_figures.emplace_back("trade");
  for (const FigureCard& card : cards_.cards())
    if (card.open) now.open_figures.emplace_back(card.kind->name);
  return now;
}

void ControlPanel::resize(int width, int height) {
  if (recorder_ && picture_) recorder_->note_size(width, height);
  options_.width = std::max(width, 64);
  options_.height = std::max(height, 64);
  context_.make_current();
  picture_.reset();
  picture_ =
      std::make_unique<Framebuffer>(options_.width, options_.height, 0);  // ImGui smooths its own edges
  damage_.forget();
  settling_ = 3;
}

const plot::Rect& ControlPanel::place(const std::string& key) const {
  const auto& places = host_->ui().places;
  const auto found = places.find(key);
  if (found == places.end())
    throw std::out_of_range("the frame before has no widget called " + in_quotes(key));
  return found->second;
}

void ControlPanel::handle(const InputEvent& event) {
  if (recorder_) recorder_->note(event);
  events_.push_back(event);
}

// A key goes to the text that is typed, to the widget that has the keyboard, or to the actions: true. Esc
// closes what is open, whoever has it.
bool ControlPanel::take_key(const InputEvent& event) {
  const bool escape = event.key == Key::escape, question = !state().question.text.empty();
  const bool box = state().palette_open || state().files_open || state().export_open || state().help_open ||
                   state().tour > 0 || question;
  const bool anywhere = event.control && (event.key == Key::p || event.key == Key::o || event.key == Key::q);
  if (escape && host_->close_popups()) return true;
  if (host_->typing() && !(escape && box) && !anywhere) return false;
  if (host_->widget_takes(event.key) && !(escape && box)) return false;
  if (event.key == Key::tab || event.key == Key::f6) {
    host_->focus_pane(event.key == Key::f6);
    return event.key == Key::f6;  // Tab goes on to the pane's first widget
  }
  if (question && !escape) return false;
  state().intents.emplace_back([event](LiveSession& s) { press(s, event); });
  return true;
}

// Up to the next press or release of a button or key, so that a click shorter than a frame is seen.
void ControlPanel::take_events() {
  using Kind = InputEvent::Kind;
  const bool box = state().palette_open || state().files_open || state().export_open;
  box_frames_ = box ? box_frames_ + 1 : 0;
  const bool waits = box && box_frames_ <= until_typing && !host_->typing();
  while (!events_.empty()) {
    const InputEvent& next = events_.front();
    const bool pressed = next.kind == Kind::key && next.down && next.key != Key::escape;
    if (waits && (pressed || next.kind == Kind::text)) {
      keep_drawing(true);
      break;
    }
    const InputEvent event = std::move(events_.front());
    events_.pop_front();
    if (event.down && (event.kind == Kind::button || event.key != Key::none)) session_.note_press();
    InputEvent seen = event;  // by widgets: nothing of a key that was for others but what is held beside it
    if (event.kind == Kind::key && event.down) seen.down = !take_key(event);
    host_->apply(seen);
    keep_drawing(true);
    if (event.kind == Kind::text && event.text == "?" && !host_->typing())
      state().intents.emplace_back([](LiveSession& s) { s.state().help_open = !s.state().help_open; });
    if (event.kind == Kind::drop) {
      host_->leave_field();  // it would write its text into the other scene
      state().intents.emplace_back([path = event.text](LiveSession& s) { s.open_file(path); });
    }
    if (event.kind == Kind::close) state().intents.emplace_back(&LiveSession::ask_to_close);
    if (event.kind == Kind::button || event.kind == Kind::key) break;
  }
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
  Ui& ui = host_->ui();
  const float thick = std::round(ui.px(6));
  const Pane pane(name, x - thick / 2, top, thick, bottom - top, ImGuiWindowFlags_NoBackground);
  ImGui::PopStyleVar(2);
  ImGui::InvisibleButton(name, {thick, std::max(1.0f, bottom - top)});
  ui.note(name);
  const bool held = ImGui::IsItemActive();
  const float line = held || ImGui::IsItemHovered() ? ui.px(3) : 1.0f;
  ImGui::GetWindowDrawList()->AddRectFilled(
      {x - line / 2, top}, {x + line / 2, bottom},
      ui.color(held || ImGui::IsItemHovered() ? ui.theme.accent : ui.theme.rule));
  if (held) width = std::clamp(width + way * ImGui::GetIO().MouseDelta.x / ui.scale, 200.0f, 900.0f);
}

void ControlPanel::draw_panes() {
  Ui& ui = host_->ui();
  PanelState& now = state();
  const auto width = static_cast<float>(options_.width), height = static_cast<float>(options_.height);
  const float top = std::round(ui.px(bar_height)), bottom = height - std::round(ui.px(timeline_height));
  const auto side = [&](bool open, float points) {
    return open ? std::min(std::round(ui.px(points)), 0.32f * width) : 0;
  };
  const float left = side(now.left_open, options_.settings.left_width);
  const float right = side(now.right_open, options_.settings.right_width);
  {
    const Pane pane("bar", 0, 0, width, top, ImGuiWindowFlags_NoScrollWithMouse);
    draw_top_bar(ui, now);
  }
  if (left > 0) {
    const Pane pane("scene", 0, top, left, bottom - top, ImGuiWindowFlags_AlwaysVerticalScrollbar);
    draw_scene_pane(ui, now);
  }
  view_place_ = {left, top, width - right, bottom};
  timed(times_.scene, [&] {
    now.view_place.heading = heading_room(ui, now, width - right - left, bottom - top);
    view_.prepare(static_cast<int>(view_place_.width()), static_cast<int>(view_place_.height()), now);
  });
  {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    const Pane pane("view", left, top, width - right - left, bottom - top,
                    ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleVar();
    draw_view_pane(ui, now, view_);
  }
  if (right > 0) draw_right_pane({width - right, top, width, bottom});
  {
    const Pane pane("timeline", 0, bottom, width, height - bottom, ImGuiWindowFlags_NoScrollWithMouse);
    draw_timeline(ui, now);
  }
  if (left > 0) draw_splitter("left edge", left, top, bottom, options_.settings.left_width, 1);
  if (right > 0) draw_splitter("right edge", width - right, top, bottom, options_.settings.right_width, -1);
  draw_help(ui, now);
  draw_export(ui, now);
  draw_files(ui, now);
  draw_palette(ui, now);
  draw_tour(ui, now);
  draw_question(ui, now);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled({0, 0}, {width, top}, ui.color(ui.theme.window));
}

// Of the panes, which no click brings to the front, ImGui puts a new one below those that there are: the
// lines of the present time have theirs first, and are drawn into it when the figures have said where they
// are.
void ControlPanel::draw_right_pane(const plot::Rect& place) {
  Ui& ui = host_->ui();
  const auto pane = [&](const char* name, ImGuiWindowFlags flags, const auto& draw) {
    const Pane here(name, static_cast<float>(place.x0), static_cast<float>(place.y0),
                    static_cast<float>(place.width()), static_cast<float>(place.height()), flags);
    draw();
  };
  const auto cursors = [&](const auto& draw) {
    pane("cursors", ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoBackground, draw);
  };
  cursors([] {});
  pane("figures", ImGuiWindowFlags_AlwaysVerticalScrollbar, [&] {
    ui.cursors.clear();
    draw_right_tabs(ui, state());
    const float compared =
        draw_comparison(ui, state(), ImGui::GetCursorScreenPos(), ImGui::GetContentRegionAvail().x);
    if (compared > 0) ImGui::Dummy({0, compared});
    timed(times_.figures, [&] {
      if (state().studies_open)
        draw_study_pane(ui, state(), cards_);
      else
        draw_figure_pane(ui, state(), cards_);
    });
  });
  cursors([&] { draw_cursors(ui); });
}

// While something moves and frames take long, smooth edges wait until it rests.
bool ControlPanel::coarse_view(double seconds) {
  const bool moves = state().playback.playing || view_.moved(state()) || ImGui::IsAnyMouseDown();
  if (slow_frames_ < slow_enough && moves && seconds > 0)
    slow_frames_ = seconds > slow_frame ? slow_frames_ + 1 : 0;
  return moves && slow_frames_ >= slow_enough;
}

// What is as it was stays; the view's picture goes below whatever lies over it.
void ControlPanel::paint(bool coarse) {
  const plot::Rect& v = view_place_;
  std::vector<plot::Rect> parts = damage_.update(*ImGui::GetDrawData());
  bool copied = false;
  timed(times_.scene, [&] { copied = view_.paint(state(), coarse); });
  const auto below = [&](const plot::Rect& part) { return part.overlaps(v); };
  if (copied || std::any_of(parts.begin(), parts.end(), below)) parts.push_back(v);
  const ImVec4& ground = host_->ui().theme.window;
  for (const plot::Rect& part : apart(std::move(parts))) {
    const int x = static_cast<int>(part.x0), y = static_cast<int>(part.y0);
    painted_ += part.width() * part.height();
    timed(times_.scene, [&] {
      picture_->fill(ground.x, ground.y, ground.z, x, y, static_cast<int>(part.width()),
                     static_cast<int>(part.height()));
      if (below(part)) view_.copy_to(*picture_, static_cast<int>(v.x0), static_cast<int>(v.y0));
    });
    timed(times_.painting, [&] { host_->painter().draw(*ImGui::GetDrawData(), part); });
  }
}

void ControlPanel::settle() {
  frame(0);
  while (session_.busy()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    frame(0, false);
  }
  for (int i = 0; i < 4; ++i) frame(0);
}

// What goes wrong in a part of a frame is said, and the window with its changes stays. Graphics that are lost
// are another matter.
void ControlPanel::survive(const std::function<void()>& part) {
  try {
    part();
  } catch (const GraphicsError&) {
    throw;
  } catch (const std::exception& error) {
    state().message = error.what();
    keep_drawing(true);
  }
}

bool ControlPanel::frame(double seconds, bool visible) {
  context_.make_current();
  host_->make_current();
  take_events();
  survive([this] { keep_drawing(session_.take_results()); });
  session_.advance(seconds);
  Ui& ui = host_->ui();
  if (dark_drawn_ != state().dark) ui.theme = apply_theme(*(dark_drawn_ = state().dark), ui.scale);
  ui.places.clear();
  times_ = {};
  double building = 0;
  timed(building, [&] {
    survive([&] { host_->frame(options_.width, options_.height, seconds, [this] { draw_panes(); }); });
  });
  keep_drawing(std::exchange(ui.unsettled, false));
  times_.widgets = building - times_.scene - times_.figures;
  keep_drawing(session_.act());
  survive([this] { keep_drawing(session_.follow_document()); });
  if (visible) paint(coarse_view(seconds));
  settling_ = std::max(0, settling_ - 1);
  const bool more = settling_ > 0 || !events_.empty() || state().playback.playing || state().wiggled >= 0 ||
                    host_->typing() || (visible && view_.coarse());
  return record(seconds, visible, more) || more;
}

// Where the session cannot be recorded any further, its work goes on. Returns whether there is that to say.
bool ControlPanel::record(double seconds, bool visible, bool more) {
  if (!recorder_) return false;
  const auto picture = !more && visible ? std::optional(picture_->read()) : std::nullopt;
  try {
    recorder_->frame(seconds, visible, session_, picture);
    return false;
  } catch (const FileError& error) {
    state().message = error.what();
    record_failure_ = std::current_exception();
  }
  recorder_.reset();
  keep_drawing(true);
  return true;
}

}  // namespace unfurl
