// SPDX-License-Identifier: BSD-3-Clause
// One row of the left pane: a label and the widget that a parameter's kind asks for.
#include <imgui_internal.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "app/panel/panes/panes.hpp"
#include "core/study/table.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

constexpr std::size_t most_numbers = 4;  // that a vector has a field for each of

// Seven digits. ImGui takes them for the smallest number of a logarithmic slider too.
int digit_count(const SliderRange& range) {
  const double smallest = range.logarithmic && range.low > 0 ? std::log10(range.low) : 0.0;
  return std::clamp(static_cast<int>(std::ceil(-smallest)) + 1, 7, 15);
}
std::string digits_of(const SliderRange& range) {
  return "%." + std::to_string(digit_count(range)) + "g";
}
std::string behind_number(const ParamSpec& spec) {
  const std::string unit = unit_caption(spec.unit);
  return (unit.empty() || unit == "°" ? "" : " ") + unit;
}

// A power of ten is written over the slider as people write it: "7e10 Pa" for the "7e+10 Pa" of its format.
bool slide(double& x, const SliderRange& range, const ParamSpec& spec, ImGuiSliderFlags flags) {
  const std::string unit = behind_number(spec);
  const double size = std::abs(x);
  const bool power = size > 0 && (size < 1e-4 || size >= std::pow(10.0, digit_count(range)));
  if (power) ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32_BLACK_TRANS);
  const bool moved = ImGui::SliderScalar("##value", ImGuiDataType_Double, &x, &range.low, &range.high,
                                         (digits_of(range) + unit).c_str(), flags);
  if (!power) return moved;
  ImGui::PopStyleColor();
  const std::string text = short_number(x, digit_count(range)) + unit;
  ImGui::RenderTextClipped(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), text.c_str(), nullptr, nullptr,
                           {0.5f, 0.5f});
  return moved;
}

// Whether a slider is a text field now (a click with Ctrl, Enter), in which ImGui takes the first number for
// the whole.
bool is_typed(const char* label) {
  return ImGui::TempInputIsActive(ImGui::GetID(label));
}

// That text field: a number or an expression, as scenes have them, and nothing else.
bool typed_widget(const char* label, const std::string& digits, double& x, Typing& typing) {
  const ImVec2 low = ImGui::GetCursorScreenPos(), size(ImGui::CalcItemWidth(), ImGui::GetFrameHeight());
  const ImRect place(low, {low.x + size.x, low.y + size.y});
  const ImGuiID id = ImGui::GetID(label);
  ImGui::ItemSize(place, ImGui::GetStyle().FramePadding.y);
  if (!ImGui::ItemAdd(place, id, &place, ImGuiItemFlags_Inputable)) return false;
  char text[256];
  std::snprintf(text, sizeof text, digits.c_str(), x);
  ImGui::TempInputText(place, id, label, text, sizeof text, ImGuiInputTextFlags_AutoSelectAll);
  const bool changed = take_typed(id, text, x, typing);
  if (changed) ImGui::MarkItemEdited(id);
  return changed;
}

bool real_widget(const ParamRow& row, ParamValue& value, Typing& typing) {
  double x = std::get<double>(value);
  const SliderRange range = slider_range(row);
  if (not_given(value)) {
    if (!ImGui::Button("not given", {ImGui::CalcItemWidth(), 0})) return false;
    value = first_value(row);
    return true;
  }
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_NoRoundToFormat | (range.logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  if (is_typed("##value")) {
    if (!typed_widget("##value", digits_of(range), x, typing)) return false;
    value = x;
    return true;
  }
  if (!slide(x, range, row.spec, flags)) return false;
  if (!ImGui::GetIO().WantTextInput) {  // dragged: four digits are what a hand can mean
    char rounded[40];
    std::snprintf(rounded, sizeof rounded, "%.4g", x);
    x = std::clamp(std::strtod(rounded, nullptr), range.low, range.high);
  }
  value = x;
  return true;
}

bool integer_widget(const ParamRow& row, ParamValue& value, Typing& typing) {
  const SliderRange range = slider_range(row);
  auto x = static_cast<ImS64>(std::get<long>(value));
  if (is_typed("##value")) {
    constexpr double exact = 9007199254740992.0;  // 2^53
    auto number = static_cast<double>(x);
    if (!typed_widget("##value", "%.16g", number, typing)) return false;
    if (number != std::floor(number) || std::abs(number) > exact) {
      typing.problem = exact_number(number) + " is no whole number";
      typing.back = true;
      return false;
    }
    value = static_cast<long>(number);
    return true;
  }
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

bool text_field(std::string& text) {
  std::vector<char> buffer = typing_room(text);
  if (!ImGui::InputText("##value", buffer.data(), buffer.size())) return false;
  text = buffer.data();
  return true;
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i <= text.size();) {
    const std::size_t end = std::min(text.find(',', i), text.size());
    const std::size_t first = text.find_first_not_of(' ', i);
    if (first < end) words.push_back(text.substr(first, text.find_last_not_of(' ', end - 1) - first + 1));
    i = end + 1;
  }
  return words;
}

// Names with commas between them; what is no list of names yet changes nothing.
bool names_widget(ParamValue& value) {
  std::string text = value_caption(value, "");
  if (!text_field(text)) return false;
  auto words = words_of(text);
  if (words.empty() || words == std::get<std::vector<std::string>>(value)) return false;
  value = std::move(words);
  return true;
}

// The same for any number of numbers, with all their digits: those that nobody touches stay.
bool numbers_widget(ParamValue& value) {
  std::string text;
  for (const double x : std::get<std::vector<double>>(value))
    text += (text.empty() ? "" : ", ") + exact_number(x);
  if (!text_field(text)) return false;
  std::vector<double> numbers;
  for (const std::string& word : words_of(text)) {
    double x = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
    if (error != std::errc() || end != word.data() + word.size()) return false;
    numbers.push_back(x);
  }
  if (numbers == std::get<std::vector<double>>(value)) return false;
  value = std::move(numbers);
  return true;
}

bool vector_widget(const ParamRow& row, ParamValue& value, Typing& typing) {
  auto& numbers = std::get<std::vector<double>>(value);
  if (row.spec.length == 0 || numbers.size() > most_numbers) return numbers_widget(value);
  const SliderRange range = slider_range(row);
  const float speed = static_cast<float>((range.high - range.low) / 400);
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  bool changed = false;
  ImGui::BeginGroup();
  ImGui::PushMultiItemsWidths(static_cast<int>(numbers.size()), ImGui::CalcItemWidth());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0) ImGui::SameLine(0, gap);
    ImGui::PushID(static_cast<int>(i));
    changed |= is_typed("##value")
                   ? typed_widget("##value", "%.15g", numbers[i], typing)
                   : ImGui::DragScalar("##value", ImGuiDataType_Double, &numbers[i], speed, nullptr, nullptr,
                                       "%.4g", ImGuiSliderFlags_NoRoundToFormat);
    ImGui::PopID();
    ImGui::PopItemWidth();
  }
  ImGui::EndGroup();
  return changed;
}

bool widget(Ui& ui, const ParamRow& row, ParamValue& value, Typing& typing) {
  switch (row.spec.kind) {
    case ParamKind::boolean:
      return ImGui::Checkbox("##value", &std::get<bool>(value));
    case ParamKind::integer:
      return integer_widget(row, value, typing);
    case ParamKind::real:
      return real_widget(row, value, typing);
    case ParamKind::choice:
      return choice_widget(ui, row, value);
    case ParamKind::text:
      return text_field(std::get<std::string>(value));
    case ParamKind::vector:
      return vector_widget(row, value, typing);
    case ParamKind::names:
      return names_widget(value);
  }
  return false;
}

}  // namespace

bool take_typed(ImGuiID id, const char* text, double& x, Typing& typing) {
  if (typing.field.id != id) typing.field = {id, x};
  typing.field.drawn = typing.typed = true;
  const auto number = [&](std::string meant) {
    meant.erase(0, meant.find_first_not_of(" ="));
    return evaluate(meant, typing.variables);
  };
  double now = typing.field.began;
  const ImGuiInputTextState* state = ImGui::GetInputTextState(id);
  if (state == nullptr || std::string_view(text) != state->InitialTextA.Data) try {
      now = number(text);
    } catch (const ExpressionError& error) {
      // A comma is a point, as on half of the keyboards, where it does not stand between two arguments.
      try {
        std::string pointed = text;
        std::replace(pointed.begin(), pointed.end(), ',', '.');
        now = number(pointed);
      } catch (const ExpressionError&) {
        typing.problem = in_quotes(text) + " is no number: " + error.what();
      }
    }
  typing.back = now == typing.field.began;
  return now != std::exchange(x, now);
}

bool draw_param(Ui& ui, const ParamRow& row, ParamValue& value, bool wrong, Typing& typing) {
  ImGui::PushID(row.key.c_str());
  const float full = ImGui::GetContentRegionAvail().x;
  const float label = std::floor(0.44f * full);
  const bool edited = !(value == row.value) && !(not_given(value) && not_given(row.value));
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, wrong ? ui.theme.error : edited ? ui.theme.accent : ui.theme.text);
  ImGui::TextUnformatted(shortened(row.label, label - ui.px(6)).c_str());
  ImGui::PopStyleColor();
  tooltip(ui, row.label + "\n" + param_tooltip(row));
  ImGui::SameLine(ImGui::GetCursorStartPos().x + label);
  ImGui::SetNextItemWidth(full - label);
  if (wrong) ImGui::PushStyleColor(ImGuiCol_Border, ui.theme.error);
  const bool changed = widget(ui, row, value, typing);
  if (wrong) ImGui::PopStyleColor();
  ui.note(row.key);
  ImGui::PopID();
  return changed;
}

}  // namespace unfurl
