// SPDX-License-Identifier: BSD-3-Clause
// The right pane: the run's figures, with the present time as a line.
#include <algorithm>
#include <cmath>

#include "app/panel/panes/panes.hpp"
#include "app/panel/panes/themed_canvas.hpp"
#include "render/plot/painter.hpp"
#include "render/ui/imgui_canvas.hpp"

namespace unfurl {

namespace {

constexpr double figure_tolerance = 0.1;  // of curves [pixels]

bool over_time(const Panel& panel) {
  return panel.x.label.starts_with("time") || (!panel.x.shown && panel.x.label.empty());
}

// The line at the present time; dragging in the panel moves it.
void draw_cursor(Ui& ui, PanelState& state, const plot::PanelLayout& panel, const PlacedFigure& place,
                 const std::string& key) {
  const plot::Rect& frame = panel.frame;
  const double t = state.playback.t;
  const double at = panel.x.scale(t);
  if (at >= frame.x0 - 0.5 && at <= frame.x1 + 0.5)
    ui.cursors.push_back(
        {std::floor(place.x(at)), place.y(frame.y0), std::floor(place.x(at)), place.y(frame.y1)});
  ImGui::SetCursorScreenPos({place.x(frame.x0), place.y(frame.y0)});
  ImGui::InvisibleButton(key.c_str(),
                         {place.x(frame.x1) - place.x(frame.x0), place.y(frame.y1) - place.y(frame.y0)});
  ui.note(key);
  if (!ImGui::IsItemActive()) return;
  const double points = (ImGui::GetIO().MousePos.x - place.origin.x) / place.scale;
  const double share = std::clamp((points - frame.x0) / frame.width(), 0.0, 1.0);
  state.playback.playing = false;
  state.playback.t = std::clamp(panel.x.scale.lo + share * (panel.x.scale.hi - panel.x.scale.lo),
                                state.shown->simulation.trajectory.start_time(),
                                state.shown->simulation.trajectory.end_time());
}

}  // namespace

PlacedFigure draw_figure(Ui& ui, PanelState& state, const FigureCard& card) {
  const PlacedFigure place{ImGui::GetCursorScreenPos(), figure_pixels_per_point * ui.scale};
  const ImVec2 size(static_cast<float>(card.layout.width * place.scale),
                    static_cast<float>(card.layout.height * place.scale));
  const ImVec2 high(place.origin.x + size.x, place.origin.y + size.y);
  if (ImGui::IsRectVisible(place.origin, high)) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(place.origin, high, ui.color(figure_paper(ui.theme.dark)), ui.px(4));
    plot::ImguiCanvas canvas(list, ui.figure_font, place.scale, {place.origin.x, place.origin.y},
                             figure_tolerance);
    ThemedCanvas themed(canvas, ui.theme.dark);
    plot::paint(*card.figure, card.layout, themed);
    if (state.simulation.late) list.AddRectFilled(place.origin, high, ui.color(ui.theme.window, 0.45f));
  }
  const std::string name = card.figure->name;
  for (std::size_t i = 0; i < card.layout.panels.size(); ++i)
    if (over_time(card.figure->panels[i]))
      draw_cursor(ui, state, card.layout.panels[i], place, "figure " + name + " " + std::to_string(i));
  ImGui::SetCursorScreenPos({place.origin.x, high.y + ui.px(4)});
  ImGui::Dummy({0, 0});
  return place;
}

double figure_width(const Ui& ui) {
  return ImGui::GetContentRegionAvail().x / (figure_pixels_per_point * ui.scale);
}

namespace {

// A header that opens and closes; returns whether it is open.
bool draw_header(Ui& ui, FigureCard& card, std::string title, const std::string& key,
                 const std::string& help) {
  std::replace(title.begin(), title.end(), '_', ' ');
  title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  ImGui::SetNextItemOpen(card.open);
  ImGui::PushFont(ui.bold);
  card.open = ImGui::CollapsingHeader((title + "##" + key).c_str());
  ImGui::PopFont();
  ui.note("card " + key);
  tooltip(ui, card.figure ? card.figure->title + "\n" + card.figure->caption : help);
  return card.open;
}

// Says which settings the point under the pointer had.
void name_point(Ui& ui, const PanelState& state, const FigureCard& card, const PlacedFigure& place) {
  const plot::PanelLayout& panel = card.layout.panels.front();
  const bool positions = shows_positions(state.trade);
  ui.places["trade points"] = {place.x(panel.frame.x0), place.y(panel.frame.y0), place.x(panel.frame.x1),
                               place.y(panel.frame.y1)};
  const plot::Point now = mark_of(state.trade.back(), positions, panel);
  if (!std::isnan(now.y))
    ui.places["trade now"] = {place.x(now.x) - 1, place.y(now.y) - 1, place.x(now.x) + 1, place.y(now.y) + 1};
  if (!ImGui::IsWindowHovered()) return;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const plot::Point at{(mouse.x - place.origin.x) / place.scale, (mouse.y - place.origin.y) / place.scale};
  const std::size_t i = nearest_point(state.trade, panel, at, 6);
  if (i == state.trade.size()) return;
  const plot::Point mark = mark_of(state.trade[i], positions, panel);
  ImGui::GetWindowDrawList()->AddCircle({place.x(mark.x), place.y(mark.y)}, ui.px(7),
                                        ui.color(ui.theme.accent), 0, ui.px(2));
  ImGui::SetTooltip("%s", point_caption(state.trade[i]).c_str());
  ui.places["trade point"] = {place.x(mark.x) - 1, place.y(mark.y) - 1, place.x(mark.x) + 1,
                              place.y(mark.y) + 1};
}

void draw_trade(Ui& ui, PanelState& state, FigureCards& cards) {
  if (state.trade.empty()) return;
  const char* help = "CPU time and error of every run of this session";
  if (!draw_header(ui, cards.trade(), "Speed against accuracy", "trade", help)) return;
  cards.make_trade(state.trade, state.trade_news, state.studied);
  const PlacedFigure place = draw_figure(ui, state, cards.trade());
  name_point(ui, state, cards.trade(), place);
  ImGui::PushStyleColor(ImGuiCol_Text, ui.theme.dim);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(present_sentence(state.trade.back()).c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
  ui.note("trade sentence");
}

}  // namespace

void draw_figure_pane(Ui& ui, PanelState& state, FigureCards& cards) {
  cards.show(state.shown, state.pinned, figure_width(ui));
  bool traded = false;  // speed against accuracy stands before the figures of how well it was computed
  for (FigureCard& card : cards.cards()) {
    if (!cards.applies(card)) continue;
    if (!traded && (card.kind->name == "constraint_error" || card.kind->name == "energy"))
      traded = true, draw_trade(ui, state, cards);
    const std::string name(card.kind->name);
    if (!draw_header(ui, card, name, name, std::string(card.kind->help))) continue;
    cards.make(card);
    draw_figure(ui, state, card);
  }
  if (!traded) draw_trade(ui, state, cards);
}

void draw_right_tabs(Ui& ui, PanelState& state) {
  const std::pair<const char*, bool> pages[] = {{"Figures", false}, {"Studies", true}};
  for (const auto& [name, studies] : pages) {
    if (studies) ImGui::SameLine(0, ui.px(4));
    const bool is = state.studies_open == studies;
    if (is) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (button(ui, std::string("page ") + name, name,
               studies ? "measure this scene: speed against accuracy, a parameter's effect (3)"
                       : "of the run shown (3)"))
      state.studies_open = studies;
    if (is) ImGui::PopStyleColor();
  }
}

void draw_cursors(const Ui& ui) {
  for (const plot::Rect& line : ui.cursors)
    ImGui::GetWindowDrawList()->AddLine({static_cast<float>(line.x0), static_cast<float>(line.y0)},
                                        {static_cast<float>(line.x1), static_cast<float>(line.y1)},
                                        ui.color(ui.theme.error, 0.9f), std::max(1.0f, ui.px(1.2f)));
}

}  // namespace unfurl
