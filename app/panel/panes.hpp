// The parts of the panel. Each draws into the current ImGui window and changes the state.
#pragma once

#include "app/panel/export_process.hpp"
#include "app/panel/figure_cards.hpp"
#include "app/panel/panel_state.hpp"
#include "app/panel/scene_view.hpp"
#include "app/panel/ui.hpp"

namespace unfurl {

void draw_top_bar(Ui& ui, PanelState& state);
void draw_scene_pane(Ui& ui, PanelState& state);                       // left
void draw_view_pane(Ui& ui, PanelState& state, SceneView& view);       // centre
void draw_figure_pane(Ui& ui, PanelState& state, FigureCards& cards);  // right
void draw_cursors(const Ui& ui);                                       // over the figures
void draw_timeline(Ui& ui, PanelState& state);                         // bottom
void draw_help(Ui& ui, PanelState& state);
void draw_export(Ui& ui, PanelState& state, ExportProcess& job);

// A row of the left pane: label and widget. Returns whether the value changed.
bool draw_param(Ui& ui, const ParamRow& row, ParamValue& value, bool wrong);

}  // namespace unfurl
