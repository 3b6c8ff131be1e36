// SPDX-License-Identifier: BSD-3-Clause
// The parts of the panel. Each draws into the current ImGui window, changes what is shown, and leaves what it
// is asked to do as intents.
#pragma once

#include "app/panel/live_session.hpp"
#include "app/panel/panes/figure_cards.hpp"
#include "app/panel/panes/ui.hpp"
#include "app/panel/view/scene_view.hpp"
#include "core/scene/expression.hpp"

namespace unfurl {

void draw_top_bar(Ui& ui, PanelState& state);
void draw_scene_pane(Ui& ui, PanelState& state);                  // left
void draw_view_pane(Ui& ui, PanelState& state, SceneView& view);  // centre
// What the words on the left of a view of that size take of it [pixels].
CornerRoom heading_room(const Ui& ui, const PanelState& state, float width, float height);
void draw_figure_pane(Ui& ui, PanelState& state, FigureCards& cards);  // right
void draw_study_pane(Ui& ui, PanelState& state, FigureCards& cards);   // right, other page
void draw_right_tabs(Ui& ui, PanelState& state);                       // above either

// The pinned run beside the present one, in a box at a place of the window that has so much room [pixels];
// returns how high it is, 0: nothing is pinned.
float draw_comparison(Ui& ui, const PanelState& state, const ImVec2& low, float room);

struct PlacedFigure {  // a figure in the window
  ImVec2 origin;
  double scale;  // pixels per point
  float x(double points) const { return origin.x + static_cast<float>(points * scale); }
  float y(double points) const { return origin.y + static_cast<float>(points * scale); }
};
// At the cursor; with the present time as a line where it is drawn over time.
PlacedFigure draw_figure(Ui& ui, PanelState& state, const FigureCard& card);
double figure_width(const Ui& ui);              // what the window has room for [points]
void draw_cursors(const Ui& ui);                // over the figures
void draw_timeline(Ui& ui, PanelState& state);  // bottom
void draw_help(Ui& ui, PanelState& state);
void draw_export(Ui& ui, PanelState& state);
void draw_files(Ui& ui, PanelState& state);
void draw_question(Ui& ui, PanelState& state);
void draw_palette(Ui& ui, PanelState& state);
void draw_tour(Ui& ui, PanelState& state);

struct PaletteItem {
  std::string name, note;
  int points = 0;  // how well it fits
  Intent act;
};
// What fits a query, the best first.
std::vector<PaletteItem> palette_items(const PanelState& state, const std::string& query);

// A row of the left pane, with its menu and what is wrong with it.
void draw_row(Ui& ui, PanelState& state, const ParamRow& row);
// What is typed into a number's widget: an expression may have the scene's variables.
struct Typing {
  Ui::TypedField& field;
  const Variables& variables;
  bool typed = false;        // there is a text field
  bool back = false;         // what stands in it is the value that it began with, or none
  std::string problem = {};  // with what stands in it
};
// The value that the text of a field means: a number or an expression, as scenes have them; that which the
// field began with where it is none, or says what it said then. Returns whether it is another than `x` was.
bool take_typed(ImGuiID id, const char* text, double& x, Typing& typing);
// The same without: label and widget. Returns whether the value changed.
bool draw_param(Ui& ui, const ParamRow& row, ParamValue& value, bool wrong, Typing& typing);

}  // namespace unfurl
