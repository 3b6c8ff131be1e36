// One row of the left pane: a label and the widget that a parameter's kind asks for.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/panel/panes.hpp"

namespace unfurl {

namespace {

constexpr std::size_t longest_text = 256;

// Seven digits and the unit. ImGui takes the digits for the smallest number of a logarithmic slider too.
std::string format_of(const ParamSpec& spec, const SliderRange& range) {
  const double smallest = range.logarithmic && range.low > 0 ? std::log10(range.low) : 0.0;
  const int digits = std::clamp(static_cast<int>(std::ceil(-smallest)) + 1, 7, 15);
  const std::string unit = unit_caption(spec.unit);
  return "%." + std::to_string(digits) + "g" + (unit.empty() || unit == "°" ? "" : " ") + unit;
}

bool real_widget(const ParamRow& row, ParamValue& value) {
  double x = std::get<double>(value);
  const SliderRange range = slider_range(row.spec, row.value);
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_NoRoundToFormat | (range.logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  const std::string format = format_of(row.spec, range);
  if (!ImGui::SliderScalar("##value", ImGuiDataType_Double, &x, &range.low, &range.high, format.c_str(),
                           flags))
    return false;
  if (!ImGui::GetIO().WantTextInput) {  // dragged: four digits are what a hand can mean
    char rounded[40];
    std::snprintf(rounded, sizeof rounded, "%.4g", x);
    x = std::clamp(std::strtod(rounded, nullptr), range.low, range.high);
  }
  value = x;
  return true;
}

bool integer_widget(const ParamRow& row, ParamValue& value) {
  const SliderRange range = slider_range(row.spec, row.value);
  auto x = static_cast<ImS64>(std::get<long>(value));
  const auto low = static_cast<ImS64>(range.low), high = static_cast<ImS64>(range.high);
  if (!ImGui::SliderScalar("##value", ImGuiDataType_S64, &x, &low, &high, "%lld")) return false;
  value = static_cast<long>(x);
  return true;
}

bool choice_widget(Ui& ui, const ParamRow& row, ParamValue& value) {
  auto& chosen = std::get<std::string>(value);
  bool changed = false;
  if (!ImGui::BeginCombo("##value", chosen.c_str())) return false;
  for (const std::string_view choice : row.spec.choices) {
    const bool is = chosen == choice;
    if (ImGui::Selectable(std::string(choice).c_str(), is) && !is) {
      chosen = choice;
      changed = true;
    }
    ui.note(row.key + "=" + std::string(choice));
  }
  ImGui::EndCombo();
  return changed;
}

bool text_widget(ParamValue& value) {
  auto& text = std::get<std::string>(value);
  char buffer[longest_text];
  std::snprintf(buffer, sizeof buffer, "%s", text.c_str());
  if (!ImGui::InputText("##value", buffer, sizeof buffer)) return false;
  text = buffer;
  return true;
}

bool vector_widget(const ParamRow& row, ParamValue& value) {
  auto& numbers = std::get<std::vector<double>>(value);
  const SliderRange range = slider_range(row.spec, row.value);
  const float speed = static_cast<float>((range.high - range.low) / 400);
  return ImGui::DragScalarN("##value", ImGuiDataType_Double, numbers.data(), static_cast<int>(numbers.size()),
                            speed, nullptr, nullptr, "%.4g", ImGuiSliderFlags_NoRoundToFormat);
}

bool widget(Ui& ui, const ParamRow& row, ParamValue& value) {
  switch (row.spec.kind) {
    case ParamKind::boolean:
      return ImGui::Checkbox("##value", &std::get<bool>(value));
    case ParamKind::integer:
      return integer_widget(row, value);
    case ParamKind::real:
      return real_widget(row, value);
    case ParamKind::choice:
      return choice_widget(ui, row, value);
    case ParamKind::text:
      return text_widget(value);
    case ParamKind::vector:
      return vector_widget(row, value);
  }
  return false;
}

std::string shortened(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::string kept = text;
  while (!kept.empty() && ImGui::CalcTextSize((kept + "\u2026").c_str()).x > width) {
    do kept.pop_back();
    while (!kept.empty() && (kept.back() & 0xC0) == 0x80);
  }
  while (!kept.empty() && kept.back() == ' ') kept.pop_back();
  return kept + "\u2026";
}

}  // namespace

bool draw_param(Ui& ui, const ParamRow& row, ParamValue& value, bool wrong) {
  ImGui::PushID(row.key.c_str());
  const float full = ImGui::GetContentRegionAvail().x;
  const float label = std::floor(0.44f * full);
  const bool edited = !(value == row.value);
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, wrong ? ui.theme.error : edited ? ui.theme.accent : ui.theme.text);
  ImGui::TextUnformatted(shortened(row.label, label - ui.px(6)).c_str());
  ImGui::PopStyleColor();
  tooltip(ui, row.label + "\n" + param_tooltip(row));
  ImGui::SameLine(ImGui::GetCursorStartPos().x + label);
  ImGui::SetNextItemWidth(full - label);
  if (wrong) ImGui::PushStyleColor(ImGuiCol_Border, ui.theme.error);
  const bool changed = widget(ui, row, value);
  if (wrong) ImGui::PopStyleColor();
  ui.note(row.key);
  ImGui::PopID();
  return changed;
}

}  // namespace unfurl
