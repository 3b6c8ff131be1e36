// SPDX-License-Identifier: BSD-3-Clause
// A and B side by side: beside the view, which they would cover, or in it where that is all there is.
#include <algorithm>
#include <array>

#include "app/panel/panes/panes.hpp"
#include "app/panel/runs/comparison.hpp"

namespace unfurl {

float draw_comparison(Ui& ui, const PanelState& state, const ImVec2& low, float room) {
  if (!state.pinned) return 0;
  std::vector<ComparisonRow> rows = compare(*state.pinned, *state.shown, point_of(state.trade, *state.pinned),
                                            point_of(state.trade, *state.shown));
  rows.insert(rows.begin(), {"", "A (pinned)", "B (now)", "B/A"});
  const float line = ui.regular->FontSize + ui.px(3), pad = ui.px(10), gap = ui.px(16);
  std::array<float, 4> columns{};  // with the gap before them
  for (const ComparisonRow& row : rows)
    for (std::size_t i = 0; const std::string* cell : {&row.label, &row.a, &row.b, &row.change}) {
      columns[i] = std::max(columns[i], ImGui::CalcTextSize(cell->c_str()).x + (i > 0 ? gap : 0));
      ++i;
    }
  // Names above their values where both have no room side by side; where these alone have none they are
  // smaller.
  const float values = columns[1] + columns[2] + columns[3], most = room - 2 * pad;
  const bool above = columns[0] + values > most;
  const float width = above ? room : 2 * pad + columns[0] + values;
  const float size = std::min(1.0f, above ? most / (values - gap) : 1.0f);
  const float lines = above ? 2 * static_cast<float>(rows.size()) - 1 : static_cast<float>(rows.size());
  const float height = 2 * pad + line * lines;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, {low.x + width, low.y + height}, ui.color(ui.theme.window, 0.92f), ui.px(6));
  list.AddRect(low, {low.x + width, low.y + height}, ui.color(ui.theme.rule), ui.px(6));
  float y = low.y + pad;
  for (const ComparisonRow& row : rows) {
    const bool heading = &row == &rows.front();
    const std::string name = shortened(row.label, above ? most : columns[0]);
    list.AddText({low.x + pad, y}, ui.color(ui.theme.dim), name.c_str());
    if (above && !heading) y += line;
    const std::pair<const std::string*, const ImVec4*> cells[] = {
        {&row.a, heading ? &ui.theme.curve_a : &ui.theme.text},
        {&row.b, heading ? &ui.theme.curve_b : &ui.theme.text},
        {&row.change, &ui.theme.text}};
    float right = low.x + width - pad;
    for (std::size_t i = 3; i > 0; --i) {
      const std::string& text = *cells[i - 1].first;
      list.AddText(ui.regular, size * ui.regular->FontSize,
                   {right - size * ImGui::CalcTextSize(text.c_str()).x, y + 0.5f * (1 - size) * line},
                   ui.color(*cells[i - 1].second), text.c_str());
      right -= size * columns[i];
    }
    y += line;
  }
  ui.places["comparison"] = {low.x, low.y, low.x + width, low.y + height};
  return height;
}

}  // namespace unfurl
