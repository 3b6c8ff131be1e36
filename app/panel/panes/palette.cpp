// SPDX-License-Identifier: BSD-3-Clause
// The command palette: every action and every parameter, by a few letters of its name.
#include <algorithm>
#include <cctype>

#include "app/panel/actions.hpp"
#include "app/panel/panes/panes.hpp"

namespace unfurl {

namespace {

constexpr std::size_t most_rows = 12;

std::string lower(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

// How well all words of a query fit: 0 not at all; a name that begins with them best.
int fit(const std::string& query, std::string_view name, std::string_view help) {
  const std::string in_name = lower(name), in_help = lower(help);
  int points = 1;
  for (std::size_t i = 0; i < query.size();) {
    const std::size_t end = std::min(query.find(' ', i), query.size());
    const std::string word = query.substr(i, end - i);
    i = end + 1;
    if (word.empty()) continue;
    const std::size_t at = in_name.find(word);
    if (at == 0)
      points += 100;
    else if (at != std::string::npos)
      points += in_name[at - 1] == ' ' ? 50 : 20;
    else if (in_help.find(word) != std::string::npos)
      points += 5;
    else
      return 0;
  }
  return points;
}

}  // namespace

std::vector<PaletteItem> palette_items(const PanelState& state, const std::string& query) {
  std::vector<PaletteItem> items;
  const std::string wanted = lower(query);
  for (const Action& action : actions())
    items.push_back(
        {std::string(action.help), std::string(action.keys), fit(wanted, action.help, ""), action.act});
  for (const ParamSection& section : state.sections)
    for (const ParamRow& row : section.rows) {
      const std::string name = row.label + "  (" + row.key + ")";
      items.push_back({name, section.title, fit(wanted, name, row.spec.help),
                       [key = row.key](LiveSession& s) { s.state().reveal = key; }});
    }
  std::erase_if(items, [](const PaletteItem& item) { return item.points == 0; });
  std::stable_sort(items.begin(), items.end(),
                   [](const PaletteItem& a, const PaletteItem& b) { return a.points > b.points; });
  if (items.size() > most_rows) items.resize(most_rows);
  return items;
}

void draw_palette(Ui& ui, PanelState& state) {
  if (!state.palette_open) return;
  const Box box(ui, "palette", 560, true);
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  const std::string before = state.palette_query;
  // With a history of its own the field leaves no arrow to the walk among widgets.
  const bool entered = text_field(ui, "palette query", state.palette_query, -1, "an action or a parameter",
                                  ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory,
                                  [](ImGuiInputTextCallbackData*) { return 0; });
  if (state.palette_query != before) state.palette_row = 0;
  const auto items = palette_items(state, state.palette_query);
  const ImGuiIO& io = ImGui::GetIO();
  const auto pressed = [&](ImGuiKey key) { return ImGui::IsKeyPressed(io.KeyMap[key]); };
  const int last = static_cast<int>(items.size()) - 1;
  if (pressed(ImGuiKey_DownArrow)) ++state.palette_row;
  if (pressed(ImGuiKey_UpArrow)) --state.palette_row;
  state.palette_row = std::clamp(state.palette_row, 0, std::max(0, last));
  for (int i = 0; i <= last; ++i) {
    const PaletteItem& item = items[static_cast<std::size_t>(i)];
    const bool chosen =
        ImGui::Selectable((item.name + "##" + std::to_string(i)).c_str(), i == state.palette_row);
    ui.note("palette " + std::to_string(i));
    const float wide = ImGui::CalcTextSize(item.note.c_str()).x;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - wide);
    ImGui::TextColored(ui.theme.dim, "%s", item.note.c_str());
    if (!chosen && !(entered && i == state.palette_row)) continue;
    state.palette_open = false;
    state.intents.push_back(item.act);
  }
  if (items.empty()) wrapped(ui.theme.dim, "nothing is called so");
}

}  // namespace unfurl
