// SPDX-License-Identifier: BSD-3-Clause
// Six steps around the window, shown once.
#include <iterator>

#include "app/panel/panes/panes.hpp"

namespace unfurl {

namespace {

struct Step {
  const char *title, *text;
  const char* place;  // what it points to
};

constexpr Step steps[] = {
    {"Scene",
     "Everything that can be changed stands on the left. Drag a slider: the motion is made anew beside "
     "what you see.",
     "scene"},
    {"View",
     "Drag to turn, wheel to come nearer, point at a rod or node to read it. Pull: take a node by hand. "
     "Build: add nodes and rods.",
     "view"},
    {"Time", "Space plays. Drag along the line, here or in any figure.", "timeline"},
    {"Figures", "Forces, deployment, and speed against accuracy: each change of the solver moves its point.",
     "page Figures"},
    {"Compare", "Pin a run as A, change something, and see both.", "pin"},
    {"Find",
     "Ctrl P finds every action and parameter by its name; F1 lists the keys. Export writes films, "
     "figures and files for other programs.",
     "export"}};

}  // namespace

void draw_tour(Ui& ui, PanelState& state) {
  if (state.tour < 1) return;
  const int last = static_cast<int>(std::size(steps));
  const Step& step = steps[std::min(state.tour, last) - 1];
  if (const auto at = ui.places.find(step.place); at != ui.places.end()) {
    const plot::Rect& r = at->second;
    const float edge = ui.px(3);
    ImGui::GetForegroundDrawList()->AddRect(
        {static_cast<float>(r.x0) - edge, static_cast<float>(r.y0) - edge},
        {static_cast<float>(r.x1) + edge, static_cast<float>(r.y1) + edge}, ui.color(ui.theme.accent),
        ui.px(5), 0, ui.px(2));
  }
  const Box box(ui, "tour", 380);
  box.heading(step.title);
  wrapped(ui.theme.text, step.text);
  ImGui::Dummy({0, ui.px(4)});
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(ui.theme.dim, "%d of %d", std::min(state.tour, last), last);
  ImGui::SameLine(box.width() - ui.px(120));
  if (button(ui, "tour end", "Skip", "Esc; Ctrl P, guided tour: again")) state.tour = 0;
  ImGui::SameLine();
  if (button(ui, "tour next", state.tour < last ? "Next" : "Begin", ""))
    state.tour = state.tour < last ? state.tour + 1 : 0;
}

}  // namespace unfurl
